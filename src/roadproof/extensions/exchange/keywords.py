"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

from roadproof.frontends.settings.keywords import SearchPlaceKeywords

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from roadproof.extensions.encoding.kinds import Drives
    from roadproof.frontends.settings.value_types import RoadLike
    from roadproof.library.bind import Number


class ExportKeywords(TypedDict, total=False):
    rate: int
    specs: Iterable[str | Path]


class CompileKeywords(SearchPlaceKeywords, total=False):
    drives: Drives
    memory: int
    name: str


class OnlineMonitorKeywords(TypedDict, total=False):
    dt: Number
    road: RoadLike | None
    lanes: Mapping[str, str] | None
    strict: bool
