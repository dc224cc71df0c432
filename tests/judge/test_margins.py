"""Robustness over time on drives: exact pieces by definition, samples as the drive from each of them on."""

from dataclasses import replace
from fractions import Fraction
from math import inf

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from judge.cases import comparisons, drives, formulas, jerk_drives, operators
from judge.test_exact import alone, motion, truth
from judge.test_robust import HALF, SECOND, Naive, forget, quiet, terms
from planting import plant
from roadproof.errors import InputError, UsageError
from roadproof.extensions.traffic.evaluate import margin_signal
from roadproof.extensions.traffic.evaluate.margin_signal import RobustnessSignal
from roadproof.extensions.traffic.evaluate.observed import observe_drive
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.semantics.exact import margins
from roadproof.semantics.exact.algebraic import bounds
from roadproof.semantics.exact.judging import judge
from roadproof.world.drive import Drive
from roadproof.world.motion import piece_starts, state_at

SEVENTH = Fraction(1, 7)
polynomials = st.builds(f.Compare, terms, operators, terms)
states = st.recursive(
    st.one_of(polynomials, comparisons, st.sampled_from([f.TRUE, f.FALSE])),
    lambda inner: st.one_of(
        inner.map(f.Not),
        st.lists(inner, min_size=2, max_size=3).map(lambda x: f.And(tuple(x))),
        st.lists(inner, min_size=2, max_size=3).map(lambda x: f.Or(tuple(x))),
        inner.map(lambda x: f.Application("p", (), x)),
    ),
    max_leaves=5,
)


class NaiveStates(Naive):
    """Margins of state formulas by definition, with constants and names."""

    def margin(self, formula, k):
        match formula:
            case f.Truth(value):
                return inf if value else -inf
            case f.Application(_, _, body):
                return self.margin(body, k)
            case f.And(parts):
                return min(self.margin(x, k) for x in parts)
            case f.Or(parts):
                return max(self.margin(x, k) for x in parts)
            case f.Not(body):
                return -self.margin(body, k)
        return super().margin(formula, k)


def signal_of(formula, drive, horizon=4 * SECOND, dt=HALF):
    return margin_signal.drive_signal(judge(formula, drive), drive, horizon, dt)


def advanced(drive, time):
    """The drive from a time on."""
    vehicles = {}
    for name, old in drive.vehicles.items():
        now, starts = state_at(old, time), piece_starts(old)
        number = max(k for k, x in enumerate(starts) if x.time <= time)
        piece = old.pieces[number]
        gone = time - starts[number].time
        rest = None if piece.duration is None else piece.duration - gone
        first = replace(piece, duration=rest, a_lon=now.a_lon)
        pieces = (first, *old.pieces[number + 1 :])
        vehicles[name] = replace(old, s=now.s, d=now.d, v_lon=now.v_lon, v_lat=now.v_lat, pieces=pieces)
    return Drive(vehicles)


def times_near_switches(formula, drive):
    """Many times, with some close to each switch of truth."""
    cuts = judge(formula, drive).truth(formula).cuts
    near = [x for cut in cuts for x in bounds(cut.point, Fraction(1, 10**9))]
    knots = [x.time for each in drive.vehicles.values() for x in piece_starts(each)]
    return {*(SEVENTH * k for k in range(30)), *(x for x in near if x >= 0), *knots}


def faults_of_pieces(formula, drive):
    """Where exact pieces and the definition part: values, signs, least value."""
    found, judged = signal_of(formula, drive), judge(formula, drive).truth(formula)
    if found.exact is None:
        return
    naive, values = NaiveStates(drive, SEVENTH, 0), {}
    for time in times_near_switches(formula, drive):
        naive.dt = time
        values[time] = found.at(time)[0]
        expected = naive.margin(formula, 1)
        if values[time] != pytest.approx(expected, rel=1e-9, abs=1e-9):
            yield f"{values[time]} for {expected} at {time}"
        if values[time] and judged.at(time) != (values[time] > 0):
            yield f"sign at {time}"
        inside = [x.at(time) for x in found.sign_sets()]
        if sum(inside) != 1 or (inside[0] and not judged.at(time)) or (inside[1] and judged.at(time)):
            yield f"sign sets at {time}"
    if found.pieces:
        least = found.least()
        within = [x for time, x in values.items() if time <= found.horizon]
        if least.value > min(within) + 1e-9:
            yield f"least {least} of {min(within)}"
        if least.attained:
            there = found.at(Fraction(least.time))[0]
            if there != pytest.approx(least.value, rel=1e-6, abs=1e-6):
                yield f"least {least}, but {there}"


