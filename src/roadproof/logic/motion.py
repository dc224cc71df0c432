"""What is true of every motion, as formulas: schemas that terms and formulas are put into.

A *motion* gives vehicles positions and speeds for all time such that positions are the integrals of speeds
and speeds those of accelerations (``SIGNALS[…].rate_of``), which are bounded in bounded time; sizes,
parameters and numbers never change. So positions and speeds are continuous, and for an affine combination
e of them with the rate e': e(t) - e(T) is the integral of e' from T to t. Every drive is a motion. Each
schema says which theorem makes it true; docs/explanation/motion.md has the arguments, and
proofs/kernel/Schemas.v proves them.
"""

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import assert_never

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.terms import Term
from roadproof.world.signals import SIGNALS, SignalName

RATES: Mapping[SignalName, SignalName] = {
    about.rate_of: name for name, about in SIGNALS.items() if about.rate_of is not None
}
"""The rate of change of each signal that is an integral; the others may jump."""


# --- terms ---------------------------------------------------------------------------------------


def is_rigid(term: Term) -> bool:
    """Whether ``term`` has one value at all times."""
    return not any(isinstance(leaf, t.Varying) for leaf in t.leaves(term))


def is_continuous(term: Term) -> bool:
    """Whether ``term`` is a continuous function of time on every motion.

    Sums, products, powers, maxima and minima of continuous functions are, quotients by what never changes
    too; an inverse is not, and neither is a signal that is no integral.
    """
    if isinstance(term, t.Inverse):
        return False
    if isinstance(term, t.Quotient) and not is_rigid(term.denominator):
        return False
    if isinstance(term, t.Signal):
        return term.name in RATES
    if isinstance(term, t.Own):
        return False
    return all(map(is_continuous, t.children(term)))


def rate(term: Term) -> Term | None:
    """The rate of change of an affine combination of signals; None where it never changes.

    Raises ``ValueError`` where ``term`` is no affine combination, or has a signal that is no integral.
    """
    if is_rigid(term):
        return None
    match term:
        case t.Signal(name, vehicle) if name in RATES:
            return t.Signal(RATES[name], vehicle)
        case t.Sum(summands):
            rates = tuple(x for x in map(rate, summands) if x is not None)
            return rates[0] if len(rates) == 1 else t.Sum(rates)
        case t.Product(factors):
            moving = [place for place, x in enumerate(factors) if not is_rigid(x)]
            if len(moving) == 1:
                place = moving[0]
                changed = rate(factors[place])
                assert changed is not None
                return t.Product((*factors[:place], changed, *factors[place + 1 :]))
        case t.Quotient(numerator, denominator) if is_rigid(denominator):
            changed = rate(numerator)
            assert changed is not None
            return t.Quotient(changed, denominator)
        case _:
            pass
    raise ValueError("no affine combination of signals that have a rate")


def rates(left: Term, right: Term) -> tuple[Term, Term]:
    """The rates of two sides of a comparison, of which one moves. Raises ``ValueError``."""
    changes = rate(left), rate(right)
    moving = next((x for x in changes if x is not None), None)
    if moving is None:
        raise ValueError("neither side ever changes")
    still = t.number(0, _dimension(moving))
    return changes[0] or still, changes[1] or still


def _dimension(term: Term) -> t.Dimension:
    """The dimension that 0 is printed with beside ``term``; that of a signal, or none."""
    return t.SIGNAL_DIMENSIONS[term.name] if isinstance(term, t.Signal) else (0, 0)


def add(*terms: Term) -> Term:
    """A sum without zeros, as one number where all are numbers of one dimension."""
    known = [x for x in terms if isinstance(x, t.Number)]
    if len(known) == len(terms) and len({x.dimension for x in known}) == 1:
        return t.number(sum((x.value for x in known), Fraction(0)), known[0].dimension)
    kept = tuple(x for x in terms if t.constant_value(x) != 0)
    return kept[0] if len(kept) == 1 else t.Sum(kept or terms[:1])


def _times(*terms: Term) -> Term:
    """A product, as one number where all are numbers."""
    known = [x for x in terms if isinstance(x, t.Number)]
    if len(known) == len(terms):
        metres, seconds = (sum(x.dimension[k] for x in known) for k in (0, 1))
        return t.number(math.prod((x.value for x in known), start=Fraction(1)), (metres, seconds))
    return t.Product(terms)


# --- formulas ------------------------------------------------------------------------------------


