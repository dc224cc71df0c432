"""Judges of drives: which simple drives are gaps, their classes, and their placing on other roads."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Annotated, ClassVar

from roadproof.engines.search.placing import place_on_roads, with_moved
from roadproof.evidence.codec import Doc
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.surveys.coverage.answers import in_role
from roadproof.extensions.surveys.coverage.claims import GapClaims
from roadproof.extensions.surveys.coverage.classes import ScenarioPart
from roadproof.extensions.surveys.coverage.gap_drives import (
    GapDrive,
    SimpleDrives,
    drives_of_need,
    simple_drive,
)
from roadproof.library.bind import bind
from roadproof.library.scenarios import LANE
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import LazyJudge, judge
from roadproof.verdict import Verdict
from roadproof.world.road import Road


@dataclass(frozen=True, kw_only=True)
class GapJudgement:
    """The judgement of a gap."""

    first: Annotated[str, Doc("The first of the wider sets that catches it; empty where none does.")]
    classes: Annotated[tuple[str, ...], Doc("The parts for which it is a near miss.")]

    @property
    def verdict(self) -> Verdict:
        """The verdict GAPS: the judgement is about a gap."""
        return Verdict.GAPS


@dataclass(frozen=True, kw_only=True)
class SimpleGap(GapJudgement):
    """A simple drive that is a gap."""

    number: Annotated[int, Doc("Its number among the simple drives of the road.")]


@dataclass(frozen=True, kw_only=True)
class SimpleGaps:
    """The gaps among some of the simple drives; of equal classes one that is easy to read."""

    gaps: Annotated[tuple[SimpleGap, ...], Doc("The gaps.")]

    @property
    def verdict(self) -> Verdict:
        """Return whether there are gaps."""
        return Verdict.GAPS if self.gaps else Verdict.COVERED


@dataclass(frozen=True, kw_only=True)
class RoadPlacement:
    """A placement of a gap's motions on another road, where they are a gap, too."""

    road: Annotated[str, Doc("The name of the road.")]
    place: Annotated[int, Doc("How far it is moved along: the number among the places that are tried.")]
    scenario: Annotated[int | None, Doc("The scenario that is missed there by one part.")]


@dataclass(frozen=True, kw_only=True)
class NearMiss:
    """The scenario, lane and roles of a near miss, the definitions that catch it, and other roads."""

    scenario: Annotated[int | None, Doc("The scenario that is missed by one part; null where none is.")]
    turned: Annotated[bool, Doc("Whether SV and POV are in each other's role.")]
    lane: Annotated[str | None, Doc("The lane that L stands for.")]
    caught_by: Annotated[
        tuple[tuple[str, ...], ...], Doc("The smallest choices of definitions of a wider set which catch it.")
    ]
    elsewhere: Annotated[tuple[RoadPlacement, ...], Doc("Other roads.")]

    @property
    def verdict(self) -> Verdict:
        """The verdict GAPS: the judgement is about a gap."""
        return Verdict.GAPS


@dataclass(frozen=True, kw_only=True)
class NeedDrive:
    """A simple drive that a set misses without one of its definitions."""

    road: Annotated[int, Doc("The number of the road.")]
    number: Annotated[int, Doc("Its number among the simple drives of the road.")]


@dataclass(frozen=True, kw_only=True)
class NeedJudgement:
    """The judgement whether a simple drive shows that a set needs a definition."""

    drive: Annotated[NeedDrive | None, Doc("The drive, if there is one.")]

    @property
    def verdict(self) -> Verdict:
        """Return whether there is a gap without the definition."""
        return Verdict.COVERED if self.drive is None else Verdict.GAPS


@dataclass(frozen=True)
class SimpleJudge:
    """A judge that searches gaps among every ``step``-th of the simple drives on a road."""

    relies_on: ClassVar[tuple[str, ...]] = ()
    claims: GapClaims
    road: Road
    start: int
    step: int

    @property
    def kind(self) -> type[SimpleGaps]:
        """The class of the answer."""
        return SimpleGaps

    @property
    def _drives(self) -> SimpleDrives:
        claims = self.claims
        return claims.cache.once(
            ("simple", self.road), lambda: SimpleDrives(self.road, claims.classes, claims.trials)
        )

    def __call__(self) -> SimpleGaps:
        """Return the gaps."""
        best = self._drives.best(self.start, self.step)
        gaps = (SimpleGap(number=k, first=x.first, classes=x.classes) for k, x in best.items())
        return SimpleGaps(gaps=tuple(gaps))

    def confirms(self, shows: SimpleGaps) -> bool:
        """Return whether all listed drives are gaps, with the listed classes."""
        places = [x.number - self.start for x in shows.gaps]
        if any(x % self.step or x < 0 for x in places) or len({*places}) < len(places):
            return False
        return all(self._is_so(x) for x in shows.gaps)

    def _is_so(self, gap: SimpleGap) -> bool:
        first = next(self._drives.gaps(gap.number, 10**9), None)
        return (
            first is not None
            and first[0] == gap.number
            and (first[1].first, first[1].classes)
            == (
                gap.first,
                gap.classes,
            )
        )

    def drives_of(self, shows: SimpleGaps) -> Iterator[GapDrive]:
        """Yield the gaps as drives; numbers of no drive are left out."""
        for gap in shows.gaps:
            drive = self.claims.cache.once(
                ("simple drive", self.road, gap.number), partial(simple_drive, self.road, gap.number)
            )
            if drive is not None:
                yield GapDrive(self._drives.file(drive), gap.first, gap.classes)


