"""The judge on written-out drives, on the bundled library, and on input that is wrong."""

import pickle
import random
import sys
from fractions import Fraction

import pytest
from hypothesis import HealthCheck, Phase, assume, find, given, settings
from hypothesis import strategies as st

from examples import some
from extensions.drivers.read import boundary
from judge.cases import (
    comparisons,
    drives,
    every_small_case,
    formulas,
    jerk_comparisons,
    jerk_drives,
    opaque_cases,
)
from judge.pinning import disagreement_on_drive, disagreement_on_sets
from planting import plant
from roadproof.errors import InputError, UsageError
from roadproof.extensions.drivers import judging as restricted
from roadproof.extensions.drivers.judging import truth_within
from roadproof.extensions.drivers.manoeuvres import CUT_IN, along_line
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.semantics.exact import judging
from roadproof.semantics.exact.algebraic import real_roots
from roadproof.semantics.exact.judging import DriveJudge, LazyJudge, judge
from roadproof.semantics.exact.signals import AbstractSignals, DriveSignals
from roadproof.semantics.exact.truth import ALWAYS, NEVER, intersection, interval, union
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.road import Lanelet, Road, adjacency
from tables import read_table

LIBRARY = bundled_library()
ROAD = Road(
    "two lanes",
    (
        Lanelet("m1", "main-1", "main", "main", (None, None), (Fraction(0), Fraction(7, 2))),
        Lanelet("m2", "main-2", "main", "main", (None, None), (Fraction(7, 2), Fraction(7))),
    ),
    adjacency([("main-1", "main-2")]),
)
SQRT2 = real_roots((-2, 0, 1))[1][0]


def motion(s=0, d=0, v_lon=0, v_lat=0, pieces=(), last=(0, 0)):
    """``pieces`` are (duration, a_lon, a_lat) or (duration, a_lon, a_lat, j_lon)."""
    made = [Piece(*map(Fraction, piece)) for piece in pieces]
    state = [Fraction(x) for x in (s, d, v_lon, v_lat)]
    final = Piece(None, Fraction(last[0]), Fraction(last[1]))
    return Motion(Fraction(9, 2), Fraction(9, 5), *state, (*made, final))


def bound(text, set_name="base", lane="main-1", **options):
    query = read_claim(LIBRARY.select(set_name, options), text)
    lanes = dict.fromkeys(query.lanes, lane)
    return bind(query.formula, ROAD, lanes, default_values(LIBRARY))


def truth(text, drive, **options):
    formula = bound(f"given A, B: vehicle: {text}", **options)
    return judge(formula, drive).truth(formula)


def span(low, high, closed="[]"):
    return interval(Fraction(low), None if high is None else Fraction(high), closed)


def alone(**state):
    return Drive({"A": motion(**state)})


def test_a_tangent_root_is_one_instant():
    drive = alone(s=1, v_lon=-2, last=(2, 0))  # s = (t - 1)²
    assert truth("s(A) <= 0 m", drive) == span(1, 1)
    assert truth("s(A) < 0 m", drive) == NEVER
    assert truth("s(A) >= 0 m", drive) == ALWAYS
    assert truth("s(A) > 0 m", drive) == union([span(0, 1, "[)"), span(1, None, "()")])
    assert truth("F[1,1] s(A) = 0 m", drive) == span(0, 0)
    assert truth("F[0,1] s(A) = 0 m", drive) == span(0, 1)


def test_windows_that_end_on_roots():
    drive = alone(v_lon=0, last=(1, 0))  # s = t²/2 reaches 1 at √2
    assert truth("s(A) >= 1 m", drive) == interval(SQRT2, None)
    assert truth("F[0,1.5] s(A) >= 1 m", drive) == ALWAYS
    assert truth("F[0,1.4] s(A) >= 1 m", drive).at(Fraction(1, 50)) is True
    assert truth("F[0,1.4] s(A) >= 1 m", drive).at(Fraction(1, 100)) is False
    assert truth("s(A) >= 2 m", drive) == span(2, None)
    assert truth("F[0,2] s(A) >= 2 m", drive) == ALWAYS
    assert truth("F[0,2] s(A) > 2 m", drive) == span(0, None, "()")
    assert truth("G[0,2] s(A) < 2 m", drive) == NEVER
    assert truth("G[0,2] s(A) <= 2 m", drive) == span(0, 0)


