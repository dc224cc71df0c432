"""Coverage: what its claims have to say, and classes of gaps of which some are proved, found or in doubt."""

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any, TypeVar

import pytest

from roadproof.engines.search.batches import Engines
from roadproof.errors import InputError
from roadproof.evidence.answer import JudgedTrace, undecided
from roadproof.evidence.answer_codec import answer_data, read_answer
from roadproof.evidence.certificate_file import read_certificate_data
from roadproof.evidence.claim import Claim
from roadproof.evidence.verdict_with_evidence import ProofResult
from roadproof.extensions.catalogue.gaps import named_gap_classes
from roadproof.extensions.surveys.composition import in_some_lane
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, GapSurvey
from roadproof.extensions.surveys.coverage.claims import GapClaims
from roadproof.extensions.surveys.coverage.classes import (
    GapClasses,
    GapGroup,
    ScenarioPart,
    catch_formula,
    claims_of,
    gap_formula,
    in_either_role,
    near_miss,
    numbers_on,
    sectors_of,
    starts,
    swap_roles,
)
from roadproof.extensions.surveys.coverage.gap_drives import GapDrive, SimpleDrives
from roadproof.extensions.surveys.coverage.gap_search import (
    AGAIN,
    LOOK,
    GapRoads,
    GapSearch,
    ask_need,
    work_of,
)
from roadproof.extensions.surveys.coverage.judges import (
    NearMiss,
    NeedJudge,
    NeedJudgement,
    SimpleGap,
    SimpleGaps,
    SimpleJudge,
)
from roadproof.extensions.surveys.coverage.question import CoverageQuestion, gaps_of
from roadproof.extensions.surveys.coverage.simple_drives import simple_drives
from roadproof.extensions.surveys.extremes.points import ClaimGenerator
from roadproof.library.compose import both, either, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import LANE, PAIR
from roadproof.logic import formula as f
from roadproof.logic.formula import subformulas
from roadproof.questions.basis import Basis
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.budget import Effort, Work
from roadproof.semantics.exact.replay import first_overlap
from roadproof.verdict import Verdict
from roadproof.world.models import load_road, load_vehicle

V = Verdict
HOME = bundled_library().select()
SECTORS = sectors_of(HOME)
PROOF = Path(__file__).parents[2] / "proofs/P4-scenario-03-base.json"
CERTIFICATE: Any = read_certificate_data(json.loads(PROOF.read_text("utf-8")), "proof")
T = TypeVar("T")


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
    said = calls(gap_formula(HOME, numbers).formula)
    assert len({x for x in said if x[0].startswith("scenario_")}) >= 2 * len(numbers)


def test_what_begins_so_that_is_asked_about_is_a_part_of_every_gap() -> None:
    import roadproof as rp
    from roadproof.extensions.drivers.restriction import Restriction, files_for
    from roadproof.library.diagnose import checked_library

    wanted = Restriction("unpreventable", "careful", "drives")
    library = checked_library(files_for(rp.load().library.files, "careful"))
    restricted = library.select("base", wanted.options)
    assert len(starts(restricted)) > len(starts(HOME)) == 2


def test_a_near_miss_is_one_in_either_role() -> None:
    part = classes().parts[0]
    whole = in_some_lane(either(part.without, swap_roles(part.without)), LANE)
    assert near_miss(part).formula == whole.formula
    assert swap_roles(part.without).formula != part.without.formula


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

Sent = Callable[[str, Claim], Any]


def asking(wider: tuple[str, ...] = (), lost: tuple[Reason, ...] = ()) -> GapSearch:
    """The claims about one component."""
    claims = GapClaims(Basis(HOME), wider)
    group = GapGroup(classes().parts[0])
    return GapSearch(claims, GapRoads((load_road("main-2"),), ()), group, (), lost)