@settings(quiet, max_examples=150)
@given(states, st.one_of(drives, jerk_drives))
def test_pieces_are_what_the_definition_says(formula, drive):
    assert list(faults_of_pieces(formula, drive)) == []


def faults_of_samples(formula, drive, horizon=2 * SECOND):
    """Where the value at a sample is not that of the drive which starts there, or has another sign."""
    found = signal_of(formula, drive, horizon)
    for k, low in enumerate(found.low):
        later = advanced(drive, k * HALF)
        seen = observe_drive("it", formula, later, horizon - k * HALF, HALF)
        if seen.margin != (low, found.high[k]) or found.at(k * HALF)[0] != pytest.approx(low, rel=1e-9):
            yield f"{low} at sample {k} for {seen.margin}"
        if found.truths[k] != seen.verdict or (low and (low > 0) != (seen.verdict == "true")):
            yield f"{found.truths[k]} and {low} at sample {k} for {seen.verdict}"


@settings(quiet, max_examples=60)
@given(formulas(comparisons, leaves=3).filter(lambda x: not f.looks_back(x)), drives)
def test_each_sample_has_the_robustness_of_the_drive_that_starts_there(formula, drive):
    assert list(faults_of_samples(formula, drive)) == []


def test_temporal_operators_and_inverses_are_refused_between_samples():
    fast = f.Compare(t.Signal("v_lon", "A"), ">=", t.number(1))
    near = f.Compare(t.Inverse(t.Signal("s", "A")), ">=", t.number(1))
    for formula, reason in ((f.Eventually(f.FOREVER, fast), "temporal operators"), (near, "inverse")):
        found = signal_of(formula, alone(v_lon=2))
        assert (found.exact, found.pieces, reason in found.sampled) == (None, (), True)
        assert reason in str(found)
        assert found.at(HALF) == found.at(0.5) == found.at("500 ms")
        with pytest.raises(InputError, match="time=soon: this is no value"):
            found.at("soon")
        with pytest.raises(UsageError, match="between two samples"):
            found.at(SEVENTH)
        with pytest.raises(UsageError, match="outside the trace"):
            found.at(5 * SECOND)
    with pytest.raises(InputError, match="bound to a road"):
        signal_of(f.Occupies("A", "m1"), alone())


def test_pieces_begin_where_parts_cross():
    """s = t²/2 and 3 - t cross at √7 - 1; the least of both turns there."""
    drive = alone(last=(1, 0))
    rising = f.Compare(t.Signal("s", "A"), ">=", t.number(0))
    falling = f.Compare(t.Signal("v_lon", "A"), "<=", t.number(3))
    found = signal_of(f.And((rising, falling)), drive)
    assert [str(p.coefficients) for _, p in found.pieces] == [
        "(Fraction(0, 1), Fraction(0, 1), Fraction(1, 2))",
        "(Fraction(3, 1), Fraction(-1, 1))",
    ]
    assert float(bounds(found.pieces[1][0], SEVENTH**20)[0]) == pytest.approx(7**0.5 - 1)
    assert str(found).splitlines() == [
        "robustness over time, exact, in 2 pieces:",
        "  least    -1 at 4 s, up to 4 s",
        "  above 0  (0, 3)",
        "  below 0  (3, ∞)",
        "  0        {0} ∪ {3}",
    ]
    assert truth("s(A) >= 0 m and v_lon(A) <= 3 m/s", drive).at(Fraction(3))
    assert found.at(10**6 * SECOND) == (3 - 10**6, 3 - 10**6)


