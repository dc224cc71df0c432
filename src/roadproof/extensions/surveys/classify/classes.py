"""The plan of a division of scenarios into classes, and the classes.

A class is about one trace, its vehicles and a lane: it says which scenarios hold there, and that no others
do. The template (eq. scenarioAsInitSafePlusDisturb and disturbFormat) repeats the same disturbances for
each road sector. So there are two axes, disturbances and road sectors, and a class is a cell of each.
Scenarios between different numbers of vehicles are divided separately.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from roadproof.errors import InputError, TextError, UsageError
from roadproof.evidence.specifications import specification_names
from roadproof.extensions.surveys.classify.cells import Axis, Cell
from roadproof.extensions.traffic import scenario_parts
from roadproof.extensions.traffic.scenario_parts import disturbance, sector
from roadproof.library import scenarios as scenario_library
from roadproof.library.elaborate import apply_definition, walk_of
from roadproof.library.scenarios import name_of as scenario_name
from roadproof.library.sector_twins import sector_twins
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names

SET_NAME = "classes"
FILE_NAME = "classes.spec"
ANYBODY = scenario_library.PAIR  # SV and any group of vehicles
_WORD = re.compile(r"[a-z][a-z0-9]*")


@dataclass(frozen=True)
class ScenarioGroup:
    """Scenarios between the same vehicles.

    ``rows``: for each scenario the first one with its disturbance, and the first one of all groups with its
    road sector.
    """

    vehicles: tuple[str, ...]
    rows: Mapping[int, tuple[int, int]]

    @property
    def arguments(self) -> str:
        """The arguments of its scenarios."""
        return f"({', '.join(self.vehicles)}, {scenario_library.LANE})"

    @property
    def disturbances(self) -> tuple[int, ...]:
        """The first scenario of each disturbance."""
        return tuple(sorted({disturbance for disturbance, _ in self.rows.values()}))


@dataclass(frozen=True)
class DivisionPlan:
    """The plan of a division of scenarios of the set ``set_name``.

    By the first scenario with it: ``sectors``: a name for each road sector; ``places``: its description;
    ``happenings``: the description of each disturbance.
    """

    set_name: str
    groups: tuple[ScenarioGroup, ...]
    sectors: Mapping[int, str]
    places: Mapping[int, str]
    happenings: Mapping[int, str]

    @property
    def has_places(self) -> bool:
        """Return whether there are several road sectors; with one, only behaviour divides scenarios."""
        return len(self.sectors) > 1

    @property
    def numbers(self) -> tuple[int, ...]:
        """The numbers of its scenarios."""
        return tuple(sorted(number for group in self.groups for number in group.rows))

    def what(self, holds: Sequence[int]) -> str:
        """Return the name of a cell of disturbances: ``what_4_8``, or ``class_4_8`` without road sectors."""
        return _joined("what" if self.has_places else "class", holds)

    def place(self, holds: Sequence[int]) -> str:
        """Return a word for a cell of road sectors, such as ``main_merge``."""
        return "_".join(self.sectors[number] for number in holds)

    def where(self, holds: Sequence[int]) -> str:
        """Return the name of the definition of a cell of road sectors."""
        return f"where_{self.place(holds)}"


@dataclass(frozen=True)
class Class:
    """A class, in which exactly ``scenarios`` hold; its cells are ``what`` happens and ``where``.

    ``place`` and ``description`` describe the two cells in words.
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
        """The text of the class applied to its vehicles and L."""
        return f"{self.name}({', '.join(self.vehicles)}, {scenario_library.LANE})"

    def query(self, specification: Specification) -> Query:
        """Return the class applied to its vehicles and L, read in the set of the classes."""
        roles = (*self.vehicles, scenario_library.LANE)
        return apply_definition(specification, self.name, roles, walk_of(specification))


@dataclass(frozen=True)
class Classes:
    """The cells of each group of a plan, and those of its road sectors."""

    plan: DivisionPlan
    what: tuple[tuple[Cell, ...], ...]
    where: tuple[Cell, ...]

    def of(self, group: ScenarioGroup) -> tuple[Class, ...]:
        """Return the classes of a group."""
        what = self.what[self.plan.groups.index(group)]
        places: tuple[Cell | None, ...] = self.where if self.plan.has_places else (None,)
        return tuple(self._made(group, w, place) for w, place in product(what, places))

    def _made(self, group: ScenarioGroup, what: Cell, where: Cell | None) -> Class:
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
        """Return the classes of all groups."""
        return tuple(one for group in self.plan.groups for one in self.of(group))

    def alike(self) -> tuple[tuple[Class, ...], ...]:
        """Return the classes of all groups, with those of the same disturbances together."""
        return tuple(
            tuple(one for one in self.of(group) if one.what.holds == cell.holds)
            for group, cells in zip(self.plan.groups, self.what, strict=True)
            for cell in cells
        )


