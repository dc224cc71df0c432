"""The judge on drives with jerk against exact values at many instants, of boxes and RSS distances too."""

from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from judge.cases import jerk_drives, operators
from judge.test_exact import bound, motion, truth
from planting import plant
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import boxes_overlap
from roadproof.semantics.exact import algebraic, exact, piecewise, signals
from roadproof.semantics.exact.algebraic import bounds, real_roots
from roadproof.semantics.exact.robust import robustness
from roadproof.world.drive import Drive
from roadproof.world.motion import starts_of, state_at
from roadproof.world.signals import SIGNALS

quiet = settings(max_examples=60, deadline=None, derandomize=True)
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
    found = exact.judge(compare, drive).truth(compare)
    switches = [bounds(cut.point, Fraction(1, 10**9)) for cut in found.cuts]
    knots = [x.time for motion in drive.vehicles.values() for x in starts_of(motion)]
    for time in {*TIMES, *knots, *(x for pair in switches for x in pair)}:
        said = HOLDS[compare.op](value(compare.left, drive, time), value(compare.right, drive, time))
        if time >= 0 and found.at(time) != said:
            return time
    return None


@quiet
@given(st.builds(f.Compare, terms, operators, st.one_of(terms, numbers)), jerk_drives)
def test_comparisons_of_cubics_and_their_products(compare, drive):
    assert disagreement(compare, drive) is None


SIX = f.Compare(t.Power(t.Signal("s", "A"), 2), ">=", t.number(2))
SMOOTH = Drive({"A": motion(0, 2, pieces=[(3, 0, 0, 1)]), "B": motion(3, 2, 1)})


def test_a_square_of_a_cubic_is_a_sextic():
    """t⁶/36 >= 2 from the sixth root of 72 on, which is 2.039648903 s; then s is 9/2 + 9/2·(t - 3)."""
    found = exact.judge(SIX, SMOOTH).truth(SIX)
    assert str(found) == "[2.039649 ± 0.000001, ∞)"
    (cut,) = found.cuts
    assert cut.point == real_roots((-72, 0, 0, 0, 0, 0, 1))[1][0]
    assert disagreement(SIX, SMOOTH) is None


@pytest.mark.parametrize(
    ("owner", "name", "right", "wrong"),
    [
        (signals, "_from", "found[k] -= begin", "found[k] += begin"),
        (signals, "_from", "range(len(found) - 1)", "range(min(2, len(found) - 1))"),
        (algebraic, "_roots_by_factoring", "found.append((Root(polynomial, *ends), multiplicity))", "break"),
        (algebraic, "_roots_by_factoring", "(point, multiplicity) for", "(point, 2 * multiplicity) for"),
        (
            algebraic,
            "_roots_by_factoring",
            "Root(polynomial, *ends), multiplicity",
            "Root(polynomial, *ends), 2",
        ),
        (piecewise, "_steady_sign", "if is_rootless(numerators, low, high) else 0", ""),
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


@quiet
@given(jerk_drives)
def test_boxes_overlap_where_corners_say_so(drive):
    overlap = boxes_overlap("A", "B")
    found = exact.judge(overlap, drive).truth(overlap)
    a, b = drive.vehicles["A"], drive.vehicles["B"]
    for time in TIMES:
        x, y = state_at(a, time), state_at(b, time)
        along = max(x.s - a.length, y.s - b.length) < min(x.s, y.s)
        assert found.at(time) == (along and max(x.d - a.width, y.d - b.width) < min(x.d, y.d))


@quiet
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
        found = exact.judge(part, drive).truth(part)
        points = [bounds(cut.point, Fraction(1, 10**9)) for cut in found.cuts]
        inside = [Fraction(0), *(x for pair in points for x in pair), Fraction(50)]
        for low, high in pairwise(inside):
            middle = (low + high) / 2
            margin = robustness(part, drive, middle, middle).margins[part][1] if middle else None
            if margin is not None and abs(margin) > 1e-6:
                assert found.at(middle) == (margin > 0)
