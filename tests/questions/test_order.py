"""The order of scenarios: a small library, whose order is known, decided and its evidence checked."""

import json
import random
from collections.abc import Sequence
from itertools import permutations
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from extensions.pages.report.edges import cut_off
from roadproof.engines.search.batches import Engines
from roadproof.engines.search.known_drive import recast
from roadproof.errors import UsageError
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.certificate_file import read_certificate
from roadproof.evidence.claim import Claim, Valid
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.surveys.report.order_picture import draw_order
from roadproof.frontends.api import ordering
from roadproof.frontends.cli.main import main
from roadproof.frontends.report.order import as_dot, as_text
from roadproof.library.compose import both, implication, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.library.words import words_by_number
from roadproof.questions.basis import Basis
from roadproof.questions.order import deciding
from roadproof.questions.order.deciding import Edge, JudgedDrives, drive_claim
from roadproof.questions.order.kinds import Cast, Kind, casts_of, families_of, kinds_of
from roadproof.questions.order.question import (
    Compared,
    OrderQuestion,
    OrderView,
    reachable,
    transitive_reduction,
)
from roadproof.questions.question import walk_batch
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.budget import Work
from roadproof.verdict import Verdict
from roadproof.world.drive import FAR

BASE = bundled_library().select("base")
BASIS = Basis(BASE)
ROOT = Path(__file__).parents[2]
PROOF = read_certificate(ROOT / "proofs/P4-scenario-03-base.json")
DRIVE: Any = object.__new__(JudgedDrive)
V = Verdict


def node(number: int, set_name: str = "base") -> Scenario:
    return Scenario(number, set_name)


def question(*numbers: int) -> OrderQuestion:
    return OrderQuestion(BASIS, Compared(among=numbers))


def test_scenarios_with_one_formula_are_one_kind() -> None:
    kinds = kinds_of(BASE, ("base", "extA", "ext"))
    assert sum(len(kind.nodes) for kind in kinds) == 72
    assert len(kinds) == 57
    by_node = {n: kind for kind in kinds for n in kind.nodes}
    assert by_node[node(1)].nodes == (node(1), node(1, "extA"))
    assert by_node[node(6)].nodes == (node(6), node(6, "extA"), node(6, "ext"))
    assert by_node[node(4)] is not by_node[node(4, "extA")]
    assert by_node[node(4)].family == by_node[node(12)].family != by_node[node(4, "ext")].family
    assert {x.number for kind in kinds_of(BASE, ("base",), (3, 4)) for x in kind.nodes} == {3, 4}


def test_implications_are_chains_of_edges() -> None:
    pairs = {("a", "b"), ("b", "c"), ("a", "c"), ("c", "d")}
    assert reachable("a", pairs) == {"a", "b", "c", "d"}
    assert reachable("d", pairs) == {"d"}
    assert transitive_reduction(pairs) == {("a", "b"), ("b", "c"), ("c", "d")}
    one, other = node(1), node(1, "ext")
    claim: Any = None
    edge = Edge(one, other, "implies", claim)
    order = OrderView((Kind((one,), 0), Kind((other,), 0)), (edge,), (edge,), (), (), ())
    words = words_by_number(BASE, (1,))
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


# --- answers as they are given -----------------------------------------------------------------------


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


