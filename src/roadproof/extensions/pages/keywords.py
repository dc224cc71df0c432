"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from roadproof.frontends.settings.keywords import RunKeywords, WorkersKeywords

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from roadproof.frontends.api.checking import Solver
    from roadproof.frontends.api.definitions import Among
    from roadproof.runtime.pool import Progress


class AtlasKeywords(RunKeywords, total=False):
    among: Among
    topics: Sequence[str]


class PageKeywords(WorkersKeywords, total=False):
    title: str | None
    solver: Solver
    specs: Iterable[str | Path]
    progress: Progress | None
