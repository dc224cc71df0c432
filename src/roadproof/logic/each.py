"""``each`` blocks: definitions that are written once for many indices."""

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
        match expression:
            case syntax.Call(name, arguments, at):
                new = tuple(rename(a, index) for a in arguments)
                return syntax.Call(at_index(name, index, at), new, at)
            case syntax.Name(name, at):
                return syntax.Name(at_index(name, index, at), at)
            case syntax.Literal_():
                return expression
            case syntax.Prefix():
                return replace(expression, body=rename(expression.body, index))
            case syntax.Binary():
                return replace(
                    expression,
                    left=rename(expression.left, index),
                    right=rename(expression.right, index),
                )
            case syntax.Chain():
                return replace(expression, parts=tuple(rename(p, index) for p in expression.parts))
            case syntax.Quantified():
                return replace(expression, body=rename(expression.body, index))
            case syntax.Temporal():
                left = None if expression.left is None else rename(expression.left, index)
                return replace(expression, left=left, right=rename(expression.right, index))

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
