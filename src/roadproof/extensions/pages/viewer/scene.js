// Draws the road from above, driving direction to the right, with the first vehicle always at the same place.

import { html, useEffect, useRef } from "vendor/view";
import { colour, coloursOf, font } from "viewer/palette";
import { acrossOf, formatNumber, requiredAt, stateAt, windowOf } from "viewer/drive";
import { placesBeside, placeWords } from "viewer/labels";
import { extentOf, viewOf } from "viewer/plane";

const ZONES = { main: "main road", merge: "merge zone", depart: "departure zone" };
const HEIGHT = 216;
const MARGIN = { top: 20, bottom: 26 };
const MOST_STRETCH = 6;
const STEPS = [5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000]; // metres between ticks
const LETTERS = 13; // pixels for a line of words
const HIGHEST = 420; // pixels of a road with bends, which is to scale

/** A canvas of the scene; `time` and `toScale` are signals. */
export function Scene({ drive, time, toScale, theme }) {
  const canvas = useRef(null);
  useEffect(() => {
    const draw = () => paint(canvas.current, drive, time.value, toScale.value);
    const stop = time.subscribe(draw);
    const stopScale = toScale.subscribe(draw);
    const stopTheme = theme ? theme.subscribe(() => requestAnimationFrame(draw)) : () => {};
    const watching = new ResizeObserver(draw);
    watching.observe(canvas.current);
    return () => {
      stop();
      stopScale();
      stopTheme();
      watching.disconnect();
    };
  }, [drive]);
  return html`<canvas class="scene" ref=${canvas} role="img" aria-label="The road from above"></canvas>`;
}

/** Return the scene in words, for screen readers. */
export function describe(drive, time) {
  return Object.entries(drive.vehicles)
    .map(([name, vehicle]) => {
      const x = stateAt(vehicle, time);
      return `${name}: s ${formatNumber(x.s, 4)} m, d ${formatNumber(x.d)} m, ${formatNumber(x.vLon * 3.6)} km/h`;
    })
    .join("; ");
}

function paint(canvas, drive, time, toScale) {
  if (!canvas || !canvas.clientWidth) return;
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const place = projection(drive, time, width, toScale);
  if (place.bends) canvas.style.height = `${place.height}px`;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(place.height * ratio);
  const brush = canvas.getContext("2d");
  brush.scale(ratio, ratio);
  brush.clearRect(0, 0, width, place.height);
  paintRoad(brush, drive, place);
  if (place.bends) paintBar(brush, drive, place);
  else paintScale(brush, place);
  paintDirection(brush, place);
  const colours = coloursOf(Object.keys(drive.vehicles));
  const needs = drive.distances.map((distance) => paintRequired(brush, drive, distance, time, place, colours));
  const boxes = Object.keys(drive.vehicles).map((name) => paintVehicle(brush, drive, name, time, place, colours));
  for (const box of boxes) labelVehicle(brush, box, boxes, place);
  labelLanes(brush, drive, boxes, place);
  for (const need of needs) if (need) labelDistance(brush, need, boxes, place);
  const description = `${describe(drive, time)}`;
  canvas.setAttribute("aria-label", `The road from above at ${time.toFixed(2)} s: ${description}`);
}

/** Return functions from places of the road (m) to px: points, lines along the road, areas, and its turn (rad). */
function projection(drive, time, width, toScale) {
  const [low, high] = windowOf(drive);
  const [right, left] = acrossOf(drive.road);
  const origin = stateAt(Object.values(drive.vehicles)[0], time).s;
  const within = { x: 2, y: MARGIN.top - 4, wide: width - 4, tall: HEIGHT - MARGIN.top - MARGIN.bottom + 8 };
  const common = { low, high, right, left, origin, width, within, letters: 0, labels: [] };
  const view = viewOf(drive, time);
  if (view) {
    const bent = bentProjection(drive, view, width);
    return { ...common, ...bent, within: { ...within, tall: bent.height - MARGIN.top - MARGIN.bottom + 8 } };
  }
  const along = width / (high - low);
  const room = HEIGHT - MARGIN.top - MARGIN.bottom;
  const fitting = Math.max(1, Math.min(MOST_STRETCH, room / (left - right) / along));
  const stretch = toScale || fitting < 1.1 ? 1 : fitting;
  const across = along * stretch;
  const middle = MARGIN.top + room / 2;
  const point = (s, d) => [(s - origin - low) * along, middle - (d - (right + left) / 2) * across];
  const way = (begin, end, d) => [point(begin, d), point(end, d)];
  const fill = (brush, begin, end, [bottom, top]) =>
    brush.fillRect(...point(begin, top), (end - begin) * along, (top - bottom) * across);
  return { ...common, along, across, stretch, height: HEIGHT, point, way, fill, turn: () => 0 };
}

