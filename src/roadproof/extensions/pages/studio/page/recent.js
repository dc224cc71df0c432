// Recent questions with their verdicts, stored in the browser, and examples.

import { html, signal } from "vendor/view";
import { toneOf } from "viewer/verdict";
import * as actions from "studio/actions";
import { inOneStep } from "studio/history";
import * as state from "studio/state";
import { recall, remember } from "studio/store";

const MOST = 12;
const LONGEST = 20_000; // characters of definitions that are stored with a question
const FIELDS = ["formula", "base", "text", "options", "params"];
const JOBS = ["find", "without", "prove"];

export const examples = signal([]);
const recent = signal(validEntries(recall("recent", [])));

/** Return the valid entries of a stored list: anything may be in the storage of a browser. */
function validEntries(list) {
  const isOurs = (x) => typeof x?.formula === "string" && typeof x.verdict === "string" && JOBS.includes(x.job);
  return (Array.isArray(list) ? list : []).filter(isOurs).slice(0, MOST);
}

/** Return the present question, to be stored with its verdict later. */
export function currentQuestion(job) {
  const saved = Object.fromEntries(FIELDS.map((name) => [name, state.saved[name].peek()]));
  return { job, ...saved, text: saved.text.length > LONGEST ? null : saved.text };
}

/** Store an answered question; equal ones are stored once. */
export function storeQuestion(question, verdict) {
  const same = (x) => JSON.stringify({ ...x, verdict: "" }) === JSON.stringify({ ...question, verdict: "" });
  recent.value = [{ ...question, verdict }, ...recent.value.filter((x) => !same(x))].slice(0, MOST);
  remember("recent", recent.value);
}

function restore(question) {
  inOneStep(() => {
    actions.setQuestion(question.formula);
    const { text, base, options, params } = question;
    state.applyState({ base, options, params, ...(text === null ? {} : { text }) });
  });
}

/** The pane with examples and recent questions. */
export function Try() {
  const isPlain = !state.saved.text.value.trim() && state.saved.base.value === "base";
  const askExample = (x) => {
    inOneStep(() => actions.setQuestion(x.formula));
    if (x.job === "prove") actions.prove();
    else actions.find();
  };
  const forget = () => {
    recent.value = [];
    remember("recent", []);
  };
  return html`<section class="pane try" aria-label="Examples and recent questions">
    ${recent.value.length
      ? html`<h2>Recent questions <span class="right"><button onClick=${forget}>Forget</button></span></h2>
          <ul class="recent">${recent.value.map(
            (x) => html`<li><button title="Put this question back" onClick=${() => restore(x)}>
              <${Word} verdict=${x.verdict} /><span class="what">${x.job}</span><code>${x.formula}</code>${x.text?.trim() ? html`<small>with definitions</small>` : null}
            </button></li>`,
          )}</ul>`
      : null}
    <h2>Examples <small>click one to ask it</small></h2>
    <ul class="examples">${examples.value.map(
      (x) => html`<li><button title=${`${x.job === "prove" ? "Prove" : "Find a drive for"} ${x.formula}`} onClick=${() => askExample(x)}>
        ${isPlain ? html`<${Word} verdict=${x.verdict} />` : null}<span>${x.title}</span><code>${x.formula}</code>
      </button></li>`,
    )}</ul>
  </section>`;
}

function Word({ verdict }) {
  return html`<span class=${`word ${toneOf(verdict)}`}>${verdict}</span>`;
}
