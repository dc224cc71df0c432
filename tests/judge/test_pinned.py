"""The judge against a reading by definition, on random truth sets and random drives; and mutants."""

import pytest
from hypothesis import HealthCheck, assume, given, settings

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
from judge.test_exact import bound, random_drive

quiet = settings(
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)


def test_operators_on_all_small_truth_sets():
    assert [case for case in every_small_case() if disagreement_on_sets(*case) is not None] == []


@settings(quiet, max_examples=120)
@given(opaque_cases())
def test_operators_on_truth_sets(case):
    assert disagreement_on_sets(*case) is None


@settings(quiet, max_examples=250)
@given(comparisons, drives)
def test_comparisons_on_drives(comparison, drive):
    found = disagreement_on_drive(comparison, drive)
    assume(found != "doubtful")
    assert found is None


@settings(quiet, max_examples=150)
@given(formulas(comparisons, leaves=4), drives)
def test_formulas_on_drives(formula, drive):
    found = disagreement_on_drive(formula, drive)
    assume(found != "doubtful")
    assert found is None


@settings(quiet, max_examples=120)
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
