"""A refinement of the scenarios of a set into classes: what is divided, and the classes that come out.

A class is about one trace, its vehicles and a lane: it says which scenarios hold there, and that no others
do. The template (eq. scenarioAsInitSafePlusDisturb and disturbFormat) repeats the same disturbances for
each road sector, so there are two axes, what happens and where, and a class is a cell of one with a cell
of the other. Scenarios between different numbers of vehicles are divided apart.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from roadproof.analysis.classify.cells import Axis, Cell
from roadproof.errors import InputError, TextError, UsageError
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.spec.elaborate import read_claim, signature
from roadproof.spec.library import Specification
from roadproof.spec.scenarios import Scenario, likes_of, vehicles_of

SET_NAME = "classes"
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
        return f"({', '.join(self.vehicles)}, L)"

    @property
    def disturbances(self) -> tuple[int, ...]:
        """The first scenario of each disturbance."""
        return tuple(sorted({disturbance for disturbance, _ in self.rows.values()}))


@dataclass(frozen=True)
class Plan:
    """What is to be divided; ``sectors``: a word for each road sector by its first scenario."""

    groups: tuple[Group, ...]
    sectors: Mapping[int, str]

    @property
    def has_places(self) -> bool:
        """Whether there are several road sectors; if not, scenarios are divided by what happens alone."""
        return len(self.sectors) > 1


@dataclass(frozen=True)
class Class:
    """A class by name: exactly ``scenarios`` hold; ``what`` and ``where`` are the cells it is made of."""

    name: str
    vehicles: tuple[str, ...]
    scenarios: tuple[int, ...]
    what: Cell
    where: Cell | None

    @property
    def formula(self) -> str:
        """The class applied to its vehicles and L."""
        return f"{self.name}({', '.join(self.vehicles)}, L)"


@dataclass(frozen=True)
class Classes:
    """The cells of each group of a plan, and those of its road sectors."""

    plan: Plan
    what: tuple[tuple[Cell, ...], ...]
    where: tuple[Cell, ...]

    def of(self, group: Group) -> tuple[Class, ...]:
        """The classes of a group."""
        what = self.what[self.plan.groups.index(group)]
        if not self.plan.has_places:
            return tuple(Class(name_of("class", w), group.vehicles, w.holds, w, None) for w in what)
        return tuple(
            Class(
                f"{name_of('class', w)}_{self.place(place)}",
                group.vehicles,
                tuple(
                    number
                    for number, (disturbance, sector) in group.rows.items()
                    if disturbance in w.holds and sector in place.holds
                ),
                w,
                place,
            )
            for w, place in product(what, self.where)
        )

    def place(self, cell: Cell) -> str:
        """A name for a cell of road sectors, such as main_merge."""
        return "_".join(self.plan.sectors[number] for number in cell.holds)

    def all(self) -> tuple[Class, ...]:
        """The classes of all groups."""
        return tuple(one for group in self.plan.groups for one in self.of(group))


def name_of(prefix: str, cell: Cell) -> str:
    """``what_4_8`` for the cell where 4 and 8 hold."""
    return "_".join([prefix, *map(str, cell.holds)])


def plan_of(specification: Specification, numbers: Sequence[int]) -> Plan:
    """Scenarios by vehicles, disturbance and road sector. Raises ``InputError``, ``UsageError``.

    Every disturbance of a group has to be there for each of the same road sectors, as in the paper's table.
    """
    if specification.set_name == SET_NAME or SET_NAME in specification.library.sets:
        raise UsageError(f"there is a set '{SET_NAME}' already: classify the set that it extends, without it")
    likes = likes_of(specification)
    disturbances: dict[int, int] = {}
    sectors: dict[Formula, int] = {}
    groups: dict[tuple[str, ...], dict[int, tuple[int, int]]] = {}
    for number in numbers:
        vehicles = vehicles_of(specification, Scenario(number, specification.set_name))
        sector = sectors.setdefault(_sector(specification, number), number)
        disturbance = disturbances.setdefault(likes[number], number)
        groups.setdefault(vehicles, {})[number] = (disturbance, sector)
    for rows in groups.values():
        _check_rows(rows, tuple(sectors.values()))
    words = _words(specification, tuple(sectors.values()))
    return Plan(tuple(Group(vehicles, rows) for vehicles, rows in sorted(groups.items(), key=_size)), words)


def _size(item: tuple[tuple[str, ...], object]) -> int:
    return len(item[0])


def _sector(specification: Specification, number: int) -> Formula:
    for name in (f"roadSector_{number}", f"disturb_{number}"):
        if name not in specification.definitions:
            raise InputError(
                f"scenario_{number}: there is no definition {name}; classify needs the template "
                "initSafe and roadSector_i and disturb_i, so leave the scenario out with --among"
            )
    try:
        return without_names(read_claim(specification, f"roadSector_{number}(SV, POV)").formula)
    except TextError as error:
        raise InputError(f"roadSector_{number} must take SV and any group of vehicles: {error}") from None


def _check_rows(rows: Mapping[int, tuple[int, int]], sectors: Sequence[int]) -> None:
    disturbances = {disturbance for disturbance, _ in rows.values()}
    if {*rows.values()} != {*product(disturbances, sectors)}:
        listed = ", ".join(map(str, rows))
        raise UsageError(
            f"--among: scenarios {listed} do not have the same disturbances in each road sector; name whole "
            "rows of the table, such as 1-8, 9-16 or 1-24"
        )


def _words(specification: Specification, sectors: Sequence[int]) -> dict[int, str]:
    """The first word of each sector's description, or its number where that is no name of its own."""
    docs = {n: specification.describe(specification.definitions[f"roadSector_{n}"]) for n in sectors}
    first = {n: (_WORD.findall(doc.lower()) or [str(n)])[0] for n, doc in docs.items()}
    words = list(first.values())
    return {n: word if words.count(word) == 1 else str(n) for n, word in first.items()}


def what_axis(plan: Plan, group: Group, specification: Specification) -> Axis:
    """What happens: disturbances after initSafe, or whole scenarios where there is one road sector only."""
    row = "disturb" if plan.has_places else "scenario"
    safe = [f"initSafe(SV, {other})" for other in group.vehicles[1:]]
    return Axis(
        tuple(safe) if plan.has_places else (),
        {n: f"{row}_{n}{group.arguments}" for n in group.disturbances},
        {n: tuple(_parts(specification, group, n)) for n in group.disturbances},
    )


def where_axis(plan: Plan, vehicles: Sequence[str]) -> Axis:
    """Which road sectors the vehicles are in at the start."""
    listed = ", ".join(vehicles)
    return Axis((), {n: f"roadSector_{n}({listed})" for n in plan.sectors}, {})


def _parts(specification: Specification, group: Group, number: int) -> list[str]:
    """The parts of a disturbance (eq. disturbFormat) that are definitions of the group's vehicles and L."""
    parts = []
    for kind in ("behaviourSV", "behaviourPOV", "initialCondition"):
        name = f"{kind}_{number}"
        if name in specification.definitions:
            arguments = signature(specification, name)
            if {*arguments} <= {*group.vehicles, "L"}:
                parts.append(f"{name}({', '.join(arguments)})")
    return parts
