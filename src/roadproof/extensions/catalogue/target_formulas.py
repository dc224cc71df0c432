"""The formulas of all targets: scenarios, the rows of which classes are made, and danger.

A class is a choice of disturbances with a choice of road sectors (``classify.classes``), so all classes
follow from a few formulas: the rows. They share almost all of their parts with the scenarios. So readers
judge all formulas together, and each shared part once.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import TypeAlias

from roadproof.errors import RoadproofError, UsageError
from roadproof.extensions.catalogue.gaps import NamedGapClasses, named_gap_classes
from roadproof.extensions.surveys.classify.classes import Class, Classes, DivisionPlan, ScenarioGroup
from roadproof.extensions.surveys.extremes.points import JudgementCache
from roadproof.extensions.traffic import scenario_parts
from roadproof.library import scenarios
from roadproof.library.bind import bind
from roadproof.library.compose import both, negation
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.questions.basis import Basis
from roadproof.world.road import Road

NO_CLASS = "no class"
"""The name for a test that is in none of the classes, though scenarios hold."""
ENDANGERED = scenarios.DANGER_ARISES
"""The target in which vehicles are safe and come into danger, in any scenario or none."""
GAP = "gap"
"""The target of danger that no scenario covers, for any lane and in any roles."""


@dataclass(frozen=True)
class ScenarioKey:
    """The key of the scenario ``number``."""

    number: int


@dataclass(frozen=True)
class RowKey:
    """The key of a disturbance: that of the scenario ``number`` and its twins in other road sectors."""

    number: int


@dataclass(frozen=True)
class SectorKey:
    """The key of the formula that the vehicles are in the road sector of the scenario ``number``."""

    number: int


@dataclass(frozen=True)
class EndangeredKey:
    """The key of the formula that the vehicles are safe now and come into danger."""


TargetKey: TypeAlias = ScenarioKey | RowKey | SectorKey | EndangeredKey
_Names: TypeAlias = tuple[str, ...]


@dataclass
class TargetFormulas:
    """The formulas of the scenarios ``numbers`` and of their ``classes``, None where there are none.

    ``wholes``: the formulas by roles and vehicles; ``bound``: also by road and lane. ``parts``: one object
    for all equal parts, in all spec sets. ``cache``: the targets that drives show.
    """

    specification: Specification
    numbers: tuple[int, ...]
    classes: Classes | None
    values: Mapping[str, Fraction]
    wholes: dict[tuple[_Names, _Names], tuple[tuple[TargetKey, ...], Formula]] = field(default_factory=dict)
    bound: dict[tuple[Road, _Names, _Names, str], dict[TargetKey, Formula]] = field(default_factory=dict)
    parts: dict[Formula, Formula] = field(default_factory=dict)
    cache: JudgementCache = field(default_factory=JudgementCache, compare=False, repr=False)

    @property
    def is_always_judged(self) -> bool:
        """Return whether every part can be judged; user definitions may use signals that a drive lacks."""
        return not self.specification.library.files

    @cached_property
    def in_other_sets(self) -> "Mapping[str, TargetFormulas]":
        """The formulas of the scenarios, without classes, in each other spec set that has them."""
        home, formulas = self.specification, dict[str, TargetFormulas]()
        for name in (x for x in home.library.sets if x != home.set_name):
            with suppress(RoadproofError):
                there = home.in_set(name)
                numbers = tuple(x for x in self.numbers if x in scenarios.numbers_of(there))
                formulas[name] = TargetFormulas(there, numbers, None, self.values, parts=self.parts)
        return formulas

    @cached_property
    def gaps(self) -> NamedGapClasses | None:
        """The classes of gaps between two vehicles; None where these scenarios do not make any."""
        try:
            return named_gap_classes(Basis(self.specification, values=self.values), self.numbers)
        except UsageError:
            return None

    @cached_property
    def roles(self) -> tuple[tuple[str, ...], ...]:
        """The roles of the vehicles of the scenarios, each combination once."""
        return tuple(dict.fromkeys(self._vehicles.values()))

    @cached_property
    def all_roles(self) -> tuple[tuple[str, ...], ...]:
        """The roles of the vehicles of all scenarios of the specification, each combination once."""
        home = self.specification
        own = (
            scenarios.vehicles_of(home, scenarios.Scenario(number, home.set_name))
            for number in scenarios.numbers_of(home)
        )
        return tuple(dict.fromkeys((scenarios.PAIR, scenarios.TRIPLE, *own)))

    @cached_property
    def role_names(self) -> frozenset[str]:
        """The names of all roles."""
        return frozenset(role for roles in self.all_roles for role in roles)

    @cached_property
    def _vehicles(self) -> Mapping[int, tuple[str, ...]]:
        """The vehicles of each scenario by number."""
        home = self.specification
        return {
            number: scenarios.vehicles_of(home, scenarios.Scenario(number, home.set_name))
            for number in self.numbers
        }

    @cached_property
    def class_names(self) -> Mapping[tuple[tuple[str, ...], tuple[int, ...], tuple[int, ...]], str]:
        """The name of each class by its vehicles, rows and sectors."""
        made = () if self.classes is None else self.classes.all()
        return {(one.vehicles, *_cell(one)): one.name for one in made}

    def on(
        self, road: Road, roles: tuple[str, ...], vehicles: tuple[str, ...], lane: str
    ) -> Mapping[TargetKey, Formula]:
        """Return the formulas of ``vehicles`` in these ``roles``, bound to a road with ``lane`` for L."""
        place = (road, roles, vehicles, lane)
        if place not in self.bound:
            keys, whole = self._whole(roles, vehicles)
            bound = bind(whole, road, {scenarios.LANE: lane}, self.values)
            self.bound[place] = dict(zip(keys, f.children(self._shared(bound)), strict=True))
        return self.bound[place]

    def _whole(
        self, roles: tuple[str, ...], vehicles: tuple[str, ...]
    ) -> tuple[tuple[TargetKey, ...], Formula]:
        """Return all keys, and their formulas as one conjunction, for any road."""
        if (roles, vehicles) not in self.wholes:
            queries = self._queries(roles, vehicles)
            whole = self._shared(f.And(tuple(x.formula for x in queries.values())))
            self.wholes[roles, vehicles] = (tuple(queries), whole)
        return self.wholes[roles, vehicles]

    def _shared(self, formula: Formula) -> Formula:
        """Return a formula with one object for equal parts, since comparing trees takes long."""
        return f.transform(formula, lambda part: self.parts.setdefault(part, part))

    def _queries(self, roles: tuple[str, ...], vehicles: tuple[str, ...]) -> dict[TargetKey, Query]:
        """Return the formula of each key for ``vehicles`` in these ``roles``, on any road."""
        home = self.specification
        queries: dict[TargetKey, Query] = {
            EndangeredKey(): scenario_parts.danger_comes(home, *scenario_parts.danger_pair(vehicles))
        }
        for number in self.numbers:
            if self._vehicles[number] == roles:
                queries[ScenarioKey(number)] = scenarios.apply_scenario(
                    home, scenarios.Scenario(number, home.set_name), vehicles
                )
        if self.classes is not None:
            for group in self.classes.plan.groups:
                if group.vehicles == roles:
                    queries |= self._rows(self.classes.plan, group, vehicles)
        return queries

    def _rows(
        self, plan: DivisionPlan, group: ScenarioGroup, vehicles: tuple[str, ...]
    ) -> dict[TargetKey, Query]:
        """Return the rows of a group of classes, and the road sectors where classes have places."""
        home, (first, *others) = self.specification, vehicles
        start = [scenario_parts.safe(home, first, other) for other in others]
        rows: dict[TargetKey, Query] = {}
        for number in group.disturbances:
            if plan.has_places:
                rows[RowKey(number)] = both(*start, scenario_parts.disturbance(home, number, vehicles))
            else:
                rows[RowKey(number)] = scenarios.apply_scenario(
                    home, scenarios.Scenario(number, home.set_name), vehicles
                )
        if plan.has_places:
            rows |= {
                SectorKey(number): scenario_parts.sector(home, number, vehicles) for number in plan.sectors
            }
        return rows

    def scenarios_of(self, vehicles: Sequence[str]) -> dict[str, Query]:
        """Return the scenarios between some of ``vehicles``, applied to these and L, by name."""
        return {
            scenarios.name_of(number): scenarios.apply_scenario(
                self.specification, scenarios.Scenario(number, self.specification.set_name)
            )
            for number in self.numbers
            if set(self._vehicles[number]) <= {*vehicles}
        }

    def query_of(self, name: str) -> Query:
        """Return the formula of a scenario or a class by name."""
        number = scenarios.number_in(name)
        if number is None:
            return self.class_query(name)
        return scenarios.apply_scenario(
            self.specification, scenarios.Scenario(number, self.specification.set_name)
        )

    def class_query(self, name: str) -> Query:
        """Return the formula of a class by name: which rows hold and which do not, and in which sectors."""
        assert self.classes is not None
        one = next(x for x in self.classes.all() if x.name == name)
        group = next(x for x in self.classes.plan.groups if x.vehicles == one.vehicles)
        rows = self._rows(self.classes.plan, group, one.vehicles)
        true_rows, sectors = _cell(one)
        true = {RowKey(n) for n in true_rows} | {SectorKey(n) for n in sectors}
        return both(*(query if key in true else negation(query) for key, query in rows.items()))

    def names_of(self, roles: tuple[str, ...], true: frozenset[TargetKey]) -> list[str]:
        """Return the names of the targets that hold where these keys are true: scenarios, the class, danger.

        For a class that is proved empty the name is ``NO_CLASS``: the readers contradict each other.
        """
        names = [scenarios.name_of(key.number) for key in true if isinstance(key, ScenarioKey)]
        rows = tuple(sorted(key.number for key in true if isinstance(key, RowKey)))
        sectors = tuple(sorted(key.number for key in true if isinstance(key, SectorKey)))
        if self.classes is not None and rows and (sectors or not self.classes.plan.has_places):
            names.append(self.class_names.get((roles, rows, sectors), NO_CLASS))
        return [*names, ENDANGERED] if EndangeredKey() in true else names


def _cell(one: Class) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the rows that hold in a class, and its sectors."""
    return one.what.holds, () if one.where is None else one.where.holds
