"""Specification files with mistakes: what can be read of them, and all that cannot.

A file is cut where a statement begins, and read piece by piece. A piece that does not parse is left out; the
names that it would have declared are known, so that nobody is told that they do not exist.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

from roadproof.errors import Position, TextError
from roadproof.logic.parse import parse_library
from roadproof.logic.syntax import EachBlock, SetBlock, Statement, WhenBlock

_BLOCKS = ("each", "set", "when")
_START = re.compile(
    r"^[ \t]*(def|param|option|each|set|when|lane(?=\s+of\b)|title(?=\s+of\b))\b", re.MULTILINE
)
_HIDDEN = re.compile(r'"[^"\n]*"|#[^\n]*')
_COMMENT = re.compile(r"[ \t]*#[^\n]*")
_DECLARED = re.compile(r"^[ \t]*(?:def|param)[ \t]+((?:[A-Za-z0-9_]|\{[^{}\n]*\})+)", re.MULTILINE)
_INDEX = re.compile(r"\\\{[^{}]*\\\}")


@dataclass(frozen=True)
class Parsed:
    """What was read of a text, what was not, and how names look that what was not read declares."""

    statements: tuple[Statement, ...]
    errors: tuple[TextError, ...] = ()
    lost: tuple[re.Pattern[str], ...] = ()


def parse_pieces(text: str, source: str) -> Parsed:
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
            joined = block is not None and piece.head == block.head and block.line < piece.line
            statements = _join(statements, read) if joined else [*statements, *read]
        block = piece if piece.opens else block if piece.head else None
    return Parsed(tuple(statements), tuple(errors), tuple(lost))


@dataclass(frozen=True)
class _Piece:
    """A statement, at which line and column it begins, and the head of the block that it is in or opens."""

    text: str
    line: int
    column: int
    head: str = ""
    opens: bool = False

    @property
    def alone(self) -> str:
        """The statement with nothing around it but its block, at its own line and column."""
        place = "\n" * (self.line - 1) + " " * (self.column - 1)
        if self.opens or not self.head:
            return f"{place}{self.text}{'}' * self.opens}"
        return f"{self.head}{place}{self.text}{'}' if self.text else ''}"


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
    head = ""
    for start, end in pairwise([*starts, len(text)]):
        found = _START.match(plain, start)
        word = "" if found is None else found[1]
        if head and word != "def":
            yield _unclosed(text, plain, start, head)
            head = ""
        if word in _BLOCKS:
            brace = plain.find("{", start, end)
            opens = brace >= 0 and not plain[brace + 1 : end].strip()
            head = " ".join(text[start : brace + 1].split()) if opens else ""
            yield _piece(text, start, end, head, opens)
        elif head:
            closing = _closing(plain[start:end])
            last = end if closing is None else start + closing
            yield _piece(text, start, last, head)
            if closing is not None:
                head = ""
                if plain[last + 1 : end].strip():
                    yield _piece(text, last + 1, end)
        else:
            yield _piece(text, start, end)
    if head:
        yield _unclosed(text, plain, len(text), head)


def _unclosed(text: str, plain: str, before: int, head: str) -> _Piece:
    """Nothing, where the end of a block is missing."""
    end = len(plain[:before].rstrip())
    return _piece(text, end, end, head)


def _piece(text: str, start: int, end: int, head: str = "", opens: bool = False) -> _Piece:
    column = start - text.rfind("\n", 0, start)
    return _Piece(text[start:end], text.count("\n", 0, start) + 1, column, head, opens)


def _closing(plain: str) -> int | None:
    """Where the block ends that a definition stands in; None where the definition is not its last."""
    depth = 0
    for found in re.finditer(r"[{}]", plain):
        depth += 1 if found[0] == "{" else -1
        if depth < 0:
            return found.start()
    return None


def _placed(error: TextError, text: str, piece: _Piece) -> TextError:
    """The error in the whole text; what is missing at the end of a statement is told at its end."""
    said = _COMMENT.sub("", piece.text).rstrip()
    above, _, below = said.rpartition("\n")
    last = Position(
        piece.line + said.count("\n"), len(below) + (1 if above or "\n" in said else piece.column)
    )
    if not piece.text:
        shown = TextError(f"'{piece.head}' is not closed", last, "Write } where it ends.")
        return shown.locate(error.source, text)
    at, message = error.position, error.message
    if at is not None and (at.line, at.column) >= (last.line, last.column):
        at, message = last, "the statement ends too early"
    return TextError(message, at, error.hint).locate(error.source, text)


def _names_in(piece: str) -> Iterator[re.Pattern[str]]:
    for found in _DECLARED.finditer(piece):
        yield re.compile(_INDEX.sub(r"\\w+", re.escape(found[1])))
