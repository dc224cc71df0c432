"""The driver models that are installed, and the names of their definitions, which no other file knows."""

from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Final

from roadproof.errors import UsageError
from roadproof.extension import entries, imported
from roadproof.extensions.drivers.driver_model import DriverModel, Law
from roadproof.extensions.drivers.driver_settings import OPTIONS, PARAMETERS
from roadproof.extensions.drivers.lemmas import Lemma, parsed_lemmas
from roadproof.extensions.drivers.manoeuvres import Course, ManoeuvreName
from roadproof.library.scenarios import LANE, disturbance_name, name_of, number_in
from roadproof.library.specification import unknown_name

DRIVERS = "driver"
"""What the file of the definitions is called, among those that are read on request."""
PREVENTION = "prevention"
"""What the file is called that asks what a driver prevents, and its option for which side is asked."""
DRIVEN_BY, BEGINS = "driver", "prevention_of"
"""Its options for the model of the driver, and for what begins so."""
# The scenario of the library that each manoeuvre is the course of.
SCENARIOS: Mapping[ManoeuvreName, int] = MappingProxyType({"cut-in": 1, "cut-out": 2, "deceleration": 4})
_CHANGING: Mapping[ManoeuvreName, int] = MappingProxyType({"cut-in": 5, "cut-out": 6, "deceleration": 8})
"""The scenario in which the same happens while SV changes lanes, of which models have no drive."""
_SECTORS = (0, 8, 16)
"""How much later in the library's list a scenario of the main road stands for each road sector."""
_FORESEEN: Mapping[Course, str] = MappingProxyType(
    {
        "cut-in": "cutsIn",
        "cut-out": "cutsOut",
        "deceleration": "brakesAhead",
        "gradual-deceleration": "brakesMoreAhead",
    }
)


MODELS: Mapping[str, DriverModel] = MappingProxyType(
    {name: imported("drivers", name) for name in entries("drivers")}
)
"""The driver models of all extensions by name; other packages add rows of their own."""


def driver_model(name: str) -> DriverModel:
    """Return a model by its name. Raises ``UsageError``."""
    if name not in MODELS:
        raise UsageError(f"model={name}: {unknown_name('driver model', name, MODELS)}")
    return MODELS[name]


def entry_of(name: str) -> str:
    """Return the entry of a model in the record of its extension, as ``module:name``."""
    return entries("drivers")[name]


def law_of(name: str) -> Law:
    """Return the law of a model that has formulas. Raises ``UsageError``."""
    law = driver_model(name).law
    if law is None:
        formulas = ", ".join(x.name for x in MODELS.values() if x.law is not None)
        raise UsageError(f"model={name}: {name} is a controller and has no formula; these have: {formulas}")
    return law


def specifications() -> tuple[str, ...]:
    """The names of the specifications with the definitions of driver models."""
    own = (x.law.specification for x in MODELS.values() if x.law is not None and x.law.specification)
    return (DRIVERS, *dict.fromkeys(own))


def parameters_of(name: str) -> tuple[str, ...]:
    """The names of the parameters with which a model moves."""
    law = driver_model(name).law
    return PARAMETERS if law is None else (*PARAMETERS, *law.parameters)


def options_of(name: str) -> tuple[str, ...]:
    """The names of the options on which a model depends."""
    law = driver_model(name).law
    return OPTIONS if law is None else (*OPTIONS, *law.options)


def models_for(manoeuvre: ManoeuvreName, names: tuple[str, ...] = ()) -> tuple[DriverModel, ...]:
    """The models of these names, or all with a formula for a manoeuvre. Raises ``UsageError``."""
    for name in names:
        if manoeuvre not in driver_model(name).manoeuvres:
            able = ", ".join(x.name for x in MODELS.values() if manoeuvre in x.manoeuvres)
            raise UsageError(
                f"model={name}: {MODELS[name].source} says nothing of a {manoeuvre}; these do: {able}"
            )
    return tuple(MODELS[name] for name in names) or tuple(
        x for x in MODELS.values() if manoeuvre in x.manoeuvres and not x.is_stepped
    )


def lemmas_for(manoeuvre: ManoeuvreName, models: Sequence[DriverModel], aeb: str = "none") -> list[Lemma]:
    """Return the lemmas on which the boundaries of these models rest, each model with its own braking.

    ``aeb``: what AEB does in a cut-in of the careful driver, as the option ``cc_aeb``.
    """
    laws = ((x.name, x.law) for x in models if x.law is not None)
    stated = (y for name, x in laws for y in x.lemmas(name, (x.ramp, x.braking), manoeuvre, aeb))
    return parsed_lemmas(stated)


def course_in(number: int) -> ManoeuvreName | None:
    """Return the manoeuvre that happens in a scenario, on any road sector, or None."""
    return next((x for x, first in SCENARIOS.items() if number - first in _SECTORS), None)


def courses_of(name: str) -> tuple[int, ...]:
    """Return the numbers of the scenarios in which a manoeuvre of a model happens, in order."""
    return tuple(sorted(SCENARIOS[x] + later for x in MODELS[name].manoeuvres for later in _SECTORS))


def check_drivers(names: Sequence[str], numbers: Collection[int]) -> None:
    """Check that each model exists, once, and applies to one of the scenarios. Raises ``UsageError``."""
    if len({*names}) < len(names):
        raise UsageError(f"drivers={','.join(names)}: one is named twice; name different models")
    for name in names:
        check_driver(name, f"drivers={','.join(names)}")
        check_courses(name, numbers, f"drivers={','.join(names)}")


