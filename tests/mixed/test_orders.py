"""Implications between scenarios of which some readings are proved or refuted, and some are in doubt."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from roadproof.analysis.basis import Basis
from roadproof.analysis.order import deciding
from roadproof.analysis.order.deciding import (
    FAR,
    Cast,
    Decisions,
    Edge,
    OrderDoubt,
    RefutationTask,
    families_of,
    kinds_of,
    settle_doubts,
)
from roadproof.analysis.order.study import (
    Doubtful,
    Family,
    Ordering,
    name_of,
    reachable,
    transitive_reduction,
)
from roadproof.engines.prove.prover import Result
from roadproof.errors import InputError
from roadproof.evidence.answers import order as kept
from roadproof.evidence.certificate import read_certificate_data
from roadproof.evidence.drive_file import load_drive
from roadproof.library.compose import implication
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.reasons import Why
from roadproof.verdict import Verdict

ROOT = Path(__file__).parents[2]
HOME = bundled_library().select()
BASIS = Basis(HOME)
DRIVE_FILE = load_drive(ROOT / "examples/catalogue/tests/drives/braking.json")
DRIVE: Any = SimpleNamespace(file=DRIVE_FILE)
PROOF = ROOT / "proofs/P4-scenario-03-base.json"
CERTIFICATE: Any = read_certificate_data(json.loads(PROOF.read_text("utf-8")), "proof")
V = Verdict
ONE, TWO, THREE = (Scenario(k, "base") for k in (1, 2, 3))


def of(**fields: Any) -> Any:
    return SimpleNamespace(**fields)


# --- implications ------------------------------------------------------------------------------------


def ordering(*numbers: int) -> Ordering:
    return Ordering(BASIS, kinds_of(HOME, ("base",), numbers))


@pytest.mark.parametrize(
    ("found", "settled"),
    [([], False), ([None], False), ([DRIVE, None], False), ([None, DRIVE], False), ([DRIVE, DRIVE], True)],
)
def test_every_reading_of_an_implication_has_to_be_refuted(
    found: list[Any], settled: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    drives = iter(found)
    monkeypatch.setattr(deciding, "_refuted_by", lambda *_: next(drives))
    doubt = OrderDoubt(ONE, TWO, tuple((of(text="a"), of(text="b")) for _ in found))
    after = settle_doubts(BASIS, Decisions(doubts=(doubt,)), [])
    assert after.again
    assert (after.doubts, len(after.drives)) == (() if settled else (doubt,), len(found) if settled else 0)


@pytest.mark.parametrize("found", [0, 1, 2])
def test_a_reading_for_which_no_drive_is_found_is_a_doubt(
    found: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Scenario 1 has two readings for scenario 2: POV may be either of its other vehicles."""
    asked: list[str] = []

    def prove(basis: Basis, query: Any, *_: Any, **__: Any) -> Result:
        asked.append(query.text)
        return Result(verdict=V.UNKNOWN)

    monkeypatch.setattr(Basis, "proof_of", prove)
    kinds = kinds_of(HOME, ("base",), (1, 2))
    one, two = sorted(kinds, key=lambda x: x.node.number)
    jobs = deciding._DecisionJobs(BASIS, kinds, (one,))
    for mine, others in jobs._casts(one):
        for other in others:
            jobs.open.setdefault((one.node, other.scenario), set()).add((mine, other))
    readings = jobs._still_open(one, two)
    assert len(readings) == 2
    drives = iter([(DRIVE,)] * found)
    monkeypatch.setattr(jobs, "_ask", lambda *_: next(drives, ()))
    jobs._decide(one, two)
    claims = [implication(jobs._query(mine), jobs._query(theirs)).text for mine, theirs in readings]
    assert asked == claims
    assert (len(jobs.drives), len(jobs.edges)) == (found, 0)
    assert [len(x.open) for x in jobs.doubts] == ([] if found == 2 else [2 - found])


def test_a_proof_of_one_reading_is_an_implication(monkeypatch: pytest.MonkeyPatch) -> None:
    kinds = kinds_of(HOME, ("base",), (1, 2))
    one, two = sorted(kinds, key=lambda x: x.node.number)
    jobs = deciding._DecisionJobs(BASIS, kinds, (one,))
    for mine, others in jobs._casts(one):
        for other in others:
            jobs.open.setdefault((one.node, other.scenario), set()).add((mine, other))
    answers = iter([Result(verdict=V.UNKNOWN), Result(verdict=V.PROVED, certificate=CERTIFICATE)])
    monkeypatch.setattr(Basis, "proof_of", lambda *_, **__: next(answers))
    jobs._decide(one, two)
    [edge] = jobs.edges
    assert edge.certificate is CERTIFICATE
    assert not jobs.doubts


