"""A drive for each class: one is looked for, and put on roads where the same happens in other zones."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import get_args

from roadproof.engines.search.ask import ask
from roadproof.engines.search.placing import patched, placed, placed_on, with_zones
from roadproof.engines.search.question import usual_road, zones_of
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.settled import Settled
from roadproof.extensions.surveys.classify.classes import Class
from roadproof.extensions.surveys.classify.data import Word
from roadproof.library.compose import both, with_parts
from roadproof.library.scenarios import sector
from roadproof.library.specification import Query, Specification
from roadproof.questions.basis import Basis
from roadproof.reasons import Why, joined
from roadproof.runtime.budget import BudgetExceeded
from roadproof.verdict import Verdict
from roadproof.world.models import load_road
from roadproof.world.road import Road, Zone

MOST_FAILURES = 2
PLAIN_ROAD = "main-2"


@dataclass(frozen=True)
class Example(Settled[Word]):
    """A judged drive of a class, or the reason why there is none to show."""

    one: Class


def find_examples(
    basis: Basis, classes: Sequence[Class], known: Sequence[JudgedDrive] = (), more: Query | None = None
) -> list[Example]:
    """Examples of classes in which the same happens in different places; ``basis`` is about their set.

    ``known``: drives of others of these classes; ``more``: what is to hold beside.
    """
    searching = _DriveJobs(basis, known, more)
    return [searching.example(one) for one in classes]


class _DriveJobs:
    def __init__(self, basis: Basis, known: Sequence[JudgedDrive], more: Query | None) -> None:
        self.basis = basis
        self.more = [] if more is None else [more]
        self.found = list(known)
        self.failures = 0

    def example(self, one: Class) -> Example:
        """A drive of a class; UNKNOWN where none was found, or where the clock cut the search off."""
        try:
            return self._find(one)
        except BudgetExceeded as late:
            return Example(one, verdict=Verdict.UNKNOWN, reason=late.reason)

    def _find(self, one: Class) -> Example:
        query = with_parts(one.query(self.basis.specification), self.more)
        for judged in self.found:
            here = self._elsewhere(judged, query)
            if here is not None:
                return Example(one, verdict=Verdict.WITNESSED, drive=here)
        if self.failures == MOST_FAILURES:
            return Example(one, verdict=Verdict.UNKNOWN, reason=Why.NO_DRIVE_ELSEWHERE())
        reasons = []
        for road in roads_of(one, self.basis.specification):
            outcome = ask(self.basis.search(query, road))
            if outcome.drives:
                self.found.append(outcome.drives[0])
                return Example(one, verdict=Verdict.WITNESSED, drive=outcome.drives[0])
            told = outcome.reason or Why.LATE_PROOF()
            reasons.append(Why.ON_ROAD(told, outcome.road, self.basis.effort.units))
        self.failures += 1
        return Example(one, verdict=Verdict.UNKNOWN, reason=joined(reasons))

    def _elsewhere(self, judged: JudgedDrive, query: Query) -> JudgedDrive | None:
        """The motions of a drive on another road, or on their own with other zones."""
        library = self.basis.library
        file = replace(judged.file, values=self.basis.all_values())
        return placed(file, query, library) or placed_on(file, query, library, patched(file.road, file.drive))


def roads_of(one: Class, specification: Specification) -> Iterator[Road]:
    """Yield the usual road for the sectors that hold; those that do not would ask for their zones, too.

    Then, for sectors of one zone that it has beside others, one that has no other: motions have to settle
    in one lanelet within the horizon, for which zones of the usual roads can be too long.
    """
    query = one.query(specification)
    if one.where is not None:
        query = both(*(sector(specification, number, one.vehicles) for number in one.where.holds))
    usual = usual_road(query.formula)
    yield usual
    zones = zones_of(query.formula)
    if len(zones) == 1 and not zones >= {x.zone for x in usual.lanelets}:
        for zone in get_args(Zone):
            if zone in zones:
                yield with_zones(load_road(PLAIN_ROAD), (), (zone,))
