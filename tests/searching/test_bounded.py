"""Bounded checks: limits are printed, counterexamples are judged, engines agree."""

from fractions import Fraction

import pytest

from asking import search_for
from roadproof.engines.search.bounded import check_bounded
from roadproof.engines.search.question import SearchOptions
from roadproof.evidence.judged import judge_file
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

LIBRARY = bundled_library()


def check(claim, engine):
    search_options = SearchOptions(engine=engine, effort=Effort(30))
    return check_bounded(search_for(claim, search_options=search_options, horizon=Fraction(6, 5)))


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
    assert judge_file(broken.drive.file, LIBRARY).accepted


def test_what_holds_for_all_time_is_proved_so():
    assert check("danger(SV,POV) -> F danger(SV,POV)", "milp").verdict is Verdict.PROVED
