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
    Survey,
    Workers,
    driver_model,
    effort_for,
    folder_for,
    pictures_of,
    same_or_any,
    scenarios_such_as,
)
from roadproof.frontends.settings.option import option
from roadproof.frontends.settings.readers import seconds, text_or_none, whole

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from roadproof.engines.search.question import Objective
    from roadproof.frontends.api.definitions import What
    from roadproof.frontends.api.phrases import Term
    from roadproof.frontends.settings.value_types import RoadLike, Same
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


@dataclass(frozen=True, kw_only=True)
class Overlap(Survey, Prevention):
    """Options of ``overlap``."""

    among: str | None = scenarios_such_as()
    lanes: Same = same_or_any("--lanes", "both speak of one lane, or each of its own")
    roles: Same = same_or_any("--roles", "vehicles play the same parts in both, or any")
    start: Same = same_or_any("--start", "both start at 0, or one then or later")
    horizon: Number | None = option(
        None,
        "--horizon",
        "S",
        help="seconds of driving searched (default: 6; 9 with --start any)",
        group="search",
        read=seconds("--horizon"),
    )
    effort: float = effort_for("a drive", 60.0)
    out: str | Path | None = folder_for("evidence, CSV, JSON and heat map")
    pictures: bool = pictures_of("heat map", command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Order(Survey):
    """Options of ``order``."""

    among: str | None = scenarios_such_as()
    effort: float = effort_for("a drive", 120.0)
    out: str | Path | None = folder_for("certificates, drives, DOT and SVG")
    pictures: bool = pictures_of("picture", command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Redundancy(Survey):
    """Options of ``redundancy``."""

    among: str | None = scenarios_such_as()
    whole: bool = option(False, "--whole", help="also the parts of simple predicates")
    effort: float = effort_for("a drive", 20.0)


@dataclass(frozen=True, kw_only=True)
class Coverage(Survey, Prevention):
    """Options of ``coverage``."""

    preventable: str | None = driver_model("preventable", "prevents", "drives")
    unpreventable: str | None = driver_model("unpreventable", "cannot prevent", "drives")
    wider: str | None = option(
        None,
        "--wider",
        "S",
        help="the set that catches all (default: complete, where it extends the set)",
    )
    roads: Iterable[RoadLike] | None = option(
        None,
        "--road",
        "R",
        help="where to look for drives; may be repeated (default: main-2, then main-3)",
        group="search",
        gather=list,
    )
    needed: bool = option(
        False, "--needed", help="of a set that covers: a drive for each definition it needs"
    )
    on: str | Path | None = option(
        None,
        "--on",
        "DIR",
        help="count the classes in recordings, as roadproof simulate makes",
        read=Path,
    )
    effort: float = effort_for("a search, half of it for one more that another set catches", 10.0)
    out: str | Path | None = folder_for("certificates, drives and pictures")
    pictures: bool = pictures_of(command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Classify(Survey, Prevention):
    """Options of ``classify``."""

    among: str | None = scenarios_such_as("1-8")
    on: str | Path | None = option(
        None, "--on", "DIR", help="recordings (default: simulated for this)", read=Path
    )
    shares: bool = option(True, "--no-shares", help="no recordings, so no shares")
    effort: float = effort_for("a drive or a proof", 60.0)
    out: str | Path | None = folder_for("classes.spec, claims, evidence, picture")
    pictures: bool = pictures_of("picture", command_line_only=True)
