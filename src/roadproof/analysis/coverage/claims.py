"""Whether a spec set misses a disturbance between two vehicles, and what is asked of a drive that shows it.

A gap of a set is a drive that starts in safety (initSafe), comes into danger later, and on which no
scenario of the set holds at the start, for any lane and with the two vehicles in either role.
"""

from collections.abc import Sequence

from roadproof.engines.search.question import zones_of
from roadproof.library.compose import both, either, eventually, implication, in_some_lane, negation
from roadproof.library.scenarios import (
    LANE,
    PAIR,
    SUBJECT,
    Scenario,
    applied,
    asked_between,
    danger,
    in_lane,
    in_some_zone,
    numbers_of,
    safe,
    sector,
    vehicles_of,
)
from roadproof.library.specification import Library, Query, Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.world.road import Road

PROOF = 60.0  # units of work for a claim of coverage


def two_vehicle_numbers(specification: Specification) -> tuple[int, ...]:
    """The scenarios between SV and one POV."""
    name = specification.set_name
    numbers = numbers_of(specification)
    return tuple(n for n in numbers if len(vehicles_of(specification, Scenario(n, name))) == len(PAIR))


def sectors_of(specification: Specification) -> tuple[tuple[int, ...], ...]:
    """The two-vehicle scenarios, those of one road sector together, in the order of their numbers."""
    sectors: dict[Formula, list[int]] = {}
    for number in two_vehicle_numbers(specification):
        where = sector(specification, number, PAIR).formula
        sectors.setdefault(without_names(where), []).append(number)
    return tuple(map(tuple, sectors.values()))


def numbers_on(
    road: Road, specification: Specification, sectors: Sequence[tuple[int, ...]]
) -> tuple[int, ...]:
    """The scenarios of the sectors whose zones the road has; the others cannot hold on it."""
    zones = {lanelet.zone for lanelet in road.lanelets}
    found: list[int] = []
    for numbers in sectors:
        if zones_of(sector(specification, numbers[0], PAIR).formula) <= zones:
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
    somewhere = both(*(in_some_zone(specification, vehicle) for vehicle in PAIR))
    some_sector = either(*(sector(specification, numbers[0], PAIR) for numbers in sectors))
    return (*claims, implication(somewhere, some_sector))


def starts(specification: Specification) -> tuple[Query, ...]:
    """That the two vehicles are safe and in danger later, and what else drives are asked to begin with."""
    later = eventually(danger(specification, *PAIR))
    return safe(specification, *PAIR), later, *asked_between(specification, *PAIR)


def starts_in(specification: Specification, numbers: Sequence[int]) -> Query:
    """Safety and later danger in the road sector of these scenarios, with SV in L."""
    where = sector(specification, numbers[0], PAIR)
    return both(where, in_lane(specification, SUBJECT), *starts(specification))


def in_either_role(specification: Specification, numbers: Sequence[int], set_name: str = "") -> list[Query]:
    """The scenarios for L, each with the two vehicles in either role; ``set_name``: those of another set."""
    name = set_name or specification.set_name
    roles = (PAIR, PAIR[::-1])
    return [applied(specification, Scenario(n, name), pair) for pair in roles for n in numbers]


def missed(specification: Specification, numbers: Sequence[int]) -> Query:
    """Safety and later danger, and none of the scenarios for any lane and either role."""
    none = (negation(in_some_lane(x, LANE)) for x in in_either_role(specification, numbers))
    return both(*starts(specification), *none)


def caught(specification: Specification, numbers: Sequence[int], set_name: str) -> Query:
    """That one of the scenarios of a set holds, for some lane and either role."""
    return in_some_lane(either(*in_either_role(specification, numbers, set_name)), LANE)


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
