"""What proofs/kernel/Signs.v and Shown.v accept of comparisons on an interval, said in Python beforehand.

Nothing rests on it: where it says yes too often Coq refuses, and where it says no too often a derivation is
longer, or is not found.
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
    Polynomial,
    add,
    multiply,
    negate,
    polynomial,
    primitive,
)
from roadproof.semantics.exact.signals import Courses, DriveSignals, compare_truth, course
from roadproof.semantics.exact.truth import Cut, TruthSet
from roadproof.world.drive import Drive, value_at
from roadproof.world.motion import State, starts_of
from roadproof.world.road import Lanelet
from roadproof.world.signals import SIZES


@dataclass(frozen=True)
class Part:
    """What lies between two cuts at rational instants; ``end`` None is for ever."""

    begin: Cut
    end: Cut | None

    @property
    def start(self) -> Fraction:
        return rational_of(self.begin)

    @property
    def stop(self) -> Fraction | None:
        return None if self.end is None else rational_of(self.end)

    def has_inside(self, time: Fraction) -> bool:
        """Whether cutting just before ``time`` leaves something on both sides."""
        before = Cut(time, False)
        return self.begin < before and (self.end is None or before < self.end)

    def cut(self, times: list[Fraction]) -> "list[Part]":
        """The parts between ascending instants inside."""
        cuts = [self.begin, *(Cut(x, False) for x in times)]
        return [Part(*pair) for pair in pairwise([*cuts, self.end])]  # type: ignore[arg-type]

    def around(self, times: list[Fraction]) -> "list[Part]":
        """The parts before, at and after ascending instants."""
        cuts = [x for time in times for x in (Cut(time, False), Cut(time, True))]
        inside = [x for x in cuts if self.begin < x and (self.end is None or x < self.end)]
        return [Part(*pair) for pair in pairwise([self.begin, *inside, self.end])]  # type: ignore[arg-type]


def rational_of(cut: Cut) -> Fraction:
    """The instant of a cut. Raises ``ValueError`` where it is irrational."""
    if isinstance(cut.point, Root):
        raise ValueError("a part of a derivation ends at rational instants")
    return cut.point


# --- polynomials -----------------------------------------------------------------------------------


def scale(factor: Fraction, p: Polynomial) -> Polynomial:
    return multiply(polynomial(factor), p)


def subtract(p: Polynomial, q: Polynomial) -> Polynomial:
    return add(p, negate(q))


def _shifted(by: Fraction, p: Polynomial) -> Polynomial:
    found = ZERO
    for x in reversed(p.coefficients):
        found = add(polynomial(x), multiply(polynomial(by, 1), found))
    return found


def _bernstein(width: Fraction, p: Polynomial) -> list[Fraction]:
    """As Signs.v has it."""
    found: list[Fraction] = []
    ones = [Fraction(1)]
    for x in reversed(p.coefficients):
        raised = [Fraction(0), *found]
        found = [x * one + more for one, more in zip(ones, raised, strict=True)]
        ones = [(a + b) / width for a, b in zip([Fraction(0), *ones], [*ones, Fraction(0)], strict=True)]
    return found


@dataclass
class Signs:
    """Signs of polynomials on parts; ``tested`` are those that were asked for."""

    tested: set[Polynomial] = field(default_factory=set)

    def above(self, strict: bool, p: Polynomial, part: Part) -> bool:
        """Whether Signs.v says that ``p`` is positive (or not negative) in all of ``part``."""
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


def splits(tested: set[Polynomial], part: Part) -> list[Fraction]:
    """Rational instants inside ``part`` at which a polynomial, or how fast it grows, changes its sign."""
    found: set[Fraction] = set()
    for p in tested:
        for q in (p.numerators, tuple(place * x for place, x in enumerate(p.numerators))[1:]):
            if 1 < len(q) <= 3:
                roots = real_roots(primitive(q))
                found |= {x for x, _ in roots if not isinstance(x, Root) and part.has_inside(x)}
    return sorted(found)


# --- a drive ---------------------------------------------------------------------------------------


@dataclass
class Shapes(ABC):
    """Signals as polynomials of time; ``values``: of parameters."""

    values: Mapping[str, Fraction]

    @property
    def loop(self) -> Loop | None:
        """How signals repeat for ever, where they do; then all that is asked lies in the first round."""
        return None

    @abstractmethod
    def knots(self, leaf: t.Leaf) -> list[Fraction]:
        """The instants from which on a leaf may change in another way than before."""

    @abstractmethod
    def steps(self, leaf: t.Leaf) -> list[Fraction]:
        """The instants at which a leaf may be what it is neither before nor after."""

    @abstractmethod
    def signal(self, signal: t.Varying, part: Part) -> Polynomial:
        """On a part without a knot or a step inside."""

    @abstractmethod
    def size(self, size: t.Size) -> Fraction: ...

    @abstractmethod
    def when(self, compared: Compare) -> TruthSet:
        """When a comparison is true."""

    def term(self, term: Term, part: Part, signs: Signs) -> list[Polynomial]:
        """Polynomials of which one is the term at each instant; none where it cannot be said."""

        def all_of(
            terms: tuple[Term, ...], join: Callable[[Polynomial, Polynomial], list[Polynomial]]
        ) -> list[Polynomial]:
            found = self.term(terms[0], part, signs)
            for other in terms[1:]:
                more = self.term(other, part, signs)
                found = [r for p, q in product(found, more) for r in join(p, q)]
            return found

        match term:
            case t.Number(value, _):
                return [polynomial(value)]
            case t.Parameter(name, _):
                return [polynomial(self.values[name])]
            case t.Signal() | t.Own():
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
            case _:
                return []

    @staticmethod
    def _extreme(
        p: Polynomial, q: Polynomial, part: Part, signs: Signs, least: bool = False
    ) -> list[Polynomial]:
        difference = subtract(q, p) if least else subtract(p, q)
        if signs.above(False, difference, part):
            return [p]
        if signs.above(False, negate(difference), part):
            return [q]
        return [p, q]


@dataclass
class DriveShapes(Shapes):
    """Those of a drive."""

    drive: Drive
    _starts: dict[str, tuple[State, ...]] = field(default_factory=dict)

    @cached_property
    def courses(self) -> Courses:
        return Courses(DriveSignals(self.drive))

    def when(self, compared: Compare) -> TruthSet:
        return compare_truth(self.courses, compared.left, compared.op, compared.right)

    def starts(self, vehicle: str) -> tuple[State, ...]:
        if vehicle not in self._starts:
            self._starts[vehicle] = starts_of(self.drive.vehicles[vehicle])
        return self._starts[vehicle]

    def knots(self, leaf: t.Leaf) -> list[Fraction]:
        match leaf:
            case t.Signal(_, vehicle):
                return [x.time for x in self.starts(vehicle)[1:]]
            case t.Own(name, vehicle):
                return [start for start, _ in self.drive.own[name, vehicle][1:]]
            case _:
                return []

    def steps(self, leaf: t.Leaf) -> list[Fraction]:
        return []

    def signal(self, signal: t.Varying, part: Part) -> Polynomial:
        if isinstance(signal, t.Own):
            return polynomial(value_at(self.drive.own[signal.name, signal.vehicle], part.start))
        starts = self.starts(signal.vehicle)
        return course(signal.name, [state for state in starts if state.time <= part.start][-1])

    def size(self, size: t.Size) -> Fraction:
        return self.courses.signals.size(size)


_MIRRORED: Mapping[Comparison, tuple[bool, bool]] = {
    # strict, and whether the sides are exchanged: x > y is y < x
    "<": (True, False),
    "<=": (False, False),
    ">": (True, True),
    ">=": (False, True),
}


def compares(shapes: Shapes, left: Term, op: Comparison, right: Term, part: Part, signs: Signs) -> bool:
    """Whether Shown.v says that the comparison is true in all of ``part``."""
    strict, exchanged = _MIRRORED[op]
    one, other = (right, left) if exchanged else (left, right)
    inverse = isinstance(one, t.Inverse), isinstance(other, t.Inverse)
    ps = shapes.term(one.term if isinstance(one, t.Inverse) else one, part, signs)
    qs = shapes.term(other.term if isinstance(other, t.Inverse) else other, part, signs)
    return bool(ps and qs) and all(
        any(
            all(signs.above(strictly, r, part) for strictly, r in case)
            for case in _cases(inverse, strict, p, q)
        )
        for p, q in product(ps, qs)
    )


def _cases(
    inverse: tuple[bool, bool], strict: bool, p: Polynomial, q: Polynomial
) -> Iterator[tuple[tuple[bool, Polynomial], ...]]:
    """What has to be positive (strictly, where true) for p < q or p <= q, as ``in_order`` has it."""
    match inverse:
        case (False, False):
            yield ((strict, subtract(q, p)),)
        case (False, True):
            yield (False, q), (strict, subtract(ONE, multiply(p, q)))
            yield (True, negate(q)), (strict, subtract(multiply(p, q), ONE))
        case (True, False):
            yield (True, p), (strict, subtract(multiply(p, q), ONE))
            yield (True, negate(p)), (strict, subtract(ONE, multiply(p, q)))
        case _:
            yield (False, q), (strict, subtract(p, q))
            yield (True, negate(p)), (strict, subtract(p, q))
            yield (True, negate(p)), (False, q)


def _said_of(shapes: Shapes, compared: Compare, part: Part, changing: Polynomial, above: bool) -> bool | None:
    """What a comparison is in ``part`` where ``changing`` is above 0, or is not; None: open."""
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
    shapes: Shapes, vehicle: str, lanelet: Lanelet, positive: bool, part: Part, signs: Signs
) -> bool:
    """Whether Shown.v says that the box is in the lanelet (or is not) in all of ``part``."""
    along, across = (shapes.signal(x, part) for x in (t.Signal("s", vehicle), t.Signal("d", vehicle)))
    length, width = (polynomial(shapes.size(t.Size(x, vehicle))) for x in SIZES)
    low, high = lanelet.s
    edges: list[Polynomial] = []
    if low is not None:
        edges.append(subtract(along, polynomial(low)))
    if high is not None:
        edges.append(subtract(polynomial(high), subtract(along, length)))
    edges.append(subtract(across, polynomial(lanelet.d[0])))
    edges.append(subtract(polynomial(lanelet.d[1]), subtract(across, width)))
    if positive:
        return all(signs.above(True, p, part) for p in edges)
    return any(signs.above(False, negate(p), part) for p in edges)


def assume(shapes: Shapes, formula: Formula, part: Part, changing: Polynomial, above: bool) -> Formula:
    """``formula`` with what the sign of a polynomial says of its comparisons at the same instant."""
    match formula:
        case f.Compare():
            leaves = {*leaves_of(formula)}
            if any(part.has_inside(x) for leaf in leaves for x in shapes.knots(leaf)) or any(
                len(part.around(shapes.steps(leaf))) > 1 for leaf in leaves
            ):
                return formula
            said = _said_of(shapes, formula, part, changing, above)
            return formula if said is None else f.Truth(said)
        case f.Not() | f.And() | f.Or() | f.Some() | f.Every():
            inside = (assume(shapes, x, part, changing, above) for x in f.children(formula))
            return f.with_children(formula, tuple(inside))
        case _:
            return formula