def test_vehicles_that_a_drive_lacks_are_far_behind_all_others() -> None:
    kinds = kinds_of(HOME, ("base",), (1, 2))
    one = next(x for x in kinds if x.node.number == 1)
    jobs = deciding._DecisionJobs(BASIS, kinds, (one,))
    file = jobs._recast(DRIVE_FILE, one, Cast(ONE, ("SV", "POV")), [Cast(TWO, ("SV", "POV1", "POV"))])
    places = {name: x.s for name, x in file.drive.vehicles.items()}
    added = places.pop("POV1")
    assert added == min(places.values()) - FAR


def test_a_drive_that_the_judge_rejects_refutes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    kinds = kinds_of(HOME, ("base",), (3, 4))
    jobs = deciding._DecisionJobs(BASIS, kinds, kinds)
    one, other = kinds
    for mine, others in jobs._casts(one):
        for x in others:
            jobs.open.setdefault((one.node, x.scenario), set()).add((mine, x))
    before = {*jobs.open[one.node, other.node]}
    monkeypatch.setattr(jobs, "_holds", lambda *_: False)
    for shown, left in ((None, before), (DRIVE, set())):
        monkeypatch.setattr(deciding, "judged_as", lambda *_, shown=shown: shown)
        jobs._use(one, DRIVE)
        assert jobs.open[one.node, other.node] == left
    assert [x.others for x in jobs.drives] == [(other.node,)]


def test_what_follows_from_others_is_no_edge_and_no_doubt() -> None:
    """1 -> 3 follows from 1 -> 2 -> 3, whether it is proved by itself or in doubt."""
    study = ordering(3, 4, 5)
    families = [*study.families]
    a, b, c = (x.node for x in study.kinds)
    made = [Edge(x, y, of(text=""), CERTIFICATE) for x, y in ((a, b), (b, c), (a, c))]
    refuted = RefutationTask(b, (a,), DRIVE)
    doubts = (OrderDoubt(a, c, ()), OrderDoubt(c, a, ()))
    decided = {name: Decisions() for name in families}
    decided[families[0]] = Decisions(tuple(made), (refuted,), doubts)
    pairs = {(str(x), str(y)) for x, y in ((a, b), (b, c), (a, c))}
    assert transitive_reduction(pairs) == pairs - {(str(a), str(c))}
    assert reachable(str(a), pairs) == {str(a), str(b), str(c)}
    missing = RefutationTask(c, (b,), DRIVE)
    decided[families[0]] = replace(decided[families[0]], drives=(refuted, missing))
    order = study.order(decided)
    assert [(x.above, x.below) for x in order.proved] == [(a, b), (b, c), (a, c)]
    assert [(x.above, x.below) for x in order.edges] == [(a, b), (b, c)]
    assert [(x.above, x.below) for x in order.doubts] == [(c, a)]
    assert order.missing == ((b, a, (0,)), (c, b, (1,)))


def test_doubts_are_tried_with_the_drives_of_all_families() -> None:
    study = ordering(3, 4)
    first, second = study.families
    kinds = study.families
    other = RefutationTask(kinds[second][0].node, (kinds[first][0].node,), DRIVE)
    doubt = Decisions(doubts=(OrderDoubt(kinds[first][0].node, kinds[second][0].node, ()),))
    known = {first: doubt, second: Decisions(drives=(other,))}
    assert study.pieces(known) == [Doubtful(kinds[first], doubt, (DRIVE,))]
    assert study.pieces({**known, first: replace(doubt, again=True)}) == []
    assert not study.is_sure(doubt)
    assert study.is_sure(known[second])


def test_a_lost_family_is_in_doubt_about_all_others() -> None:
    study = ordering(3, 4, 5)
    family = study.kinds[0]
    [doubted] = study.doubt(Family((family,)), Why.PROCESS("SIGKILL")).values()
    pairs = {(x.above, x.below) for x in doubted.doubts}
    assert pairs == {(family.node, x.node) for x in study.kinds[1:]}
    assert doubted.again


def test_an_answer_that_leaves_an_implication_out_is_none() -> None:
    study = ordering(3, 4, 5)
    a, b, c = (x.node for x in study.kinds)
    name = name_of(families_of(study.kinds)[0])
    said = [kept.Doubt(above=str(a), below=str(x), reason=Why.TOLD("why")) for x in (b, c)]
    found, decided = study.recall(kept.Record(family=name, proved=(), drives=(), doubts=tuple(said)), of())
    assert (found, len(decided.doubts)) == (name, 2)
    with pytest.raises(InputError, match="nothing is kept of"):
        study.recall(kept.Record(family=name, proved=(), drives=(), doubts=tuple(said[:1])), of())


def test_a_key_of_an_order_changes_with_each_scenario() -> None:
    name = name_of(families_of(ordering(3, 4).kinds)[0])
    questions = [ordering(3, *rest).question.fingerprint for rest in ((4,), (5,), (4, 5))]
    assert len({*questions}) == 3
    assert len({ordering(3, *rest).key(name) for rest in ((4,), (5,), (4, 5))}) == 3
