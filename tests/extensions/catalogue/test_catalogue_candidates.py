"""Shipped drives as drives of a test, and proofs that share a premise: nothing is said that is not judged."""

from collections.abc import Iterator
from dataclasses import replace

import pytest

import roadproof as rp
from roadproof.engines.search.batches import Engines
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.extensions.catalogue import abstract_claims
from roadproof.extensions.catalogue.candidates import CandidateDrives, candidates
from roadproof.extensions.catalogue.entries import AbstractTest
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.surveys.survey import replay_steps
from roadproof.library.scenarios import name_of
from roadproof.questions.basis import Basis
from roadproof.questions.question import walk_batch
from roadproof.runtime.archives import shipped_answers
from roadproof.runtime.budget import Effort, Work
from roadproof.verdict import Verdict
from roadproof.world.models import load_road, load_vehicle

pytestmark = pytest.mark.usefixtures("searched_once")
SHIPPED = pytest.mark.skipif(not shipped_answers("classify"), reason="no answers of classify are shipped")

HOME = rp.load()
BASIS = Basis(HOME.alone)
NUMBERS = (1, 4, 6, 8)
ASKED = TargetFormulas(HOME.alone, NUMBERS, None, HOME.all_values())
SLOW = "scenario_4(SV,POV,L) and v_lon(SV) >= 14 m/s and v_lon(SV) <= 20 m/s"
"""Shipped drives are faster."""
QUERIES = ASKED.scenarios_of(("SV", "POV"))


def entry(formula: str = SLOW) -> AbstractTest:
    return AbstractTest("T", HOME.read(formula))


@pytest.fixture(scope="module")
def drive() -> JudgedDrive:
    """A drive of the slow test."""
    [found] = rp.witness(SLOW, jobs=1).drives
    return found


def found_for(test: AbstractTest, drive: JudgedDrive, name: str = "scenario_6") -> JudgedDrive | None:
    return CandidateDrives(BASIS, test, drive, ("scenario_4",)).find(name, QUERIES[name])


@SHIPPED
def test_every_class_has_a_shipped_drive() -> None:
    assert len(candidates()) == 91
    shown = {name for x in candidates() for name in x.scenarios}
    assert shown == {name_of(n) for n in range(1, 25)}


@SHIPPED
def test_a_shipped_drive_is_moved_to_the_speed_of_the_test(drive: JudgedDrive) -> None:
    found = found_for(entry(), drive)
    assert found is not None
    assert judge_file(found.file, HOME.library).accepted
    assert found.file.formula == f"({SLOW.replace(',', ', ')}) and scenario_6(SV, POV, L)"
    assert 14 <= found.file.drive.vehicles["SV"].v_lon <= 20


@pytest.mark.parametrize(
    "changed",
    [
        replace(entry(), road=load_road("main-3")),
        replace(entry(), vehicles={"SV": load_vehicle("truck")}),
        entry("scenario_4(SV,POV,L) and v_lon(SV) >= 60 m/s"),
        entry("given M: lane: scenario_4(SV,POV,M)"),
    ],
)
def test_a_drive_that_is_none_of_the_test_is_not_taken(changed: AbstractTest, drive: JudgedDrive) -> None:
    assert found_for(changed, drive) is None


@SHIPPED
def test_a_drive_that_does_not_show_the_scenario_is_not_taken(
    drive: JudgedDrive, monkeypatch: pytest.MonkeyPatch
) -> None:
    wrong = next(x for x in candidates() if x.scenarios == {"scenario_4"})
    lying = replace(wrong, scenarios=frozenset({"scenario_4", "scenario_6"}))
    monkeypatch.setattr("roadproof.extensions.catalogue.candidates.candidates", lambda: (lying,))
    assert found_for(entry(), drive) is None


def relations(without: bool, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[str, str]]:
    def none(drives: CandidateDrives, name: str, query: object) -> None:
        return None

    batch, known = abstract_claims.TestBatch(BASIS, ASKED, entry()), dict[str, ClaimAnswer]()
    engines = Engines(Work(Effort(), 3.0, explain=True))

    def find(name: str, claim: Claim) -> ClaimAnswer:
        known[name] = engines.answer_claim(claim, batch.proposed(name, known))[0]
        return known[name]

    with monkeypatch.context() as patched:
        if without:
            patched.setattr(CandidateDrives, "find", none)
        [*walk_batch(batch, find)]
    for fact in replay_steps(batch.facts(), known):
        assert (fact.drive is None) == (fact.verdict is Verdict.PROVED)
        yield fact.other, fact.relation


def test_a_test_means_the_same_without_shipped_drives(monkeypatch: pytest.MonkeyPatch) -> None:
    said = [*relations(False, monkeypatch)]
    assert said == [*relations(True, monkeypatch)]
    assert {x for _, x in said} == {"runs", "implies", "excludes", "shows"}


def test_a_proposed_drive_is_judged_for_the_claim(drive: JudgedDrive) -> None:
    batch = abstract_claims.TestBatch(BASIS, ASKED, entry())
    engines = Engines(Work(Effort(), 3.0))
    shown = engines.answer_claim(batch.exists(QUERIES["scenario_4"]), [drive])[0]
    assert shown.drive is not None
    assert shown.drive.file.drive == drive.file.drive
    never = batch.exists(HOME.read("scenario_1(SV,POV,L) and scenario_4(SV,POV,L)"))
    assert engines.answer_claim(never, [drive])[0].verdict is Verdict.IMPOSSIBLE
