// Opens drives when they are asked for, leads links into folded parts, filters tables.
import { mount } from "viewer/viewer";

const shown = new Set();

function open(place) {
  if (shown.has(place)) return;
  shown.add(place);
  const data = document.getElementById(`document-${place.dataset.document}`);
  place.replaceChildren(...place.querySelectorAll(":scope > p.wrong"));
  const room = document.createElement("div");
  place.append(room);
  unpacked(data.textContent).then((text) => mount(room, JSON.parse(text)));
}

/** The text of gzipped bytes in base64. */
function unpacked(base64) {
  const bytes = Uint8Array.from(atob(base64), (sign) => sign.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

for (const button of document.querySelectorAll("button.open")) {
  button.addEventListener("click", () => open(button.closest(".place")));
}

/** A link leads into what is folded: it is unfolded, and its first drive is shown. */
function follow() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  for (let up = target; up; up = up.parentElement) if (up.tagName === "DETAILS") up.open = true;
  const drive = target.querySelector(".place");
  if (drive) open(drive);
  target.scrollIntoView();
}
addEventListener("hashchange", follow);
follow();

for (const box of document.querySelectorAll("input.filter")) {
  const rows = [...box.parentElement.querySelectorAll("tbody tr")].map((row) => [row, row.textContent.toLowerCase()]);
  box.addEventListener("input", () => {
    const wanted = box.value.trim().toLowerCase();
    for (const [row, text] of rows) row.hidden = !text.includes(wanted);
  });
}

// On paper nothing is folded, and it is light.
const root = document.documentElement;
let folded = [];
let theme = "light";
addEventListener("beforeprint", () => {
  theme = root.dataset.theme;
  root.dataset.theme = "light";
  folded = [...document.querySelectorAll("details:not([open])")];
  for (const part of folded) part.open = true;
});
addEventListener("afterprint", () => {
  root.dataset.theme = theme;
  for (const part of folded) part.open = false;
});

document.documentElement.dataset.ready = String(Math.round(performance.now()));
