"""Pairs of scenarios with several readings: one proved beside one that is not, one in doubt among others."""

from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from roadproof.engines.search import batches
from roadproof.engines.search.batches import Engines
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.certificate_file import read_certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.compose import both, negation
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.logic.parts import parts_of
from roadproof.questions.basis import Basis
from roadproof.questions.decide import decide_claims
from roadproof.questions.overlap import Meeting, OverlapQuestion, PairVerdict, conjunctions, name_of
from roadproof.questions.question import walk_batch
from roadproof.reasons import ReasonKind
from roadproof.runtime.budget import BudgetExceeded
from roadproof.verdict import Verdict

V = Verdict
PROOF = read_certificate(Path(__file__).parents[2] / "proofs/P4-scenario-03-base.json")
HOME = bundled_library().select()
BASIS = Basis(HOME)
ANY_START = Meeting(among=(3, 4), start="any")
QUESTION = OverlapQuestion(BASIS, ANY_START)
READINGS = conjunctions(HOME, *QUESTION.pairs[0], ANY_START)
DRIVE: Any = object.__new__(JudgedDrive)


def answered(claim: Any, verdict: Verdict, reason: str = "") -> ClaimAnswer:
    match verdict:
        case V.WITNESSED:
            return ClaimAnswer(claim, DRIVE)
        case V.IMPOSSIBLE:
            return ClaimAnswer(claim, replace(PROOF, claim=negation(claim.query).text))
        case V.UNKNOWN | V.NONE_WITHIN:
            return undecided(claim, ReasonKind.TOLD(reason or "why"), verdict)
        case _:
            raise AssertionError(verdict)


def seen(verdicts: Any, question: OverlapQuestion = QUESTION) -> PairVerdict:
    """The pair whose readings have these verdicts, None where one is not asked."""
    names = [*question.claims[question.pairs[0]].items()]
    known = {
        name: answered(claim, verdict, f"why-{k}")
        for k, ((name, claim), verdict) in enumerate(zip(names, verdicts, strict=True))
        if verdict is not None
    }
    [pair] = question.view(known).pairs
    return pair


def test_there_are_two_readings() -> None:
    assert len(READINGS) == 2
    assert READINGS[0].formula != READINGS[1].formula


@pytest.mark.parametrize(
    "verdicts", list(product((V.WITNESSED, V.IMPOSSIBLE, V.NONE_WITHIN, V.UNKNOWN, None), repeat=2))
)
def test_a_pair_is_what_its_readings_are_together(verdicts: Any) -> None:
    """One drive shows a pair; only proofs against all readings rule it out; the gravest doubt counts."""
    pair = seen(verdicts)
    known = {V.UNKNOWN if x is None else x for x in verdicts}
    if V.WITNESSED in known:
        expected = V.WITNESSED
    elif known == {V.IMPOSSIBLE}:
        expected = V.IMPOSSIBLE
    else:
        expected = V.UNKNOWN if V.UNKNOWN in known else V.NONE_WITHIN
    assert pair.verdict is expected
    assert (pair.drive is DRIVE) is (expected is V.WITNESSED)
    assert len(pair.evidence) == {V.WITNESSED: 1, V.IMPOSSIBLE: 2}.get(expected, 0)
    assert len(pair.cores) == (2 if expected is V.IMPOSSIBLE else 0)
    for k, verdict in enumerate(verdicts):
        is_doubt = expected in (V.UNKNOWN, V.NONE_WITHIN) and verdict in (V.UNKNOWN, V.NONE_WITHIN)
        assert (f"why-{k}" in pair.reason) is is_doubt


def test_what_is_claimed_of_a_pair() -> None:
    whole = both(*map(negation, READINGS))
    assert seen((V.IMPOSSIBLE, V.IMPOSSIBLE)).query.formula == whole.formula
    assert seen((V.IMPOSSIBLE, V.WITNESSED)).query == READINGS[1]
    assert seen((V.IMPOSSIBLE, V.UNKNOWN)).query.formula == READINGS[1].formula


