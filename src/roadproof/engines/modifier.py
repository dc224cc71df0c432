"""What an option of an extension changes about questions, beside the definitions that it chooses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from roadproof.extension import entries, imported

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from roadproof.engines.search.outcome import Search
    from roadproof.engines.search.question import FoundDrive, SearchProblem
    from roadproof.library.specification import Specification


class Modifier(Protocol):
    """A modifier of a question. ``str`` says what it supposes of the drives that are asked about."""

    @property
    def word(self) -> str:
        """What reasons call it, such as the name of a driver model."""

    def left_open(self, home: Specification) -> Specification:
        """Return the same definitions with less said: what is proved of them is proved of ``home``, too."""

    def check_drives(self) -> None:
        """Raises ``UsageError`` where it says nothing of drives outside of scenarios."""

    def objector(self, search: Search, problem: SearchProblem) -> Callable[[FoundDrive], str] | None:
        """Return who says what speaks against a drive that was found, if anyone does; "" is nothing."""

    def as_data(self, schema: str) -> dict[str, object]:
        """Return what an answer of this schema says of it, as plain data."""


def modifier_of(options: Mapping[str, str]) -> Modifier | None:
    """Return the modifier that the options of a specification say; None where they say none."""
    for option, entry in entries("modifiers").items():
        if option in options:
            find: Callable[[Mapping[str, str]], Modifier | None] = imported(entry)
            if (found := find(options)) is not None:
                return found
    return None


def left_open(home: Specification) -> Specification | None:
    """Return the definitions with what a modifier leaves open; None where there is no modifier."""
    found = modifier_of(home.options)
    return None if found is None else found.left_open(home)
