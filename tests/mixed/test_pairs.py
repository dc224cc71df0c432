"""Pairs of scenarios with several readings: one proved beside one that is not, one in doubt among others."""

import json
from dataclasses import replace
from itertools import product
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from roadproof.analysis import overlap
from roadproof.analysis.basis import Basis
from roadproof.analysis.overlap import Core, Group, Meeting, Overlap, PairVerdict, conjunctions, name_of
from roadproof.engines.prove.prover import Result
from roadproof.evidence.certificate import read_certificate_data
from roadproof.library.compose import both, negation
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.reasons import NO_REASON, Why
from roadproof.runtime.budget import BudgetExceeded
from roadproof.verdict import Verdict

V = Verdict
PROOF = Path(__file__).parents[2] / "proofs/P4-scenario-03-base.json"
CERTIFICATE: Any = read_certificate_data(json.loads(PROOF.read_text("utf-8")), "proof")
HOME = bundled_library().select()
PAIR = (Scenario(3, "base"), Scenario(4, "base"))
ANY_START = Meeting(start="any")
READINGS = conjunctions(HOME, *PAIR, ANY_START)
WHOLE = both(*map(negation, READINGS))
DRIVE: Any = SimpleNamespace(file=SimpleNamespace())


def outcome(verdict: Verdict, said: str, drive: Any = None) -> Any:
    told = NO_REASON if verdict is V.IMPOSSIBLE else Why.TOLD(said)
    return SimpleNamespace(verdict=verdict, drives=() if drive is None else (drive,), told=lambda _: told)


class Engines:
    """What provers and searches answer, by the text of what is asked; all that was asked is noted."""

    def __init__(
        self, monkeypatch: pytest.MonkeyPatch, proofs: dict[str, Any], found: dict[str, Any]
    ) -> None:
        self.proofs, self.found, self.asked = proofs, found, list[str]()
        monkeypatch.setattr(Basis, "proof_of", lambda basis, query, *_, **__: self.prove(query))
        monkeypatch.setattr(overlap, "ask", self.ask)
        monkeypatch.setattr(overlap, "explain", lambda *_: None)

    def prove(self, query: Any) -> Any:
        self.asked.append(query.text)
        result = self.proofs.get(query.text, Result(verdict=V.UNKNOWN))
        if isinstance(result, Exception):
            raise result
        return result

    def ask(self, search: Any) -> Any:
        return self.found[search.query.text]


def proof(name: str) -> Result:
    return Result(verdict=V.PROVED, certificate=replace(CERTIFICATE, claim=name))


def settled(meeting: Meeting = ANY_START, pair: Any = PAIR) -> PairVerdict:
    study = Overlap(Basis(HOME), (pair,), meeting)
    [piece] = study.pieces({})
    [answer] = study.settle(piece).values()
    return answer


def test_there_are_two_readings() -> None:
    assert len(READINGS) == 2
    assert READINGS[0].formula != READINGS[1].formula


