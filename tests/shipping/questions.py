"""The questions whose answers come with roadproof, each with its default settings."""

from collections.abc import Callable, Mapping
from typing import Any

import roadproof as rp
from roadproof.frontends.api.studied import StudyAnswers

SETS = ("base", "extA", "ext")
MANOEUVRES = ("cut-in", "cut-out", "deceleration")
Ask = Callable[..., StudyAnswers[Any, Any, Any]]


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
    found["classify"] = lambda **more: rp.classify(shares=False, **more)
    for manoeuvre in MANOEUVRES:
        found[f"preventable {manoeuvre}"] = lambda x=manoeuvre, **more: rp.preventable(x, **more)
    return found


QUESTIONS = _questions()
"""By the command that asks the same, each a function of further options."""
