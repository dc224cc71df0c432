"""Axiom schemas of motion: formulas that hold on every motion, whatever terms and formulas are put in.

A *motion* gives vehicles positions and speeds for all time such that positions are the integrals of speeds
and speeds those of accelerations (``SIGNALS[…].rate_of``), which are bounded in bounded time. Sizes,
parameters and numbers never change. So positions and speeds are continuous. Let e = left - right be an affine
combination of them with the rate e'; then e(t) - e(T) is the integral of e' from T to t. Every drive is a
motion. Each schema names the theorem that makes it true; docs/explanation/motion.md has the arguments, and
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
"""The rate of change of each signal that is an integral; the other signals may jump."""


# --- terms ---------------------------------------------------------------------------------------


def is_rigid(term: Term) -> bool:
    """Return whether ``term`` is constant in time."""
    return not any(isinstance(leaf, t.Varying) for leaf in t.leaves(term))


def is_continuous(term: Term) -> bool:
    """Return whether ``term`` is a continuous function of time on every motion.

    Sums, products, powers, maxima and minima of continuous functions are continuous, and so are their
    quotients by constants. Inverses and signals that are no integrals are not.
    """
    if isinstance(term, t.Inverse):
        return False
    if isinstance(term, t.Quotient) and not is_rigid(term.denominator):
        return False
    if isinstance(term, t.Signal):
        return term.name in RATES
    if isinstance(term, t.CustomSignal):
        return False
    return all(map(is_continuous, t.children(term)))


def rate(term: Term) -> Term | None:
    """Return the rate of change of an affine combination of signals; None if it is constant.

    Raises ``ValueError`` if ``term`` is no affine combination, or has a signal that is no integral.
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
        case (
            t.Signal() | t.CustomSignal() | t.Power() | t.Quotient() | t.Maximum() | t.Minimum() | t.Inverse()
        ):
            pass
        case t.Number() | t.Parameter() | t.Variable() | t.Size():
            pass
        case _:
            assert_never(term)
    raise ValueError("no affine combination of signals that have a rate")


def rates(left: Term, right: Term) -> tuple[Term, Term]:
    """Return the rates of two sides of a comparison, at least one of which changes. Raises ``ValueError``."""
    changes = rate(left), rate(right)
    moving = next((x for x in changes if x is not None), None)
    if moving is None:
        raise ValueError("neither side ever changes")
    still = t.number(0, _dimension(moving))
    return changes[0] or still, changes[1] or still


def _dimension(term: Term) -> t.Dimension:
    """Return the dimension of a signal, in which a 0 beside it is printed; no dimension for other terms."""
    return t.SIGNAL_DIMENSIONS[term.name] if isinstance(term, t.Signal) else (0, 0)


def add(*terms: Term) -> Term:
    """Return a sum without zeros; numbers of one dimension are added to one number."""
    known = [x for x in terms if isinstance(x, t.Number)]
    if len(known) == len(terms) and len({x.dimension for x in known}) == 1:
        return t.number(sum((x.value for x in known), Fraction(0)), known[0].dimension)
    nonzero = tuple(x for x in terms if t.constant_value(x) != 0)
    return nonzero[0] if len(nonzero) == 1 else t.Sum(nonzero or terms[:1])


def _times(*terms: Term) -> Term:
    """Return a product; numbers are multiplied to one number."""
    known = [x for x in terms if isinstance(x, t.Number)]
    if len(known) == len(terms):
        metres, seconds = (sum(x.dimension[k] for x in known) for k in (0, 1))
        return t.number(math.prod((x.value for x in known), start=Fraction(1)), (metres, seconds))
    return t.Product(terms)


# --- formulas ------------------------------------------------------------------------------------


