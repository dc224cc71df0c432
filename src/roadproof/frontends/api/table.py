"""Answers as tables: rows, frames, and what a notebook shows."""

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, TypeAlias

from roadproof.frontends.report.sheet import Value

if TYPE_CHECKING:
    from roadproof.extensions.traffic.formats.table import Frame

Row: TypeAlias = dict[str, Value]
"""Values by the name of their column."""


class Table(ABC):
    """Something with rows, which a notebook shows as it is printed."""

    @abstractmethod
    def rows(self) -> list[Row]:
        """The rows of ``to_frame``."""

    def to_frame(self) -> "Frame":
        """The rows as a frame of polars. Raises ``MissingSolverError`` where polars is not installed."""
        from roadproof.extensions.traffic.formats.table import frame_of

        return frame_of(self.rows())

    def _repr_html_(self) -> str:
        import html

        return f"<pre>{html.escape(str(self))}</pre>"
