"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from roadproof.frontends.settings.keywords import SharingKeywords, TracesKeywords, WorkersKeywords

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


class MonitorKeywords(TracesKeywords, total=False):
    lanes: Mapping[str, str] | None
    roles: Mapping[str, str] | None
    road: RoadLike | None
    view: View | None
    dt: Number
    frames: tuple[int | None, int | None]
    strict: bool
    drivers: Iterable[str]
    robust_signal: bool


class EvaluateKeywords(SharingKeywords, TracesKeywords, total=False):
    among: Among
    min_danger: Iterable[Number]
    classes: Iterable[str]
    drivers: Iterable[str]
    detectors: bool
    check: bool
    keep_going: bool
    strict: bool
    road: str | None
    pictures: bool
    tell: Say | None


class SimulateKeywords(WorkersKeywords, total=False):
    recordings: int
    seconds: float
    seed: int
    lanes: int
    flow: float
    truck_share: float
    section: float
    ramp: Ramp
    ramp_flow: float
    plant: Iterable[JudgedDrive | DriveFile]
    tell: Say | None
