"""Deliberate faults in what makes a no of a search: each lets a drive be denied that is known."""

from dataclasses import replace
from fractions import Fraction

import pytest

from engine_calls import search_for, search_problem
from planting import plant
from roadproof.engines.encode import build
from roadproof.engines.search import bounded, search
from roadproof.engines.search.impossible import Impossibility
from roadproof.engines.search.outcome import SearchOutcome
from roadproof.engines.setting import SearchOptions
from roadproof.engines.solve import bounds
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict
from tables import read_table

SHORT = {"horizon": Fraction(9, 5)}

# Questions that have drives, each of them out of reach of a fault below.
DRIVES = read_table(__file__, "drives")


def denied(search_options=None):
    """The drives that are denied."""
    found = []
    for name, what in DRIVES.items():
        asked = search_problem(search_for(what, **SHORT))
        if (
            search.show_none(asked, search_options or SearchOptions(effort=Effort(30))).verdict
            is Verdict.NONE_WITHIN
        ):
            found.append(name)
    return found


def test_drives_are_not_denied_without_a_fault():
    assert denied() == []
    assert denied(SearchOptions(engine="smt", effort=Effort(30))) == []


OWNERS = {
    "_GridSearch": search._GridSearch,
    "Assumptions": build.Assumptions,
    "build": build,
    "bounds": bounds,
}
FAULTS = read_table(__file__, "faults")


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_that_denies_a_drive_is_caught(fault, monkeypatch):
    owner, name, right, wrong, missed = FAULTS[fault]
    plant(monkeypatch, OWNERS[owner], name, right, wrong)
    assert missed in denied()


def outcome(verdict, **changes):
    return SearchOutcome(None, "base", search_for("true").query, "main-2", verdict, "why", **changes)


ANSWERS = {
    "a drive": (replace(outcome(Verdict.WITNESSED), drives=({"drive": 1},)), Verdict.REFUTED),
    "a proof": (outcome(Verdict.IMPOSSIBLE, impossibility=Impossibility((), True, {}, {})), Verdict.PROVED),
    "none": (
        outcome(Verdict.NONE_WITHIN, limits=search_problem(search_for("s(SV) > 0 m", **SHORT)).limits()),
        None,
    ),
    "in doubt": (outcome(Verdict.UNKNOWN), Verdict.UNKNOWN),
}


def answered(monkeypatch):
    """What is said of a claim for each answer to its negation."""
    said = {}
    for name, (answer, _) in ANSWERS.items():
        monkeypatch.setattr(bounded, "search_drive", lambda request, answer=answer: answer)
        monkeypatch.setattr(bounded, "falsifying_drive", lambda *_: None)
        said[name] = bounded.check_bounded(search_for("v_lon(SV) >= 0 m/s", **SHORT)).verdict
    return said


EXPECTED = {name: verdict or Verdict.PROVED_BOUNDED for name, (_, verdict) in ANSWERS.items()}


def test_only_a_none_within_makes_a_claim_proved_bounded(monkeypatch):
    assert answered(monkeypatch) == EXPECTED


def test_a_doubt_taken_for_a_bounded_proof_is_caught(monkeypatch):
    right, wrong = "BoundedResult(verdict=Verdict.UNKNOWN", "BoundedResult(verdict=Verdict.PROVED_BOUNDED"
    plant(monkeypatch, bounded, "check_bounded", right, wrong)
    assert answered(monkeypatch) != EXPECTED


DOUBTS = {
    "an answer that did not come": (search._GridSearch, "none", "if not by:", "if False:"),
    "a solver that gave up": (
        search._GridSearch,
        "_refute",
        'exact.status == "infeasible"',
        'exact.status != "found"',
    ),
    "a relaxation that was not decided": (
        *(search._GridSearch, "_refute", 'relaxed.status == "infeasible"', 'relaxed.status != "found"'),
    ),
    "a drive that the judge refuses": (
        *(
            search._GridSearch,
            "none",
            "Verdict.UNKNOWN, None, complaint",
            "Verdict.NONE_WITHIN, None, complaint",
        ),
    ),
}


def doubted(monkeypatch):
    """The verdicts where solvers give up, and where the judge refuses what they found."""
    asked = search_problem(search_for("s(SV) = 30 m", **SHORT))
    said = set()
    with monkeypatch.context() as solvers:
        solvers.setattr(search, "solve_mixed", lambda *_, **__: search.ColumnValues("unknown"))
        solvers.setattr(search, "solve_exactly", lambda *_, **__: search.ColumnValues("unknown"))
        said.add(search.show_none(asked, SearchOptions(effort=Effort(30))).verdict)
    with monkeypatch.context() as refusing:
        refusing.setattr(search, "complaint_about", lambda *_: "no")
        said.add(search.show_none(asked, SearchOptions(effort=Effort(30))).verdict)
    return said


def test_doubts_stay_doubts(monkeypatch):
    assert doubted(monkeypatch) == {Verdict.UNKNOWN}


@pytest.mark.parametrize("fault", DOUBTS)
def test_a_doubt_taken_for_a_no_is_caught(fault, monkeypatch):
    plant(monkeypatch, *DOUBTS[fault])
    assert doubted(monkeypatch) != {Verdict.UNKNOWN}
