// Keeps the answers of a tab when its page is loaded again. Another tab has its own.

import { effect } from "vendor/view";
import * as state from "studio/state";
import { recallInTab, rememberInTab } from "studio/store";

const NAME = "answers";
export const MOST = 6;

/** Put back the answers from before the page was loaded, then keep each new one. */
export function followAnswers() {
  state.answers.value = validAnswers(recallInTab(NAME, []));
  effect(() => keep(state.answers.value));
}

/** Return the valid entries of a stored list: anything may be in the storage of a browser. */
function validAnswers(list) {
  const isOurs = (x) => typeof x?.verdict === "string" && typeof x.formula === "string" && typeof x.key === "number";
  return (Array.isArray(list) ? list : []).filter(isOurs).slice(0, MOST);
}

/** Store answers without views, which are asked for again; the oldest ones are left out where there is no room. */
function keep(answers) {
  const plain = answers.map(({ view, marks, ...rest }) => rest);
  for (let count = plain.length; count >= 0; count -= 1) {
    if (rememberInTab(NAME, plain.slice(0, count))) return;
  }
}
