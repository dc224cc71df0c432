"""The template of the scenarios, and what its definitions are called: no other file knows these names.

A scenario is ``scenario_i := initSafe and roadSector_i and disturb_i`` with ``disturb_i :=
initialCondition_i and behaviourSV_i and behaviourPOV_i`` (paper, eq. scenarioAsInitSafePlusDisturb and
disturbFormat). Its arguments are SV, POVs and a lane L. The numbers, the vehicles, the road sectors and
whose lane L is come from the specification.
"""

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.errors import InputError
from roadproof.library.compose import both, either, eventually
from roadproof.library.elaborate import apply_definition, elaborate, read_claim, signature, walk_of
from roadproof.library.elaboration import Elaborator
from roadproof.library.specification import Query, Specification, source_of
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.formula import Formula, transform
from roadproof.logic.syntax import Definition, TitleDeclaration
from roadproof.runtime.records import dataclass
from roadproof.world.road import Zone

MIN_SAFE, MIN_DANGER = "minSafe", "minDanger"
RSS_PARAMETERS = ("rho", "a_max", "b_min", "b_max", "a_max_lat", "b_min_lat")
SUBJECT, LANE = "SV", "L"

_ZONES: dict[Zone, str] = {"main": "onMainRoad", "merge": "inMergeZone", "depart": "inDepartZone"}
_SCENARIO = re.compile(r"scenario_(\d{1,6})")
_NAMED = re.compile(r"\bscenario_(\d{1,6})\b")
_NUMBERS = re.compile(r"(scenario_)?\d[\d,\s-]*")
_BEHAVIOURS = ("behaviourSV", "behaviourPOV")
_COMPONENTS = (*_BEHAVIOURS, "initialCondition")
TEMPLATE_NAMES = (
    *("rssViolation", "initSafe", "danger", "dangerAhead", "dangerLeft", "asked_between", "atLane"),
    *_ZONES.values(),
)
"""The definitions that provers and searches use whether a formula names them or not."""


@dataclass(frozen=True)
class Scenario:
    """A scenario by number, in a spec set."""

    number: int
    set_name: str

    def __str__(self) -> str:
        return f"{self.number}@{self.set_name}"


# --- scenarios ----------------------------------------------------------------------------------


def numbers_of(specification: Specification) -> tuple[int, ...]:
    """The numbers of the scenarios that a specification defines, in order."""
    found = (number_in(name) for name in specification.definitions)
    return tuple(sorted(number for number in found if number is not None))


def number_in(name: str) -> int | None:
    """The number of a scenario in the name of its definition; None for another name."""
    found = _SCENARIO.fullmatch(name)
    return None if found is None else int(found[1])


def numbers_named(text: str) -> set[int]:
    """The numbers of the scenarios whose definitions a text names, of any set."""
    return {int(number) for number in _NAMED.findall(text)}


def are_numbers(text: str) -> bool:
    """Whether a text is meant as numbers of scenarios, and not as a name or a formula."""
    return _NUMBERS.fullmatch(text) is not None


def name_of(number: int) -> str:
    """What the definition of a scenario is called."""
    return f"scenario_{number}"


EVERY_SCENARIO = "scenario_*"
"""A pattern of what the definitions of all scenarios are called."""


def definition_of(scenario: Scenario) -> str:
    """What the definition of a scenario is called from every set."""
    return f"{name_of(scenario.number)}@{scenario.set_name}"


def vehicles_of(specification: Specification, scenario: Scenario) -> tuple[str, ...]:
    """The vehicles among the arguments of a scenario, which are SV, POVs and L. Raises ``InputError``."""
    known: tuple[str, ...] | None = specification.worked_out.get(("vehicles", scenario))
    if known is not None:
        return known
    name = name_of(scenario.number)
    home = specification.in_set(scenario.set_name)
    *vehicles, lane = signature(home, name, walk_of(home))
    if lane != LANE or not vehicles or vehicles[0] != SUBJECT:
        raise InputError(f"{name} takes {', '.join((*vehicles, lane))}: a scenario takes SV, POVs and L")
    specification.worked_out["vehicles", scenario] = tuple(vehicles)
    return tuple(vehicles)


def applied(
    specification: Specification,
    scenario: Scenario,
    vehicles: Sequence[str] = (),
    lane: str = LANE,
    walk: Elaborator | None = None,
) -> Query:
    """A scenario applied to vehicles (its own where none are given) and a lane.

    ``walk`` as for ``elaborate``; that of the specification where none is given.
    """
    roles = tuple(vehicles) or vehicles_of(specification, scenario)
    known: Query | None = specification.worked_out.get(("applied", scenario, roles, lane))
    if known is None:
        is_here = scenario.set_name == specification.set_name
        name = name_of(scenario.number) if is_here else definition_of(scenario)
        known = apply_definition(specification, name, (*roles, lane), walk or walk_of(specification))
        specification.worked_out["applied", scenario, roles, lane] = known
    return known


def scenario_number(query: Query) -> int | None:
    """The number of the scenario that a query is, as a whole; None where it is none."""
    whole = query.formula
    return number_in(whole.name.partition("@")[0]) if isinstance(whole, f.Application) else None


