"""Expansion of ``each`` blocks: one definition for every index."""

import re
from dataclasses import replace

from roadproof.errors import Position, TextError
from roadproof.logic import syntax
from roadproof.logic.syntax import Definition, EachBlock, Expression

_INDEX = re.compile(r"\{([^{}]*)\}")
_INDEX_EXPRESSION = re.compile(r"\s*([A-Za-z_]\w*)\s*(?:([+-])\s*(\d{1,4}))?\s*")


def expand_each(block: EachBlock) -> list[Definition]:
    """Return the definitions of an ``each`` block, one for every index.

    ``{i}`` and ``{i-8}`` in names and descriptions become numbers. Raises ``TextError`` for another
    expression in braces.
    """

    def at_index(text: str, index: int, at: Position) -> str:
        """Return a text with the values of indices in braces."""

        def value(match: re.Match[str]) -> str:
            """Return the number for an index such as ``{i-8}``."""
            index_match = _INDEX_EXPRESSION.fullmatch(match[1])
            if index_match is None or index_match[1] != block.variable:
                raise TextError(
                    f"'{{{match[1]}}}' is no index",
                    at,
                    f"Write {{{block.variable}}}, {{{block.variable}-8}} or the like.",
                )
            shift = int(index_match[3] or 0)
            return str(index - shift if index_match[2] == "-" else index + shift)

        return _INDEX.sub(value, text)

    def rename(expression: Expression, index: int) -> Expression:
        """Return an expression with the values of indices in its names."""
        renamed = syntax.with_parts(expression, lambda part: rename(part, index))
        if isinstance(renamed, syntax.Call | syntax.Name):
            return replace(renamed, name=at_index(renamed.name, index, renamed.at))
        return renamed

    return [
        replace(
            definition,
            name=at_index(definition.name, index, definition.at),
            doc=at_index(definition.doc, index, definition.at),
            body=rename(definition.body, index),
        )
        for index in block.indices
        for definition in block.definitions
    ]
