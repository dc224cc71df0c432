// Explanations of the viewer's terms, and a term that shows its own.

import { html, useMemo } from "vendor/view";

export const TERMS = {
  envelope: {
    word: "RSS envelope",
    says: "The shaded area is the distance that RSS (responsibility-sensitive safety) requires: along the road of the vehicle behind, across it of the right one. It is darker while the gap is smaller.",
  },
  gap: {
    word: "gap",
    says: "The free distance between two vehicles: along the road from front to rear, across it from side to side. Below the broken line it is smaller than the RSS distance.",
  },
  danger: {
    word: "danger",
    says: "In the library: both gaps, along and across, stay within the RSS distances for at least minDanger. The button below jumps to where it begins.",
  },
  strip: {
    word: "strips",
    says: "A strip shows when a part of the formula is true. Select a part to see its meaning and its margin; unfold it to see what it is made of.",
  },
  margin: {
    word: "margin",
    says: "The robustness of the selected part: positive where it is true, negative where it is false, and the nearer to 0 the closer to a change.",
  },
};

let count = 0;

/** A term with its meaning, which is visible while the term has the pointer or the focus; Escape hides it. */
export function Term({ name, label = TERMS[name].word }) {
  const id = useMemo(() => `term-${(count += 1)}`, []);
  const onKey = (event) => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    event.currentTarget.blur();
  };
  return html`<span class="term">
    <button type="button" aria-describedby=${id} onKeyDown=${onKey}>${label}</button>
    <span class="meaning" role="tooltip" id=${id}>${TERMS[name].says}</span>
  </span>`;
}

/** Return the meaning of a part of a formula whose name is one of the terms, else "". */
export function meaningOf(text) {
  const name = { danger: "danger", rssViolation: "envelope", rssViolation_lon: "envelope", rssViolation_lat: "envelope" }[/^\w+/.exec(text)?.[0]];
  return name ? TERMS[name].says : "";
}
