"""Keyword arguments of each question; made by ``roadproof.frontends.settings.keywords_file``."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from roadproof.frontends.settings.value_types import RoadLike
    from roadproof.library.bind import Number


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
