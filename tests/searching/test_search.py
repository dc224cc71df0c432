"""What a search tries and what it says where it found nothing; no solver is asked."""

from fractions import Fraction

import pytest

from asking import posed, search_for
from roadproof.engines.search import search
from roadproof.engines.search.question import SearchOptions
from roadproof.engines.search.search import find_witness, show_none
from roadproof.verdict import Verdict


def question(what, **changes):
    return posed(search_for(what, **changes))


def tried(monkeypatch, doubt, refinements):
    """The steps of the grids that are tried, in order, where every attempt ends in ``doubt``."""
    steps = []

    def attempt(self, lanes, grid, assumptions):
        steps.append(grid.dt)
        self.doubt = doubt

    monkeypatch.setattr(search._Search, "_attempt", attempt)
    search_options = SearchOptions(refinements=refinements, explain=False)
    answer = find_witness(question("v_lon(SV) > 20 m/s", natural=False), search_options)
    assert answer.verdict is Verdict.UNKNOWN
    assert answer.reason == (doubt or "none was found")
    return steps


def test_finer_grids_are_tried_where_there_is_a_doubt(monkeypatch):
    dt = Fraction(3, 5)
    assert tried(monkeypatch, "it fails between the samples", 2) == [dt, dt / 2, dt / 4]
    assert tried(monkeypatch, "it fails between the samples", 0) == [dt]
    assert tried(monkeypatch, "", 2) == [dt]


@pytest.mark.parametrize(("what", "shown"), [("v_lon(SV) > 20 m/s", "main-2"), ("atLane(SV, L)", "L=main-1")])
def test_where_nothing_was_found_it_says_where(what, shown, monkeypatch):
    monkeypatch.setattr(search._Search, "_refute", lambda self, problem: ("", None))
    answer = show_none(question(what, horizon=Fraction(6, 5)), SearchOptions())
    assert answer.verdict is Verdict.UNKNOWN
    assert answer.reason.endswith(f"with the work given for {shown}")
