"""The gaps of a spec set in classes by why each scenario fails, and which classes a drive belongs to.

A gap of a set is a drive that starts in safety (initSafe), comes into danger later, and on which no scenario
of the set holds at the start, for any lane and with the two vehicles in either role. It belongs to the class
of a part (a component of a scenario, or one of its conditions) where that scenario would hold, for some lane
and in either role, if only this part were left out. A last class holds the gaps for which no single condition
is to blame: in every scenario two or more are false. So every gap is in a class: the list is complete.

The parts of a disturbance (eq. disturbFormat: initialCondition and behaviourSV and behaviourPOV) are its
components, and every condition that a component joins by ``and``, also behind F and before U. Leaving a part
out means putting true in its place, so that what is left holds wherever the scenario does.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace

from roadproof.engines.search.question import zones_of
from roadproof.evidence.drive_file import DriveFile
from roadproof.library import scenarios as s
from roadproof.library.alike import likes_of
from roadproof.library.bind import bind
from roadproof.library.compose import (
    both,
    either,
    eventually,
    implication,
    in_some_lane,
    negation,
    with_vehicles,
)
from roadproof.library.elaborate import elaborate
from roadproof.library.scenarios import sector
from roadproof.library.specification import Library, Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, is_state, subformulas
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import without_names
from roadproof.logic.show import text
from roadproof.logic.syntax import Claim
from roadproof.questions.basis import Basis
from roadproof.semantics.exact.exact import DriveJudge, LazyJudge
from roadproof.world.road import Road

Rebuild = Callable[[Formula], Formula]


@dataclass(frozen=True)
class Part:
    """One part of a scenario with two vehicles.

    ``component``: the definition that the template names, such as ``behaviourPOV_4``, and in words
    ``description``. ``condition``: which of its conditions, as text; the whole component where it is
    empty. ``without``: the scenario without the part, about SV, POV and L. ``finest``: whether it has no
    parts itself.
    """

    scenario: int
    component: str
    description: str
    condition: str
    without: Query
    finest: bool

    @property
    def key(self) -> str:
        """A name for the part that no other part of the set has."""
        return f"{self.component}: {self.condition}" if self.condition else self.component


def parts_of(specification: Specification, number: int) -> tuple[Part, ...]:
    """The components of a scenario that are not just true, each followed by its conditions.

    A component with one condition only is a part, its condition is no second one.
    """
    whole = s.applied(specification, s.Scenario(number, specification.set_name)).formula
    found: list[Part] = []
    for component, rebuild in _components(whole, number):
        if _body(component) == f.TRUE:
            continue
        description = specification.describe(specification.definitions[component.name])
        leaves = list(_conditions(component.body, rebuild, "", None))
        if len(leaves) > 1:
            leaves.insert(0, ("", rebuild))
        else:
            leaves = [("", rebuild)]
        for shown, put in leaves:
            without = elaborate(specification, Claim((), as_syntax(put(f.TRUE))))
            finest = bool(shown) or len(leaves) == 1
            found.append(Part(number, component.name, description, shown, without, finest))
    return tuple(found)


def _components(whole: Formula, number: int) -> Iterator[tuple[f.Application, Rebuild]]:
    """The conjuncts of the disturbance, each with what puts another formula in its place."""

    def walk(current: Formula, rebuild: Rebuild, inside: bool) -> Iterator[tuple[f.Application, Rebuild]]:
        match current:
            case f.Application(name, _, body) if not inside:
                yield from walk(body, rebuild, name == s.disturbance_name(number))
            case f.Application():
                yield current, rebuild
            case f.And(parts):
                for place, part in enumerate(parts):
                    yield from walk(part, _inside(current, place, rebuild), inside)
            case _:
                return

    yield from walk(whole, lambda new: new, False)


def _conditions(
    current: Formula, rebuild: Rebuild, where: str, until: f.Until | None
) -> Iterator[tuple[str, Rebuild]]:
    """The conditions below ``current``; ``where`` is the definition around it, ``until`` the U before it."""
    below: list[tuple[str, Rebuild]] = []
    match current:
        case f.And(parts):
            for place, part in enumerate(parts):
                below += _conditions(part, _inside(current, place, rebuild), where, until)
        case f.Application(name, _, body) if not _is_simple(current):
            below += _conditions(body, rebuild, name, until)
        case f.Eventually(_, body) | f.Always(_, body):
            below += _conditions(body, _inside(current, 0, rebuild), where, until)
        case f.Until(left, _, _):
            below += _conditions(left, _inside(current, 0, rebuild), where, current)
        case _:
            pass
    if len(below) > 1:
        yield from below
    else:
        shown = current if until is None else f.Until(current, until.interval, until.right)
        yield text(as_syntax(shown)) + (f" in {where}" if where else ""), rebuild


def _inside(around: Formula, place: int, rebuild: Rebuild) -> Rebuild:
    """Put a formula in the place of one child of ``around``, where true goes away in a conjunction."""
    parts = f.children(around)

    def put(new: Formula) -> Formula:
        changed = (*parts[:place], new, *parts[place + 1 :])
        return rebuild(
            f.conjunction(*changed) if isinstance(around, f.And) else f.with_children(around, changed)
        )

    return put


def _is_simple(formula: f.Application) -> bool:
    """Whether a definition speaks of one instant, and there of lanes only or of numbers only."""
    below = list(subformulas(formula))
    lanes = any(isinstance(x, f.Occupies) for x in below)
    numbers = any(isinstance(x, f.Compare) for x in below)
    return is_state(formula) and not (lanes and numbers)


def _body(formula: Formula) -> Formula:
    while isinstance(formula, f.Application):
        formula = formula.body
    return formula


PROOF = 60.0  # units of work for a claim of coverage


def two_vehicle_numbers(specification: Specification) -> tuple[int, ...]:
    """The scenarios between SV and one POV."""
    name = specification.set_name
    numbers = s.numbers_of(specification)
    return tuple(n for n in numbers if len(s.vehicles_of(specification, s.Scenario(n, name))) == len(s.PAIR))


def with_only(home: Specification, numbers: Collection[int]) -> Specification:
    """Return the same definitions, of scenarios only those with these numbers."""
    kept = {name: x for name, x in home.definitions.items() if s.number_in(name) in {None, *numbers}}
    return Specification(home.library, home.set_name, home.options, kept)


def sectors_of(specification: Specification) -> tuple[tuple[int, ...], ...]:
    """The two-vehicle scenarios, those of one road sector together, in the order of their numbers."""
    sectors: dict[Formula, list[int]] = {}
    for number in two_vehicle_numbers(specification):
        where = sector(specification, number, s.PAIR).formula
        sectors.setdefault(without_names(where), []).append(number)
    return tuple(map(tuple, sectors.values()))


def numbers_on(
    road: Road, specification: Specification, sectors: Sequence[tuple[int, ...]]
) -> tuple[int, ...]:
    """The scenarios of the sectors whose zones the road has; the others cannot hold on it."""
    zones = {lanelet.zone for lanelet in road.lanelets}
    found: list[int] = []
    for numbers in sectors:
        if zones_of(sector(specification, numbers[0], s.PAIR).formula) <= zones:
            found += numbers
    return tuple(found)


def claims_of(specification: Specification) -> tuple[Query, ...]:
    """Claims that together say that the set has no gap on a road all of whose lanelets are in a zone.

    One for each road sector: where SV is in L, one of the sector's scenarios holds for L. A last one:
    vehicles that are each in a zone are in one of the sectors.
    """
    sectors = sectors_of(specification)
    claims = [
        implication(starts_in(specification, numbers), either(*in_either_role(specification, numbers)))
        for numbers in sectors
    ]
    somewhere = both(*(s.in_some_zone(specification, vehicle) for vehicle in s.PAIR))
    some_sector = either(*(sector(specification, numbers[0], s.PAIR) for numbers in sectors))
    return (*claims, implication(somewhere, some_sector))


def starts(specification: Specification) -> tuple[Query, ...]:
    """That the two vehicles are safe and in danger later, and what else drives are asked to begin with."""
    later = eventually(s.danger(specification, *s.PAIR))
    return s.safe(specification, *s.PAIR), later, *s.asked_between(specification, *s.PAIR)


def starts_in(specification: Specification, numbers: Sequence[int]) -> Query:
    """Safety and later danger in the road sector of these scenarios, with SV in L."""
    where = sector(specification, numbers[0], s.PAIR)
    return both(where, s.in_lane(specification, s.SUBJECT), *starts(specification))


def in_either_role(specification: Specification, numbers: Sequence[int], set_name: str = "") -> list[Query]:
    """The scenarios for L, each with the two vehicles in either role; ``set_name``: those of another set."""
    name = set_name or specification.set_name
    roles = (s.PAIR, s.PAIR[::-1])
    return [s.applied(specification, s.Scenario(n, name), pair) for pair in roles for n in numbers]


def missed(specification: Specification, numbers: Sequence[int]) -> Query:
    """Safety and later danger, and none of the scenarios for any lane and either role."""
    none = (negation(in_some_lane(x, s.LANE)) for x in in_either_role(specification, numbers))
    return both(*starts(specification), *none)


def caught(specification: Specification, numbers: Sequence[int], set_name: str) -> Query:
    """That one of the scenarios of a set holds, for some lane and either role."""
    return in_some_lane(either(*in_either_role(specification, numbers, set_name)), s.LANE)


def replaced_in(narrow: Specification, wide: Specification) -> tuple[str, ...]:
    """The names of the definitions that differ between two sets."""
    return tuple(n for n, d in wide.definitions.items() if narrow.definitions.get(n) != d)


def sets_between(library: Library, narrow: str, wide: str) -> tuple[str, ...]:
    """The sets from the first extension of ``narrow`` to ``wide``; none where that does not extend it."""
    chain: list[str] = []
    name = wide
    while name and name != narrow:
        chain.insert(0, name)
        name = library.sets[name].parent
    return tuple(chain) if name == narrow else ()


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
        self.bound: dict[Road, dict[str, Formula]] = {}
        self.gaps: dict[tuple[int, ...], Query] = {}
        self.near_misses: dict[str, Query] = {}

    @property
    def every(self) -> list[Part]:
        """The parts of all scenarios, in every road sector."""
        return [part for parts in self.by_number.values() for part in parts]

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
        for numbers in self.sectors:
            for number in numbers:
                if self.likes[number] == self.likes[part.scenario]:
                    yield self.by_number[number][place], numbers

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
        return either(*(self._near_miss(p) for p, _ in self.counterparts(part) if p.scenario in numbers))

    def _near_miss(self, part: Part) -> Query:
        """As ``near_miss``, put together once."""
        if part.key not in self.near_misses:
            self.near_misses[part.key] = near_miss(part)
        return self.near_misses[part.key]

    def of(self, file: DriveFile) -> tuple[str, ...]:
        """The keys of the parts without which their scenario would hold for some lane and either role."""
        if file.road not in self.bound:
            self.bound[file.road] = self.bind(file.road)
        # Definitions of users may speak of what a drive lacks, which is an error.
        judge = (DriveJudge if self.specification.library.files else LazyJudge).on(file.drive)
        held = {key: judge.holds(formula) for key, formula in self.bound[file.road].items()}
        return tuple(key for key, holds in held.items() if holds)

    def bind(self, road: Road) -> dict[str, Formula]:
        """By key, that a drive on the road is a near miss of the part."""
        numbers = self.numbers_on(road)
        every = f.Or(tuple(self.near(part, numbers).formula for part in self.parts))
        # Equal parts as one object: all look up what they know, and comparing trees takes long.
        [whole] = f.share([bind(f.share([every], _same)[0], road, {}, self.values)], _same)
        return {part.key: formula for part, formula in zip(self.parts, f.children(whole), strict=True)}

    def has(self, part: Part | None, keys: Collection[str]) -> bool:
        """Whether a gap with these keys is in the class of ``part``."""
        return part.key in keys if part is not None else self.finest.isdisjoint(keys)


def _same(part: Formula) -> Formula:
    return part


def near_miss(part: Part) -> Query:
    """That the scenario holds without the part, for some lane and in either role."""
    return in_some_lane(either(part.without, exchanged(part.without)), s.LANE)


def exchanged(query: Query) -> Query:
    """``query`` with SV and POV in each other's place."""
    return with_vehicles(query, dict(zip(s.PAIR, s.PAIR[::-1], strict=True)))
