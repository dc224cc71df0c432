"""The options of each question about traces and recordings."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.extensions.traffic.readers import LARGEST_SEED, frame_range, mapping_of, seconds_or_zero
from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import extensible, option, output
from roadproof.frontends.settings.readers import decimal, items_of, named, seconds, whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from roadproof.evidence.drive_file import DriveFile
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.extensions.traffic.answers.monitor import View
    from roadproof.extensions.traffic.simulate.traffic import Ramp
    from roadproof.frontends.api.definitions import Among
    from roadproof.frontends.settings.value_types import RoadLike
    from roadproof.library.bind import Number
    from roadproof.runtime.pool import Say


@extensible("monitor")
@dataclass(frozen=True, kw_only=True)
class MonitorSettings(groups.DefinitionsSettings, groups.Traces):
    """Options of ``monitor``."""

    sets: tuple[str, ...] = groups.one_set()
    lanes: Mapping[str, str] | None = option(
        None,
        "--lane [L=]LANE",
        "lane that L means: its name, or a vehicle in it at the start (default: as the drive file says, else "
        "the lane of SV; of POV for scenario 7, acceleration behind)",
        read=named("L"),
        gather=dict,
    )
    roles: Mapping[str, str] | None = option(
        None,
        "--roles SV=NAME,…",
        "vehicle of each role, such as SV=Ego,POV=Target (default: the one called as the role; for SV also "
        "ego, hero and the like; the others in the order of the file)",
        read=mapping_of("SV=Ego,POV=Target"),
        rare=True,
    )
    road: RoadLike | None = option(
        None,
        "--road R",
        "road of samples (default: NAME_road.toml beside the file, else main-2); for inD and OSI: of a map",
    )
    view: View | None = option(
        None,
        "--view",
        "judge in dense time (default: drives), or as samples",
        choices=("dense", "recorded"),
        rare=True,
    )
    dt: Number = option(
        Fraction(1, 25),
        "--dt S",
        "seconds between samples of a drive (default: 1/25)",
        read=seconds,
        rare=True,
    )
    frames: tuple[int | None, int | None] = option(
        (None, None),
        "--frames A-B",
        "frames of a recording (default: all that the vehicles share)",
        read=frame_range,
        rare=True,
    )
    strict: bool = groups.strict_reading()
    drivers: Iterable[str] = option(
        (),
        "--drivers NAME,…",
        "say what becomes of the trace where driver models (careful, r157, eu1426, rss, fsm) drive SV, all "
        "else moving as there; for scenarios 1, 2, 4 and the like on other road sectors",
        read=items_of("names", ", such as careful,r157"),
    )
    robust_signal: bool = option(
        False,
        "--robust-signal",
        "give the robustness at each sample, with its least value; of a drive and a formula without F, G and "
        "U, at every instant",
    )
    picture: Path | None = output(
        None, "--picture FILE", "draw the truth over time into FILE (.png or .svg)", read=Path, keyword=False
    )


@extensible("evaluate")
@dataclass(frozen=True, kw_only=True)
class Evaluate(groups.DefinitionsSettings, groups.Sharing, groups.Traces):
    """Options of ``evaluate``."""

    sets: tuple[str, ...] = groups.several_sets("base", "extA", "ext")
    among: Among = option(None, "--among N-M", "only these scenarios (default: all of two or three vehicles)")
    min_danger: Iterable[Number] = option(
        (0, "0.6 s"),
        "--min-danger S,S",
        "values of minDanger in seconds (default: 0,0.6)",
        read=items_of("values", read=seconds_or_zero),
    )
    min_safe: Number | None = option(
        None,
        "--min-safe S",
        "value of minSafe in seconds (default: 0.6)",
        read=seconds_or_zero,
        keyword=False,
        rare=True,
    )
    classes: Iterable[str] = option(
        ("Car",),
        "--class C",
        "vehicle class to evaluate; may be repeated (default: Car)",
        gather=tuple,
        rare=True,
    )
    drivers: Iterable[str] = option(
        (),
        "--drivers NAME,…",
        "say of each match whether driver models (careful, r157, eu1426, rss, fsm) prevent a collision in "
        "place of SV, all else moving as recorded; for scenarios 1, 2, 4 and the like on other road sectors",
        read=items_of("names", ", such as careful,r157"),
    )
    detectors: bool = option(True, "--no-detectors", "leave out the detectors of earlier works", rare=True)
    check: bool = option(False, "--check", "compare with the plain recursive evaluator (slow)", rare=True)
    keep_going: bool = option(False, "--keep-going", "skip recordings that cannot be used", rare=True)
    strict: bool = groups.strict_reading()
    road: str | None = groups.map_road()
    out: str | Path | None = groups.folder_for("results", command_line_only=True)
    list_roads: bool = output(
        False,
        "--list",
        "only list lanes and zones, and which of them were inferred",
        keyword=False,
        rare=True,
    )
    pictures: bool = groups.pictures_of("figures, which need matplotlib")
    tell: Say | None = option(None)


@extensible("simulate")
@dataclass(frozen=True, kw_only=True)
class Simulate(groups.Workers):
    """Options of ``simulate``."""

    recordings: int = option(1, "--recordings N", "number of recordings (default: 1)", read=whole(1, 999))
    seconds: float = option(990.0, "--seconds S", "seconds of each recording (default: 990)", read=decimal)
    seed: int = option(1, "--seed K", "seed from 0 to 2^64 - 1 (default: 1)", read=whole(0, LARGEST_SEED))
    lanes: int = option(3, "--lanes N", "lanes each way (default: 3)", read=whole(1))
    flow: float = option(3350.0, "--flow F", "vehicles per hour each way (default: 3350)", read=decimal)
    truck_share: float = option(
        0.18, "--truck-share P", "share of trucks (default: 0.18)", read=float, rare=True
    )
    section: float = option(
        420.0, "--section M", "length of the road in metres (default: 420)", read=decimal, rare=True
    )
    ramp: Ramp = option(
        "none",
        "--ramp",
        "add an on-ramp or an off-ramp to the lower carriageway, with XX_road.toml (default: none)",
        choices=("none", "merge", "depart"),
        checked=False,
    )
    ramp_flow: float = option(
        400.0, "--ramp-flow F", "vehicles per hour on the ramp (default: 400)", read=decimal, rare=True
    )
    plant: Iterable[JudgedDrive | DriveFile] = option(
        (),
        "--plant PATH|N,N",
        "plant drives: a drive file, a folder of them, or scenarios to search, such as 1-8; may be repeated",
        gather=tuple,
    )
    plant_set: str = option(
        "base", "--plant-set S", "spec set of --plant N,N (default: base)", keyword=False, rare=True
    )
    out: str | Path | None = groups.folder_for("recordings", command_line_only=True, required=True)
    tell: Say | None = option(None)
