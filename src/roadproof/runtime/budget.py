"""Limits of work and its cost; limits are counted, so a question has the same answer on every machine.

One unit is about a second of a solver on an idle machine. Each solver's own count (z3's resource limit,
HiGHS' iterations and nodes) is converted where the solver is called. Wall-clock time is a backstop in case
counting fails; a search that it cuts off raises ``BudgetExceeded``, and its verdict is UNKNOWN.
"""

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from typing import Self

from roadproof.errors import RoadproofError
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.records import dataclass

# Wall-clock seconds that a unit of work may take before the backstop ends it, and the least backstop: enough
# for a unit that takes several seconds on a machine with ten times as much to do as it has cores.
SECONDS_A_UNIT = 60.0
LEAST_BACKSTOP = 600.0


class BudgetExceeded(RoadproofError):
    """The error of a search that the backstop has cut off; partial results are discarded."""

    exit_code = 20

    def __init__(self, seconds: float) -> None:
        self.reason = ReasonKind.CLOCK(seconds)
        super().__init__(self.reason)
        self.seconds = seconds

    def __reduce__(self) -> tuple[type[Self], tuple[float]]:
        return type(self), (self.seconds,)


@dataclass(frozen=True)
class Effort:
    """The limits of one search: ``units`` of work, and ``timeout`` seconds of wall clock as a backstop.

    Without ``timeout`` the backstop follows from the units. ``started``: when the seconds of a ``timeout``
    began, for several searches that share it; None if they begin with each meter.
    """

    units: float = 60.0
    timeout: float | None = None
    started: float | None = field(default=None, repr=False, compare=False)

    def with_clock_started(self) -> "Effort":
        """Return these limits with the ``timeout`` started now, unless it is running already."""
        if self.timeout is None or self.started is not None:
            return self
        return replace(self, started=time.monotonic())

    def with_units(self, units: float) -> "Effort":
        """Return the limits with other units and the same backstop."""
        return replace(self, units=units)

    def meter(self) -> "Budget":
        """Return a meter that starts to count units now, and seconds unless they run already."""
        seconds = self.timeout if self.timeout is not None else backstop(self.units)
        started = time.monotonic() if self.started is None else self.started
        return Budget(self.units, seconds, started=started)


@dataclass(frozen=True)
class Work:
    """Limits and options of the work on one claim.

    ``effort``: for a drive; ``proof``: units for a proof that is tried first. ``seek_drive``: search for a
    drive that refutes a claim about all traces. ``explain``: prove that no drive exists if none is found.
    ``alone``: use no results of other claims. ``recast``: try known drives with exchanged roles. ``once``:
    skip searches that failed before, also on other roads. ``disprove``: first try to prove that no drive
    exists. ``staged``: search for natural drives, then for others, then prove that there are none, each with
    the whole effort. ``moves``: move known drives to other roads; ``zones``: also to other zones.
    ``simplify``: simplify drives that are found, and return UNKNOWN for a claim for which no search can be
    set up.
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
    """A meter of the work left for one search: ``limit`` units, and ``seconds`` of wall clock since
    ``started``.

    A part of a search has a meter of its own (``part``), which counts in the meter of the whole as well.
    """

    limit: float
    seconds: float
    parent: "Budget | None" = None
    spent: float = 0.0
    started: float = field(default_factory=lambda: time.monotonic())

    def left(self) -> float:
        """Return the units left; never below 0."""
        above = math.inf if self.parent is None else self.parent.left()
        return max(0.0, min(self.limit - self.spent, above))

    def spend(self, units: float) -> None:
        """Count ``units`` here and in the whole."""
        self.spent += units
        if self.parent is not None:
            self.parent.spend(units)

    def effort(self) -> Effort:
        """Return the remaining limits, for a search with a meter of its own. Raises ``BudgetExceeded``."""
        return Effort(max(1.0, self.left()), self.seconds_left())

    def part(self, limit: float) -> "Budget":
        """Return a meter for a part of the search, of at most ``limit`` units."""
        return Budget(limit, self.seconds, self, started=self.started)

    def separate(self, limit: float) -> "Budget":
        """Return a separate meter of ``limit`` units under the same backstop; it does not count here."""
        return Budget(limit, self.seconds, started=self.started)

    def seconds_left(self) -> float:
        """Return the wall-clock seconds until the backstop. Raises ``BudgetExceeded``."""
        left = self.seconds - (time.monotonic() - self.started)
        if left <= 0:
            raise BudgetExceeded(self.seconds)
        return left

    def is_exhausted(self) -> bool:
        """Return whether the units are used up. Raises ``BudgetExceeded``."""
        self.seconds_left()
        return self.left() <= 0

    def reason(self) -> Reason:
        """Return the reason for UNKNOWN when the units are used up."""
        above = self.parent
        if above is not None and above.left() <= 0:
            return above.reason()
        return ReasonKind.WORK(self.limit)


def backstop(units: float) -> float:
    """Return the wall-clock seconds after which a search with a limit of ``units`` is cut off."""
    return max(LEAST_BACKSTOP, SECONDS_A_UNIT * units)


@dataclass(frozen=True)
class Cost:
    """Wall-clock seconds, in all and by stage; sizes of the last problem that was solved; units of work."""

    seconds: float = 0.0
    stages: Mapping[str, float] = field(default_factory=dict)
    sizes: Mapping[str, int] = field(default_factory=dict)
    work: float | None = None


NO_COST = Cost()
"""The cost of an answer that was known."""


def sum_of(costs: Sequence[Cost]) -> Cost:
    """Return the sum of several costs; the sizes are those of the first that has any."""
    stages: dict[str, float] = {}
    for cost in costs:
        for name, seconds in cost.stages.items():
            stages[name] = stages.get(name, 0.0) + seconds
    sizes = next((x.sizes for x in costs if x.sizes), {})
    return Cost(sum(x.seconds for x in costs), stages, sizes)
