// What the browser keeps for the page. Where it keeps nothing, the page forgets at its end.

const PREFIX = "roadproof-";
const held = new Map();

/** The value that was kept under a name, or `other`. */
export function recall(name, other = null) {
  if (held.has(name)) return held.get(name);
  try {
    return JSON.parse(localStorage.getItem(PREFIX + name)) ?? other;
  } catch {
    return other;
  }
}

/** Keep plain data under a name. */
export function remember(name, value) {
  held.set(name, value);
  try {
    localStorage.setItem(PREFIX + name, JSON.stringify(value));
  } catch {
    // Denied or full: `held` has it for as long as the page is open.
  }
}
