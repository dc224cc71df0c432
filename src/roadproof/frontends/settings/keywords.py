"""Keyword arguments of each question; made by ``roadproof.frontends.settings.keywords_file``."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from roadproof.evidence.claim import Engine, Objective
    from roadproof.evidence.drive_file import DriveFile
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.extensions.catalogue.kept import Look
    from roadproof.extensions.traffic.answers.monitor import View
    from roadproof.extensions.traffic.simulate.traffic import Ramp
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
    from roadproof.library.bind import Number
    from roadproof.runtime.executors import Jobs
    from roadproof.runtime.pool import Progress, Say
    from roadproof.semantics.sampled.answers import Convention
    from roadproof.world.signals import Kind


class ModelsKeywords(TypedDict, total=False):
    vehicles: Vehicles


class SearchPlaceKeywords(ModelsKeywords, total=False):
    road: RoadLike | None
    lanes: Mapping[str, str] | None
    horizon: Number
    dt: Number | None
    reach: Number
    collisions: bool
    strict: bool


class TracesKeywords(TypedDict, total=False):
    end: Convention


class MethodKeywords(TypedDict, total=False):
    engine: Engine
    solver: str


class BudgetKeywords(TypedDict, total=False):
    effort: float
    timeout: float | None


class WorkersKeywords(TypedDict, total=False):
    jobs: Jobs


class ListenersKeywords(TypedDict, total=False):
    progress: Progress | None
    say: Say | None


class RunKeywords(WorkersKeywords, ListenersKeywords, total=False):
    out: str | Path | None
    fresh: bool


class SharingKeywords(WorkersKeywords, total=False):
    pass


class PreventionKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None


class SurveyKeywords(ModelsKeywords, BudgetKeywords, SharingKeywords, RunKeywords, total=False):
    pass


class DriveSearchKeywords(
    SearchPlaceKeywords,
    MethodKeywords,
    PreventionKeywords,
    BudgetKeywords,
    SharingKeywords,
    RunKeywords,
    total=False,
):
    pass


class CompareKeywords(SearchPlaceKeywords, MethodKeywords, BudgetKeywords, RunKeywords, total=False):
    pass


class WitnessKeywords(DriveSearchKeywords, total=False):
    objective: Objective
    count: int
    pictures: bool
    animate: str | Iterable[str]


class ExploreKeywords(DriveSearchKeywords, total=False):
    vary: Mapping[str, tuple[Number, Number]] | None
    steps: int | None
    least: Term | None
    greatest: Term | None
    when: What | None
    precision: Number | None


class ProveKeywords(ModelsKeywords, BudgetKeywords, RunKeywords, total=False):
    declared: bool
    expect: Expected
    assume: Assumed | None
    engine: ProofEngine
    road: RoadLike | None
    horizon: Number
    dt: Number | None
    drive: bool
    strict: bool
    kernel: Kernel | None


class CheckKeywords(BudgetKeywords, WorkersKeywords, total=False):
    solver: Solver
    specs: Iterable[str | Path]
    kernel: Kernel | None
    strict: bool
    progress: Progress | None


class AssuranceKeywords(BudgetKeywords, WorkersKeywords, total=False):
    solver: Solver
    specs: Iterable[str | Path]
    strict: bool
    svg: str | Path | None
    page: str | Path | None
    progress: Progress | None


class PageKeywords(WorkersKeywords, total=False):
    title: str | None
    solver: Solver
    specs: Iterable[str | Path]
    progress: Progress | None


class RequirementsKeywords(WorkersKeywords, total=False):
    accept: bool
    solver: Solver
    specs: Iterable[str | Path]
    progress: Progress | None


class BundleKeywords(WorkersKeywords, total=False):
    specs: Iterable[str | Path]
    wheel: str | Path | None
    wheels: bool
    sign: str | Path | None
    progress: Progress | None


class AskKeywords(SurveyKeywords, total=False):
    pass


class AtlasKeywords(RunKeywords, total=False):
    among: Among
    topics: Sequence[str]


class OverlapKeywords(SurveyKeywords, PreventionKeywords, total=False):
    lanes: Same
    roles: Same
    start: Same
    horizon: Number | None


class OrderKeywords(SurveyKeywords, total=False):
    pass


class RedundancyKeywords(SurveyKeywords, total=False):
    whole: bool


class CoverageKeywords(SurveyKeywords, PreventionKeywords, total=False):
    wider: str | None
    roads: Iterable[RoadLike] | None
    needed: bool
    on: str | Path | None
    strict: bool


class ClassifyKeywords(SurveyKeywords, PreventionKeywords, total=False):
    on: str | Path | None
    strict: bool
    shares: bool


class PreventableKeywords(BudgetKeywords, SharingKeywords, RunKeywords, total=False):
    at: Mapping[str, Number | Sequence[Number]] | None
    along: tuple[Number, Number] | None
    across: tuple[Number, Number] | None
    lines: int
    lemmas: bool
    kernel: Kernel | None


class CatalogueKeywords(ModelsKeywords, BudgetKeywords, RunKeywords, PreventionKeywords, total=False):
    among: Among
    classes: bool
    gaps: bool
    explore: bool
    roles: Look
    lanes: Look
    start: Look
    strict: bool
    near: float
    drivers: Iterable[str] | None


class MonitorKeywords(TracesKeywords, total=False):
    lanes: Mapping[str, str] | None
    roles: Mapping[str, str] | None
    road: RoadLike | None
    view: View | None
    dt: Number
    frames: tuple[int | None, int | None]
    strict: bool
    drivers: Iterable[str]


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


class MotionKeywords(TypedDict, total=False):
    length: Number
    width: Number
    kind: Kind | None


class ExportKeywords(TypedDict, total=False):
    rate: int
    specs: Iterable[str | Path]


class CompileKeywords(TypedDict, total=False):
    dt: Number
    road: RoadLike | None
    lanes: Mapping[str, str] | None
    strict: bool
    memory: int
    name: str
