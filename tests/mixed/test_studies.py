"""Studies of which some parts are decided and some are not: changes, searches, classes."""

import json
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import roadproof as rp
from roadproof.engines.search import placing
from roadproof.evidence.answer import ClaimAnswer, RefutingTrace, undecided
from roadproof.evidence.certificate_file import read_certificate_data
from roadproof.evidence.claim import Claim
from roadproof.evidence.codec import write
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.surveys.classify.cells import whole_cell
from roadproof.extensions.surveys.classify.division import DivisionQuestion, DivisionSettings
from roadproof.extensions.surveys.redundancy import Changes, RedundancyQuestion, changes_of
from roadproof.frontends.api.drives import witness_question
from roadproof.frontends.settings.questions import Witness
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.questions.basis import Basis
from roadproof.questions.question import OwnWork, walk_batch
from roadproof.questions.store import Store
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.budget import Work
from roadproof.verdict import Verdict

ROOT = Path(__file__).parents[2]
HOME = bundled_library().select()
BASIS = Basis(HOME)
DRIVE_FILE = load_drive(ROOT / "examples/catalogue/tests/drives/braking.json")
DRIVE: Any = object.__new__(JudgedDrive)
PROOF = ROOT / "proofs/P4-scenario-03-base.json"
CERTIFICATE: Any = read_certificate_data(json.loads(PROOF.read_text("utf-8")), "proof")
V = Verdict


def of(**fields: Any) -> Any:
    return SimpleNamespace(**fields)


# --- changes -----------------------------------------------------------------------------------------

QUESTION = RedundancyQuestion(BASIS, Changes(among=(3,)))
CHANGES = QUESTION.changes(3)
NAMES, CLAIMS = QUESTION.named(3)[0]
TRACE: Any = RefutingTrace(of())


def known(*shown: Any) -> dict[str, ClaimAnswer]:
    """Answers to the claims of the first change; None where one is not asked, or is in doubt."""
    claims = (CLAIMS.equal, CLAIMS.moving, CLAIMS.apart)
    pairs = zip(NAMES, claims, shown, strict=True)
    return {
        name: undecided(x, ReasonKind.TOLD(name)) if y is None else ClaimAnswer(x, y) for name, x, y in pairs
    }


@pytest.mark.parametrize(
    ("equal", "moving", "apart", "verdict"),
    [
        (None, None, None, V.UNKNOWN),
        (None, None, DRIVE, V.REFUTED),
        (None, CERTIFICATE, None, V.PROVED),
        (TRACE, CERTIFICATE, None, V.PROVED),
        (CERTIFICATE, None, None, V.PROVED),
        (TRACE, None, None, V.REFUTED),
        (TRACE, None, DRIVE, V.REFUTED),
        (DRIVE, None, None, V.REFUTED),
    ],
)
def test_a_change_without_proof_drive_and_trace_is_in_doubt(
    equal: Any, moving: Any, apart: Any, verdict: Verdict
) -> None:
    found = QUESTION.view(known(equal, moving, apart)).findings[3][0]
    assert found.verdict is verdict
    assert found.redundant is {V.PROVED: True, V.REFUTED: False, V.UNKNOWN: None}[verdict]
    assert (found.assuming is not None) is (moving is CERTIFICATE)
    shown = next((x for x in (equal, moving, apart) if x in (CERTIFICATE, DRIVE)), equal)
    assert (None if found.shown is None else found.shown.evidence) is shown
    assert (found.reason == "") is (shown in (CERTIFICATE, DRIVE))
    if found.assuming is not None:
        assert found.claim.text.count("->") >= 2, "both ways"


