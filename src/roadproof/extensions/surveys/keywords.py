"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

from roadproof.frontends.settings.keywords import DriveSearchKeywords, SurveyKeywords

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from roadproof.frontends.api.definitions import What
    from roadproof.frontends.api.phrases import Term
    from roadproof.frontends.settings.value_types import RoadLike
    from roadproof.library.bind import Number


class AskKeywords(SurveyKeywords, total=False):
    pass


class RedundancyKeywords(SurveyKeywords, total=False):
    whole: bool


class PreventionKeywords(TypedDict, total=False):
    preventable: str | None
    unpreventable: str | None


class PreventionOfDrivesKeywords(PreventionKeywords, total=False):
    pass


class CoverageKeywords(SurveyKeywords, PreventionOfDrivesKeywords, total=False):
    wider: str | None
    roads: Iterable[RoadLike] | None
    needed: bool
    on: str | Path | None
    strict: bool


class ClassifyKeywords(SurveyKeywords, PreventionKeywords, total=False):
    on: str | Path | None
    strict: bool
    shares: bool


class ExploreKeywords(DriveSearchKeywords, PreventionKeywords, total=False):
    vary: Mapping[str, tuple[Number, Number]] | None
    steps: int | None
    least: Term | None
    greatest: Term | None
    when: What | None
    precision: Number | None
