// Colours that colour-blind people tell apart (Okabe and Ito), from the style sheet of the page.

const ORDER = ["--one", "--two", "--three", "--four"];

/** The value of a custom property of the page. */
export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** A colour for each vehicle, SV's first. */
export function coloursOf(names) {
  return Object.fromEntries(names.map((name, k) => [name, colour(ORDER[k % ORDER.length])]));
}
