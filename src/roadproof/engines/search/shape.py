"""Shapes drives once all choices are made: objectives for ``solve.smooth``, and rounding to rationals.

Speeds at the samples are rounded and positions follow from them, so errors do not add up along the drive:
at most grain·dt/2 a step.
"""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from roadproof.engines.encode.build import NO_MARGIN, ground_atoms
from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.problem import ColumnInequality, Problem, RealColumn, evaluate, implicant
from roadproof.engines.encode.unroll import unroll_at
from roadproof.engines.search.initial_conditions import Start
from roadproof.engines.solve.bounds import Affine, Bound, TooNonlinearError, polynomial_value
from roadproof.engines.solve.milp import column_box
from roadproof.engines.solve.smooth import Square, linearise_at, minimise, trust_box
from roadproof.evidence.claim import Objective
from roadproof.library.scenarios import is_violation
from roadproof.logic.custom_names import HALF
from roadproof.logic.formula import Application, Formula, subformulas
from roadproof.logic.terms import Signal
from roadproof.world.drive import Course, Drive, Motion, Piece
from roadproof.world.polynomial import Polynomial
from roadproof.world.road import Road
from roadproof.world.signals import CustomSignalName, SignalName
from roadproof.world.vehicle import Vehicle

ROUNDS = 3


def reshape(
    problem: Problem,
    layout: ColumnLayout,
    road: Road,
    vehicles: Mapping[str, Vehicle],
    point: Sequence[float],
    objective: Objective,
    depths: Sequence[ColumnInequality] = (),
) -> tuple[float, ...]:
    """Return column values of a better drive than ``point``, or ``point`` itself; they are not judged yet.

    Better is smoother, nearer to cruising speed and lane centre, and better for ``objective``.
    Inequalities that ``implicant`` picks at ``point`` are kept, up to rounding. ``depths``: inequalities
    whose values the objective mild makes small and severe makes great. Raises ``MissingSolverError``
    without Clarabel.
    """
    choices = implicant(problem.circuit, lambda inequality: polynomial_value(inequality, point))
    squares = list(comfort_objective(layout, road, vehicles, point))
    widths = [_trust_column(column) for column in problem.columns]
    best = tuple(point)
    for _ in range(ROUNDS):
        box = trust_box(column_box(problem), best, widths)
        try:
            bounds = [linearise_at(inequality, best, box) for inequality in choices]
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


def _trust_column(column: RealColumn) -> float:
    """Return how far a column may move in one round; a custom signal may move over its whole range."""
    signal = column.of.signal
    return float(column.high - column.low) if isinstance(signal, CustomSignalName) else _trust(signal)


def _trust(signal: SignalName) -> float:
    """Return how far a signal may move in one round, so that squares are nearly straight."""
    match signal:
        case "s":
            return 400.0
        case "d":
            return 10.0
        case "v_lon":
            return 4.0
        case "v_lat":
            return 0.6
        case _:  # open: only signals that a drive starts with have columns
            raise ValueError(f"signal={signal}: it is not known how far it may move in one round")


def comfort_objective(
    layout: ColumnLayout, road: Road, vehicles: Mapping[str, Vehicle], point: Sequence[float]
) -> Iterator[Square]:
    """Yield costs of jerk, acceleration, speed off cruise and distance from the nearest lane centre."""
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
            side = point[layout.column(name, "d", k)]
            middle = min(middles, key=lambda m: abs(m - side))
            yield Square(1.0, _affine(layout, name, "d", k) + Affine((), -middle))
            yield Square(0.002, _affine(layout, name, "v_lon", k) + Affine((), -pace))


def _affine(layout: ColumnLayout, name: str, signal: SignalName, step: int) -> Affine:
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
    formula: Formula, vehicles: Mapping[str, Vehicle], layout: ColumnLayout, point: Sequence[float]
) -> tuple[ColumnInequality, ...]:
    """Return inequalities whose value is the shortfall of RSS distances wherever ``point`` violates them.

    They are the comparisons with a distance, of degree 2, in each ``rssViolation`` that is true at a sample.
    """
    depths: list[ColumnInequality] = []
    for part in subformulas(formula):
        if isinstance(part, Application) and is_violation(part.name):
            for step in range(layout.grid.steps + 1):
                circuit = ground_atoms(unroll_at(part, layout.grid, step), vehicles, layout, NO_MARGIN)
                if evaluate(circuit, lambda inequality: polynomial_value(inequality, point) > 0):
                    chosen = implicant(circuit, lambda inequality: polynomial_value(inequality, point))
                    depths += [inequality for inequality in chosen if inequality.polynomial.degree > 1]
    return tuple(depths)


def round_drive(
    layout: ColumnLayout,
    vehicles: Mapping[str, Vehicle],
    values: Sequence[float | Fraction],
    grain: Fraction | None = Fraction(1, 1000),
    fixed_start: Start | None = None,
) -> Drive:
    """Return the drive with the given column values; speeds in multiples of ``grain`` m/s, None for exact.

    Values that a start fixes are kept exactly, whatever the grain.
    """
    fixed = {} if fixed_start is None else fixed_start.exact

    def rounded(value: float | Fraction, step: Fraction | None) -> Fraction:
        return Fraction(value) if step is None else round(Fraction(value) / step) * step

    def start(name: str, signal: SignalName) -> Fraction:
        """Return the value of a signal at time 0."""
        condition = fixed.get(Signal(signal, name))
        if condition is not None:
            other = condition.beside
            return condition.low + (0 if other is None else start(other.vehicle, other.name))
        return rounded(values[layout.column(name, signal, 0)], None if grain is None else grain * 10)

    def speeds(name: str, signal: SignalName, change: SignalName) -> list[Fraction]:
        """Return the speeds at all samples; fixed start values are kept."""
        columns = [layout.column(name, signal, k) for k in range(layout.grid.steps + 1)]
        samples = [rounded(values[column], grain) for column in columns]
        if Signal(signal, name) in fixed:
            samples[0] = fixed[Signal(signal, name)].low
        if Signal(change, name) in fixed:
            samples[1] = samples[0] + fixed[Signal(change, name)].low * layout.grid.dt
        return samples

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
    return Drive(motions, _custom_trajectories(layout, values, grain))


def _custom_trajectories(
    layout: ColumnLayout, values: Sequence[float | Fraction], grain: Fraction | None
) -> dict[tuple[str, str], Course]:
    """Custom signals, each constant from a sample to the next; equal neighbours are one piece."""
    made: dict[tuple[str, str], Course] = {}
    for own in layout.custom_signals:
        name, vehicle = own.signal.name, own.signal.vehicle
        course: list[tuple[Fraction, Fraction]] = []
        for step in range(layout.grid.steps + 1):
            value = Fraction(values[layout.custom_signal_column(vehicle, name, step)])
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
