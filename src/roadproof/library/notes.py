"""Facts that elaboration notes on its way: which definitions a formula is made of, and from which text."""

from typing import TypeAlias

from roadproof.errors import Position, TextError
from roadproof.library.quantity import Quantity
from roadproof.library.scopes import Value
from roadproof.logic.formula import Formula
from roadproof.logic.syntax import Definition
from roadproof.runtime.records import dataclass

Entered: TypeAlias = dict[tuple[str, str], Definition]
"""Definitions by set and name, in reading order, whose bodies are part of a formula."""
Known: TypeAlias = dict[tuple[str, str, tuple[Value, ...]], tuple[Formula | Quantity, int, Entered]]
"""What definitions of a set mean, applied to values, how deep expressions are nested in each, and which
definitions each has entered.
"""


class LostError(TextError):
    """What was asked for is declared by a text that could not be read, of which is told elsewhere."""


@dataclass(frozen=True)
class Note:
    """That an expression at a place, in the text of a definition or of the claim (None), became a formula."""

    definition: Definition | None
    at: Position
    formula: Formula
