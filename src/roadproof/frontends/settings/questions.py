"""The options of each question."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings.groups import (
    Budget,
    Listeners,
    Prevention,
    SearchPlace,
    Sharing,
    Solver,
    Workers,
    effort_for,
    folder_for,
    pictures_of,
)
from roadproof.frontends.settings.option import option
from roadproof.frontends.settings.readers import text_or_none, whole

if TYPE_CHECKING:
    from collections.abc import Mapping

    from roadproof.engines.search.question import Objective
    from roadproof.frontends.api.definitions import What
    from roadproof.frontends.api.phrases import Term
    from roadproof.library.values import Number


@dataclass(frozen=True, kw_only=True)
class Compare(SearchPlace, Solver, Budget, Workers):
    """Options of ``compare``."""

    out: str | Path | None = folder_for("certificates and drive files", command_line_only=True)


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


@dataclass(frozen=True, kw_only=True)
class Explore(SearchPlace, Solver, Prevention, Budget, Sharing, Listeners):
    """Options of ``explore``."""

    vary: Mapping[str, tuple[Number, Number]] | None = option(
        None,
        "--vary",
        "NAME=LOW:HIGH",
        help="a parameter, or a limit such as POV.a_lon.min; may be given twice",
        gather=list,
    )
    steps: int | None = option(
        None, "--steps", "K", help="values of each (default: 11; of two: 6)", read=whole("--steps", 2)
    )
    least: Term | None = option(None, "--least", "TERM", help="the least value of a term", read=text_or_none)
    greatest: Term | None = option(
        None, "--greatest", "TERM", help="the greatest value of a term", read=text_or_none
    )
    when: What | None = option(
        None, "--when", "FORMULA", help="measure at a moment at which this holds, not at 0"
    )
    precision: Number | None = option(
        None,
        "--precision",
        "P",
        help="width of a bracket, in SI units (default: range/60; of a measure 0.1)",
    )
    effort: float = effort_for("a question", 6.0)
    out: str | Path | None = folder_for("drives, certificates, JSON, pictures")
    pictures: bool = pictures_of(command_line_only=True)
