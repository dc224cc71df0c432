"""Margins on a grid: by definition, in sign with the exact judge, and refused where they make no sense."""

from fractions import Fraction
from itertools import pairwise
from math import inf

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from judge.cases import comparisons, drives, formulas, jerk_drives, operators
from judge.test_exact import alone, bound, motion, random_drive, truth
from planting import plant
from roadproof.errors import InputError, UsageError
from roadproof.extensions.traffic.evaluate import robust
from roadproof.extensions.traffic.evaluate.robust import robustness
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import boxes_overlap
from roadproof.logic.rewrite import bounds_of
from roadproof.semantics.exact import algebraic, judging, piecewise, samples, signals
from roadproof.semantics.exact.algebraic import bounds, real_roots
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.signals import DriveSignals, TermPieces
from roadproof.world.drive import Drive
from roadproof.world.motion import piece_starts, state_at
from roadproof.world.signals import SIGNALS

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
            case f.Since(left, interval, right):
                low, high = bounds_of(interval)
                first = 0 if high is None else max(0, k - int(high / self.dt))
                past = range(first, k - int(low / self.dt) + 1)
                return max(
                    (
                        min([self.margin(right, j), *(self.margin(left, i) for i in past if i > j)])
                        for j in past
                    ),
                    default=-inf,
                )
            case f.Truth(value):
                return inf if value else -inf

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
    assert (found.value, found.sampled_until) == (1.0, 7)


def test_an_unbounded_window_ends_with_the_last_sample_and_says_so():
    drive = alone(v_lon=1)
    low = f.Compare(t.Signal("s", "A"), "<=", t.number(2))
    formula = f.Always(f.FOREVER, f.Eventually(f.Interval(t.number(0), t.number(1)), low))
    found = robustness(formula, drive, SECOND, 4 * SECOND)
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
    pieces = TermPieces(DriveSignals(alone(v_lon=Fraction(1, 7)))).of(third)
    assert list(samples._sample(pieces, Fraction(1, 10), 4)) == [k / 210 for k in range(4)]


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
homes = {name: samples if name == "_difference" else robust for name in FAULTS}
real = {name: getattr(home, name) for name, home in homes.items()}


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
    monkeypatch.setattr(homes[name], name, FAULTS[name])
    assert not all(map(agrees, cases))


# --- The judge on drives with jerk against exact values at many instants, of boxes and RSS distances too

few = settings(max_examples=60, deadline=None, derandomize=True)
TIMES = [Fraction(k, 7) for k in range(80)]
HOLDS = {
    "<": lambda x, y: x < y,
    "<=": lambda x, y: x <= y,
    ">": lambda x, y: x > y,
    ">=": lambda x, y: x >= y,
}

of_vehicles = st.builds(t.Signal, st.sampled_from(tuple(SIGNALS)), st.sampled_from("AB"))
numbers = st.integers(-6, 12).map(lambda n: t.number(Fraction(n, 2)))
products = st.builds(lambda x, y: t.Product((x, y)), of_vehicles, of_vehicles)
squares = st.builds(lambda x, y: t.Power(t.subtract(x, y), 2), of_vehicles, of_vehicles)
terms = st.one_of(
    of_vehicles,
    products,
    squares,
    st.builds(lambda x, y: t.Sum((x, y)), st.one_of(products, squares), st.one_of(numbers, of_vehicles)),
    st.builds(lambda x, y: t.Maximum((x, y)), st.one_of(products, of_vehicles), numbers),
)


def value(term, drive, time):
    """The value of a term, from the states of the vehicles."""
    match term:
        case t.Signal(name, vehicle):
            return getattr(state_at(drive.vehicles[vehicle], time), name)
        case t.Number(number, _):
            return number
        case t.Product((x, y)):
            return value(x, drive, time) * value(y, drive, time)
        case t.Power(base, exponent):
            return value(base, drive, time) ** exponent
        case t.Sum(parts):
            return sum(value(x, drive, time) for x in parts)
        case t.Maximum(parts):
            return max(value(x, drive, time) for x in parts)
    raise AssertionError(term)


def disagreement(compare, drive):
    """An instant at which the judge says otherwise than the values, near its switches too; or None."""
    found = judging.judge(compare, drive).truth(compare)
    switches = [bounds(cut.point, Fraction(1, 10**9)) for cut in found.cuts]
    knots = [x.time for motion in drive.vehicles.values() for x in piece_starts(motion)]
    for time in {*TIMES, *knots, *(x for pair in switches for x in pair)}:
        said = HOLDS[compare.op](value(compare.left, drive, time), value(compare.right, drive, time))
        if time >= 0 and found.at(time) != said:
            return time
    return None


@few
@given(st.builds(f.Compare, terms, operators, st.one_of(terms, numbers)), jerk_drives)
def test_comparisons_of_cubics_and_their_products(compare, drive):
    assert disagreement(compare, drive) is None


SIX = f.Compare(t.Power(t.Signal("s", "A"), 2), ">=", t.number(2))
SMOOTH = Drive({"A": motion(0, 2, pieces=[(3, 0, 0, 1)]), "B": motion(3, 2, 1)})


def test_a_square_of_a_cubic_is_a_sextic():
    """t⁶/36 >= 2 from the sixth root of 72 on, which is 2.039648903 s; then s is 9/2 + 9/2·(t - 3)."""
    found = judging.judge(SIX, SMOOTH).truth(SIX)
    assert str(found) == "[2.039649 ± 0.000001, ∞)"
    (cut,) = found.cuts
    assert cut.point == real_roots((-72, 0, 0, 0, 0, 0, 1))[1][0]
    assert disagreement(SIX, SMOOTH) is None


