"""A search for a drive of each class, and its placing on roads with other zones."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import get_args

from roadproof.engines.search.drive_search import search_drive
from roadproof.engines.search.placing import (
    place_on_known_roads,
    place_on_roads,
    with_patched_zones,
    with_zones,
)
from roadproof.engines.search.usual_road import usual_road, zones_of
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.verdict_with_evidence import VerdictWithEvidence
from roadproof.extensions.surveys.classify.classes import Class
from roadproof.extensions.surveys.classify.data import ExampleVerdict
from roadproof.extensions.surveys.composition import with_parts
from roadproof.extensions.traffic.scenario_parts import sector
from roadproof.library.compose import both
from roadproof.library.specification import Query, Specification
from roadproof.questions.basis import Basis
from roadproof.reasons import ReasonKind, joined
from roadproof.runtime.budget import BudgetExceeded
from roadproof.verdict import Verdict
from roadproof.world.models import load_road
from roadproof.world.road import Road, Zone

MOST_FAILURES = 2
PLAIN_ROAD = "main-2"


@dataclass(frozen=True)
class ClassExample(VerdictWithEvidence[ExampleVerdict]):
    """A judged drive of a class, or the reason why none was found."""

    one: Class


def find_examples(
    basis: Basis, classes: Sequence[Class], known: Sequence[JudgedDrive] = (), more: Query | None = None
) -> list[ClassExample]:
    """Return examples of classes with the same disturbances in different sectors; ``basis`` reads their set.

    ``known``: drives of other classes; ``more``: a further condition on each drive.
    """
    searching = _DriveJobs(basis, known, more)
    return [searching.example(one) for one in classes]


class _DriveJobs:
    def __init__(self, basis: Basis, known: Sequence[JudgedDrive], more: Query | None) -> None:
        self.basis = basis
        self.more = [] if more is None else [more]
        self.drives = list(known)
        self.failures = 0

    def example(self, one: Class) -> ClassExample:
        """Return a drive of a class; UNKNOWN where none was found, or where time ran out."""
        try:
            return self._find(one)
        except BudgetExceeded as late:
            return ClassExample(one, verdict=Verdict.UNKNOWN, reason=late.reason)

    def _find(self, one: Class) -> ClassExample:
        query = with_parts(one.query(self.basis.specification), self.more)
        for judged in self.drives:
            here = self._elsewhere(judged, query)
            if here is not None:
                return ClassExample(one, verdict=Verdict.WITNESSED, drive=here)
        if self.failures == MOST_FAILURES:
            return ClassExample(one, verdict=Verdict.UNKNOWN, reason=ReasonKind.NO_DRIVE_ELSEWHERE())
        reasons = []
        for road in roads_of(one, self.basis.specification):
            outcome = search_drive(self.basis.search(query, road))
            if outcome.drives:
                self.drives.append(outcome.drives[0])
                return ClassExample(one, verdict=Verdict.WITNESSED, drive=outcome.drives[0])
            reason = outcome.reason or ReasonKind.LATE_PROOF()
            reasons.append(ReasonKind.ON_ROAD(reason, outcome.road, self.basis.effort.units))
        self.failures += 1
        return ClassExample(one, verdict=Verdict.UNKNOWN, reason=joined(reasons))

    def _elsewhere(self, judged: JudgedDrive, query: Query) -> JudgedDrive | None:
        """Return the motions of a drive on another road, or on its own road with other zones."""
        library = self.basis.library
        file = replace(judged.file, values=self.basis.all_values())
        return place_on_known_roads(file, query, library) or place_on_roads(
            file, query, library, with_patched_zones(file.road, file.drive)
        )


def roads_of(one: Class, specification: Specification) -> Iterator[Road]:
    """Yield the roads on which a drive of a class is searched: first the usual road for its sectors.

    For sectors of a single zone, a road of this zone alone follows where the usual road has others, too.
    Motions must end in one lanelet at the horizon, and zones of usual roads can be too long for that.
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
