// Draws the road from above, driving direction to the right, with the first vehicle always at the same place.

import { html, useEffect, useRef } from "vendor/view";
import { colour, coloursOf, font } from "viewer/palette";
import { acrossOf, formatNumber, requiredAt, stateAt, windowOf } from "viewer/drive";
import { extentOf, viewOf } from "viewer/plane";

const ZONES = { main: "main road", merge: "merge zone", depart: "departure zone" };
const HEIGHT = 216;
const MARGIN = { top: 20, bottom: 26 };
const MOST_STRETCH = 6;
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
  const colours = coloursOf(Object.keys(drive.vehicles));
  const needs = drive.distances.map((distance) => paintRequired(brush, drive, distance, time, place, colours));
  const boxes = Object.keys(drive.vehicles).map((name) => paintVehicle(brush, drive, name, time, place, colours));
  boxes.forEach((box, k) => labelVehicle(brush, box, boxes.filter((_, other) => other !== k), place));
  for (const need of needs) if (need) labelDistance(brush, need, boxes, place);
  const description = `${describe(drive, time)}`;
  canvas.setAttribute("aria-label", `The road from above at ${time.toFixed(2)} s: ${description}`);
}

/** Return functions from places of the road (m) to px: points, lines along the road, areas, and its turn (rad). */
function projection(drive, time, width, toScale) {
  const [low, high] = windowOf(drive);
  const [right, left] = acrossOf(drive.road);
  const origin = stateAt(Object.values(drive.vehicles)[0], time).s;
  const common = { low, high, right, left, origin, width, letters: 0, labels: [] };
  const view = viewOf(drive, time);
  if (view) return { ...common, ...bentProjection(drive, view, width) };
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
    brush.fillStyle = colour("--faint");
    brush.font = font(11);
    brush.textAlign = "left";
    if ((d[1] - d[0]) * place.across < place.letters) continue;
    const words = zone === "main" ? lane : `${lane} · ${ZONES[zone]}`;
    write(brush, place, [Math.max(seen[0], begin), d[1]], words, [4, 12]);
  }
}

/** Draw a scale bar on a road with bends, where distances along the picture are not distances along the road. */
function paintBar(brush, drive, place) {
  const step = [5, 10, 20, 50, 100].find((x) => x * place.along > 56) ?? 200;
  const y = place.height - 8;
  brush.fillStyle = colour("--faint");
  brush.strokeStyle = colour("--faint");
  brush.lineWidth = 1;
  stroke(brush, [[8, y - 3], [8, y], [8 + step * place.along, y], [8 + step * place.along, y - 3]]);
  brush.font = font(11);
  brush.textAlign = "left";
  const { error } = drive.road;
  const bends = error ? ` · lengths differ by up to ${formatNumber(error[0], 2)} %, ${formatNumber(error[1], 2)} m` : "";
  brush.fillText(`${step} m${bends}`, 14 + step * place.along, y);
  brush.textAlign = "right";
  brush.fillText("to scale · driving direction →", place.width - 6, 13);
}

function paintScale(brush, place) {
  const step = [5, 10, 20, 50, 100].find((x) => x * place.along > 56) ?? 200;
  brush.fillStyle = colour("--faint");
  brush.strokeStyle = colour("--rule");
  brush.font = font(11);
  brush.textAlign = "center";
  for (let at = Math.ceil(place.low / step) * step; at <= place.high; at += step) {
    const x = (at - place.low) * place.along;
    stroke(brush, [[x, HEIGHT - MARGIN.bottom + 4], [x, HEIGHT - MARGIN.bottom + 8]]);
    if (x > 16 && x < place.width - 16) brush.fillText(at === 0 ? "0" : `${at}`, x, HEIGHT - 6);
  }
  brush.textAlign = "right";
  const stretched = place.stretch > 1 ? `across stretched ×${place.stretch.toFixed(1)}` : "to scale";
  brush.fillText(`m from the first front · ${stretched} · driving direction →`, place.width - 6, 13);
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
  brush.textAlign = "left";
  const [x, y] = place.point(...at);
  const spot = { x: x + 8, y: y + below - LETTERS + 3, wide: brush.measureText(words).width, tall: LETTERS };
  const isFree = ![...place.labels, ...boxes].some((other) => overlap(spot, other));
  if (place.bends || isFree) write(brush, place, at, words, [8, below]);
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
function labelVehicle(brush, box, others, place) {
  brush.fillStyle = colour("--ink");
  brush.font = font(12, 600);
  brush.textAlign = "left";
  const wide = brush.measureText(box.words).width;
  const inside = (x) => Math.max(2, Math.min(place.width - wide - 2, x));
  const [middle, level] = [inside(box.x + box.wide / 2 - wide / 2), box.y + box.tall / 2 - LETTERS / 2];
  const beside = [[box.x - 6 - wide, level], [box.x + box.wide + 6, level]].filter(([x]) => x === inside(x));
  const [above, below] = [box.y - 3, box.y + box.tall + 3];
  const rows = [0, 1, 2, 3].flatMap((k) => [[middle, above - (k + 1) * LETTERS], [middle, below + k * LETTERS]]);
  const spots = (box.flat ? [...rows, ...beside] : [...beside, ...rows])
    .filter(([, y]) => y >= 0 && y + LETTERS <= place.height)
    .map(([x, y]) => ({ x, y, wide: wide + 6, tall: LETTERS }));
  const isFree = (spot, taken) => !taken.some((other) => overlap(spot, other));
  const spot =
    spots.find((x) => isFree(x, [...place.labels, ...others])) ??
    spots.find((x) => isFree(x, place.labels)) ?? { x: middle, y: level, wide, tall: LETTERS };
  place.labels.push(spot);
  brush.fillText(box.words, spot.x, spot.y + LETTERS - 3);
}

/** Whether two boxes in px overlap. */
export function overlap(one, other) {
  const across = Math.abs(one.x + one.wide / 2 - other.x - other.wide / 2);
  const down = Math.abs(one.y + one.tall / 2 - other.y - other.tall / 2);
  return 2 * across < one.wide + other.wide && 2 * down < one.tall + other.tall;
}

/** Write words beside a place of the road, in its direction; on a straight road no later label will cover them. */
function write(brush, place, [s, d], words, [ahead, below]) {
  const [x, y] = place.point(s, d);
  if (!place.bends) {
    const wide = brush.measureText(words).width;
    place.labels.push({ x: x + ahead, y: y + below - LETTERS + 3, wide, tall: LETTERS });
  }
  brush.save();
  brush.translate(...place.point(s, d));
  brush.rotate(place.turn(s));
  brush.fillText(words, ahead, below);
  brush.restore();
}

function trace(brush, points) {
  brush.beginPath();
  points.forEach((point, k) => (k ? brush.lineTo(...point) : brush.moveTo(...point)));
}

function stroke(brush, points) {
  trace(brush, points);
  brush.stroke();
}
