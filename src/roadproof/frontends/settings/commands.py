"""The options of commands that have no function of their own in Python."""

from __future__ import annotations

from roadproof.frontends.settings.groups import Answered, Readings
from roadproof.frontends.settings.option import option, output
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
class Extensions(Answered):
    """Options of ``roadproof extensions``."""
