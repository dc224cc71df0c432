"""The options of ``road``."""

from __future__ import annotations

from pathlib import Path

from roadproof.frontends.settings.groups import Answered, strict_reading
from roadproof.frontends.settings.option import output
from roadproof.runtime.records import dataclass


@dataclass(frozen=True, kw_only=True)
class RoadOptions(Answered):
    """Options of ``roadproof road``."""

    out: str | Path | None = output(None, "--out FILE", "draw the road to FILE, .svg or .png", read=Path)
    strict: bool = strict_reading()
