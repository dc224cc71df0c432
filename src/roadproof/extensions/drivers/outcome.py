"""The outcome of a test in which a model drives SV: prevented, a collision, or undecided."""

from enum import StrEnum
from typing import assert_never

from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.records import dataclass


class Result(StrEnum):
    """PREVENTED: SV never touches POV before it has passed it. COLLIDES: it does. UNDECIDED: no answer."""

    PREVENTED = "prevented"
    COLLIDES = "collides"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class Outcome:
    """The result of a replay, times in s from the start of the test.

    ``onset``: when SV begins to move otherwise than in the test, None where the model never responds.
    ``gap``: the least distance along the road between SV and the vehicle ahead while their boxes overlap
    across it (m), where nothing collides. ``instant``, ``speed``: when they touch, and how much faster SV
    then is (m/s). ``is_late``: undecided, as they touch later than is looked at.
    """

    result: Result
    onset: float | None = None
    gap: float | None = None
    instant: float | None = None
    speed: float | None = None
    reason: Reason = NO_REASON
    is_late: bool = False


def shown_by_drive(outcome: Outcome, vehicles: tuple[str, ...]) -> str:
    """Return the formula that the drive of an outcome shows; nothing where it is too long to decide.

    ``vehicles``: SV first, the vehicle that it may hit last.
    """
    a, b = vehicles[0], vehicles[-1]
    along = f"s({a}) >= s({b}) - length({b}) and s({b}) >= s({a}) - length({a})"
    touches = f"{along} and d({a}) >= d({b}) - width({b}) and d({b}) >= d({a}) - width({a})"
    past = f"s({a}) - length({a}) > s({b})"
    match outcome.result:
        case Result.COLLIDES:
            return f"not ({past}) U ({touches})"
        case Result.PREVENTED:
            return f"G not ({touches})"
        case Result.UNDECIDED:
            return "" if outcome.is_late else f"not ({touches}) U ({past})"
        case _:
            assert_never(outcome.result)


def faster_text(speed: float) -> str:
    """Return in words how much faster SV is, in m/s.

    >>> faster_text(-8.33)
    '8.33 m/s slower'
    """
    return f"{abs(speed):g} m/s {'slower' if speed < 0 else 'faster'}"
