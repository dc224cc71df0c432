// Stores data in the browser; where that is denied, only for as long as the page is open.

const PREFIX = "roadproof-";
const memory = new Map();

/** Return the value stored under a name, or `other`. */
export function recall(name, other = null) {
  if (memory.has(name)) return memory.get(name);
  try {
    return JSON.parse(localStorage.getItem(PREFIX + name)) ?? other;
  } catch {
    return other;
  }
}

/** Return the value that this tab stored under a name, or `other`; it is there after a reload. */
export function recallInTab(name, other = null) {
  try {
    return JSON.parse(sessionStorage.getItem(PREFIX + name)) ?? other;
  } catch {
    return other;
  }
}

/** Store plain data under a name for this tab; return whether there was room. */
export function rememberInTab(name, value) {
  try {
    sessionStorage.setItem(PREFIX + name, JSON.stringify(value));
    return true;
  } catch {
    return false;
  }
}

/** Store plain data under a name. */
export function remember(name, value) {
  memory.set(name, value);
  try {
    localStorage.setItem(PREFIX + name, JSON.stringify(value));
  } catch {
    // Denied or full: `memory` stores it for as long as the page is open.
  }
}
