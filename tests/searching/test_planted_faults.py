"""Deliberate faults in what makes a no of a search: each lets a drive be denied that is known."""

from dataclasses import replace
from fractions import Fraction

import pytest

from asking import posed, search_for
from planting import plant
from roadproof.engines.encode import build
from roadproof.engines.search import bounded, search
from roadproof.engines.search.ask import Outcome
from roadproof.engines.search.impossible import Impossibility
from roadproof.engines.search.question import SearchOptions
from roadproof.engines.solve import bounds
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

SHORT = {"horizon": Fraction(9, 5)}

# Questions that have drives, each of them out of reach of a fault below.
DRIVES = {
    "in the second lane": "d(SV) > 6 m and atLane(SV, L)",
    "a square": "v_lon(SV)^2 = 900 * 1 m/s * 1 m/s",
    "at the limits": "v_lon(SV) >= 40 m/s and v_lat(SV) >= 2 m/s and d(SV) <= 1.8 m",
    "as far as the reach": "s(POV) - s(SV) >= 80 m",
    "elsewhere": "s(SV) = 30 m",
    "before the zone": "not inMergeZone(SV) and F inMergeZone(SV)",
    "gone again": "F[1.8 s, 1.8 s] s(SV) < 30 m and s(SV) > 0 m",
    "bumper to bumper": "s(POV) - s(SV) = 4.5 m and d(SV) = d(POV)",
    "through between samples": "s(POV) > s(SV) and d(POV) = d(SV) and F[0.6 s, 0.6 s] s(POV) < rear(SV)",
    "full throttle": "F[1.2 s, 1.2 s] a_lon(SV) = 3 m/s^2 and a_lat(SV) >= 1.5 m/s^2",
    "on the lane that ends": "G[0, 1.8 s] d(SV) < 0 m and atLane(SV, L) and inMergeZone(SV)",
}


def denied(search_options=None):
    """The drives that are denied."""
    found = []
    for name, what in DRIVES.items():
        asked = posed(search_for(what, **SHORT))
        if (
            search.show_none(asked, search_options or SearchOptions(effort=Effort(30))).verdict
            is Verdict.NONE_WITHIN
        ):
            found.append(name)
    return found


def test_drives_are_not_denied_without_a_fault():
    assert denied() == []
    assert denied(SearchOptions(engine="smt", effort=Effort(30))) == []


FAULTS = {
    "the first lane assignment only": (
        *(search._Search, "none", "in self.question.lanes:", "in self.question.lanes[:1]:"),
        "in the second lane",
    ),
    "one lane assignment without a drive will do": (
        *(search._Search, "none", "how.add(by)", "how.add(by); break"),
        "in the second lane",
    ),
    "the inner approximation": (search._Search, "_refute", '"outer"', '"inner"', "a square"),
    "natural drives only": (build.Assumptions, "loosest", "self.plain()", "self", "full throttle"),
    "limits are kept by a margin": (
        *(build.Assumptions, "loosest", "inside=Fraction(0)", "inside=Fraction(1, 100)"),
        "full throttle",
    ),
    "between the samples, too": (
        *(build.Assumptions, "loosest", "between=False", "between=True"),
        "through between samples",
    ),
    "settled by the last sample": (
        build.Assumptions,
        "loosest",
        "lasting=False",
        "lasting=True",
        "gone again",
    ),
    "lanes that end are no road": (
        *(build, "stay_on_road", "[(spell, allowed)", "[(spell, endless)"),
        "on the lane that ends",
    ),
    "the first vehicle starts at 0": (
        *(search._Search, "none", "starts=self.question.starts", "starts=None"),
        "elsewhere",
    ),
    "the reach is open": (
        *(
            build,
            "_motions",
            "(-assumptions.reach, assumptions.reach)",
            "(1 - assumptions.reach, assumptions.reach - 1)",
        ),
        "as far as the reach",
    ),
    "bounds are not loosened": (
        *(bounds, "_leaf", "Bound(affine, -slack)", "Bound(affine, 3 * slack)"),
        "at the limits",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_that_denies_a_drive_is_caught(fault, monkeypatch):
    owner, name, right, wrong, missed = FAULTS[fault]
    plant(monkeypatch, owner, name, right, wrong)
    assert missed in denied()


def outcome(verdict, **changes):
    return Outcome(None, "base", search_for("true").query, "main-2", verdict, "why", **changes)


ANSWERS = {
    "a drive": (replace(outcome(Verdict.WITNESSED), drives=({"drive": 1},)), Verdict.REFUTED),
    "a proof": (outcome(Verdict.IMPOSSIBLE, impossibility=Impossibility((), True, {})), Verdict.PROVED),
    "none": (outcome(Verdict.NONE_WITHIN, limits=posed(search_for("s(SV) > 0 m", **SHORT)).limits()), None),
    "in doubt": (outcome(Verdict.UNKNOWN), Verdict.UNKNOWN),
}


def answered(monkeypatch):
    """What is said of a claim for each answer to its negation."""
    said = {}
    for name, (answer, _) in ANSWERS.items():
        monkeypatch.setattr(bounded, "ask", lambda request, answer=answer: answer)
        said[name] = bounded.check_bounded(search_for("true", **SHORT)).verdict
    return said


EXPECTED = {name: verdict or Verdict.PROVED_BOUNDED for name, (_, verdict) in ANSWERS.items()}


def test_only_a_none_within_makes_a_claim_proved_bounded(monkeypatch):
    assert answered(monkeypatch) == EXPECTED


def test_a_doubt_taken_for_a_bounded_proof_is_caught(monkeypatch):
    right, wrong = "BoundedResult(Verdict.UNKNOWN", "BoundedResult(Verdict.PROVED_BOUNDED"
    plant(monkeypatch, bounded, "check_bounded", right, wrong)
    assert answered(monkeypatch) != EXPECTED


DOUBTS = {
    "an answer that did not come": (search._Search, "none", "if not by:", "if False:"),
    "a solver that gave up": (
        search._Search,
        "_refute",
        'exact.status == "infeasible"',
        'exact.status != "found"',
    ),
    "a relaxation that was not decided": (
        *(search._Search, "_refute", 'relaxed.status == "infeasible"', 'relaxed.status != "found"'),
    ),
    "a drive that the judge refuses": (
        *(search._Search, "none", "Verdict.UNKNOWN, None, complaint", "Verdict.NONE_WITHIN, None, complaint"),
    ),
}


def doubted(monkeypatch):
    """The verdicts where solvers give up, and where the judge refuses what they found."""
    asked = posed(search_for("s(SV) = 30 m", **SHORT))
    said = set()
    with monkeypatch.context() as solvers:
        solvers.setattr(search, "solve_mixed", lambda *_, **__: search.Solution("unknown"))
        solvers.setattr(search, "solve_exactly", lambda *_, **__: search.Solution("unknown"))
        said.add(search.show_none(asked, SearchOptions(effort=Effort(30))).verdict)
    with monkeypatch.context() as refusing:
        refusing.setattr(search._Search, "_complaint", lambda *_: "no")
        said.add(search.show_none(asked, SearchOptions(effort=Effort(30))).verdict)
    return said


def test_doubts_stay_doubts(monkeypatch):
    assert doubted(monkeypatch) == {Verdict.UNKNOWN}


@pytest.mark.parametrize("fault", DOUBTS)
def test_a_doubt_taken_for_a_no_is_caught(fault, monkeypatch):
    plant(monkeypatch, *DOUBTS[fault])
    assert doubted(monkeypatch) != {Verdict.UNKNOWN}
