"""``roadproof.explore``: values with a drive, their boundaries, and extremes of a measure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Unpack

from roadproof.engines.setting import Search, SearchOptions
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import road_data
from roadproof.evidence.kinds import Evidence
from roadproof.extensions.surveys.explore.data import (
    ExplorationSettings,
    ExploredFormula,
    SearchSetup,
    VariationRange,
)
from roadproof.extensions.surveys.explore.explorable import explorable_of
from roadproof.extensions.surveys.explore.question import ExploreQuestion, ExploreView
from roadproof.extensions.surveys.explore.values import ExplorationResult
from roadproof.extensions.surveys.extremes.measure import Sense
from roadproof.extensions.surveys.keywords import ExploreKeywords
from roadproof.extensions.surveys.report import explore as report
from roadproof.extensions.surveys.settings import Explore
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.phrases import Term
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.settings import basis_of, searches_of, setting
from roadproof.frontends.report.picture import Picture, drawn, picture
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.bind import Number
from roadproof.library.scenario_references import names_scenarios
from roadproof.verdict import ExitCode, Verdict, exit_code
from roadproof.world.road import Road


class Explorations(QuestionAnswers[ExploreView]):
    """The explorations, one for each formula."""

    question: ExploreQuestion
    pieces = "formulas"

    @property
    def explored(self) -> Mapping[str, ExplorationResult]:
        """The results by the name of the formula."""
        return self.view.explored

    @property
    def _entries(self) -> list[report.Entry]:
        return [*report.entries_of(self.question.named, self.explored)]

    @property
    def verdicts(self) -> dict[str, Verdict]:
        entries = ((name, kind, ", ".join(map(report.show, x.at)), x) for name, kind, x, _ in self._entries)
        return {f"{name}, {kind} {at}": x.verdict for name, kind, at, x in entries}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        return tuple(y for _, _, x, _ in self._entries if (y := x.certificate or x.drive) is not None)

    @property
    def road(self) -> Road | None:
        return self.question.road

    @property
    def exit_code(self) -> ExitCode:
        return exit_code((x, x) for each in self.explored.values() for x in each.verdicts)

    @property
    def _sheet(self) -> Sheet[report.Entry]:
        return report.sheet_of(self._entries)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Yield a strip or a map of each explored formula."""
        for name, explorable in self.question.named.items():
            if self.explored[name].findings:
                yield name, picture(report.draw_exploration(explorable, self.explored[name]))

    def files(self, pictures: bool) -> dict[str, bytes]:
        """Return pictures of all formulas, and of the drives at boundaries and extremes."""
        named = self.question.named.items() if pictures else ()
        every = (
            x for name, explorable in named for x in report.draw_all(name, explorable, self.explored[name])
        )
        return drawn(dict(every))

    def __str__(self) -> str:
        named = self.question.named.items()
        return "\n".join(
            report.as_text(explorable, self.explored[name], self._seconds_of(name))
            for name, explorable in named
        )

    def _seconds_of(self, name: str) -> float | None:
        """Return the seconds that the claims of a formula took; None if they were read from files."""
        if not self.seconds:
            return None
        return sum(cost.seconds for claim, cost in self.found.costs.items() if name in claim)


@takes(Explore)
def explore(
    *what: What, using: Definitions | None = None, **options: Unpack[ExploreKeywords]
) -> Explorations:
    """Find the values of parameters or limits with a drive, and the extremes of a measure.

    ``vary``: least and greatest value by name, ``{"minDanger": (0, 3)}`` or ``{"POV.a_lon.min": (-6, -1)}``,
    one or two. ``least``, ``greatest``: a term, at time 0 or ``when`` a formula holds. ``steps``: values of
    each; ``precision``: width of a bracket, SI units. The rest as for ``witness``. Raises as that does.
    """
    given = Explore.of(options)
    plain = definitions_of(using)
    each = plain.each(what)
    home = given.modified(plain, what=each)
    vary = given.vary or {}
    for name in {*vary} & {*home.values}:
        raise UsageError(f"{name} is given a value and varied: leave one out")
    question = explore_question(home, each, given, [(name, *ends) for name, ends in vary.items()])
    return Explorations.decide(question, given)


def explore_question(
    home: Definitions, what: Sequence[What], given: Explore, ranges: Sequence[tuple[str, Number, Number]]
) -> ExploreQuestion:
    """Return the question about formulas in spec sets, varied over ``ranges``. Raises as ``explore``."""
    place = setting(home, given)
    basis = replace(basis_of(home, given), vehicles=place.vehicles, horizon=place.horizon)
    searches = [*searches_of(home, what, place, SearchOptions(engine=given.engine, solver=given.solver))]
    formulas = tuple(_explored_formula(home, x, given.when) for x in searches)
    measures: dict[Sense, Term | None] = {"least": given.least, "greatest": given.greatest}
    extremes = [(sense, str(x)) for sense, x in measures.items() if x is not None]
    first = explorable_of(searches[0], ranges, given.steps, given.precision, extremes, formulas[0].when)
    settings = ExplorationSettings(
        formulas=formulas,
        vary=tuple(VariationRange(name=x.name, low=x.low, high=x.high) for x in first.variables),
        steps=given.steps,
        precision=first.precision,
        **dict(extremes),
        place=SearchSetup(
            road=None if place.road is None else road_data(place.road),
            lanes=place.lanes,
            dt=place.dt,
            reach=place.reach,
            collisions=place.collisions,
            engine=given.engine,
            solver=given.solver,
        ),
    )
    question = ExploreQuestion(basis, settings)
    _ = question.named
    return question


def _explored_formula(home: Definitions, search: Search, when: What | None) -> ExploredFormula:
    """Return a formula and the moment of measuring, in the notation of its spec set."""
    here = replace(home, specification=search.specification)
    if when is None or (isinstance(when, str) and not names_scenarios(here.specification, when)):
        moment = when or ""
    else:
        moment = here.read(when).text
    return ExploredFormula(
        scenario=search.scenario,
        set=search.specification.set_name,
        formula=search.query.text,
        when=moment,
    )