def test_scenarios_of_different_size_are_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = ["order", "--set", "base", "--among", "2,4", "--out", str(tmp_path / "out"), "--no-pictures"]
    assert main([*line, "--jobs", "1", "--json", "-"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert {(x["from"], x["to"]) for x in data["missing"]} == {("2@base", "4@base"), ("4@base", "2@base")}
    assert main(["check", str(tmp_path / "out"), "--jobs", "1"]) == 0


def test_a_run_of_all_scenarios_says_at_once_what_it_does(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def stop(*_: object, **__: object) -> None:
        raise UsageError("it would take minutes")

    monkeypatch.setattr(ordering, "order", stop)
    assert main(["order"]) == 2
    assert capsys.readouterr().err.startswith("expanding all scenarios into families, then looking up")
    assert main(["order", "--among", "2,4"]) == 2
    assert capsys.readouterr().err == "roadproof: it would take minutes\n"


def test_a_run_that_was_broken_off_goes_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    line = ["order", "--set", "base", "--among", "1,6", "--out", str(out), "--no-pictures", "--json", "-"]
    assert main([*line, "--jobs", "1"]) == 0
    whole = json.loads(capsys.readouterr().out)
    files = {path.name: path.read_bytes() for path in out.iterdir()}
    for path in out.glob("*-base-06*"):
        path.unlink()
    before = {path.name: path.stat().st_mtime_ns for path in out.glob("*-base-01-*.json")}
    assert main([*line, "--jobs", "1"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert {k: v for k, v in again.items() if k != "seconds"} == {
        k: v for k, v in whole.items() if k != "seconds"
    }
    assert {path.name: path.read_bytes() for path in out.iterdir()} == files
    kept = {x for x, time in before.items() if (out / x).stat().st_mtime_ns == time}
    assert kept == {x for x in before if not x.startswith(("implies-base-06", "against-base-06"))}


@pytest.mark.parametrize(
    ("reason", "again"),
    [(ReasonKind.CLOCK(3.0), 0), (ReasonKind.SOLVER_GAVE_UP(), 0), (ReasonKind.NO_DRIVE(), 20)],
)
def test_a_family_in_doubt_is_asked_again_unless_its_work_was_counted_out(
    reason: Reason,
    again: int,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    out = tmp_path / "out"
    line = ["order", "--set", "base", "--among", "1,6", "--out", str(out), "--no-pictures", "--jobs", "1"]

    with monkeypatch.context() as without_answers:
        without_answers.setattr(Engines, "decide", lambda _, claim: undecided(claim, reason))
        assert main(line) == 20
    told = capsys.readouterr().out
    assert "in doubt: 6@base -> 1@base: neither a proof nor a drive against scenario_6(" in told
    assert main(["check", str(out), "--jobs", "1", "--strict"]) == 20
    assert main(line) == again
    assert main(["check", str(out), "--jobs", "1", "--strict"]) == again


# --- drives in other roles ---------------------------------------------------------------------------


def test_a_drive_for_another_scenario_settles_a_doubt_with_its_vehicles_exchanged() -> None:
    three, one, wide = (read_claim(BASE, f"scenario_{x}(SV, POV, L)") for x in ("3", "1", "3@ext"))
    engines = Engines(Work(recast=True, once=True, disprove=False))
    drive, _ = engines.answer_claim(BASIS.claim(read_claim(BASE, "scenario_4(SV, POV, L)")))
    assert drive.drive is not None
    engines.learn(drive)
    wanted = drive_claim(BASIS, three, both(three, negation(one)))
    engines.learn(undecided(wanted, ReasonKind.NO_DRIVE()))
    shown = engines.answer_claim(wanted)[0].drive
    assert shown is not None
    assert shown.file.drive.vehicles["SV"] == drive.drive.file.drive.vehicles["POV"]
    assert shown.file.formula == "scenario_3(SV, POV, L) and not scenario_1(SV, POV, L)"
    vain = drive_claim(BASIS, three, both(three, negation(wide)))
    engines.learn(undecided(vain, ReasonKind.NO_DRIVE()))
    assert engines.answer_claim(vain)[0].verdict is V.UNKNOWN


def test_what_the_clock_cut_off_is_looked_for_again(monkeypatch: pytest.MonkeyPatch) -> None:
    claim = BASIS.claim(read_claim(BASE, "scenario_4(SV, POV, L)"))
    monkeypatch.setattr(Engines, "decide", lambda _, claim: undecided(claim, ReasonKind.TOLD("decided")))
    for reason, seen in (
        (ReasonKind.CLOCK(1), "decided"),
        (ReasonKind.NO_DRIVE(), str(ReasonKind.NO_DRIVE_ELSEWHERE())),
    ):
        engines = Engines(Work(once=True))
        engines.learn(undecided(claim, reason))
        assert engines.answer_claim(claim)[0].reason == seen


def test_vehicles_that_a_drive_lacks_are_far_behind_all_others() -> None:
    file = load_drive(ROOT / "examples/catalogue/tests/drives/braking.json")
    made = recast(file, {"SV": "SV", "POV": "POV"}, ("SV", "POV2", "POV1", "POV"))
    places = {name: x.s for name, x in made.drive.vehicles.items()}
    assert (places.pop("POV1"), places.pop("POV2")) == (
        min(places.values()) - FAR,
        min(places.values()) - 2 * FAR,
    )


# --- all that can be answered ------------------------------------------------------------------------


class Answers(dict[str, ClaimAnswer]):
    """Answers by chance, and which of the others are false on each drive."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)

    def find(self, name: str, claim: Claim) -> ClaimAnswer:
        if name not in self:
            self[name] = self.answer(claim)
        return self[name]

    def answer(self, claim: Claim) -> ClaimAnswer:
        kind = self.chance.choice(("shown", "other", "doubt"))
        if kind == "shown":
            return ClaimAnswer(claim, PROOF if isinstance(claim.mode, Valid) else DRIVE)
        if kind == "other" and isinstance(claim.mode, Valid):
            return ClaimAnswer(claim, DRIVE)
        return undecided(claim, ReasonKind.NO_DRIVE())

    def truths(self, _: Any, drive: Any, own: Cast, mine: Cast, others: Sequence[Cast]) -> tuple[bool, ...]:
        held = random.Random(repr((own, mine)))
        return tuple(held.random() < 0.7 for _ in others)


@pytest.mark.parametrize("seed", range(60))
def test_each_implication_is_proved_refuted_or_in_doubt(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A proof of one reading proves it, drives against all refute it, and nothing else does either."""
    answers = Answers(seed)
    monkeypatch.setattr(ClaimAnswer, "verdict", property(verdict_of))
    monkeypatch.setattr(deciding.JudgedDrives, "truths", lambda _, *given: answers.truths(*given))
    asked = question(1, 2, 3, 9)
    seen: set[str] = set()
    while new := [x for x in asked.batches(answers) if x.name not in seen]:
        for batch in new:
            seen.add(batch.name)
            assert not [*walk_batch(batch, answers.find)]
    view = asked.view(answers)
    nodes = [x.node for x in view.kinds]
    proved = {x.pair for x in view.proved}
    implied = {(a, b) for a in map(str, nodes) for b in reachable(a, proved)}
    missing = {(str(a), str(b)) for a, b, _ in view.missing}
    doubts = {(str(x.above), str(x.below)) for x in view.doubts}
    for a, b in permutations(map(str, nodes), 2):
        assert ((a, b) in implied) + ((a, b) in missing) + ((a, b) in doubts) == 1
    for edge in view.proved:
        readings = readings_of(asked, edge.above, edge.below)
        assert edge.claim.formula in [implication(*x).formula for x in readings]
        assert edge.answer.certificate is not None
    for above, below, places in view.missing:
        shown = [view.drives[k] for k in places]
        assert all(x.node == above and below in x.others for x in shown)
        texts = [x.answer.claim.text for x in shown]
        for one, other in readings_of(asked, above, below):
            against = (f"{one.text} and ", f"not {other.text}")
            plain = f"{one.text} -> {other.text}"
            assert any(plain == x or (x.startswith(against[0]) and against[1] in x) for x in texts)


def verdict_of(answer: ClaimAnswer) -> Verdict:
    """The verdict by the kind of evidence alone, since the evidence here is of other claims."""
    if answer.evidence is DRIVE:
        return V.REFUTED if isinstance(answer.claim.mode, Valid) else V.WITNESSED
    return V.PROVED if answer.evidence is PROOF else V.UNKNOWN


def readings_of(asked: OrderQuestion, above: Scenario, below: Scenario) -> list[Any]:
    [kind] = [x for x in asked.kinds if x.node == above]
    return [
        (mine.query(BASE), other.query(BASE))
        for mine, others in casts_of(BASE, asked.kinds, kind)
        for other in others
        if other.scenario == below
    ]


def test_a_pair_of_different_size_has_a_reading_for_each_pov() -> None:
    asked = question(1, 2)
    assert len(readings_of(asked, node(1), node(2))) == len(readings_of(asked, node(2), node(1))) == 2
    assert [len(x) for x in families_of(question(1, 9, 2).kinds)] == [2, 1]


def test_what_follows_from_others_is_no_edge_and_no_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    """3 -> 5 follows from 3 -> 4 -> 5, whether it is proved by itself or in doubt."""
    monkeypatch.setattr(ClaimAnswer, "verdict", property(verdict_of))
    asked = question(3, 4, 5)
    pairs = [(a, b) for a, b in permutations((3, 4, 5), 2)]
    for direct in (True, False):
        proved = {(3, 4), (4, 5)} | ({(3, 5)} if direct else set())
        known: dict[str, ClaimAnswer] = {}
        for a, b in pairs:
            claim: Any = BASIS.claim(read_claim(BASE, "true"))
            valid: Any = object.__new__(Claim)
            object.__setattr__(valid, "mode", Valid())
            name = f"base-{a:02}-base-{b:02}"
            known[f"implies-{name}"] = (
                ClaimAnswer(valid, PROOF) if (a, b) in proved else undecided(claim, ReasonKind.NO_DRIVE())
            )
        view = asked.view(known)
        assert {x.pair for x in view.proved} == {(f"{a}@base", f"{b}@base") for a, b in proved}
        assert {x.pair for x in view.edges} == {("3@base", "4@base"), ("4@base", "5@base")}
        assert {(x.above.number, x.below.number) for x in view.doubts} == {(4, 3), (5, 4), (5, 3)}
        assert view.missing == ()


def test_what_is_known_of_drives_is_not_sent_elsewhere() -> None:
    import pickle

    judged = JudgedDrives()
    judged.known["key"] = DRIVE, (True,)
    assert pickle.loads(pickle.dumps(judged)).known == {}
