"""The highD experiment on one recording (semantics §7): which disturbance matches which scenario."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import repeat
from operator import attrgetter
from typing import Any

import numpy as np

from roadproof.extensions.traffic.evaluate.boundary import TraceQuestions, TruthBounds, truth_bounds
from roadproof.extensions.traffic.evaluate.detectors import Detection, find_detections, order_of_detections
from roadproof.extensions.traffic.evaluate.disturbances import (
    NEVER,
    CutTriples,
    Disturbances,
    cut_triples,
    find_disturbances,
)
from roadproof.extensions.traffic.evaluate.foretelling import with_driver_labels
from roadproof.extensions.traffic.evaluate.matching import Match, PossibleMatch
from roadproof.extensions.traffic.evaluate.questions import START, EvaluationQuestions, MonitorKey
from roadproof.extensions.traffic.evaluate.traces import OTHER_LANE, gather
from roadproof.extensions.traffic.formats.overlaps import Overlap, find_overlaps, overlap_text
from roadproof.extensions.traffic.formats.pairs import Pairs, row_of, triples_of
from roadproof.extensions.traffic.formats.recording import Bools, Integers, Recording
from roadproof.extensions.traffic.formats.repeats import FramePair, frame_pair
from roadproof.extensions.traffic.formats.windows import TimeWindow
from roadproof.library.scenarios import LANE, PAIR
from roadproof.logic.formula import Formula
from roadproof.semantics.sampled.answers import Convention
from roadproof.semantics.sampled.compiled import Monitor, Observation

OTHER: Mapping[Convention, Convention] = {"truncated": "clip", "clip": "truncated"}


@dataclass(frozen=True)
class DisturbanceTrace:
    """A disturbance: an unordered pair under one minDanger. Lanes and road sectors are those at its start."""

    first: int
    second: int
    min_danger: int
    start_frame: int
    end_frame: int
    first_lane: str
    second_lane: str
    sectors: tuple[str, ...]


@dataclass(frozen=True)
class Findings:
    """The findings in one recording. ``violating``: the pairs (ids, ascending) with an rssViolation in some
    frame.

    ``undecided`` counts questions whose answer depends on what comes after the trace, ``differing``
    those that the other convention for the end of a trace answers otherwise. ``sectors``: the road sectors
    that its road has, of those that were asked for. ``seen``: the pairs that
    violate or are detected, where another recording may show them too. ``possible``: on a measured road,
    scenarios that traces do not match, but may.
    """

    recording: str
    vehicles: int
    samples: int
    violating: tuple[tuple[int, int], ...]
    triples: int
    asked: int
    undecided: int
    differing: int
    traces: tuple[DisturbanceTrace, ...]
    matches: tuple[Match, ...]
    detections: tuple[Detection, ...]
    notes: tuple[str, ...]
    sectors: tuple[str, ...]
    seen: tuple[FramePair, ...] = ()
    possible: tuple[PossibleMatch, ...] = ()


def evaluate_recording(recording: Recording, questions: EvaluationQuestions) -> Findings:
    """Filter, cut and match all pairs, and all triples for the scenarios of three cars."""
    return evaluate_windows([TimeWindow(recording, np.ones(recording.vehicles, bool))], questions)


def evaluate_windows(windows: Iterable[TimeWindow], questions: EvaluationQuestions) -> Findings:
    """Evaluate a recording in windows of time, one window in memory at a time.

    A pair or triple is looked at where the last of its vehicles comes in, on all of its common frames.
    """
    parts, overlaps, kinds = list[Findings](), list[Overlap](), set[str]()
    for window in windows:
        kinds |= {*map(str, np.unique(window.recording.kind))}
        part, overlapping = _evaluate(window, questions)
        parts.append(part)
        overlaps += overlapping
    added = {name: sum(getattr(part, name) for part in parts) for name in _ADDED}
    rows = {
        name: tuple(sorted((x for part in parts for x in getattr(part, name)), key=order))
        for name, order in _ORDERS.items()
    }
    overlap_notes = map(overlap_text, sorted(overlaps, key=lambda x: x[:2]))
    class_notes = _note_on_classes(questions.settings.classes, kinds)
    notes = (
        *parts[-1].notes,
        *class_notes,
        *overlap_notes,
        *_note_on_uncertain([x for part in parts for x in part.matches]),
    )
    return replace(parts[-1], **added, **rows, notes=notes)  # type: ignore[arg-type]


def _note_on_classes(classes: tuple[str, ...], kinds: set[str]) -> Iterator[str]:
    """A note where nothing is evaluated, since no vehicle is of the classes that were asked for."""
    if kinds and not kinds & {*classes}:
        yield f"no vehicle of class {', '.join(classes)}: its classes are {', '.join(sorted(kinds))}"


def _evaluate(window: TimeWindow, questions: EvaluationQuestions) -> tuple[Findings, Iterable[Overlap]]:
    """The findings of one window, and the boxes that overlap there."""
    recording = window.recording
    if recording.rate != questions.rate:
        raise ValueError(f"questions for {questions.rate} Hz put to a recording of {recording.rate} Hz")
    all_disturbances = find_disturbances(recording, questions)
    disturbances = all_disturbances.choose(
        window.has(all_disturbances.pairs.first, all_disturbances.pairs.second)
    )
    tally = _Tally(questions)
    matches, possible = _match_pairs(recording, questions, disturbances, tally)
    cut = None
    if questions.triple_start is not None:
        cut = _candidates(window, questions, all_disturbances)
        matches += _match_triples(recording, questions, cut, tally)
    meeting = all_disturbances.meeting.choose(
        window.has(all_disturbances.meeting.first, all_disturbances.meeting.second)
    )
    detections = find_detections(recording, questions, meeting)
    findings = Findings(
        recording=recording.name,
        vehicles=int(np.count_nonzero(window.new)),
        samples=int(np.diff(recording.start)[window.new].sum()),
        violating=tuple(_ids_of(recording, disturbances.pairs)),
        triples=0 if cut is None else len(cut.triples),
        asked=tally.asked,
        undecided=tally.undecided,
        differing=tally.differing,
        traces=tuple(_traces(recording, questions, disturbances)),
        matches=tuple(with_driver_labels(recording, questions, matches)),
        detections=detections,
        notes=recording.notes,
        sectors=tuple(x.name for x in questions.sectors),
        seen=tuple(_seen_pairs(recording, disturbances, detections)) if len(recording.moments) else (),
        possible=tuple(dict.fromkeys(possible)),
    )
    # Boxes that overlap violate the RSS distance, so they are here; CommonRoad's are noted already.
    return findings, () if len(recording.moments) else find_overlaps(recording, disturbances.pairs)


def _ids_of(recording: Recording, pairs: Pairs) -> Iterator[tuple[int, int]]:
    """The ids of the vehicles of each pair, the smaller first."""
    ids = recording.vehicle_id
    for one, other in zip(ids[pairs.first].tolist(), ids[pairs.second].tolist(), strict=True):
        yield min(one, other), max(one, other)


def _note_on_uncertain(matches: Sequence[Match]) -> Iterator[str]:
    count = sum(match.uncertain for match in matches)
    if count:
        yield f"{count} of {len(matches)} matches depend on less than places along the road may be off"


def _seen_pairs(
    recording: Recording, disturbances: Disturbances, detections: tuple[Detection, ...]
) -> Iterator[FramePair]:
    ids = recording.vehicle_id
    violating = set(zip(disturbances.pairs.first.tolist(), disturbances.pairs.second.tolist(), strict=True))
    place = {number: v for v, number in enumerate(ids.tolist())}
    detected = {(place[a], place[b]) for a, b in (x.pair for x in detections)}
    for first, second in sorted(violating | detected):
        yield frame_pair(recording, first, second, (first, second) in violating)


# What is counted in all windows together, and what is listed, each in which order.
_ADDED = ("vehicles", "samples", "triples", "asked", "undecided", "differing")
_ORDERS: Mapping[str, Callable[[Any], Any] | None] = {
    "violating": None,
    "traces": attrgetter("first", "second", "min_danger"),
    "matches": lambda x: (x.sv, x.pov, x.pov2 or 0, x.min_danger, x.set_name, x.scenario),
    "detections": order_of_detections,
    "seen": attrgetter("first", "second"),
    "possible": attrgetter("first", "second", "min_danger", "set_name", "scenario"),
}


@dataclass
class _Tally:
    questions: EvaluationQuestions
    asked: int = 0
    undecided: int = 0
    differing: int = 0

    def ask(
        self, monitor: Monitor[MonitorKey], seen: Observation, arises: Bools
    ) -> Mapping[MonitorKey, Bools]:
        """Return for each question which traces, of those where danger ``arises``, satisfy it."""
        convention = self.questions.settings.convention
        answers = monitor.evaluate(seen, convention).answers
        others = monitor.holds(seen, OTHER[convention])
        true = {}
        for key, answer in answers.items():
            true[key] = answer.true & arises
            self.asked += int(np.count_nonzero(arises))
            self.undecided += int(np.count_nonzero(answer.undecided & arises))
            self.differing += int(np.count_nonzero((answer.true != others[key]) & arises))
        return true


def _match_pairs(
    recording: Recording, questions: EvaluationQuestions, disturbances: Disturbances, tally: _Tally
) -> tuple[list[Match], list[PossibleMatch]]:
    end = np.max(disturbances.end, axis=0, initial=-1)
    chosen = np.flatnonzero(end >= 0)
    chosen = chosen[np.argsort(disturbances.start[chosen] - end[chosen], kind="stable")]  # the longest first
    if not len(chosen) or not questions.pairs:
        return [], []
    pairs, start = disturbances.pairs.choose(chosen), disturbances.start[chosen]
    vehicles = pairs.vehicles
    at = zip((LANE, OTHER_LANE), vehicles.values(), strict=True)
    lanes = {lane: _lane_at(recording, vehicle, start) for lane, vehicle in at}
    ends = tuple(x[chosen] for x in disturbances.end)
    return _ask_all(recording, questions, questions.pairs, vehicles, start, ends, lanes, tally)


def _candidates(window: TimeWindow, questions: EvaluationQuestions, disturbances: Disturbances) -> CutTriples:
    """Triples in which danger arises and whose start allows a scenario of three cars."""
    recording = window.recording
    triples = triples_of(recording, disturbances.pairs, disturbances.meeting)
    triples = triples.choose(window.has(triples.sv, triples.pov1, triples.pov2))
    cut = cut_triples(questions, disturbances, triples)
    assert questions.triple_start is not None
    if not len(cut.triples):
        return cut
    lanes = {LANE: _lane_at(recording, cut.triples.sv, cut.start)}
    vehicles, signals = cut.triples.vehicles, questions.triple_start.signals
    batch = gather(recording, vehicles, cut.start, cut.start, signals, lanes, questions.lane_atoms)
    return cut.choose(questions.triple_start.holds(batch)[START])


def _match_triples(
    recording: Recording, questions: EvaluationQuestions, cut: CutTriples, tally: _Tally
) -> list[Match]:
    triples = cut.triples
    if not len(triples):
        return []
    lanes = {LANE: _lane_at(recording, triples.sv, cut.start)}
    vehicles = triples.vehicles
    monitors = questions.triples
    return _ask_all(recording, questions, monitors, vehicles, cut.start, cut.end, lanes, tally)[0]


def _ask_all(
    recording: Recording,
    questions: EvaluationQuestions,
    monitors: tuple[Monitor[MonitorKey], ...],
    vehicles: Mapping[str, Integers],
    start: Integers,
    ends: tuple[Integers, ...],
    lanes: Mapping[str, Integers],
    tally: _Tally,
) -> tuple[list[Match], list[PossibleMatch]]:
    """Return the traces that satisfy each question for each minDanger, each cut at its own end.

    On a measured road, for pairs also those that may, as places are off.
    """
    matches, possible = list[Match](), list[PossibleMatch]()
    last = np.max(ends, axis=0)
    signals = [signal for monitor in monitors for signal in monitor.signals]
    states = frozenset[Formula]().union(*(monitor.states for monitor in monitors))
    atoms = {formula: atom for formula, atom in questions.lane_atoms.items() if formula in states}
    batch = gather(recording, vehicles, start, last, signals, lanes, atoms)
    seen: Observation | None = None
    for k, (monitor, end) in enumerate(zip(monitors, ends, strict=True)):
        seen = monitor.observe(batch, known=seen)
        arises = end >= 0
        lengths = np.where(arises, end - start + 1, batch.lengths)
        true = tally.ask(monitor, seen.cut(lengths), arises)
        convention, formulas = questions.settings.convention, monitor.formulas
        trace_questions = TraceQuestions(
            formulas, vehicles, start, end, lanes, questions.lane_atoms, convention
        )
        paired = len(vehicles) == len(PAIR)
        bounds = _bounds(
            recording, trace_questions, arises if paired else np.logical_or.reduce([*true.values()])
        )
        for key, hit in true.items():
            hits = np.flatnonzero(hit)
            uncertain = np.zeros(len(hits), np.bool_) if bounds is None else ~bounds[key].surely[hits]
            matches += _matches_of(recording, key, trace_questions.choose(hits), k, uncertain)
            if bounds is not None and paired:
                unmatched = np.flatnonzero(bounds[key].perhaps & ~hit)
                possible += _possible_of(recording, key, trace_questions.choose(unmatched), k)
    return matches, possible


def _bounds(
    recording: Recording, trace_questions: TraceQuestions[MonitorKey], chosen: Bools
) -> dict[MonitorKey, TruthBounds] | None:
    """The bounds of the answers to all traces, false where not ``chosen``; None where places are exact."""
    if recording.slack is None:
        return None
    bounds = {}
    for key, bound in truth_bounds(recording, recording.slack, trace_questions.choose(chosen)).items():
        bounds[key] = TruthBounds(*np.zeros((2, len(chosen)), np.bool_))
        bounds[key].surely[chosen], bounds[key].perhaps[chosen] = bound.surely, bound.perhaps
    return bounds


def _matches_of(
    recording: Recording,
    key: MonitorKey,
    trace_questions: TraceQuestions[MonitorKey],
    min_danger: int,
    uncertain: Bools,
) -> Iterator[Match]:
    """A match for each trace."""
    vehicles = [recording.vehicle_id[index].tolist() for index in trace_questions.vehicles.values()]
    sv, pov = vehicles[:2] if key.sv == "first" else vehicles[1::-1]
    pov2 = vehicles[2] if len(vehicles) > 2 else repeat(None)
    names = _lane_names(recording)
    lanes = [names[lane] for lane in trace_questions.lanes[key.lane].tolist()]
    frames = trace_questions.low.tolist(), trace_questions.high.tolist()
    question = map(repeat, (min_danger, key.set_name, key.number))
    return map(Match, sv, pov, pov2, lanes, *frames, *question, uncertain.tolist())


def _possible_of(
    recording: Recording, key: MonitorKey, trace_questions: TraceQuestions[MonitorKey], min_danger: int
) -> Iterator[PossibleMatch]:
    """A possible match for each trace, whichever of the two is SV."""
    ids = (recording.vehicle_id[index].tolist() for index in trace_questions.vehicles.values())
    return map(PossibleMatch, *ids, *map(repeat, (min_danger, key.set_name, key.number)))


def _lane_at(recording: Recording, vehicle: Integers, frame: Integers) -> Integers:
    lane: Integers = recording.lane[row_of(recording, vehicle, frame)]
    return lane


def _lane_names(recording: Recording) -> list[str]:
    """The names of the lanes by their indices, the last that of -1: empty, of a box that is on no lane."""
    return [*(lane.name for lane in recording.lanes), ""]


def _traces(
    recording: Recording, questions: EvaluationQuestions, disturbances: Disturbances
) -> Iterator[DisturbanceTrace]:
    known = np.flatnonzero(disturbances.start != NEVER)
    pairs, start = disturbances.pairs.choose(known), disturbances.start[known]
    sectors = _sectors_at(recording, questions, pairs, start)
    names = _lane_names(recording)
    lanes = [_lane_at(recording, vehicle, start) for vehicle in (pairs.first, pairs.second)]
    columns = (recording.vehicle_id[pairs.first], recording.vehicle_id[pairs.second], start, *lanes)
    ends = zip(*(x[known].tolist() for x in disturbances.end), strict=True)
    for p, (row, each) in enumerate(zip(zip(*(x.tolist() for x in columns), strict=True), ends, strict=True)):
        first, second, frame, *at = row
        one, other = (names[lane] for lane in at)
        within = tuple(name for name, there in sectors.items() if there[p])
        for k, end in enumerate(each):
            if end >= 0:
                yield DisturbanceTrace(first, second, k, frame, end, one, other, within)


def _sectors_at(
    recording: Recording, questions: EvaluationQuestions, pairs: Pairs, frame: Integers
) -> dict[str, Bools]:
    """Return for each road sector of the road which of the pairs are in it at ``frame``."""
    everywhere = np.ones(len(pairs), bool)
    if not len(pairs):
        return {x.name: everywhere for x in questions.sectors}
    monitor = questions.where
    batch = gather(recording, pairs.vehicles, frame, frame, monitor.signals, None, questions.lane_atoms)
    inside = monitor.holds(batch)
    return {x.name: inside.get(x, everywhere) for x in questions.sectors}
