// The gallery at the left: scenarios with small pictures, and the user's files; a drawer on narrow screens.

import { effect, html, signal, useRef } from "vendor/view";
import * as actions from "studio/actions";
import { forgetSteps, inOneStep } from "studio/history";
import { Picture } from "studio/picture";
import { ask } from "studio/server";
import * as state from "studio/state";
import { recall, remember } from "studio/store";

const WIDE = 1180; // px of the window from which the gallery fits beside the other panes
const SHARE = 4; // scenarios in one request
const FIRST = 1;

const cards = signal(new Map()); // of the chosen set, by number
export const shippedCards = signal({}); // words and pictures by set, there before the server has read it
const playing = signal(null); // the number of the card that plays
export const isOpen = signal(isBeside() && recall("gallery", true));

function isBeside() {
  return matchMedia(`(min-width: ${WIDE}px)`).matches;
}

/** Show or hide the gallery; as a drawer it takes the focus, and gives it back. */
export function toggleGallery() {
  isOpen.value = !isOpen.value;
  if (isBeside()) remember("gallery", isOpen.value);
  if (isOpen.value) requestAnimationFrame(focusGallery);
  else document.querySelector(".bar .gallery-switch")?.focus();
}

function focusGallery() {
  document.querySelector(".gallery .card[tabindex='0']")?.focus();
}

/** Focus the current card, for the keyboard. */
export function toGallery() {
  if (isOpen.value) focusGallery();
  else toggleGallery();
}

/** Load some cards of a set, if it is still the chosen one. */
async function load(set, numbers) {
  const isChosen = () => set === state.saved.base.peek();
  if (!numbers.length || !isChosen()) return;
  const reply = await ask("gallery", { draft: { base: set }, scenarios: numbers }).catch(() => ({}));
  if (!reply.answer || !isChosen()) return;
  const loaded = reply.answer.cards.map((x) => [x.number, { ...cards.peek().get(x.number), ...x }]);
  cards.value = new Map([...cards.value, ...loaded]);
}

/** Load the cards of the chosen set, now and whenever another is chosen; `play`: start with scenario 1. */
export function followSets(play) {
  let isFirst = play;
  effect(() => {
    const set = state.saved.base.value;
    cards.value = new Map(shippedOf(set).map((x) => [x.number, { number: x.number, picture: x.picture }]));
    const loadAll = async () => {
      await load(set, [FIRST]);
      if (isFirst && isUntouched() && cards.peek().get(FIRST)?.drive) {
        await show(FIRST);
        forgetSteps();
      }
      isFirst = false;
      const rest = numbersOf(await state.whenNamesKnown()).filter((x) => x !== FIRST);
      for (let k = 0; k < rest.length; k += SHARE) await load(set, rest.slice(k, k + SHARE));
    };
    loadAll();
  });
}

/** Return the words and pictures of a set that come with the page. */
function shippedOf(set) {
  return shippedCards.peek()[set] ?? [];
}

function isUntouched() {
  const { drive, text, formula } = state.saved;
  const isBlank = drive.peek() === null && text.peek() === "" && formula.peek() === state.FIRST_QUESTION;
  return isBlank && state.view.peek() === null && !state.job.peek();
}

const numbersOf = (names) => names.scenarios.map((x) => x.number);

/** Make a scenario the question, and show its known drive, or else search for one. */
async function show(number) {
  if (!cards.peek().get(number)?.formula) await load(state.saved.base.peek(), [number]);
  const card = cards.peek().get(number);
  inOneStep(() => {
    actions.setQuestion(card?.formula ?? String(number));
    if (card?.drive) actions.showFile(card.drive, null, { play: true });
  });
  if (!card?.drive) actions.find();
  if (!isBeside()) isOpen.value = false;
}

