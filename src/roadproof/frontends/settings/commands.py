"""The options of commands that have no function of their own in Python."""

from __future__ import annotations

from pathlib import Path

from roadproof.frontends.settings.groups import (
    Answered,
    Readings,
    Workers,
    folder_for,
    map_road,
    strict_reading,
)
from roadproof.frontends.settings.option import Settings, option, output
from roadproof.runtime.records import dataclass


@dataclass(frozen=True, kw_only=True)
class List(Readings, Answered):
    """Options of ``roadproof list``."""


@dataclass(frozen=True, kw_only=True)
class Show(Readings):
    """Options of ``roadproof show``."""

    expand: bool = option(False, "--expand", "write every definition out, as one formula")
    format: str = output("text", "--format", "default: text", choices=("text", "latex", "json"))


@dataclass(frozen=True, kw_only=True)
class Road(Answered):
    """Options of ``roadproof road``."""

    out: str | Path | None = output(None, "--out FILE", "draw the road to FILE, .svg or .png", read=Path)
    strict: bool = strict_reading()


@dataclass(frozen=True, kw_only=True)
class Convert(Workers):
    """Options of ``roadproof convert``."""

    out: str | Path | None = folder_for("the data set", required=True)
    strict: bool = strict_reading()
    road: str | None = map_road()


@dataclass(frozen=True, kw_only=True)
class Studio(Settings):
    """Options of ``roadproof studio``."""

    port: int | None = option(None, "--port N", "default: 8642, or any that is free", read=int)
    browser: bool = option(True, "--no-browser", "print the address, and open nothing")
