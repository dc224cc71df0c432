// The page: panes side by side, keys, and the address.

import { effect, html, render, useLayoutEffect, useRef } from "vendor/view";
import { toggle, Viewer } from "viewer/viewer";
import * as actions from "studio/actions";
import { readAddress, writeAddress } from "studio/address";
import { Bar, toggleTheme } from "studio/bar";
import { followEdits } from "studio/live";
import { followSets, Gallery, shippedCards, toGallery } from "studio/gallery";
import { followChanges, redo, undo } from "studio/history";
import { examples } from "studio/recent";
import { start, takeToken } from "studio/server";
import { recall } from "studio/store";
import { addWatch, Side } from "studio/side";
import { followAnswers } from "studio/answers";
import { endTour, startTour, Tour, welcome } from "studio/tour";
import * as state from "studio/state";

const KEYS = [
  ["f", "Find a drive", () => actions.find()],
  ["n", "Next: one that differs clearly", () => actions.find({ next: true })],
  ["w", "Find one without it", () => actions.find({ negated: true })],
  ["p", "Prove", () => actions.prove()],
  ["c", "Compare before and after the edit", () => actions.compare()],
  ["e", "Explain the selected part at the present time", () => actions.explain()],
  ["b", "Keep the text as before", () => actions.keepAsBefore()],
  ["Escape", "Stop what runs", () => actions.stop()],
  [" ", "Play or pause", () => state.view.value && toggle(state.look, state.view.value.drive)],
  ["x", "Save as a page", () => actions.savePage()],
  ["l", "Copy the address", () => actions.copy(location.href)],
  ["u", "Undo", () => undo()],
  ["r", "Redo", () => redo()],
  ["g", "To the gallery", () => toGallery()],
  ["d", "To the definitions", () => document.querySelector(".definitions .cm-content")?.focus()],
  ["q", "To the question", () => document.querySelector(".asked .cm-content")?.focus()],
  ["s", "To the strips", () => document.querySelector(".tree")?.focus()],
  ["a", "Watch another formula", () => addWatch()],
  ["k", "Scene to scale or stretched", () => (state.look.toScale.value = !state.look.toScale.value)],
  ["t", "Light or dark", () => toggleTheme()],
  ["i", "A tour of the page", () => startTour()],
  ["?", "These keys", () => (state.help.value = !state.help.value)],
];
const MORE = [
  ["↑ ↓", "in the strips: select a part"],
  ["← →", "in the strips: fold and unfold"],
  ["Enter, Shift-Enter", "in the strips: to the next switch, to the one before"],
  ["Enter", "in the question: find a drive"],
  ["Escape", "in an editor: leave it"],
  ["Ctrl-Space", "in an editor: names"],
  ["Ctrl-Z, Ctrl-Y", "undo and redo; in an editor, those of its text"],
];

function Help() {
  return state.help.value ? html`<${Keys} />` : null;
}

/** The dialog with the keys; it takes the focus and gives it back. */
function Keys() {
  const main = useRef(null);
  useLayoutEffect(() => {
    const before = document.activeElement;
    main.current.focus();
    return () => before?.isConnected && before.focus();
  }, []);
  const close = () => (state.help.value = false);
  return html`<div class="help" role="dialog" aria-modal="true" aria-label="Keys" onClick=${close}>
    <div class="card">
      <h2>Keys</h2>
      <dl>${[...KEYS.map(([key, text]) => [key === " " ? "Space" : key, text]), ...MORE].map(([key, text]) => html`<dt><kbd>${key}</kbd></dt><dd>${text}</dd>`)}</dl>
      <button ref=${main} onClick=${close}>Close</button> <button onClick=${startTour}>Take the tour</button>
    </div>
  </div>`;
}

function Main() {
  const doc = state.view.value;
  const isFormer = state.isFormer.value;
  const titles = { question: isFormer ? "Former question" : "Question" };
  return html`<main class=${`stage ${isFormer ? "former" : ""}`}>
    ${doc && isFormer
      ? html`<p class="wrong former" role="status">The strips are those of a former question: ${state.viewProblem.value.split("\n")[0] || "the present one is being judged"}</p>`
      : null}
    ${doc
      ? html`<${Viewer} ...${{ doc, look: state.look, titles, theme: state.theme }} />`
      : html`<div class="empty">
          <p>No drive is shown.</p>
          <p class="faint">Choose a scenario, find a drive, or drop a file here.</p>
        </div>`}
  </main>`;
}

function App() {
  return html`<${Bar} /><div class="panes"><${Gallery} /><${Side} /><${Main} /></div><${Help} /><${Tour} />`;
}

function isTyping(target) {
  return target.closest?.(".cm-editor, input[type=text], select, textarea") !== null;
}

/** Return the command of Ctrl-Z or Ctrl-Y outside of editors, which have their own; else null. */
function undoCommand(event) {
  if (!(event.ctrlKey || event.metaKey) || event.altKey || isTyping(event.target)) return null;
  const key = event.key.toLowerCase();
  if (key === "y" || (key === "z" && event.shiftKey)) return redo;
  return key === "z" ? undo : null;
}

function onKey(event) {
  const command = undoCommand(event);
  if (command) {
    event.preventDefault();
    return command();
  }
  if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
  if (isTyping(event.target)) {
    if (event.key === "Escape") event.target.blur();
    return;
  }
  if (event.key === "Escape" && endTour()) return;
  if (event.key === "Escape" && state.help.value) {
    state.help.value = false;
    return;
  }
  if ((event.key === " " || event.key === "Enter") && event.target.closest("button, input")) return;
  const binding = KEYS.find(([key]) => key === event.key);
  if (binding) {
    event.preventDefault();
    binding[2]();
  }
}

function onDrop(event) {
  event.preventDefault();
  actions.open([...event.dataTransfer.files]);
}

async function main() {
  takeToken();
  const storedTheme = recall("theme");
  const dark = storedTheme ? storedTheme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  state.theme.value = dark ? "dark" : "light";
  const content = await start();
  state.drives.value = content.drives;
  state.specs.value = content.specs;
  state.form.value = content.form;
  examples.value = content.examples;
  shippedCards.value = content.cards;
  const addressed = await readAddress();
  if (addressed) state.applyState(addressed);
  else {
    if (content.text) state.saved.text.value = content.text;
    if (content.shows) actions.showFile(content.drives[0].drive);
  }
  const app = document.getElementById("app");
  app.textContent = "";
  render(html`<${App} />`, app);
  document.addEventListener("keydown", onKey);
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", onDrop);
  addEventListener("popstate", async () => state.applyState((await readAddress()) ?? {}));
  followAnswers();
  followAddress();
  followChanges();
  followEdits();
  followSets(!content.shows);
  if (!addressed && content.files.length) actions.openFiles(content.files);
  else if (!addressed) welcome();
  document.documentElement.dataset.ready = "yes";
}

/** Write each change into the address; only a new drive makes a new history entry. */
function followAddress() {
  let timer = 0;
  let last = state.saved.drive.peek();
  effect(() => {
    const data = state.savedData();
    clearTimeout(timer);
    timer = setTimeout(() => {
      writeAddress(data, data.drive !== last && last !== null);
      last = data.drive;
    }, 300);
  });
}

main().catch((error) => {
  const app = document.getElementById("app");
  app.textContent = `The studio cannot be used: ${error.message}`;
});
