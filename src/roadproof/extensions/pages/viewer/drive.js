// Computes states of vehicles, truth and required distances from the document of a drive.
// Units are those of the document: m, m/s, m/s^2, m/s^3, s.

/** Return the state of a vehicle at a time, from its last knot [time, s, d, v_lon, v_lat, a_lon, a_lat, j_lon]. */
export function stateAt(vehicle, time) {
  const knots = vehicle.knots;
  let knot = knots[0];
  for (const next of knots) {
    if (next[0] > time) break;
    knot = next;
  }
  const [start, s, d, vLon, vLat, aLon, aLat, jLon] = knot;
  const t = time - start;
  return {
    s: s + t * (vLon + t * (aLon / 2 + (jLon * t) / 6)),
    d: d + t * (vLat + (aLat * t) / 2),
    vLon: vLon + t * (aLon + (jLon * t) / 2),
    vLat: vLat + aLat * t,
    aLon: aLon + jLon * t,
    aLat,
  };
}

/** Whether a part of a formula is true at a time. */
export function isTrue(part, time) {
  return part.true.some(
    ([begin, end, withBegin, withEnd]) =>
      (time > begin || (withBegin && time === begin)) &&
      (end === null || time < end || (withEnd && time === end)),
  );
}

/** Return the instants up to a horizon at which the truth of a part changes. */
export function switchesOf(part, horizon) {
  const ends = part.true.flatMap(([begin, end]) => [begin, end]);
  return [...new Set(ends.filter((x) => x !== null && x > 0 && x <= horizon))];
}

/** Return the value of a curve sampled every `grain` seconds, null where it has none. */
export function sampled(values, grain, time) {
  const k = Math.max(0, Math.min(values.length - 1, Math.floor(time / grain)));
  const next = Math.min(values.length - 1, k + 1);
  if (values[k] === null || values[next] === null) return values[k];
  const share = Math.max(0, Math.min(1, time / grain - k));
  return values[k] + share * (values[next] - values[k]);
}

/** Return the vehicle that has to keep an RSS distance at a time (the one behind or at the right), the distance and the gap (m). */
export function requiredAt(drive, distance, time) {
  const k = Math.max(0, Math.min(distance.one_behind.length - 1, Math.floor(time / drive.grain + 1e-9)));
  const [keeper, other] = distance.one_behind[k]
    ? [distance.one, distance.other]
    : [distance.other, distance.one];
  const needed = sampled(distance.needed, drive.grain, time);
  return { keeper, other, needed, gap: sampled(distance.gap, drive.grain, time) };
}

/** Return the visible span along the road, in m from the front of the first vehicle. */
export function windowOf(drive) {
  const vehicles = Object.values(drive.vehicles);
  let low = Infinity;
  let high = -Infinity;
  for (let k = 0; k <= 60; k += 1) {
    const time = (drive.horizon * k) / 60;
    const origin = stateAt(vehicles[0], time).s;
    for (const vehicle of vehicles) {
      const front = stateAt(vehicle, time).s - origin;
      low = Math.min(low, front - vehicle.length);
      high = Math.max(high, front);
    }
    for (const distance of drive.distances) {
      if (distance.direction !== "along") continue;
      const { keeper, needed } = requiredAt(drive, distance, time);
      if (needed > 0) high = Math.max(high, stateAt(drive.vehicles[keeper], time).s - origin + needed);
    }
  }
  const room = 0.1 * Math.max(40, high - low);
  return [Math.min(-20, low - room), Math.max(20, high + room)];
}

/** Return the right and the left edge of the road. */
export function acrossOf(road) {
  const ends = road.lanelets.flatMap((x) => x.d);
  return [Math.min(...ends), Math.max(...ends)];
}

/** Return a number as text with some significant digits. */
export function formatNumber(value, digits = 3) {
  if (value === null || value === undefined) return "–";
  const text = Number(value).toPrecision(digits);
  return text.includes("e") ? text : String(Number(text));
}
