// What the buttons and the keys do.

import { batch } from "vendor/view";
import { save } from "viewer/verdict";
import { inOneStep } from "studio/history";
import { keepQuestion, questionNow } from "studio/recent";
import { ask } from "studio/server";
import * as state from "studio/state";

const LARGEST = 60_000_000; // bytes of files that are dropped together
let running = null;

/** The definitions as they are now; what was explained, or went wrong, of the former ones is gone. */
export function rewrite(text) {
  batch(() => {
    forgetMarks();
    state.kept.text.value = text;
  });
}

/** The definitions of a file in place of those of the editor, which `undo` brings back. */
export function loadText(text) {
  inOneStep(() => rewrite(text));
}

/** Another question. */
export function askAnother(text) {
  batch(() => {
    forgetMarks();
    state.kept.formula.value = text;
  });
}

function forgetMarks() {
  if (state.explain.peek() !== null) state.explain.value = null;
  if (state.clashes.peek().length) state.clashes.value = [];
  if (state.trouble.peek()) state.trouble.value = "";
}

/** End what runs. The server ends the worker of a job that nobody listens to. */
export function stop() {
  running?.abort();
  running = null;
  state.job.value = null;
}

/** Ask one long question after ending the former one; null where it was stopped or failed. */
async function askLong(title, kind, question) {
  stop();
  const mine = new AbortController();
  running = mine;
  const begun = performance.now();
  state.job.value = { title, stage: "", seconds: 0 };
  state.trouble.value = "";
  const tell = (message) => {
    if (running !== mine) return;
    const stage = message.waiting ? "waiting for a worker" : (message.stage ?? "");
    state.job.value = { title, stage, seconds: (performance.now() - begun) / 1000 };
  };
  const ticking = setInterval(() => {
    if (running === mine && state.job.value) tell({ stage: state.job.value.stage });
  }, 250);
  try {
    const told = await ask(kind, question, { hear: tell, signal: mine.signal });
    if (told.error) {
      state.trouble.value = told.error;
      return null;
    }
    return { ...told.answer, seconds: told.seconds, cpu: told.cpu };
  } catch (error) {
    if (error.name !== "AbortError") state.trouble.value = error.message;
    return null;
  } finally {
    clearInterval(ticking);
    if (running === mine) {
      running = null;
      state.job.value = null;
    }
  }
}

/** Show an answer, and its drive where it has one. */
function take(answer, { show = true, compared = false } = {}) {
  batch(() => {
    state.answers.value = [{ ...answer, key: Date.now() + Math.random() }, ...state.answers.value].slice(0, 6);
    state.clashes.value = answer.marks ?? [];
    if (answer.drive && show) showDrive(answer.drive, answer.view, compared);
  });
}

/** Show a drive from its start. */
export function showDrive(drive, view, compared = false) {
  batch(() => {
    state.kept.drive.value = drive;
    state.kept.compared.value = compared;
    if (view) state.view.value = view;
    state.fromTheStart();
  });
}

/** A drive of a file, with the formula that the file is about as the question; `play`: begin to play it. */
export function showFile(drive, view, { play = false } = {}) {
  batch(() => {
    state.recording.value = null;
    state.kept.formula.value = drive.formula ?? state.kept.formula.value;
    showDrive(drive, view);
    state.plays.value = play && !state.wantsRest();
  });
}

let found = { text: "", count: 0 };

/**
 * Find a drive; `negated`: one without it; `next`: one that differs clearly from those before; `fresh`: even if
 * the answer is known.
 */
export async function find({ negated = false, next = false, fresh = false } = {}) {
  const question = { ...state.question.value, settings: state.settingsOf("find"), negated };
  const text = JSON.stringify(question);
  const count = next && found.text === text ? found.count + 1 : next ? 2 : 1;
  const title = negated ? "Find one without it" : count > 1 ? `Find drive ${count}` : "Find a drive";
  const asked = questionNow(negated ? "without" : "find");
  const answer = await askLong(title, "find", { ...question, count, fresh });
  if (!answer) return;
  keepQuestion(asked, answer.verdict);
  found = { text, count: answer.drive ? count : found.count };
  take({ ...answer, again: () => find({ negated, fresh: true }) });
}

/** Why the selected part of the question is true or false at the present time: in the strips, in the text. */
export function explain() {
  const { formula, id } = state.look.selected.value;
  const doc = state.view.value;
  if (!doc) return say("Explain is about a drive that is shown: find one first.");
  if (state.kept.drive.value === null) {
    return say("Explain is about judged drives: a recording is only known at its samples. See its strips.");
  }
  const at = state.look.time.value;
  const same = state.explain.value;
  const part = formula === 0 ? id : 0;
  if (same && same.part === part && Math.abs(same.at - at) < 1e-6) state.explain.value = null;
  else state.explain.value = { part, at };
}

export async function prove({ fresh = false } = {}) {
  const settings = state.settingsOf("prove");
  const asked = questionNow("prove");
  const answer = await askLong("Prove", "prove", { ...state.question.value, settings, fresh });
  if (!answer) return;
  keepQuestion(asked, answer.verdict);
  take({ ...answer, again: () => prove({ fresh: true }) });
}

