// Opens drives when they are asked for, leads links into folded parts, prepares tables and prints.
import { mount } from "viewer/viewer";
import "page/tables";

const shown = new Set();

/** Shows the viewer of a drive, or its picture again. */
function toggle(place, wanted = !place.classList.contains("opened")) {
  place.classList.toggle("opened", wanted);
  place.querySelector("button.open").setAttribute("aria-expanded", String(wanted));
  if (!wanted || shown.has(place)) return;
  shown.add(place);
  const room = document.createElement("div");
  room.className = "viewer-room";
  place.append(room);
  const data = document.getElementById(`document-${place.dataset.document}`);
  unpacked(data.textContent).then((text) => mount(room, JSON.parse(text)));
}

/** The text of gzipped bytes in base64. */
function unpacked(base64) {
  const bytes = Uint8Array.from(atob(base64), (sign) => sign.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

for (const button of document.querySelectorAll("button.open")) {
  button.addEventListener("click", () => toggle(button.closest(".place")));
}

/** A link leads into what is folded: it is unfolded, and its first drive is shown. */
function follow() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  for (let up = target; up; up = up.parentElement) if (up.tagName === "DETAILS") up.open = true;
  const drive = target.matches(".place") ? target : target.matches("section") ? null : target.querySelector(".place");
  if (drive) toggle(drive, true);
  target.scrollIntoView();
}
addEventListener("hashchange", follow);
follow();

document.getElementById("unfold").addEventListener("click", () => {
  for (const part of document.querySelectorAll("details")) part.open = true;
});

// Parts of class "printed" are unfolded on paper.
let folded = [];
addEventListener("beforeprint", () => {
  folded = [...document.querySelectorAll("details.printed:not([open])")];
  for (const part of folded) part.open = true;
});
addEventListener("afterprint", () => {
  for (const part of folded) part.open = false;
});

document.documentElement.dataset.ready = String(Math.round(performance.now()));
