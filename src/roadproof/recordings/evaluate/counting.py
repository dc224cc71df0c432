"""Each thing once: what an earlier window of the same recording has shown is left out, and said."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from roadproof.recordings.evaluate.evaluate import Findings
from roadproof.recordings.formats.repeats import FramePair


@dataclass(frozen=True)
class Repeat:
    """``what`` of a pair that an earlier recording has too: a trace, a violation or a detector's name."""

    recording: str
    first: int
    second: int
    what: str
    min_danger: int | None
    shown_in: str


@dataclass
class Counts:
    """What was counted so far, by what it is and the moment: the recording that showed it."""

    known: dict[tuple[str, int], str] = field(default_factory=dict)
    repeats: list[Repeat] = field(default_factory=list)

    def is_new(
        self, recording: str, pair: tuple[int, int], what: str, k: int | None, keys: Iterable[int]
    ) -> bool:
        """Whether no earlier recording shows this at any of its moments; then this one does."""
        marks = [(f"{what} {k}", key) for key in keys if key]
        shown = next(
            (self.known[mark] for mark in marks if self.known.get(mark, recording) != recording), None
        )
        if shown is not None:
            self.repeats.append(Repeat(recording, *pair, what, k, shown))
            return False
        self.known.update(dict.fromkeys(marks, recording))
        return True


def without_repeats(findings: Findings, counted: Counts) -> Findings:
    """The findings without what an earlier recording has too: traces with matches, violations, detections."""
    if not findings.seen:
        return findings

    def is_new(pair: FramePair, what: str, k: int | None, keys: tuple[int, ...]) -> bool:
        return counted.is_new(findings.recording, (pair.first, pair.second), what, k, keys)

    seen = {(x.first, x.second): x for x in findings.seen}
    shown = {
        (x.first, x.second) for x in findings.seen if x.violating and not is_new(x, "violation", None, x.keys)
    }
    kept = []
    for trace in findings.traces:
        pair = seen[trace.first, trace.second]
        keys = pair.keys[trace.start_frame - pair.low : trace.end_frame - pair.low + 1]
        if is_new(pair, "trace", trace.min_danger, keys):
            kept.append(trace)
    traces = {(x.first, x.second, x.min_danger) for x in kept}
    detected = dict.fromkeys((x.detector, x.pair) for x in findings.detections)
    new = {(name, pair) for name, pair in detected if is_new(seen[pair], name, None, seen[pair].keys)}
    return replace(
        findings,
        violating=tuple(pair for pair in findings.violating if pair not in shown),
        traces=tuple(kept),
        matches=tuple(x for x in findings.matches if (*x.pair, x.min_danger) in traces),
        detections=tuple(x for x in findings.detections if (x.detector, x.pair) in new),
    )
