// The left side: definitions, watched formulas, answers.

import { html, useEffect, useRef } from "vendor/view";
import { Verdict } from "viewer/verdict";
import * as actions from "studio/actions";
import { Editor } from "studio/editor";
import { Try } from "studio/recent";
import * as state from "studio/state";

export function Side() {
  const { saved } = state;
  const wrong = state.mistakes.value.filter((x) => x.where === "definitions");
  const answers = useRef(null);
  const newest = state.answers.value[0]?.key;
  useEffect(() => {
    if (newest) answers.current.scrollIntoView({ block: "nearest" });
  }, [newest]);
  return html`<aside class="side">
    <section class="pane definitions" aria-label="Definitions">
      <h2>Definitions <small>set <code>edit</code> on top of <code>${saved.base.value}</code></small>
        <span class="right">
          ${saved.before.value === null
            ? html`<button title="b: what the next edit is compared with" onClick=${actions.keepAsBefore}>Keep as before</button>`
            : html`<button title="Compare with the set below again" onClick=${actions.forgetBefore}>Forget before</button>`}
        </span>
      </h2>
      <${Editor} where="definitions" label="Definitions" read=${() => saved.text.value}
        hint=${"def danger(a, b: vehicle) \"what replaces the definition of the set\"\n  := …"}
        onChange=${actions.setDefinitions} />
      ${wrong.length
        ? html`<ul class="mistakes" role="alert">
            ${wrong.map((x) => html`<li><b>${x.at ? x.at[0].join(":") : ""}</b> ${x.message} <span class="faint">${x.hint}</span></li>`)}
          </ul>`
        : null}
    </section>
    <${Readings} />
    <section class="pane watch" aria-label="Watch">
      <h2>Watch <span class="right"><button onClick=${addWatch}>Add</button></span></h2>
      ${saved.watches.value.map((_, k) => html`<${WatchLine} key=${k} ...${{ k }} />`)}
      ${saved.watches.value.length ? null : html`<p class="faint">Any formula typed here gets a strip on the drive that is shown.</p>`}
    </section>
    <${Recording} />
    <section class="pane answers" aria-label="Answers" ref=${answers}>
      <h2>Answers</h2>
      ${state.answers.value.map(
        (x) => html`<${Verdict} key=${x.key} answer=${x} downloads=${downloadsOf(x)} onCopy=${actions.copy}
          shows=${showsOf(x)} cost=${costOf(x)} onAgain=${x.cost?.known && x.job ? () => actions.again(x) : null} />`,
      )}
      ${state.answers.value.length ? null : html`<p class="faint">None yet: press Find a drive.</p>`}
    </section>
    <${Try} />
  </aside>`;
}

/** Readings and parameter values, folded at first. */
function Readings() {
  const { options, params } = state.saved;
  const known = state.names.value;
  if (!known) return null;
  const set = (values, name, value) => {
    const next = { ...values.value };
    if (value) next[name] = value;
    else delete next[name];
    values.value = next;
  };
  const wrong = state.mistakes.value.find((x) => x.where === "parameters");
  const changed = [...Object.entries(options.value), ...Object.entries(params.value)];
  return html`<details class="pane readings">
    <summary>Parameters and readings <small>${changed.map(([name, value]) => `${name} = ${value}`).join(", ")}</small></summary>
    ${wrong ? html`<p class="wrong">${wrong.message}</p>` : null}
    <dl>
      ${known.parameters.map(
        (x) => html`<dt title=${x.doc}>${x.name}</dt>
          <dd><input type="text" aria-label=${x.name} placeholder=${x.value} value=${params.value[x.name] ?? ""} onChange=${(e) => set(params, x.name, e.target.value.trim())} /></dd>`,
      )}
      ${known.options.map(
        (x) => html`<dt title=${x.doc}>${x.name}</dt>
          <dd><select aria-label=${x.name} value=${options.value[x.name] ?? x.values[0]} onChange=${(e) => set(options, x.name, e.target.value === x.values[0] ? "" : e.target.value)}>${x.values.map((y) => html`<option>${y}</option>`)}</select></dd>`,
      )}
    </dl>
  </details>`;
}

