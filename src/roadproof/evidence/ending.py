"""Says what ended the work on an undecided claim, which decides whether the answer is stored.

Work is counted, so an answer that ended by its count is that of every run and every machine. The clock,
memory, a lost process or a solver that gave up say nothing of the next run: such an answer is never stored.
"""

from collections.abc import Iterable
from enum import StrEnum, unique
from typing import assert_never

from roadproof.evidence.answer_files import Cause, UndecidedFile
from roadproof.reasons import Reason, ReasonKind
from roadproof.verdict import Verdict

_OF_WORK = frozenset(
    {
        ReasonKind.WORK,
        ReasonKind.FEW_LANES,
        ReasonKind.STATE,
        ReasonKind.ELEMENTS,
        ReasonKind.ROUNDS,
        ReasonKind.TRACES,
        ReasonKind.FACTS,
        ReasonKind.NO_CERTIFICATE,
        ReasonKind.LEFT_OPEN,
        ReasonKind.NO_REFUTATION,
        ReasonKind.NO_REFUTATION_SOUGHT,
        ReasonKind.NO_PROOF,
        ReasonKind.NO_STATE,
        ReasonKind.UNREAD,
        ReasonKind.UNREAD_NO_STATE,
        ReasonKind.UNREAD_SAMPLED,
        ReasonKind.NONE_FOUND,
        ReasonKind.BREACH,
        ReasonKind.OVERLAP,
        ReasonKind.BETWEEN_SAMPLES,
        ReasonKind.NEITHER,
        ReasonKind.NO_DRIVE,
        ReasonKind.NO_TREES,
        ReasonKind.NO_DRIVE_ELSEWHERE,
        ReasonKind.NO_SEARCH,
        ReasonKind.FOUND_OVERLAP,
        ReasonKind.FOUND_REJECTED,
        ReasonKind.NOT_DRIVEN,
    }
)
_OF_MACHINE = frozenset(
    {
        ReasonKind.CLOCK,
        ReasonKind.PROCESS,
        ReasonKind.WORKERS,
        ReasonKind.GROUND_QUERY,
        ReasonKind.UNCONFIRMED,
        ReasonKind.SOLVER_GAVE_UP,
    }
)
"""The kinds of reasons that engines give for undecided claims; a test keeps both sets complete."""


@unique
class Ending(StrEnum):
    """The ending of the work on an undecided claim, weakest last."""

    WORK = "work"
    """Counted work, or the last of its attempts: as much work finds no more, on any machine."""
    MACHINE = "machine"
    """The clock, memory, a lost process or a solver that gave up: another run may decide the claim."""
    UNSTATED = "unstated"
    """Anything else: a reason about other things than work, or words whose kind is lost."""


def ending_of(file: UndecidedFile) -> Ending:
    """Return what ended the work on the claim of a file."""
    match file.verdict:
        case Verdict.NONE_WITHIN | Verdict.PROVED_BOUNDED:
            return Ending.WORK
        case Verdict.CROSSCHECK_FAILED:
            return Ending.MACHINE
        case Verdict.UNKNOWN:
            return ending_of_reason(file.reason) if file.doubt is None else ending_of_cause(file.doubt.cause)
        case verdict:
            assert_never(verdict)


def ending_of_cause(cause: Cause) -> Ending:
    """Return what ended a search for a proof and a counterexample with this cause."""
    match cause:
        case (
            Cause.WORK
            | Cause.PLACE
            | Cause.FACTS
            | Cause.LANES
            | Cause.INDUCTION
            | Cause.ALTERNATION
            | Cause.FIRST_INSTANT
            | Cause.SECOND_ORDER
            | Cause.PAST
        ):
            return Ending.WORK
        case Cause.CLOCK | Cause.PROCESS | Cause.SOLVER | Cause.CERTIFICATE:
            return Ending.MACHINE
        case _:
            assert_never(cause)


def ending_of_reason(reason: Reason) -> Ending:
    """Return what ended the work for a reason; the weakest of its parts where it consists of several.

    A kind that no engine gives is ``UNSTATED``, so that its answer is not stored.
    """
    parts = [ending_of_reason(x) for x in reason.values if isinstance(x, Reason)]
    own = [] if reason.kind is ReasonKind.AND else [_ending_of_kind(reason.kind)]
    return _weakest([*own, *parts])


def _weakest(endings: Iterable[Ending]) -> Ending:
    """Return the ending that allows least; ``UNSTATED`` where there is none."""
    order = [*Ending]
    return max(endings, key=order.index, default=Ending.UNSTATED)


def _ending_of_kind(kind: ReasonKind) -> Ending:
    if kind in _OF_WORK:
        return Ending.WORK
    return Ending.MACHINE if kind in _OF_MACHINE else Ending.UNSTATED
