"""The options of each question that takes long, about many scenarios."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings.groups import (
    OBJECTIVES,
    Budget,
    Definitions,
    Models,
    Prevention,
    Readings,
    Run,
    SeveralSets,
    Sharing,
    Survey,
    driver_model,
    effort_for,
    fixed_or_any,
    folder_for,
    pictures_of,
    same_or_any,
    scenarios_such_as,
    several_sets,
    with_complete,
)
from roadproof.frontends.settings.option import option, output, search
from roadproof.frontends.settings.readers import (
    driver_models_or_none,
    flat,
    initial_values,
    items_of,
    seconds,
    whole,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from roadproof.engines.search.question import Objective
    from roadproof.evidence.answers.catalogue_index import Look
    from roadproof.frontends.api.definitions import Among
    from roadproof.frontends.settings.value_types import RoadLike, Same
    from roadproof.library.bind import Number


@dataclass(frozen=True, kw_only=True)
class Ask(Survey):
    """Options of ``ask``."""

    among: str | None = scenarios_such_as()


@dataclass(frozen=True, kw_only=True)
class Atlas(Readings, Run):
    """Options of ``atlas``."""

    among: Among = scenarios_such_as("1-8", keyword=True)
    topics: Sequence[str] = option(
        (),
        "--topics NAME,…",
        "only these: proofs, drives, overlaps, implications, redundancy, gaps, classes or plates "
        "(default: all)",
        read=items_of("topics", ", such as drives,overlaps"),
    )
    out: str | Path | None = folder_for("pages and evidence", required=True)


@dataclass(frozen=True, kw_only=True)
class Overlap(SeveralSets, Survey, Prevention):
    """Options of ``overlap``."""

    among: str | None = scenarios_such_as()
    lanes: Same = same_or_any("--lanes", "L is the same lane in both scenarios, or any")
    roles: Same = same_or_any("--roles", "vehicles have the same roles in both, or any")
    start: Same = same_or_any("--start", "both start at time 0, or one at any later time")
    horizon: Number | None = search(
        None, "--horizon S", "seconds to search (default: 6; 9 with --start any)", read=seconds
    )
    effort: float = effort_for("a drive", 60.0)
    out: str | Path | None = folder_for("evidence, CSV, JSON and heat map")
    pictures: bool = pictures_of("heat map", command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Order(Survey):
    """Options of ``order``."""

    sets: tuple[str, ...] = several_sets("base", "extA", "ext")
    among: str | None = scenarios_such_as()
    effort: float = effort_for("a drive", 120.0)
    out: str | Path | None = folder_for("certificates, drives, DOT and SVG")
    pictures: bool = pictures_of("picture", command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Redundancy(Survey):
    """Options of ``redundancy``."""

    among: str | None = scenarios_such_as()
    whole: bool = option(False, "--whole", "include the parts of simple predicates")
    effort: float = effort_for("a drive", 20.0)


@dataclass(frozen=True, kw_only=True)
class Coverage(Survey, Prevention):
    """Options of ``coverage``."""

    preventable: str | None = driver_model("preventable", "prevents", "drives")
    unpreventable: str | None = driver_model("unpreventable", "cannot prevent", "drives")
    wider: str | None = option(
        None, "--wider S", "set that misses nothing (default: complete, if it extends the set)"
    )
    roads: Iterable[RoadLike] | None = search(
        None, "--road R", "road to search; may be repeated (default: main-2, then main-3)", gather=list
    )
    needed: bool = option(
        False, "--needed", "if the set has no gap: find a drive for each definition that it needs"
    )
    on: str | Path | None = option(
        None, "--on DIR", "count the classes of gaps in these recordings", read=Path
    )
    effort: float = effort_for("a search", 10.0)
    out: str | Path | None = folder_for("certificates, drives and pictures")
    pictures: bool = pictures_of(command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Classify(Survey, Prevention):
    """Options of ``classify``."""

    among: str | None = scenarios_such_as("1-8")
    on: str | Path | None = option(
        None, "--on DIR", "recordings for the shares (default: simulated traffic)", read=Path
    )
    shares: bool = option(True, "--no-shares", "compute no shares")
    effort: float = effort_for("a drive or a proof", 60.0)
    out: str | Path | None = folder_for("classes.spec, claims, evidence, picture")
    pictures: bool = pictures_of("picture", command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Preventable(Definitions, Budget, Sharing, Run):
    """Options of ``preventable``."""

    models: Sequence[str] = option(
        (),
        "--model NAME",
        "driver model: careful, r157, eu1426, rss or fsm (default: all but fsm)",
        read=items_of("names", ", such as careful,r157"),
        gather=flat,
        keyword=False,
    )
    at: Mapping[str, Number | Sequence[Number]] | None = option(
        None,
        "--at NAME=VALUE[,…]",
        "fix an initial value; several values make several plates",
        read=initial_values,
        gather=dict,
    )
    along: tuple[Number, Number] | None = option(
        None, "--along NAME=LOW:HIGH", "range of the value along each line"
    )
    across: tuple[Number, Number] | None = option(
        None, "--across NAME=LOW:HIGH", "range of the value across the lines"
    )
    lines: int = option(100, "--lines K", "lines of a plate (default: 100)", read=whole(2))
    lemmas: bool = option(True, "--no-lemmas", "prove no lemmas")
    effort: float = effort_for("a lemma", 60.0)
    out: str | Path | None = folder_for("drives, certificates, CSV, pictures")
    pictures: bool = pictures_of(command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Catalogue(SeveralSets, Models, Budget, Run, Prevention):
    """Options of ``catalogue``."""

    among: Among = scenarios_such_as("1-8", keyword=True)
    classes: bool = option(True, "--no-classes", "ask about scenarios only")
    gaps: bool = option(False, "--gaps", "also ask for a test of each class of gaps that is not proved empty")
    explore: bool = option(
        False, "--explore", "also ask how drives of each class can begin, and which part no test covers"
    )
    roles: Look = fixed_or_any("--roles", "choices of roles")
    lanes: Look = fixed_or_any("--lanes", "lanes")
    start: Look = fixed_or_any("--start", "instants")
    near: float = option(
        0.5,
        "--near X",
        "tests that show the same and begin within X m and m/s are duplicates (default: 0.5)",
        read=float,
        rare=True,
    )
    drivers: Iterable[str] | None = option(
        None,
        "--drivers MODELS",
        "driver models that drive each test: careful,r157, or none (default: all)",
        read=driver_models_or_none,
    )
    effort: float = effort_for("a drive", 60.0)
    out: str | Path | None = folder_for("matrix, JUnit, picture, evidence")
    pictures: bool = pictures_of("picture", command_line_only=True)
    complete: Path | None = output(
        None,
        "--complete DIR",
        "write a drive for each scenario and class without a test",
        read=Path,
        keyword=False,
    )
    objective: Objective | None = with_complete(
        "--objective", "what the drives should be like (default: smooth)", choices=OBJECTIVES
    )
    spread: int | None = with_complete(
        "--spread K", "write drives far from the tests until each class has K tests", read=whole(1)
    )
    formats: Sequence[str] | None = with_complete(
        "--format FORMAT", "also write openscenario, commonroad, highd, csv or opendrive", gather=list
    )
