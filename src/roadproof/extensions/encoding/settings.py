"""The options of encodings of searches."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from roadproof.extensions.encoding.kinds import DRIVES
from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import search
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.extensions.encoding.kinds import Drives


def drives_to_encode() -> Any:
    """``drives``: those that solve a problem."""
    text = "drives that solve the problem: natural (default) as a search tries first, all within its limits, "
    text += "or outer, a relaxation that shows there is none where it has no solution"
    return search("natural", "--drives KIND", text, choices=DRIVES)


@dataclass(frozen=True, kw_only=True)
class Encode(groups.Values, groups.SearchPlace):
    """Options of ``encode``."""

    sets: tuple[str, ...] = groups.one_set("base")
    drives: Drives = drives_to_encode()


@dataclass(frozen=True, kw_only=True)
class Conflict(groups.Values, groups.SearchPlace):
    """Options of ``conflict``, which exists in Python only."""

    sets: tuple[str, ...] = groups.one_set("base")
