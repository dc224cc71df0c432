"""The options of each question."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import Settings, extensible, option, output, search
from roadproof.frontends.settings.readers import named, seconds, whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable

    from roadproof.evidence.claim import Objective
    from roadproof.frontends.api.checking import Kernel, Solver
    from roadproof.frontends.settings.value_types import Assumed, Expected, ProofEngine, RoadLike, Vehicles
    from roadproof.library.bind import Number
    from roadproof.runtime.pool import Progress
    from roadproof.world.signals import Kind


@extensible("compare")
@dataclass(frozen=True, kw_only=True)
class CompareSettings(
    groups.SeveralSets, groups.SearchPlace, groups.Method, groups.BudgetSettings, groups.Run
):
    """Options of ``compare``."""

    out: str | Path | None = groups.folder_for("certificates and drive files")


@extensible("witness")
@dataclass(frozen=True, kw_only=True)
class Witness(groups.DriveSearch):
    """Options of ``witness``."""

    objective: Objective = option(
        "typical",
        "--objective KIND",
        "typical (default), any, smooth, margin, mild, severe or short",
        choices=groups.OBJECTIVES,
        rare=True,
    )
    count: int = option(
        1, "--count K", "find K clearly different drives (default: 1)", read=whole(1), least=1
    )
    verbose: bool = output(False, "--verbose", "print sizes and seconds by stage", keyword=False, rare=True)
    out: str | Path | None = groups.folder_for("drive files, CSV and pictures")
    pictures: bool = groups.pictures_of()
    animate: str | Iterable[str] = output(
        (), "--animate FORMAT", "with --out: write animations: svg, gif or mp4", gather=list, rare=True
    )


@dataclass(frozen=True, kw_only=True)
class MotionSettings(Settings):
    """Options of ``motion``, which exists in Python only."""

    length: Number = option(Fraction(9, 2))
    width: Number = option(Fraction(9, 5))
    kind: Kind | None = option(None)


@extensible("prove")
@dataclass(frozen=True, kw_only=True)
class Prove(groups.DefinitionsSettings, groups.Models, groups.BudgetSettings, groups.Run):
    """Options of ``prove``."""

    sets: tuple[str, ...] = groups.one_set()
    file: Path | None = option(
        None, "--claims FILE", "read claims from a file, one a paragraph", read=Path, keyword=False, rare=True
    )
    declared: bool = option(
        False, "--declared", "use the declared values of all other parameters, not all values", rare=True
    )
    expect: Expected = option(
        "PROVED",
        "--expect",
        "verdict that you expect of your own claims (default: PROVED)",
        choices=("PROVED", "REFUTED"),
        rare=True,
    )
    assume: Assumed | None = option(
        None, "--assume", "assume that vehicles move: places and speeds are continuous", choices=("motion",)
    )
    vehicles: Vehicles = search(
        None,
        "--vehicle [NAME=]MODEL",
        "with --assume motion, smt or milp: limits of a model, for all vehicles or for NAME",
        read=named(""),
        gather=dict,
        rare=True,
    )
    engine: ProofEngine = search(
        "dense",
        "--engine",
        "dense: for all time (default); smt, milp: drives up to a horizon",
        choices=("dense", "smt", "milp"),
    )
    road: RoadLike | None = search(None, "--road R", "with smt, milp: reference road, .toml file or map")
    horizon: Number = search(
        Fraction(6), "--horizon S", "with smt, milp: seconds to search (default: 6)", read=seconds, rare=True
    )
    dt: Number | None = search(
        None,
        "--dt S",
        "with smt, milp: seconds between samples (default: the coarsest that fits)",
        read=seconds,
        rare=True,
    )
    drive: bool = search(True, "--no-drive", "search no drive that refutes a claim", rare=True)
    strict: bool = groups.strict_reading(rare=True)
    kernel: Kernel | None = option(
        None,
        "--kernel",
        "also check each proof with Coq, or with the program extracted from it",
        choices=("coq", "extracted"),
    )
    effort: float = groups.effort_for("a claim", 60.0)
    out: str | Path | None = groups.folder_for("certificates and an index")
    verbose: bool = output(
        False, "--verbose", "print a line for every claim of the list", keyword=False, rare=True
    )


@extensible("check")
@dataclass(frozen=True, kw_only=True)
class Check(groups.Answered, groups.BudgetSettings, groups.Workers):
    """Options of ``check``."""

    solver: Solver = groups.checker_of("solver that checks certificates")
    specs: Iterable[str | Path] = groups.specifications_of("the claims")
    kernel: Kernel | None = option(
        None,
        "--kernel",
        "check certificates and drives with Coq, or the program extracted from it, instead of a solver",
        choices=("coq", "extracted"),
    )
    strict: bool = option(
        False, "--strict", "exit with 20 if an answer has no evidence (UNKNOWN, NONE-WITHIN)"
    )
    effort: float = groups.effort_for("a query", 60.0)
    write: Path | None = output(
        None, "--write DIR", "only write the files for the kernel, with --kernel", read=Path, keyword=False
    )
    progress: Progress | None = option(None)
