"""Parts of scenarios, and what is said of their vehicles, of which extensions make questions.

This file and ``library.scenarios`` alone name definitions of the template.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.errors import InputError
from roadproof.library.compose import both, either, eventually
from roadproof.library.elaborate import apply_definition, elaborate, read_claim, signature
from roadproof.library.scenario_names import LANE as LANE
from roadproof.library.scenario_names import PAIR as PAIR
from roadproof.library.scenario_names import SUBJECT as SUBJECT
from roadproof.library.scenario_names import TRIPLE as TRIPLE
from roadproof.library.scenario_names import Scenario as Scenario
from roadproof.library.scenarios import (
    BEHAVIOURS,
    ZONES,
    danger,
    disturbance_name,
    initial_condition_name,
    sector_name,
    vehicles_of,
)
from roadproof.library.specification import Query, Specification
from roadproof.logic import syntax
from roadproof.world.road import Zone

RSS_PARAMETERS = ("rho", "a_max", "b_min", "b_max", "a_max_lat", "b_min_lat")
_COMPONENTS = (*BEHAVIOURS, "initialCondition")


def lane_owner(specification: Specification, scenario: Scenario) -> str:
    """Return the vehicle whose lane at the start is L. Raises ``InputError`` if it is not in the scenario."""
    declared = specification.library.lanes.get(scenario.number)
    if declared is None:
        return SUBJECT
    vehicles = vehicles_of(specification, scenario)
    if declared.vehicle not in vehicles:
        raise InputError(
            f"lane of {declared.vehicle} for {scenario.number}: the scenario has {', '.join(vehicles)}; "
            "name one of them"
        )
    return declared.vehicle


def danger_pair(vehicles: Sequence[str]) -> tuple[str, str]:
    """Return SV and the vehicle with which it comes into danger: the last POV."""
    return vehicles[0], vehicles[-1]


def sector(specification: Specification, number: int, vehicles: Sequence[str]) -> Query:
    """Return the road sector of a scenario as a query: where ``vehicles`` are. Raises ``TextError``."""
    return apply_definition(specification, sector_name(number), tuple(vehicles))


def disturbance(specification: Specification, number: int, vehicles: Sequence[str]) -> Query:
    """Return the disturbance of a scenario in the lane L, without safety and sector. Raises ``TextError``."""
    return apply_definition(specification, disturbance_name(number), (*vehicles, LANE))


def initial_condition(specification: Specification, number: int, vehicles: Sequence[str]) -> Query:
    """Return the initial condition of a scenario in the lane L, without safety. Raises ``TextError``."""
    return apply_definition(specification, initial_condition_name(number), (*vehicles, LANE))


def components(specification: Specification, number: int, vehicles: Sequence[str]) -> list[Query]:
    """Return the parts of a disturbance that use no other names than ``vehicles`` and L, behaviours first."""
    queries = []
    for kind in _COMPONENTS:
        name = f"{kind}_{number}"
        if name in specification.definitions:
            arguments = signature(specification, name)
            if {*arguments} <= {*vehicles, LANE}:
                queries.append(apply_definition(specification, name, arguments))
    return queries


def follows_template(specification: Specification, number: int) -> bool:
    """Return whether a scenario has a road sector and a disturbance of its own, as the template requires."""
    return not missing_part(specification, number)


def violation(specification: Specification, a: str, b: str) -> Query:
    """Return the query "two vehicles are closer than the RSS distances" (eq. rssViolation and danger_lat)."""
    return apply_definition(specification, "rssViolation", (a, b))


def safe(specification: Specification, a: str, b: str) -> Query:
    """Return the query "two vehicles are safe for minSafe from now on"."""
    return apply_definition(specification, "initSafe", (a, b))


def danger_comes(specification: Specification, a: str, b: str) -> Query:
    """Return the query "two vehicles are safe now and in danger later"."""
    return both(safe(specification, a, b), eventually(danger(specification, a, b)))


def start_requirements(specification: Specification, a: str, b: str) -> tuple[Query, ...]:
    """Return further requirements on the start of a drive of two vehicles; empty for most specifications."""
    name = "asked_between"
    return (apply_definition(specification, name, (a, b)),) if name in specification.definitions else ()


def in_lane(specification: Specification, vehicle: str, lane: str = LANE) -> Query:
    """Return the query "a vehicle occupies a lanelet of a lane"."""
    return apply_definition(specification, "atLane", (vehicle, lane))


def leaves_at_once(specification: Specification, vehicle: str) -> Query:
    """Return the query "a vehicle that leaves L has a first moment outside", true of continuous motions."""
    inside = f"atLane({vehicle}, {LANE})"
    return read_claim(specification, f"({inside} U not {inside}) or G {inside}")


def alone_in_lane(specification: Specification, vehicle: str) -> Query:
    """Return the query "a vehicle occupies no lanelet of a lane beside L"."""
    return read_claim(specification, f"every M in adjacentLanes({LANE}): not atLane({vehicle}, M)")


def danger_at(specification: Specification, a: str, b: str, time: Fraction) -> Query:
    """Return the query "two vehicles violate the RSS distances for minDanger from ``time`` (s) on"."""
    return read_claim(specification, f"F[{time} * 1 s, {time} * 1 s] danger({a}, {b})")


def in_zone(specification: Specification, vehicle: str, zone: Zone) -> Query:
    """Return the query "a vehicle occupies a lanelet of a zone"."""
    return apply_definition(specification, ZONES[zone], (vehicle,))


def in_some_zone(specification: Specification, vehicle: str) -> Query:
    """Return the query "a vehicle occupies a lanelet of one of the zones"."""
    return either(*(in_zone(specification, vehicle, zone) for zone in ZONES))


TEMPLATE = "initSafe and roadSector_i and disturb_i"


def missing_part(specification: Specification, number: int) -> str:
    """Return the first definition of a scenario's template that does not exist; empty if all do."""
    names = (sector_name(number), disturbance_name(number))
    return next((name for name in names if name not in specification.definitions), "")


Metric: TypeAlias = Literal["TTC", "THW", "none"]
DETECTORS: Mapping[str, Mapping[Metric, str]] = {
    "cut-in": {"TTC": "cutIn_ttc", "THW": "cutIn_thw", "none": "cutIn_free"},
    "deceleration": {"TTC": "decel_ttc", "THW": "decel_thw", "none": "decel_free"},
}
"""Detectors of earlier work, by what they detect and their danger metric (paper, RQ5)."""
COMPARISON = tuple(name for detectors in DETECTORS.values() for name in detectors.values())
"""The detectors in the paper's comparison table, all definitions of (SV, POV, L)."""


def beside_lane(specification: Specification, vehicle: str, lane: str = LANE) -> Query:
    """Return the query "a vehicle occupies a lanelet of a lane beside ``lane``"."""
    beside = syntax.Call("adjacentLanes", (syntax.Name(lane),))
    inside = syntax.Call("atLane", (syntax.Name(vehicle), syntax.Name("M")))
    return elaborate(specification, syntax.Claim((), syntax.Quantified("some", "M", beside, inside)))