def lane_owner(specification: Specification, scenario: Scenario) -> str:
    """The vehicle whose lane at the start is L. Raises ``InputError`` where the scenario has none such."""
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


def endangered(vehicles: Sequence[str]) -> tuple[str, str]:
    """SV and the vehicle that it comes into danger with, of a scenario's vehicles: the last POV."""
    return vehicles[0], vehicles[-1]


# --- parts of the template ----------------------------------------------------------------------


def sector_name(number: int) -> str:
    """What the definition of a scenario's road sector is called."""
    return f"roadSector_{number}"


def disturbance_name(number: int) -> str:
    """What the definition of what happens in a scenario is called."""
    return f"disturb_{number}"


def sector(specification: Specification, number: int, vehicles: Sequence[str]) -> Query:
    """That ``vehicles`` are where a scenario happens. Raises ``TextError``."""
    return apply_definition(specification, sector_name(number), tuple(vehicles))


def sector_words(specification: Specification, number: int) -> str:
    """Where a scenario happens, in words; empty where nothing is said of it."""
    return _words(specification, sector_name(number))


def disturbance(specification: Specification, number: int, vehicles: Sequence[str]) -> Query:
    """What happens in a scenario, after safety and wherever it is, in the lane L. Raises ``TextError``."""
    return apply_definition(specification, disturbance_name(number), (*vehicles, LANE))


def initial_condition(specification: Specification, number: int, vehicles: Sequence[str]) -> Query:
    """What a scenario asks of its start beside safety and sector, in the lane L. Raises ``TextError``."""
    return apply_definition(specification, initial_condition_name(number), (*vehicles, LANE))


def initial_condition_name(number: int) -> str:
    """What the definition is called of what a scenario asks of its start beside safety and sector."""
    return f"initialCondition_{number}"


def components(specification: Specification, number: int, vehicles: Sequence[str]) -> list[Query]:
    """The components of a disturbance that speak of no others than ``vehicles`` and L: behaviours first."""
    found = []
    for kind in _COMPONENTS:
        name = f"{kind}_{number}"
        if name in specification.definitions:
            arguments = signature(specification, name)
            if {*arguments} <= {*vehicles, LANE}:
                found.append(apply_definition(specification, name, arguments))
    return found


def follows_template(specification: Specification, number: int) -> bool:
    """Whether a scenario has a road sector and a disturbance of its own, as the template says."""
    return not missing_part(specification, number)


def is_sector(name: str) -> bool:
    """Whether a definition, or an application of one, is a road sector."""
    return name.startswith("roadSector_")


def without_sectors(formula: Formula) -> Formula:
    """``formula`` without names, and with every application of a road sector replaced by true."""

    def change(part: Formula) -> Formula:
        if not isinstance(part, f.Application):
            return part
        return f.TRUE if is_sector(part.name) else part.body

    return transform(formula, change)


# --- safety, danger, lanes ----------------------------------------------------------------------


def violation(specification: Specification, a: str, b: str) -> Query:
    """Two vehicles are nearer than the RSS distances (eq. rssViolation and danger_lat)."""
    return apply_definition(specification, "rssViolation", (a, b))


def safe(specification: Specification, a: str, b: str) -> Query:
    """Two vehicles are safe for minSafe from now on."""
    return apply_definition(specification, "initSafe", (a, b))


def danger(specification: Specification, a: str, b: str) -> Query:
    """Two vehicles violate the RSS distances for minDanger from now on."""
    return apply_definition(specification, "danger", (a, b))


def danger_comes(specification: Specification, a: str, b: str) -> Query:
    """Two vehicles are safe now and in danger later."""
    return both(safe(specification, a, b), eventually(danger(specification, a, b)))


def too_near_ahead(specification: Specification, behind: str, ahead: str) -> Query:
    """One vehicle is ahead of the other, nearer than the longitudinal RSS distance (eq. lon_RSS)."""
    return apply_definition(specification, "dangerAhead", (behind, ahead))


def too_near_left(specification: Specification, right: str, left: str) -> Query:
    """One vehicle is left of the other, nearer than the lateral RSS distance (eq. lat_RSS)."""
    return apply_definition(specification, "dangerLeft", (right, left))


def asked_between(specification: Specification, a: str, b: str) -> tuple[Query, ...]:
    """What a drive between two vehicles is to begin with beside safety; nothing in the library itself."""
    name = "asked_between"
    return (apply_definition(specification, name, (a, b)),) if name in specification.definitions else ()


def in_lane(specification: Specification, vehicle: str, lane: str = LANE) -> Query:
    """A vehicle occupies a lanelet of a lane."""
    return apply_definition(specification, "atLane", (vehicle, lane))


def leaves_at_once(specification: Specification, vehicle: str) -> Query:
    """A vehicle that leaves L has a first moment outside it, as all that move without jumps have."""
    inside = f"atLane({vehicle}, {LANE})"
    return read_claim(specification, f"({inside} U not {inside}) or G {inside}")


