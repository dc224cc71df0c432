"""What becomes of a test in which SV is driven by a model: prevented, a collision, or undecided."""

from enum import StrEnum

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
    then is (m/s).
    """

    result: Result
    onset: float | None = None
    gap: float | None = None
    instant: float | None = None
    speed: float | None = None
    reason: Reason = NO_REASON


def told_faster(speed: float) -> str:
    """Return in words how much faster SV is, in m/s.

    >>> told_faster(-8.33)
    '8.33 m/s slower'
    """
    return f"{abs(speed):g} m/s {'slower' if speed < 0 else 'faster'}"
