"""Coverage: what its claims have to say, and classes of gaps of which some are proved, found or in doubt."""

import json
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from roadproof.analysis.basis import Basis, ProofResult
from roadproof.analysis.coverage import settling
from roadproof.analysis.coverage.answers import ClassAnswer, GapScan
from roadproof.analysis.coverage.classes import (
    GapClasses,
    GapGroup,
    GapSurvey,
    Part,
    claims_of,
    exchanged,
    in_either_role,
    missed,
    near_miss,
    numbers_on,
    sectors_of,
    starts,
)
from roadproof.analysis.coverage.found import Need
from roadproof.analysis.coverage.settling import ClassGroup
from roadproof.analysis.coverage.study import Coverage, _with_lost
from roadproof.engines.prove.prover import Result
from roadproof.evidence.certificate import read_certificate_data
from roadproof.library.compose import both, either, in_some_lane, negation
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import LANE, PAIR
from roadproof.logic import formula as f
from roadproof.logic.formula import subformulas
from roadproof.reasons import Why
from roadproof.runtime.budget import BudgetExceeded
from roadproof.verdict import Verdict
from roadproof.world.models import load_road

V = Verdict
HOME = bundled_library().select()
SECTORS = sectors_of(HOME)
PROOF = Path(__file__).parents[2] / "proofs/P4-scenario-03-base.json"
CERTIFICATE: Any = read_certificate_data(json.loads(PROOF.read_text("utf-8")), "proof")
PROVED = Result(verdict=V.PROVED, certificate=CERTIFICATE)
UNKNOWN = Result(verdict=V.UNKNOWN)
GIVEN: Any = SimpleNamespace(file=SimpleNamespace())


def calls(formula: Any) -> set[tuple[str, tuple[str, ...]]]:
    """The definitions that a formula speaks of, with their arguments."""
    found = (x for x in subformulas(formula) if isinstance(x, f.Application))
    return {(x.name, x.arguments) for x in found}


@cache
def classes() -> GapClasses:
    return GapClasses(Basis(HOME))


def test_claims_speak_of_every_scenario_in_both_roles_of_safety_and_of_danger() -> None:
    *claims, last = claims_of(HOME)
    assert len(claims) == len(SECTORS) > 1
    for numbers, claim in zip(SECTORS, claims, strict=True):
        said = calls(claim.formula)
        for number in numbers:
            assert {(f"scenario_{number}", (*x, LANE)) for x in (PAIR, PAIR[::-1])} <= said
        assert {("initSafe", PAIR), ("danger", PAIR), ("atLane", ("SV", LANE))} <= said
        sector = {(f"roadSector_{numbers[0]}", PAIR)}
        [premise] = [
            x for x in f.children(claim.formula) if sector <= calls(x) and not is_conclusion(x, numbers)
        ]
        assert ("initSafe", PAIR) in calls(premise)
    said = calls(last.formula)
    assert {(f"roadSector_{numbers[0]}", PAIR) for numbers in SECTORS} <= said


def is_conclusion(formula: Any, numbers: tuple[int, ...]) -> bool:
    return (f"scenario_{numbers[0]}", (*PAIR, LANE)) in calls(formula)


def test_a_gap_is_missed_by_all_scenarios_in_either_role() -> None:
    numbers = SECTORS[0]
    assert len(in_either_role(HOME, numbers)) == 2 * len(numbers)
    assert len({x.text for x in in_either_role(HOME, numbers)}) == 2 * len(numbers)
    said = calls(missed(HOME, numbers).formula)
    assert len({x for x in said if x[0].startswith("scenario_")}) >= 2 * len(numbers)


def test_what_begins_so_that_is_asked_about_is_a_part_of_every_gap() -> None:
    import roadproof as rp
    from roadproof.drivers.restriction import Restriction, files_for
    from roadproof.library.diagnose import checked_library

    wanted = Restriction("unpreventable", "careful", "drives")
    library = checked_library(files_for(rp.load().library.files))
    restricted = library.select("base", wanted.options)
    assert len(starts(restricted)) > len(starts(HOME)) == 2


def test_a_near_miss_is_one_in_either_role() -> None:
    part = classes().parts[0]
    whole = in_some_lane(either(part.without, exchanged(part.without)), LANE)
    assert near_miss(part).formula == whole.formula
    assert exchanged(part.without).formula != part.without.formula