def test_a_knot_belongs_to_the_piece_that_begins_there():
    drive = alone(pieces=[(1, 2, 0), (1, -1, 0)])
    assert truth("a_lon(A) > 0 m/s^2", drive) == span(0, 1, "[)")
    assert truth("a_lon(A) < 0 m/s^2", drive) == span(1, 2, "[)")
    assert truth("a_lon(A) = 0 m/s^2", drive) == span(2, None)
    assert truth("v_lon(A) >= 2 m/s", drive) == span(1, 1)


def test_simultaneous_switches():
    drive = alone(pieces=[(1, 1, 0)], last=(0, 0))
    assert truth("a_lon(A) > 0 m/s^2 U v_lon(A) >= 1 m/s", drive) == ALWAYS
    assert truth("a_lon(A) > 0 m/s^2 U v_lon(A) > 1 m/s", drive) == NEVER
    assert truth("(a_lon(A) > 0 m/s^2) U[0,0.5] (a_lon(A) <= 0 m/s^2)", drive) == span("1/2", None)


def test_until_asks_for_left_inside_its_window_only():
    # a_lon > 0 on [1, 2) only; v_lon reaches 1 at 2.
    drive = alone(pieces=[(1, 0, 0), (1, 1, 0)])
    assert truth("(a_lon(A) > 0 m/s^2) U[1,3] (v_lon(A) >= 1 m/s)", drive).at(Fraction(0))
    assert not truth("(a_lon(A) > 0 m/s^2) U[0,3] (v_lon(A) >= 1 m/s)", drive).at(Fraction(0))


def test_the_last_piece_lasts_for_ever():
    assert truth("G v_lon(A) >= 0 m/s", alone(v_lon=100, last=(Fraction(-1, 1000), 0))) == NEVER
    assert truth("G v_lon(A) >= 0 m/s", alone(v_lon=100)) == ALWAYS
    assert truth("F s(A) < 0 m", alone(v_lon=100, last=(Fraction(-1, 1000), 0))) == ALWAYS
    assert truth("G F s(A) > 1000000 m", alone(v_lon=1)) == ALWAYS


def test_maximum_and_powers():
    drive = alone(v_lon=-1, last=(1, 0))  # v = t - 1
    assert truth("max(0 m/s, v_lon(A)) > 0 m/s", drive) == span(1, None, "()")
    assert truth("max(v_lon(A), -v_lon(A)) <= 1 m/s", drive) == span(0, 2)
    # (t - 1)^4 = 4 at 1 + √2
    assert str(truth("v_lon(A)^4 >= 4 * 1 m/s * 1 m/s * 1 m/s * 1 m/s", drive)) == "[2.414214 ± 0.000001, ∞)"


def test_inverse_is_infinite_at_zero():
    drive = alone(v_lon=-1, last=(1, 0))  # v = t - 1
    one = f.Compare(t.Inverse(t.Signal("v_lon", "A")), ">=", t.number(2))
    assert judge(one, drive).truth(one) == span(1, "3/2")
    both = f.Compare(t.Inverse(t.Signal("v_lon", "A")), ">=", t.Inverse(t.Signal("v_lon", "A")))
    strict = f.Compare(both.left, ">", both.right)
    assert judge(both, drive).truth(both) == ALWAYS
    assert judge(strict, drive).truth(strict) == NEVER
    below = f.Compare(t.number(0), ">", t.Inverse(t.Signal("v_lon", "A")))
    assert judge(below, drive).truth(below) == span(0, 1, "[)")


def constant_speeds(**speeds):
    return Drive(
        {
            name: motion(v_lon=speeds.get(f"{name}_lon", 0), v_lat=speeds.get(f"{name}_lat", 0))
            for name in ("A", "B")
        }
    )


def lies_at(term, value, drive, **options):
    """``value`` (m) is the value of ``term`` to the last digit given, half a digit either way."""
    half = Fraction(1, 2 * 10 ** len(value.partition(".")[2]))
    low, high = Fraction(value) - half, Fraction(value) + half
    claim = f"{term} >= {float(low):.6f} m and {term} <= {float(high):.6f} m"
    return truth(claim, drive, **options) == ALWAYS


