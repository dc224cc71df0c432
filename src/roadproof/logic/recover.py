"""Specification files with mistakes: what can be read of them, and all that cannot.

A file is cut where a statement begins, and read piece by piece. A piece that does not parse is left out; the
names that it would have declared are known, so that nobody is told that they do not exist.
"""

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

from roadproof.errors import Position, TextError
from roadproof.logic.parse import parse_library
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


@dataclass(frozen=True)
class ParseResult:
    """What was read of a text, what was not, and how names look that what was not read declares."""

    statements: tuple[Statement, ...]
    errors: tuple[TextError, ...] = ()
    lost: tuple[re.Pattern[str], ...] = ()


def parse_pieces(text: str, source: str) -> ParseResult:
    """All statements of a specification file that parse, and every error, in order. Never raises.

    Pieces are kept, so that a text of which one statement was changed is read in the time of that one.
    """
    statements: list[Statement] = []
    errors: list[TextError] = []
    lost: list[re.Pattern[str]] = []
    block: _Piece | None = None
    for piece in _pieces(text):
        read = _read(piece, source)
        if isinstance(read, TextError):
            errors.append(_placed(read, text, piece))
            lost += _names_in(piece.text)
        else:
            joined = block is not None and piece.outer == block.outer and block.line < piece.line
            statements = _join(statements, read) if joined else [*statements, *read]
        block = (block if piece.inner else piece) if piece.opens else block if piece.heads else None
    return ParseResult(tuple(statements), tuple(errors), tuple(lost))


@dataclass(frozen=True)
class _Piece:
    """A statement, at which line and column it begins, and the heads of blocks that it is in or opens."""

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
        """Whether it is in a block that it does not open itself."""
        return len(self.heads) > self.opens

    @property
    def alone(self) -> str:
        """The statement with nothing around it but its block, at its own line and column."""
        place = "\n" * (self.line - 1) + " " * (self.column - 1)
        above = self.heads[: len(self.heads) - self.opens]
        return f"{''.join(above)}{place}{self.text}{'}' * len(self.heads) if self.text else ''}"


@lru_cache(maxsize=1024)
def _read(piece: _Piece, source: str) -> tuple[Statement, ...] | TextError:
    try:
        return parse_library(piece.alone, source)
    except TextError as error:
        return error


def _join(statements: list[Statement], more: tuple[Statement, ...]) -> list[Statement]:
    """Definitions of a block, read alone, put back into it."""
    block = statements[-1]
    inside = [x for x in more if isinstance(x, EachBlock | SetBlock | WhenBlock)]
    if not isinstance(block, EachBlock | SetBlock | WhenBlock) or not inside:
        return statements
    definitions = (*block.definitions, *(y for x in inside for y in x.definitions))
    return [*statements[:-1], replace(block, definitions=definitions)]


def _pieces(text: str) -> Iterator[_Piece]:
    """The statements of a text, those in blocks one by one."""
    plain = _HIDDEN.sub(lambda found: " " * len(found[0]), text)
    starts = [found.start() for found in _START.finditer(plain)]
    if plain[: starts[0] if starts else len(text)].strip():
        starts = [0, *starts]
    heads: tuple[str, ...] = ()
    for start, end in pairwise([*starts, len(text)]):
        found = _START.match(plain, start)
        word = "" if found is None else found[1]
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
    """Definitions in any block; ``each`` in a set and in what an option says."""
    return word == "def" or (word == "each" and not heads[-1].startswith("each"))


def _unclosed(text: str, plain: str, before: int, heads: tuple[str, ...]) -> _Piece:
    """Nothing, where the end of a block is missing."""
    end = len(plain[:before].rstrip())
    return _piece(text, end, end, heads)


def _piece(text: str, start: int, end: int, heads: tuple[str, ...] = (), opens: bool = False) -> _Piece:
    column = start - text.rfind("\n", 0, start)
    return _Piece(text[start:end], text.count("\n", 0, start) + 1, column, heads, opens)


def _closings(plain: str) -> list[int]:
    """Where the blocks end that a definition stands in, the inner one first; nowhere where it is not last."""
    depth, found = 0, list[int]()
    for brace in re.finditer(r"[{}]", plain):
        depth += 1 if brace[0] == "{" else -1
        if depth < 0:
            found.append(brace.start())
            depth = 0
    return found


def _placed(error: TextError, text: str, piece: _Piece) -> TextError:
    """The error in the whole text; what is missing at the end of a statement is told at its end."""
    said = _COMMENT.sub("", piece.text).rstrip()
    above, _, below = said.rpartition("\n")
    last = Position(
        piece.line + said.count("\n"), len(below) + (1 if above or "\n" in said else piece.column)
    )
    if not piece.text:
        shown = TextError(f"'{piece.heads[-1]}' is not closed", last, "Write } where it ends.")
        return shown.locate(error.source, text)
    at, message = error.position, error.message
    if at is not None and (at.line, at.column) >= (last.line, last.column):
        at, message = last, "the statement ends too early"
    return TextError(message, at, error.hint).locate(error.source, text)


def _names_in(piece: str) -> Iterator[re.Pattern[str]]:
    for found in _DECLARED.finditer(piece):
        yield re.compile(_INDEX.sub(r"\\w+", re.escape(found[1])))
