"""Checks that a driver model, put into a drive of a restricted search, ends as the restriction says.

A restriction (``prevention.spec``) is a formula of the first state, from which the other vehicle goes on as
it begins. The drive that is found has its own motion, which may decide otherwise, so a drive counts only
where the model in place of SV does what is asked for.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.engines.search.question import FoundDrive, SearchProblem
from roadproof.engines.setting import Search
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.models import course_in
from roadproof.extensions.drivers.outcome import Outcome, Result, faster_text
from roadproof.extensions.drivers.replay import replay
from roadproof.library.bind import bind
from roadproof.library.scenarios import number_in
from roadproof.logic.formula import Application, Formula, subformulas
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import DriveJudge

if TYPE_CHECKING:
    from roadproof.extensions.drivers.restriction import Restriction

_START = Fraction(0)
_WANTED: Mapping[str, Result] = {"unpreventable": Result.COLLIDES, "preventable": Result.PREVENTED}


@dataclass(frozen=True)
class Driven:
    """A driver model in drives of a ``search`` under a ``restriction``, with bound ``problem``."""

    search: Search
    problem: SearchProblem
    restriction: "Restriction"

    def objection(self, candidate: FoundDrive) -> str:
        """Return how the model ends in the drive, where that is not asked for; else nothing."""
        for number, vehicles in self._shown(candidate):
            outcome = self._outcome(candidate, number, vehicles)
            if outcome.result is not _WANTED[self.restriction.side]:
                return _words(outcome)
        return ""

    def _shown(self, candidate: FoundDrive) -> Iterator[tuple[int, tuple[str, ...]]]:
        """Yield the restricted scenarios that the drive shows from its start on, with their vehicles."""
        query, road = self.search.query, self.problem.road
        scenarios: dict[Formula, tuple[int, tuple[str, ...]]] = {}
        for part in subformulas(bind(query.formula, road, candidate.lanes, self.problem.values)):
            if isinstance(part, Application):
                number = number_in(part.name.partition("@")[0])
                if number in self.restriction.scenarios:
                    vehicles = tuple(x for x in part.arguments if x in candidate.drive.vehicles)
                    scenarios[part] = (number, vehicles)
        truths = DriveJudge.on(candidate.drive)
        yield from (x for part, x in scenarios.items() if truths.visit(part).at(_START))

    def _outcome(self, candidate: FoundDrive, number: int, vehicles: tuple[str, ...]) -> Outcome:
        manoeuvre, home = course_in(number), self.search.specification
        assert manoeuvre is not None
        settings = DriverSettings(self.problem.values, home.options)
        model, road = self.restriction.model, self.problem.road
        return replay(candidate.drive, road, vehicles, manoeuvre, model, _START, home, settings).outcome


def _words(outcome: Outcome) -> str:
    match outcome.result:
        case Result.COLLIDES:
            return f"SV touches POV at {outcome.instant:g} s, {faster_text(outcome.speed or 0)}"
        case Result.PREVENTED:
            return "no collision" if outcome.gap is None else f"no collision, {outcome.gap:g} m left"
        case Result.UNDECIDED:
            return outcome.reason