def answered(steps: ClaimGenerator[T], sent: Sent) -> tuple[T, list[tuple[str, Claim]]]:
    """What answers show, and all claims that are asked with their names."""
    asked: list[tuple[str, Claim]] = []
    try:
        name, claim = next(steps)
        while True:
            asked.append((name, claim))
            name, claim = steps.send(sent(name, claim) or undecided(claim, ReasonKind.NO_DRIVE()))
    except StopIteration as end:
        return end.value, asked


def proof(claim: Claim) -> Any:
    """An answer with a certificate, of which nothing is checked here."""
    return SimpleNamespace(certificate=CERTIFICATE, claim=claim, reason=NO_REASON)


@pytest.mark.parametrize("no_condition", [False, True])
def test_a_class_is_empty_where_all_sectors_are_proved_together(no_condition: bool) -> None:
    made = asking()
    part: ScenarioPart | None = None if no_condition else made.group.component
    claims = made.claims._all_are_near() if part is None else made.claims._is_redundant(part)
    assert len(claims) == len(SECTORS)
    answer, asked = answered(made._prove("a", part, LOOK, set()), lambda _, claim: proof(claim))
    assert [x.text for _, x in asked] == [claims[0].text, both(*claims).text]
    assert [name for name, _ in asked] == [f"{LOOK}-a-1", "empty-a-1"]
    assert answer is not None
    assert (answer.verdict, answer.certificate) == (V.IMPOSSIBLE, CERTIFICATE)
    assert answer.claim is not None
    assert answer.claim.formula == both(*claims).formula
    failed = set[str]()

    def first_only(name: str, claim: Claim) -> Any:
        return proof(claim) if name.startswith(LOOK) else None

    lost, _ = answered(made._prove("a", part, LOOK, failed), first_only)
    assert lost is None
    assert failed
    again, asked = answered(made._prove("a", part, AGAIN, failed), lambda _, claim: proof(claim))
    assert again is None, "what was not proved with as much work is not asked again"
    assert [name for name, _ in asked] == [f"{AGAIN}-a-{k}" for k, _ in enumerate(failed, 1)]


def test_near_misses_that_are_no_gaps_are_so_in_both_roles_and_all_sectors() -> None:
    made = asking().claims
    claims = made._no_gaps(classes().parts[0])
    assert len({x.text for x in claims}) == 2 * len(SECTORS)
    near = {*subformulas(made._all_are_near()[0].formula)}
    for part in made._finest(SECTORS[0]):
        assert {part.without.formula, swap_roles(part.without).formula} <= near


def test_more_work_is_allowed_after_a_search_and_for_all_sectors() -> None:
    claims = GapClaims(Basis(HOME, effort=Effort(8.0)))
    proofs = {x: work_of(f"{x}-a-1", claims).proof for x in (LOOK, AGAIN, "empty", "covered")}
    assert [*proofs.values()] == [2.0, 30.0, 30.0 * len(SECTORS), 60.0]
    units = {x: work_of(f"help-{x}-a-1", claims).effort.units for x in ("sought", "wider")}
    assert units == {"sought": 8.0, "wider": 4.0}
    every = [work_of(f"{x}-a", claims) for x in ("help-sought", "help-wider", "near", "gap")]
    assert [x.simplify for x in every] == [True, True, False, False]
    assert all(x.alone for x in every)


@pytest.mark.parametrize("told", ["no drive was found", "cut off by the clock", "no search: fine"])
def test_a_class_of_which_nothing_is_found_is_in_doubt(told: str) -> None:
    lost = (ReasonKind.NOT_LOOKED_THROUGH("SIGKILL"),)
    made = asking(lost=lost)
    for part in (made.group.component, None):
        steps = made._decide("a", part, (), [])
        answer, asked = answered(steps, lambda _, claim: undecided(claim, ReasonKind.TOLD(told)))
        assert (answer.verdict, answer.gaps, answer.certificate) == (V.UNKNOWN, (), None)
        assert told in answer.reason
        assert answer.reason.count("main-2") == 1
        assert "SIGKILL" in answer.reason
        words = [name.removeprefix("help-").partition("-")[0] for name, _ in asked]
        assert [*dict.fromkeys(words)] == ["look", "sought", "again"]


