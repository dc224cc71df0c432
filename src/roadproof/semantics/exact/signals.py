"""Evaluates terms as functions of time, on a drive or an abstract trace, and compares them.

1/x is ∞ at 0 (paper, appendix *Robust Semantics*).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce
from typing import Protocol, assert_never

from roadproof.errors import InputError, RoadproofError, UsageError
from roadproof.logic import terms as t
from roadproof.logic.custom_names import code_of, refuse_value
from roadproof.logic.formula import MIRRORED, Comparison
from roadproof.logic.terms import CustomSignal, Inverse, Signal, Size, Term
from roadproof.semantics.exact import piecewise
from roadproof.semantics.exact.piecewise import Pieces, where_sign
from roadproof.semantics.exact.polynomial import ONE, TimePolynomial, multiply, polynomial
from roadproof.semantics.exact.truth import TruthSet, intersection, union
from roadproof.world.drive import Drive, Motion
from roadproof.world.motion import State, piece_starts

LARGEST_DEGREE = 24


class Signals(Protocol):
    """The source of signals as pieces, sizes in m, kinds as numbers.

    Both methods raise ``UsageError`` for unknown vehicles, ``InputError`` for missing values.
    """

    def signal(self, signal: Signal | CustomSignal) -> Pieces: ...

    def size(self, size: Size) -> Fraction: ...


@dataclass(frozen=True)
class DriveSignals:
    """The signals of a drive, polynomials in time on each piece: positions of degree 3 at most."""

    drive: Drive
    _starts: dict[str, tuple[State, ...]] = field(default_factory=dict, repr=False, compare=False)

    def signal(self, signal: Signal | CustomSignal) -> Pieces:
        """Return a signal of a vehicle, or a custom one, as pieces."""
        if isinstance(signal, CustomSignal):
            return self._own(signal)
        if signal.vehicle not in self._starts:
            self._starts[signal.vehicle] = piece_starts(self._motion(signal.vehicle))
        return tuple((x.time, signal_polynomial(signal.name, x)) for x in self._starts[signal.vehicle])

    def _own(self, signal: CustomSignal) -> Pieces:
        """Raises ``InputError`` for a value that the declaration of the signal excludes."""
        if signal.vehicle:
            self._motion(signal.vehicle)
        course = self.drive.custom_signals.get((signal.name, signal.vehicle))
        if course is None:
            raise InputError(
                f"the drive says nothing of {signal.text}: derive the signal (signal … derived by …), or "
                "take a drive that was found for a formula that speaks of it"
            )
        for start, value in course:
            refuse_value(signal, value, f"at {start} s")
        return tuple((start, polynomial(value)) for start, value in course)

    def size(self, size: Size) -> Fraction:
        """Return a size (m) or kind (code) of a vehicle."""
        motion = self._motion(size.vehicle)
        match size.name:
            case "length":
                return motion.length
            case "width":
                return motion.width
            case "kind":
                if motion.kind is None:
                    raise InputError(
                        f"the drive does not say what kind of vehicle {size.vehicle} is: add kind to its file"
                    )
                return Fraction(code_of(motion.kind))
            case _:
                assert_never(size.name)

    def _motion(self, vehicle: str) -> Motion:
        if vehicle not in self.drive.vehicles:
            known = ", ".join(sorted(self.drive.vehicles)) or "none"
            raise UsageError(f"the formula speaks of vehicle={vehicle}, but the drive has {known}: add it")
        return self.drive.vehicles[vehicle]


@dataclass(frozen=True)
class AbstractSignals:
    """Signals that are constant on pieces: ascending (start, value), the first start 0."""

    signals: Mapping[Signal | CustomSignal, tuple[tuple[Fraction, Fraction], ...]]
    sizes: Mapping[Size, Fraction]

    def signal(self, signal: Signal | CustomSignal) -> Pieces:
        """Return a signal of the trace as pieces."""
        if signal not in self.signals:
            of = f" of vehicle={signal.vehicle}" if signal.vehicle else ""
            raise UsageError(f"the trace has no {signal.name}{of}: add it")
        if isinstance(signal, CustomSignal):
            for start, value in self.signals[signal]:
                refuse_value(signal, value, f"at {start} s")
        return tuple((start, polynomial(value)) for start, value in self.signals[signal])

    def size(self, size: Size) -> Fraction:
        if size not in self.sizes:
            raise UsageError(f"the trace has no {size.name} of vehicle={size.vehicle}: add it")
        return self.sizes[size]


@dataclass(frozen=True)
class LineSignals:
    """States along a line: the judge's time is a running value on which signals depend.

    ``refuse`` makes the error for a signal or size, such as ``v_lon(SV)``, that no state has.
    """

    courses: Mapping[Signal | CustomSignal, TimePolynomial]
    sizes: Mapping[Size, Fraction]
    refuse: Callable[[str], RoadproofError]

    def signal(self, signal: Signal | CustomSignal) -> Pieces:
        if signal not in self.courses:
            raise self.refuse(f"{signal.name}({signal.vehicle})")
        return piecewise.constant(self.courses[signal])

    def size(self, size: Size) -> Fraction:
        if size not in self.sizes:
            raise self.refuse(f"{size.name}({size.vehicle})")
        return self.sizes[size]


def unknown_at_instant(what: str) -> InputError:
    """Return the error for a value that was not observed at an instant."""
    return InputError(f"nothing is known of {what} at this instant")


@dataclass(frozen=True)
class TermPieces:
    """Terms as piecewise functions of time, each computed once."""

    signals: Signals
    _known: dict[Term, Pieces] = field(default_factory=dict, repr=False, compare=False)

    def of(self, term: Term) -> Pieces:
        """Return ``term`` as a function of time. Raises ``InputError`` if it is not bound or not finite."""
        if term not in self._known:
            self._known[term] = self._of(term)
        return self._known[term]

    def _of(self, term: Term) -> Pieces:
        match term:
            case t.Number(value, _):
                return piecewise.constant(polynomial(value))
            case t.Signal() | t.CustomSignal():
                return self.signals.signal(term)
            case t.Size():
                return piecewise.constant(polynomial(self.signals.size(term)))
            case t.Sum(terms):
                return piecewise.total([*map(self.of, terms)])
            case t.Product(factors):
                return reduce(lambda x, y: piecewise.combine(_product, x, y), map(self.of, factors))
            case t.Power(base, exponent):
                return piecewise.apply(lambda p: _power(p, exponent), self.of(base))
            case t.Quotient(numerator, denominator):
                scale = polynomial(1 / self._divisor(denominator))
                return piecewise.apply(lambda p: multiply(p, scale), self.of(numerator))
            case t.Maximum(terms):
                return reduce(piecewise.greatest, map(self.of, terms))
            case t.Minimum(terms):
                return reduce(piecewise.least, map(self.of, terms))
            case t.Inverse():
                raise InputError("inverse(…) may only stand alone on one side of a comparison")
            case t.Parameter(name, _) | t.Variable(name, _):
                raise InputError(f"'{name}' has no value: a formula is judged after values are put in")
            case _:
                assert_never(term)

    def _divisor(self, term: Term) -> Fraction:
        pieces = self.of(term)
        if len(pieces) > 1 or len(pieces[0][1].numerators) != 1:
            raise InputError("a divisor must be a number other than zero, the same at all times")
        value = pieces[0][1]
        return Fraction(value.numerators[0], value.denominator)


def signal_polynomial(name: t.SignalName, x: State) -> TimePolynomial:
    """Return a signal on the piece that starts in state ``x``, as a polynomial in time since 0."""
    begin = x.time
    match name:
        case "s":
            return _from(begin, x.s, x.v_lon, x.a_lon / 2, x.j_lon / 6)
        case "d":
            return _from(begin, x.d, x.v_lat, x.a_lat / 2)
        case "v_lon":
            return _from(begin, x.v_lon, x.a_lon, x.j_lon / 2)
        case "v_lat":
            return _from(begin, x.v_lat, x.a_lat)
        case "a_lon":
            return _from(begin, x.a_lon, x.j_lon)
        case "a_lat":
            return polynomial(x.a_lat)
        case "j_lon":
            return polynomial(x.j_lon)
        case _:
            assert_never(name)


def _from(begin: Fraction, *coefficients: Fraction) -> TimePolynomial:
    """A polynomial in time since 0, from the coefficients of the one in time since ``begin``."""
    shifted = list(coefficients)
    while shifted and shifted[-1] == 0:
        shifted.pop()
    # Horner's division by t - (-begin), once for each coefficient: what is left are those of the other one.
    for lowest in range(len(shifted) - 1):
        for k in range(len(shifted) - 2, lowest - 1, -1):
            shifted[k] -= begin * shifted[k + 1]
    return polynomial(*shifted)


def _product(left: TimePolynomial, right: TimePolynomial) -> TimePolynomial:
    degree = len(left.numerators) + len(right.numerators) - 2
    if degree > LARGEST_DEGREE:
        raise InputError(
            f"a term has degree={degree} in time, above the {LARGEST_DEGREE} that can be judged: "
            "use lower powers"
        )
    return multiply(left, right)


def _power(p: TimePolynomial, exponent: int) -> TimePolynomial:
    if not 0 <= exponent <= LARGEST_DEGREE:
        raise InputError(f"a power has exponent={exponent}: it must lie between 0 and {LARGEST_DEGREE}")
    return reduce(_product, [p] * exponent, ONE)


# The signs of left - right for which ``left op right`` is true.
TRUE_SIGNS: Mapping[Comparison, frozenset[int]] = {
    "<": frozenset({-1}),
    "<=": frozenset({-1, 0}),
    ">": frozenset({1}),
    ">=": frozenset({0, 1}),
}
POSITIVE, ZERO, NEGATIVE = frozenset({1}), frozenset({0}), frozenset({-1})
NONZERO = POSITIVE | NEGATIVE


def compare_truth(courses: TermPieces, left: Term, op: Comparison, right: Term) -> TruthSet:
    """Return the times at which ``left op right`` holds; ∞ >= ∞ is true and ∞ > ∞ false."""
    match left, right:
        case Inverse(x), Inverse(y):
            return _two_inverses(courses.of(x), op, courses.of(y))
        case Inverse(x), _:
            return _one_inverse(courses.of(x), op, courses.of(right))
        case _, Inverse(y):
            return _one_inverse(courses.of(y), MIRRORED[op], courses.of(left))
        case _:  # open: two terms, neither of which is an inverse
            return where_sign(piecewise.subtract(courses.of(left), courses.of(right)), TRUE_SIGNS[op])


def _one_inverse(x: Pieces, op: Comparison, y: Pieces) -> TruthSet:
    """1/x op y: where x > 0 as 1 op x·y, where x < 0 as x·y op 1, and ∞ op y where x = 0."""
    product = piecewise.combine(multiply, x, y)
    difference = piecewise.subtract(piecewise.constant(ONE), product)
    return union(
        [
            intersection([where_sign(x, POSITIVE), where_sign(difference, TRUE_SIGNS[op])]),
            intersection([where_sign(x, NEGATIVE), where_sign(difference, TRUE_SIGNS[MIRRORED[op]])]),
            *([where_sign(x, ZERO)] if 1 in TRUE_SIGNS[op] else []),
        ]
    )


def _two_inverses(x: Pieces, op: Comparison, y: Pieces) -> TruthSet:
    """1/x op 1/y: as y op x where the signs agree, as x op y where they differ, ∞ where one is 0."""
    difference = piecewise.subtract(y, x)
    agree = union([_both(x, POSITIVE, y, POSITIVE), _both(x, NEGATIVE, y, NEGATIVE)])
    differ = union([_both(x, POSITIVE, y, NEGATIVE), _both(x, NEGATIVE, y, POSITIVE)])
    cases = [
        intersection([agree, where_sign(difference, TRUE_SIGNS[op])]),
        intersection([differ, where_sign(difference, TRUE_SIGNS[MIRRORED[op]])]),
    ]
    if 1 in TRUE_SIGNS[op]:
        cases.append(_both(x, ZERO, y, NONZERO))
    if 0 in TRUE_SIGNS[op]:
        cases.append(_both(x, ZERO, y, ZERO))
    if -1 in TRUE_SIGNS[op]:
        cases.append(_both(x, NONZERO, y, ZERO))
    return union(cases)


def _both(x: Pieces, x_signs: frozenset[int], y: Pieces, y_signs: frozenset[int]) -> TruthSet:
    return intersection([where_sign(x, x_signs), where_sign(y, y_signs)])