@pytest.mark.parametrize(
    ("shown", "asked"),
    [
        ((CERTIFICATE,), 1),
        ((DRIVE,), 1),
        ((TRACE, CERTIFICATE), 2),
        ((None, CERTIFICATE), 2),
        ((TRACE, None, DRIVE), 3),
        ((None, None, None), 3),
    ],
)
def test_of_a_change_claims_are_asked_until_one_decides(shown: Any, asked: int) -> None:
    [batch] = QUESTION.batches({})
    first = known(*shown, *[None] * (3 - len(shown)))
    names: list[str] = []

    def find(name: str, claim: Claim) -> ClaimAnswer:
        names.append(name)
        return first.get(name) or undecided(claim, ReasonKind.TOLD("none"))

    [*walk_batch(batch, find)]
    assert names[0] == "scenario-03"
    assert [x for x in names if x in NAMES] == [*NAMES[:asked]]
    assert len(names) == len({*names}), "changes that come to the same are asked once"


def test_both_values_of_a_part_are_tried_on_the_side_where_they_matter() -> None:
    by_part: dict[Any, list[Any]] = {}
    for x in CHANGES:
        by_part.setdefault((x.where, x.part), []).append(x)
    for those in by_part.values():
        assert sorted(x.value for x in those) == [False, True] * (len(those) // 2) or len(those) % 2 == 0
        assert {x.value for x in those} == {False, True}
        assert {x.weakens for x in those} == {False, True}
    negated = read_claim(HOME, "not (danger(SV,POV) and aheadOf(SV,POV))")
    inside = [x for x in changes_of(HOME, negated) if x.part.startswith("danger(")]
    assert [(x.value, x.weakens) for x in inside] == [(True, False), (False, True)]


# --- searches for drives, and drives on other roads -----------------------------------------------------


def test_searches_are_told_apart() -> None:
    def key(what: str = "danger(SV,POV)", using: Any = None, **more: Any) -> str:
        asked = witness_question((what,), using or rp.load(), Witness(jobs=1, **more))
        [name] = asked.named
        claims = [asked.claim(x) for x in asked.claim_names(name)]
        return Store(None, asked.kind, asked.work).key(claims[-1])

    usual = key()
    others = [
        key("aheadOf(SV,POV)"),
        key(objective="severe"),
        key(effort=3),
        key(using=rp.load(params={"rho": 2})),
        key(horizon=3),
        key(reach=60),
        key(dt="3/10"),
        key(engine="smt"),
        key(collisions=True),
        *(
            key("fast(SV)", rp.load(specs=[f"def fast(a: vehicle) := v_lon(a) > {k} m/s\n"]))
            for k in (20, 21)
        ),
    ]
    assert usual == key()
    assert len({usual, *others}) == 1 + len(others)


def test_no_further_drive_is_searched_where_none_was_found() -> None:
    question = witness_question(("danger(SV,POV)",), rp.load(), Witness(jobs=1, count=3))
    [batch] = question.batches({})
    steps = batch.steps()
    _, claim = next(steps)
    with pytest.raises(StopIteration):
        steps.send(undecided(claim, ReasonKind.NO_DRIVE()))


def test_a_zone_is_moved_under_each_vehicle() -> None:
    from roadproof.world.models import load_road

    road = load_road("merge")
    ends = {end for x in road.lanelets for end in x.s if end is not None}
    middles = {x.s - x.length / 2 for x in DRIVE_FILE.drive.vehicles.values()}
    moved = [*placing._moved_under(road, DRIVE_FILE.drive)]
    assert len(moved) == len(ends) * len(DRIVE_FILE.drive.vehicles)
    for there in moved:
        assert middles & {end for x in there.lanelets for end in x.s if end is not None}


def test_a_drive_of_another_formula_is_of_no_scenario(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Any] = []
    monkeypatch.setattr(placing, "JudgedDrive", lambda file, library: made.append(file))
    asked = read_claim(HOME, "v_lon(SV) > minSafe*1 m/s^2")
    placing.judge_as(replace(DRIVE_FILE, scenario=4, values={"rho": Fraction(1)}), asked, HOME.library)
    assert (made[0].formula, made[0].scenario) == (asked.text, None)
    assert made[0].values == {"rho": 1, "minSafe": Fraction(3, 5)}


# --- a division of which a part is in doubt ------------------------------------------------------------


DIVISION = DivisionQuestion(BASIS, DivisionSettings(scenarios=(4, 8)))
AXIS = [*(f"axis-0-any-{x}" for x in ("4", "8", "4_8")), *(f"axis-0-only-{x}" for x in ("4", "8"))]
IN_DOUBT = ReasonKind.TOLD("no proof was found")


def doubted(reasons: Mapping[str, Reason], question: DivisionQuestion = DIVISION) -> dict[str, ClaimAnswer]:
    """Doubts about all claims that a division asks; with other reasons, by name."""
    answers: dict[str, ClaimAnswer] = {}

    def find(name: str, claim: Claim) -> ClaimAnswer:
        return answers.setdefault(name, undecided(claim, reasons.get(name, IN_DOUBT)))

    for _ in range(2):
        for batch in question.batches(answers):
            [*walk_batch(batch, find)]
    return answers


def test_a_division_asks_for_short_texts_of_the_cells_that_it_knows() -> None:
    assert [x.name for x in DIVISION.batches({})] == ["axis-0"]
    answers = doubted({})
    assert [x.name for x in DIVISION.batches(answers)] == ["axis-0", "class_4", "class_4_8", "class_8"]
    assert [*answers][:5] == AXIS
    assert {*answers} > {"class_4-denies-8", "class_4-part-8-1", "class_4_8-holds-4", "class_8-denies-4"}
    found = DIVISION.view(answers)
    assert [x.holds for x in found.classes.what[0]] == [(4,), (4, 8), (8,)]
    assert (found.doubts, found.cut_off, found.data.scenarios) == ((), False, (4, 8))
    assert DivisionQuestion.of(BASIS, write(DIVISION.settings), "here") == DIVISION


def test_a_division_in_any_words_asks_which_cells_there_are_alone() -> None:
    quick = replace(DIVISION, settings=DivisionSettings(scenarios=(4, 8), in_few_words=False))
    assert [*doubted({}, quick)] == AXIS
    assert quick.view(doubted({}, quick)).classes == DIVISION.view(doubted({})).classes


def test_claims_of_a_division_have_work_of_their_own() -> None:
    axis, cell, *_ = DIVISION.batches(doubted({}))
    assert not isinstance(axis, OwnWork)
    assert isinstance(cell, OwnWork)
    assert (DIVISION.work.proof, cell.work.proof) == (BASIS.proof, 2.0)


@pytest.mark.parametrize(("reason", "stays"), [(ReasonKind.WORK(3.0), True), (ReasonKind.CLOCK(3.0), False)])
def test_a_proof_that_was_not_found_is_sought_once_with_the_same_work(reason: Reason, stays: bool) -> None:
    """One that the clock has cut off is sought again."""
    [(_, claim)] = walk_batch(DIVISION.batches({})[0], lambda *_: None)
    store = Store(None, DIVISION.kind, DIVISION.work)
    answer = store.exhausted(undecided(claim, reason))
    assert store.stands(answer) is stays
    assert not Store(None, DIVISION.kind, Work(proof=9.0, staged=True)).stands(answer)


@pytest.mark.parametrize("late", [ReasonKind.CLOCK(3.0), ReasonKind.PROCESS("signal 9")])
def test_a_division_in_doubt_says_so(late: Reason) -> None:
    made = DIVISION.view(doubted({"class_4-denies-8": late}))
    about = "whether there is a shorter text for class_4"
    assert [(x.about, x.reason) for x in made.doubts] == [(about, late)]
    assert made.classes.what[0][0] == whole_cell(DIVISION.axes["axis-0"].axis, (4,), (8,))
    for name in AXIS:
        answers = doubted({name: late})
        assert [x.name for x in DIVISION.batches(answers)] == ["axis-0"]
        cut = DIVISION.view(answers)
        assert cut.cut_off
        assert [(x.about, x.reason) for x in cut.doubts] == [("which classes there are", late)]
        assert cut.classes.all() == ()
        assert (cut.data.groups, cut.data.doubts) == ((), cut.doubts)
