"""Rows of answers as tables."""

from typing import TypeAlias

Row: TypeAlias = dict[str, str | int | float | bool | None]
"""Values by the name of their column."""
