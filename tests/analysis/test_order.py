"""The order of scenarios: a small library, whose order is known, decided and its evidence checked."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asking import prove, search_for
from judge.cases import drives
from report.edges import cut_off
from roadproof.analysis import redundancy
from roadproof.analysis.basis import Basis
from roadproof.analysis.order.deciding import (
    Decisions,
    Edge,
    Kind,
    OrderDoubt,
    _DecisionJobs,
    decide_family,
    families_of,
    kinds_of,
    settle_doubts,
)
from roadproof.analysis.order.study import Order, reachable, transitive_reduction
from roadproof.analysis.redundancy import Change, ChangeFinding, SharedFindings, _ExaminationJobs, changes_of
from roadproof.engines.search.ask import ask
from roadproof.engines.search.ask import ask as ask_for_drive
from roadproof.engines.search.outcome import Outcome, Search
from roadproof.engines.solve.smt import ask as ask_solver
from roadproof.evidence.certificate import refusal
from roadproof.evidence.judged import judge_file
from roadproof.frontends.cli.main import main
from roadproof.frontends.report.order import as_dot, as_text, draw_order
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario, without_sectors
from roadproof.library.specification import Query, Specification
from roadproof.library.words import called
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.exact import judge
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.models import load_road

BASE = bundled_library().select("base")


def node(number: int, set_name: str = "base") -> Scenario:
    return Scenario(number, set_name)


def test_scenarios_with_one_formula_are_one_kind() -> None:
    kinds = kinds_of(BASE, ("base", "extA", "ext"))
    assert sum(len(kind.nodes) for kind in kinds) == 72
    assert len(kinds) == 57
    by_node = {n: kind for kind in kinds for n in kind.nodes}
    assert by_node[node(1)].nodes == (node(1), node(1, "extA"))
    assert by_node[node(6)].nodes == (node(6), node(6, "extA"), node(6, "ext"))
    assert by_node[node(4)] is not by_node[node(4, "extA")]
    assert by_node[node(4)].like == by_node[node(12)].like != by_node[node(4, "ext")].like


def test_implications_are_chains_of_edges() -> None:
    pairs = {("a", "b"), ("b", "c"), ("a", "c"), ("c", "d")}
    assert reachable("a", pairs) == {"a", "b", "c", "d"}
    assert reachable("d", pairs) == {"d"}
    assert transitive_reduction(pairs) == {("a", "b"), ("b", "c"), ("c", "d")}
    one, other = node(1), node(1, "ext")
    certificate = prove(BASE, "true").certificate
    assert certificate is not None
    edge = Edge(one, other, read_claim(BASE, "true"), certificate)
    order = Order((Kind((one,), 0), Kind((other,), 0)), (edge,), (edge,), (), (), ())
    words = called(BASE, (1,))
    graph = as_dot(order, words)
    assert graph.count("->") == 1
    assert graph.count('label="1@') == graph.count("cut-in, lane keep, main road") == 2
    figure = draw_order(order, "implications in base and ext; an arrow leads to what is implied", words)
    assert cut_off(figure) == []
    assert "cut-in, lane keep\nmain road" in [x.get_text() for x in figure.axes[0].texts]
    told = as_text(order, 1.0, words).splitlines()
    assert told[:2] == ["1@base -> 1@ext", "  1: cut-in, lane keep, main road"]


@given(st.sets(st.tuples(st.sampled_from("abcde"), st.sampled_from("abcde"))))
def test_a_reduction_reaches_as_far(pairs: set[tuple[str, str]]) -> None:
    reduced = transitive_reduction(pairs)
    assert reduced <= pairs
    assert all(reachable(x, reduced) == reachable(x, pairs) for x in "abcde")
    assert all(below not in reachable(above, reduced - {(above, below)}) for above, below in reduced)


def test_every_answer_comes_with_its_evidence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    line = ["order", "--set", "base", "--set", "extA", "--among", "4,12", "--out", str(out), "--json", "-"]
    assert main([*line, "--no-pictures"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert {(x["from"], x["to"]) for x in data["edges"]} == {
        ("4@base", "4@extA"),
        ("12@base", "12@extA"),
    }
    assert data["doubts"] == []
    # Four formulas have twelve implications: two are proved, and a drive refutes each of the others.
    assert len(data["missing"]) == 10
    drives = {x["number"]: x for x in data["drives"]}
    for missing in data["missing"]:
        assert missing["drives"]
        for number in missing["drives"]:
            content = json.loads(Path(drives[number]["drive"]).read_text())
            assert drives[number]["holds"] == missing["from"]
            assert f"not {call(missing['to'])}" in content["formula"]
            assert content["formula"].startswith(call(missing["from"]))
    assert main(["check", str(out), "--jobs", "1"]) == 0
    assert (out / "order.dot").read_text().count("->") == 2


def call(name: str) -> str:
    number, _, set_name = name.partition("@")
    return f"scenario_{number}{'' if set_name == 'base' else '@' + set_name}(SV, POV, L)"


def test_scenarios_of_different_size_are_compared() -> None:
    basis = Basis(BASE, effort=Effort(60))
    kinds = kinds_of(BASE, ("base",), (2, 4))
    refuted = set()
    for family in families_of(kinds):
        decided = decide_family(basis, kinds, family)
        assert decided.edges == ()
        assert decided.doubts == ()
        refuted |= {(drive.node.number, other.number) for drive in decided.drives for other in drive.others}
    assert refuted == {(2, 4), (4, 2)}


def test_a_run_that_was_broken_off_goes_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    line = ["order", "--set", "base", "--among", "1,6", "--out", str(out), "--no-pictures", "--json", "-"]
    assert main([*line, "--jobs", "1"]) == 0
    whole = json.loads(capsys.readouterr().out)
    (out / "answers/base-06.json").unlink()
    before = {path.name: path.stat().st_mtime_ns for path in out.glob("drive-*")}
    assert main([*line, "--jobs", "1"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert {k: v for k, v in again.items() if k != "seconds"} == {
        k: v for k, v in whole.items() if k != "seconds"
    }
    after = {path.name: path.stat().st_mtime_ns for path in out.glob("drive-*")}
    kept = {name for name in before if before[name] == after[name]}
    assert kept == {name for name in before if "base-01" in name} != set(before)


def test_a_family_in_doubt_is_asked_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    line = ["order", "--set", "base", "--among", "1,6", "--out", str(out), "--no-pictures", "--jobs", "1"]
    with monkeypatch.context() as without_drives:
        without_drives.setattr(_DecisionJobs, "_ask", lambda *_: ())
        assert main(line) == 20
    assert "in doubt: 1@base -> 6@base" in capsys.readouterr().out
    assert main(line) == 0


def test_a_drive_for_another_scenario_settles_a_doubt_with_its_vehicles_exchanged() -> None:
    basis = Basis(BASE)
    three, one, wide = (read_claim(BASE, f"scenario_{x}(SV, POV, L)") for x in ("3", "1", "3@ext"))
    decided = Decisions(doubts=(OrderDoubt(node(3), node(1), ((three, one),)),))
    (drive,) = ask(search_for("4")).drives
    settled = settle_doubts(basis, decided, [drive])
    assert settled.doubts == ()
    (refuting,) = settled.drives
    file = refuting.drive.file
    assert file.drive.vehicles["SV"] == drive.file.drive.vehicles["POV"]
    assert file.formula == "scenario_3(SV, POV, L) and not scenario_1(SV, POV, L)"
    wrong = OrderDoubt(node(3), node(4), ((three, wide),))
    assert settle_doubts(basis, Decisions(doubts=(wrong,)), [drive]).doubts == (wrong,)


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
