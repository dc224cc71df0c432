// A small picture of a drive: the road from above, with the first vehicle always at the same place.

import { html, useEffect, useSignal } from "vendor/view";
import { acrossOf, requiredAt, stateAt, windowOf } from "viewer/drive";

const WIDTH = 132;
const LANE = 3; // pixels a metre across
const EDGE = 2;
const LINE = 0.8; // pixels between lanes
const SHORTEST = 7; // pixels of a vehicle
const AFTER = 0.4; // seconds after danger begins, at which the picture stands
const REST = 0.8; // seconds between two plays

/** The picture of `drive`: it stands just after danger begins, and plays in a loop while `playing`. */
export function Picture({ drive, playing }) {
  const danger = drive.dangers[0];
  const still = danger ? Math.min(drive.horizon, danger.begins + AFTER) : drive.horizon / 2;
  const time = useSignal(still);
  useEffect(() => {
    if (!playing) {
      time.value = still;
      return undefined;
    }
    const started = performance.now();
    let frame = 0;
    const step = (now) => {
      const passed = ((now - started) / 1000) % (drive.horizon + REST);
      time.value = Math.min(drive.horizon, Math.max(0, passed));
      frame = requestAnimationFrame(step);
    };
    frame = requestAnimationFrame(step);
    return () => cancelAnimationFrame(frame);
  }, [playing, drive]);
  const place = projection(drive, time.value);
  return html`<svg class="picture" viewBox=${`0 0 ${WIDTH} ${place.height.toFixed(1)}`} aria-hidden="true">
    ${drive.road.lanelets.map((x) => html`<${Lanelet} lanelet=${x} place=${place} />`)}
    ${drive.distances.filter((x) => x.direction === "along").map((x) => html`<${Envelope} ...${{ drive, place, distance: x, time: time.value }} />`)}
    ${Object.values(drive.vehicles).map((x, k) => html`<${Vehicle} ...${{ vehicle: x, k, place, time: time.value }} />`)}
  </svg>`;
}

/** Return functions from metres to px at a time. */
function projection(drive, time) {
  const [low, high] = windowOf(drive);
  const [right, left] = acrossOf(drive.road);
  const origin = stateAt(Object.values(drive.vehicles)[0], time).s;
  const along = WIDTH / (high - low);
  return {
    along,
    height: (left - right) * LANE + 2 * EDGE,
    x: (s) => (s - origin - low) * along,
    y: (d) => EDGE + (left - d) * LANE,
    inside: (x) => Math.max(-1, Math.min(WIDTH + 1, x)),
  };
}

function Lanelet({ lanelet, place }) {
  const x = lanelet.s[0] === null ? -1 : place.inside(place.x(lanelet.s[0]));
  const end = lanelet.s[1] === null ? WIDTH + 1 : place.inside(place.x(lanelet.s[1]));
  if (end <= x) return null;
  const [top, bottom] = [place.y(lanelet.d[1]), place.y(lanelet.d[0])];
  return html`<rect class=${lanelet.zone} x=${x} y=${top + LINE / 2} width=${end - x} height=${bottom - top - LINE} />`;
}

/** The RSS distance in front of the vehicle behind, darker where the gap is smaller. */
function Envelope({ drive, place, distance, time }) {
  const { keeper, needed, gap } = requiredAt(drive, distance, time);
  if (needed === null || needed <= 0) return null;
  const vehicle = drive.vehicles[keeper];
  const { s, d } = stateAt(vehicle, time);
  const at = { x: place.x(s), y: place.y(d), width: needed * place.along, height: vehicle.width * LANE };
  return html`<rect class=${gap <= needed ? "envelope near" : "envelope"} ...${at} />`;
}

function Vehicle({ vehicle, k, place, time }) {
  const { s, d } = stateAt(vehicle, time);
  const width = Math.max(SHORTEST, vehicle.length * place.along);
  const at = { x: place.x(s) - width, y: place.y(d), width, height: vehicle.width * LANE, rx: 1.2 };
  return html`<rect class=${`car v${k % 4}`} ...${at} />`;
}
