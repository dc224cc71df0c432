"""The options of each question that takes long, about many scenarios."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings import groups, readers
from roadproof.frontends.settings.option import option, output, search
from roadproof.frontends.settings.readers import whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from roadproof.evidence.claim import Objective
    from roadproof.extensions.catalogue.kept import Look
    from roadproof.frontends.api.checking import Kernel
    from roadproof.frontends.api.definitions import Among
    from roadproof.frontends.settings.value_types import RoadLike, Same
    from roadproof.library.bind import Number


@dataclass(frozen=True, kw_only=True)
class Ask(groups.Survey):
    """Options of ``ask``."""

    among: str | None = groups.scenarios_such_as()


@dataclass(frozen=True, kw_only=True)
class Atlas(groups.Readings, groups.Run):
    """Options of ``atlas``."""

    among: Among = groups.scenarios_such_as("1-8", keyword=True)
    topics: Sequence[str] = option(
        (),
        "--topics NAME,…",
        "only these: proofs, drives, overlaps, implications, redundancy, gaps, classes or plates "
        "(default: all)",
        read=readers.items_of("topics", ", such as drives,overlaps"),
    )
    out: str | Path | None = groups.folder_for("pages and evidence", required=True)


@dataclass(frozen=True, kw_only=True)
class Overlap(groups.SeveralSets, groups.Survey, groups.Prevention):
    """Options of ``overlap``."""

    among: str | None = groups.scenarios_such_as()
    lanes: Same = groups.same_or_any("--lanes", "L is the same lane in both scenarios, or any")
    roles: Same = groups.same_or_any("--roles", "vehicles have the same roles in both, or any")
    start: Same = groups.same_or_any("--start", "both start at time 0, or one at any later time")
    horizon: Number | None = search(
        None, "--horizon S", "seconds to search (default: 6; 9 with --start any)", read=readers.seconds
    )
    effort: float = groups.effort_for("a drive", 60.0)
    out: str | Path | None = groups.folder_for("evidence, CSV, JSON and heat map")
    pictures: bool = groups.pictures_of("heat map", command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Order(groups.Survey):
    """Options of ``order``."""

    sets: tuple[str, ...] = groups.several_sets("base", "extA", "ext")
    among: str | None = groups.scenarios_such_as()
    effort: float = groups.effort_for("a drive", 120.0)
    out: str | Path | None = groups.folder_for("certificates, drives, DOT and SVG")
    pictures: bool = groups.pictures_of("picture", command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Redundancy(groups.Survey):
    """Options of ``redundancy``."""

    among: str | None = groups.scenarios_such_as()
    whole: bool = option(False, "--whole", "include the parts of simple predicates")
    effort: float = groups.effort_for("a drive", 20.0)


@dataclass(frozen=True, kw_only=True)
class Coverage(groups.Survey, groups.Prevention, groups.Reported):
    """Options of ``coverage``."""

    preventable: str | None = groups.driver_model("preventable", "prevents", "drives")
    unpreventable: str | None = groups.driver_model("unpreventable", "cannot prevent", "drives")
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
    strict: bool = groups.strict_reading()
    effort: float = groups.effort_for("a search", 10.0)
    out: str | Path | None = groups.folder_for("certificates, drives and pictures")
    pictures: bool = groups.pictures_of(command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Classify(groups.Survey, groups.Prevention):
    """Options of ``classify``."""

    among: str | None = groups.scenarios_such_as("1-8")
    on: str | Path | None = option(
        None, "--on DIR", "recordings for the shares (default: simulated traffic)", read=Path
    )
    strict: bool = groups.strict_reading()
    shares: bool = option(True, "--no-shares", "compute no shares")
    effort: float = groups.effort_for("a drive or a proof", 60.0)
    out: str | Path | None = groups.folder_for("classes.spec, claims, evidence, picture")
    pictures: bool = groups.pictures_of("picture", command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Preventable(groups.Definitions, groups.Budget, groups.Sharing, groups.Run, groups.Reported):
    """Options of ``preventable``."""

    models: Sequence[str] = option(
        (),
        "--model NAME",
        "driver model: careful, r157, eu1426, rss or fsm (default: all but fsm)",
        read=readers.items_of("names", ", such as careful,r157"),
        gather=readers.flat,
        keyword=False,
    )
    at: Mapping[str, Number | Sequence[Number]] | None = option(
        None,
        "--at NAME=VALUE[,…]",
        "fix an initial value; several values make several plates",
        read=readers.initial_values,
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
    kernel: Kernel | None = option(
        None,
        "--kernel",
        "also prove each formula against the motion, with the kernel of Coq (coqc)",
        choices=("coq",),
    )
    effort: float = groups.effort_for("a lemma", 60.0)
    out: str | Path | None = groups.folder_for("drives, certificates, CSV, pictures")
    pictures: bool = groups.pictures_of(command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Catalogue(
    groups.SeveralSets, groups.Models, groups.Budget, groups.Run, groups.Prevention, groups.Reported
):
    """Options of ``catalogue``."""

    among: Among = groups.scenarios_such_as("1-8", keyword=True)
    classes: bool = option(True, "--no-classes", "ask about scenarios only")
    gaps: bool = option(False, "--gaps", "also ask for a test of each class of gaps that is not proved empty")
    explore: bool = option(
        False, "--explore", "also ask how drives of each class can begin, and which part no test covers"
    )
    roles: Look = groups.fixed_or_any("--roles", "choices of roles")
    lanes: Look = groups.fixed_or_any("--lanes", "lanes")
    start: Look = groups.fixed_or_any("--start", "instants")
    strict: bool = groups.strict_reading()
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
        read=readers.driver_models_or_none,
    )
    effort: float = groups.effort_for("a drive", 60.0)
    out: str | Path | None = groups.folder_for("matrix, JUnit, picture, evidence")
    pictures: bool = groups.pictures_of("picture", command_line_only=True)
    complete: Path | None = output(
        None,
        "--complete DIR",
        "write a drive for each scenario and class without a test",
        read=Path,
        keyword=False,
    )
    objective: Objective | None = groups.with_complete(
        "--objective", "what the drives should be like (default: smooth)", choices=groups.OBJECTIVES
    )
    spread: int | None = groups.with_complete(
        "--spread K", "write drives far from the tests until each class has K tests", read=whole(1)
    )
    formats: Sequence[str] | None = groups.with_complete(
        "--format FORMAT", "also write openscenario, commonroad, highd, csv or opendrive", gather=list
    )
