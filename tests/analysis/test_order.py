"""The order of scenarios: a small library, whose order is known, decided and its evidence checked."""

import json
from pathlib import Path

import pytest

from roadproof.analysis.meeting import Node
from roadproof.analysis.order import Edge, Kind, Order, find_order, kinds_of
from roadproof.analysis.overlap import Asked
from roadproof.cli.main import main
from roadproof.report.order import as_dot


def node(number: int, set_name: str = "base") -> Node:
    return Node(number, set_name)


def test_scenarios_with_one_formula_are_one_kind() -> None:
    kinds = kinds_of(Asked(sets=("base", "extA", "ext")))
    assert sum(len(kind.nodes) for kind in kinds) == 72
    assert len(kinds) == 57
    by_node = {n: kind for kind in kinds for n in kind.nodes}
    assert by_node[node(1)].nodes == (node(1), node(1, "extA"))
    assert by_node[node(6)].nodes == (node(6), node(6, "extA"), node(6, "ext"))
    assert by_node[node(4)] is not by_node[node(4, "extA")]
    assert by_node[node(4)].like == by_node[node(12)].like != by_node[node(4, "ext")].like


def test_implications_are_chains_of_edges() -> None:
    a, b, c = node(1), node(1, "extA"), node(1, "ext")
    order = Order(tuple(Kind((x,), 0) for x in (a, b, c)), [Edge(a, b, "", ""), Edge(b, c, "", "")])
    assert order.implies(a, c)
    assert not order.implies(c, a)
    assert as_dot([["1@base"], ["1@ext"]], [{"from": "1@base", "to": "1@ext"}]).count("->") == 1


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
    return f"scenario_{number}{'' if set_name == 'base' else '@' + set_name}(SV,POV,L)"


def test_scenarios_of_different_size_are_compared(tmp_path: Path) -> None:
    order = find_order(Asked(timeout=60.0), (2, 4))
    assert order.edges == []
    assert order.doubts == []
    refuted = {(drive.node.number, other.number) for drive in order.drives for other in drive.others}
    assert refuted == {(2, 4), (4, 2)}
