"""The answer of ``roadproof show --format json``: a scenario, a definition or a formula."""

from typing import Annotated, Final, Literal

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.answers.tree import ClaimNode, DefinitionNode
from roadproof.evidence.codec import Doc
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/show/1"


@dataclass(frozen=True, kw_only=True)
class ShownFormulaData:
    """A formula as text and as a syntax tree."""

    text: shared.Formula
    tree: ClaimNode


@dataclass(frozen=True, kw_only=True)
class ShownDefinitionData:
    """A definition as text and as a syntax tree."""

    name: str
    text: str
    tree: DefinitionNode


@dataclass(frozen=True, kw_only=True)
class ShownParameterData:
    """A parameter that a formula or a definition mentions."""

    name: str
    value: Annotated[shared.Rational, Doc("The declared value, in unit.")]
    unit: str
    doc: str


@dataclass(frozen=True, kw_only=True)
class ShowData(headings.BaseHeading):
    """A scenario, a definition or a formula."""

    schema: Literal["roadproof/show/1"] = SCHEMA
    set: shared.SetName
    options: shared.Options
    scenario: Annotated[
        shared.WordsField | None, Doc("The scenario in words; null where something else is shown.")
    ]
    formula: Annotated[ShownFormulaData | None, Doc("The formula; null where a definition is shown.")]
    definitions: tuple[ShownDefinitionData, ...]
    parameters: tuple[ShownParameterData, ...]
