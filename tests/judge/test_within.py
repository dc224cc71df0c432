"""The judge of formulas without temporal operators within an interval, against the judge of all formulas."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from judge.cases import jerk_comparisons, jerk_drives
from planting import plant
from preventing.read import boundary
from roadproof.drivers.manoeuvres import CUT_IN, along_line
from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.semantics.exact import within
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.signals import DriveSignals
from roadproof.semantics.exact.truth import intersection, interval
from roadproof.semantics.exact.within import truth_within

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
quiet = settings(max_examples=300, deadline=None, derandomize=True)


def both(formula, drive, pair):
    signals = DriveSignals(drive)
    whole = judge(formula, signals).truth(formula)
    return within.truth_within(formula, signals, *pair), intersection([whole, interval(*pair)])


@quiet
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
    [
        ("_visit", "if kept == NEVER", "if kept != self.within"),
        ("_visit", "if found == self.within", "if found != NEVER"),
        (
            "_visit",
            "intersection([self.within, complement(self.visit(body))])",
            "complement(self.visit(body))",
        ),
        ("_visit", "return self.within if value", "return NEVER if value"),
        ("_visit", "union([found, self.visit(part)])", "self.visit(part)"),
        ("signal", "if x[0] < self.end", "if x[0] < self.end - 1"),
        ("signal", "(self.end, ZERO)", "(self.end - 1, ZERO)"),
    ],
)
def test_planted_faults_are_noticed(monkeypatch, name, right, wrong):
    owner = within._EndedSignals if name == "signal" else within._RestrictedTruth
    found = []

    @settings(max_examples=400, deadline=None, derandomize=True, database=None)
    @given(cases, jerk_drives, ends)
    def look(formula, drive, pair):
        said, expected = both(formula, drive, pair)
        if said != expected:
            found.append(formula)

    plant(monkeypatch, owner, name, right, wrong)
    look()
    assert found


def test_temporal_operators_are_refused():
    formula = f.And((f.Truth(True), f.Eventually(f.FOREVER, f.Truth(True))))
    with pytest.raises(InputError, match="without temporal operators"):
        truth_within(formula, along_line(CUT_IN, CUT_IN.values({})), Fraction(0), Fraction(1))
