"""The data of an assurance case in Goal Structuring Notation (GSN): elements, and how they support each
other.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from pathlib import Path


class ElementKind(StrEnum):
    """The kinds of GSN elements."""

    GOAL = "goal"
    STRATEGY = "strategy"
    SOLUTION = "solution"
    CONTEXT = "context"
    ASSUMPTION = "assumption"
    JUSTIFICATION = "justification"

    @property
    def is_contextual(self) -> bool:
        """Return whether elements of this kind are context: they neither support nor are supported."""
        return self in (ElementKind.CONTEXT, ElementKind.ASSUMPTION, ElementKind.JUSTIFICATION)


@dataclass(frozen=True)
class Evidence:
    """The evidence that a solution refers to, and what the case expects of it.

    ``path``: a file or folder, relative to the folder of the case. ``expect``: the verdicts that selected
    entries may have. ``select``: patterns such as ``P4 *`` for labels or file names; for a catalogue, of the
    scenarios and classes that must be COVERED. Without patterns every entry is selected. ``entries``: the
    required number of selected entries, None for any. ``sha256``: the required digest of the file or folder,
    empty for any.
    """

    path: str
    expect: tuple[str, ...] = ()
    select: tuple[str, ...] = ()
    sha256: str = ""
    entries: int | None = None


@dataclass(frozen=True)
class CaseElement:
    """An element of a case; ``line`` is that of its table in the file, 0 for derived elements."""

    id: str
    kind: ElementKind
    text: str
    supported_by: tuple[str, ...] = ()
    in_context_of: tuple[str, ...] = ()
    undeveloped: bool = False
    evidence: Evidence | None = None
    line: int = 0


@dataclass(frozen=True)
class AssuranceCase:
    """A well-formed case (see ``rules``): the elements by id in file order, and the id of the top goal."""

    path: Path
    title: str
    elements: Mapping[str, CaseElement]
    top: str

    @cached_property
    def supported(self) -> Mapping[str, tuple[str, ...]]:
        """The ids of the elements that each element supports, by id."""
        parents: dict[str, list[str]] = {name: [] for name in self.elements}
        for element in self.elements.values():
            for other in element.supported_by:
                parents[other].append(element.id)
        return {name: tuple(x) for name, x in parents.items()}

    @property
    def solutions(self) -> tuple[CaseElement, ...]:
        """The solutions in file order."""
        return tuple(x for x in self.elements.values() if x.kind is ElementKind.SOLUTION)
