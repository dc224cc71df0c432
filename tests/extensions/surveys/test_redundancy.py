"""Parts of scenarios that could be left out: known answers, and the evidence behind them."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings

from judge.cases import drives
from rejection import rejection_reason
from roadproof.engines.search import drive_search
from roadproof.engines.search.batches import Engines
from roadproof.engines.search.outcome import SearchOutcome
from roadproof.engines.setting import Search
from roadproof.engines.solve.smt import check_sat as ask_solver
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.judged import judge_file
from roadproof.extensions.surveys import redundancy
from roadproof.extensions.surveys.redundancy import (
    Change,
    ChangeFinding,
    Changes,
    RedundancyQuestion,
    changes_of,
)
from roadproof.frontends.cli.main import main
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.specification import Query, Specification
from roadproof.questions.basis import Basis
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.judging import judge
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


def decide(number: int, part: str, value: bool, basis: Basis = BASIS) -> ChangeFinding:
    """The finding on the first change of ``part`` in a scenario of base, its claims asked in turn."""
    asked = RedundancyQuestion(basis, Changes(among=(number,)))
    first = next(
        place for place, x in enumerate(asked.changes(number)) if x.part == part and x.value is value
    )
    names, claims = asked.named(number)[first]
    engines, known = Engines(asked.work), dict[str, ClaimAnswer]()
    for name, claim in zip(names, (claims.equal, claims.moving, claims.apart), strict=True):
        known[name], _ = engines.answer_claim(claim)
        if redundancy._decides(known[name]):
            break
    return asked.view(known).findings[number][first]


def test_adjacent_lanes_are_redundant_in_scenario_3() -> None:
    part = "atLane(SV, L) and (some M in adjacentLanes(L): atLane(POV, M))"
    finding = decide(3, part, False)
    assert finding.verdict is Verdict.PROVED
    assert finding.shown is not None
    certificate = finding.shown.certificate
    assert certificate is not None
    assert certificate.claim.startswith("scenario_3(SV, POV, L) <-> ")
    assert rejection_reason(certificate, bundled_library(), ask_solver) is None


def test_what_a_scenario_needs_is_shown_by_a_drive() -> None:
    finding = decide(8, "aheadOf(SV, POV)", False)
    assert finding.verdict is Verdict.REFUTED
    assert finding.apart is not None
    assert finding.apart.drive is not None
    drive = finding.apart.drive.file
    assert drive.formula == f"scenario_8(SV, POV, L) and not ({finding.change.changed.text})"
    assert judge_file(drive, bundled_library()).accepted


@pytest.fixture
def few_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the changes of one part of scenarios 3 and 11, so that a run takes seconds."""

    def few(home: Specification, query: Query, whole: bool = False) -> Iterator[Change]:
        yield from (x for x in changes_of(home, query, whole) if x.part.startswith(("sameLane", "aheadOf")))

    monkeypatch.setattr(redundancy, "changes_of", few)


def test_scenarios_that_differ_in_their_road_only_share_drives(
    few_changes: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    searched: list[str] = []
    searching = drive_search.search_drive

    def counted(search: Search) -> SearchOutcome:
        searched.append(search.query.text)
        return searching(search)

    monkeypatch.setattr(drive_search, "search_drive", counted)
    out = tmp_path / "out"
    line = ["redundancy", "--among", "3,11", "--out", str(out), "--jobs", "1", "--json", "-"]
    assert main(line) == 0
    whole = json.loads(capsys.readouterr().out)["verdicts"]
    assert [x["redundant"] for x in whole if x["scenario"] == 3] == [
        x["redundant"] for x in whole if x["scenario"] == 11
    ]
    assert searched
    assert not any("scenario_11" in x and "not" in x for x in searched)
    assert main(["check", str(out), "--jobs", "1"]) == 0
    capsys.readouterr()

    for path in (*out.glob("needed-11-*.json"), *out.glob("redundant-11-*.json")):
        path.unlink()
    searched.clear()
    assert main(line) == 0
    assert json.loads(capsys.readouterr().out)["verdicts"] == whole
    assert not any("scenario_11" in x and "not" in x for x in searched)


def test_what_motion_makes_redundant_is_proved_for_motion() -> None:
    """SV need not be asked to keep its lane until it or POV1 has left it: one of them leaves first."""
    finding = decide(2, "laneKeep(SV, L) U not sameLane(SV, POV1, L)", True, Basis(BASE, proof=10.0))
    assert finding.verdict is Verdict.PROVED
    assert finding.assuming is not None
    assert finding.assuming.text.count(" U not atLane(") == 3
    assert finding.claim.text.count(finding.assuming.text) == 2


@settings(deadline=None, derandomize=True)
@given(drives)
def test_every_drive_has_a_first_moment_outside_its_lane(drive: Drive) -> None:
    road = load_road("main-2")
    text = "given A: vehicle: (atLane(A,L) U not atLane(A,L)) or G atLane(A,L)"
    for lane in road.lanes:
        assert judge(bind(read_claim(BASE, text).formula, road, {"L": lane}, {}), drive).holds
