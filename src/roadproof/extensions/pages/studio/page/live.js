// Each edit is read and judged again, one question at a time and always the latest.

import { batch, effect } from "vendor/view";
import { showPair } from "studio/actions";
import { ask } from "studio/server";
import * as state from "studio/state";

const PATIENCE = 25; // ms after the last key
const LONGER = 500; // the same, for what nobody waits for, and where a recording is read again

/** Ask `kind` whenever `question` changes; `take` gets the latest answer, `fail` why there is none. */
function follow(kind, question, take, fail, patience = PATIENCE) {
  let wanted = null;
  let busy = false;
  let timer = 0;
  const next = async () => {
    if (busy || wanted === null) return;
    busy = true;
    const asked = wanted;
    wanted = null;
    try {
      const told = await ask(kind, asked);
      if (wanted === null) {
        if (told.error) fail(told.error);
        else take(told.answer, asked);
      }
    } catch (error) {
      fail(error.message);
    }
    busy = false;
    next();
  };
  let isFirst = true;
  effect(() => {
    wanted = question();
    clearTimeout(timer);
    timer = setTimeout(next, isFirst ? 0 : patience);
    isFirst = false;
  });
}

/** Begin: mistakes, names and strips follow what is typed. */
export function followEdits() {
  follow(
    "read",
    () => {
      const { draft, set, formula } = state.question.value;
      const watches = Object.fromEntries(state.kept.watches.value.map((x, k) => [`watch ${k + 1}`, x]));
      const said = Object.fromEntries(Object.entries(watches).filter(([, x]) => x.trim()));
      return { draft, set, formulas: { formula, ...said } };
    },
    (answer) => {
      state.mistakes.value = answer.mistakes;
      state.about.value = answer.formulas;
    },
    (reason) => (state.trouble.value = reason),
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
      const drive = state.kept.drive.value;
      if (drive === null) return null;
      const compare = state.kept.compared.value;
      return { ...state.question.value, drive, compare, explain: state.explain.value };
    },
    (answer, asked) => {
      if (asked.drive !== state.kept.drive.peek()) return;
      batch(() => {
        state.view.value = answer.view;
        if (state.plays.peek()) state.look.playing.value = true;
        state.plays.value = false;
      });
    },
    () => {},
  );
}
