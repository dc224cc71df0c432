"""Questions in the words of the command line, for the analyses that still pass text."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from roadproof.effort import Effort
from roadproof.spec import scenarios
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Library, Specification, load_library
from roadproof.spec.scenarios import Scenario
from roadproof.witness import ask as search
from roadproof.witness.ask import Outcome, Search
from roadproof.witness.question import Means, Question, Setting, pose
from roadproof.world.models import load_road, load_vehicle


@dataclass(frozen=True)
class Request:
    """A question in the words of the command line; ``what`` is a formula.

    ``road`` None takes the reference road with the zones that the formula speaks of; ``vehicles``
    gives models by vehicle, "" for all others, and ``limits`` other limits than the models', such as
    ``{"POV": {"a_lon.min": -2}}`` (``world.vehicle.with_limits``). ``natural``: whether natural drives are
    tried first. ``horizon``, ``dt``: seconds; ``reach``: metres.
    """

    what: str
    set_name: str = "base"
    options: Mapping[str, str] = field(default_factory=dict)
    specs: tuple[Path, ...] = ()
    values: Mapping[str, Fraction] = field(default_factory=dict)
    road: str | None = None
    lanes: Mapping[str, str] = field(default_factory=dict)
    vehicles: Mapping[str, str] = field(default_factory=dict)
    limits: Mapping[str, Mapping[str, Fraction]] = field(default_factory=dict)
    horizon: Fraction = Fraction(6)
    dt: Fraction = Fraction(3, 5)
    reach: Fraction = Fraction(80)
    collisions: bool = False
    natural: bool = True
    count: int = 1
    means: Means = field(default_factory=Means)

    def search(self) -> Search:
        """The search of values that is meant."""
        specification = load_library(self.specs).select(self.set_name, self.options)
        setting = Setting(
            None if self.road is None else load_road(self.road),
            self.lanes,
            {name: load_vehicle(model) for name, model in self.vehicles.items()},
            self.limits,
            self.values,
            self.horizon,
            self.dt,
            self.reach,
            self.collisions,
            self.natural,
        )
        return Search(specification, read_claim(specification, self.what), setting, self.means, self.count)

    def question(self) -> Question:
        """The question with road, vehicles and grid in place. Raises ``UsageError``."""
        search = self.search()
        return pose(search.specification.library, search.query, search.setting)


def ask(request: Request) -> Outcome:
    """Answer a request. Raises ``InputError``, ``UsageError``, ``MissingSolverError``, ``Late``."""
    return search.ask(request.search())


@dataclass(frozen=True)
class Asked:
    """What is asked of every scenario, and within which limits; ``horizon`` in s.

    ``effort`` is for one drive; ``proof``: units of work for a proof before a drive is looked for.
    """

    sets: tuple[str, ...] = ("base",)
    options: Mapping[str, str] = field(default_factory=dict)
    specs: tuple[Path, ...] = ()
    values: Mapping[str, Fraction] = field(default_factory=dict)
    horizon: Fraction = Fraction(6)
    effort: Effort = field(default_factory=Effort)
    proof: float = 3.0

    def load(self) -> tuple[Library, Specification]:
        """The library, and the definitions of the first set."""
        library = load_library(self.specs)
        return library, library.select(self.sets[0], self.options)

    def question(self) -> dict[str, str]:
        """What is asked as texts, without the limits of the search."""
        values = " ".join(f"{name}={value}" for name, value in sorted(self.values.items()))
        return {
            "sets": ",".join(self.sets),
            "options": repr(sorted(self.options.items())),
            "values": values,
        }


def applied(scenario: Scenario, home: Specification, vehicles: Sequence[str], lane: str = "L") -> str:
    """The scenario applied to vehicles and a lane, as text to be read with ``home``."""
    return scenarios.applied(home, scenario, vehicles, lane).text
