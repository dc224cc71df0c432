"""For which values there is a drive, where that changes, and how far a measure can go."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Unpack

from roadproof.analysis.explore.answer import Explorable, ExplorationResult, Sense, say_nothing
from roadproof.analysis.explore.asking import ask_for
from roadproof.analysis.explore.study import Exploration
from roadproof.analysis.study.pool import Say
from roadproof.engines.search.question import SearchOptions
from roadproof.errors import UsageError
from roadproof.evidence.answers import explore as kept
from roadproof.evidence.kinds import Evidence
from roadproof.frontends.api.answer import Picture, picture
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.phrases import Term
from roadproof.frontends.api.restricting import restricted
from roadproof.frontends.api.settings import searches_of, setting, work_of
from roadproof.frontends.api.studied import StudyAnswers, drawn
from roadproof.frontends.report import explore as report
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.groups import Run
from roadproof.frontends.settings.keywords import ExploreKeywords
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.questions import Explore
from roadproof.library.bind import Number
from roadproof.library.scenario_references import names_scenarios
from roadproof.verdict import ExitCode, Verdict, exit_code
from roadproof.world.road import Road


class Explorations(StudyAnswers[Exploration, ExplorationResult, kept.Record]):
    """What was explored, a formula after the other."""

    pieces = "formulas"

    @property
    def explored(self) -> dict[str, ExplorationResult]:
        """What was found, by the name of the formula."""
        return {name: self.found.answers[name] for name in self.study.named}

    @property
    def _entries(self) -> list[report.Entry]:
        return [*report.entries_of(self.study.named, self.explored)]

    @property
    def verdicts(self) -> dict[str, Verdict]:
        entries = ((name, kind, ", ".join(map(report.show, x.at)), x) for name, kind, x, _ in self._entries)
        return {f"{name}, {kind} {at}": x.verdict for name, kind, at, x in entries}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        return tuple(y for _, _, x, _ in self._entries if (y := x.certificate or x.drive) is not None)

    @property
    def road(self) -> Road | None:
        return self.study.road

    @property
    def exit_code(self) -> ExitCode:
        return exit_code((x, x) for each in self.explored.values() for x in each.verdicts)

    @property
    def _sheet(self) -> Sheet[report.Entry]:
        return report.sheet_of(self._entries)

    def _index(self, records: Mapping[str, kept.Record]) -> kept.Index:
        return self.study.index(records, self.seconds)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """A strip or a map of each formula that was varied."""
        for name, asked in self.study.named.items():
            if self.explored[name].findings:
                yield name, picture(report.draw_exploration(asked, self.explored[name]))

    def files(self, pictures: bool) -> dict[str, bytes]:
        """Pictures of all, and of the drives at boundaries and extremes."""
        named = self.study.named.items() if pictures else ()
        every = (x for name, asked in named for x in report.draw_all(name, asked, self.explored[name]))
        return drawn({file: picture(figure) for file, figure in every})

    def __str__(self) -> str:
        return "\n".join(
            report.as_text(asked, self.explored[name]) for name, asked in self.study.named.items()
        )


@takes(Explore)
def explore(
    *what: What, using: Definitions | None = None, **options: Unpack[ExploreKeywords]
) -> Explorations:
    """For which values of parameters or limits there is a drive, and how far a measure can go.

    ``vary``: least and greatest value by name, ``{"minDanger": (0, 3)}`` or ``{"POV.a_lon.min": (-6, -1)}``,
    one or two. ``least``, ``greatest``: a term, at time 0 or ``when`` a formula holds. ``steps``: values of
    each; ``precision``: width of a bracket, SI units. The rest as for ``witness``. Raises as that does.
    """
    given = Explore.of(options)
    plain = definitions_of(using)
    each = plain.each(what)
    home = restricted(plain, given, what=each)
    vary = given.vary or {}
    for name in {*vary} & {*home.values}:
        raise UsageError(f"{name} is given a value and varied: leave one out")
    asked = explorables(home, each, given, [(name, *ends) for name, ends in vary.items()])
    return explore_all(asked, given)


def explorables(
    home: Definitions, what: Sequence[What], given: Explore, ranges: Sequence[tuple[str, Number, Number]]
) -> Iterator[Explorable]:
    """What is asked of each formula in each spec set, varied over ``ranges``. Raises as ``explore``."""
    work = work_of(given)
    search_options = SearchOptions(engine=given.engine, solver=given.solver, effort=work)
    measures: dict[Sense, Term | None] = {"least": given.least, "greatest": given.greatest}
    wanted = [(sense, str(x)) for sense, x in measures.items() if x is not None]
    when = given.when
    for search in searches_of(home, what, setting(home, given), search_options):
        here = replace(home, specification=search.specification)
        if when is None or (isinstance(when, str) and not names_scenarios(here.specification, when)):
            moment = when or ""
        else:
            moment = here.read(when).text
        yield ask_for(search, ranges, given.steps, given.precision, wanted, moment)


def explore_all(asked: Iterable[Explorable], given: Run, tell: Say | None = None) -> Explorations:
    """As ``explore``, with what is asked as values; ``tell`` is told how far a formula is."""
    study = Exploration(tuple(asked), given.jobs, tell or say_nothing)
    return Explorations.asked(study, given)
