// A short tour of the page, shown to newcomers and on request; Escape ends it.

import { html, signal, useEffect, useLayoutEffect, useRef, useState } from "vendor/view";
import { recall, remember } from "studio/store";

// Each step points at the first of its places that is visible.
const STEPS = [
  {
    at: [".gallery .cards", ".gallery-switch"],
    title: "24 scenarios of ISO 34502",
    text: "Click a card: its formula becomes the question, and a drive of it plays at once. Your own files are below.",
  },
  {
    at: [".stage .scene", ".stage"],
    title: "A drive, judged exactly",
    text: "SV is the car under test. Shaded areas are RSS distances. Space plays and pauses; the words below the road explain themselves.",
  },
  {
    at: [".stage .strips", ".stage"],
    title: "When is each part true?",
    text: "Every part of the formula has a strip. Select a part for its meaning and its margin. Press e to see why it is true or false.",
  },
  {
    at: [".bar .asked"],
    title: "Ask your own question",
    text: "Write a formula, then press Enter to find a drive, or p to prove it. While you type, the strips follow.",
  },
  {
    at: [".side .try"],
    title: "Examples and recent questions",
    text: "A click asks an example. Each answer has evidence, its cost, and the command that gives the same.",
  },
  {
    at: [".side .definitions"],
    title: "Change a definition",
    text: "Definitions here replace those of the set. Nothing is lost: u undoes, r redoes. ? lists all keys.",
  },
];
const WIDTH = 320; // pixels of the card
const GAP = 12;

const step = signal(null); // the number of the step that is shown
let focusedBefore = null; // the element that had the focus

export function startTour() {
  focusedBefore = document.activeElement;
  step.value = 0;
}

/** Start the tour for users without a stored mark of it. */
export function welcome() {
  if (!recall("tour")) startTour();
}

/** End the tour for good; return whether it was running. */
export function endTour() {
  if (step.peek() === null) return false;
  step.value = null;
  remember("tour", "seen");
  if (focusedBefore?.isConnected) focusedBefore.focus();
  return true;
}

function isVisible(element) {
  const box = element?.getBoundingClientRect();
  return Boolean(box && box.width && box.height);
}

const placeOf = (number) => STEPS[number].at.map((x) => document.querySelector(x)).find(isVisible);

/** Return the place of a card beside a box: right of it, left of it, or at the bottom of a narrow screen. */
function cardPlace(box, height) {
  if (!box || innerWidth < 2 * WIDTH) return { left: GAP, bottom: GAP, right: GAP };
  const top = Math.max(GAP, Math.min(innerHeight - height - GAP, box.top));
  if (box.right + WIDTH + GAP < innerWidth) return { left: box.right + GAP, top };
  if (box.left - WIDTH - GAP > 0) return { left: box.left - WIDTH - GAP, top };
  const below = box.bottom + GAP + height < innerHeight;
  return { left: Math.max(GAP, innerWidth - WIDTH - GAP), top: below ? box.bottom + GAP : top };
}

const pixels = (places) => Object.fromEntries(Object.entries(places).map(([name, x]) => [name, `${x}px`]));

export function Tour() {
  return step.value === null ? null : html`<${Step} number=${step.value} />`;
}

function Step({ number }) {
  const card = useRef(null);
  const main = useRef(null);
  const [box, setBox] = useState(null);
  useLayoutEffect(() => main.current.focus(), [number]);
  useEffect(() => {
    placeOf(number)?.scrollIntoView({ block: "nearest" });
    const measure = () => {
      const { left, top, right, bottom } = placeOf(number)?.getBoundingClientRect() ?? {};
      setBox((old) => (old && old.left === left && old.top === top && old.right === right && old.bottom === bottom ? old : { left, top, right, bottom }));
    };
    measure();
    const timer = setInterval(measure, 200); // panes grow while answers come
    return () => clearInterval(timer);
  }, [number]);
  const isLast = number === STEPS.length - 1;
  const next = () => (isLast ? endTour() : (step.value = number + 1));
  const back = () => (step.value = Math.max(0, number - 1));
  const onKey = (event) => {
    const act = { Escape: endTour, ArrowRight: next, ArrowLeft: back }[event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  };
  const visible = box?.right > box?.left ? box : null;
  const frame = visible && { left: visible.left, top: visible.top, width: visible.right - visible.left, height: visible.bottom - visible.top };
  const at = cardPlace(visible, card.current?.offsetHeight ?? 180);
  return html`<div class="tour" role="dialog" aria-labelledby="tour-title" aria-describedby="tour-text" onKeyDown=${onKey}>
    ${frame ? html`<div class="frame" style=${pixels(frame)}></div>` : null}
    <div class="card" ref=${card} style=${pixels(at)}>
      <h2 id="tour-title">${STEPS[number].title} <small>${number + 1} of ${STEPS.length}</small></h2>
      <p id="tour-text">${STEPS[number].text}</p>
      <p class="buttons">
        <button onClick=${endTour}>Skip the tour</button>
        <span class="right"></span>
        ${number ? html`<button onClick=${back}>Back</button>` : null}
        <button class="main" ref=${main} onClick=${next}>${isLast ? "Done" : "Next"}</button>
      </p>
    </div>
  </div>`;
}
