// The tree of sub-formulas; each has a strip that shows when it is true, on one time axis.

import { html, useEffect, useMemo } from "vendor/view";
import { isTrue, switchesOf } from "viewer/drive";
import { meaningOf, Term } from "viewer/terms";

const JOINED = { and: "all of", or: "some of", not: "not", F: "F", G: "G", U: "U" };
const SNAP = 7; // px around a switch within which a click moves to it

/** Whether a part is unfolded at first because it only combines named parts. */
function isTemplate(formula, id) {
  const part = formula.parts[id];
  if (part.op !== "name") return false;
  const body = formula.parts[part.children[0]];
  return body && (body.op === "and" || body.op === "name") && childrenOf(formula, id).every((x) => isNamed(formula, x));
}

function isNamed(formula, id) {
  const part = formula.parts[id];
  return part.op === "name" || part.op === "truth";
}

/** Return the parts below a part; those of a name are the parts of its body. */
export function childrenOf(formula, id) {
  const part = formula.parts[id];
  if (part.op !== "name") return part.children;
  const body = formula.parts[part.children[0]];
  return body && (body.op === "and" || body.op === "or") ? body.children : part.children;
}

/** Return the operator that joins the parts below, in words. */
function joinOf(formula, id) {
  const part = formula.parts[id];
  if (part.op === "name") {
    const body = formula.parts[part.children[0]];
    return body ? (JOINED[body.op] ?? "") : "";
  }
  return JOINED[part.op] ?? "";
}

/** Return the keys of the parts that are unfolded at first. */
export function openAtFirst(formula) {
  const open = new Set();
  const visit = (id, path) => {
    const key = `${path}/${id}`;
    if (path === "" || isTemplate(formula, id)) {
      open.add(key);
      childrenOf(formula, id).forEach((x) => visit(x, key));
    }
  };
  if (formula.parts) visit(0, "");
  return open;
}

/** Return the keys to unfold so that the reasons of an explanation are visible, down to the comparisons. */
function reasonsIn(formula) {
  const keys = new Set();
  const visit = (id, path) => {
    const key = `${path}/${id}`;
    const below = childrenOf(formula, id).filter((x) => formula.because[x]);
    if (below.length) keys.add(key);
    if (keys.size < 200) below.forEach((x) => visit(x, key));
  };
  visit(0, "");
  return keys;
}

/** Return the visible rows: parts with their depth; the key of each is its path from the whole. */
export function rowsOf(formula, open) {
  const rows = [];
  const visit = (id, path, depth) => {
    const key = `${path}/${id}`;
    const children = childrenOf(formula, id);
    rows.push({ key, id, depth, children, open: open.has(key) });
    if (open.has(key)) children.forEach((x) => visit(x, key, depth + 1));
  };
  if (formula.parts) visit(0, "", 0);
  return rows;
}

/**
 * The strips of one formula. `look` has the signals time, selected ({formula, key, id}) and open (a map
 * from the index of a formula to a set of keys); `index`: that of the formula. `reference`: another formula,
 * such as the one before an edit; the strip of its part with the same text is drawn below.
 */
export function Strips({ formula, index, drive, look, title, reference = null }) {
  const isFolded = formula.role === "before";
  const first = useMemo(
    () => (isFolded ? new Set() : openAtFirst(formula)),
    [formula.text, formula.parts?.length, isFolded],
  );
  const others = useMemo(() => new Map((reference?.parts ?? []).map((x) => [x.text, x])), [reference]);
  const open = look.open.value.get(index) ?? first;
  const rows = rowsOf(formula, open);
  useEffect(() => {
    if (!formula.because) return;
    const shown = reasonsIn(formula);
    look.open.value = new Map(look.open.value).set(index, new Set([...open, ...shown]));
  }, [formula.because]);
  if (formula.error) {
    return html`<section class="strips">
      <h3>${title}</h3>
      <p class="wrong" role="alert">${formula.error}</p>
    </section>`;
  }
  const selected = look.selected.value;
  const about = selected.formula === index ? formula.parts?.[selected.id] : null;
  const change = (key, on) => {
    const next = new Set(open);
    if (on) next.add(key);
    else next.delete(key);
    look.open.value = new Map(look.open.value).set(index, next);
  };
  const select = (row) => {
    look.selected.value = { formula: index, key: row.key, id: row.id };
  };
  const onKey = (event) => {
    const at = rows.findIndex((row) => selected.formula === index && row.key === selected.key);
    const row = rows[at] ?? rows[0];
    const parent = rows.find((x) => x.key === row.key.slice(0, row.key.lastIndexOf("/")));
    const moves = {
      ArrowDown: () => select(rows[Math.min(rows.length - 1, at + 1)]),
      ArrowUp: () => select(rows[Math.max(0, at - 1)]),
      ArrowRight: () => (row.children.length && !row.open ? change(row.key, true) : select(rows[at + 1] ?? row)),
      ArrowLeft: () => (row.open && at > 0 ? change(row.key, false) : parent && select(parent)),
      Enter: () => jumpToSwitch(formula.parts[row.id], drive, look, event.shiftKey ? -1 : 1),
      Home: () => select(rows[0]),
      End: () => select(rows.at(-1)),
    };
    if (moves[event.key]) {
      event.preventDefault();
      event.stopPropagation();
      moves[event.key]();
    }
  };
  return html`<section class=${`strips ${formula.role}`} aria-label=${title}>
    <h3>${title} ${html`<span class=${formula.undecided ? "" : formula.holds ? "holds" : "fails"}>${formula.undecided ? "undecided" : formula.holds ? "true" : "false"} at 0 s</span>`} ${index === 0 ? html`<${Term} name="strip" label="strips?" />` : null}</h3>
    ${reference?.parts
      ? html`<p class="legend"><span><i style=${{ background: "var(--true)" }}></i>after the edit</span><span><i style=${{ background: "var(--four)" }}></i>before the edit</span></p>`
      : null}
    <div class="tree" role="tree" tabindex="0" aria-label=${title} aria-describedby=${about ? `about-${index}` : undefined} onKeyDown=${onKey}>
      ${rows.map((row) => {
        const part = formula.parts[row.id];
        const chosen = selected.formula === index && selected.key === row.key;
        return html`<${Row}
          key=${row.key}
          ...${{ row, part, drive, look, chosen, join: joinOf(formula, row.id) }}
          because=${formula.because?.[row.id]}
          other=${others.get(part.text)}
          onFold=${() => change(row.key, !row.open)}
          onSelect=${() => select(row)}
        />`;
      })}
    </div>
    ${about ? html`<p class="about" id=${`about-${index}`}>${saysOf(about).join(" · ")}</p>` : null}
  </section>`;
}

