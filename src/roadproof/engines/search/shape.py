"""What a drive looks like once its choices are made: objectives for ``solve.smooth``, and rational numbers.

Speeds at the samples are rounded and positions follow from them, so errors do not add up along the
drive: at most grain·dt/2 a step.
"""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from roadproof.engines.encode.build import NONE, ground
from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.problem import Column, ColumnInequality, Problem, evaluate, implicant
from roadproof.engines.encode.unroll import unroll_at
from roadproof.engines.search.initial_conditions import Start
from roadproof.engines.solve.bounds import Affine, Bound, TooNonlinearError, value_of
from roadproof.engines.solve.milp import box_of
from roadproof.engines.solve.smooth import Square, minimise, narrow, near
from roadproof.evidence.claim import Objective
from roadproof.library.scenarios import is_violation
from roadproof.logic.custom_names import HALF
from roadproof.logic.formula import Application, Formula, subformulas
from roadproof.logic.terms import Signal
from roadproof.world.drive import Course, Drive, Motion, Piece
from roadproof.world.polynomial import Polynomial
from roadproof.world.road import Road
from roadproof.world.signals import OwnName, SignalName
from roadproof.world.vehicle import Vehicle

ROUNDS = 3


def reshape(
    problem: Problem,
    layout: Layout,
    road: Road,
    vehicles: Mapping[str, Vehicle],
    found: Sequence[float],
    objective: Objective,
    depths: Sequence[ColumnInequality] = (),
) -> tuple[float, ...]:
    """A better drive than ``found`` for the same choices; ``found`` where there is none.

    ``depths``: inequalities of which mild makes the values small and severe great.
    """
    choices = implicant(problem.circuit, lambda inequality: value_of(inequality, found))
    squares = list(comfort(layout, road, vehicles, found))
    widths = [_trust_column(column) for column in problem.columns]
    best = tuple(found)
    for _ in range(ROUNDS):
        box = narrow(box_of(problem), best, widths)
        try:
            bounds = [near(inequality, best, box) for inequality in choices]
        except TooNonlinearError:
            break
        cost = None
        if objective == "margin":
            box, bounds, cost = _with_margin(box, bounds)
        elif objective in ("mild", "severe") and depths:
            cost = _depth(depths, best, 1.0 if objective == "mild" else -1.0)
        better = minimise(problem.rows, box, bounds, squares, cost)
        if better is None:
            break
        best = better[: len(problem.columns)]
    return best


def _trust_column(column: Column) -> float:
    """How far a column may move in one round; an own signal over its whole range."""
    signal = column.of.signal
    return float(column.high - column.low) if isinstance(signal, OwnName) else _trust(signal)


def _trust(signal: SignalName) -> float:
    """How far a signal may move in one round, so that squares are nearly straight."""
    match signal:
        case "s":
            return 400.0
        case "d":
            return 10.0
        case "v_lon":
            return 4.0
        case "v_lat":
            return 0.6
        case _:
            raise ValueError(f"signal={signal}: it is not known how far it may move in one round")


def comfort(
    layout: Layout, road: Road, vehicles: Mapping[str, Vehicle], found: Sequence[float]
) -> Iterator[Square]:
    """Little jerk and acceleration, near the middle of the lane that ``found`` is nearest to."""
    steps = layout.grid.steps
    weights: Mapping[SignalName, tuple[float, float]] = {"a_lon": (1.0, 0.1), "a_lat": (1.0, 0.5)}
    for name, vehicle in vehicles.items():
        middles = sorted({float(x.d[0] + x.d[1] + vehicle.width) / 2 for x in road.lanelets})
        pace = float(sum(vehicle.cruise)) / 2
        for k in range(steps):
            for signal, (jerk, effort) in weights.items():
                now, later = _affine(layout, name, signal, k), _affine(layout, name, signal, k + 1)
                yield Square(jerk, later + now.scaled(-1.0))
                yield Square(effort, now)
        for k in range(steps + 1):
            side = found[layout.column(name, "d", k)]
            middle = min(middles, key=lambda m: abs(m - side))
            yield Square(1.0, _affine(layout, name, "d", k) + Affine((), -middle))
            yield Square(0.002, _affine(layout, name, "v_lon", k) + Affine((), -pace))


def _affine(layout: Layout, name: str, signal: SignalName, step: int) -> Affine:
    polynomial: Polynomial[int] = layout.state(name, signal, step)
    terms = tuple((m[0], float(c)) for m, c in polynomial.terms.items() if m)
    return Affine(terms, float(polynomial.constant))


def _with_margin(
    box: list[tuple[float, float]], bounds: list[Bound]
) -> tuple[list[tuple[float, float]], list[Bound], Affine]:
    """One more column that no inequality with a margin may fall below, to be made great."""
    extra = len(box)
    raised = [Bound(b.affine + Affine(((extra, -1.0),), 0.0), 0.0) if b.margin > 0 else b for b in bounds]
    least = min((b.margin for b in bounds if b.margin > 0), default=0.0)
    return [*box, (least, 1000.0)], raised, Affine(((extra, -100.0),), 0.0)


