"""Parsing with lark, which loads slowly; ``logic.parse`` imports this module if no cache has the tree."""

import io
from functools import cache

from lark import Lark
from lark.exceptions import UnexpectedCharacters, UnexpectedEOF, UnexpectedInput, UnexpectedToken, VisitError

from roadproof.errors import Position, TextError
from roadproof.logic.build_syntax import SyntaxBuilder, short_token
from roadproof.logic.foreign_syntax import find_foreign
from roadproof.logic.grammar import grammar, version
from roadproof.runtime.cache import cached
from roadproof.world.units import UNITS


def parse_text(text: str, start: str) -> object:
    """Return the syntax tree of a text; ``start`` is a rule of the grammar. Raises ``TextError``."""
    try:
        return SyntaxBuilder().transform(_parser().parse(text, start=start))
    except UnexpectedInput as error:
        raise _explain(error, text) from None
    except VisitError as error:
        if isinstance(error.orig_exc, TextError):
            raise error.orig_exc from None
        raise


@cache
def _parser() -> Lark:
    def tables() -> bytes:
        """Return lark's parse tables, which take long to make."""
        buffer = io.BytesIO()
        Lark(
            grammar(),
            start=["library", "claim"],
            parser="lalr",
            propagate_positions=True,
            maybe_placeholders=True,
        ).save(buffer)
        return buffer.getvalue()

    return Lark.load(io.BytesIO(cached("grammar", version().encode(), tables)))


_READABLE = {
    "NAME": "a name",
    "INDEXED": "a name",
    "QUALIFIED": "a name",
    "NUMBER": "a number",
    "UNIT": f"a unit ({', '.join(UNITS)})",
    "STRING": 'a "text"',
    "LPAR": "(",
    "RPAR": ")",
    "LSQB": "[",
    "RSQB": "]",
    "LBRACE": "{",
    "RBRACE": "}",
    "COMMA": ",",
    "COLON": ":",
    "SEMICOLON": ";",
    "VBAR": "|",
    "EQUAL": "=",
    "CIRCUMFLEX": "^",
    "COMPARISON": "a comparison (<, <=, >, >=, =, !=)",
    "PLUS": "+",
    "MINUS": "-",
    "TIMES": "*",
    "DIVIDE": "/",
    "INFINITY": "inf",
    "$END": "the end",
    "__ANON_0": ":=",
}


def _expected_text(names: set[str]) -> str:
    shown = sorted({_READABLE.get(n, n.lower() if n.isalpha() and len(n) > 1 else n) for n in names})
    shown = [s if s[0].isalnum() else f"'{s}'" for s in shown if not s.startswith("__")]
    many = len(shown) > 8
    return ", ".join(shown[:8]) + (", …" if many else "")


def _explain(error: UnexpectedInput, text: str) -> TextError:
    mistake = error.pos_in_stream
    foreign = None if mistake is None else find_foreign(text, mistake)
    if foreign is not None:
        start, sign, instead = foreign
        line = text.count("\n", 0, start) + 1
        position = Position(line, start - text.rfind("\n", 0, start))
        return TextError(f"'{sign}' is not of this language", position, instead)
    if isinstance(error, UnexpectedToken) and error.token.type != "$END":
        expected = set(error.accepts or error.expected)
        return TextError(
            f"'{short_token(str(error.token))}' cannot stand here",
            Position(error.line, error.column),
            f"Expected {_expected_text(expected)}.",
        )
    if isinstance(error, UnexpectedCharacters):
        character = text[error.pos_in_stream] if error.pos_in_stream is not None else ""
        expected = set(error.allowed or ())
        return TextError(
            f"the character {character!r} cannot stand here",
            Position(error.line, error.column),
            f"Expected {_expected_text(expected)}." if expected else "",
        )
    expected = set(error.expected) if isinstance(error, UnexpectedEOF | UnexpectedToken) else set()
    lines = text.splitlines() or [""]
    return TextError(
        "the text ends too early",
        Position(len(lines), len(lines[-1]) + 1),
        f"Expected {_expected_text(expected)}." if expected else "",
    )
