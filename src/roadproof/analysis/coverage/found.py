"""Gaps to begin with: simple drives that a set misses, before anything is searched or proved."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, islice

from roadproof.analysis.basis import Basis
from roadproof.analysis.coverage.claims import missed, numbers_on, replaced_in, sectors_of
from roadproof.analysis.coverage.classes import GapClasses
from roadproof.analysis.coverage.simple import HORIZON, simple_drives
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.bind import bind
from roadproof.library.scenarios import PAIR, danger_comes
from roadproof.library.specification import Specification
from roadproof.logic.custom_names import own_of
from roadproof.logic.formula import Formula, transform
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.world.models import load_vehicle
from roadproof.world.road import Road

TRIAL = "trial"
MOST_COMBINED = 4


class Trials:
    """Judges drives under the sets ``wider`` (each extends the one before) and under choices from them."""

    def __init__(self, basis: Basis, wider: Sequence[str]) -> None:
        self.specification = basis.specification
        self.sectors = sectors_of(basis.specification)
        self.wider = tuple(wider)
        self.values = basis.all_values()
        self.bound: dict[tuple[str, tuple[str, ...] | None, Road], Formula] = {}

    def first(self, file: DriveFile) -> str:
        """The first of the wider sets that catches the drive; empty where none does."""
        return next((name for name in self.wider if not self.misses(file, name, None)), "")

    def smallest(self, file: DriveFile) -> tuple[tuple[str, ...], ...]:
        """The smallest choices of definitions of the first set that catches the drive which do, too."""
        name = self.first(file)
        if not name:
            return ()
        names = replaced_in(self.specification, self.specification.in_set(name))
        for size in range(1, min(len(names), MOST_COMBINED) + 1):
            catching = tuple(x for x in combinations(names, size) if not self.misses(file, name, x))
            if catching:
                return catching
        return (names,)

    def trial(self, wide: str, names: Sequence[str]) -> Specification:
        """The trial set: the set with the definitions ``names`` of ``wide`` in place of its own."""
        narrow, other = self.specification, self.specification.in_set(wide)
        taken = {name: other.definitions[name] for name in names}
        return Specification(narrow.library, TRIAL, narrow.options, {**narrow.definitions, **taken})

    def misses(self, file: DriveFile, wide: str, names: tuple[str, ...] | None) -> bool:
        """Whether the drive is a gap of ``wide``, or of the trial set with its definitions ``names``."""
        key = (wide, names, file.road)
        if key not in self.bound:
            tried = self.specification.in_set(wide) if names is None else self.trial(wide, names)
            gap = missed(tried, numbers_on(file.road, self.specification, self.sectors))
            self.bound[key] = bind(gap.formula, file.road, {}, self.values)
        return judge(self.bound[key], file.drive).holds


@dataclass(frozen=True)
class FoundGap:
    """A drive that the set misses; ``first``: the first of the wider sets that catches it, or empty.

    ``classes``: the keys of all parts for which it is a near miss. It is no evidence yet: what it shows of
    a class is judged when an answer is made of it.
    """

    file: DriveFile
    first: str
    classes: tuple[str, ...]

    @property
    def effort(self) -> tuple[int, int, int, Fraction]:
        """What makes a drive hard to read: vehicles that move across the road, accelerations, vehicles that
        start off the middle of a lane; and how long it takes (s)."""
        motions = self.file.drive.vehicles.values()
        movers = sum(m.v_lat != 0 or any(p.a_lat for p in m.pieces) for m in motions)
        changes = sum((p.a_lon != 0 or p.j_lon != 0) + (p.a_lat != 0) for m in motions for p in m.pieces)
        middles = {sum(lanelet.d, Fraction(0)) for lanelet in self.file.road.lanelets}
        off = sum(2 * m.d - m.width not in middles for m in motions)
        longest = max(sum((p.duration or Fraction(0) for p in m.pieces), Fraction(0)) for m in motions)
        return movers, changes, off, longest


def find_among_simple(
    road: Road, start: int, step: int, classes: GapClasses, trials: Trials
) -> list[FoundGap]:
    """The gaps among every ``step``-th of the simple drives; of those alike the ones with least effort."""
    specification, car = classes.specification, load_vehicle("car")
    begins = bind(danger_comes(specification, *PAIR).formula, road, {}, classes.values)
    gap = bind(classes.missed(classes.numbers_on(road)).formula, road, {}, classes.values)
    gap = transform(gap, lambda part: part)
    best: dict[tuple[str, tuple[str, ...]], FoundGap] = {}
    if own_of([begins, gap]):
        return []  # simple drives say nothing of own signals
    for drive in islice(simple_drives(road, car), start, None, step):
        if not judge(begins, drive).holds or not judge(gap, drive).holds:
            continue
        if first_overlap(drive, HORIZON) or first_breach(drive, dict.fromkeys(drive.vehicles, car), None):
            continue
        name, options = specification.set_name, specification.options
        file = DriveFile(None, name, "", HORIZON, {}, classes.values, options, road, drive)
        found = FoundGap(file, trials.first(file), classes.of(file))
        key = (found.first, found.classes)
        if key not in best or found.effort < best[key].effort:
            best[key] = found
    return list(best.values())
