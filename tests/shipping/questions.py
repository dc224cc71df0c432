"""The questions whose answers come with roadproof, each with its default settings."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import roadproof as rp
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim
from roadproof.extensions.surveys.classify.division import DivisionQuestion, DivisionSettings
from roadproof.extensions.surveys.classify.question import question_of
from roadproof.extensions.surveys.classify.simulated import shares_key, shares_text, simulated_shares
from roadproof.extensions.surveys.settings import Classify
from roadproof.frontends.api.settings import basis_of
from roadproof.library.scenarios import numbers_of
from roadproof.questions.decide import decide_claims, store_of
from roadproof.questions.question import (
    Answers,
    EarlierAnswers,
    Question,
    QuestionBatch,
    walk_with_earlier,
)
from roadproof.questions.store import Store

SETS = ("base", "extA", "ext")
MANOEUVRES = ("cut-in", "cut-out", "deceleration")


@dataclass(frozen=True)
class Texts:
    """What is shipped for a kind of question: a text for each key."""

    kind: str
    texts: Mapping[str, str]


Ask = Callable[..., Any]


def _dividing() -> DivisionQuestion:
    home, given = rp.load(), Classify.of({})
    basis = basis_of(home, given, given.vehicles)
    return DivisionQuestion(basis, DivisionSettings(scenarios=tuple(numbers_of(home.alone))))


def texts_of(question: Question[Any], answers: Answers) -> Texts:
    """The answers to a question that stand: with evidence, or undecided after counted work."""
    store = Store(None, question.kind, question.work)
    texts: dict[str, str] = {}
    for batch in question.batches(answers):

        def find(
            name: str, claim: Claim, earlier: EarlierAnswers, batch: QuestionBatch = batch
        ) -> ClaimAnswer | None:
            found, own = answers.get(name), store_of(batch, store, name)
            if found is not None and own.stands(found):
                key, text = own.shipped_text(found, earlier)
                texts[key] = text
            return found

        [*walk_with_earlier(batch, find)]
    return Texts(question.kind, texts)


def divide(jobs: int | None = None) -> Texts:
    """The proofs for the cells of the classes, which ``classify`` and ``catalogue`` begin with."""
    question = _dividing()
    return texts_of(question, decide_claims(question, executor=jobs).answers)


def count_shares(jobs: int | None = None) -> Texts:
    """The shares of the classes in a simulated recording."""
    question = _dividing()
    made = question_of(question.basis, question.view(decide_claims(question, executor=jobs).answers))
    shares = simulated_shares(made.basis, made.classes)
    assert not shares.broken
    return Texts("shares", {shares_key(made.basis, made.classes): shares_text(shares)})


def _questions() -> Mapping[str, Ask]:
    found: dict[str, Ask] = {"prove": rp.prove}
    for objective in ("typical", "smooth", "mild", "severe"):
        found[f"witness --objective {objective}"] = lambda x=objective, **more: rp.witness(
            using=rp.load(*SETS), objective=x, **more
        )
    for name in SETS:
        for lanes in ("same", "any"):
            for roles in ("same", "any"):
                found[f"overlap --set {name} --lanes {lanes} --roles {roles}"] = (
                    lambda s=name, x=lanes, y=roles, **more: rp.overlap(
                        using=rp.load(s), lanes=x, roles=y, **more
                    )
                )
        found[f"redundancy --set {name}"] = lambda s=name, **more: rp.redundancy(using=rp.load(s), **more)
        found[f"coverage --set {name}"] = lambda s=name, **more: rp.coverage(using=rp.load(s), **more)
    found["order"] = rp.order
    found["division of classes"] = divide
    found["shares of classes"] = count_shares
    found["classify"] = lambda **more: rp.classify(shares=False, **more)
    for manoeuvre in MANOEUVRES:
        found[f"preventable {manoeuvre}"] = lambda x=manoeuvre, **more: rp.preventable(x, **more)
    return found


QUESTIONS = _questions()
"""By the command that asks the same, each a function of further options."""
