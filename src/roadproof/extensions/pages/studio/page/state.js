// What the page is about. All of `kept` is in the address; the rest follows from it, or is asked for again.

import { computed, effect, signal } from "vendor/view";
import { makeLook } from "viewer/viewer";

export const FIRST_QUESTION = "scenario_1(SV,POV,L)";
export const kept = {
  base: signal("base"),
  text: signal(""),
  before: signal(null),
  options: signal({}),
  params: signal({}),
  formula: signal(FIRST_QUESTION),
  watches: signal([]),
  settings: signal({}), // options of jobs that differ from their defaults, by name
  drive: signal(null),
  compared: signal(false),
};

export const form = signal([]); // the options that the page offers: {job, name, help, choices, default}
export const names = signal(null); // what there is to be named
export const view = signal(null); // the document of the drive that is shown
export const mistakes = signal([]);
export const about = signal({}); // what each formula is called
export const answers = signal([]); // verdicts, the newest first
export const job = signal(null); // what runs: {title, stage, seconds, stop}
export const trouble = signal(""); // what went wrong with the page itself
export const said = signal(""); // a word for the user, such as "copied"
export const help = signal(false);
export const drives = signal([]); // those of the command line, and dropped ones: {name, drive}
export const specs = signal([]); // definitions of files: {name, text}
export const plays = signal(false); // whether the drive that is loaded plays once it is there
export const recording = signal(null); // a recording that was dropped: its pairs, matches and files
export const pair = signal(null); // the vehicles of it that are shown
export const explain = signal(null); // {part, at}: what is to be explained
export const clashes = signal([]); // where the parts are said that clash
export const marks = computed(() => [...clashes.value, ...(view.value?.marks ?? [])]);
export const theme = signal(document.documentElement.dataset.theme ?? "light");
export const look = makeLook();

export const draft = computed(() => ({
  base: kept.base.value,
  text: kept.text.value,
  before: kept.before.value,
  options: kept.options.value,
  params: kept.params.value,
}));

/** What is asked with every question about the drive that is shown. */
export const question = computed(() => ({
  draft: draft.value,
  set: "edit",
  formula: kept.formula.value,
  watches: kept.watches.value.filter((x) => x.trim()),
}));

/** Another drive is looked at: from its start, at rest, with nothing selected or explained. */
export function fromTheStart() {
  explain.value = null;
  pair.value = null;
  plays.value = false;
  look.playing.value = false;
  look.time.value = 0;
  look.open.value = new Map();
  look.selected.value = { formula: 0, key: "/0", id: 0 };
}

/** The value of an option of the page. */
export function settingOf(option) {
  return kept.settings.value[option.name] ?? option.default;
}

/** The options of a job, by name. */
export function settingsOf(job) {
  const own = form.value.filter((x) => x.job === job);
  return Object.fromEntries(own.map((x) => [x.name, settingOf(x)]));
}

/** What there is to be named, once it is known. */
export function named() {
  return new Promise((done) => {
    const stop = effect(() => {
      if (names.value) queueMicrotask(() => (stop(), done(names.peek())));
    });
  });
}

/** Whether the user prefers pictures at rest. */
export function wantsRest() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** All that is kept, as plain data. */
export function asData() {
  return Object.fromEntries(Object.entries(kept).map(([name, x]) => [name, x.value]));
}

/** Take over what an address says; what it does not say stays. */
export function takeOver(data) {
  if (data && data.drive === null && pair.peek() === null) view.value = null;
  for (const [name, x] of Object.entries(kept)) {
    if (data && name in data) x.value = data[name];
  }
}