def test_a_road_has_the_scenarios_of_all_its_zones() -> None:
    for name, count in (("main-2", 1), ("merge", 2), ("depart", 2)):
        assert len(numbers_on(load_road(name), HOME, SECTORS)) == sum(map(len, SECTORS[:count])), name


def test_a_part_stands_for_itself_in_every_sector() -> None:
    for part in classes().parts[:6]:
        there = [*classes().counterparts(part)]
        assert [numbers for _, numbers in there] == [*SECTORS]
        assert all(x.scenario in numbers for x, numbers in there)


def test_a_gap_that_is_near_in_a_whole_component_only_has_no_single_condition() -> None:
    coarse = next(x for x in classes().parts if not x.finest)
    fine = next(x for x in classes().parts if x.finest)
    assert classes().has(None, ())
    assert classes().has(None, (coarse.key,))
    assert not classes().has(None, (fine.key,))
    assert classes().has(coarse, (coarse.key,))
    assert not classes().has(fine, (coarse.key,))


# --- one class ---------------------------------------------------------------------------------------


def group(
    monkeypatch: pytest.MonkeyPatch, *results: Any, wider: tuple[str, ...] = ()
) -> tuple[Any, list[str]]:
    """What settles a component, with what the prover answers in turn; and all that it is asked."""
    answers, asked = iter(results), list[str]()

    def prove(basis: Any, query: Any, *_: Any, **__: Any) -> Result:
        asked.append(query.text)
        result = next(answers, UNKNOWN)
        if isinstance(result, Exception):
            raise result
        return result

    monkeypatch.setattr(Basis, "proof_of", prove)
    component = classes().parts[0]
    survey = GapSurvey(Basis(HOME), wider, (load_road("main-2"),))
    trials: Any = SimpleNamespace(first=lambda _: "", smallest=lambda _: ())
    return ClassGroup(survey, GapGroup(component), [], classes(), trials), asked


