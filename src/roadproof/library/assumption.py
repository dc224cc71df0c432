"""Assumptions of a claim: their texts, the facts about motion that they stand for, and unused limits."""

import re
from collections.abc import Mapping, Sequence

from roadproof.runtime.records import dataclass

MOTION = "motion"


_VALUE = re.compile(r"\s*\w+\s*=(?!=)", re.ASCII)


SCHEMAS: Mapping[str, tuple[str, ...]] = {
    "at-most": ("left", "right"),
    "below": ("left", "right"),
    "meets": ("left", "right"),
    "leaves": ("inside",),
    "within": ("left", "right", "speed", "time"),
    "after": ("left", "right", "speed", "time"),
    "within-twice": ("left", "right", "speed", "growth", "time"),
    "after-twice": ("left", "right", "speed", "growth", "time"),
}
"""The schemas of motion with the names of their arguments: terms, except for ``inside``, a formula."""


INDUCTIONS: Mapping[str, tuple[str, ...]] = {"steps": ("inside", "low", "high"), "lasts": ("inside", "time")}
"""Schemas that are true on every trace, not only on motions."""


ALL_SCHEMAS: Mapping[str, tuple[str, ...]] = {**SCHEMAS, **INDUCTIONS}


@dataclass(frozen=True)
class Axiom:
    """An instance of a schema: the texts of its arguments, in the order of ``ALL_SCHEMAS``."""

    schema: str
    arguments: tuple[str, ...]

    def named(self) -> dict[str, str]:
        """Return the arguments by name."""
        return dict(zip(ALL_SCHEMAS[self.schema], self.arguments, strict=True))

    @property
    def is_induction(self) -> bool:
        """Return whether the axiom is true on every trace."""
        return self.schema in INDUCTIONS

    def __str__(self) -> str:
        return f"{self.schema}({', '.join(self.arguments)})"


@dataclass(frozen=True)
class Assumption:
    """The assumptions of a claim, and the axioms that a proof uses.

    ``texts``: empty; or motion, then limits, then values of parameters; or values alone. ``axioms``: the
    facts about motion and the inductions that are premises. ``unused``: limits in ``texts`` that the proof
    does not need; every other limit is a premise.
    """

    texts: tuple[str, ...] = ()
    axioms: tuple[Axiom, ...] = ()
    unused: tuple[str, ...] = ()

    @property
    def limits(self) -> tuple[str, ...]:
        """The limits that are premises, in their order in ``texts``."""
        return tuple(x for x in limits_in(self.texts) if x not in self.unused)

    @property
    def facts(self) -> tuple[Axiom, ...]:
        """The facts about motion among the axioms."""
        return tuple(x for x in self.axioms if not x.is_induction)

    @property
    def inductions(self) -> tuple[Axiom, ...]:
        """The inductions over time among the axioms."""
        return tuple(x for x in self.axioms if x.is_induction)

    @property
    def premises(self) -> tuple[str, ...]:
        """All premises as text: limits, then facts such as ``below(s(SV), s(POV))``, then inductions."""
        return (*self.limits, *map(str, (*self.facts, *self.inductions)))


NOTHING = Assumption()


def claim_statement(assumptions: Sequence[str], claim: str) -> str:
    """Return the text of a claim with its assumptions in front; the inverse of ``split_claim``."""
    head = "assuming" if assumes_motion(assumptions) else "at"
    return f"{head} {', '.join(assumptions)}: {claim}" if assumptions else claim


def assumes_motion(assumptions: Sequence[str]) -> bool:
    """Return whether motion is assumed, so that only a drive can refute the claim."""
    return MOTION in assumptions[:1]


def limits_in(assumptions: Sequence[str]) -> tuple[str, ...]:
    """Return the limits among assumptions, without motion and values of parameters."""
    return tuple(x for x in assumptions[assumes_motion(assumptions) :] if not _VALUE.match(x))
