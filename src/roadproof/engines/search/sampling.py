"""Samples states in which a formula about one instant holds.

Points are spread over ranges of signals by a sequence that is the same on every machine, each on a grid
of few digits, and evaluated in vectors. If few satisfy the formula, the search closes in on the nearest.
Every returned state has been judged exactly; an empty result shows nothing.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from roadproof.engines.encode.inequalities import Quantity, term_polynomial
from roadproof.engines.search.patterns import spread
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare, Formula
from roadproof.logic.initial_conditions import top_level_conjuncts
from roadproof.logic.rewrite import leaves_of
from roadproof.logic.terms import CustomSignal, Signal, Size
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.signals import AbstractSignals
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import Monitor, compile
from roadproof.world.polynomial import Polynomial, constant, variable
from roadproof.world.vehicle import Range

State: TypeAlias = Mapping[Signal, Fraction]
Points: TypeAlias = NDArray[np.float64]

POINTS = 1 << 14  # that are looked at in one round
SPREAD, CLOSER = 4, 7  # rounds over all of the space, and of looking around the nearest points
NEAREST = 64  # points that are looked around
NARROWER = 3  # by how much the surroundings shrink from round to round
ENOUGH = 64  # points in which the formula holds, after which no more are looked at
LAST = 256  # points that are judged where those are not enough
CHOICE = 4  # points for each state that is asked for, of which those that differ most come first
DIGITS = 400  # at least so many values in a range


@dataclass(frozen=True)
class Space:
    """The space of samples: a range of each signal (SI), which may be one value, and vehicle sizes (m)."""

    ranges: Mapping[Signal, Range]
    sizes: Mapping[Size, Fraction]


@dataclass(frozen=True)
class _Axis:
    signal: Signal
    low: Fraction
    high: Fraction
    grain: Fraction

    @property
    def count(self) -> int:
        """Return how many values there are beside the first."""
        return int((self.high - self.low) / self.grain)

    def values(self, shares: Points) -> Points:
        """Map shares of the range to whole numbers of grains above its lower end."""
        return np.clip(np.floor(shares * (self.count + 1)), 0, self.count)


def states(formula: Formula, space: Space, most: int) -> list[State]:
    """Return at most ``most`` states in ``space``, unlike each other, in which ``formula`` holds.

    ``formula`` is bound and about one instant. An empty list shows nothing. Raises ``InputError`` where the
    formula cannot be judged, ``KeyError`` for a signal or size without range or value.
    """
    signals = signals_in(formula)
    solved, rest = _solve_equalities(formula, space, signals)
    axes = [_axis(x, *space.ranges[x]) for x in signals if x not in solved]
    looking = _StateSampler(rest, space, axes, solved)
    accepted: list[State] = []
    for point in _spread_out(looking.points(), axes, most):
        state = looking.exactly(point)
        inside = all(space.ranges[x][0] <= value <= space.ranges[x][1] for x, value in state.items())
        if inside and holds(formula, state, space.sizes):
            accepted.append(state)
            if len(accepted) == most:
                break
    return accepted


def holds(formula: Formula, state: State, sizes: Mapping[Size, Fraction]) -> bool:
    """Return whether a bound formula about one instant holds in a state: the judge's word."""
    now: dict[Signal | CustomSignal, tuple[tuple[Fraction, Fraction], ...]] = {
        signal: ((Fraction(0), value),) for signal, value in state.items()
    }
    return judge(formula, AbstractSignals(now, sizes)).holds


def signals_in(formula: Formula) -> list[Signal]:
    """The signals that it speaks of, in an order that depends on it only."""
    return sorted({x for x in leaves_of(formula) if isinstance(x, Signal)}, key=lambda x: (x.name, x.vehicle))