/** Return the projection for a road with bends, which is to scale. */
function bentProjection(drive, view, width) {
  const [begin, end, bottom, top] = extentOf(drive);
  const along = Math.min(width / (end - begin), (HIGHEST - MARGIN.top - MARGIN.bottom) / (top - bottom));
  const room = Math.max(HEIGHT - MARGIN.top - MARGIN.bottom, (top - bottom) * along);
  const pixels = ([x, y]) => [
    width / 2 + (x - (begin + end) / 2) * along,
    MARGIN.top + room / 2 - (y - (top + bottom) / 2) * along,
  ];
  return {
    bends: true,
    letters: LETTERS,
    along,
    across: along,
    height: Math.round(room + MARGIN.top + MARGIN.bottom),
    point: (s, d) => pixels(view.at(s, d)),
    way: (...ends) => view.edge(...ends).map(pixels),
    fill: (brush, ...ends) => {
      trace(brush, view.outline(...ends).map(pixels));
      brush.fill();
    },
    turn: (s) => -view.turned(s),
  };
}

function paintRoad(brush, drive, place) {
  const more = place.bends ? (place.high - place.low) / 2 : 0; // to the corners of the picture
  const seen = [place.origin + place.low, place.origin + place.high];
  for (const { lane, zone, s, d } of drive.road.lanelets) {
    const begin = Math.max(seen[0] - more, s[0] ?? -Infinity);
    const end = Math.min(seen[1] + more, s[1] ?? Infinity);
    if (begin >= end) continue;
    brush.fillStyle = colour(`--zone-${zone}`);
    place.fill(brush, begin, end, d);
    brush.strokeStyle = colour("--lane-line");
    for (const edge of d) {
      const outer = edge === place.right || edge === place.left;
      brush.setLineDash(outer ? [] : [10, 8]);
      brush.lineWidth = outer ? 1.5 : 1;
      stroke(brush, place.way(begin, end, edge));
    }
    brush.setLineDash([]);
    if (s[0] !== null && s[0] > seen[0]) stroke(brush, [place.point(begin, d[1]), place.point(begin, d[0])]);
  }
}

/** Write the name of each lane on it, at the first place from its beginning where it covers nothing. */
function labelLanes(brush, drive, boxes, place) {
  const seen = [place.origin + place.low, place.origin + place.high];
  for (const { lane, zone, s, d } of drive.road.lanelets) {
    const [begin, end] = [Math.max(seen[0], s[0] ?? -Infinity), Math.min(seen[1], s[1] ?? Infinity)];
    if (begin >= end || (d[1] - d[0]) * place.across < place.letters) continue;
    brush.fillStyle = colour("--faint");
    brush.font = font(11);
    const words = zone === "main" ? lane : `${lane} · ${ZONES[zone]}`;
    const size = { wide: brush.measureText(words).width, tall: LETTERS };
    const down = place.bends ? (d[0] + d[1]) / 2 : d[1];
    const steps = Array.from({ length: 40 }, (_, k) => place.point(begin + ((end - begin) * k) / 40, down));
    const places = steps.map(([x, y]) => [x + 4, place.bends ? y - LETTERS / 2 : y + 2]);
    writeFree(brush, place, places, size, words, boxes, false);
  }
}

/** Draw a scale bar on a road with bends, where distances along the picture are not distances along the road. */
function paintBar(brush, drive, place) {
  const step = STEPS.find((x) => x * place.along > 56) ?? STEPS.at(-1);
  const y = place.height - 8;
  brush.fillStyle = colour("--faint");
  brush.strokeStyle = colour("--faint");
  brush.lineWidth = 1;
  stroke(brush, [[8, y - 3], [8, y], [8 + step * place.along, y], [8 + step * place.along, y - 3]]);
  brush.font = font(11);
  brush.textAlign = "left";
  const { error } = drive.road;
  const [bar, left] = [`${step} m`, 14 + step * place.along];
  const length = error ? `lengths differ by up to ${formatNumber(error[0], 2)} %, ${formatNumber(error[1], 2)} m` : "";
  brush.fillText(fitting(brush, [bar, length], place.width - left - 6).join(" · "), left, y);
}

/** Return as many words as there is room for when they are joined by dots. */
function fitting(brush, words, room) {
  const some = words.filter(Boolean);
  while (some.length > 1 && brush.measureText(some.join(" · ")).width > room) some.pop();
  return some;
}

/** Draw the driving direction at the right, with as much of the legend before it as there is room for. */
function paintDirection(brush, place) {
  brush.fillStyle = brush.strokeStyle = colour("--faint");
  brush.font = font(11);
  brush.textAlign = "right";
  brush.lineWidth = 1.2;
  const [tip, y] = [place.width - 6, 9];
  stroke(brush, [[tip - 18, y], [tip, y]]);
  stroke(brush, [[tip - 5, y - 3.5], [tip, y], [tip - 5, y + 3.5]]);
  const stretched = place.stretch > 1 ? `across stretched ×${place.stretch.toFixed(1)}` : "to scale";
  const legend = ["driving direction", stretched, ...(place.bends ? [] : ["m from the first front"])];
  brush.fillText(fitting(brush, legend, tip - 28).reverse().join(" · "), tip - 23, 13);
}

