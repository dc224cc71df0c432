"""Undecided answers that are stored: those that counted work ended, and never others."""

import ast
import json
import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, reduce
from pathlib import Path
from random import Random
from typing import Any, get_args

import pytest

import roadproof
import roadproof as rp
from questions.decided_claims import Asked
from roadproof.engines.search.batches import Engines
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.answer_files import Cause, OpenVerdict, UndecidedFile, UnknownReportData
from roadproof.evidence.claim import Claim
from roadproof.evidence.ending import Ending, ending_of, ending_of_reason
from roadproof.frontends.api.definitions import load
from roadproof.frontends.api.proofs import claims_question
from roadproof.frontends.cli.main import main
from roadproof.questions.decide import decide_claims
from roadproof.questions.overlap import Meeting, OverlapQuestion
from roadproof.questions.question import EarlierAnswers, Steps
from roadproof.questions.store import Store
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime import archives
from roadproof.runtime.archives import SWITCH
from roadproof.runtime.budget import NO_COST, BudgetExceeded
from roadproof.verdict import Verdict
from shipping.archive import ship
from shipping.questions import texts_of

HARD = "scenario_4(SV,POV,L) -> dangerArises(SV,POV)"
CLAIM = "v_lon(SV) > 2 m/s -> v_lon(SV) > 1 m/s"
QUESTION = claims_question(load(), [CLAIM], None)
# From the machine: the clock, memory, a process, a solver. Written down here a second time, on purpose.
CAUSES_OF_MACHINE = {Cause.CLOCK, Cause.PROCESS, Cause.SOLVER, Cause.CERTIFICATE}
REASONS_OF_MACHINE = {
    *(ReasonKind.CLOCK, ReasonKind.PROCESS, ReasonKind.WORKERS),
    *(ReasonKind.SOLVER_GAVE_UP, ReasonKind.GROUND_QUERY, ReasonKind.UNCONFIRMED),
}
ENGINES = Path(roadproof.__file__).parent / "engines"
NO_ENDINGS = {ReasonKind.TOLD, ReasonKind.CONTRADICTION, ReasonKind.PREMISE}
"""Kinds that engines give with other answers: for limits, for a known cause, for a vacuous claim."""


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache of our own, and nothing that is shipped."""
    monkeypatch.setenv(SWITCH, "on")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(archives, "shipped_folder", lambda _: tmp_path / "shipped")
    archives.shipped_answers.cache_clear()
    yield tmp_path / "cache/roadproof"
    archives.shipped_answers.cache_clear()


@cache
def kinds_in_engines() -> set[ReasonKind]:
    """The kinds of reasons that the source of the engines names."""
    trees = [ast.parse(path.read_text("utf-8")) for path in ENGINES.rglob("*.py")]
    named = {
        x.attr
        for tree in trees
        for x in ast.walk(tree)
        if isinstance(x, ast.Attribute) and isinstance(x.value, ast.Name) and x.value.id == "ReasonKind"
    }
    return {x for x in ReasonKind if x.name in named}


def reason_of(kind: ReasonKind) -> Reason:
    """A reason of a kind with numbers for what its words leave open."""
    return kind(*(1.0 for _ in re.findall(r"\{[^{}]*\}", kind.value)))


def report(cause: Cause) -> UnknownReportData:
    return UnknownReportData(
        cause=cause,
        tried=("proof",),
        effort_helps=False,
        remedy="",
        options=(),
        without_assumptions=False,
        detail="",
    )


GIVEN: dict[str, tuple[Callable[[Claim], ClaimAnswer], bool]] = {
    **{
        f"reason {kind.name}": (
            lambda claim, kind=kind: undecided(claim, reason_of(kind)),
            kind in kinds_in_engines() - NO_ENDINGS - REASONS_OF_MACHINE or kind is ReasonKind.WORK,
        )
        for kind in ReasonKind
    },
    **{
        f"cause {cause}": (
            lambda claim, cause=cause: undecided(claim, ReasonKind.TOLD("words"), report=report(cause)),
            cause not in CAUSES_OF_MACHINE,
        )
        for cause in Cause
    },
    "failed cross-check": (
        lambda claim: undecided(claim, ReasonKind.WORK(1.0), Verdict.CROSSCHECK_FAILED),
        False,
    ),
}
"""Undecided answers, and whether they are stored."""


@pytest.mark.parametrize("place", ["folder", "cache"])
def test_only_what_counted_work_ended_is_not_asked_again(
    place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One question has a claim for each cause, each kind of reason and each verdict."""
    claims = {f"v_lon(SV) > {k + 1} m/s -> v_lon(SV) > {k} m/s": name for k, name in enumerate(GIVEN)}
    question = claims_question(load(), [*claims], None)
    asked: list[str] = []

    def answer_claim(engines: Engines, claim: Claim, *_: Any) -> Any:
        asked.append(claims[claim.text])
        return GIVEN[claims[claim.text]][0](claim), NO_COST

    monkeypatch.setattr(Engines, "answer_claim", answer_claim)
    folder = tmp_path / "out" if place == "folder" else None
    first = decide_claims(question, folder, 1, fresh=folder is not None)
    assert {*asked} == {*GIVEN}
    asked.clear()
    again = decide_claims(question, folder, 1, fresh=folder is not None)
    stored = {name for name, (_, is_stored) in GIVEN.items() if is_stored}
    assert {*asked} == GIVEN.keys() - stored
    assert list(again.origins.values()) == ["cache"] * (len(stored) if folder is None else 0)
    for name, answer in first.answers.items():
        other = again.answers[name]
        assert (answer.verdict, str(answer.reason)) == (other.verdict, str(other.reason))


