"""The classes of gaps of a spec set, by the condition to blame, and the classes of a drive.

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
from typing import assert_never

from roadproof.engines.search.usual_road import zones_of
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.surveys.composition import in_some_lane, with_vehicles
from roadproof.extensions.traffic import scenario_parts
from roadproof.extensions.traffic.scenario_parts import sector
from roadproof.library import scenarios
from roadproof.library.bind import bind
from roadproof.library.compose import both, either, eventually, implication, negation
from roadproof.library.elaborate import elaborate
from roadproof.library.sector_twins import sector_twins
from roadproof.library.specification import Library, Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, is_state, subformulas
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import without_names
from roadproof.logic.show import text
from roadproof.logic.syntax import Claim
from roadproof.questions.basis import Basis
from roadproof.semantics.exact.judging import DriveJudge, LazyJudge
from roadproof.world.road import Road

Rebuild = Callable[[Formula], Formula]


@dataclass(frozen=True)
class ScenarioPart:
    """One part of a scenario with two vehicles: a component, or one of its conditions.

    ``component``: the definition that the template names, such as ``behaviourPOV_4``; ``description``: its
    text. ``condition``: the condition as text; empty for the whole component. ``without``: the scenario
    without the part, about SV, POV and L. ``finest``: whether it has no parts itself.
    """

    scenario: int
    component: str
    description: str
    condition: str
    without: Query
    finest: bool

    @property
    def key(self) -> str:
        """The name of the part, unique in the set."""
        return f"{self.component}: {self.condition}" if self.condition else self.component


def parts_of(specification: Specification, number: int) -> tuple[ScenarioPart, ...]:
    """Return the components of a scenario that are not just true, each followed by its conditions.

    A component with a single condition counts once.
    """
    whole = scenarios.apply_scenario(
        specification, scenarios.Scenario(number, specification.set_name)
    ).formula
    parts: list[ScenarioPart] = []
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
            parts.append(ScenarioPart(number, component.name, description, shown, without, finest))
    return tuple(parts)


def _components(whole: Formula, number: int) -> Iterator[tuple[f.Application, Rebuild]]:
    """Yield the conjuncts of the disturbance, each with a function that replaces it."""

    def walk(current: Formula, rebuild: Rebuild, inside: bool) -> Iterator[tuple[f.Application, Rebuild]]:
        match current:
            case f.Application(name, _, body) if not inside:
                yield from walk(body, rebuild, name == scenarios.disturbance_name(number))
            case f.Application():
                yield current, rebuild
            case f.And(parts):
                for place, part in enumerate(parts):
                    yield from walk(part, _inside(current, place, rebuild), inside)
            case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.Not() | f.Or():
                return
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                return
            case _:
                assert_never(current)

    yield from walk(whole, lambda new: new, False)


def _conditions(
    current: Formula, rebuild: Rebuild, where: str, until: f.Until | None
) -> Iterator[tuple[str, Rebuild]]:
    """Yield the conditions below ``current``, in the definition ``where``, after the U of ``until``."""
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
        case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every():
            pass
        case f.Not() | f.Or() | f.Application() | f.Since():
            pass
        case _:
            assert_never(current)
    if len(below) > 1:
        yield from below
    else:
        shown = current if until is None else f.Until(current, until.interval, until.right)
        yield text(as_syntax(shown)) + (f" in {where}" if where else ""), rebuild


def _inside(around: Formula, place: int, rebuild: Rebuild) -> Rebuild:
    """Return a function that replaces one child of ``around``; a conjunction drops true."""
    parts = f.children(around)

    def put(new: Formula) -> Formula:
        changed = (*parts[:place], new, *parts[place + 1 :])
        return rebuild(
            f.conjunction(*changed) if isinstance(around, f.And) else f.with_children(around, changed)
        )

    return put


def _is_simple(formula: f.Application) -> bool:
    """Return whether a definition is about one instant, and about lanes only or numbers only."""
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
    """Return the scenarios between SV and one POV."""
    name = specification.set_name
    numbers = scenarios.numbers_of(specification)
    return tuple(
        n
        for n in numbers
        if len(scenarios.vehicles_of(specification, scenarios.Scenario(n, name))) == len(scenarios.PAIR)
    )


def with_only(home: Specification, numbers: Collection[int]) -> Specification:
    """Return the same definitions, of scenarios only those with these numbers."""
    definitions = {
        name: x for name, x in home.definitions.items() if scenarios.number_in(name) in {None, *numbers}
    }
    return Specification(home.library, home.set_name, home.options, definitions)


def sectors_of(specification: Specification) -> tuple[tuple[int, ...], ...]:
    """Return the two-vehicle scenarios by road sector, in the order of their numbers."""
    sectors: dict[Formula, list[int]] = {}
    for number in two_vehicle_numbers(specification):
        where = sector(specification, number, scenarios.PAIR).formula
        sectors.setdefault(without_names(where), []).append(number)
    return tuple(map(tuple, sectors.values()))


def numbers_on(
    road: Road, specification: Specification, sectors: Sequence[tuple[int, ...]]
) -> tuple[int, ...]:
    """Return the scenarios of the sectors whose zones the road has; the others cannot hold on it."""
    zones = {lanelet.zone for lanelet in road.lanelets}
    present: list[int] = []
    for numbers in sectors:
        if zones_of(sector(specification, numbers[0], scenarios.PAIR).formula) <= zones:
            present += numbers
    return tuple(present)


def claims_of(specification: Specification) -> tuple[Query, ...]:
    """Return claims that together imply that the set has no gap on a road whose lanelets are all in zones.

    One for each road sector: if SV is in L, one of the sector's scenarios holds for L. A last one: vehicles
    that are each in a zone are in one of the sectors.
    """
    sectors = sectors_of(specification)
    claims = [
        implication(starts_in(specification, numbers), either(*in_either_role(specification, numbers)))
        for numbers in sectors
    ]
    somewhere = both(*(scenario_parts.in_some_zone(specification, vehicle) for vehicle in scenarios.PAIR))
    some_sector = either(*(sector(specification, numbers[0], scenarios.PAIR) for numbers in sectors))
    return (*claims, implication(somewhere, some_sector))


def starts(specification: Specification) -> tuple[Query, ...]:
    """Return the conditions of a start: safety, later danger, and further requirements on the start."""
    later = eventually(scenarios.danger(specification, *scenarios.PAIR))
    return (
        scenario_parts.safe(specification, *scenarios.PAIR),
        later,
        *scenario_parts.start_requirements(specification, *scenarios.PAIR),
    )


def starts_in(specification: Specification, numbers: Sequence[int]) -> Query:
    """Return the formula of a start in the road sector of these scenarios, with SV in L."""
    where = sector(specification, numbers[0], scenarios.PAIR)
    return both(where, scenario_parts.in_lane(specification, scenarios.SUBJECT), *starts(specification))


def in_either_role(specification: Specification, numbers: Sequence[int], set_name: str = "") -> list[Query]:
    """Return the scenarios for L, each with the two vehicles in either role; ``set_name``: of another set."""
    name = set_name or specification.set_name
    roles = (scenarios.PAIR, scenarios.PAIR[::-1])
    return [
        scenarios.apply_scenario(specification, scenarios.Scenario(n, name), pair)
        for pair in roles
        for n in numbers
    ]


def gap_formula(specification: Specification, numbers: Sequence[int]) -> Query:
    """Return the formula of a gap: a start, and no scenario for any lane and either role."""
    none = (negation(in_some_lane(x, scenarios.LANE)) for x in in_either_role(specification, numbers))
    return both(*starts(specification), *none)


def catch_formula(specification: Specification, numbers: Sequence[int], set_name: str) -> Query:
    """Return the formula that a scenario of a set holds, for some lane and either role."""
    return in_some_lane(either(*in_either_role(specification, numbers, set_name)), scenarios.LANE)


def changed_definitions(narrow: Specification, wide: Specification) -> tuple[str, ...]:
    """Return the names of the definitions that differ between two sets."""
    return tuple(n for n, d in wide.definitions.items() if narrow.definitions.get(n) != d)


def sets_between(library: Library, narrow: str, wide: str) -> tuple[str, ...]:
    """Return the sets from the first extension of ``narrow`` to ``wide``; none if that does not extend it."""
    chain: list[str] = []
    name = wide
    while name and name != narrow:
        chain.insert(0, name)
        name = library.sets[name].parent
    return tuple(chain) if name == narrow else ()


@dataclass(frozen=True)
class GapGroup:
    """A component with its conditions, decided together; None: the class without a condition to blame."""

    component: ScenarioPart | None
    conditions: tuple[ScenarioPart, ...] = ()

    @property
    def title(self) -> str:
        return "no single condition" if self.component is None else self.component.component

    @property
    def parts(self) -> tuple[ScenarioPart | None, ...]:
        return (self.component, *self.conditions)


class GapClasses:
    """The classes of gaps of a set. A class stands for one part of a disturbance in every road sector."""

    def __init__(self, basis: Basis) -> None:
        self.specification = basis.specification
        self.values = basis.all_values()
        self.sectors = sectors_of(self.specification)
        self.numbers = tuple(number for sector in self.sectors for number in sector)
        self.twins = sector_twins(self.specification)
        self.by_number = {number: parts_of(self.specification, number) for number in self.numbers}
        self.parts = [part for number in self.sectors[0] for part in self.by_number[number]]
        self.finest = frozenset(part.key for part in self.parts if part.finest)
        self.bound: dict[Road, dict[str, Formula]] = {}
        self.gaps: dict[tuple[int, ...], Query] = {}
        self.near_misses: dict[str, Query] = {}

    @property
    def every(self) -> list[ScenarioPart]:
        """The parts of all scenarios, in every road sector."""
        return [part for parts in self.by_number.values() for part in parts]

    def groups(self) -> list[GapGroup]:
        """Return all classes, by the scenarios of the first road sector, whose disturbances others repeat."""
        groups: list[GapGroup] = []
        for part in self.parts:
            if part.condition:
                groups[-1] = replace(groups[-1], conditions=(*groups[-1].conditions, part))
            else:
                groups.append(GapGroup(part))
        return [*groups, GapGroup(None)]

    def counterparts(self, part: ScenarioPart) -> Iterator[tuple[ScenarioPart, tuple[int, ...]]]:
        """Yield this part of the disturbance in every road sector, with the sector's scenarios."""
        place = [x.key for x in self.by_number[part.scenario]].index(part.key)
        for numbers in self.sectors:
            for number in numbers:
                if self.twins[number] == self.twins[part.scenario]:
                    yield self.by_number[number][place], numbers

    def numbers_on(self, road: Road) -> tuple[int, ...]:
        """Return the scenarios whose sector's zones the road has; the others cannot hold on it."""
        return numbers_on(road, self.specification, self.sectors)

    def gap_formula(self, numbers: tuple[int, ...]) -> Query:
        """Return the formula of a gap, composed once."""
        if numbers not in self.gaps:
            self.gaps[numbers] = gap_formula(self.specification, numbers)
        return self.gaps[numbers]

    def near_miss_of(self, part: ScenarioPart, numbers: Collection[int]) -> Query:
        """Return the formula of a near miss of the part, or of a counterpart among these scenarios."""
        return either(*(self._near_miss(p) for p, _ in self.counterparts(part) if p.scenario in numbers))

    def _near_miss(self, part: ScenarioPart) -> Query:
        """Return ``near_miss``, composed once."""
        if part.key not in self.near_misses:
            self.near_misses[part.key] = near_miss(part)
        return self.near_misses[part.key]

    def of(self, file: DriveFile) -> tuple[str, ...]:
        """Return the keys of the parts for which a drive is a near miss."""
        if file.road not in self.bound:
            self.bound[file.road] = self.bind(file.road)
        # Definitions of users may speak of what a drive lacks, which is an error.
        judge = (DriveJudge if self.specification.library.files else LazyJudge).on(file.drive)
        truth = {key: judge.holds(formula) for key, formula in self.bound[file.road].items()}
        return tuple(key for key, holds in truth.items() if holds)

    def bind(self, road: Road) -> dict[str, Formula]:
        """Return the formulas of near misses on a road, by the key of the part."""
        numbers = self.numbers_on(road)
        every = f.Or(tuple(self.near_miss_of(part, numbers).formula for part in self.parts))
        # Equal parts as one object: all look up what they know, and comparing trees takes long.
        [whole] = f.hash_cons([bind(f.hash_cons([every], _same)[0], road, {}, self.values)], _same)
        return {part.key: formula for part, formula in zip(self.parts, f.children(whole), strict=True)}

    def has(self, part: ScenarioPart | None, keys: Collection[str]) -> bool:
        """Return whether a gap with these keys is in the class of ``part``."""
        return part.key in keys if part is not None else self.finest.isdisjoint(keys)


def _same(part: Formula) -> Formula:
    return part


def near_miss(part: ScenarioPart) -> Query:
    """Return the formula that a scenario holds without the part, for some lane and in either role."""
    return in_some_lane(either(part.without, swap_roles(part.without)), scenarios.LANE)


def swap_roles(query: Query) -> Query:
    """Return ``query`` with SV and POV swapped."""
    return with_vehicles(query, dict(zip(scenarios.PAIR, scenarios.PAIR[::-1], strict=True)))
