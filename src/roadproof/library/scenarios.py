"""The template of the scenarios, and the names of its definitions.

Beside it only ``extensions.traffic.scenario_parts`` uses such names.

A scenario is ``scenario_i := initSafe and roadSector_i and disturb_i`` with ``disturb_i := initialCondition_i
and behaviourSV_i and behaviourPOV_i`` (paper, eq. scenarioAsInitSafePlusDisturb and disturbFormat). Its
arguments are SV, POVs and a lane L. Numbers, vehicles, road sectors and the owner of lane L come from the
specification.
"""

import re
from collections.abc import Sequence

from roadproof.errors import InputError
from roadproof.library.elaborate import apply_definition, signature, walk_of
from roadproof.library.elaboration import Elaborator
from roadproof.library.scenario_names import LANE as LANE
from roadproof.library.scenario_names import PAIR as PAIR
from roadproof.library.scenario_names import SUBJECT as SUBJECT
from roadproof.library.scenario_names import TRIPLE as TRIPLE
from roadproof.library.scenario_names import Scenario as Scenario
from roadproof.library.specification import Query, Specification, source_of
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.formula import Formula, transform
from roadproof.logic.syntax import Definition, TitleDeclaration
from roadproof.world.road import Zone

MIN_SAFE, MIN_DANGER = "minSafe", "minDanger"
DANGER_ARISES = "dangerArises"

ZONES: dict[Zone, str] = {"main": "onMainRoad", "merge": "inMergeZone", "depart": "inDepartZone"}
_SCENARIO = re.compile(r"scenario_(\d{1,6})")
_NAMED = re.compile(r"\bscenario_(\d{1,6})\b")
_NUMBERS = re.compile(r"(scenario_)?\d[\d,\s-]*")
BEHAVIOURS = ("behaviourSV", "behaviourPOV")
TEMPLATE_NAMES = (
    *("rssViolation", "initSafe", "danger", "dangerAhead", "dangerLeft", "asked_between", "atLane"),
    *ZONES.values(),
)
"""Definitions that provers and searches use even if a formula does not name them."""


# --- scenarios ----------------------------------------------------------------------------------


def numbers_of(specification: Specification) -> tuple[int, ...]:
    """Return the numbers of the scenarios that a specification defines, in order."""
    numbers = (number_in(name) for name in specification.definitions)
    return tuple(sorted(number for number in numbers if number is not None))


def number_in(name: str) -> int | None:
    """Return the number of a scenario from the name of its definition; None for another name."""
    match = _SCENARIO.fullmatch(name)
    return None if match is None else int(match[1])


def numbers_named(text: str) -> set[int]:
    """Return the numbers of the scenarios whose definitions a text names, in any set."""
    return {int(number) for number in _NAMED.findall(text)}


def are_numbers(text: str) -> bool:
    """Return whether a text is a list of scenario numbers, and no name or formula."""
    return _NUMBERS.fullmatch(text) is not None


def name_of(number: int) -> str:
    """Return the name of a scenario's definition."""
    return f"scenario_{number}"


EVERY_SCENARIO = "scenario_*"
"""A pattern for the names of all scenarios' definitions."""


def definition_of(scenario: Scenario) -> str:
    """Return the name of a scenario's definition with its set, valid in every set."""
    return f"{name_of(scenario.number)}@{scenario.set_name}"


def vehicles_of(specification: Specification, scenario: Scenario) -> tuple[str, ...]:
    """Return the vehicles of a scenario. Raises ``InputError`` unless its arguments are SV, POVs and L."""
    known: tuple[str, ...] | None = specification.memo.get(("vehicles", scenario))
    if known is not None:
        return known
    name = name_of(scenario.number)
    home = specification.in_set(scenario.set_name)
    *vehicles, lane = signature(home, name, walk_of(home))
    if lane != LANE or not vehicles or vehicles[0] != SUBJECT:
        raise InputError(f"{name} takes {', '.join((*vehicles, lane))}: a scenario takes SV, POVs and L")
    specification.memo["vehicles", scenario] = tuple(vehicles)
    return tuple(vehicles)


def apply_scenario(
    specification: Specification,
    scenario: Scenario,
    vehicles: Sequence[str] = (),
    lane: str = LANE,
    walk: Elaborator | None = None,
) -> Query:
    """Return a scenario applied to vehicles (by default its own) and a lane.

    ``walk``: as for ``elaborate``; by default that of the specification.
    """
    roles = tuple(vehicles) or vehicles_of(specification, scenario)
    known: Query | None = specification.memo.get(("applied", scenario, roles, lane))
    if known is None:
        is_here = scenario.set_name == specification.set_name
        name = name_of(scenario.number) if is_here else definition_of(scenario)
        known = apply_definition(specification, name, (*roles, lane), walk or walk_of(specification))
        specification.memo["applied", scenario, roles, lane] = known
    return known