def check_driver(name: str, option: str) -> None:
    """Check that a model exists; ``option`` is the option with its value. Raises ``UsageError``."""
    if name not in MODELS:
        raise UsageError(f"{option}: {unknown_name('driver model', name, MODELS)}")


def check_restricts(name: str, requested: str) -> None:
    """Check that a model restricts questions; ``requested`` is the option with its value.

    Raises ``UsageError``.
    """
    check_driver(name, requested)
    law = MODELS[name].law
    if law is None:
        able = ", ".join(x.name for x in MODELS.values() if x.law is not None and x.law.restriction)
        raise UsageError(f"{requested}: {name} is a controller and has no formula; these have: {able}")
    if law.restriction is None:
        raise UsageError(
            f"{requested}: the law of {name} names no restriction; its package must add one: a file that "
            f"python -m roadproof.extensions.drivers.restriction_file {name} prints, in the slot "
            "specifications of its record and as restriction of its law"
        )


def restriction_specifications(name: str) -> tuple[str, ...]:
    """Return the names of the specifications that a question restricted by a model is read with, in order."""
    law = MODELS[name].law if name in MODELS else None
    own = () if law is None else (law.specification, PREVENTION, law.restriction)
    return tuple(dict.fromkeys(x for x in (DRIVERS, *own, PREVENTION) if x))


def check_courses(name: str, numbers: Collection[int], option: str) -> None:
    """Check that a model applies to one of the scenarios. Raises ``UsageError``."""
    known = courses_of(name)
    if not {*known} & {*numbers}:
        raise UsageError(
            f"{option}: {name} does not apply to the selected scenarios "
            f"({', '.join(map(str, numbers)) or 'none'}); it applies to {', '.join(map(str, known))}: "
            "select one of these, or omit the model"
        )


def manoeuvre_of(name: str) -> tuple[ManoeuvreName, int | None]:
    """``cut-in``, or the number of a scenario in which it happens, as manoeuvre and number.

    Raises ``UsageError``.
    """
    tables = (SCENARIOS, _CHANGING)
    numbers = {number: manoeuvre for table in tables for manoeuvre, number in table.items()}
    number = int(name) if name.isdecimal() else number_in(name)
    manoeuvre_name = (
        next((x for x in SCENARIOS if x == name), None) if number is None else numbers.get(number)
    )
    if manoeuvre_name is None:
        known = ", ".join(f"{x} (scenarios {SCENARIOS[x]}, {_CHANGING[x]})" for x in SCENARIOS)
        raise UsageError(f"'{name}' is not a manoeuvre of driver models; known are {known}")
    return manoeuvre_name, number


def parts_of(number: int, vehicles: tuple[str, ...]) -> tuple[str, str]:
    """A scenario of those vehicles as a formula, and what happens in it without where and how it begins.

    Where SV changes lanes the scenario has one POV, the first.
    """
    those = (*(vehicles[:2] if number in _CHANGING.values() else vehicles), LANE)
    arguments = ", ".join(those)
    return f"{name_of(number)}({arguments})", f"{disturbance_name(number)}({arguments})"


def _word(manoeuvre: Course) -> str:
    """``cut-in`` as the middle of a name."""
    first, *others = manoeuvre.split("-")
    return first + "".join(x.capitalize() for x in others)


def unpreventable(manoeuvre: Course, model: str, vehicles: tuple[str, ...]) -> str:
    """The formula: the manoeuvre, from this state on, ends in a collision though SV is driven so."""
    return f"{boundary_name(manoeuvre, model)}({', '.join(vehicles)})"


def boundary_name(manoeuvre: Course, model: str) -> str:
    """The name of the definition that ``unpreventable`` applies to vehicles."""
    return f"unpreventable_{_word(manoeuvre)}_{model}"


def touched(vehicles: tuple[str, ...]) -> str:
    """The formula about a drive: SV touches the last of the vehicles, and has not passed it before."""
    return f"meets({vehicles[0]}, {vehicles[-1]})"


def passed(vehicles: tuple[str, ...]) -> str:
    """The formula about a state: SV has passed the last of the vehicles."""
    return f"isPast({vehicles[0]}, {vehicles[-1]})"


GRADUAL: Final = "gradual-deceleration"
"""What a deceleration is called in definitions where the braking of POV grows at a finite rate."""


def untouched(vehicles: tuple[str, ...]) -> str:
    """The formula about a drive: SV never does."""
    return f"G not touches({vehicles[0]}, {vehicles[-1]})"


def boundary_of(manoeuvre: Course, model: str, vehicles: tuple[str, ...]) -> str:
    """Return the formula of an unpreventable collision: of the state, or of a controller's drive."""
    return touched(vehicles) if driver_model(model).is_stepped else unpreventable(manoeuvre, model, vehicles)


def foreseen(manoeuvre: Course, vehicles: tuple[str, ...]) -> str:
    """The formula: the manoeuvre begins in this state."""
    return f"{_FORESEEN[manoeuvre]}({', '.join(vehicles)})"


def follows(manoeuvre: Course, model: str, vehicles: tuple[str, ...], numbers: tuple[str, ...]) -> str:
    """The formula: SV drives as the model does; ``numbers`` are of the start, with units."""
    return f"{follows_name(manoeuvre, model)}({', '.join((*vehicles, *numbers))})"


def follows_name(manoeuvre: Course, model: str) -> str:
    """Return the name of the definition that ``follows`` applies."""
    return f"follows_{_word(manoeuvre)}_{model}"
