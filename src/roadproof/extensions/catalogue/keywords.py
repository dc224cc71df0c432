"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

from roadproof.frontends.settings.keywords import BudgetKeywords, ModelsKeywords, RunKeywords

if TYPE_CHECKING:
    from collections.abc import Iterable

    from roadproof.extensions.catalogue.catalogue_data import FixedOrAny
    from roadproof.frontends.api.definitions import Among


class PreventionKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None


class CatalogueKeywords(ModelsKeywords, BudgetKeywords, RunKeywords, PreventionKeywords, total=False):
    among: Among
    classes: bool
    gaps: bool
    explore: bool
    roles: FixedOrAny
    lanes: FixedOrAny
    start: FixedOrAny
    strict: bool
    near: float
    drivers: Iterable[str] | None
