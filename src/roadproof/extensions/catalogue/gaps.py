"""Gaps of the scenarios that tests are asked about, in the classes of ``coverage``, which have names here.

A gap is a drive from safety into danger on which none of the scenarios between two vehicles holds, for any
lane and in either role. Its classes say why: each scenario fails for one part alone, or for several.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.drivers.restriction import restriction_of
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, Survey, is_covered
from roadproof.extensions.surveys.coverage.claims import group_name
from roadproof.extensions.surveys.coverage.classes import GapClasses, Part, sectors_of, with_only
from roadproof.extensions.surveys.coverage.question import CoverageQuestion, gaps_of
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.library import scenarios as s
from roadproof.library.alike import likes_of
from roadproof.library.bind import bind
from roadproof.library.specification import Specification
from roadproof.library.words import called
from roadproof.questions.basis import Basis
from roadproof.semantics.sampled.compiled import compile
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.models import load_road

PREFIX = "gap_"
NO_SINGLE = f"{PREFIX}no_single_condition"
ROADS = ("main-2", "main-3")
EFFORT = 10.0
"""Most units of work for a search for one gap; the simple drives are looked through before."""


@dataclass(frozen=True)
class GapKinds:
    """The classes of gaps of the scenarios ``numbers``."""

    basis: Basis
    numbers: tuple[int, ...]

    @cached_property
    def classes(self) -> GapClasses:
        """What the judge is asked."""
        only = with_only(self.basis.specification, self.numbers)
        return GapClasses(replace(self.basis, specification=only, sets=()))

    @cached_property
    def parts(self) -> Mapping[str, Part | None]:
        """By the name of a class, the part that is to blame; None for that of gaps with no single one."""
        found: dict[str, Part | None] = {}
        for group in self.classes.groups():
            for k, part in enumerate(group.parts):
                found[NO_SINGLE if part is None else _name(part, k)] = part
        return found

    @cached_property
    def words(self) -> Mapping[str, str]:
        """What a gap of each class is, by name."""
        scenarios = called(self.basis.specification, self.numbers)
        found = {}
        for name, part in self.parts.items():
            if part is None:
                found[name] = "danger outside all scenarios, and no single condition is to blame"
            else:
                what = part.condition or f"{part.component} ({part.description})"
                found[name] = f"as {part.scenario} {scenarios[part.scenario].title}, but not {what}"
        return found

    def question(self, shown: Collection[str]) -> CoverageQuestion:
        """Return the question for a drive of each class that is not ``shown``, or a proof that it is empty.

        Each class is asked about with all others of its component.
        """
        parts = {part for name, part in self.parts.items() if name not in shown}
        wanted = frozenset(group_name(x) for x in self.classes.groups() if parts & {*x.parts})
        if wanted not in self._asked:
            effort, roads = self.basis.effort, tuple(map(load_road, ROADS))
            basis = replace(self.basis, sets=(), effort=effort.of(min(effort.units, EFFORT)))
            self._asked[wanted] = CoverageQuestion(basis, gaps_of((), roads), wanted, self.numbers)
        return self._asked[wanted]

    @cached_property
    def _asked(self) -> dict[frozenset[str], CoverageQuestion]:
        """The questions that were put together, by the groups of classes that they ask about."""
        return {}

    def answers(self, survey: Survey) -> Mapping[str, ClassAnswer | None]:
        """Return what is known of each class, by name; None where it was not asked.

        All are empty where it is proved that there is no gap.
        """
        if is_covered(survey.claims):
            return {name: ClassAnswer(x, verdict=Verdict.IMPOSSIBLE) for name, x in self.parts.items()}
        found = {x.part and x.part.key: x for x in survey.classes}
        return {name: found.get(part and part.key) for name, part in self.parts.items()}

    def of_drive(self, file: DriveFile, pair: Sequence[str]) -> tuple[str, ...]:
        """The classes of a gap between the two vehicles ``pair`` of a drive."""
        motions = {role: file.drive.vehicles[name] for role, name in zip(s.PAIR, pair, strict=True)}
        keys = {*self.classes.of(replace(file, drive=Drive(motions)))}
        return tuple(name for name, part in self.parts.items() if self.classes.has(part, keys))

    def of_trace(self, trace: OneTrace, sample: int) -> tuple[str, ...]:
        """The classes of samples of SV and POV, whatever comes after them; none where that may be no gap."""
        numbers = self.classes.numbers_on(trace.road)
        missed = bind(self.classes.missed(numbers).formula, trace.road, {}, self.classes.values)
        asked = {"": missed, **self.classes.bind(trace.road)}
        answers = compile(asked).evaluate(trace.batch, "truncated", at="all").answers
        if not answers[""].true[sample, 0]:
            return ()
        keys = {key for key, answer in answers.items() if key and answer.true[sample, 0]}
        none = all(answers[key].false[sample, 0] for key in self.classes.finest)
        return tuple(n for n, part in self.parts.items() if (none if part is None else part.key in keys))


def _name(part: Part, place: int) -> str:
    return f"{PREFIX}{part.component}_{place}" if part.condition else f"{PREFIX}{part.component}"


def gap_kinds(basis: Basis, numbers: Sequence[int]) -> GapKinds:
    """The classes of gaps of these scenarios. Raises ``UsageError`` where they cannot be sorted into any."""
    fault = next(_faults(basis.specification, numbers), "")
    if fault:
        raise UsageError(f"classes of gaps: {fault}")
    return GapKinds(basis, tuple(numbers))


def _faults(home: Specification, numbers: Sequence[int]) -> Iterator[str]:
    if restriction_of(home.options) is not None:
        yield "a driver model says how scenarios begin; coverage asks which drives that begin so are in none"
        return
    two = [n for n in numbers if len(s.vehicles_of(home, s.Scenario(n, home.set_name))) == len(s.PAIR)]
    if not two:
        yield "none of the scenarios is between two vehicles"
    for number in two:
        if not s.follows_template(home, number):
            yield f"{s.name_of(number)} does not follow the template {s.TEMPLATE}; leave it out with --among"
            return
    likes = likes_of(home)
    sectors = sectors_of(with_only(home, numbers))
    rows = {tuple(sorted({likes[n] for n in sector})) for sector in sectors}
    if len(rows) > 1:
        listed = ", ".join(map(str, two))
        yield (
            f"scenarios {listed} do not have the same disturbances in each road sector; name whole rows of "
            "the table, such as 1-8, 9-16 or 1-24"
        )
