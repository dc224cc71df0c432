"""Road sectors: which scenarios happen where, and whether a recording's road has such a place."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from roadproof.errors import TextError
from roadproof.extensions.traffic import scenario_parts
from roadproof.library import scenarios as scenario_library
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, conjunction, disjunction, negation, transform
from roadproof.logic.rewrite import without_names

ANYWHERE = "anywhere"
"""The name of the sector of scenarios that have none."""


@dataclass(frozen=True)
class Sector:
    """Scenarios that happen in one place, and those among them ``of_three`` cars.

    ``where``: that SV and POV are there, None where nothing is asked.
    """

    name: str
    scenarios: tuple[int, ...]
    of_three: tuple[int, ...]
    where: Query | None

    def __str__(self) -> str:
        return self.name


def sectors_of(specification: Specification, numbers: Iterable[int]) -> tuple[Sector, ...]:
    """The scenarios by road sector, in the order in which the sectors come first."""
    sectors: dict[tuple[str, Formula | None], Sector] = {}
    for number in numbers:
        name, where = _place_of(specification, number)
        key = name, None if where is None else without_names(where.formula)
        known = sectors.get(key, Sector(name, (), (), where))
        vehicles = scenario_library.vehicles_of(
            specification, scenario_library.Scenario(number, specification.set_name)
        )
        three = (number,) if len(vehicles) == len(scenario_library.TRIPLE) else ()
        scenarios, of_three = (*known.scenarios, number), (*known.of_three, *three)
        sectors[key] = replace(known, scenarios=scenarios, of_three=of_three)
    return tuple(sectors.values())


def _place_of(specification: Specification, number: int) -> tuple[str, Query | None]:
    if not scenario_parts.follows_template(specification, number):
        return ANYWHERE, None
    name = scenario_library.sector_words(specification, number) or f"sector of {number}"
    try:
        return name, scenario_parts.sector(specification, number, scenario_library.PAIR)
    except TextError:  # a sector of three vehicles that says nothing of two
        return name, None


def is_possible(sector: Sector, zones: Iterable[str]) -> bool:
    """Return whether a sector can be met on a road that has lanelets of no other than these ``zones``.

    True is said in doubt: then its scenarios are asked, and found or not.
    """
    there = {*zones}

    def change(part: Formula) -> Formula:
        match part:
            case f.Some(domain=f.Domain("zone", zone)):
                return part if zone in there else f.FALSE
            case f.And():
                return conjunction(*part.parts)
            case f.Or():
                return disjunction(*part.parts)
            case f.Not():
                return negation(part.body)
        return part

    if sector.where is None:
        return True
    return transform(without_names(sector.where.formula), change) != f.FALSE
