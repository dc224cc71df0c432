"""The questions whose answers come with roadproof, each with its default settings."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import roadproof as rp
from roadproof.analysis.classify.classes import plan_of
from roadproof.analysis.classify.divide import Dividing
from roadproof.analysis.classify.divide import divide as divide_plan
from roadproof.analysis.classify.simulated import SimulatedShares
from roadproof.analysis.study.frame import Study, StudyResult, conduct
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.settings.studies import Classify
from roadproof.library.scenarios import numbers_of
from roadproof.questions.classify.question import question_of

SETS = ("base", "extA", "ext")
MANOEUVRES = ("cut-in", "cut-out", "deceleration")


@dataclass(frozen=True)
class Asked:
    """A study with its answers, as all answers of the API have them."""

    study: Study[Any, Any, Any]
    found: StudyResult[Any, Any]


Ask = Callable[..., Any]


def _dividing() -> Dividing:
    home, given = rp.load(), Classify.of({})
    basis = basis_of(home, given, given.vehicles)
    return Dividing(basis, plan_of(home.alone, numbers_of(home.alone)))


def divide(jobs: int | None = None) -> Asked:
    """The cells of the classes, which ``classify`` and ``catalogue`` begin with."""
    study = _dividing()
    return Asked(study, conduct(study, hands=jobs))


def count_shares(jobs: int | None = None) -> Asked:
    """The shares of the classes in a simulated recording."""
    asked = _dividing()
    division = divide_plan(asked.basis, asked.plan, jobs)
    made = question_of(asked.basis, asked.plan.numbers, division)
    study = SimulatedShares(made.basis, made.classes)
    return Asked(study, conduct(study, hands=1))


def _questions() -> Mapping[str, Ask]:
    found: dict[str, Ask] = {"prove": rp.prove}
    for objective in ("smooth", "mild", "severe"):
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