def alone_in_lane(specification: Specification, vehicle: str) -> Query:
    """A vehicle occupies no lanelet of a lane beside L."""
    return read_claim(specification, f"every M in adjacentLanes({LANE}): not atLane({vehicle}, M)")


def danger_at(specification: Specification, a: str, b: str, time: Fraction) -> Query:
    """Two vehicles violate the RSS distances for minDanger from ``time`` (s) on."""
    return read_claim(specification, f"F[{time} * 1 s, {time} * 1 s] danger({a}, {b})")


def in_zone(specification: Specification, vehicle: str, zone: Zone) -> Query:
    """A vehicle occupies a lanelet of a zone."""
    return apply_definition(specification, _ZONES[zone], (vehicle,))


def in_some_zone(specification: Specification, vehicle: str) -> Query:
    """A vehicle occupies a lanelet of one of the zones."""
    return either(*(in_zone(specification, vehicle, zone) for zone in _ZONES))


# --- what classes are made of --------------------------------------------------------------------

TEMPLATE = "initSafe and roadSector_i and disturb_i"


def missing_part(specification: Specification, number: int) -> str:
    """The first definition of a scenario's template that is not there; empty where all are."""
    names = (sector_name(number), disturbance_name(number))
    return next((name for name in names if name not in specification.definitions), "")


def behaviour_words(specification: Specification, number: int) -> tuple[str, str]:
    """What SV and what POVs do in a scenario, in words; empty where nothing is said of it."""
    sv, pov = (_words(specification, f"{kind}_{number}") for kind in _BEHAVIOURS)
    return sv, pov


def happening_words(specification: Specification, number: int) -> str:
    """What happens in a scenario, in the words of its behaviours, else in its own."""
    does = ", ".join(filter(None, behaviour_words(specification, number)))
    return does or _words(specification, name_of(number)) or f"scenario {number}"


def own_words(specification: Specification, number: int) -> str:
    """The description of a scenario itself; empty where it only puts those of its parts together."""
    definition = specification.definitions.get(name_of(number))
    return "" if definition is None or "[" in definition.doc else definition.doc


def declared_title(specification: Specification, number: int) -> TitleDeclaration | None:
    """The title of a scenario; None where it has none, or where its behaviours are others by now.

    A title is of the definitions in its own file: a set, an option or a later file that replaces one of them
    makes another scenario of it, which the old words would only hide.
    """
    library = specification.library
    if number not in library.titles:
        return None
    title, source = library.titles[number]
    for definition in _happening(specification, number):
        if definition is not library.definitions[definition.name] or source_of(library, definition) != source:
            return None
    return title


def _happening(specification: Specification, number: int) -> tuple[Definition, ...]:
    """The definitions of a scenario that say what happens, those of others that it takes over among them."""
    kinds = ("disturb", *_BEHAVIOURS)
    found: dict[str, Definition] = {}
    waiting = [name_of(number), *(f"{kind}_{number}" for kind in kinds)]
    while waiting:
        definition = specification.definitions.get(waiting.pop())
        if definition is not None and definition.name not in found:
            found[definition.name] = definition
            calls = (x.name for x in syntax.walk(definition.body) if isinstance(x, syntax.Call))
            waiting += [name for name in calls if name.rpartition("_")[0] in kinds]
    return tuple(found.values())


def _words(specification: Specification, name: str) -> str:
    definition = specification.definitions.get(name)
    return "" if definition is None else specification.describe(definition)


# --- scenarios in recordings ---------------------------------------------------------------------

PAIR, TRIPLE = (SUBJECT, "POV"), (SUBJECT, "POV1", "POV2")
"""What vehicles are called in scenarios of two and of three."""

Metric: TypeAlias = Literal["TTC", "THW", "none"]
DETECTORS: Mapping[str, Mapping[Metric, str]] = {
    "cut-in": {"TTC": "cutIn_ttc", "THW": "cutIn_thw", "none": "cutIn_free"},
    "deceleration": {"TTC": "decel_ttc", "THW": "decel_thw", "none": "decel_free"},
}
"""Detectors of earlier works, by what they detect and their danger metric (paper, RQ5)."""
COMPARISON = tuple(name for detectors in DETECTORS.values() for name in detectors.values())
"""The detectors that the paper's comparison table counts, all definitions of (SV, POV, L)."""


def roles(vehicles: int) -> tuple[str, ...]:
    """What so many vehicles are called: SV and POV, or SV, POV1, POV2 and so on."""
    return PAIR if vehicles == len(PAIR) else (SUBJECT, *(f"POV{k}" for k in range(1, vehicles)))


def beside_lane(specification: Specification, vehicle: str, lane: str = LANE) -> Query:
    """A vehicle occupies a lanelet of a lane beside ``lane``."""
    beside = syntax.Call("adjacentLanes", (syntax.Name(lane),))
    inside = syntax.Call("atLane", (syntax.Name(vehicle), syntax.Name("M")))
    return elaborate(specification, syntax.Claim((), syntax.Quantified("some", "M", beside, inside)))


def is_violation(name: str) -> bool:
    """Whether a definition is the violation of the RSS distances."""
    return name == "rssViolation"