def test_joined_reasons_stand_where_each_of_them_does() -> None:
    random = Random(0)
    every = sorted(kinds_in_engines() - NO_ENDINGS | REASONS_OF_MACHINE)
    for _ in range(300):
        kinds = random.choices(every, k=random.randint(2, 4))
        reason = reduce(ReasonKind.AND, map(reason_of, kinds))
        assert (ending_of_reason(reason) is Ending.WORK) is REASONS_OF_MACHINE.isdisjoint(kinds)


@pytest.mark.parametrize("kind", sorted(REASONS_OF_MACHINE))
def test_what_depends_on_the_machine_has_an_ending_of_its_own(kind: ReasonKind) -> None:
    assert ending_of_reason(reason_of(kind)) is Ending.MACHINE


def test_words_whose_kind_is_lost_store_nothing() -> None:
    work = ReasonKind.WORK(60.0)
    assert ending_of_reason(ReasonKind.TOLD(str(work))) is Ending.UNSTATED
    assert ending_of_reason(ReasonKind.AND(work, ReasonKind.TOLD("more"))) is Ending.UNSTATED
    assert ending_of_reason(ReasonKind.AND(work, "more")) is Ending.WORK, "words alone are no part"


def test_each_verdict_without_evidence_has_an_ending() -> None:
    for verdict in get_args(OpenVerdict):
        file = UndecidedFile(
            set="base", options={}, claim=CLAIM, verdict=verdict, reason=ReasonKind.TOLD("x")
        )
        within = verdict in (Verdict.NONE_WITHIN, Verdict.PROVED_BOUNDED)
        assert (ending_of(file) is Ending.WORK) is within


@pytest.fixture
def asked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Asked:
    """The claims that engines are asked."""
    return Asked(tmp_path / "notes", monkeypatch, Engines, lambda claim: claim.text)


def prove(effort: float, **more: Any) -> Any:
    return rp.prove(HARD, jobs=1, drive=False, effort=effort, **more)


def test_more_work_asks_again_and_as_much_does_not(asked: Asked) -> None:
    first, again = prove(0.001), prove(0.001)
    assert [str(x.verdict) for x in (first, again)] == ["UNKNOWN", "UNKNOWN"]
    assert first.as_data()["verdicts"][0]["reason"] == again.as_data()["verdicts"][0]["reason"]
    assert asked == [HARD]
    assert prove(0.002).verdict is Verdict.UNKNOWN
    assert asked == [HARD, HARD]
    assert prove(60.0).verdict is Verdict.PROVED
    assert prove(0.001, fresh=True).verdict is Verdict.UNKNOWN
    assert asked == [HARD] * 4


def test_the_clock_stores_nothing(asked: Asked, monkeypatch: pytest.MonkeyPatch) -> None:
    def late(*_: Any, **__: Any) -> None:
        raise BudgetExceeded(1.0)

    with monkeypatch.context() as patch:
        patch.setattr("roadproof.engines.search.decide.prove_claim", late)
        assert prove(60.0).verdict is Verdict.UNKNOWN
    assert prove(60.0).verdict is Verdict.PROVED
    assert asked == [HARD, HARD]


