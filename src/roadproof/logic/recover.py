"""Parsing of specification files with mistakes: all statements that parse, and all errors.

The file is cut at the beginnings of statements, and each piece is parsed by itself. A piece that does not
parse is left out. The names that it would have declared are recorded, so that their uses cause no further
errors.
"""

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

from roadproof.errors import Position, TextError
from roadproof.logic.parse import ParseResult, parse_library
from roadproof.logic.syntax import EachBlock, SetBlock, Statement, WhenBlock
from roadproof.runtime.records import dataclass

_BLOCKS = ("each", "set", "when")
_START = re.compile(
    r"^[ \t]*(def|param|signal|option|each|set|when|lane(?=\s+of\b)|title(?=\s+of\b))\b", re.MULTILINE
)
_HIDDEN = re.compile(r'"[^"\n]*"|#[^\n]*')
_COMMENT = re.compile(r"[ \t]*#[^\n]*")
_DECLARED = re.compile(r"^[ \t]*(?:def|param|signal)[ \t]+((?:[A-Za-z0-9_]|\{[^{}\n]*\})+)", re.MULTILINE)
_INDEX = re.compile(r"\\\{[^{}]*\\\}")


def parse_pieces(text: str, source: str) -> ParseResult:
    """Return all statements of a specification file that parse, and every error, in order. Never raises.

    Parsed pieces are cached: after a change of one statement only that statement is parsed again.
    """
    statements: list[Statement] = []
    errors: list[TextError] = []
    lost: list[re.Pattern[str]] = []
    block: _Piece | None = None
    for piece in _pieces(text):
        parsed = _parse_piece(piece, source)
        if isinstance(parsed, TextError):
            errors.append(_relocate(parsed, text, piece))
            lost += _names_in(piece.text)
        else:
            continues = block is not None and piece.outer == block.outer and block.line < piece.line
            statements = _join(statements, parsed) if continues else [*statements, *parsed]
        block = (block if piece.inner else piece) if piece.opens else block if piece.heads else None
    return ParseResult(tuple(statements), tuple(errors), tuple(lost))


@dataclass(frozen=True)
class _Piece:
    """A statement, its first line and column, and the heads of the blocks that it is in or opens."""

    text: str
    line: int
    column: int
    heads: tuple[str, ...] = ()
    opens: bool = False

    @property
    def outer(self) -> str:
        """The head of the outermost block."""
        return self.heads[0] if self.heads else ""

    @property
    def inner(self) -> bool:
        """Return whether the piece is in a block that it does not open itself."""
        return len(self.heads) > self.opens

    @property
    def alone(self) -> str:
        """The statement in its block, without its neighbours, at its own line and column."""
        place = "\n" * (self.line - 1) + " " * (self.column - 1)
        above = self.heads[: len(self.heads) - self.opens]
        return f"{''.join(above)}{place}{self.text}{'}' * len(self.heads) if self.text else ''}"


@lru_cache(maxsize=1024)
def _parse_piece(piece: _Piece, source: str) -> tuple[Statement, ...] | TextError:
    try:
        return parse_library(piece.alone, source)
    except TextError as error:
        return error


def _join(statements: list[Statement], more: tuple[Statement, ...]) -> list[Statement]:
    """Append definitions of a block, which were parsed alone, to the block."""
    block = statements[-1]
    blocks = [x for x in more if isinstance(x, EachBlock | SetBlock | WhenBlock)]
    if not isinstance(block, EachBlock | SetBlock | WhenBlock) or not blocks:
        return statements
    definitions = (*block.definitions, *(y for x in blocks for y in x.definitions))
    return [*statements[:-1], replace(block, definitions=definitions)]


def _pieces(text: str) -> Iterator[_Piece]:
    """Yield the statements of a text, those in blocks one by one."""
    plain = _HIDDEN.sub(lambda match: " " * len(match[0]), text)
    starts = [match.start() for match in _START.finditer(plain)]
    if plain[: starts[0] if starts else len(text)].strip():
        starts = [0, *starts]
    heads: tuple[str, ...] = ()
    for start, end in pairwise([*starts, len(text)]):
        match = _START.match(plain, start)
        word = "" if match is None else match[1]
        while heads and not _may_stand_in(word, heads):
            yield _unclosed(text, plain, start, heads)
            heads = heads[:-1]
        brace = plain.find("{", start, end) if word in _BLOCKS else -1
        if brace >= 0 and not plain[brace + 1 : end].strip():
            heads = (*heads, " ".join(text[start : brace + 1].split()))
            yield _piece(text, start, end, heads, True)
            continue
        ends = [start + x for x in _closings(plain[start:end])[: len(heads)]]
        yield _piece(text, start, ends[0] if ends else end, heads)
        for closing, last in pairwise([*ends, end]):
            heads = heads[:-1]
            if plain[closing + 1 : last].strip():
                yield _piece(text, closing + 1, last, heads)
    while heads:
        yield _unclosed(text, plain, len(text), heads)
        heads = heads[:-1]


def _may_stand_in(word: str, heads: tuple[str, ...]) -> bool:
    """Return whether a statement may stand in the innermost block: ``def``, or ``each`` but in ``each``."""
    return word == "def" or (word == "each" and not heads[-1].startswith("each"))


def _unclosed(text: str, plain: str, before: int, heads: tuple[str, ...]) -> _Piece:
    """Return an empty piece at the place where the end of a block is missing."""
    end = len(plain[:before].rstrip())
    return _piece(text, end, end, heads)


def _piece(text: str, start: int, end: int, heads: tuple[str, ...] = (), opens: bool = False) -> _Piece:
    column = start - text.rfind("\n", 0, start)
    return _Piece(text[start:end], text.count("\n", 0, start) + 1, column, heads, opens)


def _closings(plain: str) -> list[int]:
    """Return where the blocks around a definition end, inner one first; empty if none ends."""
    depth, closings = 0, list[int]()
    for brace in re.finditer(r"[{}]", plain):
        depth += 1 if brace[0] == "{" else -1
        if depth < 0:
            closings.append(brace.start())
            depth = 0
    return closings


def _relocate(error: TextError, text: str, piece: _Piece) -> TextError:
    """Return the error with its place in the whole text.

    An error beyond the last character of a statement, such as a missing operand, is moved to its end.
    """
    statement = _COMMENT.sub("", piece.text).rstrip()
    above, _, below = statement.rpartition("\n")
    last = Position(
        piece.line + statement.count("\n"), len(below) + (1 if above or "\n" in statement else piece.column)
    )
    if not piece.text:
        shown = TextError(f"'{piece.heads[-1]}' is not closed", last, "Write } where it ends.")
        return shown.locate(error.source, text)
    at, message = error.position, error.message
    if at is not None and (at.line, at.column) >= (last.line, last.column):
        at, message = last, "the statement ends too early"
    return TextError(message, at, error.hint).locate(error.source, text)


def _names_in(piece: str) -> Iterator[re.Pattern[str]]:
    for match in _DECLARED.finditer(piece):
        yield re.compile(_INDEX.sub(r"\\w+", re.escape(match[1])))
