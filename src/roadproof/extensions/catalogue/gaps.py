"""Classes of gaps of the scenarios of a catalogue: those of ``coverage``, with names.

A gap is a drive from safety into danger on which no scenario between two vehicles holds, in any lane and any
roles. Its class says why: each scenario fails for one part alone, or for several.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.drivers.restriction import restriction_of
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, GapSurvey, is_covered
from roadproof.extensions.surveys.coverage.claims import group_name
from roadproof.extensions.surveys.coverage.classes import GapClasses, ScenarioPart, sectors_of, with_only
from roadproof.extensions.surveys.coverage.question import CoverageQuestion, gaps_of
from roadproof.extensions.traffic import scenario_parts
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.library import scenarios as scenario_library
from roadproof.library.bind import bind
from roadproof.library.sector_twins import sector_twins
from roadproof.library.specification import Specification
from roadproof.library.words import words_by_number
from roadproof.questions.basis import Basis
from roadproof.semantics.sampled.compiled import compile
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.models import load_road

PREFIX = "gap_"
NO_SINGLE = f"{PREFIX}no_single_condition"
ROADS = ("main-2", "main-3")
EFFORT = 10.0
"""The most units of work for a search for one gap, after the simple drives."""


@dataclass(frozen=True)
class NamedGapClasses:
    """The classes of gaps of the scenarios ``numbers``, with names and titles."""

    basis: Basis
    numbers: tuple[int, ...]

    @cached_property
    def classes(self) -> GapClasses:
        """The classes for the judge."""
        only = with_only(self.basis.specification, self.numbers)
        return GapClasses(replace(self.basis, specification=only, sets=()))

    @cached_property
    def parts(self) -> Mapping[str, ScenarioPart | None]:
        """The part to blame by the name of a class; None for the class of gaps without a single one."""
        parts: dict[str, ScenarioPart | None] = {}
        for group in self.classes.groups():
            for k, part in enumerate(group.parts):
                parts[NO_SINGLE if part is None else _name(part, k)] = part
        return parts

    @cached_property
    def titles(self) -> Mapping[str, str]:
        """The title of each class of gaps, by name."""
        scenarios = words_by_number(self.basis.specification, self.numbers)
        titles = {}
        for name, part in self.parts.items():
            if part is None:
                titles[name] = "danger outside all scenarios, and no single condition is to blame"
            else:
                what = part.condition or f"{part.component} ({part.description})"
                titles[name] = f"as {part.scenario} {scenarios[part.scenario].title}, but not {what}"
        return titles

    def question(self, shown: Collection[str]) -> CoverageQuestion:
        """Return the question for a drive of each class that is not ``shown``, or a proof that it is empty.

        Each class is asked about with all others of its component.
        """
        parts = {part for name, part in self.parts.items() if name not in shown}
        groups = frozenset(group_name(x) for x in self.classes.groups() if parts & {*x.parts})
        if groups not in self._questions:
            effort, roads = self.basis.effort, tuple(map(load_road, ROADS))
            basis = replace(self.basis, sets=(), effort=effort.with_units(min(effort.units, EFFORT)))
            self._questions[groups] = CoverageQuestion(basis, gaps_of((), roads), groups, self.numbers)
        return self._questions[groups]

    @cached_property
    def _questions(self) -> dict[frozenset[str], CoverageQuestion]:
        """The questions made so far, by the groups of their classes."""
        return {}

    def answers(self, survey: GapSurvey) -> Mapping[str, ClassAnswer | None]:
        """Return the answer about each class by name, None for those outside the question.

        All classes are empty where it is proved that no gap exists.
        """
        if is_covered(survey.claims):
            return {name: ClassAnswer(x, verdict=Verdict.IMPOSSIBLE) for name, x in self.parts.items()}
        by_part = {x.part and x.part.key: x for x in survey.classes}
        return {name: by_part.get(part and part.key) for name, part in self.parts.items()}

    def of_drive(self, file: DriveFile, pair: Sequence[str]) -> tuple[str, ...]:
        """Return the classes of a gap between the two vehicles ``pair`` of a drive."""
        motions = {
            role: file.drive.vehicles[name] for role, name in zip(scenario_library.PAIR, pair, strict=True)
        }
        keys = {*self.classes.of(replace(file, drive=Drive(motions)))}
        return tuple(name for name, part in self.parts.items() if self.classes.has(part, keys))

    def of_trace(self, trace: OneTrace, sample: int) -> tuple[str, ...]:
        """Return the classes of a gap of SV and POV from a sample on, on every continuation; else none."""
        numbers = self.classes.numbers_on(trace.road)
        gap = bind(self.classes.gap_formula(numbers).formula, trace.road, {}, self.classes.values)
        formulas = {"": gap, **self.classes.bind(trace.road)}
        answers = compile(formulas).evaluate(trace.batch, "truncated", at="all").answers
        if not answers[""].true[sample, 0]:
            return ()
        keys = {key for key, answer in answers.items() if key and answer.true[sample, 0]}
        none = all(answers[key].false[sample, 0] for key in self.classes.finest)
        return tuple(n for n, part in self.parts.items() if (none if part is None else part.key in keys))


def _name(part: ScenarioPart, place: int) -> str:
    return f"{PREFIX}{part.component}_{place}" if part.condition else f"{PREFIX}{part.component}"


def named_gap_classes(basis: Basis, numbers: Sequence[int]) -> NamedGapClasses:
    """Return the classes of gaps of these scenarios. Raises ``UsageError`` where gaps have no classes."""
    fault = next(_faults(basis.specification, numbers), "")
    if fault:
        raise UsageError(f"classes of gaps: {fault}")
    return NamedGapClasses(basis, tuple(numbers))


def _faults(home: Specification, numbers: Sequence[int]) -> Iterator[str]:
    """Yield why gaps of these scenarios have no classes."""
    if restriction_of(home.options) is not None:
        yield "a driver model says how scenarios begin; coverage asks which drives that begin so are in none"
        return
    two = [
        n
        for n in numbers
        if len(scenario_library.vehicles_of(home, scenario_library.Scenario(n, home.set_name)))
        == len(scenario_library.PAIR)
    ]
    if not two:
        yield "none of the scenarios is between two vehicles"
    for number in two:
        if not scenario_parts.follows_template(home, number):
            name, template = scenario_library.name_of(number), scenario_parts.TEMPLATE
            yield f"{name} does not follow the template {template}; leave it out with --among"
            return
    twins = sector_twins(home)
    sectors = sectors_of(with_only(home, numbers))
    rows = {tuple(sorted({twins[n] for n in sector})) for sector in sectors}
    if len(rows) > 1:
        listed = ", ".join(map(str, two))
        yield (
            f"scenarios {listed} do not have the same disturbances in each road sector; name whole rows of "
            "the table, such as 1-8, 9-16 or 1-24"
        )
