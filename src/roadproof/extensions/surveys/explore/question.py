"""The question for which values formulas have drives: its settings, claims and view."""

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property
from typing import ClassVar

from roadproof.engines.setting import Search, SearchOptions, Setting
from roadproof.errors import InputError, UsageError
from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import road_of
from roadproof.extensions.surveys.explore.data import (
    SCHEMA,
    ExplorationSettings,
    ExploreData,
    ExploredFormula,
    exploration_data,
)
from roadproof.extensions.surveys.explore.explorable import Explorable, explorable_of
from roadproof.extensions.surveys.explore.values import ExplorationResult, explore
from roadproof.extensions.surveys.extremes.extreme import PROOF
from roadproof.extensions.surveys.extremes.measure import Sense
from roadproof.extensions.surveys.extremes.points import ClaimGenerator, JudgementCache
from roadproof.extensions.surveys.survey import replay_steps
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import Scenario, apply_scenario, numbers_of
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, EvidencePlace, Steps, heading_of
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road


@dataclass(frozen=True)
class ExploreView:
    """The view of explorations by the names of formulas, in their order."""

    explored: Mapping[str, ExplorationResult]


@dataclass(frozen=True)
class ExploreQuestion:
    """The question for which values formulas have drives, and for extremes of measures."""

    kind: ClassVar[str] = "explore"
    basis: Basis
    settings: ExplorationSettings
    remembered: JudgementCache = field(default_factory=JudgementCache, compare=False, repr=False)

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, PROOF, staged=True, moves=False)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "ExploreQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        question = cls(basis, read(ExplorationSettings, settings, where))
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
        """The exploration of each formula. Raises ``InputError``, ``UsageError``."""
        return tuple(map(self._explorable, self.settings.formulas))

    def _explorable(self, formula: ExploredFormula) -> Explorable:
        settings, place = self.settings, self.settings.place
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
        measures += [] if settings.least is None else [("least", settings.least)]
        measures += [] if settings.greatest is None else [("greatest", settings.greatest)]
        varied = [(x.name, x.low, x.high) for x in settings.vary]
        return explorable_of(search, varied, settings.steps, settings.precision, measures, formula.when)

    @cached_property
    def road(self) -> Road | None:
        """The road of the search, if one is named."""
        road = self.settings.place.road
        return None if road is None else road_of(road, "road")

    @cached_property
    def named(self) -> dict[str, Explorable]:
        """The explorations by the names of formulas; a repeated formula occurs once."""
        return {_name_of(k, x.search): x for k, x in enumerate(self.explorables, 1)}

    def batches(self, known: Answers) -> list["ExploreBatch"]:
        """A batch for each formula."""
        return [ExploreBatch(self, name) for name in self.named]

    def steps_of(self, name: str) -> ClaimGenerator[ExplorationResult]:
        """Yield the claims about a formula. Raises ``InputError``, ``UsageError``."""
        return explore(name, self.named[name], self.remembered)

    def label(self, name: str) -> str:
        """Return the scenario and the values that the claim of a name is about, in words."""
        formula = max((x for x in self.named if x in name), key=len)
        explorable, rest = self.named[formula], name.partition(formula)[2].strip("-").split("-")
        number = explorable.search.scenario
        words = [] if number is None else [f"scenario {number}"]
        match rest:
            case ["value", place, *_]:
                point = explorable.points[int(place) - 1]
                words += [
                    f"{variable.name}={x}" for variable, x in zip(explorable.variables, point, strict=True)
                ]
            case ["at" | "held", *value]:
                words.append(f"{explorable.variables[0].name}={'-'.join(value).replace('_', '/')}")
            case ["least" | "greatest" as sense, *_]:
                words += [f"{x.sense} {x.text}" for x in explorable.measures if x.sense == sense]
        return ", ".join(words)

    def view(self, known: Answers) -> ExploreView:
        """Return the results for each formula."""
        return ExploreView({name: replay_steps(self.steps_of(name), known) for name in self.named})

    def data(self, view: ExploreView, place: EvidencePlace, seconds: float) -> ExploreData:
        """Return the view as ``--json`` prints it."""
        varied = {x.name for x in self.settings.vary}
        explored = (exploration_data(self.named[name], x, place) for name, x in view.explored.items())
        return ExploreData(
            **heading_of(SCHEMA, self.basis),
            **self.basis.common_data(varied),
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
        yield from self.question.steps_of(self.name)


def _is_scenario(search: Search, number: int) -> bool:
    """Return whether a search is for the scenario of a number."""
    home = search.specification
    if number not in numbers_of(home):
        return False
    return apply_scenario(home, Scenario(number, home.set_name)).formula == search.query.formula


def _name_of(number: int, search: Search) -> str:
    set_name = search.specification.set_name
    if search.scenario is None:
        return f"formula-{number:02}-{set_name}"
    return f"scenario-{search.scenario:02}-{set_name}"
