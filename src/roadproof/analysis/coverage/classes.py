"""The gaps of a spec set in classes by why each scenario fails, and which classes a drive belongs to.

A gap belongs to the class of a part (a component of a scenario, or one of its conditions) where that
scenario would hold, for some lane and in either role, if only this part were left out. A last class
holds the gaps for which no single condition is to blame: in every scenario two or more are false. So
every gap is in a class: the list is complete.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from roadproof.analysis.basis import Basis
from roadproof.analysis.coverage.claims import missed, numbers_on, sectors_of
from roadproof.analysis.coverage.parts import Part, parts_of
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.bind import bind
from roadproof.library.compose import either, in_some_lane, with_vehicles
from roadproof.library.scenarios import LANE, PAIR, likes_of
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.exact import judge
from roadproof.world.road import Road


@dataclass(frozen=True)
class GapSurvey:
    """What is asked for: the gaps of a set for two vehicles.

    ``wider``: extensions of the set, each of the one before; ``roads``: where drives are looked for, in
    this order; ``elsewhere``: roads on which the drives are tried that were found.
    """

    basis: Basis
    wider: tuple[str, ...] = ()
    roads: tuple[Road, ...] = ()
    elsewhere: tuple[Road, ...] = ()


@dataclass(frozen=True)
class GapGroup:
    """A component with its conditions, which are settled together; None: no single condition to blame."""

    component: Part | None
    conditions: tuple[Part, ...] = ()

    @property
    def title(self) -> str:
        return "no single condition" if self.component is None else self.component.component

    @property
    def parts(self) -> tuple[Part | None, ...]:
        return (self.component, *self.conditions)


class GapClasses:
    """Which classes a drive belongs to. A class stands for the same part in every road sector."""

    def __init__(self, basis: Basis) -> None:
        self.specification = basis.specification
        self.values = basis.all_values()
        self.sectors = sectors_of(self.specification)
        self.numbers = tuple(number for sector in self.sectors for number in sector)
        self.likes = likes_of(self.specification)
        self.by_number = {number: parts_of(self.specification, number) for number in self.numbers}
        self.parts = [part for number in self.sectors[0] for part in self.by_number[number]]
        self.finest = frozenset(part.key for part in self.parts if part.finest)
        self.bound: dict[Road, Formula] = {}
        self.gaps: dict[tuple[int, ...], Query] = {}

    def groups(self) -> list[GapGroup]:
        """All classes, for the scenarios of the first road sector: the others repeat their disturbances."""
        groups: list[GapGroup] = []
        for part in self.parts:
            if part.condition:
                groups[-1] = replace(groups[-1], conditions=(*groups[-1].conditions, part))
            else:
                groups.append(GapGroup(part))
        return [*groups, GapGroup(None)]

    def counterparts(self, part: Part) -> Iterator[tuple[Part, tuple[int, ...]]]:
        """The same part of the same disturbance in every road sector, with the sector's scenarios."""
        place = [x.key for x in self.by_number[part.scenario]].index(part.key)
        for sector in self.sectors:
            for number in sector:
                if self.likes[number] == self.likes[part.scenario]:
                    yield self.by_number[number][place], sector

    def numbers_on(self, road: Road) -> tuple[int, ...]:
        """The scenarios whose sector's zones the road has; the others cannot hold on it."""
        return numbers_on(road, self.specification, self.sectors)

    def missed(self, numbers: tuple[int, ...]) -> Query:
        """That a drive is a gap, as ``claims.missed``; put together once, since it is long."""
        if numbers not in self.gaps:
            self.gaps[numbers] = missed(self.specification, numbers)
        return self.gaps[numbers]

    def near(self, part: Part, numbers: Collection[int]) -> Query:
        """That a drive is a near miss of the part, or of a counterpart among these scenarios."""
        return either(*(near_miss(p) for p, _ in self.counterparts(part) if p.scenario in numbers))

    def of(self, file: DriveFile) -> tuple[str, ...]:
        """The keys of the parts without which their scenario would hold for some lane and either role."""
        if file.road not in self.bound:
            self.bound[file.road] = f.Or(tuple(self.bind(file.road).values()))
        whole = self.bound[file.road]
        judgement = judge(whole, file.drive)
        truths = zip(self.parts, f.children(whole), strict=True)
        return tuple(part.key for part, formula in truths if judgement.truth(formula).at(Fraction(0)))

    def bind(self, road: Road) -> dict[str, Formula]:
        """By key, that a drive on the road is a near miss of the part."""
        numbers = self.numbers_on(road)
        bound = tuple(bind(self.near(part, numbers).formula, road, {}, self.values) for part in self.parts)
        # Equal parts as one object: the judge looks up what it knows, and comparing trees takes long.
        shared = f.children(f.transform(f.Or(bound), lambda part: part))
        return {part.key: formula for part, formula in zip(self.parts, shared, strict=True)}

    def has(self, part: Part | None, keys: Collection[str]) -> bool:
        """Whether a gap with these keys is in the class of ``part``."""
        return part.key in keys if part is not None else self.finest.isdisjoint(keys)


def near_miss(part: Part) -> Query:
    """That the scenario holds without the part, for some lane and in either role."""
    return in_some_lane(either(part.without, exchanged(part.without)), LANE)


def exchanged(query: Query) -> Query:
    """``query`` with SV and POV in each other's place."""
    return with_vehicles(query, dict(zip(PAIR, PAIR[::-1], strict=True)))
