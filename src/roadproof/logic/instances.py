"""The definitions of an ``each`` block, once for every index."""

import re
from dataclasses import replace

from roadproof.errors import Position, TextError
from roadproof.logic import syntax
from roadproof.logic.syntax import Definition, EachBlock, Expression

_INDEX = re.compile(r"\{([^{}]*)\}")
_INDEX_EXPRESSION = re.compile(r"\s*([A-Za-z_]\w*)\s*(?:([+-])\s*(\d{1,4}))?\s*")


def instances(block: EachBlock) -> list[Definition]:
    """The definitions of an ``each`` block, once for every index. Raises ``TextError``."""

    def at_index(text: str, index: int, at: Position) -> str:
        def value(found: re.Match[str]) -> str:
            read = _INDEX_EXPRESSION.fullmatch(found[1])
            if read is None or read[1] != block.variable:
                raise TextError(
                    f"'{{{found[1]}}}' is no index",
                    at,
                    f"Write {{{block.variable}}}, {{{block.variable}-8}} or the like.",
                )
            shift = int(read[3] or 0)
            return str(index - shift if read[2] == "-" else index + shift)

        return _INDEX.sub(value, text)

    def rename(expression: Expression, index: int) -> Expression:
        made = syntax.with_parts(expression, lambda part: rename(part, index))
        if isinstance(made, syntax.Call | syntax.Name):
            return replace(made, name=at_index(made.name, index, made.at))
        return made

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
