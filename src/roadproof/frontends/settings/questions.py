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
        "KIND",
        help="any, smooth (default), margin, mild, severe or short",
        choices=("any", "smooth", "margin", "mild", "severe", "short"),
    )
    count: int = option(
        1,
        "--count",
        "K",
        help="find K clearly different drives (default: 1)",
        read=whole("--count", 1),
        least=1,
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
        help="vary a parameter, or a limit such as POV.a_lon.min; may be given twice",
        gather=list,
    )
    steps: int | None = option(
        None,
        "--steps",
        "K",
        help="number of values (default: 11; 6 for each of two)",
        read=whole("--steps", 2),
    )
    least: Term | None = option(
        None, "--least", "TERM", help="find the least value of a term", read=text_or_none
    )
    greatest: Term | None = option(
        None, "--greatest", "TERM", help="find the greatest value of a term", read=text_or_none
    )
    when: What | None = option(
        None, "--when", "FORMULA", help="measure the term when FORMULA holds, not at time 0"
    )
    precision: Number | None = option(
        None,
        "--precision",
        "P",
        help="width of a bracket in SI units (default: range/60; 0.1 for a term)",
    )
    effort: float = effort_for("a question", 6.0)
    out: str | Path | None = folder_for("drives, certificates, JSON, pictures")
    pictures: bool = pictures_of(command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Overlap(Survey, Prevention):
    """Options of ``overlap``."""

    among: str | None = scenarios_such_as()
    lanes: Same = same_or_any("--lanes", "L is the same lane in both scenarios, or any")
    roles: Same = same_or_any("--roles", "vehicles have the same roles in both, or any")
    start: Same = same_or_any("--start", "both start at time 0, or one at any later time")
    horizon: Number | None = option(
        None,
        "--horizon",
        "S",
        help="seconds to search (default: 6; 9 with --start any)",
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
    whole: bool = option(False, "--whole", help="include the parts of simple predicates")
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
        help="set that misses nothing (default: complete, if it extends the set)",
    )
    roads: Iterable[RoadLike] | None = option(
        None,
        "--road",
        "R",
        help="road to search; may be repeated (default: main-2, then main-3)",
        group="search",
        gather=list,
    )
    needed: bool = option(
        False, "--needed", help="if the set has no gap: find a drive for each definition that it needs"
    )
    on: str | Path | None = option(
        None,
        "--on",
        "DIR",
        help="count the classes of gaps in these recordings",
        read=Path,
    )
    effort: float = effort_for("a search", 10.0)
    out: str | Path | None = folder_for("certificates, drives and pictures")
    pictures: bool = pictures_of(command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Classify(Survey, Prevention):
    """Options of ``classify``."""

    among: str | None = scenarios_such_as("1-8")
    on: str | Path | None = option(
        None, "--on", "DIR", help="recordings for the shares (default: simulated traffic)", read=Path
    )
    shares: bool = option(True, "--no-shares", help="compute no shares")
    effort: float = effort_for("a drive or a proof", 60.0)
    out: str | Path | None = folder_for("classes.spec, claims, evidence, picture")
    pictures: bool = pictures_of("picture", command_line_only=True)