def scenario_number(query: Query) -> int | None:
    """Return the number of the scenario that a query is as a whole; None if it is none."""
    whole = query.formula
    return number_in(whole.name.partition("@")[0]) if isinstance(whole, f.Application) else None


# --- parts of the template ----------------------------------------------------------------------


def sector_name(number: int) -> str:
    """Return the name of the definition of a scenario's road sector."""
    return f"roadSector_{number}"


def disturbance_name(number: int) -> str:
    """Return the name of the definition of a scenario's disturbance."""
    return f"disturb_{number}"


def sector_words(specification: Specification, number: int) -> str:
    """Return the road sector of a scenario in words; empty if it has no description."""
    return _words(specification, sector_name(number))


def initial_condition_name(number: int) -> str:
    """Return the name of the definition of a scenario's initial condition."""
    return f"initialCondition_{number}"


def is_sector(name: str) -> bool:
    """Return whether a definition, or an application of one, is a road sector."""
    return name.startswith("roadSector_")


def without_sectors(formula: Formula) -> Formula:
    """Return ``formula`` without names, and with every road sector replaced by true."""

    def change(part: Formula) -> Formula:
        if not isinstance(part, f.Application):
            return part
        return f.TRUE if is_sector(part.name) else part.body

    return transform(formula, change)


# --- safety, danger, lanes ----------------------------------------------------------------------


def danger(specification: Specification, a: str, b: str) -> Query:
    """Return the query "two vehicles violate the RSS distances for minDanger from now on"."""
    return apply_definition(specification, "danger", (a, b))


def too_near_ahead(specification: Specification, behind: str, ahead: str) -> Query:
    """Return the query "one vehicle is ahead, closer than the longitudinal RSS distance" (eq. lon_RSS)."""
    return apply_definition(specification, "dangerAhead", (behind, ahead))


def too_near_left(specification: Specification, right: str, left: str) -> Query:
    """Return the query "one vehicle is on the left, closer than the lateral RSS distance" (eq. lat_RSS)."""
    return apply_definition(specification, "dangerLeft", (right, left))


# --- what classes are made of --------------------------------------------------------------------


def behaviour_words(specification: Specification, number: int) -> tuple[str, str]:
    """Return what SV and what POVs do in a scenario, in words; empty without a description."""
    sv, pov = (_words(specification, f"{kind}_{number}") for kind in BEHAVIOURS)
    return sv, pov


def happening_words(specification: Specification, number: int) -> str:
    """Return what happens in a scenario, from the descriptions of its behaviours, else from its own."""
    does = ", ".join(filter(None, behaviour_words(specification, number)))
    return does or _words(specification, name_of(number)) or f"scenario {number}"


def description_of(specification: Specification, number: int) -> str:
    """Return the description of a scenario itself; empty if it only joins those of its parts."""
    definition = specification.definitions.get(name_of(number))
    return "" if definition is None or "[" in definition.doc else definition.doc


def declared_title(specification: Specification, number: int) -> TitleDeclaration | None:
    """Return the title of a scenario; None if it has none, or if its behaviours were redefined.

    A title belongs to the definitions of its own file. A set, an option or a later file that replaces one of
    them makes another scenario, which the old words would misdescribe.
    """
    library = specification.library
    if number not in library.titles:
        return None
    title, source = library.titles[number]
    for definition in _behaviour_definitions(specification, number):
        if definition is not library.definitions[definition.name] or source_of(library, definition) != source:
            return None
    return title


def _behaviour_definitions(specification: Specification, number: int) -> tuple[Definition, ...]:
    """Return the definitions of a scenario's behaviours, also those that it reuses from other scenarios."""
    kinds = ("disturb", *BEHAVIOURS)
    definitions: dict[str, Definition] = {}
    waiting = [name_of(number), *(f"{kind}_{number}" for kind in kinds)]
    while waiting:
        definition = specification.definitions.get(waiting.pop())
        if definition is not None and definition.name not in definitions:
            definitions[definition.name] = definition
            calls = (x.name for x in syntax.walk(definition.body) if isinstance(x, syntax.Call))
            waiting += [name for name in calls if name.rpartition("_")[0] in kinds]
    return tuple(definitions.values())


def _words(specification: Specification, name: str) -> str:
    definition = specification.definitions.get(name)
    return "" if definition is None else specification.describe(definition)


# --- scenarios in recordings ---------------------------------------------------------------------


def roles(vehicles: int) -> tuple[str, ...]:
    """Return the roles for this number of vehicles: SV and POV, or SV, POV1, POV2 and so on."""
    return PAIR if vehicles == len(PAIR) else (SUBJECT, *(f"POV{k}" for k in range(1, vehicles)))


def is_violation(name: str) -> bool:
    """Return whether a definition is the violation of the RSS distances."""
    return name == "rssViolation"
