"""The options of the commands for requirements, assurance cases and bundles."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.extensions.assurance.options import BuildResultOptions
from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import option, output
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable

    from roadproof.frontends.api.checking import Solver
    from roadproof.runtime.pool import Progress


def file_names(text: str) -> tuple[str, ...]:
    """Names of files or folders with commas between them."""
    return tuple(x for x in text.split(",") if x)


@dataclass(frozen=True, kw_only=True)
class Assurance(groups.Answered, groups.BudgetSettings, groups.Workers):
    """The options of ``assurance``."""

    solver: Solver = groups.checker_of("solver that checks certificates")
    specs: Iterable[str | Path] = groups.specifications_of("the evidence")
    strict: bool = option(
        False, "--strict", "leave undecided what expects a verdict without evidence (NONE-WITHIN)"
    )
    effort: float = groups.effort_for("a query", 60.0)
    svg: str | Path | None = output(None, "--svg FILE", "draw the argument to FILE", read=Path)
    page: str | Path | None = output(
        None, "--page FILE", "write the argument as a page, NAME.html", read=Path
    )
    template: str | None = output(
        None, "--template NAME", "write a case instead (catalogue-coverage)", keyword=False
    )
    evidence: tuple[str, ...] = output(
        (), "--evidence DIR,…", "with --template: folders of evidence", keyword=False, read=file_names
    )
    out: Path | None = output(
        None, "--out FILE", "with --template: the case, NAME.toml", read=Path, keyword=False
    )
    progress: Progress | None = option(None)


@dataclass(frozen=True, kw_only=True)
class Requirements(groups.Answered, groups.Workers, BuildResultOptions):
    """The options of ``trace``, called ``requirements`` in Python."""

    accept: bool = option(
        False, "--accept", "write the lock file: what each link rests on now is as it should be"
    )
    solver: Solver = groups.checker_of("solver that checks certificates")
    specs: Iterable[str | Path] = groups.specifications_of("requirements and evidence")
    out: str | Path | None = groups.folder_for("a page, CSV, Markdown and JSON", command_line_only=True)
    reqif: Path | None = output(
        None, "--reqif FILE", "write the requirements with their states as ReqIF", read=Path, keyword=False
    )
    progress: Progress | None = option(None)


@dataclass(frozen=True, kw_only=True)
class BundleSettings(groups.Answered, groups.Workers):
    """The options of ``bundle``."""

    specs: Iterable[str | Path] = groups.specifications_of("the evidence")
    wheel: str | Path | None = option(
        None, "--wheel FILE", "the wheel of this version (default: made by pip)", read=Path
    )
    wheels: bool = option(False, "--wheels", "put all packages inside, so that the check needs no network")
    sign: str | Path | None = option(
        None, "--sign KEY", "sign with an Ed25519 key in PEM, into FILE.sig", read=Path
    )
    progress: Progress | None = option(None)
