// Opens drives on demand, opens folded parts for links, and prepares tables and printing.
import { mount } from "viewer/viewer";
import "page/tables";

const shown = new Set();

/** Show the viewer of a drive, or its picture again. */
function toggle(place, isOpened = !place.classList.contains("opened")) {
  place.classList.toggle("opened", isOpened);
  place.querySelector("button.open").setAttribute("aria-expanded", String(isOpened));
  if (!isOpened || shown.has(place)) return;
  shown.add(place);
  const room = document.createElement("div");
  room.className = "viewer-room";
  place.append(room);
  const data = document.getElementById(`document-${place.dataset.document}`);
  unpack(data.textContent).then((text) => mount(room, JSON.parse(text)));
}

/** Return the text of gzipped bytes in base64. */
function unpack(base64) {
  const bytes = Uint8Array.from(atob(base64), (sign) => sign.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

for (const button of document.querySelectorAll("button.open")) {
  button.addEventListener("click", () => toggle(button.closest(".place")));
}

/** Unfold the target of the address, and show its first drive. */
function openTarget() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  for (let up = target; up; up = up.parentElement) if (up.tagName === "DETAILS") up.open = true;
  const drive = target.matches(".place") ? target : target.matches("section") ? null : target.querySelector(".place");
  if (drive) toggle(drive, true);
  target.scrollIntoView();
}
addEventListener("hashchange", openTarget);
openTarget();

document.getElementById("unfold").addEventListener("click", () => {
  for (const part of document.querySelectorAll("details")) part.open = true;
});

// Parts of class "printed" are unfolded for printing.
let folded = [];
addEventListener("beforeprint", () => {
  folded = [...document.querySelectorAll("details.printed:not([open])")];
  for (const part of folded) part.open = true;
});
addEventListener("afterprint", () => {
  for (const part of folded) part.open = false;
});

document.documentElement.dataset.ready = String(Math.round(performance.now()));
