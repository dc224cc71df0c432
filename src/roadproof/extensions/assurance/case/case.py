"""An assurance case in Goal Structuring Notation (GSN): elements, and how they support each other."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from pathlib import Path


class Kind(StrEnum):
    """The kinds of elements of GSN."""

    GOAL = "goal"
    STRATEGY = "strategy"
    SOLUTION = "solution"
    CONTEXT = "context"
    ASSUMPTION = "assumption"
    JUSTIFICATION = "justification"

    @property
    def is_contextual(self) -> bool:
        """Whether elements of the kind stand beside the argument."""
        return self in (Kind.CONTEXT, Kind.ASSUMPTION, Kind.JUSTIFICATION)


@dataclass(frozen=True)
class Evidence:
    """The evidence of a solution.

    ``path``: a file or folder, as it is from the folder of the case. ``expect``: verdicts of which each
    selected entry has one. ``select``: patterns such as ``P4 *`` for labels or names of files, or where a
    catalogue is to be COVERED for scenarios and classes; without them every entry is selected.
    ``entries``: how many are selected, None for any number. ``sha256``: the digest that the file or folder
    must have; empty for any.
    """

    path: str
    expect: tuple[str, ...] = ()
    select: tuple[str, ...] = ()
    sha256: str = ""
    entries: int | None = None


@dataclass(frozen=True)
class Element:
    """An element of a case; ``line`` is that of its table in the file, 0 where roadproof made it."""

    id: str
    kind: Kind
    text: str
    supported_by: tuple[str, ...] = ()
    in_context_of: tuple[str, ...] = ()
    undeveloped: bool = False
    evidence: Evidence | None = None
    line: int = 0


@dataclass(frozen=True)
class Case:
    """A well-formed case (``rules``): elements by id in the order of the file, and the id of the top goal."""

    path: Path
    title: str
    elements: Mapping[str, Element]
    top: str

    @cached_property
    def supported(self) -> Mapping[str, tuple[str, ...]]:
        """For each element, those that it supports."""
        found: dict[str, list[str]] = {name: [] for name in self.elements}
        for element in self.elements.values():
            for other in element.supported_by:
                found[other].append(element.id)
        return {name: tuple(x) for name, x in found.items()}

    @property
    def solutions(self) -> tuple[Element, ...]:
        """The solutions, in the order of the file."""
        return tuple(x for x in self.elements.values() if x.kind is Kind.SOLUTION)
