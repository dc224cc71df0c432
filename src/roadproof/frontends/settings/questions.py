"""The options of each question."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings.groups import (
    Budget,
    Listeners,
    Models,
    Prevention,
    SearchPlace,
    Sharing,
    Solver,
    Workers,
    driver_model,
    effort_for,
    folder_for,
    pictures_of,
)
from roadproof.frontends.settings.option import option
from roadproof.frontends.settings.readers import seconds, whole

if TYPE_CHECKING:
    from roadproof.engines.search.question import Objective
    from roadproof.library.values import Number


@dataclass(frozen=True, kw_only=True)
class Compare(SearchPlace, Solver, Budget, Workers):
    """Options of ``compare``."""


@dataclass(frozen=True, kw_only=True)
class Witness(SearchPlace, Solver, Prevention, Budget, Sharing, Listeners):
    """Options of ``witness``."""

    objective: Objective = option(
        "smooth",
        "--objective",
        help="what the drive should be like (default: smooth)",
        choices=("any", "smooth", "margin", "mild", "severe", "short"),
    )
    count: int = option(
        1, "--count", "K", help="K clearly different drives", read=whole("--count", 1), least=1
    )
    out: str | Path | None = folder_for("drive files, CSV and pictures")
    pictures: bool = pictures_of()
