"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from roadproof.frontends.settings.keywords import BudgetKeywords, WorkersKeywords

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from roadproof.frontends.api.checking import Solver
    from roadproof.runtime.pool import Progress


class AssuranceKeywords(BudgetKeywords, WorkersKeywords, total=False):
    solver: Solver
    specs: Iterable[str | Path]
    strict: bool
    svg: str | Path | None
    page: str | Path | None
    progress: Progress | None


class RequirementsKeywords(WorkersKeywords, total=False):
    accept: bool
    solver: Solver
    specs: Iterable[str | Path]
    progress: Progress | None


class BundleKeywords(WorkersKeywords, total=False):
    specs: Iterable[str | Path]
    wheel: str | Path | None
    wheels: bool
    sign: str | Path | None
    progress: Progress | None
