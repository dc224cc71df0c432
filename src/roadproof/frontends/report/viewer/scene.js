// The road from above, driving direction to the right, the first vehicle always at the same place.

import { html, useEffect, useRef } from "vendor/view";
import { colour, coloursOf, font } from "viewer/palette";
import { acrossOf, keptAt, shown, stateAt, windowOf } from "viewer/drive";

const ZONES = { main: "main road", merge: "merge zone", depart: "departure zone" };
const HEIGHT = 216;
const MARGIN = { top: 20, bottom: 26 };
const MOST_STRETCH = 6;

/** A canvas of the scene at `time`, which is a signal; `toScale` is one too. */
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

/** What the scene shows, in words, for those who do not see it. */
export function describe(drive, time) {
  return Object.entries(drive.vehicles)
    .map(([name, vehicle]) => {
      const x = stateAt(vehicle, time);
      return `${name}: s ${shown(x.s, 4)} m, d ${shown(x.d)} m, ${shown(x.vLon * 3.6)} km/h`;
    })
    .join("; ");
}

function paint(canvas, drive, time, toScale) {
  if (!canvas || !canvas.clientWidth) return;
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(HEIGHT * ratio);
  const brush = canvas.getContext("2d");
  brush.scale(ratio, ratio);
  brush.clearRect(0, 0, width, HEIGHT);
  const place = placing(drive, time, width, toScale);
  paintRoad(brush, drive, place);
  paintScale(brush, place);
  const colours = coloursOf(Object.keys(drive.vehicles));
  for (const distance of drive.distances) paintNeeded(brush, drive, distance, time, place, colours);
  for (const name of Object.keys(drive.vehicles)) paintVehicle(brush, drive, name, time, place, colours);
  const told = `${describe(drive, time)}`;
  canvas.setAttribute("aria-label", `The road from above at ${time.toFixed(2)} s: ${told}`);
}

/** From m (along from the first vehicle's front, across) to pixels. */
function placing(drive, time, width, toScale) {
  const [low, high] = windowOf(drive);
  const [right, left] = acrossOf(drive.road);
  const origin = stateAt(Object.values(drive.vehicles)[0], time).s;
  const along = width / (high - low);
  const room = HEIGHT - MARGIN.top - MARGIN.bottom;
  const fitting = Math.max(1, Math.min(MOST_STRETCH, room / (left - right) / along));
  const stretch = toScale || fitting < 1.1 ? 1 : fitting;
  const across = along * stretch;
  const middle = MARGIN.top + room / 2;
  return {
    low,
    high,
    right,
    left,
    origin,
    along,
    across,
    stretch,
    width,
    x: (s) => (s - origin - low) * along,
    y: (d) => middle - (d - (right + left) / 2) * across,
  };
}

function paintRoad(brush, drive, place) {
  const seen = [place.origin + place.low, place.origin + place.high];
  const zones = new Set();
  for (const { lane, zone, s, d } of drive.road.lanelets) {
    const begin = Math.max(seen[0], s[0] ?? -Infinity);
    const end = Math.min(seen[1], s[1] ?? Infinity);
    if (begin >= end) continue;
    zones.add(zone);
    const box = [place.x(begin), place.y(d[1]), (end - begin) * place.along, (d[1] - d[0]) * place.across];
    brush.fillStyle = colour(`--zone-${zone}`);
    brush.fillRect(...box);
    brush.strokeStyle = colour("--lane-line");
    brush.lineWidth = 1;
    brush.setLineDash([10, 8]);
    for (const edge of d) {
      const outer = edge === place.right || edge === place.left;
      brush.setLineDash(outer ? [] : [10, 8]);
      brush.lineWidth = outer ? 1.5 : 1;
      line(brush, box[0], place.y(edge), box[0] + box[2], place.y(edge));
    }
    brush.setLineDash([]);
    if (s[0] !== null && s[0] > seen[0]) line(brush, box[0], box[1], box[0], box[1] + box[3]);
    brush.fillStyle = colour("--faint");
    brush.font = font(11);
    brush.textAlign = "left";
    const words = zone === "main" ? lane : `${lane} · ${ZONES[zone]}`;
    brush.fillText(words, Math.max(4, box[0] + 4), place.y(d[1]) + 12);
  }
}

