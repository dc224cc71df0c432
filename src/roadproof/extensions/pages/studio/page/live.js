// Reads and judges each edit again: one question at a time, and always the latest.

import { batch, effect } from "vendor/view";
import { showPair } from "studio/actions";
import { ask } from "studio/server";
import * as state from "studio/state";

const PATIENCE = 25; // ms after the last key
const LONGER = 500; // ms, for names, which nobody waits for, and for recordings, which take long

/** Ask `kind` whenever `question` changes; `take` gets the latest answer, `fail` the reason why there is none. */
function follow(kind, question, take, fail, patience = PATIENCE) {
  let pending = null;
  let busy = false;
  let timer = 0;
  const next = async () => {
    if (busy || pending === null) return;
    busy = true;
    const sent = pending;
    pending = null;
    try {
      const reply = await ask(kind, sent);
      if (pending === null) {
        if (reply.error) fail(reply.error);
        else take(reply.answer, sent);
      }
    } catch (error) {
      fail(error.message);
    }
    busy = false;
    next();
  };
  let isFirst = true;
  effect(() => {
    pending = question();
    clearTimeout(timer);
    timer = setTimeout(next, isFirst ? 0 : patience);
    isFirst = false;
  });
}

/** Keep mistakes, names and strips up to date with the texts. */
export function followEdits() {
  follow(
    "read",
    () => {
      const { draft, set, formula } = state.question.value;
      const watches = Object.fromEntries(state.saved.watches.value.map((x, k) => [`watch ${k + 1}`, x]));
      const filled = Object.fromEntries(Object.entries(watches).filter(([, x]) => x.trim()));
      return { draft, set, formulas: { formula, ...filled } };
    },
    (answer) => {
      state.mistakes.value = answer.mistakes;
      state.descriptions.value = answer.formulas;
    },
    (reason) => (state.errorText.value = reason),
  );
  follow(
    "names",
    () => ({ draft: state.draft.value, set: "edit" }),
    (answer) => (state.names.value = answer),
    () => {},
    LONGER,
  );
  let timer = 0;
  let last = JSON.stringify(state.question.peek());
  effect(() => {
    const now = JSON.stringify(state.question.value);
    const isNew = now !== last;
    last = now;
    const row = state.pair.peek();
    clearTimeout(timer);
    if (isNew && row) timer = setTimeout(() => state.pair.peek() === row && !state.job.peek() && showPair(row), LONGER);
  });
  follow(
    "show",
    () => {
      const drive = state.saved.drive.value;
      if (drive === null) return null;
      const compare = state.saved.compared.value;
      return { ...state.question.value, drive, compare, explain: state.explain.value };
    },
    (answer, sent) => {
      if (sent.drive !== state.saved.drive.peek()) return;
      batch(() => {
        state.view.value = answer.view;
        state.viewedQuestion.value = questionIn(sent);
        state.viewProblem.value = "";
        if (state.autoplay.peek()) state.look.playing.value = true;
        state.autoplay.value = false;
      });
    },
    (reason) => (state.viewProblem.value = reason),
  );
  followFormer();
}

/** Return the question of a request to show a drive, as JSON. */
function questionIn({ draft, set, formula, watches }) {
  return JSON.stringify({ draft, set, formula, watches });
}

/** Say that the view is about a former question once it has been so for a while, or there is none of the present. */
function followFormer() {
  let timer = 0;
  effect(() => {
    const isOther = state.view.value !== null && state.viewedQuestion.value !== JSON.stringify(state.question.value);
    clearTimeout(timer);
    if (!isOther) state.isFormer.value = false;
    else if (state.viewProblem.value) state.isFormer.value = true;
    else timer = setTimeout(() => (state.isFormer.value = true), LONGER);
  });
}
