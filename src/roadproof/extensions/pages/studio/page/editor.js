// The editors for definitions and for one-line formulas. Completion, hovers and mistakes come from the server.

import { html, useEffect, useRef } from "vendor/view";
import * as cm from "vendor/edit";
import { ask } from "studio/server";
import * as state from "studio/state";

const WORDS = /^(?:def|param|signal|option|each|set|extends|when|lane|title|of|for|where|in|derived|by)\b/;
const LOGIC = /^(?:not|and|or|some|every|given|true|false|inf|F|G|U|O|H)(?![A-Za-z0-9_])/;
const UNIT = /^(?:km\/h|m\/s\^2|m\/s|ms|s|m|unitless)(?![A-Za-z0-9_^(])/;
const SORTS = /^(?:vehicles|vehicle|lanelet|lane)\b/;

const language = cm.StreamLanguage.define({
  name: "roadproof",
  startState: () => ({ wasNumber: false, wasDef: false }),
  token(stream, last) {
    const { wasNumber, wasDef } = last; // the kind of the token before
    last.wasNumber = false;
    last.wasDef = false;
    if (stream.eatSpace()) {
      last.wasNumber = wasNumber;
      last.wasDef = wasDef;
      return null;
    }
    if (stream.match(/^#.*/)) return "comment";
    if (stream.match(/^"[^"]*"?/)) return "string";
    if (wasNumber && stream.match(UNIT)) return "unit";
    if (stream.match(/^\d+(?:\.\d+)?(?:[eE][+-]?\d+)?/)) {
      last.wasNumber = true;
      return "number";
    }
    if (stream.match(LOGIC)) return "operatorKeyword";
    if (stream.match(SORTS)) return "typeName";
    if (stream.match(WORDS)) {
      last.wasDef = true;
      return "keyword";
    }
    if (stream.match(/^[A-Za-z_][\w{}@-]*/)) return wasDef ? "definition" : "variableName";
    if (stream.match(/^(?::=|->|<->|[<>!]?=|[<>+\-*/^])/)) return "operator";
    stream.next();
    return null;
  },
  tokenTable: { unit: cm.tags.unit, definition: cm.tags.definition(cm.tags.variableName) },
  languageData: { commentTokens: { line: "#" } },
});

const colours = cm.HighlightStyle.define([
  { tag: cm.tags.comment, color: "var(--faint)", fontStyle: "italic" },
  { tag: cm.tags.string, color: "var(--three)" },
  { tag: [cm.tags.number, cm.tags.unit], color: "var(--four)" },
  { tag: cm.tags.keyword, color: "var(--accent)", fontWeight: "600" },
  { tag: cm.tags.operatorKeyword, color: "var(--two)", fontWeight: "600" },
  { tag: cm.tags.typeName, color: "var(--faint)" },
  { tag: cm.tags.definition(cm.tags.variableName), color: "var(--accent)", fontWeight: "600" },
]);

// --- words -----------------------------------------------------------------------------------

const LOGICAL = [
  ["F", "eventually: F p, F[0, 3 s] p"],
  ["G", "always: G p, G[0, 3 s] p"],
  ["U", "until: p U q"],
  ["O", "once, at an earlier time or now: O p, O[0, 3 s] p"],
  ["H", "historically, at all times so far: H p, H[0, 3 s] p"],
  ["S", "since: p S q"],
  ["not", "negation"],
  ["and", "conjunction"],
  ["or", "disjunction"],
  ["some", "some x in {SV, POV}: …"],
  ["every", "every l in lanelets(L): …"],
];

function complete(context) {
  const word = context.matchBefore(/[A-Za-z_]\w*/);
  if ((!word && !context.explicit) || !state.names.value) return null;
  const known = state.names.value;
  const options = [
    ...known.definitions.map((x) => ({
      label: x.name,
      type: "function",
      detail: `(${x.parameters})`,
      info: () => note(x.doc),
      apply: `${x.name}(`,
    })),
    ...known.parameters.map((x) => ({
      label: x.name,
      type: "constant",
      detail: x.value,
      info: () => note(x.doc),
    })),
    ...known.signals.map((x) => ({ label: x.name, type: "property", detail: x.doc, apply: `${x.name}(` })),
    ...LOGICAL.map(([label, info]) => ({ label, type: "keyword", info: () => note(info) })),
  ];
  return { from: word ? word.from : context.pos, options, validFor: /^\w*$/ };
}

function note(text) {
  const element = document.createElement("div");
  element.textContent = text;
  return element;
}

const hover = cm.hoverTooltip(
  async (view, pos, side) => {
    const { from, to, text } = view.state.doc.lineAt(pos);
    let begin = pos;
    let end = pos;
    while (begin > from && /\w/.test(text[begin - from - 1])) begin -= 1;
    while (end < to && /\w/.test(text[end - from])) end += 1;
    if (begin === end || (begin === pos && side < 0) || (end === pos && side > 0)) return null;
    const name = text.slice(begin - from, end - from);
    if (!/^[A-Za-z_]/.test(name)) return null;
    const reply = await ask("explain", { draft: state.draft.value, set: "edit", name }).catch(() => ({}));
    if (!reply.answer?.text) return null;
    return { pos: begin, end, above: true, create: () => ({ dom: card(reply.answer) }) };
  },
  { hoverTime: 250 },
);

function card(info) {
  const element = document.createElement("div");
  element.className = "card";
  const add = (tag, text, name) => {
    if (!text) return;
    const child = document.createElement(tag);
    child.textContent = text;
    if (name) child.className = name;
    element.append(child);
  };
  add("p", info.doc);
  add("pre", info.text);
  add("p", info.expansion ? "Written out:" : "", "faint");
  add("pre", info.expansion, "expansion");
  return element;
}

// --- marks -----------------------------------------------------------------------------------

const setMarks = cm.StateEffect.define();
const marks = cm.StateField.define({
  create: () => cm.Decoration.none,
  update(value, transaction) {
    for (const effect of transaction.effects) if (effect.is(setMarks)) return effect.value;
    return transaction.docChanged ? cm.Decoration.none : value;
  },
  provide: (field) => cm.EditorView.decorations.from(field),
});

/** Return the offset in the text of a line and column that count from 1. */
function placeAt(doc, [row, column]) {
  const line = doc.line(Math.max(1, Math.min(doc.lines, row)));
  return Math.min(line.to, line.from + Math.max(0, column - 1));
}

// --- the editor ------------------------------------------------------------------------------

function oneLine(onEnter) {
  return [
    cm.EditorState.transactionFilter.of((change) => (change.newDoc.lines > 1 ? [] : change)),
    cm.keymap.of([
      {
        key: "Enter",
        run: (view) => {
          if (cm.completionStatus(view.state) === "active") return cm.acceptCompletion(view);
          onEnter();
          return true;
        },
      },
    ]),
  ];
}

/**
 * An editor of the text that `read` returns; `onChange` stores each edit at once. `where`: its name in mistakes and
 * marks (definitions, formula, watch 1). `line`: one line only, with `onEnter`. `takesFocus`: focus it at first.
 */
export function Editor({ read, onChange, where, label, line = false, onEnter = () => {}, hint = "", takesFocus = false }) {
  const text = read();
  const place = useRef(null);
  const view = useRef(null);
  const changed = useRef(onChange);
  changed.current = onChange;
  useEffect(() => {
    const extensions = [
      cm.EditorView.cspNonce.of(document.querySelector("script[nonce]").nonce),
      line ? oneLine(() => onEnter()) : [cm.lineNumbers(), cm.highlightActiveLine()],
      cm.history(),
      cm.drawSelection(),
      cm.bracketMatching(),
      cm.closeBrackets(),
      language,
      cm.syntaxHighlighting(colours),
      cm.autocompletion({ override: [complete], icons: false }),
      cm.tooltips({ position: "fixed" }),
      cm.keymap.of([...cm.closeBracketsKeymap, ...cm.defaultKeymap, ...cm.historyKeymap, ...cm.completionKeymap, ...cm.lintKeymap]),
      cm.placeholder(hint),
      cm.EditorView.contentAttributes.of({ "aria-label": label }),
      cm.EditorView.lineWrapping,
      hover,
      marks,
      cm.EditorView.updateListener.of((update) => {
        if (update.docChanged) changed.current(update.state.doc.toString());
      }),
    ];
    view.current = new cm.EditorView({ doc: text, extensions, parent: place.current });
    if (takesFocus) view.current.focus();
    return () => view.current.destroy();
  }, []);
  useEffect(() => {
    // Compare with the stored text of now, not of the rendering: the user may have typed on.
    const shown = view.current.state.doc.toString();
    const now = read();
    if (shown !== now) view.current.dispatch({ changes: { from: 0, to: shown.length, insert: now } });
  }, [text]);
  const mistakes = state.mistakes.value;
  useEffect(() => {
    const doc = view.current.state.doc;
    const diagnostics = mistakes
      .filter((x) => x.where === where)
      .map((x) => {
        const [from, to] = (x.at ?? [[1, 1], [1, 2]]).map((at) => placeAt(doc, at));
        const message = x.hint ? `${x.message}\n${x.hint}` : x.message;
        return { from: Math.min(from, to), to, severity: "error", message };
      });
    view.current.dispatch(cm.setDiagnostics(view.current.state, diagnostics));
  }, [mistakes, where]);
  const placed = state.marks.value;
  useEffect(() => {
    const doc = view.current.state.doc;
    const spans = placed
      .filter((x) => x.where === where)
      .map((x) => [placeAt(doc, x.from), placeAt(doc, x.to), x.kind])
      .filter(([from, to]) => to > from)
      .sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const made = spans.map(([from, to, kind]) => cm.Decoration.mark({ class: `mark-${kind}` }).range(from, to));
    view.current.dispatch({ effects: setMarks.of(cm.Decoration.set(made)) });
  }, [placed, where]);
  return html`<div class=${line ? "editor line" : "editor"} ref=${place}></div>`;
}
