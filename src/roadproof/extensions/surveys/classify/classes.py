"""A refinement of the scenarios of a set into classes: what is divided, how, and the classes that come out.

A class is about one trace, its vehicles and a lane: it says which scenarios hold there, and that no others
do. The template (eq. scenarioAsInitSafePlusDisturb and disturbFormat) repeats the same disturbances for
each road sector, so there are two axes, what happens and where, and a class is a cell of one with a cell
of the other. Scenarios between different numbers of vehicles are divided apart.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from roadproof.errors import InputError, TextError, UsageError
from roadproof.evidence.specifications import specification_names
from roadproof.extensions.surveys.classify.cells import Axis, Cell
from roadproof.library import scenarios as s
from roadproof.library.alike import likes_of
from roadproof.library.elaborate import apply_definition, walk_of
from roadproof.library.scenarios import disturbance, sector
from roadproof.library.scenarios import name_of as scenario_name
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names

SET_NAME = "classes"
FILE_NAME = "classes.spec"
ANYBODY = s.PAIR  # SV and any group of vehicles
_WORD = re.compile(r"[a-z][a-z0-9]*")


@dataclass(frozen=True)
class Group:
    """Scenarios between the same vehicles; ``rows`` gives for each the first one with its disturbance, and
    the first one of all groups with its road sector.
    """

    vehicles: tuple[str, ...]
    rows: Mapping[int, tuple[int, int]]

    @property
    def arguments(self) -> str:
        """What its scenarios are applied to."""
        return f"({', '.join(self.vehicles)}, {s.LANE})"

    @property
    def disturbances(self) -> tuple[int, ...]:
        """The first scenario of each disturbance."""
        return tuple(sorted({disturbance for disturbance, _ in self.rows.values()}))


@dataclass(frozen=True)
class Plan:
    """What is to be divided: scenarios of the set ``set_name``.

    In words, each by its first scenario, ``sectors``: a name for each road sector; ``places``: what is said
    of it; ``happenings``: what each disturbance is.
    """

    set_name: str
    groups: tuple[Group, ...]
    sectors: Mapping[int, str]
    places: Mapping[int, str]
    happenings: Mapping[int, str]

    @property
    def has_places(self) -> bool:
        """Whether there are several road sectors; if not, scenarios are divided by what happens alone."""
        return len(self.sectors) > 1

    @property
    def numbers(self) -> tuple[int, ...]:
        """All its scenarios."""
        return tuple(sorted(number for group in self.groups for number in group.rows))

    def what(self, holds: Sequence[int]) -> str:
        """The name of a cell of what happens: ``what_4_8``, or ``class_4_8`` where there are no places."""
        return _joined("what" if self.has_places else "class", holds)

    def place(self, holds: Sequence[int]) -> str:
        """A name for a cell of road sectors, such as main_merge."""
        return "_".join(self.sectors[number] for number in holds)

    def where(self, holds: Sequence[int]) -> str:
        """The name of a cell of road sectors among definitions."""
        return f"where_{self.place(holds)}"


@dataclass(frozen=True)
class Class:
    """A class by name: exactly ``scenarios`` hold; ``what`` and ``where`` are the cells it is made of.

    In words, ``place`` is where and ``description`` what happens.
    """

    name: str
    vehicles: tuple[str, ...]
    scenarios: tuple[int, ...]
    what: Cell
    where: Cell | None
    place: str | None
    description: str

    @property
    def formula(self) -> str:
        """The class applied to its vehicles and L, as it is written."""
        return f"{self.name}({', '.join(self.vehicles)}, {s.LANE})"

    def query(self, specification: Specification) -> Query:
        """The class applied to its vehicles and L, in the set of the classes."""
        roles = (*self.vehicles, s.LANE)
        return apply_definition(specification, self.name, roles, walk_of(specification))


@dataclass(frozen=True)
class Classes:
    """The cells of each group of a plan, and those of its road sectors."""

    plan: Plan
    what: tuple[tuple[Cell, ...], ...]
    where: tuple[Cell, ...]

    def of(self, group: Group) -> tuple[Class, ...]:
        """The classes of a group."""
        what = self.what[self.plan.groups.index(group)]
        places: tuple[Cell | None, ...] = self.where if self.plan.has_places else (None,)
        return tuple(self._made(group, w, place) for w, place in product(what, places))

    def _made(self, group: Group, what: Cell, where: Cell | None) -> Class:
        description = "; ".join(self.plan.happenings[number] for number in what.holds)
        name = _joined("class", what.holds)
        if where is None:
            return Class(name, group.vehicles, what.holds, what, None, None, description)
        place = self.plan.place(where.holds)
        scenarios = tuple(
            number
            for number, (disturbance, sector) in group.rows.items()
            if disturbance in what.holds and sector in where.holds
        )
        return Class(f"{name}_{place}", group.vehicles, scenarios, what, where, place, description)

    def all(self) -> tuple[Class, ...]:
        """The classes of all groups."""
        return tuple(one for group in self.plan.groups for one in self.of(group))

    def alike(self) -> tuple[tuple[Class, ...], ...]:
        """The classes of all groups, those together in which the same happens."""
        return tuple(
            tuple(one for one in self.of(group) if one.what.holds == cell.holds)
            for group, cells in zip(self.plan.groups, self.what, strict=True)
            for cell in cells
        )


def _joined(prefix: str, holds: Sequence[int]) -> str:
    return "_".join([prefix, *map(str, holds)])


def plan_of(specification: Specification, numbers: Sequence[int]) -> Plan:
    """Scenarios by vehicles, disturbance and road sector. Raises ``InputError``, ``UsageError``.

    Every disturbance of a group has to be there for each of the same road sectors, as in the paper's table.
    """
    if specification.set_name == SET_NAME or SET_NAME in specification.library.sets:
        raise UsageError(f"there is a set '{SET_NAME}' already: classify the set that it extends")
    if FILE_NAME in specification_names(specification.library):
        raise UsageError(f"--spec: the output file for classes is {FILE_NAME}: rename your file")
    return plan_within(specification, numbers)


def plan_within(specification: Specification, numbers: Sequence[int]) -> Plan:
    """Return a plan whether or not its classes are defined. Raises ``InputError``, ``UsageError``."""
    likes = likes_of(specification)
    disturbances: dict[int, int] = {}
    sectors: dict[Formula, int] = {}
    groups: dict[tuple[str, ...], dict[int, tuple[int, int]]] = {}
    for number in numbers:
        vehicles = s.vehicles_of(specification, s.Scenario(number, specification.set_name))
        first = sectors.setdefault(_sector(specification, number), number)
        groups.setdefault(vehicles, {})[number] = (disturbances.setdefault(likes[number], number), first)
    for rows in groups.values():
        _check_rows(rows, tuple(sectors.values()))
    return Plan(
        specification.set_name,
        tuple(Group(vehicles, rows) for vehicles, rows in sorted(groups.items(), key=lambda x: len(x[0]))),
        _names(specification, tuple(sectors.values())),
        {number: s.sector_words(specification, number) for number in sectors.values()},
        {number: s.happening_words(specification, number) for number in disturbances.values()},
    )


def scenarios_in(plan: Plan, name: str) -> tuple[int, ...]:
    """Return the scenarios that hold in a class of a plan with places, which its name says."""
    words = name.split("_")[1:]
    holds = {int(x) for x in words if x.isdigit()}
    return tuple(
        number
        for group in plan.groups
        for number, (disturbance, sector) in group.rows.items()
        if disturbance in holds and plan.sectors[sector] in words
    )


def _sector(specification: Specification, number: int) -> Formula:
    missing = s.missing_part(specification, number)
    if missing:
        raise InputError(
            f"{scenario_name(number)}: there is no definition {missing}; classify needs the template "
            f"{s.TEMPLATE}, so leave the scenario out with --among"
        )
    try:
        return without_names(sector(specification, number, ANYBODY).formula)
    except TextError as error:
        told = f"{s.sector_name(number)} must take SV and any group of vehicles: {error}"
        raise InputError(told) from None


def _check_rows(rows: Mapping[int, tuple[int, int]], sectors: Sequence[int]) -> None:
    disturbances = {disturbance for disturbance, _ in rows.values()}
    if {*rows.values()} != {*product(disturbances, sectors)}:
        listed = ", ".join(map(str, rows))
        raise UsageError(
            f"--among: scenarios {listed} do not have the same disturbances in each road sector; name whole "
            "rows of the table, such as 1-8, 9-16 or 1-24"
        )


def _names(specification: Specification, sectors: Sequence[int]) -> dict[int, str]:
    """The first word of each sector's description, or its number where that is no name of its own."""
    docs = {number: s.sector_words(specification, number) for number in sectors}
    first = {n: (_WORD.findall(doc.lower()) or [str(n)])[0] for n, doc in docs.items()}
    words = list(first.values())
    return {n: word if words.count(word) == 1 else str(n) for n, word in first.items()}


def what_axis(plan: Plan, group: Group, specification: Specification) -> Axis:
    """What happens: disturbances after initSafe, or whole scenarios where there is one road sector only."""
    context = [s.safe(specification, group.vehicles[0], other) for other in group.vehicles[1:]]
    return Axis(
        tuple(context) if plan.has_places else (),
        {number: _row(plan, group, specification, number) for number in group.disturbances},
        {n: tuple(s.components(specification, n, group.vehicles)) for n in group.disturbances},
    )


def _row(plan: Plan, group: Group, specification: Specification, number: int) -> Query:
    if plan.has_places:
        return disturbance(specification, number, group.vehicles)
    return s.applied(specification, s.Scenario(number, specification.set_name), group.vehicles)


def where_axis(plan: Plan, specification: Specification) -> Axis:
    """Which road sectors the vehicles are in at the start."""
    return Axis((), {number: sector(specification, number, ANYBODY) for number in plan.sectors}, {})