@pytest.mark.parametrize(
    ("rear", "front", "distance"),
    [("30", "24", "73.6500"), ("20", "33", "0.0000"), ("0", "0", "1.6500"), ("35", "35", "65.6708")],
)
def test_longitudinal_rss_distance(rear, front, distance):
    drive = constant_speeds(A_lon=rear, B_lon=front)
    assert lies_at("dRSS_lon(v_lon(A), v_lon(B))", distance, drive)


@pytest.mark.parametrize(
    ("left", "right", "paper", "signed"),
    [
        ("0", "0", "1.0800", "1.0800"),
        ("1", "-1", "4.1467", "4.1467"),
        ("-1", "3/2", "0.0000", "0.0000"),
        ("-2", "-1", "1.5467", "1.1433"),
        ("-3", "-3", "7.0800", "5.6100"),
    ],
)
def test_lateral_rss_distance(left, right, paper, signed):
    literal = constant_speeds(A_lat=left, B_lat=right)
    mirrored = constant_speeds(A_lat=-Fraction(left), B_lat=-Fraction(right))
    for reading, distance in (("paper", paper), ("signed", signed)):
        assert lies_at("dRSS_lat(v_lat(A), v_lat(B))", distance, literal, lateral_rss=reading)
        for sign, drive in (("literal", literal), ("rss", mirrored)):
            options = {"lateral_rss": reading, "lateral_sign": sign}
            assert lies_at("lateralDistance(A, B)", distance, drive, **options)


def random_drive(seed, names, count=11):
    rnd = random.Random(seed)
    drive = {}
    for i, name in enumerate(names):
        pieces = [
            (
                Fraction(rnd.randint(4, 9), 10),
                Fraction(rnd.randint(-30, 30), 10),
                Fraction(rnd.randint(-5, 5), 10),
            )
            for _ in range(count)
        ]
        drive[name] = motion(70 * i, rnd.randint(2, 5), 30 - 5 * i, 0, pieces)
    return Drive(drive)


@pytest.mark.parametrize("seed", range(12))
def test_robust_predicates_are_true_where_the_boolean_ones_are(seed):
    drive = random_drive(seed, ("A", "B"), count=5)
    plain = truth("rssViolation(A, B)", drive)
    assert plain == truth("rssViolation(A, B)", drive, rss_form="robust")
    assert plain == truth("rssViolation(B, A)", drive)


def test_a_scenario_on_a_drive_made_for_it():
    # SV closes in at 8 m/s on POV, 100 m ahead in the same lane: scenario 4, danger at 51.5 m of gap.
    drive = Drive({"SV": motion(0, 3, 30), "POV": motion(100, 3, 22)})
    scenario = bound("scenario_4(SV, POV, L)")
    judgement = judge(scenario, drive)
    assert judgement.holds
    names = {part.name: found for part, found in judgement.named()}
    assert names["scenario_4"].at(Fraction(0))
    assert str(names["aheadOf"]).startswith("[0, 11.9375]")
    assert judge(bound("scenario_4(SV, POV, L) -> dangerArises(SV, POV)"), drive).holds
    assert not judge(bound("scenario_3(SV, POV, L)"), drive).holds
    assert not judge(bound("scenario_4(SV, POV, L)", lane="main-2"), drive).holds
    assert judge(bound("scenario_3(POV, SV, L)"), drive).holds


def test_three_vehicles_are_judged_with_little_work():
    scenario = bound("scenario_2(SV, POV1, POV2, L)")
    calls = []
    for seed in range(5):
        drive = random_drive(seed, ("SV", "POV1", "POV2"))
        calls.append(0)

        def count(frame, event, argument):
            calls[-1] += event == "call"

        sys.setprofile(count)
        try:
            judge(scenario, drive)
        finally:
            sys.setprofile(None)
    assert max(calls) < 100_000  # of functions, in about a tenth of a second


def test_given_truth_sets_come_first_at_any_depth():
    atom = f.Application("danger", ("SV", "POV"), f.TRUE)
    formula = f.Eventually(f.FOREVER, f.And((atom, f.TRUE)))
    assert judge(formula, None, {atom: NEVER}).truth(formula) == NEVER
    assert judge(formula, None, {atom: span(3, 4)}).truth(formula) == span(0, 4)
    assert judge(formula).holds


def test_abstract_signals_are_constant_on_pieces():
    speed = t.Signal("v_lon", "A")
    trace = AbstractSignals({speed: ((Fraction(0), Fraction(3)), (Fraction(2), Fraction(1)))}, {})
    formula = f.Compare(speed, ">", t.number(2))
    assert judge(formula, trace).truth(formula) == span(0, 2, "[)")
    with pytest.raises(UsageError, match="no d of vehicle=A"):
        judge(f.Compare(t.Signal("d", "A"), ">", t.number(2)), trace)


