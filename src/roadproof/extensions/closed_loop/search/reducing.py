"""A failing situation made simple: phases left out, values rounded, as long as it stays a failure.

Each change is simulated first, and kept only if the judge accepts its exact drive.
"""

from collections.abc import Iterator
from fractions import Fraction
from typing import Final, TypeAlias

from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.closed_loop.search.problem import TargetProblem, prevents
from roadproof.extensions.closed_loop.search.shape import Knob
from roadproof.extensions.closed_loop.simulation import ControlLoop
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.runtime.records import dataclass

Values: TypeAlias = tuple[float, ...]
MOST: Final = 40
"""The most exact drives that are judged for one failure."""
_GRAINS = tuple(map(Fraction, ("10", "5", "2", "1", "1/2")))
_REST = ("a_lon", "begin", "change_begin", "place")
"""The quantities of knobs that are best 0: an acceleration that is left out, instants, and a place."""


@dataclass(frozen=True)
class Reduced:
    """A failing drive with its values; ``simulations``: how many it took to make it simple."""

    values: Values
    drive: JudgedDrive
    decisions: tuple[Decision, ...]
    simulations: int


def reduced(problem: TargetProblem, loop: ControlLoop, first: Reduced) -> Reduced:
    """Return a simpler failure; one that a driver model prevents stays one. Raises ``ControllerError``."""
    best, judged, simulations = first, 0, 0
    assert problem.fails is not None
    for k, knob in enumerate(problem.shape.knobs):
        for value in _simpler(knob, best.values[k]):
            values = (*best.values[:k], value, *best.values[k + 1 :])
            [trial] = problem.run(loop, [values])
            simulations += 1
            if trial.shows <= 0 or trial.breaks <= 0:
                continue
            if judged == MOST:
                break
            judged += 1
            situation = problem.shape.situation(values)
            drive = problem.judged(situation, loop, problem.fails, may_overlap=True)
            if drive is None:
                continue
            decisions = problem.decisions(drive)
            if prevents(first.decisions) <= prevents(decisions):
                best = Reduced(values, drive, decisions, 0)
                break
    return Reduced(best.values, best.drive, best.decisions, simulations)


def _simpler(knob: Knob, value: float) -> Iterator[float]:
    """Yield simpler values of a knob, the simplest first."""
    quantity = knob.name.partition(".")[2]
    if quantity in _REST and value:
        yield float(knob.value(0.0))
    if quantity in ("begin", "lasts", "change_begin"):
        return  # instants are steps of the clock
    for grain in _GRAINS:
        near = float(knob.value(float(round(value / float(grain)) * grain)))
        if near != value:
            yield near