/** Before against after the edit, both directions at once; each answer is shown when it is there. */
export async function compare() {
  stop();
  const mine = new AbortController();
  running = mine;
  const begun = performance.now();
  const stages = { true: "", false: "" };
  let isShown = false;
  const tick = () => {
    const seconds = (performance.now() - begun) / 1000;
    const stage = Object.values(stages).filter(Boolean).join(" · ");
    if (running === mine) state.job.value = { title: "Compare", stage, seconds };
  };
  const ticking = setInterval(tick, 250);
  tick();
  state.trouble.value = "";
  const one = async (forward) => {
    const hear = (message) => {
      stages[forward] = message.waiting ? "waiting" : (message.stage ?? "");
    };
    const told = await ask("compare", { ...state.question.value, forward }, { hear, signal: mine.signal });
    stages[forward] = "";
    if (told.error) state.trouble.value = told.error;
    else {
      const [one, other] = told.answer.sets.map((x) => (x === "edit" ? "after" : "before"));
      const so = { PROVED: "it holds", REFUTED: "it does not always hold" }[told.answer.verdict];
      const promise = `Where it holds ${one} the edit, ${so ?? "nobody knows whether it holds"} ${other} it.`;
      take({ ...told.answer, promise, seconds: told.seconds, cpu: told.cpu }, { compared: true, show: !isShown });
      isShown ||= Boolean(told.answer.drive);
    }
  };
  try {
    await Promise.all([one(true), one(false)]);
  } catch (error) {
    if (error.name !== "AbortError") state.trouble.value = error.message;
  } finally {
    clearInterval(ticking);
    if (running === mine) {
      running = null;
      state.job.value = null;
    }
  }
}

/** Keep the present text as what the next edit is compared with; a second time forgets it. */
export function keepAsBefore() {
  state.kept.before.value = state.kept.text.value;
  say("Kept: Compare now tells this text from the next one.");
}

export function forgetBefore() {
  state.kept.before.value = null;
}

/** A word that goes away. */
export function say(text) {
  state.said.value = text;
  setTimeout(() => {
    if (state.said.value === text) state.said.value = "";
  }, 4000);
}

/** The drive that is shown as a page of its own. */
export async function savePage() {
  const drive = state.kept.drive.value;
  if (!drive) return say("There is no drive to be saved: find one first.");
  const asked = { ...state.question.value, drive, compare: state.kept.compared.value };
  const told = await ask("page", { ...asked, explain: state.explain.value }).catch((error) => ({ error: error.message }));
  if (told.error) state.trouble.value = told.error;
  else save({ name: "drive.html", content: told.answer.page, kind: "text/html" });
}

export async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    say("Copied.");
  } catch {
    say("The browser does not let the page copy: mark the text and copy it.");
  }
}

/** Files that were dropped on the page, or chosen: definitions, a drive, a certificate, a recording. */
export async function open(list) {
  const files = [];
  if (list.reduce((sum, x) => sum + x.size, 0) > LARGEST) {
    state.trouble.value = "The files are larger than 60 MB together: ask `roadproof evaluate` on the command line.";
    return;
  }
  for (const file of list) files.push({ name: file.name, content: await file.text() });
  await openTexts(files);
}

/** Files with their names and contents, as `open`; those that the studio was started with, too. */
export async function openTexts(files) {
  if (!files.length) return;
  const spec = files.find((x) => x.name.endsWith(".spec"));
  if (spec) {
    state.trouble.value = "";
    state.specs.value = [...state.specs.value.filter((x) => x.name !== spec.name), { name: spec.name, text: spec.content }];
    loadText(spec.content);
    return;
  }
  if (!files.every((x) => x.name.endsWith(".json"))) return openTogether(files);
  const troubles = [];
  let isShown = false;
  for (const file of files) {
    isShown = (await openTogether([file], !isShown)) || isShown;
    if (state.trouble.value) troubles.push(state.trouble.value);
  }
  if (troubles.length) state.trouble.value = troubles.join("\n");
}

/** Files that belong together; whether a drive is among them, which is shown where `show` says so. */
async function openTogether(files, show = true) {
  const title = `Open ${files.map((x) => x.name).join(", ")}`;
  const answer = await askLong(title, "drop", { ...state.question.value, files });
  if (!answer) return false;
  if (answer.drive) {
    const [{ name }] = files;
    state.drives.value = [...state.drives.value.filter((x) => x.name !== name), { name, drive: answer.drive }];
    if (show) showFile(answer.drive, answer.view);
  } else if (answer.view) {
    showRecorded(answer.view);
  } else if (answer.recording) {
    state.recording.value = { ...answer.recording, contents: files };
  } else if (answer.checked) {
    const promise = answer.checked.accepted
      ? "Checked again, without the programs that made it."
      : "It does not show what it says.";
    take({ ...answer.checked, promise, reason: answer.checked.told });
  }
  return Boolean(answer.drive);
}

/** A pair of the recording that was dropped, with the question, or with a scenario by its number. */
export async function showPair(row, number = null) {
  if (number !== null) state.kept.formula.value = String(number);
  state.pair.value = row;
  const pair = {
    recording: String(row.recording),
    vehicles: row.vehicles,
    first: row.first_frame,
    last: row.last_frame,
  };
  const question = { ...state.question.value, files: state.recording.value.contents, pair };
  const answer = await askLong(`Vehicles ${row.vehicles.join(", ")}`, "pair", question);
  if (answer && state.pair.value === row) showRecorded(answer.view);
}

/** A recorded trace. It is not in the address, since recordings are large. */
function showRecorded(view) {
  const row = state.pair.peek();
  batch(() => {
    showDrive(null, view);
    state.pair.value = row;
    state.look.selected.value = { formula: 0, key: "/0", id: 0 };
  });
}
