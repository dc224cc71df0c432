"""What drives are judged to be: gaps among simple drives, of which classes, and where else."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Annotated

from roadproof.engines.search.placing import placed_on, with_moved
from roadproof.evidence.codec import Doc
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.surveys.coverage.answers import in_role
from roadproof.extensions.surveys.coverage.claims import GapClaims
from roadproof.extensions.surveys.coverage.classes import Part
from roadproof.extensions.surveys.coverage.found import FoundGap, SimpleDrives, needs_it, numbered
from roadproof.library.bind import bind
from roadproof.library.scenarios import LANE
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.exact import LazyJudge, judge
from roadproof.verdict import Verdict
from roadproof.world.road import Road


@dataclass(frozen=True, kw_only=True)
class Looks:
    """What a gap is judged to be."""

    first: Annotated[str, Doc("The first of the wider sets that catches it; empty where none does.")]
    classes: Annotated[tuple[str, ...], Doc("The parts for which it is a near miss.")]

    @property
    def verdict(self) -> Verdict:
        """A gap is none of what is covered."""
        return Verdict.GAPS


@dataclass(frozen=True, kw_only=True)
class SimpleGap(Looks):
    """A simple drive that is a gap."""

    number: Annotated[int, Doc("Its number among the simple drives of the road.")]


@dataclass(frozen=True, kw_only=True)
class SimpleGaps:
    """The gaps among some of the simple drives; of those alike one that is easy to read."""

    gaps: Annotated[tuple[SimpleGap, ...], Doc("The gaps.")]

    @property
    def verdict(self) -> Verdict:
        """Whether there are gaps."""
        return Verdict.GAPS if self.gaps else Verdict.COVERED


@dataclass(frozen=True, kw_only=True)
class Placed:
    """Another road on which the motions of a gap are one, too."""

    road: Annotated[str, Doc("The name of the road.")]
    place: Annotated[int, Doc("How far it is moved along: the number among the places that are tried.")]
    scenario: Annotated[int | None, Doc("The scenario that is missed there by one part.")]


@dataclass(frozen=True, kw_only=True)
class Near:
    """In which scenario, lane and roles a gap is near, what catches it, and where else it is one."""

    scenario: Annotated[int | None, Doc("The scenario that is missed by one part; null where none is.")]
    turned: Annotated[bool, Doc("Whether SV and POV are in each other's role.")]
    lane: Annotated[str | None, Doc("The lane that L stands for.")]
    caught_by: Annotated[
        tuple[tuple[str, ...], ...], Doc("The smallest choices of definitions of a wider set which catch it.")
    ]
    elsewhere: Annotated[tuple[Placed, ...], Doc("Other roads.")]

    @property
    def verdict(self) -> Verdict:
        """A gap is none of what is covered."""
        return Verdict.GAPS


@dataclass(frozen=True, kw_only=True)
class NeedingDrive:
    """A simple drive that a set misses without one of its definitions."""

    road: Annotated[int, Doc("The number of the road.")]
    number: Annotated[int, Doc("Its number among the simple drives of the road.")]


@dataclass(frozen=True, kw_only=True)
class Needing:
    """Whether a simple drive shows that a set needs a definition."""

    drive: Annotated[NeedingDrive | None, Doc("The drive, if there is one.")]

    @property
    def verdict(self) -> Verdict:
        """Whether there is a gap without the definition."""
        return Verdict.COVERED if self.drive is None else Verdict.GAPS


@dataclass(frozen=True)
class SimpleJudge:
    """Looks for gaps among every ``step``-th of the simple drives on a road."""

    claims: GapClaims
    road: Road
    start: int
    step: int

    @property
    def kind(self) -> type[SimpleGaps]:
        """What it says."""
        return SimpleGaps

    @property
    def _drives(self) -> SimpleDrives:
        claims = self.claims
        return claims.made.once(
            ("simple", self.road), lambda: SimpleDrives(self.road, claims.classes, claims.trials)
        )

    def __call__(self) -> SimpleGaps:
        """Return the gaps."""
        best = self._drives.best(self.start, self.step)
        gaps = (SimpleGap(number=k, first=x.first, classes=x.classes) for k, x in best.items())
        return SimpleGaps(gaps=tuple(gaps))

    def confirms(self, shows: SimpleGaps) -> bool:
        """Return whether all drives that are named are gaps, and what is said of them."""
        places = [x.number - self.start for x in shows.gaps]
        if any(x % self.step or x < 0 for x in places) or len({*places}) < len(places):
            return False
        return all(self._is_so(x) for x in shows.gaps)

    def _is_so(self, said: SimpleGap) -> bool:
        found = next(self._drives.gaps(said.number, 10**9), None)
        return (
            found is not None
            and found[0] == said.number
            and (found[1].first, found[1].classes)
            == (
                said.first,
                said.classes,
            )
        )

    def found(self, shows: SimpleGaps) -> Iterator[FoundGap]:
        """Yield the gaps as drives; numbers of no drive are left out."""
        for said in shows.gaps:
            drive = self.claims.made.once(
                ("simple drive", self.road, said.number), partial(numbered, self.road, said.number)
            )
            if drive is not None:
                yield FoundGap(self._drives.file(drive), said.first, said.classes)


@dataclass(frozen=True)
class LooksJudge:
    """Judges a gap under wider sets, and without each part."""

    claims: GapClaims
    file: DriveFile

    @property
    def kind(self) -> type[Looks]:
        """What it says."""
        return Looks

    def __call__(self) -> Looks:
        """Return what the gap is."""
        claims = self.claims
        return Looks(first=claims.trials.first(self.file), classes=claims.classes.of(self.file))


@dataclass(frozen=True)
class NearJudge:
    """Tells in which scenario, lane and roles a gap of the class of ``part`` is near, and where else it is.

    ``elsewhere``: the roads that are tried.
    """

    claims: GapClaims
    part: Part | None
    file: DriveFile
    elsewhere: tuple[Road, ...]

    @property
    def kind(self) -> type[Near]:
        """What it says."""
        return Near

    def __call__(self) -> Near:
        """Return it."""
        counterpart, turned, lane = self._turned()
        file = in_role(self.file, turned, lane)
        return Near(
            scenario=None if counterpart is None else counterpart.scenario,
            turned=turned,
            lane=lane,
            caught_by=self.claims.trials.smallest(file),
            elsewhere=tuple(self._elsewhere(file)),
        )

    def confirms(self, shows: Near) -> bool:
        """Return whether these definitions catch it; that it is a gap where is said, drives show."""
        known = self.file.road.lanes
        if shows.lane is not None and shows.lane not in known:
            return False
        file = in_role(self.file, shows.turned, shows.lane)
        return self.claims.trials.smallest(file) == shows.caught_by

    def _turned(self) -> tuple[Part | None, bool, str | None]:
        """The sector, the roles and the lane in which the scenario of the part is missed by it alone."""
        if self.part is None:
            return None, False, None
        file, classes = self.file, self.claims.classes
        for counterpart, _ in classes.counterparts(self.part):
            for turned, lane in product((False, True), file.road.lanes):
                bound = bind(counterpart.without.formula, file.road, {LANE: lane}, classes.values)
                if judge(bound, in_role(file, turned, lane).drive).holds:
                    return counterpart, turned, lane
        raise AssertionError(f"the drive is no near miss of {self.part.key}")

    def _elsewhere(self, file: DriveFile) -> Iterator[Placed]:
        """The same motions on other roads, where a counterpart is missed as nearly."""
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
                there = placed_on(here, query, self.claims.basis.library, places, known)
                if there is not None:
                    scenario = None if counterpart is None else counterpart.scenario
                    yield Placed(road=road.name, place=places.index(there.file.road), scenario=scenario)
                    break


@dataclass(frozen=True)
class NeedJudge:
    """Looks for a simple drive that a set misses without a definition."""

    claims: GapClaims
    definition: str

    @property
    def kind(self) -> type[Needing]:
        """What it says."""
        return Needing

    def __call__(self) -> Needing:
        """Return the first such drive."""
        drive = next(needs_it(self.claims.basis, self.definition), None)
        return Needing(drive=None if drive is None else NeedingDrive(road=drive[0], number=drive[1]))

    def confirms(self, shows: Needing) -> bool:
        """Return whether the drive is one; that there is none claims nothing."""
        said = shows.drive
        found = needs_it(self.claims.basis, self.definition)
        return said is None or (said.road, said.number) in found
