"""The answer of ``roadproof list``: what the library holds."""

from typing import Annotated, Final, Literal

from roadproof.evidence.answers import shared
from roadproof.evidence.codec import Doc, Rule
from roadproof.logic.syntax import ParameterBound
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/list/1"


@dataclass(frozen=True, kw_only=True)
class Scenario:
    """A scenario that can be asked about."""

    name: Annotated[str, Rule(least=1), Doc("Its definition, such as that of number 4.")]
    arguments: Annotated[tuple[str, ...], Doc("Vehicles and lane that it is about.")]
    doc: str
    words: shared.KeptWords


@dataclass(frozen=True, kw_only=True)
class Definition:
    """A definition that is no scenario."""

    name: str
    parameters: tuple[shared.KeptBinding, ...]
    doc: str


@dataclass(frozen=True, kw_only=True)
class SpecificationSet:
    """A spec set."""

    name: shared.SetName
    extends: Annotated[str, Doc("The set whose definitions it replaces; empty where there is none.")]
    doc: str


@dataclass(frozen=True, kw_only=True)
class Option:
    """An option with its readings."""

    name: str
    values: Annotated[tuple[str, ...], Rule(least=1), Doc("The first is the default.")]
    chosen: str
    doc: str


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """A parameter with its declared value."""

    name: str
    value: Annotated[shared.Rational, Doc("The declared value, in unit.")]
    unit: Annotated[str, Doc("Such as s or m/s^2; empty where it has none.")]
    bound: Annotated[ParameterBound, Doc("Its declared bound against 0.")]
    doc: str


@dataclass(frozen=True, kw_only=True)
class Answer(shared.PlainHeading):
    """What the library holds."""

    schema: Literal["roadproof/list/1"] = SCHEMA
    set: shared.SetName
    scenarios: tuple[Scenario, ...]
    definitions: tuple[Definition, ...]
    sets: tuple[SpecificationSet, ...]
    options: tuple[Option, ...]
    parameters: tuple[Parameter, ...]
