"""The question for which values a formula has a drive, as plain data, with its claims and its view."""

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property
from typing import Any, ClassVar

from roadproof.engines.search.outcome import Search
from roadproof.engines.search.question import SearchOptions, Setting
from roadproof.errors import InputError, UsageError
from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import road_of
from roadproof.extensions.surveys.explore.asking import Explorable, ask_for
from roadproof.extensions.surveys.explore.data import (
    SCHEMA,
    AskedFormula,
    ExploreData,
    Exploring,
    exploration_data,
)
from roadproof.extensions.surveys.explore.values import ExplorationResult, explore
from roadproof.extensions.surveys.extremes.extreme import PROOF
from roadproof.extensions.surveys.extremes.measure import Sense
from roadproof.extensions.surveys.extremes.points import Asking, Remembered
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import Scenario, applied, numbers_of
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Place, Steps, heading_of, seen
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road


@dataclass(frozen=True)
class ExploreView:
    """What was explored, by the names of formulas, in their order."""

    explored: Mapping[str, ExplorationResult]


@dataclass(frozen=True)
class ExploreQuestion:
    """The question for which values there is a drive, and how far measures can go."""

    kind: ClassVar[str] = "explore"
    basis: Basis
    asked: Exploring
    remembered: Remembered = field(default_factory=Remembered, compare=False, repr=False)

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, PROOF, staged=True, moves=False)

    @classmethod
    def of(cls, basis: Basis, asked: object, where: str) -> "ExploreQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        question = cls(basis, read(Exploring, asked, where))
        try:
            searches = [x.search for x in question.named.values()]
        except UsageError as error:
            raise InputError(f"{where}: {error}") from None
        for search in searches:
            if search.scenario is not None and not _is_scenario(search, search.scenario):
                other = f"its formula is another: {search.query.text:.120}"
                raise InputError(f"{where}: scenario={search.scenario}, but {other}")
        return question

    @cached_property
    def explorables(self) -> tuple[Explorable, ...]:
        """What is asked of each formula. Raises ``InputError``, ``UsageError``."""
        return tuple(map(self._explorable, self.asked.formulas))

    def _explorable(self, formula: AskedFormula) -> Explorable:
        asked, place = self.asked, self.asked.place
        home = self.basis.specification.in_set(formula.set)
        setting = Setting(
            self.road,
            dict(place.lanes),
            self.basis.vehicles,
            values=self.basis.all_values(),
            horizon=self.basis.horizon,
            dt=place.dt,
            reach=place.reach,
            collisions=place.collisions,
        )
        options = SearchOptions(
            self.basis.objective, place.engine, place.solver, self.basis.effort, explain=False
        )
        query = read_claim(home, formula.formula)
        search = Search(home, query, setting, options, scenario=formula.scenario)
        measures: list[tuple[Sense, str]] = []
        measures += [] if asked.least is None else [("least", asked.least)]
        measures += [] if asked.greatest is None else [("greatest", asked.greatest)]
        varied = [(x.name, x.low, x.high) for x in asked.vary]
        return ask_for(search, varied, asked.steps, asked.precision, measures, formula.when)

    @cached_property
    def road(self) -> Road | None:
        """The road on which is searched, where one is named."""
        said = self.asked.place.road
        return None if said is None else road_of(said, "road")

    @cached_property
    def named(self) -> dict[str, Explorable]:
        """What is asked, by the names of formulas; what is asked twice is there once."""
        return {_name_of(k, x.search): x for k, x in enumerate(self.explorables, 1)}

    def batches(self, known: Answers) -> list["ExploreBatch"]:
        """A batch for each formula."""
        return [ExploreBatch(self, name) for name in self.named]

    def asking(self, name: str) -> Asking[ExplorationResult]:
        """Ask all of a formula. Raises ``InputError``, ``UsageError``."""
        return explore(name, self.named[name], self.remembered)

    def label(self, name: str) -> str:
        """Return what the claim of a name is about, in words: scenario and values."""
        formula = max((x for x in self.named if x in name), key=len)
        asked, rest = self.named[formula], name.partition(formula)[2].strip("-").split("-")
        number = asked.search.scenario
        words = [] if number is None else [f"scenario {number}"]
        match rest:
            case ["value", place, *_]:
                point = asked.points[int(place) - 1]
                words += [f"{knob.name}={x}" for knob, x in zip(asked.knobs, point, strict=True)]
            case ["at" | "held", *value]:
                words.append(f"{asked.knobs[0].name}={'-'.join(value).replace('_', '/')}")
            case ["least" | "greatest" as sense, *_]:
                words += [f"{x.sense} {x.text}" for x in asked.measures if x.sense == sense]
        return ", ".join(words)

    def view(self, known: Answers) -> ExploreView:
        """Return what is known of each formula."""
        return ExploreView({name: seen(self.asking(name), known) for name in self.named})

    def data(self, view: ExploreView, place: Place, seconds: float) -> ExploreData:
        """Return the view as ``--json`` prints it."""
        varied = {x.name for x in self.asked.vary}
        said: dict[str, Any] = self.basis.said()
        said["parameters"] = {name: x for name, x in said["parameters"].items() if name not in varied}
        explored = (exploration_data(self.named[name], x, place) for name, x in view.explored.items())
        return ExploreData(
            **heading_of(SCHEMA, self.basis),
            **said,
            **ExploreData.of_road(self.road),
            seconds=seconds,
            explored=tuple(explored),
        )


@dataclass(frozen=True)
class ExploreBatch:
    """The claims of one formula."""

    question: ExploreQuestion
    name: str

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        yield from self.question.asking(self.name)


def _is_scenario(search: Search, number: int) -> bool:
    """Return whether a search is for the scenario of a number."""
    home = search.specification
    if number not in numbers_of(home):
        return False
    return applied(home, Scenario(number, home.set_name)).formula == search.query.formula


def _name_of(number: int, search: Search) -> str:
    set_name = search.specification.set_name
    if search.scenario is None:
        return f"formula-{number:02}-{set_name}"
    return f"scenario-{search.scenario:02}-{set_name}"
