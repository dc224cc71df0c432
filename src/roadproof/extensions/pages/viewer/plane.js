// Projects places (s, d) of a road with bends to the plane, for all scenes.
// Units are m and rad. Points of a view are [ahead, to the left] of the road at the middle of the window.

import { acrossOf, stateAt, windowOf } from "viewer/drive";

const STEP = 2; // metres between points of an edge
const VIEWS = 24; // the number of instants from which the scale is chosen
const EXTENTS = new WeakMap(); // by drive

/** Return the pose of a road's line at s: cubic between its samples, straight beyond them. */
function poseOn(line, s) {
  const last = line.length - 1;
  const inside = Math.max(line[0][0], Math.min(line[last][0], s));
  const step = (line[last][0] - line[0][0]) / last;
  const k = Math.max(0, Math.min(last - 1, Math.floor((inside - line[0][0]) / step)));
  const [[a, x0, y0, h0], [b, x1, y1, h1]] = [line[k], line[k + 1]];
  const [length, t] = [b - a, (inside - a) / (b - a)];
  const cubic = (p, m, q, n) => {
    const [c2, c3] = [3 * (q - p) - 2 * m - n, 2 * (p - q) + m + n];
    return [p + t * (m + t * (c2 + t * c3)), m + t * (2 * c2 + t * 3 * c3)];
  };
  const [x, dx] = cubic(x0, length * Math.cos(h0), x1, length * Math.cos(h1));
  const [y, dy] = cubic(y0, length * Math.sin(h0), y1, length * Math.sin(h1));
  const heading = Math.atan2(dy, dx);
  const beyond = s - inside;
  return { x: x + beyond * Math.cos(heading), y: y + beyond * Math.sin(heading), heading };
}

/** Return functions from places to points for the view at a time; null for a straight road. */
export function viewOf(drive, time) {
  const { line } = drive.road;
  if (!line) return null;
  const [low, high] = windowOf(drive);
  const [right, left] = acrossOf(drive.road);
  const middle = stateAt(Object.values(drive.vehicles)[0], time).s + (low + high) / 2;
  const from = poseOn(line, middle);
  const aside = (right + left) / 2;
  const [cos, sin] = [Math.cos(from.heading), Math.sin(from.heading)];
  const at = (s, d) => {
    const here = poseOn(line, s);
    const x = here.x - d * Math.sin(here.heading) - from.x;
    const y = here.y + d * Math.cos(here.heading) - from.y;
    return [x * cos + y * sin, y * cos - x * sin - aside];
  };
  const edge = (begin, end, d) => {
    const count = Math.max(1, Math.ceil(Math.abs(end - begin) / STEP));
    return Array.from({ length: count + 1 }, (_, k) => at(begin + ((end - begin) * k) / count, d));
  };
  return {
    at,
    edge,
    outline: (begin, end, [bottom, top]) => [...edge(begin, end, top), ...edge(end, begin, bottom)],
    turned: (s) => poseOn(line, s).heading - from.heading,
  };
}

/** Return the extent of the visible road in the plane, over all times: left, right, bottom, top. */
export function extentOf(drive) {
  if (!EXTENTS.has(drive)) EXTENTS.set(drive, measureExtent(drive));
  return EXTENTS.get(drive);
}

function measureExtent(drive) {
  const [low, high] = windowOf(drive);
  const points = [];
  for (let k = 0; k <= VIEWS; k += 1) {
    const time = (drive.horizon * k) / VIEWS;
    const origin = stateAt(Object.values(drive.vehicles)[0], time).s;
    points.push(...viewOf(drive, time).outline(origin + low, origin + high, acrossOf(drive.road)));
  }
  const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
  return [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
}
