"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

from roadproof.frontends.settings.keywords import BudgetKeywords, ModelsKeywords, RunKeywords, SharingKeywords

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from roadproof.extensions.closed_loop.data import Method, Wanted
    from roadproof.frontends.api.definitions import Among
    from roadproof.library.bind import Number


class ControllerRunsKeywords(TypedDict, total=False):
    require: Iterable[str]
    drivers: Iterable[str] | None
    step: Number
    seconds: Number
    patience: float


class FalsifyKeywords(
    ModelsKeywords,
    ControllerRunsKeywords,
    BudgetKeywords,
    SharingKeywords,
    RunKeywords,
    total=False,
):
    among: Among
    failures: Wanted
    classes: bool
    simulations: int
    seed: int
    seeds: str | Path | None
    method: Method


class ResimulateKeywords(
    ModelsKeywords,
    ControllerRunsKeywords,
    BudgetKeywords,
    SharingKeywords,
    RunKeywords,
    total=False,
):
    among: Among
    kinds: Iterable[str]
    road: str | None
