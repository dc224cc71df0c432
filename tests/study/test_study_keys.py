"""The keys of answers change with everything that their question depends on, and with nothing else of it.

No engine is asked: each question is stopped before its study is conducted.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.claim import Claim
from roadproof.extensions.surveys.classify.division import DivisionQuestion, DivisionSettings
from roadproof.extensions.surveys.coverage.claims import GapClaims
from roadproof.extensions.surveys.coverage.judges import NeedJudge
from roadproof.library.scenarios import Scenario, apply_scenario
from roadproof.questions.basis import Basis
from roadproof.questions.decide import Decisions
from roadproof.questions.question import OwnWork, walk_batch
from roadproof.questions.store import Store
from roadproof.reasons import ReasonKind
from roadproof.runtime import archives
from roadproof.runtime.archives import SWITCH, shipped_answers
from roadproof.runtime.budget import Effort, Work
from shipping.questions import QUESTIONS
from study.changes import MORE, changes_of
from study.commands import EVERY
from study.stored_question import StoredQuestion
from study.test_keys import LEAF, NEAR

KEYED = tuple(x for x in EVERY if x not in ("evaluate", "compare", "catalogue"))
"""The questions that are studies whose answers all have keys."""
SURVEYS = ("overlap", "order", "redundancy", "coverage", "classify")
SEEN_BY = {
    LEAF: {"prove", "witness", "witness_scenarios", *SURVEYS},
    "text: bar of a set": {"prove", "witness"},
    NEAR: {"prove", "witness", "witness_scenarios", "explore", *SURVEYS},
    "text: paced, which an option replaces": {"prove", "witness", "witness_scenarios", *SURVEYS},
    "text: a value that is declared": {"prove", "witness", "witness_scenarios", "explore", *SURVEYS},
    "text: a bound": {"prove", "witness", "witness_scenarios", "explore", *SURVEYS},
    "text: danger": {"coverage"},
    "param gap": {"witness", "witness_scenarios", "explore", "overlap", "order", "redundancy"},
    "option pace": {"prove", "witness", "witness_scenarios", *SURVEYS},
}
"""By a change the questions whose keys change, at least; other answers may stay known."""
STAYS = {
    LEAF: {"preventable"},
    "text: apart, which nothing uses": {
        "preventable",
        "prove",
        "witness",
        "witness_scenarios",
        "explore",
        *SURVEYS,
    },
    "text: a spare value": {"preventable", "prove", "explore", "overlap", "order", "redundancy", "coverage"},
    "text: bar of a set": {"overlap", "order", "redundancy", "explore"},
    "param spare": {"preventable", "overlap", "order", "redundancy", "coverage"},
}


class Stopped(Exception):
    """Nothing more is to be computed."""


def nothing_known(question: DivisionQuestion, *_: object, **__: object) -> Decisions:
    """No claim of a division is settled: all cells are possible."""
    return Decisions({}, {})


def study_of(name: str, asking: StoredQuestion) -> Any:
    found: list[Any] = []

    def stop(study: Any, *_: object, **__: object) -> None:
        found.append(study)
        raise Stopped

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("roadproof.frontends.api.question_answers.decide_claims", stop)
        patch.setattr("roadproof.extensions.surveys.classify.division.decide_claims", nothing_known)
        with pytest.raises(Stopped):
            EVERY[name][0](asking, True)
    return found[0]


def keys_of(name: str, asking: StoredQuestion) -> dict[str, str]:
    """The key of each answer that the question wants; no archive is divided by anything else here."""
    study = study_of(name, asking)
    return first_keys(study)


def first_keys(question: Any) -> dict[str, str]:
    """The keys of the claims that a question asks first."""
    store = Store(None, question.kind, question.work)
    first = (walk_batch(batch, lambda *_: None) for batch in question.batches({}))
    return {x: store.key(claim) for batch in first for x, claim in batch}


@pytest.fixture(scope="module")
def first() -> dict[str, dict[str, str]]:
    return {name: keys_of(name, StoredQuestion()) for name in KEYED}


@pytest.mark.parametrize(("change", "name"), [(x, y) for x, those in SEEN_BY.items() for y in sorted(those)])
def test_a_change_that_a_question_sees_changes_keys(
    change: str, name: str, first: Mapping[str, Mapping[str, str]]
) -> None:
    now = keys_of(name, changes_of(name)[change](StoredQuestion()))
    assert now.keys() == first[name].keys()
    assert any(now[x] != first[name][x] for x in now)


@pytest.mark.parametrize(("change", "name"), [(x, y) for x, those in STAYS.items() for y in sorted(those)])
def test_a_change_that_a_question_does_not_see_leaves_keys(
    change: str, name: str, first: Mapping[str, Mapping[str, str]]
) -> None:
    assert keys_of(name, changes_of(name)[change](StoredQuestion())) == first[name]


ALIKE = {
    ("preventable", "lemmas"): "lemmas are further answers",
    ("prove", "declared"): "only the claim that mentions a parameter is another",
    ("prove", "expect"): "an expected verdict is compared with the answer",
    ("classify", "shares"): "shares are counted of the answer",
    ("classify", "vehicles"): "proofs about classes are of all vehicles",
    ("classify", "on"): "shares are counted of the answer",
    ("redundancy", "whole"): "changes of single conditions are asked first, and are the same",
}
"""Options by question that leave some keys, and why."""
SHARED = ("explore", "coverage")
"""Questions whose options choose which claims are asked, and leave those as they are that are asked first."""


@pytest.mark.parametrize(
    ("name", "more"),
    [(x, y) for x in KEYED if x not in SHARED for y in MORE[x] if (x, y) not in ALIKE],
)
def test_every_option_of_a_question_changes_its_keys(
    name: str, more: str, first: Mapping[str, Mapping[str, str]]
) -> None:
    now = keys_of(name, changes_of(name)[f"--{more}"](StoredQuestion()))
    assert all(now[x] != first[name].get(x) for x in now)


def test_lemmas_depend_on_the_values_that_they_assume() -> None:
    asked = StoredQuestion(more={"lemmas": True})
    before, after = (keys_of("preventable", replace(asked, params=x)) for x in ({}, {"cc_braking": 4}))
    assert all(before[x] != after[x] for x in before if x in after and "careful" in x)


def test_no_two_answers_of_a_question_have_one_key(first: Mapping[str, Mapping[str, str]]) -> None:
    for keys in first.values():
        assert len({*keys.values()}) == len(keys)


def test_cells_have_keys_of_their_claims() -> None:
    def keys(text: str) -> dict[str, str]:
        basis = Basis(StoredQuestion().edited("v_lon(SV) < 40 m/s", text).using.specification)
        question = DivisionQuestion(basis, DivisionSettings(scenarios=(90, 91)))
        store = Store(None, question.kind, question.work)
        found, answers = dict[str, str](), dict[str, ClaimAnswer]()
        for _ in range(2):
            for batch in question.batches(answers):
                own = batch.work if isinstance(batch, OwnWork) else question.work

                def find(name: str, claim: Claim, work: Work = own) -> ClaimAnswer:
                    found[name] = replace(store, work=work).key(claim)
                    return answers.setdefault(name, undecided(claim, ReasonKind.TOLD("none")))

                [*walk_batch(batch, find)]
        return found

    one, other = keys("v_lon(SV) < 40 m/s"), keys("v_lon(SV) < 39 m/s")
    assert len({x.partition("-")[0] for x in one}) > 1
    assert len({*one.values()}) == len(one)
    assert one.keys() == other.keys()
    assert [x for x in one if one[x] == other[x]] == ["axis-0-any-90"], "which is about no other scenario"


def test_gaps_depend_on_definitions_of_wider_sets() -> None:
    def key(asking: StoredQuestion) -> str:
        claims = GapClaims(Basis(asking.using.specification), ("mine",))
        return claims.judgement_claim(NeedJudge(claims, "danger"), "any").digest()

    assert key(StoredQuestion().edited("v_lon(a) > 5 m/s", "v_lon(a) > 6 m/s")) != key(StoredQuestion())


def test_the_program_is_part_of_keys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(SWITCH, "on")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    archives.remember("key", "{}")
    assert archives.recall("overlap", "key") is not None
    monkeypatch.setattr(archives, "program_digest", lambda: "another program")
    assert archives.recall("overlap", "key") is None


@pytest.mark.parametrize(
    "more",
    [{"horizon": 5}, {"effort": Effort(1)}, {"proof": 1.0}, {"objective": "mild"}, {"values": {"rho": 1}}],
)
def test_limits_of_a_basis_are_part_of_its_keys(more: Mapping[str, Any]) -> None:
    basis = Basis(rp.load().specification)
    query = apply_scenario(basis.specification, Scenario(4, "base"))

    def key(about: Basis) -> str:
        return Store(None, "overlap", about.work).key(about.claim(query))

    assert key(replace(basis, **more)) != key(basis)


NOT_SHIPPED = (
    *("classify", "shares of classes"),
    *(f"coverage --set {x}" for x in ("base", "extA", "ext")),
    *(f"overlap --set extA --lanes any --roles {x}" for x in ("same", "any")),
    *(f"overlap --set ext --lanes {x} --roles {y}" for x in ("same", "any") for y in ("same", "any")),
)
"""Questions that take hours to ask again, of which some answers are missing or none is shipped."""
SHIPPED = [x for x in QUESTIONS if x not in NOT_SHIPPED]


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_archives_have_the_keys_of_their_questions(name: str) -> None:
    """An archive that a question names has an answer to each part of it, under the key of today."""
    found: list[Any] = []

    def stop(study: Any, *_: object, **__: object) -> None:
        found.append(study)
        raise Stopped

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("roadproof.frontends.api.question_answers.decide_claims", stop)
        patch.setattr("shipping.questions.decide_claims", stop)
        with pytest.raises(Stopped):
            QUESTIONS[name](jobs=1)
    [study] = found
    there = shipped_answers(study.kind)
    wanted = {*first_keys(study).values()}
    assert not there or wanted <= {*there}
    assert there or name not in ALWAYS_SHIPPED


ALWAYS_SHIPPED = (
    *("prove", "order", "division of classes", "redundancy --set base"),
    *(f"witness --objective {x}" for x in ("typical", "smooth", "mild", "severe")),
    *(f"overlap --set {x} --lanes same --roles same" for x in ("base", "extA")),
)
