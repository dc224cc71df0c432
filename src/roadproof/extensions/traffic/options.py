"""The options of commands that have no function of their own in Python."""

from __future__ import annotations

from pathlib import Path

from roadproof.frontends.settings.groups import Workers, folder_for, map_road, strict_reading
from roadproof.runtime.records import dataclass


@dataclass(frozen=True, kw_only=True)
class Convert(Workers):
    """Options of ``roadproof convert``."""

    out: str | Path | None = folder_for("the data set", required=True)
    strict: bool = strict_reading()
    road: str | None = map_road()
