"""Trial sets: a spec set with some definitions of a wider one, and whether they catch a drive."""

from collections.abc import Sequence
from itertools import combinations

from roadproof.analysis.coverage.claims import missed, numbers_on, replaced_in
from roadproof.analysis.requests import Asked
from roadproof.evidence.drive_file import DriveFile
from roadproof.judge.exact import judge
from roadproof.logic.formula import Formula, transform
from roadproof.logic.show import text
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Source, build_library
from roadproof.world.road import Road

TRIAL = "trial"
MOST_COMBINED = 4


class Trials:
    """Judges drives under the sets ``wider`` (each extends the one before) and under choices from them."""

    def __init__(self, asked: Asked, wider: Sequence[str]) -> None:
        self.asked = asked
        self.wider = tuple(wider)
        self.library, self.specification = asked.load()
        self.values = {**default_values(self.library), **asked.values}
        self.numbers: dict[Road, tuple[int, ...]] = {}
        self.bound: dict[tuple[str, tuple[str, ...] | None, Road], Formula] = {}

    def numbers_on(self, road: Road) -> tuple[int, ...]:
        """The scenarios whose sector's zones the road has; the others cannot hold on it."""
        if road not in self.numbers:
            self.numbers[road] = numbers_on(self.specification, road)
        return self.numbers[road]

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

    def written(self, wide: str, names: Sequence[str]) -> str:
        """The text of the trial set: the first set with the definitions ``names`` of ``wide``."""
        definitions = self.specification.in_set(wide).definitions
        body = "\n".join(f"  {text(definitions[name])}" for name in names)
        return f"set {TRIAL} extends {self.asked.sets[0]} {{\n{body}\n}}\n"

    def misses(self, file: DriveFile, wide: str, names: tuple[str, ...] | None) -> bool:
        """Whether the drive is a gap of ``wide``, or of the trial set with its definitions ``names``."""
        key = (wide, names, file.road)
        if key not in self.bound:
            specification = self.specification.in_set(wide)
            if names is not None:
                library = build_library([Source("trial.spec", self.written(wide, names))], self.library)
                specification = library.select(TRIAL, self.asked.options)
            query = read_claim(specification, missed(self.numbers_on(file.road)))
            bound = bind(query.formula, file.road, {}, self.values)
            self.bound[key] = transform(bound, lambda part: part)
        return judge(self.bound[key], file.drive).holds