def test_a_least_value_may_be_approached_alone():
    """a_lon is 1 + 2t before 1 s, and 5 from then on; its negative comes near -3."""
    jump = Drive({"A": motion(pieces=[(1, 1, 0, 2)], last=(0, 0))})
    found = signal_of(f.Compare(t.Signal("a_lon", "A"), "<=", t.number(2)), jump)
    assert "least    -1 just before 1 s" in str(found)
    assert not found.least().attained
    smooth = signal_of(f.Compare(t.Signal("v_lon", "A"), "<=", t.number(2)), jump)
    assert smooth.least() == margins.LeastValue(0.0, 1.0)


def test_a_constant_is_infinite_at_every_instant():
    found = signal_of(f.Not(f.TRUE), alone())
    assert (found.at(SEVENTH), found.pieces, found.least()) == ((-inf, -inf), (), None)
    assert "no finite value" in str(found)


FAST, SLOW = (f.Compare(t.Signal("v_lon", "A"), op, t.number(2)) for op in (">=", "<"))
PLACE = f.Compare(t.Signal("s", "A"), ">", t.number(1))
WEAK = f.Compare(t.Signal("a_lon", "A"), "<=", t.number(2))
TURNING = Drive({"A": motion(0, 0, 4, pieces=[(1, -4, 0, 1), (2, 1, 0)], last=(-1, 0))})
JUMP = Drive({"A": motion(pieces=[(1, 1, 0, 2)])})
BACK = Drive({"A": motion(v_lon=-2, last=(2, 0))})
CASES = (
    (f.And((FAST, PLACE)), TURNING),
    (f.Or((SLOW, f.Not(PLACE))), TURNING),
    (f.And((FAST, f.TRUE)), TURNING),
    (f.Or((f.TRUE, SLOW)), TURNING),
    (WEAK, TURNING),
    (WEAK, JUMP),
    (PLACE, BACK),
)
SAMPLED = (f.Until(f.Not(PLACE), f.FOREVER, PLACE), f.Eventually(f.FOREVER, FAST))


def noticed():
    """Whether pieces or samples are not what they should be."""
    forget()
    wrong = [x for case in CASES for x in faults_of_pieces(*case)]
    wrong += [x for formula in SAMPLED for x in faults_of_samples(formula, TURNING)]
    return bool(wrong) or signal_of(WEAK, JUMP).least() != margins.LeastValue(-1.0, 1.0, attained=False)


def test_without_faults_nothing_is_noticed():
    assert not noticed()


@pytest.mark.parametrize(
    ("owner", "name", "right", "wrong"),
    [
        (margins, "_difference", 'in (">", ">=")', 'in (">",)'),
        (margins, "_fold", "piecewise.least if universal", "piecewise.greatest if universal"),
        (margins, "_fold", "return not universal", "return universal"),
        (margins, "state_margin", "piecewise.apply(negate, inner)", "inner"),
        (margins, "_candidates", "if start < turn < end", "if False"),
        (margins, "_candidates", "not _meet(p, following[1], end)", "False"),
        (margins, "_candidates", "        if last:", "        if True:"),
        (margins, "_value", "value * middle + n", "value * middle - n"),
        (margin_signal, "value_at", "reversed(pieces)", "pieces"),
        (margin_signal, "drive_signal", "if exact is None", "if False"),
        (margin_signal, "drive_signal", "truth.at(k * dt)", "truth.at(0 * dt)"),
        (RobustnessSignal, "sign_sets", "(POSITIVE, NEGATIVE,", "(NEGATIVE, POSITIVE,"),
    ],
)  # fmt: skip
def test_planted_faults_are_noticed(monkeypatch, owner, name, right, wrong):
    plant(monkeypatch, owner, name, right, wrong)
    assert noticed()


@settings(quiet, max_examples=40)
@given(polynomials, drives)
def test_rows_and_data_have_a_value_for_each_sample(formula, drive):
    found = signal_of(formula, drive, 3 * SECOND)
    assume(found.pieces)
    assert [x["time"] for x in found.rows()] == [0, 0.5, 1, 1.5, 2, 2.5, 3]
    assert found.signs() == tuple((x > 0) - (x < 0) for x in found.low)
