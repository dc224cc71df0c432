"""The driver models of ``driver.spec``, and what its definitions are called, which no other file knows."""

from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Final, Literal, TypeAlias

from roadproof.errors import UsageError
from roadproof.extensions.drivers.manoeuvres import Course, ManoeuvreName
from roadproof.library.scenarios import LANE, disturbance_name, name_of, number_in
from roadproof.library.specification import unknown
from roadproof.runtime.records import dataclass

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


ModelName: TypeAlias = Literal["careful", "r157", "eu1426", "rss", "fsm"]


@dataclass(frozen=True)
class Model:
    """A driver: what it is called, and what it says where.

    ``is_stepped``: a controller that is looked at place by place, and has no formula.
    """

    name: ModelName
    title: str
    manoeuvres: tuple[ManoeuvreName, ...]
    source: str
    is_stepped: bool = False


MODELS: Mapping[str, Model] = MappingProxyType(
    {
        model.name: model
        for model in (
            Model(
                "careful",
                "competent and careful driver",
                ("cut-in", "cut-out", "deceleration"),
                "UN R157 (01 series), Annex 3",
            ),
            Model("r157", "UN R157 5.2.5.2", ("cut-in",), "UN R157 (01 series), 5.2.5.2"),
            Model("eu1426", "EU 2022/1426", ("cut-in",), "EU 2022/1426, Annex III Part 1, 1.4.2"),
            Model(
                "rss",
                "RSS proper response",
                ("cut-in", "deceleration"),
                "Shalev-Shwartz et al. 2017; values of the paper",
            ),
            Model(
                "fsm",
                "fuzzy safety model",
                ("cut-in", "cut-out", "deceleration"),
                "UN R157 (01 series), Annex 3; JRC-FSM",
                is_stepped=True,
            ),
        )
    }
)


def models_for(manoeuvre: ManoeuvreName, names: tuple[str, ...] = ()) -> tuple[Model, ...]:
    """The models of that name, or all with a formula for a manoeuvre. Raises ``UsageError``."""
    for name in names:
        if name not in MODELS:
            raise UsageError(f"model={name}: {unknown('driver model', name, MODELS)}")
        if manoeuvre not in MODELS[name].manoeuvres:
            said = ", ".join(x.name for x in MODELS.values() if manoeuvre in x.manoeuvres)
            raise UsageError(
                f"model={name}: {MODELS[name].source} says nothing of a {manoeuvre}; these do: {said}"
            )
    return tuple(MODELS[name] for name in names) or tuple(
        x for x in MODELS.values() if manoeuvre in x.manoeuvres and not x.is_stepped
    )


def course_in(number: int) -> ManoeuvreName | None:
    """The manoeuvre that a scenario is the course of, on any road sector; None where it is of none."""
    return next((x for x, first in SCENARIOS.items() if number - first in _SECTORS), None)


def courses_of(name: str) -> tuple[int, ...]:
    """The scenarios that are the course of a manoeuvre of which a model says something, in order."""
    return tuple(sorted(SCENARIOS[x] + later for x in MODELS[name].manoeuvres for later in _SECTORS))


def check_drivers(names: Sequence[str], numbers: Collection[int]) -> None:
    """Each model is there, once, and speaks of one of the scenarios. Raises ``UsageError``."""
    if len({*names}) < len(names):
        raise UsageError(f"drivers={','.join(names)}: one is named twice; name different models")
    for name in names:
        check_driver(name, f"drivers={','.join(names)}")
        check_courses(name, numbers, f"drivers={','.join(names)}")


def check_driver(name: str, said: str) -> None:
    """The model is there; ``said`` is what was asked. Raises ``UsageError``."""
    if name not in MODELS:
        raise UsageError(f"{said}: {unknown('driver model', name, MODELS)}")


def check_formulas(name: str, said: str) -> None:
    """As ``check_driver``, and the model has formulas. Raises ``UsageError``."""
    check_driver(name, said)
    if MODELS[name].is_stepped:
        formulas = ", ".join(x.name for x in MODELS.values() if not x.is_stepped)
        raise UsageError(f"{said}: {name} is a controller and has no formula; these have: {formulas}")


def check_courses(name: str, numbers: Collection[int], said: str) -> None:
    """The model speaks of one of the scenarios. Raises ``UsageError``."""
    known = courses_of(name)
    if not {*known} & {*numbers}:
        raise UsageError(
            f"{said}: {name} does not apply to the selected scenarios "
            f"({', '.join(map(str, numbers)) or 'none'}); it applies to {', '.join(map(str, known))}: "
            "select one of these, or omit the model"
        )


def manoeuvre_of(name: str) -> tuple[ManoeuvreName, int | None]:
    """``cut-in``, or the number of a scenario in which it happens, as manoeuvre and number.

    Raises ``UsageError``.
    """
    numbers = {number: manoeuvre for said in (SCENARIOS, _CHANGING) for manoeuvre, number in said.items()}
    number = int(name) if name.isdecimal() else number_in(name)
    found = next((x for x in SCENARIOS if x == name), None) if number is None else numbers.get(number)
    if found is None:
        known = ", ".join(f"{x} (scenarios {SCENARIOS[x]}, {_CHANGING[x]})" for x in SCENARIOS)
        raise UsageError(f"'{name}' is not a manoeuvre of driver models; known are {known}")
    return found, number


def parts_of(number: int, vehicles: tuple[str, ...]) -> tuple[str, str]:
    """A scenario of those vehicles as a formula, and what happens in it without where and how it begins.

    Where SV changes lanes the scenario has one POV, the first.
    """
    those = (*(vehicles[:2] if number in _CHANGING.values() else vehicles), LANE)
    said = ", ".join(those)
    return f"{name_of(number)}({said})", f"{disturbance_name(number)}({said})"


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
    """What is true where a collision is unpreventable: of the state, or, for want of that, of the drive."""
    return touched(vehicles) if MODELS[model].is_stepped else unpreventable(manoeuvre, model, vehicles)


def foreseen(manoeuvre: Course, vehicles: tuple[str, ...]) -> str:
    """The formula: the manoeuvre begins in this state."""
    return f"{_FORESEEN[manoeuvre]}({', '.join(vehicles)})"


def follows(manoeuvre: Course, model: str, vehicles: tuple[str, ...], numbers: tuple[str, ...]) -> str:
    """The formula: SV drives as the model does; ``numbers`` are of the start, with units."""
    return f"{follows_name(manoeuvre, model)}({', '.join((*vehicles, *numbers))})"


def follows_name(manoeuvre: Course, model: str) -> str:
    """Return the name of the definition that ``follows`` applies."""
    return f"follows_{_word(manoeuvre)}_{model}"
