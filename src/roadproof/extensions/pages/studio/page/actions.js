// The actions of buttons and keys.

import { batch } from "vendor/view";
import { save } from "viewer/verdict";
import { MOST } from "studio/answers";
import { inOneStep } from "studio/history";
import { currentQuestion, storeQuestion } from "studio/recent";
import { ask } from "studio/server";
import * as state from "studio/state";

const LARGEST = 60_000_000; // bytes of files that are dropped together
let running = null;

/** Replace the definitions; explanations and errors of the former ones are cleared. */
export function setDefinitions(text) {
  batch(() => {
    forgetMarks();
    state.saved.text.value = text;
  });
}

/** Replace the definitions in the editor by those of a file; `undo` brings the former ones back. */
export function loadDefinitions(text) {
  inOneStep(() => setDefinitions(text));
}

/** Replace the question. */
export function setQuestion(text) {
  batch(() => {
    forgetMarks();
    state.saved.formula.value = text;
  });
}

function forgetMarks() {
  if (state.explain.peek() !== null) state.explain.value = null;
  if (state.clashes.peek().length) state.clashes.value = [];
  if (state.errorText.peek()) state.errorText.value = "";
}

/** Stop the running job. The server ends the worker of a job whose request was closed. */
export function stop() {
  running?.abort();
  running = null;
  state.job.value = null;
}

/** Stop the running job, then run another one; resolve to its answer, null where it was stopped or failed. */
async function runJob(title, kind, question) {
  stop();
  const controller = new AbortController();
  running = controller;
  const started = performance.now();
  state.job.value = { title, stage: "", seconds: 0 };
  state.errorText.value = "";
  const showProgress = (message) => {
    if (running !== controller) return;
    const stage = message.waiting ? "waiting for a worker" : (message.stage ?? "");
    state.job.value = { title, stage, seconds: (performance.now() - started) / 1000 };
  };
  const ticking = setInterval(() => {
    if (running === controller && state.job.value) showProgress({ stage: state.job.value.stage });
  }, 250);
  try {
    const reply = await ask(kind, question, { onMessage: showProgress, signal: controller.signal });
    if (reply.error) {
      state.errorText.value = reply.error;
      return null;
    }
    return { ...reply.answer, seconds: reply.seconds, cpu: reply.cpu };
  } catch (error) {
    if (error.name !== "AbortError") state.errorText.value = error.message;
    return null;
  } finally {
    clearInterval(ticking);
    if (running === controller) {
      running = null;
      state.job.value = null;
    }
  }
}

/** Add an answer to the list, and show its drive where it has one. */
function addAnswer(answer, { show = true, compared = false } = {}) {
  batch(() => {
    state.answers.value = [{ ...answer, key: Date.now() + Math.random() }, ...state.answers.value].slice(0, MOST);
    state.clashes.value = answer.marks ?? [];
    if (answer.drive && show) showDrive(answer.drive, answer.view, compared);
  });
}

/** Show a drive from its start; `asked`: the question that a view is about that is not asked for again. */
export function showDrive(drive, view, compared = false, asked = "") {
  batch(() => {
    state.saved.drive.value = drive;
    state.saved.compared.value = compared;
    if (view) state.view.value = view;
    if (drive === null) state.viewedQuestion.value = asked;
    state.resetView();
  });
}

/** Show the drive of a file, with the formula of the file as the question; `play`: start to play it. */
export function showFile(drive, view, { play = false } = {}) {
  batch(() => {
    state.recording.value = null;
    state.saved.formula.value = drive.formula ?? state.saved.formula.value;
    showDrive(drive, view);
    state.autoplay.value = play && !state.prefersReducedMotion();
  });
}

let lastSearch = { text: "", count: 0 }; // the last question, and how many drives of it were found

/**
 * Find a drive. `negated`: one on which the question is false; `next`: one that differs clearly from those before;
 * `fresh`: search even if the answer is known.
 */
export async function find({ negated = false, next = false, fresh = false } = {}) {
  const question = { ...state.question.value, settings: state.optionValues("find"), negated };
  const text = JSON.stringify(question);
  const count = next && lastSearch.text === text ? lastSearch.count + 1 : next ? 2 : 1;
  const title = negated ? "Find one without it" : count > 1 ? `Find drive ${count}` : "Find a drive";
  const request = currentQuestion(negated ? "without" : "find");
  const answer = await runJob(title, "find", { ...question, count, fresh });
  if (!answer) return;
  storeQuestion(request, answer.verdict);
  lastSearch = { text, count: answer.drive ? count : lastSearch.count };
  addAnswer({ ...answer, job: negated ? "without" : "find" });
}

/** Explain why the selected part of the question is true or false now, in the strips and in the text; or stop it. */
export function explain() {
  const { formula, id } = state.look.selected.value;
  const doc = state.view.value;
  if (!doc) return showNotice("Explain is about a drive that is shown: find one first.");
  if (state.saved.drive.value === null) {
    return showNotice("Explain is about judged drives: a recording is only known at its samples. See its strips.");
  }
  const at = state.look.time.value;
  const same = state.explain.value;
  const part = formula === 0 ? id : 0;
  if (same && same.part === part && Math.abs(same.at - at) < 1e-6) state.explain.value = null;
  else state.explain.value = { part, at };
}

export async function prove({ fresh = false } = {}) {
  const settings = state.optionValues("prove");
  const request = currentQuestion("prove");
  const answer = await runJob("Prove", "prove", { ...state.question.value, settings, fresh });
  if (!answer) return;
  storeQuestion(request, answer.verdict);
  addAnswer({ ...answer, job: "prove" });
}

