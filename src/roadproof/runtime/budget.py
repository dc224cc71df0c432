"""How much work an answer may cost: counted, so that the same question has the same answer on every machine.

One unit is about a second of a solver on an idle machine; each solver's own count (z3's resource limit,
HiGHS' iterations and nodes) is converted where the solver lives. Wall clock is a backstop for the case
that counting fails, and what it cuts off is in doubt: ``BudgetExceeded``.
"""

import math
import time
from dataclasses import field, replace
from typing import Self

from roadproof.errors import RoadproofError
from roadproof.reasons import Reason, Why
from roadproof.runtime.records import dataclass

# Wall-clock seconds that a unit of work may take before the backstop ends it, and the least backstop: enough
# for a unit that takes several seconds on a machine with ten times as much to do as it has cores.
SECONDS_A_UNIT = 60.0
LEAST_BACKSTOP = 600.0


class BudgetExceeded(RoadproofError):
    """The backstop has passed: what was asked stays unanswered, whatever was found of it by then."""

    exit_code = 20

    def __init__(self, seconds: float) -> None:
        self.reason = Why.CLOCK(seconds)
        super().__init__(self.reason)
        self.seconds = seconds

    def __reduce__(self) -> tuple[type[Self], tuple[float]]:
        return type(self), (self.seconds,)


@dataclass(frozen=True)
class Effort:
    """What one search may cost: ``units`` of work, and ``timeout`` seconds of wall clock as a backstop.

    Without ``timeout`` the backstop follows from the units. ``begun``: since when the seconds of a
    ``timeout`` run, which several searches share; None where they run from each meter on.
    """

    units: float = 60.0
    timeout: float | None = None
    begun: float | None = field(default=None, repr=False, compare=False)

    def running(self) -> "Effort":
        """The same limits, with the seconds of a ``timeout`` running from now on, if not before."""
        if self.timeout is None or self.begun is not None:
            return self
        return replace(self, begun=time.monotonic())

    def of(self, units: float) -> "Effort":
        """Other units under the same backstop."""
        return replace(self, units=units)

    def meter(self) -> "Budget":
        """A meter that begins to count units now, and seconds too unless they run already."""
        seconds = self.timeout if self.timeout is not None else backstop(self.units)
        begun = time.monotonic() if self.begun is None else self.begun
        return Budget(self.units, seconds, begun=begun)


@dataclass(frozen=True)
class Work:
    """The work for a claim: ``effort`` for a drive, ``proof`` units for a proof before one is looked for.

    ``seek_drive``: whether a drive is looked for that refutes a claim about all traces; ``explain``: whether
    it is shown that there is no drive, where none is found. ``alone``: nothing is taken from other claims;
    ``recast``: whether known drives are tried with their vehicles in other roles; ``once``: whether no drive
    is looked for that was looked for in vain, also on other roads; ``disprove``: whether a proof that there
    is no drive is tried before one is looked for. ``staged``: whether natural drives, others, and that there
    is none are looked for one after the other, with the effort for each. ``moves``: whether drives that are
    known are put on other roads; ``zones``: also on their own with other zones. ``simplify``: whether a drive
    that a search has found is made simpler, and a claim is in doubt for which no search can be set up.
    """

    effort: Effort = field(default_factory=Effort)
    proof: float = 3.0
    seek_drive: bool = False
    explain: bool = False
    alone: bool = False
    recast: bool = False
    once: bool = False
    disprove: bool = True
    staged: bool = False
    moves: bool = True
    zones: bool = False
    simplify: bool = False


@dataclass
class Budget:
    """The work left for one search: ``limit`` units in all, ``seconds`` of wall clock from ``begun``.

    A part of a search has a meter of its own (``part``), which spends from the whole's as well.
    """

    limit: float
    seconds: float
    whole: "Budget | None" = None
    spent: float = 0.0
    begun: float = field(default_factory=lambda: time.monotonic())

    def left(self) -> float:
        """Units left; never below 0."""
        above = math.inf if self.whole is None else self.whole.left()
        return max(0.0, min(self.limit - self.spent, above))

    def spend(self, units: float) -> None:
        """Count ``units`` here and in the whole."""
        self.spent += units
        if self.whole is not None:
            self.whole.spend(units)

    def effort(self) -> Effort:
        """What is left, for a search with a meter of its own. Raises ``BudgetExceeded``."""
        return Effort(max(1.0, self.left()), self.seconds_left())

    def part(self, limit: float) -> "Budget":
        """A meter for a part of the search, of at most ``limit`` units."""
        return Budget(limit, self.seconds, self, begun=self.begun)

    def apart(self, limit: float) -> "Budget":
        """A meter of ``limit`` units of its own, whatever is left of these, under the same backstop."""
        return Budget(limit, self.seconds, begun=self.begun)

    def seconds_left(self) -> float:
        """Wall-clock seconds until the backstop. Raises ``BudgetExceeded``."""
        left = self.seconds - (time.monotonic() - self.begun)
        if left <= 0:
            raise BudgetExceeded(self.seconds)
        return left

    def is_out(self) -> bool:
        """Whether the units are used up. Raises ``BudgetExceeded``."""
        self.seconds_left()
        return self.left() <= 0

    def reason(self) -> Reason:
        """Why there is no answer, where the units are used up."""
        above = self.whole
        if above is not None and above.left() <= 0:
            return above.reason()
        return Why.WORK(self.limit)


def backstop(units: float) -> float:
    """Wall-clock seconds after which a search with a limit of ``units`` is cut off."""
    return max(LEAST_BACKSTOP, SECONDS_A_UNIT * units)
