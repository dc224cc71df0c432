"""The options of each question about evidence that was written before."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings.groups import Budget, Workers, checker_of, effort_for, specifications_of
from roadproof.frontends.settings.option import option

if TYPE_CHECKING:
    from collections.abc import Iterable

    from roadproof.analysis.study.pool import Progress
    from roadproof.frontends.api.checking import Kernel, Solver


@dataclass(frozen=True, kw_only=True)
class Check(Budget, Workers):
    """Options of ``check``."""

    solver: Solver = checker_of("solver that checks certificates")
    specs: Iterable[str | Path] = specifications_of("the claims")
    kernel: Kernel | None = option(
        None,
        "--kernel",
        help="check certificates and drives with the kernel of Coq (coqc) instead of a solver",
        choices=("coq",),
    )
    strict: bool = option(
        False, "--strict", help="exit with 20 if an answer has no evidence (UNKNOWN, NONE-WITHIN)"
    )
    effort: float = effort_for("a query", 60.0)
    write: Path | None = option(
        None,
        "--write DIR",
        help="only write the files for Coq, with --kernel",
        group="output",
        read=Path,
        keyword=False,
    )
    progress: Progress | None = option(None)


@dataclass(frozen=True, kw_only=True)
class Page(Workers):
    """Options of ``report``, which is ``page`` in Python."""

    title: str | None = option(None, "--title TEXT", help="title of the page", group="output")
    solver: Solver = checker_of("solver that checks certificates")
    specs: Iterable[str | Path] = specifications_of("the results")
    progress: Progress | None = option(None)