def test_a_judgement_travels_between_processes():
    formula = bound("scenario_4(SV, POV, L)")
    judgement = judge(formula, random_drive(1, ("SV", "POV")))
    assert pickle.loads(pickle.dumps(judgement)) == judgement


def test_parts_that_were_not_judged_are_refused():
    with pytest.raises(UsageError, match="no judged part"):
        judge(f.TRUE).truth(f.FALSE)


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        (f.Occupies("A", "m1"), "bound to a road"),
        (f.Compare(t.Parameter("rho"), ">", t.number(0)), "'rho' has no value"),
        (f.Compare(t.Sum((t.Inverse(t.number(1)), t.number(1))), ">", t.number(0)), "stand alone"),
        (f.Compare(t.Quotient(t.number(1), t.number(0)), ">", t.number(0)), "other than zero"),
        (f.Compare(t.Quotient(t.number(1), t.Signal("s", "A")), ">", t.number(0)), "same at all times"),
        (f.Compare(t.Power(t.Signal("s", "A"), 10**9), ">", t.number(0)), "exponent=1000000000"),
        (f.Compare(t.Power(t.Signal("s", "A"), 20), ">", t.number(0)), "degree="),
        (f.Eventually(f.Interval(t.Parameter("minSafe"), None), f.TRUE), "still holds a parameter"),
        (f.Always(f.Interval(t.number(2), t.number(1)), f.TRUE), "low=2, high=1"),
    ],
)
def test_formulas_that_are_not_bound_are_refused(formula, message):
    with pytest.raises(InputError, match=message):
        judge(formula, alone(v_lon=1, last=(1, 0)))


def test_a_missing_vehicle_is_named():
    with pytest.raises(UsageError, match="vehicle=B, but the drive has A"):
        judge(bound("given A, B: vehicle: s(B) > 0 m"), alone())


def test_holds_is_the_truth_at_the_start():
    early, late = bound("given A: vehicle: v_lon(A) < 1 m/s"), bound("given A: vehicle: v_lon(A) >= 1 m/s")
    faster = alone(v_lon=0, last=(1, 0))
    assert (judge(early, faster).holds, judge(late, faster).holds) == (True, False)


# --- The judge against a reading by definition, on random truth sets and random drives; and mutants

quiet = settings(
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)


def test_operators_on_all_small_truth_sets():
    assert [case for case in every_small_case() if disagreement_on_sets(*case) is not None] == []


@settings(quiet, max_examples=some(120))
@given(opaque_cases())
def test_operators_on_truth_sets(case):
    assert disagreement_on_sets(*case) is None


@settings(quiet, max_examples=some(250))
@given(comparisons, drives)
def test_comparisons_on_drives(comparison, drive):
    found = disagreement_on_drive(comparison, drive)
    assume(found != "doubtful")
    assert found is None


@settings(quiet, max_examples=some(150))
@given(formulas(comparisons, leaves=4), drives)
def test_formulas_on_drives(formula, drive):
    found = disagreement_on_drive(formula, drive)
    assume(found != "doubtful")
    assert found is None


@settings(quiet, max_examples=some(120))
@given(jerk_comparisons, jerk_drives)
def test_comparisons_on_drives_with_jerk(comparison, drive):
    found = disagreement_on_drive(comparison, drive)
    assume(found != "doubtful")
    assert found is None


@settings(quiet, max_examples=60)
@given(formulas(jerk_comparisons, leaves=4), jerk_drives)
def test_formulas_on_drives_with_jerk(formula, drive):
    found = disagreement_on_drive(formula, drive)
    assume(found != "doubtful")
    assert found is None


@pytest.mark.parametrize(("seed", "scenario"), [(0, 1), (2, 4), (3, 5), (4, 8)])
def test_scenarios_on_drives(seed, scenario):
    drive = random_drive(seed, ("SV", "POV"), count=3)
    assert disagreement_on_drive(bound(f"scenario_{scenario}(SV, POV, L)"), drive, epsilon=1e-7) is None


# --- Judges of several formulas on one drive, against the judge of each alone ---------------------

