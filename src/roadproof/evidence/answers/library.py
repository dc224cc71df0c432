"""The answer of ``roadproof list``: the contents of the library."""

from typing import Annotated, Final, Literal

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import Doc, Rule
from roadproof.logic.syntax import ParameterBound
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/list/1"


@dataclass(frozen=True, kw_only=True)
class ScenarioData:
    """A scenario that questions can name."""

    name: Annotated[str, Rule(least=1), Doc("Its definition, such as that of number 4.")]
    arguments: Annotated[tuple[str, ...], Doc("Vehicles and lane that it is about.")]
    doc: str
    words: shared.WordsField


@dataclass(frozen=True, kw_only=True)
class DefinitionData:
    """A definition that is no scenario."""

    name: str
    parameters: tuple[shared.BindingField, ...]
    doc: str


@dataclass(frozen=True, kw_only=True)
class SpecificationSetData:
    """A spec set."""

    name: shared.SetName
    extends: Annotated[str, Doc("The set whose definitions it replaces; empty where there is none.")]
    doc: str


@dataclass(frozen=True, kw_only=True)
class OptionData:
    """An option with its readings."""

    name: str
    values: Annotated[tuple[str, ...], Rule(least=1), Doc("The first is the default.")]
    chosen: str
    doc: str


@dataclass(frozen=True, kw_only=True)
class ParameterData:
    """A parameter with its declared value."""

    name: str
    value: Annotated[shared.Rational, Doc("The declared value, in unit.")]
    unit: Annotated[str, Doc("Such as s or m/s^2; empty where it has none.")]
    bound: Annotated[ParameterBound, Doc("Its declared bound against 0.")]
    doc: str


@dataclass(frozen=True, kw_only=True)
class LibraryData(headings.BaseHeading):
    """The contents of the library."""

    schema: Literal["roadproof/list/1"] = SCHEMA
    set: shared.SetName
    scenarios: tuple[ScenarioData, ...]
    definitions: tuple[DefinitionData, ...]
    sets: tuple[SpecificationSetData, ...]
    options: tuple[OptionData, ...]
    parameters: tuple[ParameterData, ...]