def is_open(formula: Formula, positive: bool = True) -> bool:
    """Whether the instants at which a state ``formula`` is true (false: not ``positive``) are an open set.

    Strict comparisons of continuous terms are open, and so is occupying a lanelet, since boxes and lanelets
    overlap by strict comparisons of positions; finite unions and intersections of open sets are open, and a
    road has finitely many elements. Told by form alone: False may mean that it is not known.
    """
    match formula:
        case f.Truth():
            return True
        case f.Compare(left, op, right):
            return (op in ("<", ">")) == positive and is_continuous(left) and is_continuous(right)
        case f.Occupies():
            return positive
        case f.Not(body):
            return is_open(body, not positive)
        case f.And(parts) | f.Or(parts):
            return all(is_open(part, positive) for part in parts)
        case f.Some(_, _, body) | f.Every(_, _, body) | f.Application(_, _, body):
            return is_open(body, positive)
        case f.Until() | f.Eventually() | f.Always():
            return False
        case _:
            assert_never(formula)


def at_most(left: Term, right: Term) -> Formula:
    """What is at most so much is more only after an instant at which it is more, and grows.

    Were e <= 0 at T and e > 0 at t, let r be the last instant up to t with e <= 0, which there is, since e is
    continuous. If e' <= 0 wherever e > 0 between T and t, then e(t) = e(r) + the integral of e' from r to t
    <= 0. Raises ``ValueError``.
    """
    kept = f.Compare(left, "<=", right)
    slower = _not_faster(left, right)
    return _always(kept, f.negation(_until(f.disjunction(kept, slower), f.negation(kept))))


def below(left: Term, right: Term) -> Formula:
    """What is below stays below as long as it does not grow.

    Were e < 0 at T, e' <= 0 from T on and before t, then e(t) = e(T) + the integral of e' <= e(T) < 0.
    Raises ``ValueError``.
    """
    kept = f.Compare(left, "<", right)
    slower = _not_faster(left, right)
    return _always(kept, f.negation(_until(slower, f.negation(kept))))


def meets(left: Term, right: Term) -> Formula:
    """What is below and not for ever has a first instant at which it is not, and is level there.

    The intermediate value theorem: e >= 0 is a closed set of instants, so it has a first one, up to which
    e < 0; e is continuous, so e = 0 there. Raises ``ValueError`` where a side may jump.
    """
    if not (is_continuous(left) and is_continuous(right)):
        raise ValueError("a side may jump")
    kept = f.Compare(left, "<", right)
    level = f.conjunction(f.Compare(left, "<=", right), f.Compare(left, ">=", right))
    return _always(kept, f.disjunction(f.Always(f.FOREVER, kept), _until(kept, level)))


def leaves(inside: Formula) -> Formula:
    """What is open and left has a first instant outside.

    The instants outside are a closed set, so it has a first one. Raises ``ValueError`` where ``inside`` is
    not open by its form.
    """
    if not is_open(inside):
        raise ValueError("it is not open: its comparisons must be strict, and of what cannot jump")
    outside = f.negation(inside)
    return _always(inside, f.disjunction(f.Always(f.FOREVER, inside), _until(inside, outside)))


def within(left: Term, right: Term, speed: Term, time: Term) -> Formula:
    """What is at most so much, and grows by at most ``speed``, is little more within a bounded ``time``.

    With e' <= r before T + t and t <= d: e(T + t) <= e(T) + r·t <= max(0, r)·d. Raises ``ValueError``.
    """
    most = _times(_positive(speed), time)
    grown = f.Compare(left, "<=", add(right, most))
    slow = _at_speed(left, right, speed, time)
    return _always(f.Compare(left, "<=", right), f.negation(f.Until(slow, _up_to(time), f.negation(grown))))


def after(left: Term, right: Term, speed: Term, time: Term) -> Formula:
    """What is at most so much, and grows by at most ``speed`` for a ``time``, is bounded after it.

    With e' <= r from T to T + d: e(T + d) <= e(T) + r·d. Raises ``ValueError``.
    """
    grown = f.Compare(left, "<=", add(right, _times(speed, time)))
    slow = f.Always(_up_to(time), _at_speed(left, right, speed, time))
    premise = f.conjunction(f.Compare(left, "<=", right), slow)
    return _always(premise, f.Always(f.Interval(time, time), grown))


