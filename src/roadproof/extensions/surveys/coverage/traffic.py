"""Gaps of a spec set among the disturbances of recorded traffic, by class.

A disturbance (dangerArises of a pair) is read as if its last sample lasted for ever. So the end of a trace
leaves nothing undecided. A disturbance in several windows of one recording counts once.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.surveys.coverage.answers import GapTrace, GapTraffic
from roadproof.extensions.surveys.coverage.classes import GapClasses
from roadproof.extensions.traffic.evaluate.evaluate import evaluate_recording
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace, cut_trace
from roadproof.extensions.traffic.evaluate.questions import EvaluationSettings, compile_questions
from roadproof.extensions.traffic.evaluate.totals import ShownMoments, without_repeats
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.reliable import left_out_notes
from roadproof.extensions.traffic.formats.source import RecordingSource
from roadproof.extensions.traffic.formats.sources import copies_among, find_sources
from roadproof.library.bind import bind
from roadproof.library.scenarios import MIN_DANGER, PAIR
from roadproof.questions.basis import Basis
from roadproof.semantics.sampled.batch import Array, Batch
from roadproof.semantics.sampled.compiled import Monitor, compile
from roadproof.world.road import Road

TAIL = 3.0  # seconds, more than the windows of a scenario reach together


@dataclass(frozen=True)
class Recordings:
    """The recordings of a folder."""

    folder: Path
    sources: tuple[RecordingSource, ...]


@dataclass(frozen=True)
class GapQuestion:
    """The question whether a trace is a gap, or with the key of a part, a near miss of that part."""

    without: str | None = None


def recordings_in(folder: Path, strict: bool = False) -> Recordings:
    """Return the recordings of a folder; ``strict``: refuse those that are not read as a whole.

    Raises ``InputError``, also if two have the same content.
    """
    sources = find_sources(folder, strict)
    for fault in copies_among(sources, {source.name: source.digests() for source in sources}).values():
        raise InputError(fault)
    return Recordings(folder, sources)


def count_in_traffic(basis: Basis, recordings: Recordings, say: Callable[[str], None]) -> GapTraffic:
    """Return counts of the disturbances and gaps of all recordings; ``say`` is called with progress."""
    counted = ShownMoments()
    disturbances = 0
    gaps: list[GapTrace] = []
    left_out: list[str] = []
    for disturbances, trace in enumerate(disturbances_in(basis, recordings, counted, left_out), 1):
        gaps += [trace] if trace.missed else []
        say(f"{disturbances} disturbances in traffic, {len(gaps)} of them missed")
    repeats = sum(repeat.what == "trace" for repeat in counted.repeats)
    return GapTraffic(recordings.folder, disturbances, tuple(gaps), repeats, tuple(left_out))


def disturbances_in(
    basis: Basis,
    recordings: Recordings,
    counted: ShownMoments | None = None,
    left_out: list[str] | None = None,
) -> Iterator[GapTrace]:
    """Yield the disturbances of all recordings; ``counted`` collects repeated ones.

    ``left_out`` collects notes on vehicles that recordings were read without. Raises ``InputError`` for a
    file that is no recording.
    """
    classes = GapClasses(basis)
    settings = EvaluationSettings(
        basis.library,
        basis.specification.options,
        classes.values,
        (basis.specification.set_name,),
        (classes.values[MIN_DANGER],),
    )
    known = counted or ShownMoments()
    for source in recordings.sources:
        recording = source.read()
        if left_out is not None:
            left_out += left_out_notes(recording)
        place = {int(number): k for k, number in enumerate(recording.vehicle_id)}
        monitors: dict[Road, Monitor[GapQuestion]] = {}
        findings = without_repeats(
            evaluate_recording(recording, compile_questions(settings, recording.rate)), known
        )
        for trace in findings.traces:
            frames = (trace.start_frame, trace.end_frame)
            pair = dict(zip(PAIR, (place[trace.first], place[trace.second]), strict=True))
            cut = _cut(recording, pair, frames)
            if cut.road not in monitors:
                monitors[cut.road] = _monitor(classes, cut.road)
            answers = monitors[cut.road].evaluate(cut.batch, "clip").answers
            true = [question.without for question, answer in answers.items() if answer.true[0]]
            keys = tuple(key for key in true if key is not None)
            alone = None in true and classes.has(None, keys)
            yield GapTrace(recording.name, trace.first, trace.second, frames, None in true, keys, alone)


def _monitor(classes: GapClasses, road: Road) -> Monitor[GapQuestion]:
    gap = bind(classes.gap_formula(classes.numbers_on(road)).formula, road, {}, classes.values)
    near = {GapQuestion(key): formula for key, formula in classes.bind(road).items()}
    return compile({GapQuestion(): gap, **near})


def _cut(recording: Recording, pair: dict[str, int], frames: tuple[int, int]) -> OneTrace:
    """Return two vehicles from the first frame to the last, whose values then stay for ``TAIL`` seconds."""
    trace = cut_trace(recording, recording.name, pair, frames)
    more = round(TAIL * float(recording.rate))
    batch = trace.batch

    def longer(values: Array) -> Array:
        return np.concatenate([values, np.repeat(values[-1:], more, axis=0)])

    signals = {name: longer(values) for name, values in batch.signals.items()}
    given = {formula: longer(values) for formula, values in batch.given.items()}
    return replace(trace, batch=Batch(batch.dt, batch.lengths + more, signals, batch.sizes, given))
