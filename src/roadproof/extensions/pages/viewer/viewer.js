// The viewer of a judged drive: scene, clock, strips and curves. It needs only the document, and no server.
//
//   import { mount } from "viewer/viewer";
//   mount(element, document_)          // the data of roadproof.extensions.pages.viewer_data

import { html, render, signal, useEffect, useRef, useState } from "vendor/view";
import { Curves } from "viewer/curves";
import { Scene } from "viewer/scene";
import { Strips } from "viewer/strips";
import { Term } from "viewer/terms";
import { Verdict } from "viewer/verdict";

const GUTTER = { least: 130, most: 340, share: 0.42 }; // width of the names left of the time axis: px, and share of the whole
const TITLES = { question: "Question", watch: "Watch", before: "Before the edit", after: "After the edit" };

/** Return the signals of a view: the time, the selected part, the unfolded parts; a page may share them. */
export function makeLook() {
  return {
    time: signal(0),
    playing: signal(false),
    toScale: signal(false),
    selected: signal({ formula: 0, key: "/0", id: 0 }),
    open: signal(new Map()),
  };
}

/** The viewer of a document. `titles`: titles of formulas by role; `footer`: content below. */
export function Viewer({ doc, look, titles = {}, theme = null, footer = null }) {
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
          reference=${formula.role === "question" ? doc.formulas.find((x) => x.role === "before") : null}
          title=${titleOf(formula, titles)}
        />`,
      )}
      <${Curves} ...${{ doc, look, gutter, theme }} />
    </div>
    ${footer}
  </div>`;
}

/** Return the width of the names in px, which follows the width of an element. */
function useGutter(place) {
  const [gutter, set] = useState(GUTTER.most);
  useEffect(() => {
    const measure = () => {
      const width = Math.round(place.current.clientWidth * GUTTER.share);
      set(Math.max(GUTTER.least, Math.min(GUTTER.most, width)));
    };
    measure();
    const watching = new ResizeObserver(measure);
    watching.observe(place.current);
    return () => watching.disconnect();
  }, []);
  return gutter;
}

function titleOf(formula, titles) {
  const title = titles[formula.role] ?? TITLES[formula.role] ?? formula.role;
  return formula.role === "before" || formula.role === "after" ? title : `${title}: ${formula.text ?? formula.formula}`;
}

function Playhead({ drive, look }) {
  const share = look.time.value / drive.horizon;
  const style = { left: `calc(var(--gutter) + (100% - var(--gutter) - 14px) * ${share})` };
  return html`<div class="playhead" style=${style} aria-hidden="true"></div>`;
}

/** The controls of playback, the time, and a scrubber above the strips. */
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

/** Start or pause playback; at the end it restarts. */
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

/** Show the viewer of a document in an element; return its signals. */
export function mount(element, doc) {
  const look = makeLook();
  const footer = doc.verdict?.verdict ? html`<${Verdict} answer=${doc.verdict} />` : null;
  render(html`<${Viewer} ...${{ doc, look, footer }} />`, element);
  return look;
}
