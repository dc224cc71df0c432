"""Why a claim is undecided, as files and answers say it."""

from enum import StrEnum
from typing import Annotated, Literal, TypeAlias

from roadproof.evidence.codec import Doc
from roadproof.runtime.records import dataclass


class Cause(StrEnum):
    """Why there is no answer."""

    WORK = "work"
    CLOCK = "clock"
    PROCESS = "process"
    SOLVER = "solver"
    PLACE = "place"
    FACTS = "facts"
    CERTIFICATE = "certificate"
    LANES = "lanes"
    INDUCTION = "induction"
    ALTERNATION = "alternation"
    FIRST_INSTANT = "first-instant"
    SECOND_ORDER = "second-order"


Tried: TypeAlias = Literal["proof", "traces", "drives"]


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """Of an UNKNOWN: its cause, what was tried, and the options that help."""

    cause: Cause
    tried: tuple[Tried, ...]
    effort_helps: Annotated[bool, Doc("Whether a higher --effort or --timeout can change the answer.")]
    remedy: Annotated[str, Doc("What helps, as an imperative; empty where no option is known to help.")]
    options: Annotated[tuple[str, ...], Doc("Options of the command that follow the remedy.")]
    without_assumptions: Annotated[
        bool, Doc("Whether the remedy is to ask the claim without what it is assumed under.")
    ]
    detail: Annotated[str, Doc("What a solver or process said; else empty.")]
