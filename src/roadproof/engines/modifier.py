"""The interface of extension options that restrict a question, such as a driver model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from roadproof.extension import entries, import_entry

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from roadproof.engines.search.question import FoundDrive, SearchProblem
    from roadproof.engines.setting import Search
    from roadproof.library.specification import Specification


class Modifier(Protocol):
    """A restriction of a question by a specification option; ``str`` states its assumption on drives."""

    @property
    def word(self) -> str:
        """The name of the restriction in reasons, such as the name of a driver model."""

    @property
    def relies_on(self) -> Iterable[str]:
        """The entries of other extensions, as ``module:name``, whose code answers depend on."""

    def with_opaque_driver(self, home: Specification) -> Specification:
        """Return weaker definitions with an opaque driver: their theorems hold of ``home``, too."""

    def check_drives(self) -> None:
        """Raise ``UsageError`` where the modifier says nothing about drives outside of scenarios."""

    def objector(self, search: Search, problem: SearchProblem) -> Callable[[FoundDrive], str] | None:
        """Return a function from a drive to an objection ("" for none), or None if nothing objects."""

    def as_data(self, schema: str) -> dict[str, object]:
        """Return the entry of the modifier in an answer of this schema, as plain data."""


def find_modifier(options: Mapping[str, str]) -> Modifier | None:
    """Return the modifier that the options of a specification select, or None."""
    for option, entry in entries("modifiers").items():
        if option in options:
            find: Callable[[Mapping[str, str]], Modifier | None] = import_entry(entry)
            if (modifier := find(options)) is not None:
                return modifier
    return None


def with_opaque_driver(home: Specification) -> Specification | None:
    """Return the definitions with an opaque driver; None where the options select no modifier."""
    modifier = find_modifier(home.options)
    return None if modifier is None else modifier.with_opaque_driver(home)