@dataclass(frozen=True)
class GapJudge:
    """A judge of a gap under wider sets, and without each part."""

    relies_on: ClassVar[tuple[str, ...]] = ()
    claims: GapClaims
    file: DriveFile

    @property
    def kind(self) -> type[GapJudgement]:
        """The class of the answer."""
        return GapJudgement

    def __call__(self) -> GapJudgement:
        """Return the judgement."""
        claims = self.claims
        return GapJudgement(first=claims.trials.first(self.file), classes=claims.classes.of(self.file))


@dataclass(frozen=True)
class NearMissJudge:
    """A judge that finds scenario, lane and roles of a near miss of ``part``.

    ``elsewhere``: other roads on which to try its motions.
    """

    relies_on: ClassVar[tuple[str, ...]] = ()
    claims: GapClaims
    part: ScenarioPart | None
    file: DriveFile
    elsewhere: tuple[Road, ...]

    @property
    def kind(self) -> type[NearMiss]:
        """The class of the answer."""
        return NearMiss

    def __call__(self) -> NearMiss:
        """Return the judgement."""
        counterpart, turned, lane = self._turned()
        file = in_role(self.file, turned, lane)
        return NearMiss(
            scenario=None if counterpart is None else counterpart.scenario,
            turned=turned,
            lane=lane,
            caught_by=self.claims.trials.smallest(file),
            elsewhere=tuple(self._elsewhere(file)),
        )

    def confirms(self, shows: NearMiss) -> bool:
        """Return whether these definitions catch it; drives of their own show that it is a gap."""
        known = self.file.road.lanes
        if shows.lane is not None and shows.lane not in known:
            return False
        file = in_role(self.file, shows.turned, shows.lane)
        return self.claims.trials.smallest(file) == shows.caught_by

    def _turned(self) -> tuple[ScenarioPart | None, bool, str | None]:
        """Return the counterpart, the roles and the lane for which the drive is a near miss."""
        if self.part is None:
            return None, False, None
        file, classes = self.file, self.claims.classes
        for counterpart, _ in classes.counterparts(self.part):
            for turned, lane in product((False, True), file.road.lanes):
                bound = bind(counterpart.without.formula, file.road, {LANE: lane}, classes.values)
                if judge(bound, in_role(file, turned, lane).drive).holds:
                    return counterpart, turned, lane
        raise AssertionError(f"the drive is no near miss of {self.part.key}")

    def _elsewhere(self, file: DriveFile) -> Iterator[RoadPlacement]:
        """Yield the motions on other roads where a counterpart is missed as nearly."""
        numbers = self.claims.classes.numbers
        counterparts = self.claims.on(self.part, numbers)[::-1]
        known = LazyJudge.on(file.drive)
        for road in self.elsewhere:
            if road.name == file.road.name:
                continue
            places = [*with_moved([road], file.drive)]
            for counterpart in counterparts:
                query = self.claims.query(counterpart, numbers)
                here = replace(file, formula="", values=self.claims.basis.all_values())
                there = place_on_roads(here, query, self.claims.basis.library, places, known)
                if there is not None:
                    scenario = None if counterpart is None else counterpart.scenario
                    yield RoadPlacement(
                        road=road.name, place=places.index(there.file.road), scenario=scenario
                    )
                    break


@dataclass(frozen=True)
class NeedJudge:
    """A judge that searches a simple drive that a set misses without a definition."""

    relies_on: ClassVar[tuple[str, ...]] = ()
    claims: GapClaims
    definition: str

    @property
    def kind(self) -> type[NeedJudgement]:
        """The class of the answer."""
        return NeedJudgement

    def __call__(self) -> NeedJudgement:
        """Return the first such drive."""
        drive = next(drives_of_need(self.claims.basis, self.definition), None)
        return NeedJudgement(drive=None if drive is None else NeedDrive(road=drive[0], number=drive[1]))

    def confirms(self, shows: NeedJudgement) -> bool:
        """Return whether the drive is missed; a judgement without a drive claims nothing."""
        drive = shows.drive
        drives = drives_of_need(self.claims.basis, self.definition)
        return drive is None or (drive.road, drive.number) in drives
