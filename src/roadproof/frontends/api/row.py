"""Rows of answers as tables."""

from typing import TypeAlias

from roadproof.frontends.report.sheet import Value

Row: TypeAlias = dict[str, Value]
"""Values by the name of their column."""