def _axis(signal: Signal, low: Fraction, high: Fraction) -> _Axis:
    grain = Fraction(1)
    while (high - low) / grain < DIGITS and grain > Fraction(1, 100):
        grain /= 10
    least = -(-low // grain) * grain
    return _Axis(signal, least if least <= high else low, high, grain)


# --- equalities --------------------------------------------------------------------------------


def _solve_equalities(
    formula: Formula, space: Space, signals: list[Signal]
) -> tuple[dict[Signal, Polynomial[Quantity]], Formula]:
    """Signals that equalities among the parts of a conjunction give as polynomials; all other parts.

    The polynomials are of signals that are not solved, or solved later. Ranges of one value are equalities.
    """
    ends = {x: space.ranges[x] for x in signals}
    solved: dict[Signal, Polynomial[Quantity]] = {
        x: constant(low) for x, (low, high) in ends.items() if low == high
    }
    used: set[Formula] = set()
    sizes = {(size.vehicle, size.name): value for size, value in space.sizes.items()}
    for left, right in _equalities(formula):
        try:
            rest = term_polynomial(t.subtract(left, right), sizes)
        except ValueError:
            continue  # extrema
        for signal, polynomial in solved.items():
            rest = _substituted(rest, signal, polynomial)
        for signal in sorted(signals, key=lambda x: (x.name not in ("s", "d"), x.name, x.vehicle)):
            alone = (_quantity(signal),)
            others = {m: c for m, c in rest.terms.items() if m != alone}
            if signal in solved or alone not in rest.terms or any(alone[0] in m for m in others):
                continue
            solved[signal] = Polynomial(others).scaled(-1 / rest.terms[alone])
            used |= {Compare(left, "<=", right), Compare(left, ">=", right)}
            break
    if not used:
        return solved, formula
    varying = [x for x in solved if ends[x][0] < ends[x][1]]
    inside = [Compare(x, ">=", t.number(ends[x][0])) for x in varying]
    inside += [Compare(x, "<=", t.number(ends[x][1])) for x in varying]
    return solved, f.conjunction(
        *(part for part in top_level_conjuncts(formula) if part not in used), *inside
    )


def _substituted(
    polynomial: Polynomial[Quantity], signal: Signal, by: Polynomial[Quantity]
) -> Polynomial[Quantity]:
    replaced = _quantity(signal)
    return polynomial.substitute(lambda q: by if q == replaced else variable(q))


def _quantity(signal: Signal) -> Quantity:
    return signal.vehicle, signal.name


def _equalities(formula: Formula) -> Iterator[tuple[t.Term, t.Term]]:
    parts = [part for part in top_level_conjuncts(formula) if isinstance(part, Compare)]
    above = {(x.left, x.right) for x in parts if x.op == ">="}
    for part in parts:
        if part.op == "<=" and (part.left, part.right) in above:
            yield part.left, part.right


# --- points ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _StateSampler:
    """Points are rows of whole numbers, a column for each axis."""

    formula: Formula
    space: Space
    axes: list[_Axis]
    solved: Mapping[Signal, Polynomial[Quantity]]

    def points(self) -> Points:
        """Points at which the formula holds as far as floating point can see.

        Evenly spread ones first, in several rounds; where none of these holds, those around the nearest.
        """
        monitor = compile({"all": self.formula})
        hits, batch = np.zeros((0, len(self.axes))), None
        for turn in range(SPREAD if self.axes else 1):
            points = self._around(np.full((1, len(self.axes)), 0.5), 0.5, turn)
            batch = self._batch(points)
            hits = np.concatenate([hits, points[_true_at(monitor, batch)]])
            if len(hits) >= ENOUGH:
                return hits
        if len(hits) or batch is None or not self.axes:
            return hits
        nearness = compile({"all": _scaled(self.formula, batch)})
        for turn in range(1, CLOSER):
            [margin] = nearness.measure(batch, "clip").margins.values()
            margins = np.nan_to_num(margin.low, nan=-np.inf)
            nearest = points[np.argsort(-margins, kind="stable")[:NEAREST]]
            shares = (nearest + 0.5) / [x.count + 1 for x in self.axes]
            points = self._around(shares, 0.5 / NARROWER**turn, turn)
            batch = self._batch(points)
            hits = points[_true_at(monitor, batch)]
            if len(hits):
                break
        return hits

    def _around(self, shares: Points, reach: float, turn: int) -> Points:
        """Points spread evenly around some, which are shares of ranges; ``turn``: of a sequence."""
        evenly = spread(turn * POINTS, POINTS, len(self.axes))
        near = np.repeat(shares, -(-POINTS // len(shares)), axis=0)[:POINTS] + (2 * evenly - 1) * reach
        columns = [x.values(np.clip(near[:, k], 0, 1)) for k, x in enumerate(self.axes)]
        return np.column_stack(columns) if columns else np.zeros((1, 0))

    def _batch(self, points: Points) -> Batch:
        values: dict[Quantity, Any] = {}
        for k, axis in enumerate(self.axes):
            exact = float(axis.low) + points[:, k] * float(axis.grain)
            values[_quantity(axis.signal)] = exact
        ones = np.ones(len(points))
        for signal, polynomial in reversed([*self.solved.items()]):
            total = 0 * ones
            for monomial, factor in polynomial.terms.items():
                term = float(factor) * ones
                for quantity in monomial:
                    term = term * values[quantity]
                total = total + term
            values[_quantity(signal)] = total
        signals = {(str(name), vehicle): x[None, :] for (vehicle, name), x in values.items()}
        sizes = {(x.name, x.vehicle): float(value) * ones for x, value in self.space.sizes.items()}
        return Batch(Fraction(1), np.ones(len(points), dtype=np.int64), signals, sizes)

    def exactly(self, point: Points) -> State:
        """The state of a point, as rationals."""
        values: dict[Quantity, Fraction] = {}
        state: dict[Signal, Fraction] = {}
        for axis, steps in zip(self.axes, point, strict=True):
            state[axis.signal] = values[_quantity(axis.signal)] = axis.low + int(steps) * axis.grain
        for signal, polynomial in reversed([*self.solved.items()]):
            state[signal] = values[_quantity(signal)] = polynomial.value(values.__getitem__)
        return state


def _true_at(monitor: Monitor[str], batch: Batch) -> NDArray[np.bool_]:
    """Return for each point of a batch whether the one formula of a monitor holds there."""
    [answer] = monitor.evaluate(batch, "clip").answers.values()
    return answer.true


def _scaled(formula: Formula, batch: Batch) -> Formula:
    """Return an equivalent formula whose comparisons are scaled so that margins of any units compare."""
    parts = [x for x in f.subformulas(formula) if isinstance(x, Compare)]
    plain = [x for x in parts if not isinstance(x.left, t.Inverse) and not isinstance(x.right, t.Inverse)]
    margins = compile(dict(enumerate(plain))).measure(batch, "clip").margins
    scaled: dict[Formula, Formula] = {}
    for number, part in enumerate(plain):
        typical = Fraction(float(np.median(np.abs(margins[number].low)))).limit_denominator(1 << 20)
        by = t.number(1 / max(typical, Fraction(1, 1 << 20)))
        scaled[part] = Compare(t.Product((by, part.left)), part.op, t.Product((by, part.right)))
    return f.transform(formula, lambda x: scaled.get(x, x))


def _spread_out(points: Points, axes: list[_Axis], most: int) -> Iterator[Points]:
    """Points, each once; of ``CHOICE`` times ``most`` of them always the one farthest from those before."""
    if not len(points):
        return
    points = np.unique(points, axis=0)
    step = max(1, len(points) // (CHOICE * most))
    order = [k for first in range(step) for k in range(first, len(points), step)]
    farthest_first, rest = points[order[: CHOICE * most]], points[order[CHOICE * most :]]
    places = farthest_first / np.array([max(1, x.count) for x in axes]) if axes else farthest_first
    following = int(np.sum((places - places.mean(axis=0)) ** 2, axis=1).argmin())
    far = np.full(len(farthest_first), np.inf)
    for _ in range(len(farthest_first)):
        yield farthest_first[following]
        far = np.minimum(far, np.sum((places - places[following]) ** 2, axis=1))
        far[following] = -1.0
        following = int(far.argmax())
    yield from rest[:LAST]
