"""Answers as tables: rows, frames, and what a notebook shows."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, TypeAlias

from roadproof.errors import MissingSolverError
from roadproof.extension import import_entry, list_entries

if TYPE_CHECKING:
    from roadproof.frontends.report.sheet import Value

Row: TypeAlias = "dict[str, Value]"
"""Values by the name of their column."""


class Table(ABC):
    """Something with rows, which a notebook shows as it is printed."""

    @abstractmethod
    def rows(self) -> list[Row]:
        """The rows of ``to_frame``."""

    def to_frame(self) -> Any:
        """The rows as a frame of polars. Raises ``MissingSolverError`` where polars is not installed."""
        makers = list_entries("frames")
        if not makers:
            raise MissingSolverError("to_frame needs an extension with data frames; rows() has the rows")
        return import_entry(makers[0])(self.rows())

    def _repr_html_(self) -> str:
        import html

        return f"<pre>{html.escape(str(self))}</pre>"
