"""The options of ``catalogue``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.extensions.drivers.options import Prevention
from roadproof.frontends.settings import groups, readers
from roadproof.frontends.settings.option import extensible, option, output
from roadproof.frontends.settings.readers import (
    whole,
)
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from roadproof.evidence.claim import Objective
    from roadproof.extensions.catalogue.kept import Look
    from roadproof.frontends.api.definitions import Among


@extensible("catalogue")
@dataclass(frozen=True, kw_only=True)
class Catalogue(groups.SeveralSets, groups.Models, groups.Budget, groups.Run, Prevention):
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
