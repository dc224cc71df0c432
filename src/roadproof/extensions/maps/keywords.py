"""Keyword arguments of each question; made by ``roadproof.frontends.settings.keywords_file``."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from pathlib import Path


class RoadKeywords(TypedDict, total=False):
    out: str | Path | None
    strict: bool
