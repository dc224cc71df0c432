"""The order of scenarios: a small library, whose order is known, decided and its evidence checked."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from asking import prove, search_for
from report.edges import cut_off
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
from roadproof.engines.search.ask import ask
from roadproof.frontends.cli.main import main
from roadproof.frontends.report.order import as_dot, as_text, compose_order
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.library.words import called
from roadproof.runtime.budget import Effort

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
    figure = compose_order(order, "implications in base and ext; an arrow leads to what is implied", words)
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
