"""Trial sets: a spec set with some definitions of a wider one, and whether they catch a drive."""

from collections.abc import Sequence
from itertools import combinations

from roadproof.analysis.basis import Basis
from roadproof.analysis.coverage.claims import missed, numbers_on, replaced_in, sectors_of
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.bind import bind
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.exact import judge
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
