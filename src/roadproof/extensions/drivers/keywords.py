"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from roadproof.frontends.settings.keywords import BudgetKeywords, RunKeywords, SharingKeywords

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from roadproof.frontends.api.checking import Kernel
    from roadproof.library.bind import Number


class PreventableKeywords(BudgetKeywords, SharingKeywords, RunKeywords, total=False):
    at: Mapping[str, Number | Sequence[Number]] | None
    along: tuple[Number, Number] | None
    across: tuple[Number, Number] | None
    lines: int
    tests: str | Path | None
    lemmas: bool
    kernel: Kernel | None
