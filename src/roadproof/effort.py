"""How much work an answer may cost: counted, so that the same question has the same answer on every machine.

One unit is about a second of a solver on the machine of docs/performance.md; each solver's own count
(z3's resource limit, HiGHS' nodes) is converted where the solver lives. Wall clock is a backstop for
the case that counting fails; an answer that it cut short says so.
"""

import math
import time
from dataclasses import dataclass, field

# Wall-clock seconds that a unit of work may take before the backstop ends it, and the least backstop.
SECONDS_A_UNIT = 20.0
LEAST_BACKSTOP = 120.0


@dataclass
class Meter:
    """The work left for one question: ``limit`` units in all, ``seconds`` of wall clock as a backstop.

    A part of a question has a meter of its own (``part``), which spends from the whole's as well.
    """

    limit: float
    seconds: float | None = None
    whole: "Meter | None" = None
    spent: float = 0.0
    begun: float = field(default_factory=time.monotonic)

    def left(self, most: float = math.inf) -> float:
        """Units left, at most ``most``; never below 0."""
        above = math.inf if self.whole is None else self.whole.left()
        return max(0.0, min(most, self.limit - self.spent, above))

    def spend(self, units: float) -> None:
        """Count ``units`` here and in the whole."""
        self.spent += units
        if self.whole is not None:
            self.whole.spend(units)

    def part(self, limit: float) -> "Meter":
        """A meter for a part of the question, under the same backstop."""
        return Meter(limit, whole=self)

    def seconds_left(self) -> float:
        """Wall-clock seconds until the backstop, at least a hundredth."""
        if self.whole is not None:
            return self.whole.seconds_left()
        allowed = self.seconds if self.seconds is not None else backstop(self.limit)
        return max(0.01, allowed - (time.monotonic() - self.begun))

    def is_late(self) -> bool:
        """Whether the backstop has passed."""
        return self.seconds_left() <= 0.01

    def is_out(self) -> bool:
        """Whether nothing may be tried any more."""
        return self.left() <= 0 or self.is_late()

    def reason(self) -> str:
        """Why nothing may be tried any more, for an answer that says so."""
        if self.is_late():
            return (
                "cut off by the clock, not by the count of work, so a faster or idle machine may answer: "
                "raise --timeout"
            )
        top = self
        while top.whole is not None and top.whole.left() <= 0:
            top = top.whole
        return f"the work limit of {top.limit:g} is used up; raise --effort"


def backstop(limit: float) -> float:
    """Wall-clock seconds after which an answer with a work limit of ``limit`` units is cut off."""
    return max(LEAST_BACKSTOP, SECONDS_A_UNIT * limit)