def test_the_next_reading_is_asked_until_one_holds() -> None:
    [batch] = QUESTION.batches({})
    [(first, claim)] = walk_batch(batch, lambda *_: None)
    for verdict, left in ((V.WITNESSED, 0), (V.IMPOSSIBLE, 1), (V.NONE_WITHIN, 1), (V.UNKNOWN, 1)):
        known = {first: answered(claim, verdict)}
        following = [name for name, _ in walk_batch(batch, lambda name, _, known=known: known.get(name))]
        assert len(following) == left, verdict
        assert first not in following


def test_what_the_clock_cuts_off_is_in_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    def late(*_: Any) -> Any:
        raise BudgetExceeded(3.0)

    monkeypatch.setattr("roadproof.engines.prove.induction.prove_via_opaque_driver", late)
    engines = Engines(QUESTION.work)
    answers = [engines.answer_claim(BASIS.claim(x))[0] for x in READINGS]
    assert [x.verdict for x in answers] == [V.UNKNOWN, V.UNKNOWN]
    assert all("--timeout" in x.reason for x in answers)


def test_parts_that_another_claim_does_not_have_do_not_clash_there(monkeypatch: pytest.MonkeyPatch) -> None:
    [mine] = conjunctions(HOME, Scenario(3, "base"), Scenario(4, "base"), Meeting())
    [other] = conjunctions(HOME, Scenario(5, "base"), Scenario(6, "base"), Meeting())
    asked: list[str] = []

    def note(home: Any, query: Any, effort: Any) -> Any:
        asked.append(query.text)
        raise BudgetExceeded(1.0)

    monkeypatch.setattr("roadproof.engines.prove.induction.prove_via_opaque_driver", note)
    here, there = ([*parts_of(x.formula)] for x in (mine, other))
    foreign = [x for x in there if x not in here]
    assert foreign
    batch = Engines(QUESTION.work)
    for core, is_tried in ((here[:1], True), (foreign, False), ([*here[:1], *foreign], False)):
        batch.clashes[:] = [(negation(batches.conjunction_of(other, core)).formula, PROOF)]
        asked.clear()
        try:
            assert batch.follow(BASIS.claim(mine)) is None
        except BudgetExceeded:
            assert asked
        assert bool(asked) is is_tried


def test_the_claims_of_a_lost_batch_are_asked_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    question = OverlapQuestion(BASIS, Meeting(among=(3, 4, 11, 12)))
    asked: list[list[str]] = []

    def work(job: Any, jobs: Any, hands: Any, lost: Any, *_: Any, **__: Any) -> Any:
        asked.append([x.batch.name for x in jobs if x.batch.name])
        for place, x in enumerate(jobs):
            yield place, lost(x, ReasonKind.PROCESS("SIGKILL"))

    monkeypatch.setattr("roadproof.runtime.pool.work", work)
    found = decide_claims(question, executor=1, fresh=True).answers
    assert len(found) == len(question.pairs)
    assert {x.verdict for x in found.values()} == {V.UNKNOWN}
    assert {x.reason for x in found.values()} == {ReasonKind.PROCESS("SIGKILL")}
    batches, *alone = asked
    assert batches == [x.name for x in question.batches({})]
    assert [len(x) for x in alone] == [1] * len(found), "each by itself"


def test_pairs_across_two_sets_keep_their_order_and_their_names() -> None:
    basis = Basis(HOME, ("base", "ext"))
    question = OverlapQuestion(basis, Meeting(among=(3, 4)))
    expected = [(Scenario(a, "base"), Scenario(b, "ext")) for a, b in product((3, 4), repeat=2)]
    assert [*question.pairs] == expected
    listed = {name: claim for claims in question.claims.values() for name, claim in claims.items()}
    assert sorted(listed) == sorted(name_of(*pair) for pair in expected)
    sets, numbers = ("base", "extA", "ext"), [(3, 4), (4, 3), (3, 3), (11, 12)]
    every = [(Scenario(a, x), Scenario(b, y)) for a, b in numbers for x, y in product(sets, sets)]
    assert len({name_of(a, b) for a, b in every}) == len(every)
    digests = {claim.digest() for claim in listed.values()}
    assert len(digests) == len(expected)