def _joined(prefix: str, holds: Sequence[int]) -> str:
    return "_".join([prefix, *map(str, holds)])


def plan_of(specification: Specification, numbers: Sequence[int]) -> DivisionPlan:
    """Return the plan for scenarios. Raises ``InputError``, ``UsageError``.

    Each group needs every disturbance in the same road sectors, as in the paper's table.
    """
    if specification.set_name == SET_NAME or SET_NAME in specification.library.sets:
        raise UsageError(f"there is a set '{SET_NAME}' already: classify the set that it extends")
    if FILE_NAME in specification_names(specification.library):
        raise UsageError(f"--spec: the output file for classes is {FILE_NAME}: rename your file")
    return plan_within(specification, numbers)


def plan_within(specification: Specification, numbers: Sequence[int]) -> DivisionPlan:
    """Return a plan whether or not its classes are defined. Raises ``InputError``, ``UsageError``."""
    twins = sector_twins(specification)
    disturbances: dict[int, int] = {}
    sectors: dict[Formula, int] = {}
    groups: dict[tuple[str, ...], dict[int, tuple[int, int]]] = {}
    for number in numbers:
        vehicles = scenario_library.vehicles_of(
            specification, scenario_library.Scenario(number, specification.set_name)
        )
        first = sectors.setdefault(_sector(specification, number), number)
        groups.setdefault(vehicles, {})[number] = (disturbances.setdefault(twins[number], number), first)
    for rows in groups.values():
        _check_rows(rows, tuple(sectors.values()))
    return DivisionPlan(
        specification.set_name,
        tuple(
            ScenarioGroup(vehicles, rows)
            for vehicles, rows in sorted(groups.items(), key=lambda x: len(x[0]))
        ),
        _names(specification, tuple(sectors.values())),
        {number: scenario_library.sector_words(specification, number) for number in sectors.values()},
        {number: scenario_library.happening_words(specification, number) for number in disturbances.values()},
    )


def scenarios_in(plan: DivisionPlan, name: str) -> tuple[int, ...]:
    """Return the scenarios that hold in the class of a name, of a plan with road sectors."""
    words = name.split("_")[1:]
    holds = {int(x) for x in words if x.isdigit()}
    return tuple(
        number
        for group in plan.groups
        for number, (disturbance, sector) in group.rows.items()
        if disturbance in holds and plan.sectors[sector] in words
    )


def _sector(specification: Specification, number: int) -> Formula:
    missing = scenario_parts.missing_part(specification, number)
    if missing:
        raise InputError(
            f"{scenario_name(number)}: there is no definition {missing}; classify needs the template "
            f"{scenario_parts.TEMPLATE}, so leave the scenario out with --among"
        )
    try:
        return without_names(sector(specification, number, ANYBODY).formula)
    except TextError as error:
        message = f"{scenario_library.sector_name(number)} must take SV and any group of vehicles: {error}"
        raise InputError(message) from None


def _check_rows(rows: Mapping[int, tuple[int, int]], sectors: Sequence[int]) -> None:
    disturbances = {disturbance for disturbance, _ in rows.values()}
    if {*rows.values()} != {*product(disturbances, sectors)}:
        listed = ", ".join(map(str, rows))
        raise UsageError(
            f"--among: scenarios {listed} do not have the same disturbances in each road sector; name whole "
            "rows of the table, such as 1-8, 9-16 or 1-24"
        )


def _names(specification: Specification, sectors: Sequence[int]) -> dict[int, str]:
    """Return the first word of each sector's description, or its number where that word is not unique."""
    docs = {number: scenario_library.sector_words(specification, number) for number in sectors}
    first = {n: (_WORD.findall(doc.lower()) or [str(n)])[0] for n, doc in docs.items()}
    words = list(first.values())
    return {n: word if words.count(word) == 1 else str(n) for n, word in first.items()}


def what_axis(plan: DivisionPlan, group: ScenarioGroup, specification: Specification) -> Axis:
    """Return the axis of disturbances after initSafe, or of whole scenarios for a single road sector."""
    context = [scenario_parts.safe(specification, group.vehicles[0], other) for other in group.vehicles[1:]]
    return Axis(
        tuple(context) if plan.has_places else (),
        {number: _row(plan, group, specification, number) for number in group.disturbances},
        {n: tuple(scenario_parts.components(specification, n, group.vehicles)) for n in group.disturbances},
    )


def _row(plan: DivisionPlan, group: ScenarioGroup, specification: Specification, number: int) -> Query:
    if plan.has_places:
        return disturbance(specification, number, group.vehicles)
    return scenario_library.apply_scenario(
        specification, scenario_library.Scenario(number, specification.set_name), group.vehicles
    )


def where_axis(plan: DivisionPlan, specification: Specification) -> Axis:
    """Return the axis of road sectors at the start."""
    return Axis((), {number: sector(specification, number, ANYBODY) for number in plan.sectors}, {})
