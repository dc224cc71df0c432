"""Parts of scenarios that could be left out: known answers, and the evidence behind them."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from roadproof.analysis.redundancy import Change, ChangeFinding, SharedFindings, _ExaminationJobs, changes_of

from judge.cases import drives
from roadproof.analysis import redundancy
from roadproof.analysis.basis import Basis
from roadproof.engines.search.ask import ask as ask_for_drive
from roadproof.engines.search.outcome import Outcome, Search
from roadproof.engines.solve.smt import ask as ask_solver
from roadproof.evidence.certificate import refusal
from roadproof.evidence.judged import judge_file
from roadproof.frontends.cli.main import main
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario, without_sectors
from roadproof.library.specification import Query, Specification
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.exact import judge
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.models import load_road

BASE = bundled_library().select("base")


# --- Redundancy: known answers on small formulas and on the paper's, and the evidence behind them ---

BASIS = Basis(BASE, effort=Effort(30))


def changes(text: str, whole: bool = False) -> list[Change]:
    return list(changes_of(BASE, read_claim(BASE, text), whole))


def test_every_occurrence_is_changed_to_both_values() -> None:
    found = changes("laneKeep(SV,L) U not aheadOf(SV,POV)")
    texts = {x.changed.text for x in found}
    assert texts == {
        "true U not aheadOf(SV, POV)",
        "false U not aheadOf(SV, POV)",
        "laneKeep(SV, L) U true",
        "laneKeep(SV, L) U false",
        "laneKeep(SV, L) U not true",
        "laneKeep(SV, L) U not false",
    }
    weaker = {x.changed.text for x in found if x.weakens}
    assert weaker == {
        "true U not aheadOf(SV, POV)",
        "laneKeep(SV, L) U true",
        "laneKeep(SV, L) U not false",
    }


def test_simple_predicates_are_opened_only_when_asked() -> None:
    assert changes("aheadOf(SV,POV)") == []
    assert changes("F initialCondition_1(SV,POV,L)") == []
    assert len(changes("rssViolation(SV,POV)")) == 0
    assert len(changes("rssViolation(SV,POV)", whole=True)) > 10
    assert len(changes("F rssViolation(SV,POV)")) == 2


def decide(number: int, part: str, value: bool) -> ChangeFinding:
    """The finding on the first change of ``part`` in a scenario of base."""
    examining = _ExaminationJobs(BASIS, Scenario(number, "base"))
    found = changes_of(BASE, examining.query)
    change = next(x for x in found if x.part == part and x.value is value)
    return examining._decide(change)


def test_adjacent_lanes_are_redundant_in_scenario_3() -> None:
    part = "atLane(SV, L) and (some M in adjacentLanes(L): atLane(POV, M))"
    finding = decide(3, part, False)
    assert finding.verdict is Verdict.PROVED
    assert finding.certificate is not None
    assert finding.certificate.claim.startswith("scenario_3(SV, POV, L) <-> ")
    assert refusal(finding.certificate, bundled_library(), ask_solver) is None


def test_what_a_scenario_needs_is_shown_by_a_drive() -> None:
    found = [x for x in changes("scenario_8(SV,POV,L)") if x.part == "aheadOf(SV, POV)" and not x.value]
    examining = _ExaminationJobs(BASIS, Scenario(8, "base"))
    examining._collect()
    finding = examining._decide(found[0])
    assert finding.verdict is Verdict.REFUTED
    assert finding.drive is not None
    assert finding.drive.file.formula == f"scenario_8(SV, POV, L) and not ({found[0].changed.text})"
    assert judge_file(finding.drive.file, bundled_library()).accepted


@pytest.fixture
def few_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the changes of one part of scenarios 3 and 11, so that a run takes seconds."""

    def few(home: Specification, query: Query, whole: bool = False, stated: bool = False) -> Iterator[Change]:
        changes = changes_of(home, query, whole, stated)
        yield from (x for x in changes if x.part.startswith(("sameLane", "aheadOf")))

    monkeypatch.setattr(redundancy, "changes_of", few)


def test_scenarios_that_differ_in_their_road_only_share_drives(
    few_changes: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    searched: list[str] = []

    def counted(search: Search) -> Outcome:
        searched.append(search.query.text)
        return ask_for_drive(search)

    monkeypatch.setattr(redundancy, "ask", counted)
    out = tmp_path / "out"
    line = ["redundancy", "--among", "3,11", "--out", str(out), "--jobs", "1", "--json", "-"]
    assert main(line) == 0
    whole = json.loads(capsys.readouterr().out)["verdicts"]
    assert [x["redundant"] for x in whole if x["scenario"] == 3] == [
        x["redundant"] for x in whole if x["scenario"] == 11
    ]
    assert searched
    assert not any("scenario_11" in x for x in searched)
    assert main(["check", str(out), "--jobs", "1"]) == 0
    capsys.readouterr()

    (out / "answers/scenario-11.json").unlink()
    searched.clear()
    assert main(line) == 0
    assert json.loads(capsys.readouterr().out)["verdicts"] == whole
    assert not searched


def test_what_was_looked_for_in_vain_is_not_looked_for_again(monkeypatch: pytest.MonkeyPatch) -> None:
    (change,) = (x for x in changes("scenario_3(SV,POV,L)") if x.part == "aheadOf(POV, SV)" and not x.value)
    learned = SharedFindings(vain=frozenset({without_sectors(change.changed.formula)}))
    monkeypatch.setattr(redundancy, "ask", lambda request: pytest.fail("searched again"))
    (twin,) = (x for x in changes("scenario_11(SV,POV,L)") if x.part == "aheadOf(POV, SV)" and not x.value)
    finding = _ExaminationJobs(BASIS, Scenario(11, "base"), learned)._decide(twin)
    assert finding.verdict is Verdict.REFUTED
    assert finding.trace is not None
    assert "another road" in finding.reason


def test_what_motion_makes_redundant_is_proved_for_motion() -> None:
    """SV need not be asked to keep its lane until it or POV1 has left it: one of them leaves first."""
    part = "laneKeep(SV, L) U not sameLane(SV, POV1, L)"
    (change,) = (x for x in changes("scenario_2(SV,POV1,POV2,L)") if x.part == part and x.value)
    finding = _ExaminationJobs(Basis(BASE, proof=10.0), Scenario(2, "base"))._redundant_in_motion(change)
    assert finding is not None
    assert finding.verdict is Verdict.PROVED
    assert finding.assuming is not None
    assert finding.assuming.text.count(" U not atLane(") == 3
    assert finding.claim.text.count(finding.assuming.text) == 2
    other = next(x for x in changes("scenario_8(SV,POV,L)") if x.part == "atLane(POV, L)" and not x.value)
    assert _ExaminationJobs(Basis(BASE), Scenario(8, "base"))._redundant_in_motion(other) is None


@settings(deadline=None, derandomize=True)
@given(drives)
def test_every_drive_has_a_first_moment_outside_its_lane(drive: Drive) -> None:
    road = load_road("main-2")
    text = "given A: vehicle: (atLane(A,L) U not atLane(A,L)) or G atLane(A,L)"
    for lane in road.lanes:
        assert judge(bind(read_claim(BASE, text).formula, road, {"L": lane}, {}), drive).holds