def is_open(formula: Formula, positive: bool = True) -> bool:
    """Return whether the instants with ``formula`` true (false, if not ``positive``) form an open set.

    ``formula``: a state formula. Strict comparisons of continuous terms are open. Occupying a lanelet is,
    too, since boxes and lanelets overlap by strict comparisons of positions. Finite unions and intersections
    of open sets are open, and a road has finitely many elements. The test is syntactic: False may mean "not
    known".
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
        case f.Until() | f.Since() | f.Eventually() | f.Always():
            return False
        case _:
            assert_never(formula)


def at_most(left: Term, right: Term) -> Formula:
    """Return the schema: if e <= 0, then e > 0 only after an instant at which e > 0 and e' > 0.

    Proof: Let e <= 0 at T and e > 0 at t, and let r be the last instant before t with e <= 0; it exists, as e
    is continuous. If e' <= 0 wherever e > 0 between T and t, then e(t) = e(r) + the integral of e' from r to
    t <= 0. Raises ``ValueError``.
    """
    ordered = f.Compare(left, "<=", right)
    slower = _rate_not_greater(left, right)
    return _always(ordered, f.negation(_until(f.disjunction(ordered, slower), f.negation(ordered))))


def below(left: Term, right: Term) -> Formula:
    """Return the schema: e < 0 stays true as long as e' <= 0.

    Proof: with e' <= 0 from T to t, e(t) = e(T) + the integral of e' <= e(T) < 0. Raises ``ValueError``.
    """
    ordered = f.Compare(left, "<", right)
    slower = _rate_not_greater(left, right)
    return _always(ordered, f.negation(_until(slower, f.negation(ordered))))


def meets(left: Term, right: Term) -> Formula:
    """Return the schema: if e < 0, then either for ever, or some first instant has e >= 0, and e = 0 there.

    Proof by the intermediate value theorem: e >= 0 on a closed set of instants, so it has a first one, before
    which e < 0; e is continuous, so e = 0 there. Raises ``ValueError`` if a side may jump.
    """
    if not (is_continuous(left) and is_continuous(right)):
        raise ValueError("a side may jump")
    ordered = f.Compare(left, "<", right)
    level = f.conjunction(f.Compare(left, "<=", right), f.Compare(left, ">=", right))
    return _always(ordered, f.disjunction(f.Always(f.FOREVER, ordered), _until(ordered, level)))


def leaves(inside: Formula) -> Formula:
    """Return the schema: an open condition that holds either holds for ever, or has a first instant without
    it.

    Proof: the instants outside form a closed set, which has a first one. Raises ``ValueError`` unless the
    form of ``inside`` shows that it is open.
    """
    if not is_open(inside):
        raise ValueError("it is not open: its comparisons must be strict, and of what cannot jump")
    outside = f.negation(inside)
    return _always(inside, f.disjunction(f.Always(f.FOREVER, inside), _until(inside, outside)))


def within(left: Term, right: Term, speed: Term, time: Term) -> Formula:
    """Return the schema: after e <= 0, while e' <= ``speed``, e stays below a bound for a bounded ``time``.

    Proof: with e' <= r before T + t and t <= d, e(T + t) <= e(T) + r·t <= max(0, r)·d. Raises ``ValueError``.
    """
    margin = _times(_positive(speed), time)
    bounded = f.Compare(left, "<=", add(right, margin))
    slow = _rate_at_most(left, right, speed, time)
    return _always(f.Compare(left, "<=", right), f.negation(f.Until(slow, _up_to(time), f.negation(bounded))))


def after(left: Term, right: Term, speed: Term, time: Term) -> Formula:
    """Return the schema: if e <= 0, and e' <= ``speed`` for a ``time``, then e is bounded at its end.

    Proof: with e' <= r from T to T + d, e(T + d) <= e(T) + r·d. Raises ``ValueError``.
    """
    bounded = f.Compare(left, "<=", add(right, _times(speed, time)))
    slow = f.Always(_up_to(time), _rate_at_most(left, right, speed, time))
    premise = f.conjunction(f.Compare(left, "<=", right), slow)
    return _always(premise, f.Always(f.Interval(time, time), bounded))


def within_twice(left: Term, right: Term, speed: Term, growth: Term, time: Term) -> Formula:
    """Return the schema: after e <= 0 and e' <= ``speed``, while e'' <= ``growth``, e stays below a bound.

    Proof: let e(T) <= 0, e'(T) <= v, and e'' <= r before T + t, t <= d. Then e'(T + u) <= v + r·u for u <= t,
    so that e(T + t) <= v·t + r·t²/2 <= max(0, v)·d + max(0, r)·d²/2. Raises ``ValueError``.
    """
    margin = add(_times(_positive(speed), time), _half_square(_positive(growth), time))
    bounded = f.Compare(left, "<=", add(right, margin))
    slow = _second_rate_at_most(left, right, growth, time)
    premise = f.conjunction(f.Compare(left, "<=", right), _rate_at_most(left, right, speed, time))
    return _always(premise, f.negation(f.Until(slow, _up_to(time), f.negation(bounded))))


def after_twice(left: Term, right: Term, speed: Term, growth: Term, time: Term) -> Formula:
    """Return the schema: with e <= 0, e' <= ``speed``, and e'' <= ``growth`` for a ``time``, e ends below a
    bound.

    Proof: let e(T) <= 0, e'(T) <= v, and e'' <= r from T to T + d. Then e'(T + u) <= v + r·u for u <= d, so
    that e(T + d) <= v·d + r·d²/2. Raises ``ValueError``.
    """
    margin = add(_times(speed, time), _half_square(growth, time))
    bounded = f.Compare(left, "<=", add(right, margin))
    slow = f.Always(_up_to(time), _second_rate_at_most(left, right, growth, time))
    start = f.conjunction(f.Compare(left, "<=", right), _rate_at_most(left, right, speed, time))
    return _always(f.conjunction(start, slow), f.Always(f.Interval(time, time), bounded))


def limit(formula: Formula) -> Formula:
    """Return a limit of a vehicle model as a formula: it holds at all times."""
    return f.Always(f.FOREVER, formula)


def _rate_at_most(left: Term, right: Term, speed: Term, time: Term) -> f.Compare:
    """Return left' <= right' + speed. Raises ``ValueError`` if ``speed`` or ``time`` may change."""
    if not (is_rigid(speed) and is_rigid(time)):
        raise ValueError("rate and time may not change")
    left_rate, right_rate = rates(left, right)
    return f.Compare(left_rate, "<=", add(right_rate, speed))


def _second_rate_at_most(left: Term, right: Term, growth: Term, time: Term) -> f.Compare:
    """Return left'' <= right'' + growth. Raises ``ValueError`` if ``growth`` or ``time`` may change."""
    return _rate_at_most(*rates(left, right), growth, time)


def _half_square(growth: Term, time: Term) -> Term:
    """Return growth·time²/2."""
    return _times(growth, time, time, t.number(Fraction(1, 2)))


def _positive(speed: Term) -> Term:
    value = t.constant_value(speed)
    if value is None:
        return t.Maximum((t.number(0), speed))
    return speed if value >= 0 else t.number(0)


def _rate_not_greater(left: Term, right: Term) -> f.Compare:
    """Return left' <= right'."""
    left_rate, right_rate = rates(left, right)
    return f.Compare(left_rate, "<=", right_rate)


def _up_to(time: Term) -> f.Interval:
    return f.Interval(f.ZERO, time)


def _until(left: Formula, right: Formula) -> Formula:
    return f.Until(left, f.FOREVER, right)


def _always(premise: Formula, conclusion: Formula) -> Formula:
    return f.Always(f.FOREVER, f.implication(premise, conclusion))


# --- inductions ----------------------------------------------------------------------------------
# They hold on every trace. Times are numbers above zero, so finitely many steps reach every later instant.


def steps(inside: Formula, low: Term, high: Term) -> Formula:
    """Return the schema: if p holds, and again ``low`` to ``high`` after each time, it recurs for ever.

    Proof: from p at T there are instants T = t0 < t1 < … with p and t(n) + low <= t(n+1) <= t(n) + high. They
    pass every bound, since low > 0, so every later instant has one of them at most ``high`` after it. Raises
    ``ValueError``.
    """
    _check(low)
    _check(high)
    again = f.Always(f.FOREVER, f.implication(inside, f.Eventually(f.Interval(low, high), inside)))
    always = f.Always(f.FOREVER, f.Eventually(f.Interval(f.ZERO, high), inside))
    return f.Always(f.FOREVER, f.implication(f.conjunction(inside, again), always))


def lasts(inside: Formula, time: Term) -> Formula:
    """Return the schema: if p holds, and lasts for a ``time`` whenever it holds, it holds for ever.

    Proof: from p at T it holds from T + n·d to T + (n + 1)·d for every n. Raises ``ValueError``.
    """
    _check(time)
    persists = f.Always(f.FOREVER, f.implication(inside, f.Always(f.Interval(f.ZERO, time), inside)))
    return f.Always(f.FOREVER, f.implication(f.conjunction(inside, persists), f.Always(f.FOREVER, inside)))


def _check(time: Term) -> None:
    value = t.constant_value(time)
    if value is None or value <= 0:
        raise ValueError("a step of time must be a number above 0")