function paintScale(brush, place) {
  const step = [5, 10, 20, 50, 100].find((x) => x * place.along > 56) ?? 200;
  brush.fillStyle = colour("--faint");
  brush.strokeStyle = colour("--rule");
  brush.font = font(11);
  brush.textAlign = "center";
  for (let at = Math.ceil(place.low / step) * step; at <= place.high; at += step) {
    const x = (at - place.low) * place.along;
    line(brush, x, HEIGHT - MARGIN.bottom + 4, x, HEIGHT - MARGIN.bottom + 8);
    if (x > 16 && x < place.width - 16) brush.fillText(at === 0 ? "0" : `${at}`, x, HEIGHT - 6);
  }
  brush.textAlign = "right";
  const stretched = place.stretch > 1 ? `across stretched ×${place.stretch.toFixed(1)}` : "to scale";
  brush.fillText(`m from the first front · ${stretched} · driving direction →`, place.width - 6, 13);
}

/** The RSS distance that the one behind, or the right one, has to keep, around that one. */
function paintNeeded(brush, drive, distance, time, place, colours) {
  const { keeper, other, needed, gap } = keptAt(drive, distance, time);
  if (needed === null || needed <= 0) return;
  const vehicle = drive.vehicles[keeper];
  const { s, d } = stateAt(vehicle, time);
  const box =
    distance.direction === "along"
      ? [place.x(s), place.y(d), needed * place.along, vehicle.width * place.across]
      : [
          place.x(s - vehicle.length),
          place.y(d + needed),
          vehicle.length * place.along,
          needed * place.across,
        ];
  brush.save();
  brush.globalAlpha = gap <= needed ? 0.42 : 0.2;
  brush.fillStyle = colours[keeper];
  brush.fillRect(...box);
  brush.globalAlpha = 0.95;
  brush.strokeStyle = colours[keeper];
  brush.lineWidth = 1.5;
  if (distance.direction === "along") {
    line(brush, box[0] + box[2], box[1] - 3, box[0] + box[2], box[1] + box[3] + 3);
    brush.fillStyle = colour("--ink");
    brush.font = font(11);
    brush.textAlign = "left";
    const words = `RSS to ${other} ${shown(needed)} m`;
    const below = box[3] > 34 ? box[3] - 5 : box[3] / 2 + 4; // below the names of vehicles
    if (box[2] > 110) brush.fillText(words, box[0] + 8, box[1] + below);
  } else {
    line(brush, box[0] - 3, box[1], box[0] + box[2] + 3, box[1]);
  }
  brush.restore();
}

function paintVehicle(brush, drive, name, time, place, colours) {
  const vehicle = drive.vehicles[name];
  const { s, d, vLon } = stateAt(vehicle, time);
  const box = [
    place.x(s - vehicle.length),
    place.y(d),
    vehicle.length * place.along,
    vehicle.width * place.across,
  ];
  brush.fillStyle = colours[name];
  brush.beginPath();
  brush.roundRect(...box, Math.min(4, box[3] / 3));
  brush.fill();
  brush.strokeStyle = colour("--paper");
  brush.lineWidth = 1;
  brush.stroke();
  brush.fillStyle = colour("--ink");
  brush.font = font(12, 600);
  brush.textAlign = "right";
  const words = `${name} ${shown(vLon * 3.6)} km/h`;
  const fits = box[0] > brush.measureText(words).width + 8;
  brush.textAlign = fits ? "right" : "left";
  brush.fillText(words, fits ? box[0] - 6 : box[0] + box[2] + 6, box[1] + box[3] / 2 + 4);
}

function line(brush, x1, y1, x2, y2) {
  brush.beginPath();
  brush.moveTo(x1, y1);
  brush.lineTo(x2, y2);
  brush.stroke();
}