@pytest.mark.parametrize("no_condition", [False, True])
def test_a_class_is_empty_where_all_sectors_are_proved_together(
    no_condition: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, asked = group(monkeypatch, PROVED, PROVED)
    part: Part | None = None if no_condition else made.group.component
    claims = made._all_are_near() if part is None else made._is_redundant(part)
    assert len(claims) == len(SECTORS)
    answer = made._prove(part, 2.0)
    assert asked == [claims[0].text, both(*claims).text]
    assert (answer.verdict, answer.certificate) == (V.IMPOSSIBLE, CERTIFICATE)
    assert answer.claim.formula == both(*claims).formula
    lost, _ = group(monkeypatch, PROVED, UNKNOWN)
    assert lost._prove(part, 2.0) is None


def test_near_misses_that_are_no_gaps_are_so_in_both_roles_and_all_sectors(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made, _ = group(monkeypatch)
    claims = made._no_gaps(made.group.component)
    assert len({x.text for x in claims}) == 2 * len(SECTORS)
    near = {*subformulas(made._all_are_near()[0].formula)}
    for part in made._finest(SECTORS[0]):
        assert {part.without.formula, exchanged(part.without).formula} <= near


@pytest.mark.parametrize("outcome", ["none", "late", "no search"])
def test_a_class_of_which_nothing_is_found_is_in_doubt(outcome: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from roadproof.errors import UsageError

    def ask(_: Any) -> Any:
        if outcome == "late":
            raise BudgetExceeded(3.0)
        if outcome == "no search":
            raise UsageError("dt is too fine")
        return SimpleNamespace(drives=(), reason=Why.NO_DRIVE())

    monkeypatch.setattr(settling, "ask", ask)
    made, _ = group(monkeypatch)
    for part in (made.group.component, None):
        answer = made._answer(part)
        assert (answer.verdict, answer.gaps, answer.certificate) == (V.UNKNOWN, (), None)
        assert {"none": "no drive", "late": "--timeout", "no search": "dt is too fine"}[
            outcome
        ] in answer.reason


def test_what_a_gap_of_a_class_satisfies(monkeypatch: pytest.MonkeyPatch) -> None:
    made, _ = group(monkeypatch, wider=("extA", "ext"))
    numbers = SECTORS[0]
    plain, first, second = (made._query(made.group.component, numbers, x) for x in ("", "extA", "ext"))
    assert calls(plain.formula) < calls(first.formula)
    caught = {x: settling.caught(HOME, numbers, x) for x in ("extA", "ext")}
    assert caught["extA"].formula in subformulas(first.formula)
    assert negation(caught["extA"]).formula in subformulas(second.formula)
    assert negation(caught["extA"]).formula not in subformulas(first.formula)
    alone = made._query(None, numbers)
    for part in made._finest(numbers):
        assert negation(near_miss(part)).formula in subformulas(alone.formula)


# --- answers that are kept -----------------------------------------------------------------------------


def test_only_answers_with_evidence_are_sure() -> None:
    study = Coverage(GapSurvey(Basis(HOME)))
    query: Any = SimpleNamespace(text="q")
    doubt, empty = (ClassAnswer(None, verdict=x) for x in (V.UNKNOWN, V.IMPOSSIBLE))
    made: list[Any] = [
        (ProofResult(query, verdict=V.PROVED, certificate=CERTIFICATE), True),
        (ProofResult(query, verdict=V.UNKNOWN), False),
        (ProofResult(query, verdict=V.REFUTED), False),
        (Need("a", "base", verdict=V.UNKNOWN), False),
        (GapScan(()), False),
        ((empty,), True),
        ((doubt,), False),
        ((empty, doubt), False),
        ((doubt, empty), False),
    ]
    assert [study.is_sure(x) for x, _ in made] == [sure for _, sure in made]
    assert study.is_sure(Need("a", "base", verdict=V.WITNESSED, drive=GIVEN))


def test_one_claim_in_doubt_leaves_the_classes_to_be_asked() -> None:
    survey = GapSurvey(Basis(HOME), (), (load_road("main-2"),))
    study = Coverage(survey, needed=True)
    names = [f"covered-{k}" for k in range(1, len(study.claims) + 1)]
    query: Any = SimpleNamespace(text="q")

    def known(*verdicts: Any) -> Any:
        return {x: ProofResult(query, verdict=v) for x, v in zip(names, verdicts, strict=True)}

    some = known(*[V.PROVED] * (len(names) - 1), V.UNKNOWN)
    assert len(study.pieces(some)) == 7, "simple drives are looked through"
    assert study.classes_in(some)(None) is None
    every = known(*[V.PROVED] * len(names))
    assert not any(type(x).__name__ == "Chunk" for x in study.pieces(every))
    empty = study.classes_in(every)(None)
    assert empty is not None
    assert empty.verdict is V.IMPOSSIBLE
    for piece in study.pieces({}):
        [doubt] = study.doubt(piece, Why.PROCESS("SIGKILL")).values()
        assert doubt.verdict is V.UNKNOWN  # type: ignore[union-attr]
    [scan] = study.doubt(study.pieces(some)[0], Why.PROCESS("SIGKILL")).values()
    assert "SIGKILL" in scan.lost  # type: ignore[union-attr]


def test_drives_that_were_not_looked_through_are_told_of_doubts_only() -> None:
    lost = (Why.NOT_LOOKED_THROUGH("SIGKILL"),)
    doubt = ClassAnswer(None, verdict=V.UNKNOWN, reason=Why.NO_DRIVE())
    assert "SIGKILL" in _with_lost(doubt, lost).reason
    assert _with_lost(doubt, ()) is doubt
    empty = ClassAnswer(None, verdict=V.IMPOSSIBLE)
    assert _with_lost(empty, lost) is empty


def test_keys_and_questions_name_wider_sets_and_roads() -> None:
    roads = {x: load_road(x) for x in ("main-2", "main-3")}
    usual = Coverage(GapSurvey(Basis(HOME), (), (roads["main-2"],)))
    wider = Coverage(GapSurvey(Basis(HOME), ("extA",), (roads["main-2"],)))
    elsewhere = Coverage(GapSurvey(Basis(HOME), (), (roads["main-3"],)))
    assert len({x.key("covered-1") for x in (usual, wider, elsewhere)}) == 3
    assert wider.question.fingerprint != usual.question.fingerprint
