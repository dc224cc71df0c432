// Undo and redo for the saved state of the page: texts, question, options and the drive.

import { batch, effect, signal } from "vendor/view";
import * as state from "studio/state";

const MOST = 200; // steps
const PAUSE = 700; // ms: what is typed without a pause is one step

export const canUndo = signal(false);
export const canRedo = signal(false);
let past = [];
let future = [];
let committed = null; // the state at the end of the last step
let latest = null; // the present state
let timer = 0;

/** Start to record changes. */
export function followChanges() {
  latest = committed = state.savedData();
  effect(() => {
    const now = state.savedData();
    if (now.drive !== latest.drive) endStep();
    latest = now;
    clearTimeout(timer);
    timer = setTimeout(endStep, PAUSE);
  });
}

/** Forget all steps; nothing before now can be undone. */
export function forgetSteps() {
  clearTimeout(timer);
  past = [];
  future = [];
  latest = committed = state.savedData();
  updateButtons();
}

/** End the present step, such as before typed text is replaced. */
export function endStep() {
  clearTimeout(timer);
  if (latest === null || isSame(latest, committed)) return;
  past = [...past, committed].slice(-MOST);
  future = [];
  committed = latest;
  updateButtons();
}

/** Change the state in one step, which can be undone. */
export function inOneStep(change) {
  endStep();
  batch(change);
}

export function undo() {
  endStep();
  if (!past.length) return;
  future = [committed, ...future];
  restore(past.at(-1));
  past = past.slice(0, -1);
  updateButtons();
}

export function redo() {
  endStep();
  if (!future.length) return;
  past = [...past, committed];
  restore(future[0]);
  future = future.slice(1);
  updateButtons();
}

function restore(data) {
  committed = data;
  latest = data; // so the effect sees no change
  batch(() => {
    if (data.drive !== state.saved.drive.peek()) state.resetView();
    state.applyState(data);
  });
}

function updateButtons() {
  canUndo.value = past.length > 0;
  canRedo.value = future.length > 0;
}

const isSame = (a, b) => Object.keys(a).every((name) => a[name] === b[name] || JSON.stringify(a[name]) === JSON.stringify(b[name]));
