"""Gaps of a spec set among the disturbances of recorded traffic, in the classes of the survey.

A disturbance (dangerArises of a pair) is read as samples that stay as the last one is for ever, so that
the end of a trace leaves nothing undecided.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from roadproof.analysis.coverage.claims import missed, numbers_on
from roadproof.analysis.coverage.classes import Classes
from roadproof.analysis.requests import Asked
from roadproof.monitor.batch import Array, Batch
from roadproof.monitor.compiled import Monitor, compile
from roadproof.spec.bind import bind
from roadproof.spec.elaborate import read_claim
from roadproof.traffic.evaluate import evaluate_recording
from roadproof.traffic.one_trace import OneTrace, cut_trace
from roadproof.traffic.questions import Settings, ask
from roadproof.traffic.recording import Recording
from roadproof.traffic.sources import find_sources
from roadproof.world.road import Road

TAIL = 3.0  # seconds, more than the windows of a scenario reach together


@dataclass(frozen=True)
class Missed:
    """Whether a trace is a gap; with the key of a part, whether it would be none without that part."""

    without: str | None = None


@dataclass(frozen=True)
class Trace:
    """A disturbance between two vehicles of a recording; ``missed``: no scenario, any lane, either role.

    ``classes``: the keys of the parts without which a scenario would hold.
    """

    recording: str
    first: int
    second: int
    frames: tuple[int, int]
    missed: bool
    classes: tuple[str, ...]


def disturbances_in(asked: Asked, folder: Path) -> Iterator[Trace]:
    """The disturbances of all recordings of a folder, with ``minDanger`` and the other values of ``asked``.

    Raises ``InputError`` for what is no recording.
    """
    library, specification = asked.load()
    classes = Classes(asked)
    settings = Settings(
        library,
        asked.options,
        classes.values,
        asked.sets,
        (classes.values["minDanger"],),
    )
    for source in find_sources(folder):
        recording = source.read()
        place = {int(number): k for k, number in enumerate(recording.vehicle_id)}
        monitors: dict[Road, Monitor[Missed]] = {}
        for trace in evaluate_recording(recording, ask(settings, recording.rate)).traces:
            pair = {"SV": place[trace.first], "POV": place[trace.second]}
            cut = _cut(recording, pair, (trace.start_frame, trace.end_frame))
            if cut.road not in monitors:
                query = read_claim(specification, missed(numbers_on(specification, cut.road)))
                gap = bind(query.formula, cut.road, {}, classes.values)
                near = {Missed(key): formula for key, formula in classes.bind(cut.road).items()}
                monitors[cut.road] = compile({Missed(): gap, **near})
            answers = monitors[cut.road].evaluate(cut.batch, "clip").answers
            true = [missed.without for missed, answer in answers.items() if answer.true[0]]
            frames = (trace.start_frame, trace.end_frame)
            keys = tuple(key for key in true if key is not None)
            yield Trace(recording.name, trace.first, trace.second, frames, None in true, keys)


def _cut(recording: Recording, pair: dict[str, int], frames: tuple[int, int]) -> OneTrace:
    """Two vehicles from the first frame to the last, and as at the last one for some seconds more."""
    trace = cut_trace(recording, recording.name, pair, frames)
    more = round(TAIL * recording.rate)
    batch = trace.batch

    def longer(values: Array) -> Array:
        return np.concatenate([values, np.repeat(values[-1:], more, axis=0)])

    signals = {name: longer(values) for name, values in batch.signals.items()}
    given = {formula: longer(values) for formula, values in batch.given.items()}
    return replace(trace, batch=Batch(batch.dt, batch.lengths + more, signals, batch.sizes, given))