def test_the_clock_after_an_objection_stores_nothing(asked: Asked, monkeypatch: pytest.MonkeyPatch) -> None:
    """A modifier objects to the first drive; then the clock ends the search for another."""
    from roadproof.engines.search import search
    from roadproof.extensions.drivers.objection import Driven

    true_find = search.find_witness

    def find(question: Any, options: Any, unlike: Any = ()) -> Any:
        if unlike:
            raise BudgetExceeded(1.0)
        return true_find(question, options, unlike)

    monkeypatch.setattr(search, "find_witness", find)
    monkeypatch.setattr(Driven, "objection", lambda *_: "no collision, 3 m left")
    found = rp.witness(1, unpreventable="careful", jobs=1)
    [outcome] = found.outcomes
    assert found.verdict is Verdict.UNKNOWN
    assert "no collision, 3 m left" in outcome.reason
    assert "cut off by the clock" in outcome.reason
    first = asked.since()
    rp.witness(1, unpreventable="careful", jobs=1)
    assert asked == first, "it is asked again"


def test_an_undecided_answer_counts_only_after_the_same_answers() -> None:
    """A claim before it may have given the drive or the proof that decides it."""
    question = OverlapQuestion(QUESTION.basis, Meeting(among=(3, 4, 5)))
    store = Store(None, question.kind, question.work)
    batch = question.batches({})[0]
    claims = [x for claims in question.claims.values() for x in claims.values()][:3]
    last = claims[-1]

    def key(*before: tuple[Claim, Reason, Verdict]) -> str:
        earlier = EarlierAnswers(batch)
        for k, (claim, reason, verdict) in enumerate(before):
            earlier.add(str(k), undecided(claim, reason, verdict))
        return store.undecided_key(last, earlier)

    work, none = ReasonKind.WORK(60.0), ReasonKind.NONE_FOUND()
    one, other = claims[0], claims[1]
    keys = [
        key(),
        key((one, work, Verdict.UNKNOWN)),
        key((other, work, Verdict.UNKNOWN)),
        key((one, work, Verdict.NONE_WITHIN)),
        key((one, work, Verdict.UNKNOWN), (other, work, Verdict.UNKNOWN)),
        key((other, work, Verdict.UNKNOWN), (one, work, Verdict.UNKNOWN)),
        store.key(last),
    ]
    assert len({*keys}) == len(keys)
    assert key((one, none, Verdict.UNKNOWN)) == keys[1], "words are no part of the key"


@dataclass(frozen=True)
class SeededBatch:
    """A batch of one claim that has drives."""

    seeds: tuple[Any, ...]
    name: str = "seeded"

    def steps(self) -> Steps:
        yield "claim", next(iter(QUESTION.batches({})[0].steps()))[1]


def test_an_undecided_answer_counts_only_with_the_same_drives_of_its_batch() -> None:
    one, other = (rp.witness(f"v_lon(SV) > {x} m/s", jobs=1).drives[0] for x in (20, 30))
    batches = [QUESTION.batches({})[0], SeededBatch((one,)), SeededBatch((other,)), SeededBatch((other, one))]
    keys = [EarlierAnswers(x).digest() for x in batches]
    assert len({*keys}) == len(keys)
    assert EarlierAnswers(SeededBatch((one,))).digest() == keys[1]


def test_undecided_answers_are_shipped(
    home: Path, tmp_path: Path, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    found = rp.prove(HARD, CLAIM, jobs=1, drive=False, effort=0.001)
    texts = texts_of(found.question, found.found.answers)
    assert [json.loads(x)["schema"] for x in texts.texts.values()] == ["roadproof/undecided/1"] * 2
    shutil.rmtree(home)
    ship(tmp_path / "shipped/known", texts.kind, texts.texts)
    asked.since()
    out = str(tmp_path / "out")
    assert main(["prove", HARD, CLAIM, "--effort", "0.001", "--no-drive", "--out", out]) == 20
    assert asked == []
    assert "2 of 2 answers were known: 2 shipped" in capsys.readouterr().err
    assert main(["prove", HARD, CLAIM, "--effort", "0.001", "--no-drive", "--out", out, "--fresh"]) == 20
    assert asked == [], "the folder has it, too"
    assert main(["check", out]) == 20
    printed = capsys.readouterr().out
    assert "UNKNOWN" in printed
    assert "within 0.001 units of work" in printed
