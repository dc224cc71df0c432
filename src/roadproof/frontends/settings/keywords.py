"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from roadproof.evidence.claim import Engine, Objective
    from roadproof.frontends.api.checking import Kernel, Solver
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


class SurveyKeywords(ModelsKeywords, BudgetKeywords, SharingKeywords, RunKeywords, total=False):
    pass


class DriveSearchKeywords(
    SearchPlaceKeywords,
    MethodKeywords,
    BudgetKeywords,
    SharingKeywords,
    RunKeywords,
    total=False,
):
    pass


class CompareKeywords(SearchPlaceKeywords, MethodKeywords, BudgetKeywords, RunKeywords, total=False):
    pass


class PreventionKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None


class EncodingOptionsKeywords(TypedDict, total=False):
    solution: Path | None
    explain: bool


class WitnessKeywords(DriveSearchKeywords, PreventionKeywords, EncodingOptionsKeywords, total=False):
    objective: Objective
    count: int
    pictures: bool
    animate: str | Iterable[str]


class MotionKeywords(TypedDict, total=False):
    length: Number
    width: Number
    kind: Kind | None


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


class OverlapKeywords(SurveyKeywords, PreventionKeywords, total=False):
    lanes: Same
    roles: Same
    start: Same
    horizon: Number | None


class OrderKeywords(SurveyKeywords, total=False):
    pass
