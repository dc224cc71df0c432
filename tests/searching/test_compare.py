"""Which of two formulas implies the other: a proof or a drive for each direction."""

from fractions import Fraction

import pytest

from asking import search_for
from roadproof.engines.search import compare as compare_module
from roadproof.engines.search.compare import compare
from roadproof.engines.search.question import SearchOptions
from roadproof.evidence.judged import judge_file
from roadproof.library.compose import taken_from
from roadproof.library.loading import bundled_library
from roadproof.library.scenario_references import read_query
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.verdict import Verdict

LIBRARY = bundled_library()
MEANS = SearchOptions(effort=Effort(30))
FAST, FASTER = "v_lon(SV) > 20 m/s", "v_lon(SV) > 30 m/s"


def compared(first, second, set_name="base"):
    search = search_for(first, search_options=MEANS, horizon=Fraction(6, 5))
    _, other = read_query(LIBRARY.select(set_name), second)
    return compare(search, taken_from(search.specification, other, set_name))


@pytest.mark.parametrize(
    ("first", "second", "relation"),
    [
        (FASTER, FAST, "stronger"),
        (FAST, FASTER, "weaker"),
        (FAST, f"not not {FAST}", "equivalent"),
        (FAST, "v_lon(SV) < 25 m/s", "incomparable"),
    ],
)
def test_relations_and_their_evidence(first, second, relation):
    found = compared(first, second)
    assert found.relation == relation
    for direction in (found.forward, found.backward):
        if direction.verdict is Verdict.PROVED:
            assert direction.certificate.claim == direction.claim.text
            assert direction.drive is None
        else:
            assert direction.verdict is Verdict.REFUTED
            assert direction.certificate is None
            assert judge_file(direction.drive.file, LIBRARY).accepted


def test_what_is_proved_only_where_no_drive_is_found_is_bounded():
    found = compared("v_lon(SV) <= 40 m/s", "F[0, 1.2 s] v_lon(SV) <= 41 m/s")
    assert found.forward.verdict is Verdict.PROVED
    assert found.backward.verdict is Verdict.PROVED_BOUNDED
    assert found.relation == "unknown"


def test_what_the_clock_cuts_off_is_unknown(monkeypatch):
    def late(*_):
        raise BudgetExceeded(7.0)

    monkeypatch.setattr(compare_module, "_decide", late)
    found = compared(FAST, FASTER)
    assert found.forward.verdict is found.backward.verdict is Verdict.UNKNOWN
    assert "after 7 s" in found.forward.reason
    assert found.relation == "unknown"


def test_the_second_formula_may_be_of_another_set():
    found = compared("4", "4", "extA")
    assert (found.first.text, found.second.text) == ("scenario_4(SV, POV, L)", "scenario_4@extA(SV, POV, L)")
    assert found.backward.claim.text == f"{found.second.text} -> {found.first.text}"
