// The bar at the top: the question, and the actions on it.

import { html } from "vendor/view";
import * as actions from "studio/actions";
import { Editor } from "studio/editor";
import { isOpen, toggleGallery } from "studio/gallery";
import { canRedo, canUndo, redo, undo } from "studio/history";
import * as state from "studio/state";
import { remember } from "studio/store";

// The options of a job, as the server describes them: a choice of words, or a checkbox.
function Options({ job }) {
  return state.form.value.filter((x) => x.job === job).map((x) => {
    const value = state.optionValue(x);
    const set = (chosen) => (state.saved.settings.value = { ...state.saved.settings.value, [x.name]: chosen });
    return x.choices
      ? html`<select aria-label=${x.name} title=${x.help} value=${value} onChange=${(e) => set(e.target.value)}>
          ${x.choices.map((choice) => html`<option>${choice}</option>`)}
        </select>`
      : html`<label title=${x.help}><input type="checkbox" checked=${value} onChange=${(e) => set(e.target.checked)} /> ${x.name}</label>`;
  });
}

export function Bar() {
  const { saved, names, descriptions, job } = state;
  const description = descriptions.value.formula;
  const wrong = state.mistakes.value.find((x) => x.where === "formula");
  return html`<header class="bar">
    <div class="first">
      <button class="gallery-switch" title="g" aria-expanded=${isOpen.value} aria-controls="gallery" onClick=${toggleGallery}>☰ Gallery</button>
      <h1>roadproof studio</h1>
      <label>on top of
        <select aria-label="Spec set" value=${saved.base.value} onChange=${(e) => (saved.base.value = e.target.value)}>
          ${(names.value?.sets ?? [{ name: saved.base.value }])
            .filter((x) => !["edit", "before"].includes(x.name))
            .map((x) => html`<option value=${x.name} title=${x.doc}>${x.name}</option>`)}
        </select>
      </label>
      <div class="asked">
        <${Editor} where="formula" label="Question" line=${true} read=${() => saved.formula.value} hint="a formula, or a scenario's number"
          onChange=${actions.setQuestion} onEnter=${() => actions.find()} />
      </div>
      <span class="steps">
        <button class="icon" title="Undo (u, Ctrl-Z)" aria-label="Undo" disabled=${!canUndo.value} onClick=${undo}>↶</button>
        <button class="icon" title="Redo (r, Ctrl-Y)" aria-label="Redo" disabled=${!canRedo.value} onClick=${redo}>↷</button>
      </span>
      <button title="l: the address holds everything" onClick=${() => actions.copy(location.href)}>Copy link</button>
      <button title="x: one file that needs no server" onClick=${() => actions.savePage()}>Save page</button>
      <button class="icon" title="Light or dark" aria-label="Light or dark" onClick=${toggleTheme}>◐</button>
      <button class="icon" title="Keys (?)" aria-label="Keys" onClick=${() => (state.help.value = true)}>?</button>
    </div>
    <div class="second">
      <div class="called" title=${wrong ? `${wrong.message} ${wrong.hint}` : (description?.sentence ?? "")}>
        ${wrong ? html`<span class="wrong">${wrong.message}</span> <span class="faint">${wrong.hint}</span>` : html`<b>${description?.name ?? ""}</b> ${description?.sentence ?? ""}`}
      </div>
      <div class="buttons">
        <button class="main" title="f" onClick=${() => actions.find()}>Find a drive</button>
        <${Options} job="find" />
        <button title="n" onClick=${() => actions.find({ next: true })}>Next</button>
        <button title="w" onClick=${() => actions.find({ negated: true })}>Find one without it</button>
        <button title="p" onClick=${() => actions.prove()}>Prove</button>
        <${Options} job="prove" />
        <button title="c" onClick=${() => actions.compare()}>Compare</button>
        <button title="e" aria-pressed=${state.explain.value !== null} onClick=${() => actions.explain()}>Explain</button>
      </div>
    </div>
    <div class="third" aria-live="polite">
      ${job.value
        ? html`<span class="spinner" aria-hidden="true"></span><b>${job.value.title}</b> <span>${job.value.stage}</span>
            <span class="seconds">${job.value.seconds.toFixed(1)} s</span>
            <button class="stop" title="Esc" onClick=${() => actions.stop()}>Stop</button>`
        : state.errorText.value
          ? html`<span class="wrong" role="alert">${state.errorText.value}</span>`
          : html`<span class="faint">${state.notice.value}</span>`}
    </div>
  </header>`;
}

export function toggleTheme() {
  const next = state.theme.value === "dark" ? "light" : "dark";
  document.documentElement.dataset.theme = next;
  remember("theme", next);
  state.theme.value = next;
}