search = settings(quiet, max_examples=2000, database=None, phases=[Phase.generate])
several = st.lists(formulas(jerk_comparisons, leaves=6), min_size=2, max_size=4)


def shared_disagreement(wanted, drive):
    """The first formula that a judge of several says something else of than the judge of it alone."""
    whole, lazy, fresh = DriveJudge.on(drive), LazyJudge.on(drive), LazyJudge.on(drive)
    for formula in wanted:
        alone = judge(formula, drive)
        found = whole.judgement(formula)
        if any(found.truth(part) != alone.truth(part) for part in f.subformulas(formula)):
            return formula
        if {lazy.holds(formula), whole.holds(formula)} != {alone.holds}:
            return formula
        truths = lazy.visit(formula), fresh.visit(formula), LazyJudge(whole.courses, {}).visit(formula)
        if any(truth != alone.truth(formula) for truth in truths):
            return formula
    return None


@settings(quiet, max_examples=some(150))
@given(several, jerk_drives)
def test_parts_that_are_shared_or_left_out_change_no_verdict(wanted, drive):
    assert shared_disagreement(wanted, drive) is None


@pytest.mark.parametrize(
    ("name", "right", "wrong"), read_table(__file__, "faults_of_shared_judging_are_noticed")
)
def test_faults_of_shared_judging_are_noticed(monkeypatch, name, right, wrong):
    owner, _, method = name.partition(".")
    plant(monkeypatch, getattr(judging, owner), method, right, wrong)
    cases = st.tuples(several, jerk_drives)
    assert find(cases, lambda case: shared_disagreement(*case) is not None, settings=search)


# --- The judge of formulas without temporal operators within an interval, against the judge of all formulas

atoms = st.one_of(jerk_comparisons, st.sampled_from([f.Truth(True), f.Truth(False)]))
cases = st.recursive(
    atoms,
    lambda inner: st.one_of(
        inner.map(f.Not),
        st.lists(inner, min_size=2, max_size=3).map(lambda parts: f.And(tuple(parts))),
        st.lists(inner, min_size=2, max_size=3).map(lambda parts: f.Or(tuple(parts))),
    ),
    max_leaves=8,
)
ends = st.tuples(st.integers(0, 8), st.integers(0, 16)).map(
    lambda pair: (Fraction(pair[0], 2), Fraction(pair[0] + pair[1], 2))
)
many = settings(max_examples=some(300), deadline=None, derandomize=True)


def both(formula, drive, pair):
    signals = DriveSignals(drive)
    whole = judge(formula, signals).truth(formula)
    return truth_within(formula, signals, *pair), intersection([whole, interval(*pair)])


@many
@given(cases, jerk_drives, ends)
def test_within_an_interval_it_is_what_the_judge_says(formula, drive, pair):
    found, expected = both(formula, drive, pair)
    assert found == expected


@pytest.mark.parametrize("speed", [5, 20, 36])
@pytest.mark.parametrize("options", [{}, {"cc_gate": "before_delay"}, {"cc_aeb": "max"}])
def test_along_lines_of_driver_models_it_is_what_the_judge_says(options, speed):
    formula = boundary("cut-in", "careful", **options)
    values = CUT_IN.values({"Ve0": Fraction(36), "dV0": Fraction(speed), "Vy": Fraction(1)})
    signals = along_line(CUT_IN, values)
    whole = judge(formula, signals).truth(formula)
    for pair in ((Fraction(0), Fraction(60)), (Fraction(10), Fraction(41, 2))):
        assert truth_within(formula, signals, *pair) == intersection([whole, interval(*pair)])


@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    read_table(__file__, "planted_faults_are_noticed"),
)
def test_planted_faults_are_noticed(monkeypatch, name, right, wrong):
    owner, _, method = name.partition(".")

    def differ(case):
        said, expected = both(*case)
        return said != expected

    home = judging if hasattr(judging, owner) else restricted
    plant(monkeypatch, getattr(home, owner), method, right, wrong)
    assert find(st.tuples(cases, jerk_drives, ends), differ, settings=settings(search, max_examples=400))


def test_temporal_operators_are_refused():
    formula = f.And((f.Truth(True), f.Eventually(f.FOREVER, f.Truth(True))))
    with pytest.raises(InputError, match="without temporal operators"):
        truth_within(formula, along_line(CUT_IN, CUT_IN.values({})), Fraction(0), Fraction(1))
