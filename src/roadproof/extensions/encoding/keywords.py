"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from roadproof.frontends.settings.keywords import SearchPlaceKeywords

if TYPE_CHECKING:
    from roadproof.extensions.encoding.kinds import Drives


class EncodeKeywords(SearchPlaceKeywords, total=False):
    drives: Drives


class ConflictKeywords(SearchPlaceKeywords, total=False):
    pass
