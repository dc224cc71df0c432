"""Records of elaboration: the definitions that a formula uses, and the formula of each expression."""

from typing import TypeAlias

from roadproof.errors import Position, TextError
from roadproof.library.quantity import Quantity
from roadproof.library.scopes import Value
from roadproof.logic.formula import Formula
from roadproof.logic.syntax import Definition
from roadproof.runtime.records import dataclass

UsedDefinitions: TypeAlias = dict[tuple[str, str], Definition]
"""Definitions by set and name, in reading order, whose bodies are part of a formula."""
ElaborationCache: TypeAlias = dict[
    tuple[str, str, tuple[Value, ...]], tuple[Formula | Quantity, int, UsedDefinitions]
]
"""Elaborated bodies by definition, set and arguments, each with its nesting depth and its definitions."""


class UnreadableNameError(TextError):
    """The error for a name whose declaration could not be parsed; that is reported at the declaration."""


@dataclass(frozen=True)
class FormulaNote:
    """The formula of an expression at a place in a definition, or in the claim (None)."""

    definition: Definition | None
    at: Position
    formula: Formula
