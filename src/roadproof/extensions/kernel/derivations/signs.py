"""A prediction of the comparisons on an interval that proofs/kernel/Signs.v and Shown.v accept.

Not trusted: if it accepts too much, Coq refuses; if it accepts too little, a derivation is longer or not
found.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, reduce
from itertools import pairwise, product

from roadproof.evidence.countermodel import Loop
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare, Comparison, Formula
from roadproof.logic.rewrite import leaves_of
from roadproof.logic.terms import Term
from roadproof.semantics.exact.algebraic import Root, real_roots
from roadproof.semantics.exact.polynomial import (
    ONE,
    ZERO,
    TimePolynomial,
    add,
    multiply,
    negate,
    polynomial,
    primitive,
)
from roadproof.semantics.exact.signals import DriveSignals, TermPieces, compare_truth, signal_polynomial
from roadproof.semantics.exact.truth import Cut, TruthSet
from roadproof.world.drive import Drive, value_at
from roadproof.world.motion import State, piece_starts
from roadproof.world.road import Lanelet
from roadproof.world.signals import SIZES


@dataclass(frozen=True)
class TimePart:
    """The times between two cuts at rational instants; ``end`` None is unbounded."""

    begin: Cut
    end: Cut | None

    @property
    def start(self) -> Fraction:
        return rational_of(self.begin)

    @property
    def stop(self) -> Fraction | None:
        return None if self.end is None else rational_of(self.end)

    def has_inside(self, time: Fraction) -> bool:
        """Return whether a cut just before ``time`` leaves something on both sides."""
        before = Cut(time, False)
        return self.begin < before and (self.end is None or before < self.end)

    def cut(self, times: list[Fraction]) -> "list[TimePart]":
        """Return the parts between ascending instants inside."""
        cuts = [self.begin, *(Cut(x, False) for x in times)]
        return [TimePart(*pair) for pair in pairwise([*cuts, self.end])]  # type: ignore[arg-type]

    def around(self, times: list[Fraction]) -> "list[TimePart]":
        """Return the parts before, at and after ascending instants."""
        cuts = [x for time in times for x in (Cut(time, False), Cut(time, True))]
        inside = [x for x in cuts if self.begin < x and (self.end is None or x < self.end)]
        return [TimePart(*pair) for pair in pairwise([self.begin, *inside, self.end])]  # type: ignore[arg-type]


def rational_of(cut: Cut) -> Fraction:
    """Return the instant of a cut. Raises ``ValueError`` if it is irrational."""
    if isinstance(cut.point, Root):
        raise ValueError("a part of a derivation ends at rational instants")
    return cut.point


# --- polynomials -----------------------------------------------------------------------------------


def scale(factor: Fraction, p: TimePolynomial) -> TimePolynomial:
    return multiply(polynomial(factor), p)


def subtract(p: TimePolynomial, q: TimePolynomial) -> TimePolynomial:
    return add(p, negate(q))


def _shifted(by: Fraction, p: TimePolynomial) -> TimePolynomial:
    result = ZERO
    for x in reversed(p.coefficients):
        result = add(polynomial(x), multiply(polynomial(by, 1), result))
    return result


def _bernstein(width: Fraction, p: TimePolynomial) -> list[Fraction]:
    """Return the Bernstein coefficients of a polynomial on [0, width], by the algorithm of Signs.v."""
    coefficients: list[Fraction] = []
    ones = [Fraction(1)]
    for coefficient in reversed(p.coefficients):
        raised = [Fraction(0), *coefficients]
        coefficients = [coefficient * one + more for one, more in zip(ones, raised, strict=True)]
        ones = [(a + b) / width for a, b in zip([Fraction(0), *ones], [*ones, Fraction(0)], strict=True)]
    return coefficients


@dataclass
class Signs:
    """The signs of polynomials on parts; ``tested``: the polynomials that were queried."""

    tested: set[TimePolynomial] = field(default_factory=set)

    def above(self, strict: bool, p: TimePolynomial, part: TimePart) -> bool:
        """Return whether Signs.v recognises ``p`` as positive (or not negative) in all of ``part``."""
        self.tested.add(p)
        moved = _shifted(part.start, p)
        if part.end is None or part.stop is None:
            form, last_is_out = [*moved.coefficients], True
        elif part.stop <= part.start:
            first = next(iter(moved.numerators), 0)
            return first > 0 or (first == 0 and not strict)
        else:
            form, last_is_out = _bernstein(part.stop - part.start, moved), not part.end.after
        if any(x < 0 for x in form):
            return False
        if not strict:
            return True
        return bool(
            form
            and any(x > 0 for x in form)
            and (part.begin.after or form[0] > 0)
            and (last_is_out or form[-1] > 0)
        )


def splits(tested: set[TimePolynomial], part: TimePart) -> list[Fraction]:
    """Return rational instants inside ``part`` at which a polynomial or its derivative changes its sign."""
    instants: set[Fraction] = set()
    for p in tested:
        for q in (p.numerators, tuple(place * x for place, x in enumerate(p.numerators))[1:]):
            if 1 < len(q) <= 3:
                roots = real_roots(primitive(q))
                instants |= {x for x, _ in roots if not isinstance(x, Root) and part.has_inside(x)}
    return sorted(instants)


# --- a drive ---------------------------------------------------------------------------------------


@dataclass
class Shapes(ABC):
    """Signals as polynomials of time, on a drive or trace; ``values``: of parameters."""

    values: Mapping[str, Fraction]

    @property
    def loop(self) -> Loop | None:
        """The loop of the signals, if they repeat; then only times in the first round are queried."""
        return None

    @abstractmethod
    def knots(self, leaf: t.Leaf) -> list[Fraction]:
        """Return the instants at which the polynomial of a leaf may change."""

    @abstractmethod
    def steps(self, leaf: t.Leaf) -> list[Fraction]:
        """Return the instants at which a leaf may have a value of its own, unlike before and after."""

    @abstractmethod
    def signal(self, signal: t.Varying, part: TimePart) -> TimePolynomial:
        """Return the polynomial of a signal on a part without a knot or step inside."""

    @abstractmethod
    def size(self, size: t.Size) -> Fraction: ...

    @abstractmethod
    def when(self, compared: Compare) -> TruthSet:
        """Return the times at which a comparison is true."""

    def term(self, term: Term, part: TimePart, signs: Signs) -> list[TimePolynomial]:
        """Return polynomials of which one equals the term at each instant; empty if that is unknown."""

        def all_of(
            terms: tuple[Term, ...], join: Callable[[TimePolynomial, TimePolynomial], list[TimePolynomial]]
        ) -> list[TimePolynomial]:
            """Return the combinations of the polynomials of several terms."""
            results = self.term(terms[0], part, signs)
            for other in terms[1:]:
                more = self.term(other, part, signs)
                results = [r for p, q in product(results, more) for r in join(p, q)]
            return results

        match term:
            case t.Number(value, _):
                return [polynomial(value)]
            case t.Parameter(name, _):
                return [polynomial(self.values[name])]
            case t.Signal() | t.CustomSignal():
                return [self.signal(term, part)]
            case t.Size():
                return [polynomial(self.size(term))]
            case t.Sum(terms):
                return all_of(terms, lambda p, q: [add(p, q)])
            case t.Product(factors):
                return all_of(factors, lambda p, q: [multiply(p, q)])
            case t.Power(base, exponent):
                return [reduce(multiply, [p] * exponent, ONE) for p in self.term(base, part, signs)]
            case t.Quotient(numerator, denominator):
                below = self.term(denominator, part, signs)
                if len(below) != 1 or len(below[0].numerators) != 1:
                    return []
                return [scale(1 / below[0].coefficients[0], p) for p in self.term(numerator, part, signs)]
            case t.Maximum(terms):
                return all_of(terms, lambda p, q: self._extreme(p, q, part, signs))
            case t.Minimum(terms):
                return all_of(terms, lambda p, q: self._extreme(q, p, part, signs, least=True))
            case t.Variable() | t.Inverse():
                return []

    @staticmethod
    def _extreme(
        p: TimePolynomial, q: TimePolynomial, part: TimePart, signs: Signs, least: bool = False
    ) -> list[TimePolynomial]:
        difference = subtract(q, p) if least else subtract(p, q)
        if signs.above(False, difference, part):
            return [p]
        if signs.above(False, negate(difference), part):
            return [q]
        return [p, q]


@dataclass
class DriveShapes(Shapes):
    """The signals of a drive."""

    drive: Drive
    _starts: dict[str, tuple[State, ...]] = field(default_factory=dict)

    @cached_property
    def courses(self) -> TermPieces:
        return TermPieces(DriveSignals(self.drive))

    def when(self, compared: Compare) -> TruthSet:
        return compare_truth(self.courses, compared.left, compared.op, compared.right)

    def starts(self, vehicle: str) -> tuple[State, ...]:
        if vehicle not in self._starts:
            self._starts[vehicle] = piece_starts(self.drive.vehicles[vehicle])
        return self._starts[vehicle]

    def knots(self, leaf: t.Leaf) -> list[Fraction]:
        """Return the instants at which the polynomial of a leaf may change."""
        match leaf:
            case t.Signal(_, vehicle):
                return [x.time for x in self.starts(vehicle)[1:]]
            case t.CustomSignal(name, vehicle):
                return [start for start, _ in self.drive.custom_signals[name, vehicle][1:]]
            case t.Number() | t.Parameter() | t.Variable() | t.Size():
                return []

    def steps(self, leaf: t.Leaf) -> list[Fraction]:
        return []

    def signal(self, signal: t.Varying, part: TimePart) -> TimePolynomial:
        """Return the polynomial of a signal on a part without a knot or step inside."""
        if isinstance(signal, t.CustomSignal):
            return polynomial(value_at(self.drive.custom_signals[signal.name, signal.vehicle], part.start))
        starts = self.starts(signal.vehicle)
        return signal_polynomial(signal.name, [state for state in starts if state.time <= part.start][-1])

    def size(self, size: t.Size) -> Fraction:
        return self.courses.signals.size(size)


_MIRRORED: Mapping[Comparison, tuple[bool, bool]] = {
    # strict, and whether the sides are exchanged: x > y is y < x
    "<": (True, False),
    "<=": (False, False),
    ">": (True, True),
    ">=": (False, True),
}


def compares(shapes: Shapes, left: Term, op: Comparison, right: Term, part: TimePart, signs: Signs) -> bool:
    """Return whether Shown.v recognises a comparison as true in all of ``part``."""
    strict, exchanged = _MIRRORED[op]
    one, other = (right, left) if exchanged else (left, right)
    inverse = isinstance(one, t.Inverse), isinstance(other, t.Inverse)
    left_polynomials = shapes.term(one.term if isinstance(one, t.Inverse) else one, part, signs)
    right_polynomials = shapes.term(other.term if isinstance(other, t.Inverse) else other, part, signs)
    return bool(left_polynomials and right_polynomials) and all(
        any(
            all(signs.above(strictly, r, part) for strictly, r in case)
            for case in _cases(inverse, strict, p, q)
        )
        for p, q in product(left_polynomials, right_polynomials)
    )


def _cases(
    inverse: tuple[bool, bool], strict: bool, p: TimePolynomial, q: TimePolynomial
) -> Iterator[tuple[tuple[bool, TimePolynomial], ...]]:
    """Yield alternatives of polynomials that must be positive (strictly if True) for p < q or p <= q.

    The alternatives are those of ``in_order`` in Shown.v.
    """
    match inverse:
        case (False, False):
            yield ((strict, subtract(q, p)),)
        case (False, True):
            yield (False, q), (strict, subtract(ONE, multiply(p, q)))
            yield (True, negate(q)), (strict, subtract(multiply(p, q), ONE))
        case (True, False):
            yield (True, p), (strict, subtract(multiply(p, q), ONE))
            yield (True, negate(p)), (strict, subtract(ONE, multiply(p, q)))
        case (True, True):
            yield (False, q), (strict, subtract(p, q))
            yield (True, negate(p)), (strict, subtract(p, q))
            yield (True, negate(p)), (False, q)


def _known_truth(
    shapes: Shapes, compared: Compare, part: TimePart, changing: TimePolynomial, above: bool
) -> bool | None:
    """Return the truth of a comparison, given whether ``changing`` is above 0; None if unknown."""
    left = shapes.term(compared.left, part, Signs())
    right = shapes.term(compared.right, part, Signs())
    if len(left) != 1 or len(right) != 1:
        return None
    difference = subtract(right[0], left[0])
    if len(difference.numerators) != len(changing.numerators):
        return None
    factor = difference.coefficients[-1] / changing.coefficients[-1]
    if scale(factor, changing) != difference:
        return None
    signs = (
        (frozenset({1}) if above else frozenset({-1, 0}))
        if factor > 0
        else frozenset({-1} if above else {0, 1})
    )
    # The sign of right - left where the comparison is true.
    true = {"<": {1}, "<=": {0, 1}, ">": {-1}, ">=": {-1, 0}}[compared.op]
    if signs <= true:
        return True
    return None if signs & true else False


def occupies(
    shapes: Shapes, vehicle: str, lanelet: Lanelet, positive: bool, part: TimePart, signs: Signs
) -> bool:
    """Return whether Shown.v recognises that the box is in the lanelet (or is not) in all of ``part``."""
    along, across = (shapes.signal(x, part) for x in (t.Signal("s", vehicle), t.Signal("d", vehicle)))
    length, width = (polynomial(shapes.size(t.Size(x, vehicle))) for x in SIZES)
    low, high = lanelet.s
    edges: list[TimePolynomial] = []
    if low is not None:
        edges.append(subtract(along, polynomial(low)))
    if high is not None:
        edges.append(subtract(polynomial(high), subtract(along, length)))
    edges.append(subtract(across, polynomial(lanelet.d[0])))
    edges.append(subtract(polynomial(lanelet.d[1]), subtract(across, width)))
    if positive:
        return all(signs.above(True, p, part) for p in edges)
    return any(signs.above(False, negate(p), part) for p in edges)


def assume(
    shapes: Shapes, formula: Formula, part: TimePart, changing: TimePolynomial, above: bool
) -> Formula:
    """Return the formula with the comparisons decided by the sign of a polynomial replaced by their truth."""
    match formula:
        case f.Compare():
            leaves = {*leaves_of(formula)}
            if any(part.has_inside(x) for leaf in leaves for x in shapes.knots(leaf)) or any(
                len(part.around(shapes.steps(leaf))) > 1 for leaf in leaves
            ):
                return formula
            truth = _known_truth(shapes, formula, part, changing, above)
            return formula if truth is None else f.Truth(truth)
        case f.Not() | f.And() | f.Or() | f.Some() | f.Every():
            inside = (assume(shapes, x, part, changing, above) for x in f.children(formula))
            return f.with_children(formula, tuple(inside))
        case f.Truth() | f.Occupies() | f.Until() | f.Since() | f.Eventually() | f.Always() | f.Application():
            return formula