def test_a_claim_asks_for_a_gap_of_the_class() -> None:
    made = asking(wider=("extA", "ext")).claims
    numbers, part = SECTORS[0], classes().parts[0]
    plain, first, second = (made.query(part, numbers, x) for x in ("", "extA", "ext"))
    assert calls(plain.formula) < calls(first.formula)
    catches = {x: catch_formula(HOME, numbers, x) for x in ("extA", "ext")}
    assert catches["extA"].formula in subformulas(first.formula)
    assert negation(catches["extA"]).formula in subformulas(second.formula)
    assert negation(catches["extA"]).formula not in subformulas(first.formula)
    alone = made.query(None, numbers)
    for fine in made._finest(numbers):
        assert negation(near_miss(fine)).formula in subformulas(alone.formula)


# --- the question --------------------------------------------------------------------------------------


def known(question: CoverageQuestion, *verdicts: Any) -> Any:
    names = question.claims.coverage_claims
    return {x: SimpleNamespace(verdict=v) for x, v in zip(names, verdicts, strict=True)}


def test_one_claim_in_doubt_leaves_the_classes_to_be_asked() -> None:
    question = CoverageQuestion(Basis(HOME), gaps_of((), [load_road("main-2")], needed=True))
    count = len(question.claims.coverage_claims)
    assert [x.name for x in question.batches({})] == [*question.claims.coverage_claims]
    some = known(question, *[V.PROVED] * (count - 1), V.UNKNOWN)
    asked = [x.name for x in question.batches(some)][count:]
    assert asked == [f"help-simple-1-{k}" for k in range(1, 8)], "simple drives are looked through"
    every = known(question, *[V.PROVED] * count)
    assert len(question.batches(every)) == count
    scanned = some | {x: undecided(y, ReasonKind.PROCESS("SIGKILL")) for x, y in question.simple.items()}
    groups = question.batches(scanned)[count + len(question.simple) :]
    assert [x.name for x in groups] == question.groups
    few = replace(question, only=frozenset(question.groups[:2]))
    assert few.groups == question.groups[:2]


def test_classes_of_gaps_by_name_are_asked_about_by_component_and_all_empty_where_there_is_no_gap() -> None:
    kinds = named_gap_classes(Basis(HOME), range(1, 9))
    every, few = kinds.question(()), kinds.question({*kinds.parts} - {"gap_behaviourSV_1"})
    assert few.groups == ["behaviourSV_1"]
    assert few.groups != every.groups == [*every.claims.groups]
    assert kinds.question(kinds.parts).groups == []
    assert few.claims.home is HOME
    assert few.claims.classes.numbers == (1, 3, 4, 5, 6, 7, 8)  # 2 is between three vehicles
    [part] = few.claims.groups["behaviourSV_1"].parts
    found = ClassAnswer(part, verdict=V.UNKNOWN)
    one, two = (ProofResult(read_claim(HOME, "true"), verdict=x) for x in (V.PROVED, V.UNKNOWN))
    some = kinds.answers(GapSurvey((one, two), (found,), ()))
    assert {name: x for name, x in some.items() if x is not None} == {"gap_behaviourSV_1": found}
    assert some.keys() == kinds.parts.keys()
    none = kinds.answers(GapSurvey((one, one), (), ()))
    assert {name: x and x.verdict for name, x in none.items()} == dict.fromkeys(kinds.parts, V.IMPOSSIBLE)


