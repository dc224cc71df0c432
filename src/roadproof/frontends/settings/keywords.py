"""Keyword arguments of each question; made by ``roadproof.frontends.settings.keywords_file``."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from roadproof.analysis.study.pool import Progress, Say
    from roadproof.engines.search.question import Engine, Objective
    from roadproof.evidence.answers.monitor import View
    from roadproof.evidence.drive_file import DriveFile
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.frontends.api.checking import Kernel, Solver
    from roadproof.frontends.api.definitions import Among, What
    from roadproof.frontends.api.phrases import Term
    from roadproof.frontends.settings.value_types import RoadLike, Same, Vehicles
    from roadproof.library.values import Number
    from roadproof.recordings.simulate.traffic import Ramp
    from roadproof.runtime.executors import Jobs
    from roadproof.semantics.sampled.answers import Convention


class CompareKeywords(TypedDict, total=False):
    jobs: Jobs
    effort: float
    timeout: float | None
    engine: Engine
    solver: str
    vehicles: Vehicles
    road: RoadLike | None
    lanes: Mapping[str, str] | None
    horizon: Number
    dt: Number | None
    reach: Number
    collisions: bool


class WitnessKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    effort: float
    timeout: float | None
    preventable: str | None
    unpreventable: str | None
    engine: Engine
    solver: str
    vehicles: Vehicles
    road: RoadLike | None
    lanes: Mapping[str, str] | None
    horizon: Number
    dt: Number | None
    reach: Number
    collisions: bool
    objective: Objective
    count: int
    out: str | Path | None
    pictures: bool


class ExploreKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    effort: float
    timeout: float | None
    preventable: str | None
    unpreventable: str | None
    engine: Engine
    solver: str
    vehicles: Vehicles
    road: RoadLike | None
    lanes: Mapping[str, str] | None
    horizon: Number
    dt: Number | None
    reach: Number
    collisions: bool
    vary: Mapping[str, tuple[Number, Number]] | None
    steps: int | None
    least: Term | None
    greatest: Term | None
    when: What | None
    precision: Number | None
    out: str | Path | None


class OverlapKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    effort: float
    timeout: float | None
    vehicles: Vehicles
    out: str | Path | None
    lanes: Same
    roles: Same
    start: Same
    horizon: Number | None


class OrderKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    effort: float
    timeout: float | None
    vehicles: Vehicles
    out: str | Path | None


class RedundancyKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    effort: float
    timeout: float | None
    vehicles: Vehicles
    out: str | Path | None
    whole: bool


class CoverageKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    effort: float
    timeout: float | None
    vehicles: Vehicles
    out: str | Path | None
    wider: str | None
    roads: Iterable[RoadLike] | None
    needed: bool
    on: str | Path | None


class ClassifyKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    effort: float
    timeout: float | None
    vehicles: Vehicles
    out: str | Path | None
    on: str | Path | None
    shares: bool


class MonitorKeywords(TypedDict, total=False):
    end: Convention
    lanes: Mapping[str, str] | None
    road: RoadLike | None
    view: View | None
    dt: Number
    frames: tuple[int | None, int | None]


class EvaluateKeywords(TypedDict, total=False):
    end: Convention
    jobs: Jobs
    among: Among
    min_danger: Iterable[Number]
    classes: Iterable[str]
    drivers: Iterable[str]
    detectors: bool
    check: bool
    keep_going: bool
    pictures: bool
    tell: Say | None


class SimulateKeywords(TypedDict, total=False):
    jobs: Jobs
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


class ExportKeywords(TypedDict, total=False):
    rate: int
    specs: Iterable[str | Path]


class CheckKeywords(TypedDict, total=False):
    jobs: Jobs
    effort: float
    timeout: float | None
    solver: Solver
    specs: Iterable[str | Path]
    kernel: Kernel | None
    strict: bool
    progress: Progress | None


class PageKeywords(TypedDict, total=False):
    jobs: Jobs
    title: str | None
    solver: Solver
    specs: Iterable[str | Path]
    progress: Progress | None