function paintScale(brush, place) {
  const step = STEPS.find((x) => x * place.along > 56) ?? STEPS.at(-1);
  brush.fillStyle = colour("--faint");
  brush.strokeStyle = colour("--rule");
  brush.font = font(11);
  brush.textAlign = "center";
  for (let at = Math.ceil(place.low / step) * step; at <= place.high; at += step) {
    const x = (at - place.low) * place.along;
    stroke(brush, [[x, HEIGHT - MARGIN.bottom + 4], [x, HEIGHT - MARGIN.bottom + 8]]);
    if (x > 22 && x < place.width - 22) brush.fillText(`${at || 0} m`, x, HEIGHT - 6);
  }
}

/** Draw the RSS distance of the vehicle that has to keep it; return its label, if that fits. */
function paintRequired(brush, drive, distance, time, place, colours) {
  const { keeper, other, needed, gap } = requiredAt(drive, distance, time);
  if (needed === null || needed <= 0) return null;
  const { length, width } = drive.vehicles[keeper];
  const { s, d } = stateAt(drive.vehicles[keeper], time);
  const ahead = distance.direction === "along";
  brush.save();
  brush.globalAlpha = gap <= needed ? 0.42 : 0.2;
  brush.fillStyle = colours[keeper];
  if (ahead) place.fill(brush, s, s + needed, [d - width, d]);
  else place.fill(brush, s - length, s, [d, d + needed]);
  brush.globalAlpha = 0.95;
  brush.strokeStyle = colours[keeper];
  brush.lineWidth = 1.5;
  if (ahead) {
    const more = 3 / place.across;
    stroke(brush, [place.point(s + needed, d + more), place.point(s + needed, d - width - more)]);
  } else {
    const more = 3 / place.along;
    stroke(brush, place.way(s - length - more, s + more, d + needed));
  }
  brush.restore();
  const high = width * place.across;
  const fits = ahead && needed * place.along > 110 && high >= place.letters;
  const below = high > 34 ? high - 5 : high / 2 + 4; // below the names of vehicles
  return fits ? { at: [s, d], below, words: `RSS to ${other} ${formatNumber(needed)} m` } : null;
}

/** Write the length of an RSS distance, unless the label would cover another one or a vehicle. */
function labelDistance(brush, { at, below, words }, boxes, place) {
  brush.fillStyle = colour("--ink");
  brush.font = font(11);
  const [x, y] = place.point(...at);
  const size = { wide: brush.measureText(words).width, tall: LETTERS };
  const top = y + below - LETTERS + 3;
  writeFree(brush, place, [[x + 8, top], [x + 60, top], [x + 110, top]], size, words, boxes, false);
}

function paintVehicle(brush, drive, name, time, place, colours) {
  const { length, width } = drive.vehicles[name];
  const { s, d, vLon } = stateAt(drive.vehicles[name], time);
  const [x, y] = place.point(s - length / 2, d - width / 2);
  const [long, high] = [length * place.along, width * place.across];
  const turn = place.turn(s - length / 2);
  brush.save();
  brush.translate(x, y);
  brush.rotate(turn);
  brush.fillStyle = colours[name];
  brush.beginPath();
  brush.roundRect(-long / 2, -high / 2, long, high, Math.min(4, high / 3));
  brush.fill();
  brush.strokeStyle = colour("--paper");
  brush.lineWidth = 1;
  brush.stroke();
  brush.restore();
  const [cos, sin] = [Math.abs(Math.cos(turn)), Math.abs(Math.sin(turn))];
  const [wide, tall] = [cos * long + sin * high, sin * long + cos * high];
  const flat = high < place.letters;
  return { x: x - wide / 2, y: y - tall / 2, wide, tall, flat, words: `${name} ${formatNumber(vLon * 3.6)} km/h` };
}

/** Write the name of a vehicle beside its box, at the first place where it covers nothing. */
function labelVehicle(brush, box, boxes, place) {
  brush.fillStyle = colour("--ink");
  brush.font = font(12, 600);
  const size = { wide: brush.measureText(box.words).width + 6, tall: LETTERS };
  writeFree(brush, place, placesBeside(box, size, place.within), size, box.words, boxes, true);
}

/** Write words at the first free place; no later words will cover them. `anywhere`: else wherever there is room. */
function writeFree(brush, place, places, size, words, boxes, anywhere) {
  const spot = placeWords(places, size, place.within, { words: place.labels, vehicles: boxes, anywhere });
  if (spot === null) return;
  place.labels.push(spot);
  brush.textAlign = "left";
  brush.fillText(words, spot.x, spot.y + LETTERS - 3);
}

function trace(brush, points) {
  brush.beginPath();
  points.forEach((point, k) => (k ? brush.lineTo(...point) : brush.moveTo(...point)));
}

function stroke(brush, points) {
  trace(brush, points);
  brush.stroke();
}