def test_claims_name_wider_sets_roads_and_vehicles() -> None:
    part, roads = classes().parts[0], [load_road(x) for x in ("main-2", "main-3")]
    truck = Basis(HOME, vehicles={"POV": load_vehicle("truck")})
    usual = GapClaims(Basis(HOME))
    sought = [usual.gap_exists(part, x) for x in roads]
    sought += [
        GapClaims(truck).gap_exists(part, roads[0]),
        GapClaims(Basis(HOME), ("extA",)).gap_exists(part, roads[0], "extA"),
    ]
    assert len({x.digest() for x in sought}) == 4
    judged = [x.judgement_claim(NeedJudge(x, "a"), "any") for x in (usual, GapClaims(Basis(HOME), ("extA",)))]
    judged += [usual.judgement_claim(NeedJudge(usual, "a"), "other")]
    assert len({x.digest() for x in judged}) == 3


def test_a_drive_that_is_given_is_no_other_and_nowhere_else() -> None:
    """Whatever a claim gives of a drive, a file with something else of it does not answer the claim."""
    claims, road = GapClaims(Basis(HOME)), load_road("main-2")
    query = read_claim(HOME, "v_lon(SV) > 0 m/s")
    apart = (x for x in simple_drives(road, load_vehicle("car")) if first_overlap(x, Fraction(9)) is None)
    drives = [next(apart), next(apart)]

    def claim(road: Any = road, drive: Any = drives[0], lane: str | None = None, horizon: int = 9) -> Claim:
        return claims.holds_on(query, road, drive, lane, Fraction(horizon))

    answer, _ = Engines(Work()).answer_claim(claim())
    data = answer_data(answer)
    assert answer.verdict is V.WITNESSED
    assert read_answer(claim(), data, "gap.json").verdict is V.WITNESSED
    others = (claim(road=load_road("main-3")), claim(drive=drives[1]), claim(horizon=8), claim(lane="main-1"))
    for other in others:
        with pytest.raises(InputError, match="it is not the drive that is given"):
            read_answer(other, data, "gap.json")


def test_what_a_forged_judgement_names_is_left_out() -> None:
    """Numbers of no drive, scenarios of no class and places that are not tried ask for nothing."""
    claims, road = GapClaims(Basis(HOME)), load_road("main-2")
    judge = SimpleJudge(claims, road, 0, 7)
    forged = SimpleGaps(gaps=tuple(SimpleGap(number=k, first="", classes=()) for k in (-1, 10**6)))
    assert [*judge.drives_of(forged)] == []
    assert not judge.confirms(forged)
    assert judge.confirms(SimpleGaps(gaps=()))
    twice = SimpleGap(number=7, first="", classes=())
    assert not judge.confirms(SimpleGaps(gaps=(twice, twice)))
    made, part = asking(), classes().parts[0]
    drive = next(iter(simple_drives(road, load_vehicle("car"))))
    found = GapDrive(SimpleDrives(road, claims.classes, claims.trials).file(drive), "", (part.key,))
    for scenario, lane in ((99, "main-1"), (None, None), (part.scenario, "nowhere")):
        near = NearMiss(scenario=scenario, turned=False, lane=lane, caught_by=(), elsewhere=())
        sent: Any = SimpleNamespace(evidence=JudgedTrace(near))
        gap, asked = answered(made._gap("a", part, found), lambda name, _, x=sent: x)
        assert gap == ReasonKind.DRIVE_REJECTED()
        assert [name for name, _ in asked] == ["near-a"]


def test_a_definition_is_spare_where_all_is_proved_without_it() -> None:
    claims = GapClaims(Basis(bundled_library().select("complete")))

    for doubtful, verdict in (("none", V.PROVED), ("spare-cutIn-2", V.UNKNOWN)):

        def sent(name: str, claim: Claim, doubtful: str = doubtful) -> Any:
            if name.startswith("help-"):
                return SimpleNamespace(evidence=JudgedTrace(NeedJudgement(drive=None)))
            return None if name == doubtful else proof(claim)

        need, asked = answered(ask_need(claims, "cutIn"), sent)
        assert need.verdict is verdict
        count = 4 if verdict is V.PROVED else 2
        assert [x for x, _ in asked] == ["help-needed-cutIn", *(f"spare-cutIn-{k + 1}" for k in range(count))]
