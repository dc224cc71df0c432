"""The options of the commands for pages and the atlas."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings import groups, readers
from roadproof.frontends.settings.option import option, output
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from roadproof.frontends.api.checking import Solver
    from roadproof.frontends.api.definitions import Among
    from roadproof.runtime.pool import Progress


@dataclass(frozen=True, kw_only=True)
class AtlasSettings(groups.Readings, groups.Run):
    """The options of ``atlas``."""

    among: Among = groups.scenarios_such_as("1-8", keyword=True)
    topics: Sequence[str] = option(
        (),
        "--topics NAME,…",
        "only these: proofs, drives, overlaps, implications, redundancy, gaps, classes or plates "
        "(default: all)",
        read=readers.items_of("topics", ", such as drives,overlaps"),
    )
    out: str | Path | None = groups.folder_for("pages and evidence", required=True)


@dataclass(frozen=True, kw_only=True)
class PageSettings(groups.Workers):
    """The options of ``report``, called ``page`` in Python."""

    title: str | None = output(None, "--title TEXT", "title of the page")
    solver: Solver = groups.checker_of("solver that checks certificates")
    specs: Iterable[str | Path] = groups.specifications_of("the results")
    progress: Progress | None = option(None)