@pytest.mark.parametrize(
    ("owner", "name", "right", "wrong"),
    [
        (signals, "_from", "shifted[k] -= begin", "shifted[k] += begin"),
        (signals, "_from", "range(len(shifted) - 1)", "range(min(2, len(shifted) - 1))"),
        (algebraic, "_roots_by_factoring", "roots.append((Root(polynomial, *ends), multiplicity))", "break"),
        (algebraic, "_roots_by_factoring", "(point, multiplicity) for", "(point, 2 * multiplicity) for"),
        (
            algebraic,
            "_roots_by_factoring",
            "Root(polynomial, *ends), multiplicity",
            "Root(polynomial, *ends), 2",
        ),
        (piecewise, "_steady_sign", "if is_rootless(numerators, low, high, halvings) else 0", ""),
        (piecewise, "_steady_sign", "sign_at(numerators, low)", "-1"),
    ],
)
def test_planted_faults_are_noticed(monkeypatch, owner, name, right, wrong):
    later = Drive({"A": motion(-6, 2, 2, pieces=[(1, 1, 0, -2), (2, -1, 0, 4)]), "B": motion(3, 2, 1)})
    cubic = f.Compare(t.Signal("s", "A"), ">=", t.number(-1))
    factors = f.Compare(t.Product((t.Signal("v_lon", "A"), t.Signal("s", "A"))), ">", t.number(0))
    turning = Drive({"A": motion(1, 0, -1, pieces=[(3, 0, 0, 1)]), "B": motion(3, 2, 1)})
    cases = [(SIX, SMOOTH), (cubic, later), (factors, later), (cubic, SMOOTH), (factors, turning)]

    def noticed():
        forget()
        return any(disagreement(*case) is not None for case in cases)

    assert not noticed()
    plant(monkeypatch, owner, name, right, wrong)
    found = noticed()
    monkeypatch.undo()
    forget()
    assert found


def forget():
    """Roots are remembered from one question to the next."""
    algebraic.real_roots.cache_clear()
    piecewise._sign_changes.cache_clear()


@few
@given(jerk_drives)
def test_boxes_overlap_where_corners_say_so(drive):
    overlap = boxes_overlap("A", "B")
    found = judging.judge(overlap, drive).truth(overlap)
    a, b = drive.vehicles["A"], drive.vehicles["B"]
    for time in TIMES:
        x, y = state_at(a, time), state_at(b, time)
        along = max(x.s - a.length, y.s - b.length) < min(x.s, y.s)
        assert found.at(time) == (along and max(x.d - a.width, y.d - b.width) < min(x.d, y.d))


@few
@given(jerk_drives)
def test_margins_at_samples_are_differences_of_values(drive):
    compare = f.Compare(t.Power(t.Signal("v_lon", "A"), 2), ">=", t.Signal("s", "B"))
    margins = robustness(compare, drive, Fraction(1, 7), Fraction(10)).margins[compare]
    for k in range(0, 71, 5):
        time = Fraction(k, 7)
        assert margins[k] == float(value(compare.left, drive, time)) - float(
            value(compare.right, drive, time)
        )


def test_jerk_is_that_of_the_piece_that_begins_and_none_in_the_end():
    drive = Drive({"A": motion(pieces=[(1, 0, 0, 2), (1, 2, 0), (1, 0, 0, -1)])})
    assert str(truth("j_lon(A) > 0", drive)) == "[0, 1)"
    assert str(truth("j_lon(A) = 0", drive)) == "[1, 2) ∪ [3, ∞)"
    assert str(truth("j_lon(A) = -1 m/s^3", drive)) == "[2, 3)"
    assert str(truth("a_lon(A) >= 2 m/s^2", drive)) == "[1, 2)"  # 2·t before 1 s, 2 from then on
    assert str(truth("a_lon(A) > 1 m/s^2", drive)) == "(0.5, 2)"
    assert str(truth("a_lon(A) < 0", drive)) == "(2, 3)"
    assert str(truth("v_lon(A) >= 3 m/s", drive)) == "{2}"


@pytest.mark.parametrize("scenario", [1, 3, 4, 5, 8])
def test_scenarios_switch_where_their_atoms_do(scenario):
    """The RSS distances are maxima of terms of degree 4; each comparison is what its values say."""
    drive = Drive(
        {
            "SV": motion(0, "13/5", 30, pieces=[(1, 0, 0, -2), (1, -2, "1/10", 2)]),
            "POV": motion(70, "27/5", 28, pieces=[(1, 0, "-1/2", -5), (1, -5, "1/2"), (1, -5, 0, 5)]),
        }
    )
    formula = bound(f"scenario_{scenario}(SV, POV, L)", "ext")
    for part in {x for x in f.subformulas(formula) if isinstance(x, f.Compare)}:
        found = judging.judge(part, drive).truth(part)
        points = [bounds(cut.point, Fraction(1, 10**9)) for cut in found.cuts]
        inside = [Fraction(0), *(x for pair in points for x in pair), Fraction(50)]
        for low, high in pairwise(inside):
            middle = (low + high) / 2
            margin = robustness(part, drive, middle, middle).margins[part][1] if middle else None
            if margin is not None and abs(margin) > 1e-6:
                assert found.at(middle) == (margin > 0)
