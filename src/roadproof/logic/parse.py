"""Text to syntax tree. User text reaches nothing but this grammar: no eval, no sympify."""

import re
from functools import lru_cache
from typing import cast

from roadproof.errors import Position, TextError
from roadproof.logic import syntax
from roadproof.logic.grammar import version
from roadproof.logic.syntax import Expression, Statement
from roadproof.runtime.cache import remembered

DEEPEST_NESTING = 100
LONGEST_CLAIM = 100_000
_CALL = re.compile(r"\w+(?:@\w+)?\(\w+(?:, ?\w+)*\)")
_PARENTHESES = re.compile(r'[()\[\]{}]|"[^"\n]*"|#[^\n]*')


@lru_cache(maxsize=64)
def parse_library(text: str, source: str) -> tuple[Statement, ...]:
    """The statements of a specification file. Raises ``TextError``.

    A check reads the files beside evidence several times, so trees are kept in memory.
    """
    statements = cast(tuple[Statement, ...], _parse(text, source, "library"))
    for definition in _definitions(statements):
        _check_depth(definition.body, definition.at, source, text)
    return statements


def parse_bundled(text: str, source: str) -> tuple[Statement, ...]:
    """As ``parse_library``, for text that is parsed in every run: its tree is remembered from run to run."""
    made_of = "\0".join((source, text, version())).encode()
    return remembered("tree", made_of, lambda: parse_library(text, source))


@lru_cache(maxsize=256)
def parse_claim(text: str, source: str = "claim") -> syntax.Claim:
    """A formula, with an optional ``given a, b: vehicle; L: lane:`` in front. Raises ``TextError``."""
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
    """A claim that is one call, as scenarios are: many runs read the same, so its tree is remembered."""
    made_of = "\0".join((text, version())).encode()
    return remembered("call", made_of, lambda: _parsed_claim(text, source))


def _parsed_claim(text: str, source: str) -> syntax.Claim:
    return cast(syntax.Claim, _parse(text, source, "claim"))


def _definitions(statements: tuple[Statement, ...]) -> list[syntax.Definition]:
    found: list[syntax.Definition] = []
    for statement in statements:
        match statement:
            case syntax.Definition():
                found.append(statement)
            case syntax.SignalDeclaration() if statement.body is not None:
                found.append(syntax.Definition(statement.name, (), "", statement.body, statement.at))
            case syntax.EachBlock() | syntax.SetBlock() | syntax.WhenBlock():
                found += statement.definitions
            case _:
                pass
    return found


def _check_parentheses(text: str) -> None:
    """Refuse text with parentheses deeper than trees may be; those in strings and comments do not count."""
    depth = 0
    for found in _PARENTHESES.finditer(text):
        if found[0] in "([{":
            depth += 1
        elif found[0] in ")]}":
            depth -= 1
        if depth > DEEPEST_NESTING:
            before = text[: found.start()]
            raise TextError(
                f"parentheses are nested too deep: at most {DEEPEST_NESTING} are allowed",
                Position(before.count("\n") + 1, found.start() - before.rfind("\n")),
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