def within_twice(left: Term, right: Term, speed: Term, growth: Term, time: Term) -> Formula:
    """What is at most so much and grows at a bounded rate is little more within a bounded ``time``.

    With e(T) <= 0, e'(T) <= v, and e'' <= r before T + t, t <= d: e'(T + u) <= v + r·u for u <= t, so that
    e(T + t) <= v·t + r·t²/2 <= max(0, v)·d + max(0, r)·d²/2. Raises ``ValueError``.
    """
    most = add(_times(_positive(speed), time), _half_square(_positive(growth), time))
    grown = f.Compare(left, "<=", add(right, most))
    slow = _at_growth(left, right, growth, time)
    premise = f.conjunction(f.Compare(left, "<=", right), _at_speed(left, right, speed, time))
    return _always(premise, f.negation(f.Until(slow, _up_to(time), f.negation(grown))))


def after_twice(left: Term, right: Term, speed: Term, growth: Term, time: Term) -> Formula:
    """What is at most so much, and grows at a bounded rate for a ``time``, is bounded after it.

    With e(T) <= 0, e'(T) <= v, and e'' <= r from T to T + d: e'(T + u) <= v + r·u for u <= d, so that
    e(T + d) <= v·d + r·d²/2. Raises ``ValueError``.
    """
    most = add(_times(speed, time), _half_square(growth, time))
    grown = f.Compare(left, "<=", add(right, most))
    slow = f.Always(_up_to(time), _at_growth(left, right, growth, time))
    start = f.conjunction(f.Compare(left, "<=", right), _at_speed(left, right, speed, time))
    return _always(f.conjunction(start, slow), f.Always(f.Interval(time, time), grown))


def limit(formula: Formula) -> Formula:
    """What a model of a vehicle says of a signal, at all times."""
    return f.Always(f.FOREVER, formula)


def _at_speed(left: Term, right: Term, speed: Term, time: Term) -> f.Compare:
    """left' <= right' + speed. Raises ``ValueError`` where ``speed`` or ``time`` may change."""
    if not (is_rigid(speed) and is_rigid(time)):
        raise ValueError("rate and time may not change")
    moved, carried = rates(left, right)
    return f.Compare(moved, "<=", add(carried, speed))


def _at_growth(left: Term, right: Term, growth: Term, time: Term) -> f.Compare:
    """left'' <= right'' + growth. Raises ``ValueError`` where ``growth`` or ``time`` may change."""
    return _at_speed(*rates(left, right), growth, time)


def _half_square(growth: Term, time: Term) -> Term:
    """growth·time²/2."""
    return _times(growth, time, time, t.number(Fraction(1, 2)))


def _positive(speed: Term) -> Term:
    value = t.constant_value(speed)
    if value is None:
        return t.Maximum((t.number(0), speed))
    return speed if value >= 0 else t.number(0)


def _not_faster(left: Term, right: Term) -> f.Compare:
    """left' <= right'."""
    grown, carried = rates(left, right)
    return f.Compare(grown, "<=", carried)


def _up_to(time: Term) -> f.Interval:
    return f.Interval(f.ZERO, time)


def _until(left: Formula, right: Formula) -> Formula:
    return f.Until(left, f.FOREVER, right)


def _always(premise: Formula, conclusion: Formula) -> Formula:
    return f.Always(f.FOREVER, f.implication(premise, conclusion))


# --- inductions ----------------------------------------------------------------------------------
# True on every trace; with numbers above zero as times, finitely many steps reach every later instant.


def steps(inside: Formula, low: Term, high: Term) -> Formula:
    """What holds, and holds again ``low`` to ``high`` after each instant at which it does, never ends.

    With p at T there are instants T = t0 < t1 < … with p and t(n) + low <= t(n+1) <= t(n) + high. They pass
    every bound, since low > 0, so that every later instant has one of them at most ``high`` after it. Raises
    ``ValueError``.
    """
    _check(low)
    _check(high)
    again = f.Always(f.FOREVER, f.implication(inside, f.Eventually(f.Interval(low, high), inside)))
    always = f.Always(f.FOREVER, f.Eventually(f.Interval(f.ZERO, high), inside))
    return f.Always(f.FOREVER, f.implication(f.conjunction(inside, again), always))


def lasts(inside: Formula, time: Term) -> Formula:
    """What holds, and lasts for a ``time`` after each instant at which it holds, holds for ever.

    With p at T it holds from T + n·d to T + (n + 1)·d for every n. Raises ``ValueError``.
    """
    _check(time)
    kept = f.Always(f.FOREVER, f.implication(inside, f.Always(f.Interval(f.ZERO, time), inside)))
    return f.Always(f.FOREVER, f.implication(f.conjunction(inside, kept), f.Always(f.FOREVER, inside)))


def _check(time: Term) -> None:
    value = t.constant_value(time)
    if value is None or value <= 0:
        raise ValueError("a step of time must be a number above 0")
