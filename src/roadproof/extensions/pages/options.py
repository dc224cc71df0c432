"""The options of commands without a Python function."""

from __future__ import annotations

from roadproof.frontends.settings.option import Settings, option
from roadproof.runtime.records import dataclass


@dataclass(frozen=True, kw_only=True)
class Studio(Settings):
    """The options of ``roadproof studio``."""

    port: int | None = option(None, "--port N", "default: 8642, or any that is free", read=int)
    browser: bool = option(True, "--no-browser", "print the address, and open nothing")
