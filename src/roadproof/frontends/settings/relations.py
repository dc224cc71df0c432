"""Options of questions about relations between scenarios: ``overlap`` and ``order``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings import groups, readers
from roadproof.frontends.settings.option import extensible, search
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.frontends.settings.value_types import Same
    from roadproof.library.bind import Number


@extensible("overlap")
@dataclass(frozen=True, kw_only=True)
class Overlap(groups.SeveralSets, groups.Survey):
    """Options of ``overlap``."""

    among: str | None = groups.scenarios_such_as()
    lanes: Same = groups.same_or_any("--lanes", "L is the same lane in both scenarios, or any")
    roles: Same = groups.same_or_any("--roles", "vehicles have the same roles in both, or any")
    start: Same = groups.same_or_any("--start", "both start at time 0, or one at any later time")
    horizon: Number | None = search(
        None,
        "--horizon S",
        "seconds to search (default: 6; 9 with --start any)",
        read=readers.seconds,
        rare=True,
    )
    effort: float = groups.effort_for("a drive", 60.0)
    out: str | Path | None = groups.folder_for("evidence, CSV, JSON and heat map")
    pictures: bool = groups.pictures_of("heat map", command_line_only=True)


@extensible("order")
@dataclass(frozen=True, kw_only=True)
class Order(groups.Survey):
    """Options of ``order``."""

    sets: tuple[str, ...] = groups.several_sets("base", "extA", "ext")
    among: str | None = groups.scenarios_such_as()
    effort: float = groups.effort_for("a drive", 120.0)
    out: str | Path | None = groups.folder_for("certificates, drives, DOT and SVG")
    pictures: bool = groups.pictures_of("picture", command_line_only=True)
