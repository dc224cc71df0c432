"""The options of each question."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings.groups import (
    OBJECTIVES,
    Budget,
    Definitions,
    Models,
    Prevention,
    Run,
    SearchPlace,
    SeveralSets,
    Sharing,
    Solver,
    Workers,
    effort_for,
    folder_for,
    one_set,
    pictures_of,
)
from roadproof.frontends.settings.option import option
from roadproof.frontends.settings.readers import named, seconds, text_or_none, whole

if TYPE_CHECKING:
    from collections.abc import Mapping

    from roadproof.engines.search.question import Objective
    from roadproof.frontends.api.checking import Kernel
    from roadproof.frontends.api.definitions import What
    from roadproof.frontends.api.phrases import Term
    from roadproof.frontends.settings.value_types import Assumed, Expected, ProofEngine, RoadLike, Vehicles
    from roadproof.library.bind import Number


@dataclass(frozen=True, kw_only=True)
class Compare(SeveralSets, SearchPlace, Solver, Budget, Workers):
    """Options of ``compare``."""

    out: str | Path | None = folder_for("certificates and drive files", command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Witness(SeveralSets, SearchPlace, Solver, Prevention, Budget, Sharing, Run):
    """Options of ``witness``."""

    objective: Objective = option(
        "smooth",
        "--objective KIND",
        help="any, smooth (default), margin, mild, severe or short",
        choices=OBJECTIVES,
    )
    count: int = option(
        1, "--count K", help="find K clearly different drives (default: 1)", read=whole(1), least=1
    )
    out: str | Path | None = folder_for("drive files, CSV and pictures")
    pictures: bool = pictures_of()


@dataclass(frozen=True, kw_only=True)
class Explore(SeveralSets, SearchPlace, Solver, Prevention, Budget, Sharing, Run):
    """Options of ``explore``."""

    vary: Mapping[str, tuple[Number, Number]] | None = option(
        None,
        "--vary NAME=LOW:HIGH",
        help="vary a parameter, or a limit such as POV.a_lon.min; may be given twice",
        gather=list,
    )
    steps: int | None = option(
        None, "--steps K", help="number of values (default: 11; 6 for each of two)", read=whole(2)
    )
    least: Term | None = option(
        None, "--least TERM", help="find the least value of a term", read=text_or_none
    )
    greatest: Term | None = option(
        None, "--greatest TERM", help="find the greatest value of a term", read=text_or_none
    )
    when: What | None = option(
        None, "--when FORMULA", help="measure the term when FORMULA holds, not at time 0"
    )
    precision: Number | None = option(
        None, "--precision P", help="width of a bracket in SI units (default: range/60; 0.1 for a term)"
    )
    effort: float = effort_for("a question", 6.0)
    out: str | Path | None = folder_for("drives, certificates, JSON, pictures")
    pictures: bool = pictures_of(command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Prove(Definitions, Models, Budget, Run):
    """Options of ``prove``."""

    sets: tuple[str, ...] = one_set()
    file: Path | None = option(
        None, "--claims FILE", help="read claims from a file, one a paragraph", read=Path, keyword=False
    )
    declared: bool = option(
        False, "--declared", help="use the declared values of all other parameters, not all values"
    )
    expect: Expected = option(
        "PROVED",
        "--expect",
        help="verdict that you expect of your own claims (default: PROVED)",
        choices=("PROVED", "REFUTED"),
        rare=True,
    )
    assume: Assumed | None = option(
        None,
        "--assume",
        help="assume that vehicles move: places and speeds are continuous",
        choices=("motion",),
    )
    vehicles: Vehicles = option(
        None,
        "--vehicle [NAME=]MODEL",
        help="with --assume motion, smt or milp: limits of a model, for all vehicles or for NAME",
        group="search",
        read=named(""),
        gather=dict,
    )
    engine: ProofEngine = option(
        "dense",
        "--engine",
        help="dense: for all time (default); smt, milp: drives up to a horizon",
        group="search",
        choices=("dense", "smt", "milp"),
    )
    road: RoadLike | None = option(
        None, "--road R", help="with smt, milp: reference road, .toml or .xodr file", group="search"
    )
    horizon: Number = option(
        Fraction(6),
        "--horizon S",
        help="with smt, milp: seconds to search (default: 6)",
        group="search",
        read=seconds,
    )
    dt: Number | None = option(
        None,
        "--dt S",
        help="with smt, milp: seconds between samples (default: the coarsest that fits)",
        group="search",
        read=seconds,
        rare=True,
    )
    drive: bool = option(
        True, "--no-drive", help="search no drive that refutes a claim", group="search", rare=True
    )
    kernel: Kernel | None = option(
        None, "--kernel", help="also check each proof with the kernel of Coq, by coqc", choices=("coq",)
    )
    effort: float = effort_for("a claim", 60.0)
    out: str | Path | None = folder_for("certificates and an index")
    verbose: bool = option(
        False,
        "--verbose",
        help="print a line for every claim of the list",
        group="output",
        keyword=False,
        rare=True,
    )
