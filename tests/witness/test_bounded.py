"""Bounded checks: limits are printed, counterexamples are judged, engines agree."""

from dataclasses import replace
from fractions import Fraction

import pytest

from roadproof.effort import Effort
from roadproof.evidence.witness import from_json, judge_file
from roadproof.spec.bind import default_values
from roadproof.spec.library import bundled_library
from roadproof.verdict import Verdict
from roadproof.witness.ask import Request
from roadproof.witness.bounded import check_bounded
from roadproof.witness.question import Means

LIBRARY = bundled_library()
REQUEST = Request("", values=default_values(LIBRARY), horizon=Fraction(6, 5), means=Means(effort=Effort(30)))


def check(claim, engine):
    return check_bounded(replace(REQUEST, what=claim, means=replace(REQUEST.means, engine=engine)))


@pytest.mark.parametrize("engine", ["milp", "smt"])
def test_limits_of_vehicles_bound_what_can_happen(engine):
    # From at most 40 m/s at -6 m/s², 1.2 s later it is at most 40 and at least 15 m/s.
    held = check(
        "F[0, 1.2 s] v_lon(SV) <= 40 m/s and not (v_lon(SV) > 39 m/s and F[1.2 s, 1.2 s] v_lon(SV) < 31 m/s)",
        engine,
    )
    assert held.verdict is Verdict.PROVED_BOUNDED
    assert "main-2" in held.reason
    broken = check("not (v_lon(SV) > 39 m/s and F[1.2 s, 1.2 s] v_lon(SV) < 33 m/s)", engine)
    assert broken.verdict is Verdict.REFUTED
    file = from_json(broken.drive, "drive")
    assert judge_file(file, LIBRARY).accepted


def test_what_holds_for_all_time_is_proved_so():
    assert check("danger(SV,POV) -> F danger(SV,POV)", "milp").verdict is Verdict.PROVED
