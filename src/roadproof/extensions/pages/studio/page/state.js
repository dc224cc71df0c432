// The state of the page, as signals. All of `saved` is in the address; the rest is derived from it or asked for again.

import { computed, effect, signal } from "vendor/view";
import { makeLook } from "viewer/viewer";

export const FIRST_QUESTION = "scenario_1(SV,POV,L)";
export const saved = {
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
export const names = signal(null); // every name that completion offers
export const view = signal(null); // the document of the drive that is shown
export const viewedQuestion = signal(""); // the question that the view is about, as JSON
export const viewProblem = signal(""); // why there is no view of the present question
export const isFormer = signal(false); // whether the view has been about a former question for a while
export const mistakes = signal([]);
export const descriptions = signal({}); // name, sentence and vehicles of each formula
export const answers = signal([]); // verdicts, the newest first
export const job = signal(null); // the running job: {title, stage, seconds}
export const errorText = signal(""); // the last error of the page itself
export const notice = signal(""); // a short message to the user, such as "copied"
export const help = signal(false);
export const drives = signal([]); // drives of the command line and dropped ones: {name, drive}
export const specs = signal([]); // specification files: {name, text}
export const autoplay = signal(false); // whether to play the drive that is being loaded
export const recording = signal(null); // a dropped recording: its pairs, matches and files
export const pair = signal(null); // the row of the shown vehicles of the recording
export const explain = signal(null); // the part to explain, and the instant: {part, at}
export const clashes = signal([]); // marks of conflicting parts in the texts
export const marks = computed(() => [...clashes.value, ...(view.value?.marks ?? [])]);
export const theme = signal(document.documentElement.dataset.theme ?? "light");
export const look = makeLook();

export const draft = computed(() => ({
  base: saved.base.value,
  text: saved.text.value,
  before: saved.before.value,
  options: saved.options.value,
  params: saved.params.value,
}));

/** The fields that every question about the shown drive has. */
export const question = computed(() => ({
  draft: draft.value,
  set: "edit",
  formula: saved.formula.value,
  watches: saved.watches.value.filter((x) => x.trim()),
}));

/** Reset the view for another drive: at its start, paused, with nothing selected or explained. */
export function resetView() {
  explain.value = null;
  pair.value = null;
  autoplay.value = false;
  look.playing.value = false;
  look.time.value = 0;
  look.open.value = new Map();
  look.selected.value = { formula: 0, key: "/0", id: 0 };
}

/** Return the value of an option of the page. */
export function optionValue(option) {
  return saved.settings.value[option.name] ?? option.default;
}

/** Return the values of the options of a job, by name. */
export function optionValues(job) {
  const own = form.value.filter((x) => x.job === job);
  return Object.fromEntries(own.map((x) => [x.name, optionValue(x)]));
}

/** Resolve to the names, once the server has sent them. */
export function whenNamesKnown() {
  return new Promise((done) => {
    const stop = effect(() => {
      if (names.value) queueMicrotask(() => (stop(), done(names.peek())));
    });
  });
}

/** Whether the user prefers pictures at rest. */
export function prefersReducedMotion() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** Return all signals of `saved` as plain data. */
export function savedData() {
  return Object.fromEntries(Object.entries(saved).map(([name, x]) => [name, x.value]));
}

/** Apply the state of an address; fields that it lacks stay. */
export function applyState(data) {
  if (data && data.drive === null && pair.peek() === null) view.value = null;
  for (const [name, x] of Object.entries(saved)) {
    if (data && name in data) x.value = data[name];
  }
}
