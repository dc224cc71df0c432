"""Tested and missing targets: scenarios, classes and classes of gaps that tests may show."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from roadproof.extensions.catalogue import remarks
from roadproof.extensions.catalogue.catalogue_data import Remark, TargetData
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.entries import AbstractTest
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.gaps import PREFIX
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.surveys.coverage.answers import ClassAnswer
from roadproof.library.scenarios import name_of
from roadproof.library.words import words_by_number
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class GapTargets:
    """The classes of gaps in order: ``targets``, and those that are proved ``empty``.

    ``required``: whether each class is to be tested. If so, ``open`` has the reason for each class without a
    drive or a proof. If not, ``targets`` are the classes that tests show, and ``total`` counts all classes.
    """

    required: bool = False
    targets: tuple[TargetData, ...] = ()
    empty: tuple[TargetData, ...] = ()
    open: Mapping[str, str] = field(default_factory=dict)
    total: int = 0

    @property
    def missing(self) -> tuple[TargetData, ...]:
        """The required targets that no test shows, without those that are open."""
        return tuple(x for x in self.targets if self.required and not x.tested and x.name not in self.open)


@dataclass(frozen=True)
class Targets:
    """The targets in order, and the remarks on tests.

    ``faults``: tests that do not show what they claim, or show nothing. ``doubts``: open claims. ``alike``:
    duplicate tests. ``contradictions``: drives that show what is proved impossible.
    """

    targets: tuple[TargetData, ...]
    gaps: GapTargets
    faults: tuple[Remark, ...]
    doubts: tuple[Remark, ...]
    alike: tuple[Remark, ...]
    contradictions: tuple[Remark, ...]

    @property
    def missing(self) -> tuple[TargetData, ...]:
        """The targets that no test shows."""
        return (*(x for x in self.targets if not x.tested), *self.gaps.missing)

    @property
    def wrong(self) -> dict[str, str]:
        """The reasons why tests are not what they claim, by test: pictures have these names in red."""
        remarks = (*self.faults, *self.contradictions)
        return {test: x.told for x in reversed(remarks) for test in x.tests}

    @property
    def all_targets(self) -> tuple[TargetData, ...]:
        """The scenarios, classes, and classes of gaps."""
        return (*self.targets, *self.gaps.targets)


def find_targets(
    formulas: TargetFormulas,
    concrete: Sequence[ConcreteAnswer],
    abstract: Sequence[AbstractTest],
    facts: Sequence[CatalogueFact],
    titles: Mapping[str, str],
    near: float,
    gap_answers: Mapping[str, ClassAnswer | None] | None,
) -> Targets:
    """Return the targets of a catalogue, with the tests that show each and the remarks on tests.

    ``titles``: target name to title, in display order. ``near``: largest difference of the initial states of
    duplicate tests (m, m/s). ``gap_answers``: where gaps are required, the answer about each class of gaps by
    name, None for those that tests show.
    """
    sectors = sectors_of(formulas)
    gaps = _find_gaps(formulas, concrete, facts, gap_answers)
    known = {*titles, *(x.name for x in (*gaps.targets, *gaps.empty))}
    return Targets(
        tuple(_target(name, title, sectors.get(name, ""), concrete, facts) for name, title in titles.items()),
        gaps,
        remarks.fault_remarks(formulas, concrete, abstract, facts, known, gaps.required),
        remarks.open_remarks(abstract, facts, gaps.open),
        remarks.duplicate_remarks(concrete, abstract, facts, near),
        remarks.contradiction_remarks(concrete, facts, gaps.empty),
    )


def _find_gaps(
    formulas: TargetFormulas,
    concrete: Sequence[ConcreteAnswer],
    facts: Sequence[CatalogueFact],
    answers: Mapping[str, ClassAnswer | None] | None,
) -> GapTargets:
    """Return the classes of gaps; without ``answers`` those that tests show or claim."""
    seen = {x for answer in concrete for x in (*answer.names, *answer.claims) if x.startswith(PREFIX)}
    seen |= {x for fact in facts for x in fact.also if x.startswith(PREFIX)}
    if formulas.gaps is None or not (seen or answers is not None):
        return GapTargets()
    titles = formulas.gaps.titles
    made = {name: _target(name, title, "", concrete, facts) for name, title in titles.items()}
    if answers is None:
        shown = tuple(x for x in made.values() if x.name in seen)
        return GapTargets(targets=shown, total=len(made))
    verdicts = {name: answer.verdict for name, answer in answers.items() if answer is not None}
    empty = tuple(x for x in made.values() if verdicts.get(x.name) is Verdict.IMPOSSIBLE)
    still_open = {
        name: answer.reason
        for name, answer in answers.items()
        if answer is not None and answer.verdict is Verdict.UNKNOWN and not made[name].tested
    }
    left = tuple(x for x in made.values() if x not in empty)
    return GapTargets(True, left, empty, still_open, len(made))


def target_titles(formulas: TargetFormulas) -> dict[str, str]:
    """Return the title of every scenario and every class by name."""
    words = words_by_number(formulas.specification, formulas.numbers)
    titles = {name_of(number): x.name or f"scenario {number}" for number, x in words.items()}
    if formulas.classes is not None:
        for one in formulas.classes.all():
            place = "" if one.place is None else f", {one.place.replace('_', ' and ')}"
            titles[one.name] = one.description + place
    return titles


def sectors_of(formulas: TargetFormulas) -> dict[str, str]:
    """Return the road sector of each scenario and class by name; none without classes or with one sector."""
    if formulas.classes is None or not formulas.classes.plan.has_places:
        return {}
    plan = formulas.classes.plan
    sectors = {
        name_of(number): plan.sectors[first]
        for group in plan.groups
        for number, (_, first) in group.rows.items()
    }
    return sectors | {one.name: str(one.place) for one in formulas.classes.all()}


def _target(
    name: str, title: str, sector: str, concrete: Sequence[ConcreteAnswer], facts: Sequence[CatalogueFact]
) -> TargetData:
    """Return a target with the tests that show it and the range of each of their initial values."""
    showing = [x for x in concrete if name in x.names]
    implied = [x.test for x in facts if x.other == name and x.relation == "implies"]
    runs = {x.test for x in facts if x.relation == "runs"}
    possible = [x.test for x in facts if x.relation in ("shows", "runs") and name in (x.other, *x.also)]
    sure = [*(x.entry.id for x in showing), *(x for x in implied if x in runs)]
    covered: dict[str, tuple[float, float]] = {}
    for x in showing:
        for number, value in x.begins.items():
            low, high = covered.get(number, (value, value))
            covered[number] = min(low, value), max(high, value)
    maybe = dict.fromkeys(x for x in possible if x not in sure)
    return TargetData(name, title, sector, tuple(dict.fromkeys(sure)), tuple(maybe), covered)
