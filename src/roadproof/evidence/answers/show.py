"""The answer of ``roadproof show --format json``: a scenario, a definition or a formula."""

from typing import Annotated, Final, Literal

from roadproof.evidence.answers import shared
from roadproof.evidence.answers.tree import ClaimNode, DefinitionNode
from roadproof.evidence.codec import Doc
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/show/1"


@dataclass(frozen=True, kw_only=True)
class ShownFormula:
    """A formula as text and as a syntax tree."""

    text: shared.Formula
    tree: ClaimNode


@dataclass(frozen=True, kw_only=True)
class Definition:
    """A definition as text and as a syntax tree."""

    name: str
    text: str
    tree: DefinitionNode


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """A parameter that a formula or a definition speaks of."""

    name: str
    value: Annotated[shared.Rational, Doc("The declared value, in unit.")]
    unit: str
    doc: str


@dataclass(frozen=True, kw_only=True)
class Answer(shared.PlainHeading):
    """A scenario, a definition or a formula."""

    schema: Literal["roadproof/show/1"] = SCHEMA
    set: shared.SetName
    options: shared.Options
    scenario: Annotated[
        shared.KeptWords | None, Doc("The scenario in words; null where something else is shown.")
    ]
    formula: Annotated[ShownFormula | None, Doc("The formula; null where a definition is shown.")]
    definitions: tuple[Definition, ...]
    parameters: tuple[Parameter, ...]
