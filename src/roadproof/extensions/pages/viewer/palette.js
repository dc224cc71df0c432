// Colours and fonts of the design (design.css), for what is drawn on a canvas.

const ORDER = ["--one", "--two", "--three", "--four"];

const probe = document.createElement("i");
probe.hidden = true;
document.documentElement.append(probe);

/** The value of a colour of the page, light or dark as the page is. */
export function colour(name) {
  probe.style.color = `var(${name})`;
  return getComputedStyle(probe).color;
}

/** The font of texts in a size (px). */
export function font(size, weight = 400) {
  const family = getComputedStyle(document.documentElement).getPropertyValue("--text");
  return `${weight} ${size}px ${family}`;
}

/** A colour for each vehicle, SV's first. */
export function coloursOf(names) {
  return Object.fromEntries(names.map((name, k) => [name, colour(ORDER[k % ORDER.length])]));
}
