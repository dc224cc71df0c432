"""What tests are asked: which scenarios hold, and what their classes are made of, from any instant on.

A class is a choice of disturbances with a choice of road sectors (``classify.classes``), so all classes
follow from a few formulas: the rows. They share almost all of their parts with the scenarios, and are
judged together with them, once for all.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import TypeAlias

from roadproof.errors import RoadproofError, UsageError
from roadproof.extensions.catalogue.gaps import GapKinds, gap_kinds
from roadproof.extensions.surveys.classify.classes import Class, Classes, Group, Plan
from roadproof.extensions.surveys.extremes.points import Remembered
from roadproof.library import scenarios as s
from roadproof.library.bind import bind
from roadproof.library.compose import both, negation
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.questions.basis import Basis
from roadproof.world.road import Road

NOWHERE = "no class"
"""What is shown by a test that is in none of the classes, though scenarios hold."""


@dataclass(frozen=True)
class ScenarioQuestion:
    """The scenario ``number`` holds."""

    number: int


@dataclass(frozen=True)
class Row:
    """What happens in the scenario ``number`` and in all that differ from it in the road sector only."""

    number: int


@dataclass(frozen=True)
class In:
    """The vehicles are in the road sector of the scenario ``number``."""

    number: int


@dataclass(frozen=True)
class DangerQuestion:
    """The vehicles are safe now, and come into danger."""


Key: TypeAlias = ScenarioQuestion | Row | In | DangerQuestion


@dataclass
class Questions:
    """The questions to tests about scenarios ``numbers``; ``classes`` None where they are not divided.

    Formulas are kept by roles and vehicles; bound ones also by road and lane. ``parts``: one object for all
    their parts that are equal, in all spec sets. ``remembered``: what drives showed.
    """

    specification: Specification
    numbers: tuple[int, ...]
    classes: Classes | None
    values: Mapping[str, Fraction]
    wholes: dict[tuple[tuple[str, ...], tuple[str, ...]], tuple[tuple[Key, ...], Formula]] = field(
        default_factory=dict
    )
    bound: dict[tuple[Road, tuple[str, ...], tuple[str, ...], str], dict[Key, Formula]] = field(
        default_factory=dict
    )
    parts: dict[Formula, Formula] = field(default_factory=dict)
    remembered: Remembered = field(default_factory=Remembered, compare=False, repr=False)

    @property
    def is_always_judged(self) -> bool:
        """Whether no part can fail to be judged: definitions of users may speak of what a drive lacks."""
        return not self.specification.library.files

    @cached_property
    def in_other_sets(self) -> "Mapping[str, Questions]":
        """The same scenarios without classes in each other spec set that can be asked about."""
        home, found = self.specification, {}
        for name in (x for x in home.library.sets if x != home.set_name):
            with suppress(RoadproofError):
                there = home.in_set(name)
                numbers = tuple(x for x in self.numbers if x in s.numbers_of(there))
                found[name] = Questions(there, numbers, None, self.values, parts=self.parts)
        return found

    @cached_property
    def gaps(self) -> GapKinds | None:
        """The classes of gaps between two vehicles; None where these scenarios do not make any."""
        try:
            return gap_kinds(Basis(self.specification, values=self.values), self.numbers)
        except UsageError:
            return None

    @cached_property
    def roles(self) -> tuple[tuple[str, ...], ...]:
        """What the vehicles of the scenarios are called, each choice once."""
        return tuple(dict.fromkeys(self._vehicles.values()))

    @cached_property
    def all_roles(self) -> tuple[tuple[str, ...], ...]:
        """What the vehicles of all scenarios of the specification are called, each choice once."""
        home = self.specification
        own = (s.vehicles_of(home, s.Scenario(number, home.set_name)) for number in s.numbers_of(home))
        return tuple(dict.fromkeys((s.PAIR, s.TRIPLE, *own)))

    @cached_property
    def role_names(self) -> frozenset[str]:
        """All roles."""
        return frozenset(role for roles in self.all_roles for role in roles)

    @cached_property
    def _vehicles(self) -> Mapping[int, tuple[str, ...]]:
        home = self.specification
        return {number: s.vehicles_of(home, s.Scenario(number, home.set_name)) for number in self.numbers}

    @cached_property
    def named(self) -> Mapping[tuple[tuple[str, ...], tuple[int, ...], tuple[int, ...]], str]:
        """The name of each class by its vehicles, rows and sectors."""
        made = () if self.classes is None else self.classes.all()
        return {(one.vehicles, *_cell(one)): one.name for one in made}

    def on(
        self, road: Road, roles: tuple[str, ...], vehicles: tuple[str, ...], lane: str
    ) -> Mapping[Key, Formula]:
        """All questions to ``vehicles`` in these ``roles``, on a road with L for ``lane``."""
        place = (road, roles, vehicles, lane)
        if place not in self.bound:
            keys, whole = self._whole(roles, vehicles)
            bound = bind(whole, road, {s.LANE: lane}, self.values)
            self.bound[place] = dict(zip(keys, f.children(self._shared(bound)), strict=True))
        return self.bound[place]

    def _whole(self, roles: tuple[str, ...], vehicles: tuple[str, ...]) -> tuple[tuple[Key, ...], Formula]:
        """All questions, and their formulas as one conjunction, for any road."""
        if (roles, vehicles) not in self.wholes:
            asked = self._queries(roles, vehicles)
            whole = self._shared(f.And(tuple(x.formula for x in asked.values())))
            self.wholes[roles, vehicles] = (tuple(asked), whole)
        return self.wholes[roles, vehicles]

    def _shared(self, formula: Formula) -> Formula:
        """Equal parts as one object: readers look up what they know, and comparing trees takes long."""
        return f.transform(formula, lambda part: self.parts.setdefault(part, part))

    def _queries(self, roles: tuple[str, ...], vehicles: tuple[str, ...]) -> dict[Key, Query]:
        home = self.specification
        asked: dict[Key, Query] = {DangerQuestion(): s.danger_comes(home, *s.endangered(vehicles))}
        for number in self.numbers:
            if self._vehicles[number] == roles:
                asked[ScenarioQuestion(number)] = s.applied(home, s.Scenario(number, home.set_name), vehicles)
        if self.classes is not None:
            for group in self.classes.plan.groups:
                if group.vehicles == roles:
                    asked |= self._rows(self.classes.plan, group, vehicles)
        return asked

    def _rows(self, plan: Plan, group: Group, vehicles: tuple[str, ...]) -> dict[Key, Query]:
        home, (first, *others) = self.specification, vehicles
        start = [s.safe(home, first, other) for other in others]
        asked: dict[Key, Query] = {}
        for number in group.disturbances:
            if plan.has_places:
                asked[Row(number)] = both(*start, s.disturbance(home, number, vehicles))
            else:
                asked[Row(number)] = s.applied(home, s.Scenario(number, home.set_name), vehicles)
        if plan.has_places:
            asked |= {In(number): s.sector(home, number, vehicles) for number in plan.sectors}
        return asked

    def scenarios_of(self, vehicles: Sequence[str]) -> dict[str, Query]:
        """The scenarios between some of ``vehicles``, applied to these and L, by name."""
        return {
            s.name_of(number): s.applied(self.specification, s.Scenario(number, self.specification.set_name))
            for number in self.numbers
            if set(self._vehicles[number]) <= {*vehicles}
        }

    def query_of(self, name: str) -> Query:
        """A scenario or a class by name, as a formula."""
        number = s.number_in(name)
        if number is None:
            return self.class_query(name)
        return s.applied(self.specification, s.Scenario(number, self.specification.set_name))

    def class_query(self, name: str) -> Query:
        """The class of that name: which rows hold and which do not, and in which sectors."""
        assert self.classes is not None
        one = next(x for x in self.classes.all() if x.name == name)
        group = next(x for x in self.classes.plan.groups if x.vehicles == one.vehicles)
        rows = self._rows(self.classes.plan, group, one.vehicles)
        held, sectors = _cell(one)
        true = {Row(n) for n in held} | {In(n) for n in sectors}
        return both(*(query if key in true else negation(query) for key, query in rows.items()))

    def shown(self, roles: tuple[str, ...], true: frozenset[Key]) -> list[str]:
        """The names of all that is shown where these keys are true: scenarios, and the class.

        A class that is proved to be empty is shown as ``NOWHERE``: the readers contradict each other.
        """
        names = [s.name_of(key.number) for key in true if isinstance(key, ScenarioQuestion)]
        rows = tuple(sorted(key.number for key in true if isinstance(key, Row)))
        sectors = tuple(sorted(key.number for key in true if isinstance(key, In)))
        if self.classes is not None and rows and (sectors or not self.classes.plan.has_places):
            names.append(self.named.get((roles, rows, sectors), NOWHERE))
        return names


def _cell(one: Class) -> tuple[tuple[int, ...], tuple[int, ...]]:
    return one.what.holds, () if one.where is None else one.where.holds