/** The pairs of a recording on which danger arises, with the matching scenarios. */
function Recording() {
  const recording = state.recording.value;
  if (!recording) return null;
  const scenariosOf = (row) => {
    const same = (m) =>
      String(m.recording) === String(row.recording) &&
      m.minDanger === row.minDanger &&
      [m.SV, m.POV].sort().join() === [row.first, row.second].sort().join();
    return recording.matches.filter(same);
  };
  const rows = recording.pairs.map((row) => ({ row, matches: scenariosOf(row) }));
  rows.sort((a, b) => b.matches.length - a.matches.length); // equal ones stay in order
  const matching = rows.filter((x) => x.matches.length).length;
  return html`<section class="pane recording" aria-label="Recording">
    <h2>Recording <small>${rows.length} traces on which danger arises; ${matching} match a scenario, these first</small>
      <span class="right"><button aria-label="Close the recording" onClick=${() => (state.recording.value = null)}>×</button></span>
    </h2>
    <div class="table"><table>
      <thead><tr><th>vehicles</th><th>frames</th><th>minDanger</th><th>scenarios</th></tr></thead>
      <tbody>${rows.map(({ row, matches }) => {
        const show = (sv, pov, number) => actions.showPair({ ...row, vehicles: [sv, pov] }, number);
        return html`<tr>
          <td><button onClick=${() => show(row.first, row.second)}>${row.first}, ${row.second}</button></td>
          <td>${row.first_frame}–${row.last_frame}</td>
          <td>${row.minDanger} s</td>
          <td>${matches.map((m) => html`<button title=${`SV ${m.SV}, POV ${m.POV}`} onClick=${() => show(m.SV, m.POV, m.scenario)}>${m.scenario}</button>`)}</td>
        </tr>`;
      })}</tbody>
    </table></div>
  </section>`;
}

function WatchLine({ k }) {
  const { saved } = state;
  const wrong = state.mistakes.value.find((x) => x.where === `watch ${k + 1}`);
  const change = (value) => {
    state.saved.watches.value = state.saved.watches.value.map((x, n) => (n === k ? value : x));
  };
  const remove = () => {
    state.saved.watches.value = state.saved.watches.value.filter((_, n) => n !== k);
  };
  return html`<div class="watched">
    <${Editor} where=${`watch ${k + 1}`} label=${`Watched formula ${k + 1}`} line=${true} read=${() => saved.watches.value[k] ?? ""} onChange=${change} hint="v_lon(SV) > 100 km/h" takesFocus=${(saved.watches.value[k] ?? "") === ""} />
    <button aria-label="Remove" onClick=${remove}>×</button>
    ${wrong ? html`<p class="wrong">${wrong.message}</p>` : null}
  </div>`;
}

export function addWatch() {
  state.saved.watches.value = [...state.saved.watches.value, ""];
}

const drivesOf = (answer) => answer.drives ?? (answer.drive ? [answer.drive] : []);

/** Return buttons that show the drives of an answer; its view is that of the last drive. */
function showsOf(answer) {
  const isCompared = answer.sets !== undefined;
  return drivesOf(answer).map((drive, k, { length }) => ({
    name: length > 1 ? `Show ${k + 1}` : "Show",
    show: () => actions.showDrive(drive, length === 1 || k === length - 1 ? answer.view : null, isCompared),
  }));
}

/** Return the cost of an answer in words: now, and when it was computed. */
function costOf({ cost, cpu, seconds }) {
  if (cpu === undefined || seconds === undefined) return "";
  const parts = [`${shownSeconds(seconds)} (processor ${shownSeconds(cpu)})`];
  if (cost?.known) parts.push(`known: ${KNOWN[cost.known]}`);
  if (cost?.known && cost.seconds > 0) parts.push(`computed in ${shownSeconds(cost.seconds)} then`);
  if (cost?.effort) parts.push(`${shownNumber(cost.effort)} units of effort`);
  return parts.join(" · ");
}

const KNOWN = { shipped: "shipped with roadproof", cache: "of an earlier run of yours" };
const shownNumber = (x) => (x < 10 ? x.toFixed(2) : x.toFixed(0));
const shownSeconds = (x) => `${shownNumber(x)} s`;

function downloadsOf(answer) {
  const made = drivesOf(answer).map((drive, k, { length }) => ({
    name: length > 1 ? `drive-${k + 1}.json` : "drive.json",
    content: text(drive),
  }));
  if (answer.certificate) made.push({ name: "certificate.json", content: text(answer.certificate) });
  if (answer.command?.includes("edit.spec") && answer.spec) {
    made.push({ name: "edit.spec", content: answer.spec, kind: "text/plain" });
  }
  return made;
}

const text = (data) => `${JSON.stringify(data, null, 2)}\n`;
