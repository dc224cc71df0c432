"""The options that write the answers of other commands for build servers."""

from __future__ import annotations

from pathlib import Path

from roadproof.frontends.settings.option import Settings, output
from roadproof.runtime.records import dataclass


@dataclass(frozen=True, kw_only=True)
class BuildResultOptions(Settings):
    """The options of a command whose results pass or fail, for build servers."""

    junit: Path | None = output(
        None, "--junit FILE", "write JUnit XML for a build server", read=Path, keyword=False, rare=True
    )
    sarif: Path | None = output(
        None,
        "--sarif FILE",
        "write what did not pass as SARIF, with file, line and column",
        read=Path,
        keyword=False,
        rare=True,
    )
