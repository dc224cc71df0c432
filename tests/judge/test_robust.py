"""Margins on a grid: by definition, in sign with the exact judge, and refused where they make no sense."""

from fractions import Fraction
from math import inf

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from judge.cases import comparisons, drives, formulas
from judge.test_exact import alone, bound, motion, random_drive
from roadproof.errors import InputError, UsageError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.rewrite import bounds_of
from roadproof.semantics.exact import robust
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.robust import robustness
from roadproof.semantics.exact.signals import Courses, DriveSignals
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at

HALF, SECOND = Fraction(1, 2), Fraction(1)
quiet = settings(deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


class Naive:
    """Margins by definition, one sample at a time; windows without end stop at sample ``last``."""

    def __init__(self, drive, dt, last):
        self.drive, self.dt, self.last = drive, dt, last

    def value(self, term, k):
        """Exact, or ∞."""
        match term:
            case t.Number(value, _):
                return value
            case t.Signal(name, vehicle):
                return getattr(state_at(self.drive.vehicles[vehicle], k * self.dt), name)
            case t.Sum(terms):
                return sum(self.value(x, k) for x in terms)
            case t.Product((x, y)):
                return self.value(x, k) * self.value(y, k)
            case t.Power(base, exponent):
                return self.value(base, k) ** exponent
            case t.Quotient(x, y):
                return self.value(x, k) / self.value(y, k)
            case t.Maximum(terms):
                return max(self.value(x, k) for x in terms)
            case t.Minimum(terms):
                return min(self.value(x, k) for x in terms)
            case t.Inverse(inner):
                x = self.value(inner, k)
                return inf if x == 0 else 1 / x

    def margin(self, formula, k):
        match formula:
            case f.Compare(left, op, right):
                x, y = self.value(left, k), self.value(right, k)
                gap = 0.0 if x == y else float(x) - float(y)
                return gap if op in (">", ">=") else -gap
            case f.Not(body):
                return -self.margin(body, k)
            case f.And(parts):
                return min(self.margin(p, k) for p in parts)
            case f.Or(parts):
                return max(self.margin(p, k) for p in parts)
            case f.Eventually(interval, body):
                return max(self.margin(body, j) for j in self.window(interval, k, (body,)))
            case f.Always(interval, body):
                return min(self.margin(body, j) for j in self.window(interval, k, (body,)))
            case f.Until(left, interval, right):
                window = self.window(interval, k, (left, right))
                return max(
                    min([self.margin(right, j), *(self.margin(left, i) for i in window if i < j)])
                    for j in window
                )

    def window(self, interval, k, bodies):
        low, high = bounds_of(interval)
        begin = k + int(low / self.dt)
        end = self.last - max(map(self.reach, bodies)) if high is None else k + int(high / self.dt)
        return range(begin, end + 1)

    def reach(self, formula):
        within = max(map(self.reach, f.children(formula)), default=0)
        if isinstance(formula, f.Eventually | f.Always | f.Until):
            low, high = bounds_of(formula.interval)
            within += int((low if high is None else high) / self.dt)
        return within


@settings(quiet, max_examples=80)
@given(formulas(comparisons, leaves=3), drives)
def test_margins_are_what_the_definition_says(formula, drive):
    found = robustness(formula, drive, HALF, 2 * SECOND)
    naive = Naive(drive, HALF, int(found.sampled_until / HALF))
    expected = [naive.margin(formula, k) for k in range(5)]
    assert found.margins[formula] == pytest.approx(expected, rel=1e-9, abs=1e-12)
    assert all(len(margins) == 5 for margins in found.margins.values())


@settings(quiet, max_examples=80)
@given(comparisons, drives)
def test_the_sign_of_a_comparison_is_its_truth(comparison, drive):
    truth = judge(comparison, drive).truth(comparison)
    for k, margin in enumerate(robustness(comparison, drive, HALF, 4 * SECOND).margins[comparison]):
        if margin != 0:
            assert truth.at(k * HALF) == (margin > 0)
        else:
            assert truth.at(k * HALF) == (comparison.op in (">=", "<="))


@pytest.mark.parametrize("ends", [(0, 0), (0, 1), (0, 2), (1, 1), (1, 3), (2, 3), (0, None), (2, None)])
def test_until_looks_at_every_sample_of_its_window(ends):
    """The right side is true at one sample only, the left one before it, or at some of it."""
    low, high = (None if end is None else t.number(end) for end in ends)
    place = t.Signal("s", "A")
    at = [f.And((f.Compare(place, ">=", t.number(n)), f.Compare(place, "<=", t.number(n)))) for n in range(5)]
    for side in (*at, f.Or(tuple(at[:2])), f.Not(at[1]), f.Compare(place, "<=", t.number(2))):
        for other in at:
            formula = f.Until(side, f.Interval(low, high), other)
            found = robustness(formula, alone(v_lon=1), SECOND, 4 * SECOND)
            naive = Naive(alone(v_lon=1), SECOND, int(found.sampled_until))
            assert list(found.margins[formula]) == [naive.margin(formula, k) for k in range(5)]


def test_bounded_windows_are_covered_past_the_horizon():
    drive = alone(v_lon=1)  # s = t
    formula = f.Eventually(
        f.Interval(t.number(1), t.number(3)), f.Compare(t.Signal("s", "A"), ">=", t.number(2))
    )
    found = robustness(formula, drive, SECOND, 4 * SECOND)
    assert list(found.margins[formula]) == [1, 2, 3, 4, 5]
    assert (found.value, found.sampled_until, found.unbounded) == (1.0, 7, False)


def test_an_unbounded_window_ends_with_the_last_sample_and_says_so():
    drive = alone(v_lon=1)
    low = f.Compare(t.Signal("s", "A"), "<=", t.number(2))
    formula = f.Always(f.FOREVER, f.Eventually(f.Interval(t.number(0), t.number(1)), low))
    found = robustness(formula, drive, SECOND, 4 * SECOND)
    assert found.unbounded
    # The last whole inner window begins at the horizon: no margin of a window that dangles.
    assert (found.value, found.sampled_until) == (-2.0, 5)


def test_infinite_margins():
    drive = alone()
    inverse = t.Inverse(t.Signal("s", "A"))
    same = f.Compare(inverse, ">=", inverse)
    assert robustness(same, drive, SECOND, SECOND).value == 0.0
    above = f.Compare(inverse, ">=", t.number(5))
    assert robustness(above, drive, SECOND, SECOND).value == inf
    assert robustness(f.TRUE, drive, SECOND, SECOND).value == inf
    assert robustness(f.Not(f.TRUE), drive, SECOND, SECOND).value == -inf


def test_danger_deepens_as_the_gap_closes():
    """The robust predicates are monotone in the gap (paper, appendix Robust Semantics)."""
    drive = Drive({"A": motion(0, 3, 25), "B": motion(40, 3, 20)})
    violation = bound("given A, B: vehicle: rssViolation_lon(A, B)", rss_form="robust")
    margins = robustness(violation, drive, Fraction(1, 5), 6 * SECOND).margins[violation]
    assert (np.diff(margins) > 0).all()


def test_a_scenario_in_robust_form_agrees_in_sign_with_the_judge():
    for seed in range(3):
        drive = random_drive(seed, ("SV", "POV"))
        formula = bound("initSafe(SV, POV) and F[0,6] danger(SV, POV)", rss_form="robust")
        found = robustness(formula, drive, Fraction(1, 5), 3 * SECOND)
        for part in f.subformulas(formula):
            if isinstance(part, f.Compare):
                truth = judge(part, drive).truth(part)
                for k, margin in enumerate(found.margins[part]):
                    assert margin == 0 or truth.at(k * Fraction(1, 5)) == (margin > 0)


def test_values_are_rounded_once():
    third = t.Quotient(t.Signal("s", "A"), t.number(3))
    pieces = Courses(DriveSignals(alone(v_lon=Fraction(1, 7)))).of(third)
    assert list(robust._sample(pieces, Fraction(1, 10), 4)) == [k / 210 for k in range(4)]


@pytest.mark.parametrize(
    ("formula", "dt", "horizon", "error", "message"),
    [
        (f.Eventually(f.Interval(t.number(0), t.number(Fraction(3, 5))), f.TRUE), HALF, SECOND, InputError,
         "interval bound=3/5 s is no multiple of dt=1/2 s"),
        (f.TRUE, Fraction(2, 3), SECOND, InputError, "horizon=1 s is no multiple of dt=2/3 s"),
        (f.TRUE, Fraction(0), SECOND, UsageError, "dt=0"),
        (f.TRUE, HALF, -SECOND, UsageError, "horizon=-1"),
        (f.TRUE, Fraction(1, 10**6), SECOND, UsageError, "above 1000000"),
        (f.Occupies("A", "m1"), HALF, SECOND, InputError, "bound to a road"),
    ],
)  # fmt: skip
def test_what_cannot_be_sampled_is_refused(formula, dt, horizon, error, message):
    with pytest.raises(error, match=message):
        robustness(formula, alone(), dt, horizon)


def one_short(body, low, high):
    """A window that misses its last sample."""
    return real["_greatest_ahead"](body, low, high and max(low, high - 1))


def greedy(left, low, high, right):
    """Left asked for at the end, too."""
    size = min(len(left), len(right))
    return real["_until"](left, low, high, np.minimum(left[:size], right[:size]))


def reversed_difference(left, right):
    return real["_difference"](right, left)


def always_or(join, arrays):
    return real["_fold"](np.maximum, arrays)


FAULTS = {
    "_greatest_ahead": one_short,
    "_until": greedy,
    "_difference": reversed_difference,
    "_fold": always_or,
}
real = {name: getattr(robust, name) for name in FAULTS}


@pytest.mark.parametrize("name", FAULTS)
def test_a_planted_fault_is_noticed(monkeypatch, name):
    fast, slow = (f.Compare(t.Signal("v_lon", "A"), ">=", t.number(n)) for n in (1, 2))
    window = f.Interval(t.number(0), t.number(2))
    drive = alone(v_lon=0, pieces=[(1, 1, 0), (2, 2, 0)], last=(-1, 0))
    cases = (f.Eventually(window, fast), f.Until(f.Not(fast), window, slow), f.And((fast, f.Not(slow))))

    def agrees(formula):
        found = robustness(formula, drive, HALF, 3 * SECOND)
        naive = Naive(drive, HALF, int(found.sampled_until / HALF))
        return list(found.margins[formula]) == [naive.margin(formula, k) for k in range(7)]

    assert all(map(agrees, cases))
    monkeypatch.setattr(robust, name, FAULTS[name])
    assert not all(map(agrees, cases))