def _depth(depths: Sequence[ColumnInequality], point: Sequence[float], sign: float) -> Affine:
    """The sum of the inequalities' values, straightened at ``point``."""
    total = Affine((), 0.0)
    for inequality in depths:
        for monomial, coefficient in inequality.polynomial.terms.items():
            for position, column in enumerate(monomial):
                factor = float(coefficient) * sign / len(depths)
                for other in monomial[:position] + monomial[position + 1 :]:
                    factor *= point[other]
                total = total + Affine(((column, factor),), 0.0)
    return total


def violation_depths(
    formula: Formula, vehicles: Mapping[str, Vehicle], layout: Layout, found: Sequence[float]
) -> tuple[ColumnInequality, ...]:
    """By how much RSS distances fall short wherever ``found`` violates them: inequalities with that value.

    They are the comparisons with a distance in each ``rssViolation`` that is true at a sample, which
    are those of degree 2.
    """
    depths: list[ColumnInequality] = []
    for part in subformulas(formula):
        if isinstance(part, Application) and is_violation(part.name):
            for step in range(layout.grid.steps + 1):
                circuit = ground(unroll_at(part, layout.grid, step), vehicles, layout, NONE)
                if evaluate(circuit, lambda inequality: value_of(inequality, found) > 0):
                    chosen = implicant(circuit, lambda inequality: value_of(inequality, found))
                    depths += [inequality for inequality in chosen if inequality.polynomial.degree > 1]
    return tuple(depths)


def round_drive(
    layout: Layout,
    vehicles: Mapping[str, Vehicle],
    values: Sequence[float | Fraction],
    grain: Fraction | None = Fraction(1, 1000),
    begun: Start | None = None,
) -> Drive:
    """The drive with the given column values; speeds in multiples of ``grain`` m/s, None for exact.

    What a start says to be one value is that one, whatever the grain.
    """
    said = {} if begun is None else begun.exact

    def rounded(value: float | Fraction, step: Fraction | None) -> Fraction:
        return Fraction(value) if step is None else round(Fraction(value) / step) * step

    def start(name: str, signal: SignalName) -> Fraction:
        condition = said.get(Signal(signal, name))
        if condition is not None:
            other = condition.beside
            return condition.low + (0 if other is None else start(other.vehicle, other.name))
        return rounded(values[layout.column(name, signal, 0)], None if grain is None else grain * 10)

    def speeds(name: str, signal: SignalName, change: SignalName) -> list[Fraction]:
        columns = [layout.column(name, signal, k) for k in range(layout.grid.steps + 1)]
        found = [rounded(values[column], grain) for column in columns]
        if Signal(signal, name) in said:
            found[0] = said[Signal(signal, name)].low
        if Signal(change, name) in said:
            found[1] = found[0] + said[Signal(change, name)].low * layout.grid.dt
        return found

    motions = {}
    for name in layout.vehicles:
        along, across = speeds(name, "v_lon", "a_lon"), speeds(name, "v_lat", "a_lat")
        motions[name] = Motion(
            vehicles[name].length,
            vehicles[name].width,
            start(name, "s"),
            start(name, "d"),
            along[0],
            across[0],
            _pieces(along, across, layout.grid.dt),
            vehicles[name].kind,
        )
    return Drive(motions, _courses(layout, values, grain))


def _courses(
    layout: Layout, values: Sequence[float | Fraction], grain: Fraction | None
) -> dict[tuple[str, str], Course]:
    """Own signals, each constant from a sample to the next; equal neighbours are one piece."""
    made: dict[tuple[str, str], Course] = {}
    for own in layout.own:
        name, vehicle = own.signal.name, own.signal.vehicle
        course: list[tuple[Fraction, Fraction]] = []
        for step in range(layout.grid.steps + 1):
            value = Fraction(values[layout.own_column(vehicle, name, step)])
            if own.signal.truth:
                value = Fraction(value > HALF)
            elif grain is not None:
                value = min(max(round(value / grain) * grain, own.range[0]), own.range[1])
            if not course or course[-1][1] != value:
                course.append((step * layout.grid.dt, value))
        made[name, vehicle] = tuple(course)
    return made


def _pieces(along: Sequence[Fraction], across: Sequence[Fraction], dt: Fraction) -> tuple[Piece, ...]:
    """Constant accelerations between samples; equal neighbours are one piece."""
    pieces: list[Piece] = []
    for k in range(len(along) - 1):
        a_lon, a_lat = (along[k + 1] - along[k]) / dt, (across[k + 1] - across[k]) / dt
        before = pieces[-1] if pieces else None
        if (
            before is not None
            and before.duration is not None
            and (before.a_lon, before.a_lat) == (a_lon, a_lat)
        ):
            pieces[-1] = Piece(before.duration + dt, a_lon, a_lat)
        else:
            pieces.append(Piece(dt, a_lon, a_lat))
    return (*pieces, Piece(None, Fraction(0), Fraction(0)))
