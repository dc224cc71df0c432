// The places of words in the scene: on no other words, on no vehicle if there is room, and within the picture.
// Boxes are {x, y, wide, tall} in px, y downwards.

const GAP = 6; // px between a box and words beside it
const COLUMNS = 24; // of the places that are tried anywhere in the picture

/** Whether two boxes in px overlap. */
export function overlap(one, other) {
  const across = Math.abs(one.x + one.wide / 2 - other.x - other.wide / 2);
  const down = Math.abs(one.y + one.tall / 2 - other.y - other.tall / 2);
  return 2 * across < one.wide + other.wide && 2 * down < one.tall + other.tall;
}

/**
 * Return the first of some places that is within the picture and free, else the nearest that is free; null where
 * all of the picture is taken by words. `words`: boxes of words; `vehicles`: boxes that words avoid if there is room.
 */
export function placeWords(places, size, within, { words, vehicles, anywhere = true }) {
  const fits = (x) =>
    x.x >= within.x && x.y >= within.y && x.x + x.wide <= within.x + within.wide && x.y + x.tall <= within.y + within.tall;
  const isFree = (spot, taken) => !taken.some((x) => overlap(spot, x));
  const first = places.map(([x, y]) => ({ x, y, ...size })).filter(fits);
  const free = first.find((x) => isFree(x, [...words, ...vehicles]));
  if (free || !anywhere) return free ?? null;
  const [x, y] = places[0] ?? [within.x, within.y];
  const far = (spot) => Math.abs(spot.x - x) + 2 * Math.abs(spot.y - y);
  const every = allPlaces(size, within).sort((a, b) => far(a) - far(b));
  return every.find((spot) => isFree(spot, [...words, ...vehicles])) ?? every.find((spot) => isFree(spot, words)) ?? null;
}

/** Return places in rows and columns over the picture. */
function allPlaces({ wide, tall }, within) {
  const rows = Math.max(1, Math.floor(within.tall / tall));
  const share = (k, count) => (count > 1 ? k / (count - 1) : 0);
  return Array.from({ length: rows * COLUMNS }, (_, k) => ({
    x: within.x + Math.max(0, within.wide - wide) * share(k % COLUMNS, COLUMNS),
    y: within.y + Math.max(0, within.tall - tall) * share(Math.floor(k / COLUMNS), rows),
    wide,
    tall,
  }));
}

/** Return the places beside a box, the best first: ahead, behind, then rows above and below. */
export function placesBeside(box, { wide, tall }, within) {
  const inside = (x) => Math.max(within.x, Math.min(within.x + within.wide - wide, x));
  const [middle, level] = [inside(box.x + box.wide / 2 - wide / 2), box.y + box.tall / 2 - tall / 2];
  const beside = [[box.x + box.wide + GAP, level], [box.x - GAP - wide, level]];
  const rows = [0, 1, 2, 3].flatMap((k) => [[middle, box.y - 3 - (k + 1) * tall], [middle, box.y + box.tall + 3 + k * tall]]);
  return box.flat ? [...rows, ...beside] : [...beside, ...rows];
}
