"""The options of exports and of compiled monitors."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.extensions.encoding.kinds import TARGETS
from roadproof.extensions.encoding.settings import drives_to_encode
from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import Settings, option
from roadproof.frontends.settings.readers import seconds, whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from roadproof.extensions.encoding.kinds import Drives
    from roadproof.frontends.settings.value_types import RoadLike
    from roadproof.library.bind import Number


@dataclass(frozen=True, kw_only=True)
class Export(Settings):
    """Options of ``export``."""

    to: Iterable[str] = option(
        (),
        "--to FORMAT",
        "openscenario, opendrive, commonroad, highd, csv, animation, gif or mp4; may be repeated",
        gather=list,
        keyword=False,
        required=True,
    )
    rate: int = option(
        25, "--rate N", "samples per second of commonroad, highd and csv (default: 25)", read=whole(1)
    )
    specs: Iterable[str | Path] = groups.specifications_of("the drives")
    out: str | Path | None = groups.folder_for("files", command_line_only=True, required=True)


@dataclass(frozen=True, kw_only=True)
class Compile(groups.Values, groups.SearchPlace):
    """Options of ``compile``."""

    sets: tuple[str, ...] = groups.one_set("base")
    to: str = option(
        "c",
        "--to TARGET",
        "c: monitors in C99 (default); mps, lp or smt2: the problem that a search for drives solves",
        choices=("c", *TARGETS),
        keyword=False,
    )
    dt: Number | None = option(
        None,
        "--dt S",
        "seconds between samples (default: c 1/25; else the coarsest that fits, at most 3/5)",
        read=seconds,
    )
    road: RoadLike | None = option(
        None,
        "--road R",
        "road (default: c has flags for lanes in samples; else by formula)",
    )
    drives: Drives = drives_to_encode()
    memory: int = option(
        65_536,
        "--memory N",
        "bytes that the state of a monitor may take (default: 65536)",
        read=whole(1),
        rare=True,
    )
    name: str = option(
        "monitor", "--name NAME", "name of the files and of types (default: monitor)", rare=True
    )
    out: str | Path | None = groups.folder_for("the files", command_line_only=True, required=True)


@dataclass(frozen=True, kw_only=True)
class OnlineMonitorSettings(Settings):
    """Options of ``online_monitor``, which is for Python alone."""

    dt: Number = option(Fraction(1, 25))
    road: RoadLike | None = option(None)
    lanes: Mapping[str, str] | None = option(None)
    strict: bool = option(False)