@pytest.mark.parametrize("verdicts", list(product((V.IMPOSSIBLE, V.NONE_WITHIN, V.UNKNOWN), repeat=2)))
def test_one_reading_in_doubt_is_a_doubt(verdicts: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    found = {x.text: outcome(v, f"why-{k}") for k, (x, v) in enumerate(zip(READINGS, verdicts, strict=True))}
    Engines(monkeypatch, {}, found)
    answer = settled()
    assert answer.verdict is (V.UNKNOWN if V.UNKNOWN in verdicts else V.NONE_WITHIN)
    for k, verdict in enumerate(verdicts):
        assert (f"why-{k}" in answer.reason) is (verdict is not V.IMPOSSIBLE)
    assert answer.certificate is None


def test_all_readings_impossible_with_a_proof_of_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    found = {x.text: outcome(V.IMPOSSIBLE, "") for x in READINGS}
    Engines(monkeypatch, {WHOLE.text: proof("whole")}, found)
    answer = settled()
    assert answer.verdict is V.IMPOSSIBLE
    assert answer.certificate is not None
    assert answer.certificate.claim == "whole"


@pytest.mark.parametrize("place", [0, 1])
def test_one_impossible_reading_does_not_make_the_pair_so(
    place: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    verdicts = [V.NONE_WITHIN, V.NONE_WITHIN]
    verdicts[place] = V.IMPOSSIBLE
    found = {x.text: outcome(v, "why") for x, v in zip(READINGS, verdicts, strict=True)}
    Engines(monkeypatch, {WHOLE.text: proof("whole")}, found)
    assert settled().verdict is V.NONE_WITHIN


def test_proofs_of_all_readings_are_proved_together(monkeypatch: pytest.MonkeyPatch) -> None:
    proofs: dict[str, Any] = {negation(x).text: proof(f"reading-{k}") for k, x in enumerate(READINGS)}
    engines = Engines(monkeypatch, {**proofs, WHOLE.text: proof("whole")}, {})
    answer = settled()
    assert answer.verdict is V.IMPOSSIBLE
    assert answer.certificate is not None
    assert (answer.certificate.claim, answer.query and answer.query.formula) == ("whole", WHOLE.formula)
    assert [x.whole.text for x in answer.cores] == [x.text for x in READINGS]
    assert WHOLE.text in engines.asked
    Engines(monkeypatch, proofs, {})  # the proof of the whole is lost
    lost = settled()
    assert (lost.verdict, lost.certificate) == (V.UNKNOWN, None)
    assert lost.reason == Why.PROOF_LOST()


@pytest.mark.parametrize("place", [0, 1])
def test_a_drive_of_the_reading_that_is_not_proved_impossible(
    place: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    proofs: dict[str, Any] = {negation(READINGS[1 - place]).text: proof("one")}
    Engines(monkeypatch, proofs, {READINGS[place].text: outcome(V.WITNESSED, "", DRIVE)})
    answer = settled()
    assert (answer.verdict, answer.drive) == (V.WITNESSED, DRIVE)
    assert answer.query is not None
    assert answer.query.text == READINGS[place].text


def test_what_the_clock_cuts_off_is_in_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    Engines(monkeypatch, {negation(READINGS[1]).text: BudgetExceeded(3.0)}, {})
    answer = settled()
    assert answer.verdict is V.UNKNOWN
    assert "--timeout" in answer.reason


def test_a_lost_group_is_a_doubt_of_all_its_pairs() -> None:
    pairs = tuple((Scenario(a, "base"), Scenario(a + 1, "base")) for a in (3, 11, 19))
    study = Overlap(Basis(HOME), pairs)
    [piece] = study.pieces({})
    doubts = study.doubt(piece, Why.PROCESS("SIGKILL"))
    assert {x.verdict for x in doubts.values()} == {V.UNKNOWN}
    assert [*doubts] == [name_of(*x) for x in pairs]
    sure = {x: study.is_sure(PairVerdict(*PAIR, verdict=x)) for x in (V.NONE_WITHIN, V.UNKNOWN)}
    assert sure == {V.NONE_WITHIN: False, V.UNKNOWN: False}
    assert study.is_sure(PairVerdict(*PAIR, verdict=V.IMPOSSIBLE))
    assert study.is_sure(PairVerdict(*PAIR, verdict=V.WITNESSED))


@pytest.mark.parametrize("place", [0, 1])
def test_the_drive_of_a_group_is_put_to_the_same_reading(place: int, monkeypatch: pytest.MonkeyPatch) -> None:
    other = (Scenario(11, "base"), Scenario(12, "base"))
    asked: list[str] = []
    monkeypatch.setattr(overlap, "placed", lambda file, query, library: asked.append(query.text) or DRIVE)
    jobs = overlap._DecisionJobs(Basis(HOME), ANY_START)
    first = PairVerdict(*PAIR, READINGS[place], verdict=V.WITNESSED, drive=DRIVE)
    answer = jobs.answer(other, PAIR, first)
    expected = conjunctions(HOME, *other, ANY_START)[place].text
    assert asked == [expected]
    assert (answer.verdict, answer.query and answer.query.text) == (V.WITNESSED, expected)


def test_parts_that_another_pair_does_not_have_are_not_its_core(monkeypatch: pytest.MonkeyPatch) -> None:
    Engines(monkeypatch, {}, {})
    jobs = overlap._DecisionJobs(Basis(HOME), Meeting())
    [mine] = conjunctions(HOME, *PAIR, Meeting())
    [other] = conjunctions(HOME, Scenario(5, "base"), Scenario(6, "base"), Meeting())
    here, there = (list(overlap.parts(x.formula)) for x in (mine, other))
    common, foreign = tuple(here[:1]), tuple(x for x in there if x not in here)
    assert foreign
    assert jobs._core_like(mine, Core(other, common)).parts == common
    assert jobs._core_like(mine, Core(other, foreign)).parts == ()
    assert jobs._core_like(mine, Core(other, (*common, *foreign))).parts == ()


def test_pairs_across_two_sets_keep_their_order_and_their_names() -> None:
    basis = Basis(HOME, ("base", "ext"))
    pairs = tuple((Scenario(a, "base"), Scenario(b, "ext")) for a, b in product((3, 4), repeat=2))
    study = Overlap(basis, pairs)
    pieces = study.pieces({})
    assert [x for piece in pieces for x in piece.pairs] == [*pairs]
    assert all((a.set_name, b.set_name) == ("base", "ext") for piece in pieces for a, b in [piece.seed])
    sets = ("base", "extA", "ext")
    every = [(Scenario(a, x), Scenario(b, y)) for a, b in pairs_of_numbers() for x, y in product(sets, sets)]
    assert len({name_of(a, b) for a, b in every}) == len(every)
    assert len({study.key(name_of(*x)) for x in pairs}) == len(pairs)
    assert isinstance(pieces[0], Group)


def pairs_of_numbers() -> list[tuple[int, int]]:
    return [(3, 4), (4, 3), (3, 3), (11, 12)]