export function Gallery() {
  if (!isOpen.value) return null;
  const scenarios = state.names.value?.scenarios ?? shippedCards.value[state.saved.base.value] ?? [];
  const close = () => !isBeside() && toggleGallery();
  const onKey = (event) => {
    if (event.key === "Escape" && !isBeside()) {
      event.stopPropagation();
      toggleGallery();
    }
  };
  return html`<div class="drawer" onKeyDown=${onKey}>
    <div class="behind" onClick=${close}></div>
    <nav class="gallery" id="gallery" aria-label="Gallery">
      <h2>Scenarios <small>click to play</small>
        <span class="right"><button class="icon" aria-label="Hide the gallery" title="Hide the gallery" onClick=${toggleGallery}>×</button></span>
      </h2>
      ${scenarios.length ? html`<${Cards} ...${{ scenarios }} />` : html`<p class="faint">The scenarios are being read …</p>`}
      <${Files} />
    </nav>
  </div>`;
}

/** The cards by road sector. The Tab key reaches one of them; arrows move to the others. */
function Cards({ scenarios }) {
  const list = useRef(null);
  const sectors = [...new Set(scenarios.map((x) => x.sector))];
  const shown = scenarioShown(scenarios);
  const onKey = (event) => {
    const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[event.key];
    const all = [...list.current.querySelectorAll("details[open] .card")];
    const at = all.indexOf(event.target);
    if (!step || at < 0) return;
    event.preventDefault();
    all[Math.max(0, Math.min(all.length - 1, at + step))].focus();
  };
  return html`<div class="cards" ref=${list} onKeyDown=${onKey}>
    ${sectors.map((sector) => html`<details open key=${sector}>
      <summary>${sector || "your scenarios"}</summary>
      ${scenarios
        .filter((x) => x.sector === sector)
        .map((x) => html`<${Card} key=${x.number} words=${x} isShown=${x.number === shown} isFirst=${x.number === (playing.value ?? shown ?? FIRST)} />`)}
    </details>`)}
  </div>`;
}

/** Return the number of the scenario that the question is, null for other questions. */
function scenarioShown(scenarios) {
  const text = state.descriptions.value.formula?.text ?? state.saved.formula.value;
  const number = Number(/^scenario_(\d+)\(SV, ?POV\w*, ?/.exec(text)?.[1] ?? text);
  return scenarios.some((x) => x.number === number) ? number : null;
}

function Card({ words, isShown, isFirst }) {
  const { number, title, sector, sentence } = words;
  const [what, ...rest] = title.split(", ");
  const picture = cards.value.get(number)?.picture;
  const touch = (on) => () => {
    if (on) playing.value = number;
    else if (playing.value === number) playing.value = null;
  };
  return html`<button class="card" title=${sentence} tabindex=${isFirst ? 0 : -1} aria-current=${isShown ? "true" : undefined}
    aria-label=${`Scenario ${number}: ${title}, ${sector}`} onClick=${() => show(number)}
    onMouseEnter=${touch(true)} onMouseLeave=${touch(false)} onFocus=${touch(true)} onBlur=${touch(false)}>
    <span class="look">${picture
      ? html`<${Picture} drive=${picture} playing=${playing.value === number && !state.prefersReducedMotion()} />`
      : html`<span class="blank"></span>`}</span>
    <span class="words"><b>${number}</b> ${what}<small>${rest.join(", ")}</small></span>
  </button>`;
}

/** The list of files: those that the studio was started with, and dropped ones. */
function Files() {
  const { drives, specs } = state;
  const total = drives.value.length + specs.value.length;
  const shown = JSON.stringify(state.saved.drive.value);
  return html`<details class="files" open>
    <summary>your files <small>${total || "none"}</small></summary>
    ${total ? null : html`<p class="faint">Drop drives, definitions or recordings on the page, or start <code>roadproof studio FOLDER</code>.</p>`}
    <ul class="specs">${specs.value.map(
      (x) => html`<li><button title="Put these definitions into the editor" aria-pressed=${x.text === state.saved.text.value} onClick=${() => actions.loadDefinitions(x.text)}>${x.name}</button></li>`,
    )}</ul>
    <ul class="drives">${drives.value.map(
      (x) => html`<li><button aria-pressed=${JSON.stringify(x.drive) === shown} title=${x.drive.formula ?? ""} onClick=${() => actions.showFile(x.drive)}>${x.name}</button></li>`,
    )}</ul>
  </details>`;
}
