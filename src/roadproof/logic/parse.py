"""Parsing of specification files and claims to syntax trees.

User text reaches this grammar alone: no ``eval``, no ``sympify``.
"""

import re
from functools import lru_cache
from typing import assert_never, cast

from roadproof.errors import Position, TextError
from roadproof.logic import syntax
from roadproof.logic.grammar import version
from roadproof.logic.syntax import Expression, Statement
from roadproof.runtime.cache import cached
from roadproof.runtime.records import dataclass

DEEPEST_NESTING = 100
LONGEST_CLAIM = 100_000
_CALL = re.compile(r"\w+(?:@\w+)?\(\w+(?:, ?\w+)*\)")
_PARENTHESES = re.compile(r'[()\[\]{}]|"[^"\n]*"|#[^\n]*')


@dataclass(frozen=True)
class ParseResult:
    """The statements that were parsed, all errors, and patterns of the names that unparsed pieces declare."""

    statements: tuple[Statement, ...]
    errors: tuple[TextError, ...] = ()
    lost: tuple[re.Pattern[str], ...] = ()


@lru_cache(maxsize=64)
def parse_library(text: str, source: str) -> tuple[Statement, ...]:
    """Return the statements of a specification file. Raises ``TextError``.

    Trees stay in memory, because a check reads the files beside evidence several times.
    """
    statements = cast(tuple[Statement, ...], _parse(text, source, "library"))
    for definition in _definitions(statements):
        _check_depth(definition.body, definition.at, source, text)
    return statements


def parse_bundled(text: str, source: str) -> tuple[Statement, ...]:
    """Return the statements of a text that is part of roadproof; the tree is cached on disk between runs."""
    made_of = "\0".join((source, text, version())).encode()
    return cached("tree", made_of, lambda: parse_library(text, source))


@lru_cache(maxsize=256)
def parse_claim(text: str, source: str = "claim") -> syntax.Claim:
    """Parse a formula, with an optional ``given a, b: vehicle; L: lane:`` in front. Raises ``TextError``."""
    if len(text) > LONGEST_CLAIM:
        raise TextError(
            f"the formula is too long: {len(text)} characters, at most {LONGEST_CLAIM} are allowed",
            None,
            "Give its parts names with def.",
        ).locate(source, text)
    claim = _remembered_call(text, source) if _CALL.fullmatch(text) else _parsed_claim(text, source)
    _check_depth(claim.body, Position(1, 1), source, text)
    return claim


def _remembered_call(text: str, source: str) -> syntax.Claim:
    """Parse a claim that is one call, such as a scenario; its tree is cached on disk between runs."""
    made_of = "\0".join((text, version())).encode()
    return cached("call", made_of, lambda: _parsed_claim(text, source))


def _parsed_claim(text: str, source: str) -> syntax.Claim:
    return cast(syntax.Claim, _parse(text, source, "claim"))


def _definitions(statements: tuple[Statement, ...]) -> list[syntax.Definition]:
    definitions: list[syntax.Definition] = []
    for statement in statements:
        match statement:
            case syntax.Definition():
                definitions.append(statement)
            case syntax.SignalDeclaration() if statement.body is not None:
                definitions.append(syntax.Definition(statement.name, (), "", statement.body, statement.at))
            case syntax.EachBlock() | syntax.SetBlock() | syntax.WhenBlock():
                definitions += statement.definitions
            case syntax.SignalDeclaration() | syntax.ParameterDeclaration() | syntax.OptionDeclaration():
                pass
            case syntax.LaneDeclaration() | syntax.TitleDeclaration():
                pass
            case _:
                assert_never(statement)
    return definitions


def _check_parentheses(text: str) -> None:
    """Raise ``TextError`` where parentheses are nested too deep; strings and comments do not count."""
    depth = 0
    for match in _PARENTHESES.finditer(text):
        if match[0] in "([{":
            depth += 1
        elif match[0] in ")]}":
            depth -= 1
        if depth > DEEPEST_NESTING:
            before = text[: match.start()]
            raise TextError(
                f"parentheses are nested too deep: at most {DEEPEST_NESTING} are allowed",
                Position(before.count("\n") + 1, match.start() - before.rfind("\n")),
                "Give the parts of the formula names with def.",
            )


def _check_depth(body: Expression, at: Position, source: str, text: str) -> None:
    deep = syntax.depth(body)
    if deep > DEEPEST_NESTING:
        raise TextError(
            f"the formula is nested too deep: depth={deep}, at most {DEEPEST_NESTING} is allowed",
            at,
            "Give its parts names with def.",
        ).locate(source, text)


def _parse(text: str, source: str, start: str) -> object:
    from roadproof.logic.lark_parser import parse_text

    try:
        _check_parentheses(text)
        return parse_text(text, start)
    except TextError as error:
        raise error.locate(source, text) from None