/** Return the meaning of a part, and when it is true. */
function saysOf(part) {
  return [part.says, meaningOf(part.text), `true: ${part.exact}`].filter(Boolean);
}

function Row({ row, part, drive, look, chosen, join, because, other, onFold, onSelect }) {
  const at = (time) => `${(100 * time) / drive.horizon}%`;
  const onTrack = (event) => {
    const box = event.currentTarget.getBoundingClientRect();
    const time = Math.max(0, Math.min(1, (event.clientX - box.left) / box.width)) * drive.horizon;
    const pixels = (x) => Math.abs(((x - time) / drive.horizon) * box.width);
    const near = switchesOf(part, drive.horizon).filter((x) => pixels(x) <= SNAP);
    near.sort((a, b) => pixels(a) - pixels(b));
    onSelect();
    look.time.value = near[0] ?? time;
  };
  const bars = (spans, name) =>
    spans
      .filter(([begin]) => begin <= drive.horizon)
      .map(([begin, end]) => {
        const until = Math.min(end ?? drive.horizon, drive.horizon);
        const style = { left: at(begin), width: `max(2px, ${at(until - begin)})` };
        return html`<i class=${name} style=${style}></i>`;
      });
  const now = isTrue(part, look.time.value);
  const differs = other && other.exact !== part.exact;
  const says = [part.text, ...saysOf(part), ...(differs ? [`before: ${other.exact}`] : [])].join("\n");
  return html`<div
    class=${`row ${chosen ? "chosen" : ""} ${because ? "because" : ""} ${differs ? "differs" : ""}`}
    role="treeitem"
    aria-level=${row.depth + 1}
    aria-selected=${chosen}
    aria-expanded=${row.children.length ? row.open : undefined}
    title=${says}
  >
    <div class="label" style=${{ paddingLeft: `${6 + row.depth * 14}px` }} onClick=${onSelect}>
      ${row.children.length
        ? html`<button class="fold" tabindex="-1" aria-label=${row.open ? "fold" : "unfold"} onClick=${(e) => (e.stopPropagation(), onFold())}>${row.open ? "▾" : "▸"}</button>`
        : html`<span class="fold"></span>`}
      <span class=${`now ${now ? "on" : "off"}`} aria-hidden="true"></span>
      <span class="words">${part.words ?? part.text}</span>
      ${join && row.open ? html`<span class="join">${join}</span>` : null}
    </div>
    ${other
      ? html`<div class="track two" onClick=${onTrack}>
          <div>${bars(part.true, "true")} ${because ? bars(because, "why") : null}</div>
          <div>${bars(other.true, "other")}</div>
        </div>`
      : html`<div class="track" onClick=${onTrack}>
          ${bars(part.true, "true")} ${part.open ? bars(part.open, "open") : null}
          ${because ? bars(because, "why") : null}
        </div>`}
  </div>`;
}

/** Move the time to the next switch of a part, or with direction -1 to the one before. */
export function jumpToSwitch(part, drive, look, direction) {
  const switches = [0, ...switchesOf(part, drive.horizon), drive.horizon].sort((a, b) => a - b);
  const now = look.time.value;
  const next =
    direction > 0 ? switches.find((x) => x > now + 1e-9) : switches.findLast((x) => x < now - 1e-9);
  if (next !== undefined) look.time.value = next;
}
