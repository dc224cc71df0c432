"""Every error that a user can cause, with its exit code.

A message says what was asked, ``name=value``, the rule, and what to do instead.
Anything that is not a ``RoadproofError`` is our own fault and exits with 70.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Self


class RoadproofError(Exception):
    """An error with a message for the user and an exit code; never shown as a stack trace."""

    exit_code: ClassVar[int] = 70


class UsageError(RoadproofError):
    """The command line was wrong."""

    exit_code = 2


class InputError(RoadproofError):
    """A file or a value that the user gave is wrong."""

    exit_code = 3


class StaleError(InputError):
    """An answer is about a file that has changed since."""


class MissingSolverError(RoadproofError):
    """A solver or another library that was asked for is not installed."""

    exit_code = 4


class LostWorkError(RoadproofError):
    """A part of the work ended its process each time it was tried, so that its answer is not known."""

    exit_code = 20


class SharedError(RoadproofError):
    """A message, no mistake: this run has its share done, and other shares are missing."""

    exit_code = 0


@dataclass(frozen=True)
class Position:
    """A place in a text; line and column count from 1. The end, where it is known, is just behind it."""

    line: int
    column: int
    end_line: int = field(default=0, compare=False, repr=False)
    end_column: int = field(default=0, compare=False, repr=False)


class TextError(InputError):
    """A mistake in a text of ours (a specification or a claim), shown with line, column and caret."""

    def __init__(self, message: str, position: Position | None = None, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.position = position
        self.hint = hint
        self.source = ""
        self.text = ""
        self.errors: tuple[TextError, ...] = (self,)

    def locate(self, source: str, text: str) -> "TextError":
        """Add where the text came from, unless a nearer reader has already said so."""
        if not self.source:
            self.source, self.text = source, text
        return self

    def __str__(self) -> str:
        where = self.source or "input"
        lines = [self.message]
        if self.position is not None and self.position.line:
            where = f"{where}, line {self.position.line}, column {self.position.column}"
            source_lines = self.text.splitlines()
            if 1 <= self.position.line <= len(source_lines):
                lines += _excerpt(source_lines[self.position.line - 1], self.position.column)
        if self.hint:
            lines.append(self.hint)
        return f"{where}: " + "\n".join(lines)


MOST_SHOWN = 50


class TextErrors(TextError):
    """The mistakes in texts of a user, in ``errors``; a reader of one error sees the first."""

    def __init__(self, errors: Sequence[TextError]) -> None:
        first = errors[0]
        super().__init__(first.message, first.position, first.hint)
        self.source, self.text = first.source, first.text
        self.errors = tuple(errors)

    def __reduce__(self) -> tuple[type[Self], tuple[tuple[TextError, ...]]]:
        return type(self), (self.errors,)

    def __str__(self) -> str:
        shown = [str(error) for error in self.errors[:MOST_SHOWN]]
        more = len(self.errors) - len(shown)
        return "\n".join([*shown, *([f"and {more} more mistakes"] if more else [])])


def once_each(errors: Iterable[TextError]) -> list[TextError]:
    """The first error at each place: what several others use is told once."""
    first: dict[tuple[str, Position | None], TextError] = {}
    for error in errors:
        first.setdefault((error.source, error.position), error)
    return list(first.values())


def raise_all(errors: Sequence[TextError]) -> None:
    """Raise what went wrong, if anything did: one error as it is, several as ``TextErrors``."""
    if errors:
        raise errors[0] if len(errors) == 1 else TextErrors(errors)


def _excerpt(line: str, column: int, width: int = 100) -> list[str]:
    """The guilty line, cut to ``width`` characters around the caret."""
    start = max(0, min(column - 1 - width // 2, len(line) - width))
    shown = line[start : start + width].replace("\t", " ")
    return [f"  {shown}", "  " + " " * (column - 1 - start) + "^"]
