"""What a drive is that a set misses: which wider set catches it, and of which classes it is.

Simple drives are tried before any solver is asked, since many gaps are found in them, in a form that is easy
to read. Nothing rests on them: every drive is judged.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, islice

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.surveys.coverage.classes import (
    GapClasses,
    missed,
    numbers_on,
    replaced_in,
    sectors_of,
)
from roadproof.extensions.surveys.coverage.simple_drives import HORIZON, ZERO, effort_of, simple_drives
from roadproof.library.bind import bind
from roadproof.library.elaborate import entered_below
from roadproof.library.notes import Entered
from roadproof.library.scenarios import PAIR, danger_comes, name_of, numbers_of
from roadproof.library.specification import Specification
from roadproof.logic.custom_names import own_of
from roadproof.logic.formula import Formula, transform
from roadproof.questions.basis import Basis
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.road import Lanelet, Road, pairs

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
        """How hard the drive is to read."""
        return effort_of(self.file)


class SimpleDrives:
    """The simple drives on a road that a set misses, by number."""

    def __init__(self, road: Road, classes: GapClasses, trials: Trials) -> None:
        self.road, self.classes, self.trials = road, classes, trials
        gap = bind(classes.missed(classes.numbers_on(road)).formula, road, {}, classes.values)
        self.gap = transform(gap, lambda part: part)

    def file(self, drive: Drive) -> DriveFile:
        """Return a simple drive as a file that claims nothing yet."""
        home = self.classes.specification
        return DriveFile(
            None, home.set_name, "", HORIZON, {}, self.classes.values, home.options, self.road, drive
        )

    def best(self, start: int, step: int) -> dict[int, FoundGap]:
        """Return the gaps among every ``step``-th; of those alike the ones with least effort."""
        best: dict[tuple[str, tuple[str, ...]], tuple[int, FoundGap]] = {}
        for number, found in self.gaps(start, step):
            key = (found.first, found.classes)
            if key not in best or found.effort < best[key][1].effort:
                best[key] = number, found
        return dict(best.values())

    def gaps(self, start: int, step: int) -> Iterator[tuple[int, FoundGap]]:
        """Yield the gaps among every ``step``-th, with their numbers."""
        if own_of([self.gap]):
            return  # simple drives say nothing of own signals
        home, values = self.classes.specification, self.classes.values
        for number, drive in dangerous(home, values, self.road, start, step):
            if judge(self.gap, drive).holds:
                file = self.file(drive)
                yield number, FoundGap(file, self.trials.first(file), self.classes.of(file))


def dangerous(
    specification: Specification, values: Mapping[str, Fraction], road: Road, start: int = 0, step: int = 1
) -> Iterator[tuple[int, Drive]]:
    """The simple drives on which danger arises, within the limits of cars: every ``step``-th of all.

    Each comes with its number among all.
    """
    car = load_vehicle("car")
    begins = bind(danger_comes(specification, *PAIR).formula, road, {}, values)
    for number, drive in islice(enumerate(simple_drives(road, car)), start, None, step):
        if not judge(begins, drive).holds or first_overlap(drive, HORIZON) is not None:
            continue
        if first_breach(drive, dict.fromkeys(drive.vehicles, car), None) is None:
            yield number, drive


def numbered(road: Road, number: int) -> Drive | None:
    """The simple drive of a number, None where there is none."""
    return next(islice(simple_drives(road, load_vehicle("car")), number, None), None) if number >= 0 else None


# --- definitions that a set needs ------------------------------------------------------------------


# Two cars fit side by side in its lane, as they do not on the reference roads.
WIDE = Road(
    "one lane of 5 m",
    (Lanelet("m1", "main-1", "main", "main", (None, None), (ZERO, Fraction(5))),),
    pairs([]),
)


def roads_of_need() -> tuple[Road, Road]:
    """The roads on which drives are tried that show that a definition is needed."""
    return load_road("main-2"), WIDE


def parent_of(specification: Specification) -> str:
    """The set that a set extends, empty where it extends none."""
    return specification.library.sets[specification.set_name].parent


def replaced_by(specification: Specification) -> tuple[str, ...]:
    """The definitions that a set replaces in the set that it extends, if it does."""
    parent = parent_of(specification)
    return replaced_in(specification.in_set(parent), specification) if parent else ()


def mixed_definitions(home: Specification, other: Specification) -> Entered:
    """Every definition of a set, by set and name, that scenarios are made of where some definitions are those
    of another set: below its scenarios, and below the definitions that differ between the two.

    Raises ``TextError``.
    """
    names = [*map(name_of, numbers_of(other)), *map(name_of, numbers_of(home))]
    names += [*replaced_in(home, other), *replaced_in(other, home)]
    found: Entered = {}
    for each in (home, other):
        for name in dict.fromkeys(names):
            if name in each.definitions:
                found |= entered_below(each, name)
    return found


def trial_without(basis: Basis, name: str) -> Specification:
    """The set without a definition that it replaces: with that of the set which it extends in its place."""
    home = basis.specification
    narrow = replace(basis, specification=home.in_set(parent_of(home)))
    kept = tuple(x for x in replaced_by(home) if x != name)
    return Trials(narrow, (home.set_name,)).trial(home.set_name, kept)


def needs_it(basis: Basis, name: str) -> Iterator[tuple[int, int]]:
    """The simple drives that a set misses without a definition: the road of each, and its number."""
    home = basis.specification
    wide, narrow = home.set_name, home.in_set(parent_of(home))
    trials = Trials(replace(basis, specification=narrow), (wide,))
    kept = tuple(x for x in replaced_by(home) if x != name)
    # Simple drives say nothing of own signals.
    for place, road in enumerate(() if basis.library.freedom else roads_of_need()):
        for number, drive in dangerous(narrow, trials.values, road):
            file = DriveFile(None, wide, "", HORIZON, {}, trials.values, home.options, road, drive)
            if trials.misses(file, wide, kept):
                yield place, number
