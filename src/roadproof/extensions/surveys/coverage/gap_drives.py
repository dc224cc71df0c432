"""Drives that a set misses, with the wider sets that catch them, and their classes.

Simple drives are tried before a solver: many of them are gaps, and they are easy to read. No verdict rests on
them, because every drive is judged.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, islice

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.surveys.coverage.classes import (
    GapClasses,
    changed_definitions,
    gap_formula,
    numbers_on,
    sectors_of,
)
from roadproof.extensions.surveys.coverage.simple_drives import HORIZON, ZERO, effort_of, simple_drives
from roadproof.extensions.traffic.scenario_parts import danger_comes
from roadproof.library.bind import bind
from roadproof.library.elaborate import definitions_below
from roadproof.library.notes import UsedDefinitions
from roadproof.library.scenarios import PAIR, name_of, numbers_of
from roadproof.library.specification import Specification
from roadproof.logic.custom_names import custom_signals_of
from roadproof.logic.formula import Formula, transform
from roadproof.questions.basis import Basis
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.road import Lanelet, Road, adjacency

TRIAL = "trial"
MOST_COMBINED = 4


class Trials:
    """A judge of drives under the sets ``wider`` (each extends the one before) and under mixed sets."""

    def __init__(self, basis: Basis, wider: Sequence[str]) -> None:
        self.specification = basis.specification
        self.sectors = sectors_of(basis.specification)
        self.wider = tuple(wider)
        self.values = basis.all_values()
        self.bound: dict[tuple[str, tuple[str, ...] | None, Road], Formula] = {}

    def first(self, file: DriveFile) -> str:
        """Return the first of the wider sets that catches the drive; empty if none does."""
        return next((name for name in self.wider if not self.misses(file, name, None)), "")

    def smallest(self, file: DriveFile) -> tuple[tuple[str, ...], ...]:
        """Return the smallest choices of definitions of the first catching set that catch the drive, too."""
        name = self.first(file)
        if not name:
            return ()
        names = changed_definitions(self.specification, self.specification.in_set(name))
        for size in range(1, min(len(names), MOST_COMBINED) + 1):
            catching = tuple(x for x in combinations(names, size) if not self.misses(file, name, x))
            if catching:
                return catching
        return (names,)

    def trial(self, wide: str, names: Sequence[str]) -> Specification:
        """Return the mixed set: the set with the definitions ``names`` of ``wide`` instead of its own."""
        narrow, other = self.specification, self.specification.in_set(wide)
        taken = {name: other.definitions[name] for name in names}
        return Specification(narrow.library, TRIAL, narrow.options, {**narrow.definitions, **taken})

    def misses(self, file: DriveFile, wide: str, names: tuple[str, ...] | None) -> bool:
        """Return whether the drive is a gap of ``wide``, or of the mixed set with definitions ``names``."""
        key = (wide, names, file.road)
        if key not in self.bound:
            tried = self.specification.in_set(wide) if names is None else self.trial(wide, names)
            gap = gap_formula(tried, numbers_on(file.road, self.specification, self.sectors))
            self.bound[key] = bind(gap.formula, file.road, {}, self.values)
        return judge(self.bound[key], file.drive).holds


@dataclass(frozen=True)
class GapDrive:
    """A drive that the set misses; ``first``: the first of the wider sets that catches it, or empty.

    ``classes``: the keys of all parts for which it is a near miss. The drive becomes evidence for a class
    when it is judged for that class.
    """

    file: DriveFile
    first: str
    classes: tuple[str, ...]

    @property
    def effort(self) -> tuple[int, int, int, Fraction]:
        """The effort to read the drive; see ``effort_of``."""
        return effort_of(self.file)


class SimpleDrives:
    """The simple drives on a road that a set misses, by number."""

    def __init__(self, road: Road, classes: GapClasses, trials: Trials) -> None:
        self.road, self.classes, self.trials = road, classes, trials
        gap = bind(classes.gap_formula(classes.numbers_on(road)).formula, road, {}, classes.values)
        self.gap = transform(gap, lambda part: part)

    def file(self, drive: Drive) -> DriveFile:
        """Return a simple drive as a file without a formula."""
        home = self.classes.specification
        return DriveFile(
            None, home.set_name, "", HORIZON, {}, self.classes.values, home.options, self.road, drive
        )

    def best(self, start: int, step: int) -> dict[int, GapDrive]:
        """Return the gaps among every ``step``-th drive, by number; of equal classes the simplest one."""
        best: dict[tuple[str, tuple[str, ...]], tuple[int, GapDrive]] = {}
        for number, gap in self.gaps(start, step):
            key = (gap.first, gap.classes)
            if key not in best or gap.effort < best[key][1].effort:
                best[key] = number, gap
        return dict(best.values())

    def gaps(self, start: int, step: int) -> Iterator[tuple[int, GapDrive]]:
        """Yield the gaps among every ``step``-th drive, with their numbers."""
        if custom_signals_of([self.gap]):
            return  # simple drives say nothing of custom signals
        home, values = self.classes.specification, self.classes.values
        for number, drive in dangerous_drives(home, values, self.road, start, step):
            if judge(self.gap, drive).holds:
                file = self.file(drive)
                yield number, GapDrive(file, self.trials.first(file), self.classes.of(file))


def dangerous_drives(
    specification: Specification, values: Mapping[str, Fraction], road: Road, start: int = 0, step: int = 1
) -> Iterator[tuple[int, Drive]]:
    """Yield the simple drives on which danger arises, within the limits of cars, with their numbers.

    Only every ``step``-th drive from ``start`` on is considered.
    """
    car = load_vehicle("car")
    begins = bind(danger_comes(specification, *PAIR).formula, road, {}, values)
    for number, drive in islice(enumerate(simple_drives(road, car)), start, None, step):
        if not judge(begins, drive).holds or first_overlap(drive, HORIZON) is not None:
            continue
        if first_breach(drive, dict.fromkeys(drive.vehicles, car), None) is None:
            yield number, drive


def simple_drive(road: Road, number: int) -> Drive | None:
    """Return the simple drive of a number; None if the number is out of range."""
    return next(islice(simple_drives(road, load_vehicle("car")), number, None), None) if number >= 0 else None


# --- definitions that a set needs ------------------------------------------------------------------


# Two cars fit side by side in its lane, as they do not on the reference roads.
WIDE = Road(
    "one lane of 5 m",
    (Lanelet("m1", "main-1", "main", "main", (None, None), (ZERO, Fraction(5))),),
    adjacency([]),
)


def roads_of_need() -> tuple[Road, Road]:
    """Return the roads on which to try drives that need a definition."""
    return load_road("main-2"), WIDE


def parent_of(specification: Specification) -> str:
    """Return the set that a set extends; empty if none."""
    return specification.library.sets[specification.set_name].parent


def own_definitions(specification: Specification) -> tuple[str, ...]:
    """Return the definitions that a set replaces in the set that it extends."""
    parent = parent_of(specification)
    return changed_definitions(specification.in_set(parent), specification) if parent else ()


def mixed_definitions(home: Specification, other: Specification) -> UsedDefinitions:
    """Return every definition that scenarios of a mix of two sets may use, by set and name.

    These are the definitions below the scenarios, and below the definitions that differ.

    Raises ``TextError``.
    """
    names = [*map(name_of, numbers_of(other)), *map(name_of, numbers_of(home))]
    names += [*changed_definitions(home, other), *changed_definitions(other, home)]
    definitions: UsedDefinitions = {}
    for each in (home, other):
        for name in dict.fromkeys(names):
            if name in each.definitions:
                definitions |= definitions_below(each, name)
    return definitions


def trial_without(basis: Basis, name: str) -> Specification:
    """Return the set with its parent's version of one definition that it replaces."""
    home = basis.specification
    narrow = replace(basis, specification=home.in_set(parent_of(home)))
    replaced = tuple(x for x in own_definitions(home) if x != name)
    return Trials(narrow, (home.set_name,)).trial(home.set_name, replaced)


def drives_of_need(basis: Basis, name: str) -> Iterator[tuple[int, int]]:
    """Yield the simple drives that a set misses without a definition: index of the road, and number."""
    home = basis.specification
    wide, narrow = home.set_name, home.in_set(parent_of(home))
    trials = Trials(replace(basis, specification=narrow), (wide,))
    replaced = tuple(x for x in own_definitions(home) if x != name)
    # Simple drives say nothing of custom signals.
    for place, road in enumerate(() if basis.library.freedom else roads_of_need()):
        for number, drive in dangerous_drives(narrow, trials.values, road):
            file = DriveFile(None, wide, "", HORIZON, {}, trials.values, home.options, road, drive)
            if trials.misses(file, wide, replaced):
                yield place, number
