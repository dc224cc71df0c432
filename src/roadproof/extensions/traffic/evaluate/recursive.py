"""The definitions of semantics §1, read out slowly: one trace, one sample, one view at a time.

Everything faster is pinned against this file, so it shares neither arrays nor arithmetic with it.
It remembers what it has already worked out, and does nothing else to be quick.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from math import inf
from typing import Literal, TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of, without_names

ReadAs: TypeAlias = Literal["strong", "weak", "clip"]
ThreeValued: TypeAlias = Literal["true", "false", "undecided"]


@dataclass(frozen=True)
class SampledTrace:
    """Samples 0 … length-1 of one trace, ``dt`` seconds apart; ``given`` is truth by structure."""

    dt: Fraction
    length: int
    signals: Mapping[tuple[str, str], Sequence[float]]
    sizes: Mapping[tuple[str, str], float]
    given: Mapping[Formula, Sequence[bool]] = field(default_factory=dict)


def answer(formula: Formula, trace: SampledTrace, sample: int = 0, clip: bool = False) -> ThreeValued:
    """Return whether ``formula`` holds at ``sample``: true for every continuation, false for none
    (semantics §1).

    With ``clip``, windows are cut at the last sample and the answer is never ``undecided``.
    """
    reading = TraceReader(trace)
    if reading.holds(formula, sample, "clip" if clip else "strong"):
        return "true"
    return "undecided" if not clip and reading.holds(formula, sample, "weak") else "false"


class TraceReader:
    """Truth and margins of formulas over one trace."""

    def __init__(self, trace: SampledTrace) -> None:
        self.trace = trace
        self.given = {without_names(g): values for g, values in trace.given.items()}
        self.found: dict[Formula, Sequence[bool] | None] = {}
        self.constants: dict[t.Term, float | None] = {}
        self.holds = cache(self._holds)
        self.margin = cache(self._margin)

    # --- truth ---------------------------------------------------------------------------------

    def _holds(self, formula: Formula, k: int, view: ReadAs) -> bool:
        """Return whether ``formula`` holds at sample ``k`` (inside the trace) in a view."""
        known = self._given(formula)
        if known is not None:
            return bool(known[k])
        match formula:
            case f.Truth(value):
                return value
            case f.Compare(left, op, right):
                x, y = self.number(left, k), self.number(right, k)
                return x < y if op == "<" else x <= y if op == "<=" else x > y if op == ">" else x >= y
            case f.Not(body):
                return not self.holds(body, k, _swapped(view))
            case f.And(parts):
                return all(self.holds(p, k, view) for p in parts)
            case f.Or(parts):
                return any(self.holds(p, k, view) for p in parts)
            case f.Application(_, _, body):
                return self.holds(body, k, view)
            case f.Eventually(interval, body):
                window, whole = self.window(interval, k)
                some = any(self.holds(body, j, view) for j in window)
                return some or (view == "weak" and not whole)
            case f.Always(interval, body):
                window, whole = self.window(interval, k)
                every = all(self.holds(body, j, view) for j in window)
                return every and (view != "strong" or whole)
            case f.Until(left, interval, right):
                window, whole = self.window(interval, k)
                for j in window:
                    if self.holds(right, j, view) and all(self.holds(left, i, view) for i in window if i < j):
                        return True
                return view == "weak" and not whole and all(self.holds(left, i, view) for i in window)
            case f.Since(left, interval, right):
                past = self.past(interval, k)
                return any(
                    self.holds(right, j, view) and all(self.holds(left, i, view) for i in past if i > j)
                    for j in past
                )
            case f.Occupies() | f.Some() | f.Every():
                raise _not_given(formula)
            case _:
                assert_never(formula)

    # --- margins -------------------------------------------------------------------------------

    def _margin(self, formula: Formula, k: int, view: ReadAs) -> float:
        """Return by how much ``formula`` holds at sample ``k`` in a view; -∞ to ∞."""
        known = self._given(formula)
        if known is not None:
            return inf if known[k] else -inf
        match formula:
            case f.Truth(value):
                return inf if value else -inf
            case f.Compare(left, op, right):
                x, y = self.number(left, k), self.number(right, k)
                if x == y:
                    return 0.0  # ∞ - ∞ too
                return x - y if op in (">", ">=") else y - x
            case f.Not(body):
                return -self.margin(body, k, _swapped(view))
            case f.And(parts):
                return min(self.margin(p, k, view) for p in parts)
            case f.Or(parts):
                return max(self.margin(p, k, view) for p in parts)
            case f.Application(_, _, body):
                return self.margin(body, k, view)
            case f.Eventually(interval, body):
                window, whole = self.window(interval, k)
                best = max((self.margin(body, j, view) for j in window), default=-inf)
                return inf if view == "weak" and not whole else best
            case f.Always(interval, body):
                window, whole = self.window(interval, k)
                worst = min((self.margin(body, j, view) for j in window), default=inf)
                return -inf if view == "strong" and not whole else worst
            case f.Until(left, interval, right):
                window, whole = self.window(interval, k)
                best = -inf
                for j in window:
                    before = (self.margin(left, i, view) for i in window if i < j)
                    best = max(best, min(self.margin(right, j, view), min(before, default=inf)))
                if view == "weak" and not whole:
                    best = max(best, min((self.margin(left, i, view) for i in window), default=inf))
                return best
            case f.Since(left, interval, right):
                past, best = self.past(interval, k), -inf
                for j in past:
                    after = (self.margin(left, i, view) for i in past if i > j)
                    best = max(best, min(self.margin(right, j, view), min(after, default=inf)))
                return best
            case f.Occupies() | f.Some() | f.Every():
                raise _not_given(formula)
            case _:
                assert_never(formula)

    # --- windows, given formulas and numbers -----------------------------------------------------

    def window(self, interval: f.Interval, k: int) -> tuple[range, bool]:
        """Samples of the trace in k + interval, and whether these are all there are."""
        low, high = bounds_of(interval)
        first = k + self._steps(low)
        if high is None:
            return range(first, self.trace.length), False
        last = k + self._steps(high)
        return range(first, min(last, self.trace.length - 1) + 1), last < self.trace.length

    def past(self, interval: f.Interval, k: int) -> range:
        """Samples of the trace in k - interval."""
        low, high = bounds_of(interval)
        first = 0 if high is None else max(0, k - self._steps(high))
        return range(first, k - self._steps(low) + 1)

    def _steps(self, bound: Fraction) -> int:
        count, rest = divmod(bound, self.trace.dt)
        if rest:
            raise InputError(f"the interval bound {bound} s is no multiple of dt={self.trace.dt} s")
        return int(count)

    def _given(self, formula: Formula) -> Sequence[bool] | None:
        if formula not in self.found:
            self.found[formula] = self.given.get(without_names(formula))
        return self.found[formula]

    def number(self, term: t.Term, k: int) -> float:
        """The value of ``term`` at sample ``k`` in floating-point arithmetic, from left to right."""
        if term not in self.constants:
            exact = t.constant_value(term)
            self.constants[term] = None if exact is None else float(exact)
        constant = self.constants[term]
        if constant is not None:
            return constant
        match term:
            case t.Signal(name, vehicle) | t.CustomSignal(name, vehicle):
                return float(self.trace.signals[name, vehicle][k])
            case t.Size(name, vehicle):
                return float(self.trace.sizes[name, vehicle])
            case t.Sum(terms):
                first, *rest = self._numbers(terms, k)
                for x in rest:
                    first += x
                return first
            case t.Product(factors):
                first, *rest = self._numbers(factors, k)
                for x in rest:
                    first *= x
                return first
            case t.Power(base, exponent):
                factor = self.number(base, k)
                power = factor if exponent else 1.0
                for _ in range(exponent - 1):
                    power *= factor
                return power
            case t.Quotient(numerator, denominator):
                return self.number(numerator, k) / self.number(denominator, k)
            case t.Maximum(terms):
                return max(self._numbers(terms, k))
            case t.Minimum(terms):
                return min(self._numbers(terms, k))
            case t.Inverse(inner):
                x = self.number(inner, k)
                return inf if x == 0 else 1.0 / x
            case t.Number() | t.Parameter() | t.Variable():
                raise InputError(f"a monitored formula has values for all its names, but {term} is open")
            case _:
                assert_never(term)

    def _numbers(self, terms: Iterable[t.Term], k: int) -> list[float]:
        return [self.number(x, k) for x in terms]


def _swapped(view: ReadAs) -> ReadAs:
    return {"strong": "weak", "weak": "strong", "clip": "clip"}[view]  # type: ignore[return-value]


def _not_given(formula: Formula) -> InputError:
    return InputError(f"{formula} is not given for this trace: bind the formula to a road first")
