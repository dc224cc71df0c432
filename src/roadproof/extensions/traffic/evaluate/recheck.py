"""Answers of an evaluation asked once more, one by one, of the plain recursive evaluator."""

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from roadproof.extensions.traffic.evaluate.courses import BEGINS
from roadproof.extensions.traffic.evaluate.evaluate import Findings
from roadproof.extensions.traffic.evaluate.foretelling import label_of, last_common, scene_in
from roadproof.extensions.traffic.evaluate.matching import Match
from roadproof.extensions.traffic.evaluate.questions import EvaluationQuestions, MonitorKey, of_three
from roadproof.extensions.traffic.evaluate.recursive import ReadAs, SampledTrace, TraceReader
from roadproof.extensions.traffic.evaluate.traces import OTHER_LANE, gather_one
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.library.scenarios import LANE, PAIR, TRIPLE
from roadproof.logic.formula import Formula, transform
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import Monitor


def recheck(recording: Recording, questions: EvaluationQuestions, findings: Findings) -> Iterator[str]:
    """One line for each answer that the recursive evaluator denies; of nothing denied, none.

    Pairs are asked every question again, so that a match that was missed shows as well as one too
    many; of triples only the matches are asked. What is taken over from the evaluation is where
    traces start and end.
    """
    pairs, triples = _shared(questions.pairs), _shared(questions.triples)
    matched = set(findings.matches)
    place = {int(number): k for k, number in enumerate(recording.vehicle_id)}
    names = [lane.name for lane in recording.lanes]
    for t in findings.traces if questions.pairs else ():
        lanes = {LANE: t.first_lane, OTHER_LANE: t.second_lane}
        reading = _read(
            recording,
            questions,
            {PAIR[0]: place[t.first], PAIR[1]: place[t.second]},
            {name: names.index(lane) if lane else -1 for name, lane in lanes.items()},
            (t.start_frame, t.end_frame),
        )
        for key, formula in pairs[t.min_danger].items():
            sv, pov = (t.first, t.second) if key.sv == "first" else (t.second, t.first)
            lane = lanes[key.lane]
            match = Match(
                sv, pov, None, lane, t.start_frame, t.end_frame, t.min_danger, key.set_name, key.number
            )
            if reading.holds(formula, 0, _view(questions)) != (match in matched):
                yield _line(recording, match, match in matched)
    for match in findings.matches:
        if match.pov2 is not None:
            formula = triples[match.min_danger][of_three(match.set_name, match.scenario)]
            vehicles = dict(zip(TRIPLE, (place[x] for x in (match.sv, match.pov, match.pov2)), strict=True))
            frames = (match.start_frame, match.end_frame)
            reading = _read(recording, questions, vehicles, {LANE: names.index(match.lane)}, frames)
            if not reading.holds(formula, 0, _view(questions)):
                yield _line(recording, match, True)
        if match.labels:
            frame, labels = _driver_labels(recording, questions, match, place)
            if (frame, labels) != (match.begun, match.labels):
                yield (
                    f"{_about(recording, match)}: found {_labels_text(match.begun, match.labels)}, but the "
                    f"recursive evaluator has {_labels_text(frame, labels)}"
                )


def _driver_labels(
    recording: Recording, questions: EvaluationQuestions, match: Match, place: Mapping[int, int]
) -> tuple[int | None, tuple[str, ...]]:
    """Return when the manoeuvre of a match begins, sample by sample, and the labels of drivers."""
    course = next(x for x in questions.courses if match.scenario in x.scenarios)
    ids = [match.sv, match.pov] if match.pov2 is None else [match.sv, match.pov, match.pov2]
    vehicles = dict(zip(course.vehicles, (place[x] for x in ids), strict=True))
    last = int(last_common(recording, np.array([[x] for x in vehicles.values()]))[0])
    frames = match.start_frame, last
    reading = TraceReader(trace_of(gather_one(recording, vehicles, frames, course.begins.signals)))
    begins = course.begins.formulas[BEGINS]
    samples = range(frames[1] - frames[0] + 1)
    frame = next((frames[0] + k for k in samples if reading.holds(begins, k, "strong")), None)
    scene = None if frame is None else scene_in(recording, course, vehicles, frames, {})
    return frame, tuple(label_of(course, scene, x) for x in questions.settings.drivers)


def _labels_text(frame: int | None, labels: Iterable[str]) -> str:
    return f"{', '.join(x or 'nothing' for x in labels)}" + ("" if frame is None else f" at frame {frame}")


def _shared(monitors: Iterable[Monitor[MonitorKey]]) -> list[dict[MonitorKey, Formula]]:
    """The formulas as they were given, equal parts being one object: they are then found quickly."""
    known: dict[Formula, Formula] = {}
    return [
        {key: transform(x, lambda part: known.setdefault(part, part)) for key, x in m.formulas.items()}
        for m in monitors
    ]


def _read(
    recording: Recording,
    questions: EvaluationQuestions,
    vehicles: Mapping[str, int],
    lanes: Mapping[str, int],
    frames: tuple[int, int],
) -> TraceReader:
    signals = [signal for monitor in (*questions.pairs, *questions.triples) for signal in monitor.signals]
    batch = gather_one(recording, vehicles, frames, signals, lanes, questions.lane_atoms)
    return TraceReader(trace_of(batch))


def trace_of(batch: Batch) -> SampledTrace:
    """The only trace of a batch as the recursive evaluator wants it."""
    length = int(batch.lengths[0])
    return SampledTrace(
        batch.dt,
        length,
        {key: values[:length, 0].tolist() for key, values in batch.signals.items()},
        {key: float(values[0]) for key, values in batch.sizes.items()},
        {key: values[:length, 0].tolist() for key, values in batch.given.items()},
    )


def _view(questions: EvaluationQuestions) -> ReadAs:
    return "clip" if questions.settings.convention == "clip" else "strong"


def _line(recording: Recording, match: Match, is_found: bool) -> str:
    verdict = (
        "found, but the recursive evaluator denies it"
        if is_found
        else "missed, but the recursive evaluator has it"
    )
    return f"{_about(recording, match)}: {verdict}"


def _about(recording: Recording, match: Match) -> str:
    who = ", ".join(str(x) for x in (match.sv, match.pov, match.pov2) if x is not None)
    return (
        f"recording {recording.name}, vehicles {who}, frames {match.start_frame} to {match.end_frame}, "
        f"{match.set_name}, scenario {match.scenario}"
    )
