"""The gaps of a spec set in classes by why each scenario fails, and which classes a drive belongs to.

A gap belongs to the class of a part (a component of a scenario, or one of its conditions) where that
scenario would hold, for some lane and in either role, if only this part were left out. A last class
holds the gaps for which no single condition is to blame: in every scenario two or more are false. So
every gap is in a class: the list is complete.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

from roadproof.analysis.coverage.claims import numbers_on, sectors_of, wider_sets
from roadproof.analysis.coverage.parts import Part, parts_of
from roadproof.analysis.requests import Asked
from roadproof.evidence.drive_file import DriveFile
from roadproof.judge.exact import judge
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.scenarios import likes_of
from roadproof.verdict import Verdict
from roadproof.world.road import Road

_LANE = re.compile(r"\bL\b")
_VEHICLE = re.compile(r"\b(SV|POV)\b")


@dataclass(frozen=True)
class Survey:
    """What is asked for: the gaps of the first set of ``asked`` for two vehicles.

    ``wider``: extensions of the set, each of the one before; ``roads``: where drives are looked for, in
    this order; ``elsewhere``: roads on which the drives are tried that were found.
    """

    asked: Asked
    wider: tuple[str, ...] = ()
    roads: tuple[str, ...] = ("main-2", "main-3")
    elsewhere: tuple[str, ...] = ()


@dataclass(frozen=True)
class Found:
    """A drive that the set misses; ``first``: the first of the wider sets that catches it, or empty.

    ``classes``: the keys of all parts for which it is a near miss.
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
        changes = sum((p.a_lon != 0) + (p.a_lat != 0) for m in motions for p in m.pieces)
        middles = {sum(lanelet.d, Fraction(0)) for lanelet in self.file.road.lanelets}
        off = sum(2 * m.d - m.width not in middles for m in motions)
        longest = max(sum((p.duration or Fraction(0) for p in m.pieces), Fraction(0)) for m in motions)
        return movers, changes, off, longest


@dataclass(frozen=True)
class Gap:
    """A judged drive that the set misses, near to the scenario of a class in roles and lane of its formula.

    ``caught_by``: the smallest choices of definitions of the set ``first`` that catch it. ``elsewhere``:
    drive files of the same motions that are gaps on other roads, as near to the scenario's counterpart;
    they are given for whole components.
    """

    road: str
    formula: str
    drive: Mapping[str, Any]
    first: str
    caught_by: tuple[tuple[str, ...], ...]
    classes: tuple[str, ...]
    elsewhere: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


@dataclass(frozen=True)
class Answer:
    """What came out for one class; ``part`` None is the class for which no single condition is to blame.

    WITNESSED with gaps that differ in the wider set that catches them first, ``none_for`` being the sets
    for which none was found; IMPOSSIBLE with a certificate (a file's text) of ``claim``; UNKNOWN with a
    reason.
    """

    part: Part | None
    verdict: Verdict
    gaps: tuple[Gap, ...] = ()
    claim: str = ""
    certificate: str | None = None
    reason: str = ""
    none_for: tuple[str, ...] = ()


@dataclass(frozen=True)
class Group:
    """A component with its conditions, which are settled together; None: no single condition to blame."""

    component: Part | None
    conditions: tuple[Part, ...] = ()

    @property
    def name(self) -> str:
        return "no single condition" if self.component is None else self.component.component

    @property
    def parts(self) -> tuple[Part | None, ...]:
        return (self.component, *self.conditions)


def survey_of(asked: Asked, wide: str, roads: Sequence[str], elsewhere: Sequence[str] = ()) -> Survey:
    """A survey that compares with the sets from the first one to ``wide``. Raises ``UsageError``."""
    library, _ = asked.load()
    wider = wider_sets(library, asked.sets[0], wide) if wide else ()
    return Survey(asked, wider, tuple(roads), tuple(elsewhere))


def groups_of(survey: Survey) -> list[Group]:
    """All classes, for the scenarios of the first road sector: the others repeat their disturbances."""
    _, specification = survey.asked.load()
    groups: list[Group] = []
    for number in sectors_of(specification)[0]:
        for part in parts_of(specification, number):
            if part.condition:
                groups[-1] = replace(groups[-1], conditions=(*groups[-1].conditions, part))
            else:
                groups.append(Group(part))
    return [*groups, Group(None)]


class Classes:
    """Which classes a drive belongs to. A class stands for the same part in every road sector."""

    def __init__(self, asked: Asked) -> None:
        library, self.specification = asked.load()
        self.values = {**default_values(library), **asked.values}
        self.sectors = sectors_of(self.specification)
        self.likes = likes_of(self.specification)
        self.by_number = {n: parts_of(self.specification, n) for sector in self.sectors for n in sector}
        self.parts = [part for number in self.sectors[0] for part in self.by_number[number]]
        self.finest = frozenset(part.key for part in self.parts if part.finest)
        self.bound: dict[Road, Formula] = {}

    def counterparts(self, part: Part) -> Iterator[tuple[Part, tuple[int, ...]]]:
        """The same part of the same disturbance in every road sector, with the sector's scenarios."""
        place = self.by_number[part.scenario].index(part)
        for sector in self.sectors:
            for number in sector:
                if self.likes[number] == self.likes[part.scenario]:
                    yield self.by_number[number][place], sector

    def near(self, part: Part, numbers: Collection[int]) -> str:
        """That a drive is a near miss of the part, or of a counterpart among these scenarios."""
        return (
            " or ".join(near_miss(p) for p, _ in self.counterparts(part) if p.scenario in numbers) or "false"
        )

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
        numbers = numbers_on(self.specification, road)
        queries = [read_claim(self.specification, self.near(part, numbers)).formula for part in self.parts]
        bound = tuple(bind(query, road, {}, self.values) for query in queries)
        # Equal parts as one object: the judge looks up what it knows, and comparing trees takes long.
        shared = f.children(f.transform(f.Or(bound), lambda part: part))
        return {part.key: formula for part, formula in zip(self.parts, shared, strict=True)}

    def has(self, part: Part | None, keys: Collection[str]) -> bool:
        """Whether a gap with these keys is in the class of ``part``."""
        return part.key in keys if part is not None else self.finest.isdisjoint(keys)


def near_miss(part: Part) -> str:
    """That the scenario holds without the part, for some lane and in either role."""
    without = _LANE.sub("M", part.without)
    return f"(some M in lanes: ({without}) or ({exchanged(without)}))"


def exchanged(text: str) -> str:
    """``text`` with SV and POV in each other's place."""
    return _VEHICLE.sub(lambda found: "POV" if found[0] == "SV" else "SV", text)
