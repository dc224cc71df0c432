// Plots on the time axis of the strips: the margin of the selected part, speeds, gaps and RSS distances.

import { html, UPlot, useEffect, useRef } from "vendor/view";
import { colour, coloursOf, font } from "viewer/palette";
import { stateAt } from "viewer/drive";
import { Term, TERMS } from "viewer/terms";

const HEIGHT = 122;

/** Return the plot of a part's margin: title, instants and lines; null where it has none. */
function marginOf(formula, id, drive) {
  const part = formula?.parts?.[id];
  if (!part?.margins || !formula.step) return null;
  const clock = part.margins.map((_, k) => k * formula.step);
  return {
    title: `margin of ${part.text}`,
    term: "margin",
    clock,
    lines: [{ label: "margin", values: part.margins, stroke: colour("--ink"), width: 1.8 }],
    zero: true,
  };
}

function speedsOf(drive) {
  const names = Object.keys(drive.vehicles);
  const colours = coloursOf(names);
  const clock = clockOf(drive);
  const lines = names.map((name) => ({
    label: name,
    values: clock.map((t) => stateAt(drive.vehicles[name], t).vLon * 3.6),
    stroke: colours[name],
  }));
  return { title: "speed along, km/h", clock, lines };
}

function gapsOf(drive, direction) {
  const distances = drive.distances.filter((x) => x.direction === direction);
  if (!distances.length) return null;
  const colours = coloursOf(Object.keys(drive.vehicles));
  const lines = distances.flatMap((x) => [
    { label: `gap ${x.one}–${x.other}`, values: x.gap, stroke: colours[x.other] },
    { label: `RSS ${x.one}–${x.other}`, values: x.needed, stroke: colours[x.other], dash: [6, 4] },
  ]);
  const title = `gap ${direction}, m (broken: RSS distance)`;
  return { title, term: "gap", clock: clockOf(drive), lines, zero: true };
}

function clockOf(drive) {
  const count = Math.floor(drive.horizon / drive.grain + 1e-9);
  return Array.from({ length: count + 1 }, (_, k) => k * drive.grain);
}

/** The plots below the strips, on the same time axis; the names at its left are `gutter` px wide. */
export function Curves({ doc, look, gutter, theme }) {
  const { formula, id } = look.selected.value;
  const selected = doc.formulas[formula] ?? doc.formulas[0];
  const plots = [
    marginOf(selected, id, doc.drive),
    speedsOf(doc.drive),
    gapsOf(doc.drive, "along"),
    gapsOf(doc.drive, "across"),
  ].filter(Boolean);
  return html`<section class="curves" aria-label="Curves">
    ${plots.map((plot, k) => html`<${Plot} key=${k} ...${{ plot, drive: doc.drive, look, gutter, theme }} />`)}
  </section>`;
}

function Plot({ plot, drive, look, gutter, theme }) {
  const place = useRef(null);
  useEffect(() => {
    let instance = null;
    let isGone = false;
    const make = () => {
      if (isGone) return;
      instance?.destroy();
      instance = draw(place.current, plot, drive, look, gutter);
    };
    make();
    const stop = look.time.subscribe(() => instance?.redraw(false, false));
    const stopTheme = theme ? theme.subscribe(() => requestAnimationFrame(make)) : () => {};
    const watching = new ResizeObserver(() => {
      const width = place.current?.clientWidth;
      if (instance && width) instance.setSize({ width, height: HEIGHT });
    });
    watching.observe(place.current);
    return () => {
      isGone = true;
      stop();
      stopTheme();
      watching.disconnect();
      instance?.destroy();
    };
  }, [plot.title, JSON.stringify(plot.lines.map((x) => x.values)), gutter]);
  return html`<figure class="plot">
    <figcaption style=${{ width: `${gutter - 58}px` }} title=${plot.title}>
      <span class="words">${plot.title}</span>
      ${plot.term ? html`<${Term} name=${plot.term} label=${`${TERMS[plot.term].word}?`} />` : null}
      ${plot.lines.length > 1
        ? html`<span class="keys">
            ${plot.lines.map(
              (x) => html`<span class="key"><i style=${{ borderTop: `2px ${x.dash ? "dashed" : "solid"} ${x.stroke}` }}></i>${x.label}</span>`,
            )}
          </span>`
        : null}
    </figcaption>
    <div class="canvas" ref=${place}></div>
  </figure>`;
}

function draw(place, plot, drive, look, gutter) {
  const grid = { stroke: colour("--rule"), width: 1 };
  const axis = { stroke: colour("--faint"), grid, ticks: grid, font: font(11) };
  const options = {
    width: place.clientWidth || 600,
    height: HEIGHT,
    legend: { show: false },
    cursor: { drag: { setScale: false }, points: { show: false }, y: false },
    padding: [8, 14, 0, 0],
    scales: { x: { time: false, range: [0, drive.horizon] }, y: { range: rangeOf(plot) } },
    axes: [
      { ...axis, size: 26, values: (u, xs) => xs.map((x) => `${x} s`) },
      { ...axis, size: gutter, space: 24 },
    ],
    series: [
      {},
      ...plot.lines.map((x) => ({
        label: x.label,
        stroke: x.stroke,
        width: x.width ?? 1.8,
        dash: x.dash,
        points: { show: false },
      })),
    ],
    hooks: {
      draw: [(u) => paintPlayhead(u, look.time.peek(), plot.zero)],
      ready: [
        (u) =>
          u.over.addEventListener("click", (event) => {
            const box = u.over.getBoundingClientRect();
            const share = Math.max(0, Math.min(1, (event.clientX - box.left) / box.width));
            look.time.value = share * drive.horizon;
          }),
      ],
    },
  };
  return new UPlot(options, [plot.clock, ...plot.lines.map((x) => x.values)], place);
}

/** Return the range of values with some room, including 0 where the sign matters. */
function rangeOf(plot) {
  const values = plot.lines.flatMap((x) => x.values).filter((x) => x !== null);
  if (plot.zero) values.push(0);
  const low = Math.min(...values, Infinity);
  const high = Math.max(...values, -Infinity);
  if (!Number.isFinite(low)) return [-1, 1];
  const room = Math.max(1e-6, 0.08 * (high - low), high === low ? 1 : 0);
  return [low - room, high + room];
}

function paintPlayhead(u, time, zero) {
  const brush = u.ctx;
  const x = u.valToPos(time, "x", true);
  brush.save();
  if (zero) {
    brush.strokeStyle = colour("--faint");
    brush.lineWidth = 1;
    const y = u.valToPos(0, "y", true);
    brush.beginPath();
    brush.moveTo(u.bbox.left, y);
    brush.lineTo(u.bbox.left + u.bbox.width, y);
    brush.stroke();
  }
  brush.strokeStyle = colour("--clock");
  brush.lineWidth = 1.5 * (window.devicePixelRatio || 1);
  brush.beginPath();
  brush.moveTo(x, u.bbox.top);
  brush.lineTo(x, u.bbox.top + u.bbox.height);
  brush.stroke();
  brush.restore();
}
