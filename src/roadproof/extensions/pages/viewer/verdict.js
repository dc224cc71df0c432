// An answer: its verdict with an explanation, the reason, and downloads.

import { html } from "vendor/view";

const PROMISES = {
  PROVED: "True on every trace, for all time, on every road, and for all parameters within their bounds. The certificate shows it.",
  "PROVED-BOUNDED": "No counterexample up to a horizon, on a grid, within limits.",
  REFUTED: "There is a counterexample, judged exactly.",
  VACUOUS: "True, but only because its premise never holds.",
  WITNESSED: "The formula holds on this drive: judged exactly, in dense and unbounded time.",
  IMPOSSIBLE: "No trace satisfies the formula: proved for all time, on every road. The certificate shows it.",
  "NONE-WITHIN": "No drive was found, and within the limits below there is none.",
  UNKNOWN: "Nothing is promised; the reason is below.",
  JUDGED: "Judged exactly on the drive that is shown, in dense and unbounded time.",
};
const TONES = {
  PROVED: "yes",
  WITNESSED: "yes",
  REFUTED: "no",
  IMPOSSIBLE: "no",
  VACUOUS: "no",
  UNKNOWN: "open",
  "NONE-WITHIN": "open",
  "PROVED-BOUNDED": "open",
};

/** Return the colour class of a verdict: yes, no, open, or "". */
export const toneOf = (verdict) => TONES[verdict] ?? "";

/**
 * One answer. `downloads`: {name, content} with texts; `onCopy` copies a text; `shows`: {name, show} of its
 * drives; `cost`: its cost in words; `onAgain` computes it again.
 */
export function Verdict({ answer, downloads = [], onCopy = null, shows = [], cost = "", onAgain = null }) {
  if (!answer) return null;
  return html`<section class=${`verdict ${toneOf(answer.verdict)}`} aria-label="Verdict" aria-live="polite">
    <h3><span class="word">${answer.verdict}</span> <code class="claim">${answer.formula}</code></h3>
    <p>${answer.promise ?? PROMISES[answer.verdict] ?? ""}</p>
    ${answer.assuming?.length ? html`<p>At ${answer.assuming.join(", ")}.</p>` : null}
    ${answer.reason ? html`<p class="reason">${answer.reason}</p>` : null}
    ${answer.core?.length
      ? html`<p>These parts clash:</p>
          <ul class="core">${answer.core.map((x) => html`<li><code>${x}</code></li>`)}</ul>`
      : null}
    ${cost
      ? html`<p class="cost"><span>${cost}</span>${onAgain ? html`<button onClick=${onAgain}>Compute again</button>` : null}</p>`
      : null}
    ${answer.command
      ? html`<p class="command"><code>${answer.command}</code>${onCopy ? html`<button onClick=${() => onCopy(answer.command)}>Copy</button>` : null}</p>`
      : null}
    ${downloads.length || shows.length
      ? html`<p class="downloads">${shows.map((x) => html`<button onClick=${x.show}>${x.name}</button>`)}${downloads.map((x) => html`<button onClick=${() => save(x)}>↓ ${x.name}</button>`)}</p>`
      : null}
  </section>`;
}

/** Save a text as a file of the browser. */
export function save({ name, content, kind = "application/json" }) {
  const link = document.createElement("a");
  const url = URL.createObjectURL(new Blob([content], { type: kind }));
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
