"""Keyword arguments of each question; made by ``roadproof.frontends.settings.keywords_file``."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from roadproof.analysis.study.pool import Progress, Say
    from roadproof.engines.search.question import Engine, Objective
    from roadproof.evidence.answers.catalogue_index import Look
    from roadproof.evidence.answers.monitor import View
    from roadproof.evidence.drive_file import DriveFile
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.frontends.api.checking import Kernel, Solver
    from roadproof.frontends.api.definitions import Among, What
    from roadproof.frontends.api.phrases import Term
    from roadproof.frontends.settings.value_types import (
        Assumed,
        Expected,
        ProofEngine,
        RoadLike,
        Same,
        Vehicles,
    )
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
    out: str | Path | None
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
    pictures: bool


class ExploreKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    out: str | Path | None
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


class ProveKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    out: str | Path | None
    effort: float
    timeout: float | None
    vehicles: Vehicles
    declared: bool
    expect: Expected
    assume: Assumed | None
    engine: ProofEngine
    road: RoadLike | None
    horizon: Number
    dt: Number | None
    drive: bool
    kernel: Kernel | None


class AskKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    out: str | Path | None
    effort: float
    timeout: float | None
    vehicles: Vehicles


class OverlapKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    out: str | Path | None
    effort: float
    timeout: float | None
    vehicles: Vehicles
    lanes: Same
    roles: Same
    start: Same
    horizon: Number | None


class OrderKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    out: str | Path | None
    effort: float
    timeout: float | None
    vehicles: Vehicles


class RedundancyKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    out: str | Path | None
    effort: float
    timeout: float | None
    vehicles: Vehicles
    whole: bool


class CoverageKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    out: str | Path | None
    effort: float
    timeout: float | None
    vehicles: Vehicles
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
    out: str | Path | None
    effort: float
    timeout: float | None
    vehicles: Vehicles
    on: str | Path | None
    shares: bool


class PreventableKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    out: str | Path | None
    effort: float
    timeout: float | None
    at: Mapping[str, Number | Sequence[Number]] | None
    along: tuple[Number, Number] | None
    across: tuple[Number, Number] | None
    lines: int
    lemmas: bool


class CatalogueKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None
    progress: Progress | None
    say: Say | None
    jobs: Jobs
    out: str | Path | None
    effort: float
    timeout: float | None
    vehicles: Vehicles
    among: Among
    classes: bool
    gaps: bool
    explore: bool
    roles: Look
    lanes: Look
    start: Look
    near: float
    drivers: Iterable[str] | None


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
