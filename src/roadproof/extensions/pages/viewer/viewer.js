// A judged drive on a page: scene, clock, strips, curves. It needs the document alone, and no server.
//
//   import { mount } from "viewer/viewer";
//   mount(element, document_)          // the data of roadproof.extensions.pages.viewer_data

import { html, render, signal, useEffect, useRef, useState } from "vendor/view";
import { Curves } from "viewer/curves";
import { Scene } from "viewer/scene";
import { Strips } from "viewer/strips";
import { Term } from "viewer/terms";
import { Verdict } from "viewer/verdict";

const GUTTER = { least: 130, most: 340, share: 0.42 }; // names left of the clock: pixels, and of the width
const TITLES = { question: "Question", watch: "Watch", before: "Before the edit", after: "After the edit" };

/** What is looked at: the time, the selected part, what is unfolded; signals that a page may share. */
export function makeLook() {
  return {
    time: signal(0),
    playing: signal(false),
    toScale: signal(false),
    selected: signal({ formula: 0, key: "/0", id: 0 }),
    open: signal(new Map()),
  };
}

/** Scene, clock, strips and curves of a document. `titles` are other titles of formulas, by role. */
export function Viewer({ doc, look, titles = {}, theme = null, beside = null }) {
  const drive = doc.drive;
  const place = useRef(null);
  const gutter = useGutter(place);
  useEffect(() => play(look, drive), [drive]);
  return html`<div class="viewer" data-narrow=${gutter < GUTTER.most} ref=${place} style=${{ "--gutter": `${gutter}px` }}>
    <${Scene} ...${{ drive, time: look.time, toScale: look.toScale, theme }} />
    <p class="terms">${["envelope", "gap", "danger"].map((name) => html`<${Term} key=${name} name=${name} />`)}</p>
    <${Clock} ...${{ drive, look }} />
    <div class="below">
      <${Playhead} ...${{ drive, look }} />
      ${doc.formulas.map(
        (formula, index) => html`<${Strips}
          key=${`${index}-${formula.role}`}
          ...${{ formula, index, drive, look }}
          beside=${formula.role === "question" ? doc.formulas.find((x) => x.role === "before") : null}
          title=${titleOf(formula, titles)}
        />`,
      )}
      <${Curves} ...${{ doc, look, gutter, theme }} />
    </div>
    ${beside}
  </div>`;
}

/** How many pixels of the width of an element names have. */
function useGutter(place) {
  const [gutter, set] = useState(GUTTER.most);
  useEffect(() => {
    const measure = () => {
      const wanted = Math.round(place.current.clientWidth * GUTTER.share);
      set(Math.max(GUTTER.least, Math.min(GUTTER.most, wanted)));
    };
    measure();
    const watching = new ResizeObserver(measure);
    watching.observe(place.current);
    return () => watching.disconnect();
  }, []);
  return gutter;
}

function titleOf(formula, titles) {
  const said = titles[formula.role] ?? TITLES[formula.role] ?? formula.role;
  return formula.role === "watch" ? `${said}: ${formula.formula}` : said;
}

function Playhead({ drive, look }) {
  const share = look.time.value / drive.horizon;
  const style = { left: `calc(var(--gutter) + (100% - var(--gutter) - 14px) * ${share})` };
  return html`<div class="playhead" style=${style} aria-hidden="true"></div>`;
}

/** Playback, the time, and a scrubber that lies above the strips. */
export function Clock({ drive, look }) {
  const set = (event) => {
    look.playing.value = false;
    look.time.value = Number(event.target.value);
  };
  const danger = drive.dangers[0];
  return html`<div class="clock">
    <div class="controls">
      <button class="play" aria-label=${look.playing.value ? "Pause" : "Play"} title="Space" onClick=${() => toggle(look, drive)}>
        ${look.playing.value ? "❚❚" : "▶"}
      </button>
      <output>${look.time.value.toFixed(2)} s</output>
      <label class="scale"><input type="checkbox" checked=${look.toScale.value} onChange=${(e) => (look.toScale.value = e.target.checked)} /> to scale</label>
      ${danger
        ? html`<button class="danger" title="Jump to where danger begins" onClick=${() => (look.time.value = danger.begins)}>danger at ${danger.begins.toFixed(2)} s</button>`
        : null}
    </div>
    <input class="scrubber" type="range" aria-label="Time" min="0" max=${drive.horizon} step="any" value=${look.time.value} onInput=${set} />
  </div>`;
}

/** Begin or end playback; at the end it begins again. */
export function toggle(look, drive) {
  if (!look.playing.value && look.time.value >= drive.horizon) look.time.value = 0;
  look.playing.value = !look.playing.value;
}

function play(look, drive) {
  let last = null;
  let frame = 0;
  const step = (now) => {
    if (!look.playing.value) {
      last = null;
      return;
    }
    if (last !== null) look.time.value = Math.min(drive.horizon, look.time.value + (now - last) / 1000);
    last = now;
    if (look.time.value >= drive.horizon) look.playing.value = false;
    else frame = requestAnimationFrame(step);
  };
  const stop = look.playing.subscribe((on) => {
    cancelAnimationFrame(frame);
    if (on) frame = requestAnimationFrame(step);
  });
  return () => {
    stop();
    cancelAnimationFrame(frame);
  };
}

/** The viewer for one document, in an element of a page of its own. */
export function mount(element, doc) {
  const look = makeLook();
  const beside = doc.verdict?.verdict ? html`<${Verdict} answer=${doc.verdict} />` : null;
  render(html`<${Viewer} ...${{ doc, look, beside }} />`, element);
  return look;
}
