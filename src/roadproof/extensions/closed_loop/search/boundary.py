"""The boundary of a driver model on the knobs of a search: where it begins to prevent a collision.

Nobody drives SV; the first driver model of the scenario is put into its place, on samples.
"""

from collections.abc import Sequence

from roadproof.extensions.closed_loop.search.problem import TargetProblem
from roadproof.extensions.closed_loop.simulation import ControlLoop
from roadproof.extensions.drivers.outcome import Result

Values = tuple[float, ...]
_LINES, _BISECTIONS = 17, 8  # values of the speed of a POV; steps to the boundary on each of them
_PATIENCE = 60.0  # s


def is_prevented(problem: TargetProblem, every: Sequence[Values]) -> list[bool]:
    """Return whether the model prevents a collision in the situations of some values of the knobs."""
    trials = problem.run(ControlLoop(_Coasting(), _PATIENCE), every)
    outcomes = map(problem.foretold, trials)
    return [x is not None and x.result is Result.PREVENTED for x in outcomes]


def boundary_line(problem: TargetProblem, values: Values) -> tuple[tuple[float, float], ...]:
    """Return points of the boundary over the last gap (m) and how much faster SV is (m/s).

    All other knobs have these values. Nothing where the scenario has no model; a speed is left out where all
    gaps lie on one side.
    """
    names = [x.name for x in problem.shape.knobs]
    gaps, speeds = ([k for k, name in enumerate(names) if name.endswith(end)] for end in (".gap", ".faster"))
    if problem.guide is None or not gaps or not speeds:
        return ()
    gap, speed = gaps[-1], speeds[-1]
    low, high = problem.shape.knobs[gap].low, problem.shape.knobs[gap].high
    first, last = problem.shape.knobs[speed].low, problem.shape.knobs[speed].high
    lines = [first + (last - first) * k / (_LINES - 1) for k in range(_LINES)]

    def prevented(distances: Sequence[float]) -> list[bool]:
        every = [list(values) for _ in lines]
        for changed, distance, faster in zip(every, distances, lines, strict=True):
            changed[gap], changed[speed] = distance, faster
        return is_prevented(problem, [tuple(x) for x in every])

    ends = zip(prevented([low] * _LINES), prevented([high] * _LINES), strict=True)
    crossed = [not near and far for near, far in ends]
    lower, upper = [low] * _LINES, [high] * _LINES
    for _ in range(_BISECTIONS):
        middle = [(a + b) / 2 for a, b in zip(lower, upper, strict=True)]
        for k, is_far in enumerate(prevented(middle)):
            (upper if is_far else lower)[k] = middle[k]
    return tuple(
        (round(upper[k], 3), round(-lines[k], 3)) for k, is_crossed in enumerate(crossed) if is_crossed
    )


class _Coasting:
    """A vehicle that nobody drives."""

    def reset(self, observation: object) -> None:
        """Begin a simulation."""

    def step(self, observation: object, dt: float) -> float:
        """Return no acceleration."""
        return 0.0
