// Undo and redo for all that the page keeps: texts, question, options and the drive.

import { batch, effect, signal } from "vendor/view";
import * as state from "studio/state";

const MOST = 200; // steps
const PAUSE = 700; // ms: what is typed without a pause is one step

export const canUndo = signal(false);
export const canRedo = signal(false);
let past = [];
let future = [];
let settled = null; // what the last step ended with
let latest = null; // what is kept now
let timer = 0;

/** Begin to take down what changes. */
export function followChanges() {
  latest = settled = state.asData();
  effect(() => {
    const now = state.asData();
    if (now.drive !== latest.drive) settle();
    latest = now;
    clearTimeout(timer);
    timer = setTimeout(settle, PAUSE);
  });
}

/** Begin with what is kept now; nothing before it can be undone. */
export function forgetSteps() {
  clearTimeout(timer);
  past = [];
  future = [];
  latest = settled = state.asData();
  tell();
}

/** End a step, such as before what was typed is replaced. */
export function settle() {
  clearTimeout(timer);
  if (latest === null || isSame(latest, settled)) return;
  past = [...past, settled].slice(-MOST);
  future = [];
  settled = latest;
  tell();
}

/** Replace what is kept in one step, which can be undone. */
export function inOneStep(change) {
  settle();
  batch(change);
}

export function undo() {
  settle();
  if (!past.length) return;
  future = [settled, ...future];
  restore(past.at(-1));
  past = past.slice(0, -1);
  tell();
}

export function redo() {
  settle();
  if (!future.length) return;
  past = [...past, settled];
  restore(future[0]);
  future = future.slice(1);
  tell();
}

function restore(data) {
  settled = data;
  latest = data; // so that the effect takes it for no change
  batch(() => {
    if (data.drive !== state.kept.drive.peek()) state.fromTheStart();
    state.takeOver(data);
  });
}

function tell() {
  canUndo.value = past.length > 0;
  canRedo.value = future.length > 0;
}

const isSame = (a, b) => Object.keys(a).every((name) => a[name] === b[name] || JSON.stringify(a[name]) === JSON.stringify(b[name]));