/** Compute an answer again that was known; about the present question. */
export function again({ job }) {
  return job === "prove" ? prove({ fresh: true }) : find({ negated: job === "without", fresh: true });
}

/** Compare the question before and after the edit, in both directions at once; show each answer when it arrives. */
export async function compare() {
  stop();
  const controller = new AbortController();
  running = controller;
  const started = performance.now();
  const stages = { true: "", false: "" };
  let isShown = false;
  const tick = () => {
    const seconds = (performance.now() - started) / 1000;
    const stage = Object.values(stages).filter(Boolean).join(" · ");
    if (running === controller) state.job.value = { title: "Compare", stage, seconds };
  };
  const ticking = setInterval(tick, 250);
  tick();
  state.errorText.value = "";
  const compareOne = async (forward) => {
    const onMessage = (message) => {
      stages[forward] = message.waiting ? "waiting" : (message.stage ?? "");
    };
    const reply = await ask("compare", { ...state.question.value, forward }, { onMessage, signal: controller.signal });
    stages[forward] = "";
    if (reply.error) state.errorText.value = reply.error;
    else {
      const [one, other] = reply.answer.sets.map((x) => (x === "edit" ? "after" : "before"));
      const result = { PROVED: "it holds", REFUTED: "it does not always hold" }[reply.answer.verdict];
      const promise = `Where it holds ${one} the edit, ${result ?? "nobody knows whether it holds"} ${other} it.`;
      addAnswer({ ...reply.answer, promise, seconds: reply.seconds, cpu: reply.cpu }, { compared: true, show: !isShown });
      isShown ||= Boolean(reply.answer.drive);
    }
  };
  try {
    await Promise.all([compareOne(true), compareOne(false)]);
  } catch (error) {
    if (error.name !== "AbortError") state.errorText.value = error.message;
  } finally {
    clearInterval(ticking);
    if (running === controller) {
      running = null;
      state.job.value = null;
    }
  }
}

/** Store the present text for a comparison with the next edit. */
export function keepAsBefore() {
  state.saved.before.value = state.saved.text.value;
  showNotice("Kept: Compare now tells this text from the next one.");
}

export function forgetBefore() {
  state.saved.before.value = null;
}

/** Show a message for some seconds. */
export function showNotice(text) {
  state.notice.value = text;
  setTimeout(() => {
    if (state.notice.value === text) state.notice.value = "";
  }, 4000);
}

/** Save the shown drive as an HTML page of its own. */
export async function savePage() {
  const drive = state.saved.drive.value;
  if (!drive) return showNotice("There is no drive to be saved: find one first.");
  const request = { ...state.question.value, drive, compare: state.saved.compared.value };
  const reply = await ask("page", { ...request, explain: state.explain.value }).catch((error) => ({ error: error.message }));
  if (reply.error) state.errorText.value = reply.error;
  else save({ name: "drive.html", content: reply.answer.page, kind: "text/html" });
}

export async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    showNotice("Copied.");
  } catch {
    showNotice("The browser does not let the page copy: mark the text and copy it.");
  }
}

/** Open files that were dropped on the page: definitions, a drive, a certificate or a recording. */
export async function open(list) {
  const files = [];
  if (list.reduce((sum, x) => sum + x.size, 0) > LARGEST) {
    state.errorText.value = "The files are larger than 60 MB together: ask `roadproof evaluate` on the command line.";
    return;
  }
  for (const file of list) files.push({ name: file.name, content: await file.text() });
  await openFiles(files);
}

/** Open files by name and content; the studio may have been started with them. */
export async function openFiles(files) {
  if (!files.length) return;
  const spec = files.find((x) => x.name.endsWith(".spec"));
  if (spec) {
    state.errorText.value = "";
    state.specs.value = [...state.specs.value.filter((x) => x.name !== spec.name), { name: spec.name, text: spec.content }];
    loadDefinitions(spec.content);
    return;
  }
  if (!files.every((x) => x.name.endsWith(".json"))) return openGroup(files);
  const problems = [];
  let isShown = false;
  for (const file of files) {
    isShown = (await openGroup([file], !isShown)) || isShown;
    if (state.errorText.value) problems.push(state.errorText.value);
  }
  if (problems.length) state.errorText.value = problems.join("\n");
}

/** Open files that belong together; resolve to whether a drive is among them. `show`: show it. */
async function openGroup(files, show = true) {
  const title = `Open ${files.map((x) => x.name).join(", ")}`;
  const answer = await runJob(title, "drop", { ...state.question.value, files });
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
    addAnswer({ ...answer.checked, promise, reason: answer.checked.told });
  }
  return Boolean(answer.drive);
}

/** Show a pair of the dropped recording, with the question, or with scenario `number`. */
export async function showPair(row, number = null) {
  if (number !== null) state.saved.formula.value = String(number);
  state.pair.value = row;
  const pair = {
    recording: String(row.recording),
    vehicles: row.vehicles,
    first: row.first_frame,
    last: row.last_frame,
  };
  const asked = JSON.stringify(state.question.value);
  const question = { ...state.question.value, files: state.recording.value.contents, pair };
  const answer = await runJob(`Vehicles ${row.vehicles.join(", ")}`, "pair", question);
  if (answer && state.pair.value === row) showRecorded(answer.view, asked);
}

/** Show a recorded trace. It is not in the address, since recordings are large. */
function showRecorded(view, asked = JSON.stringify(state.question.peek())) {
  const row = state.pair.peek();
  batch(() => {
    showDrive(null, view, false, asked);
    state.pair.value = row;
    state.look.selected.value = { formula: 0, key: "/0", id: 0 };
  });
}
