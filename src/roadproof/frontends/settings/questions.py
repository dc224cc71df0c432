"""The options of each question."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import Settings, option, output, search
from roadproof.frontends.settings.readers import file_names, named, seconds, text_or_none, whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from roadproof.evidence.claim import Objective
    from roadproof.frontends.api.checking import Kernel, Solver
    from roadproof.frontends.api.definitions import What
    from roadproof.frontends.api.phrases import Term
    from roadproof.frontends.settings.value_types import Assumed, Expected, ProofEngine, RoadLike, Vehicles
    from roadproof.library.bind import Number
    from roadproof.runtime.pool import Progress
    from roadproof.world.signals import Kind


@dataclass(frozen=True, kw_only=True)
class Compare(groups.SeveralSets, groups.SearchPlace, groups.Method, groups.Budget, groups.Run):
    """Options of ``compare``."""

    out: str | Path | None = groups.folder_for("certificates and drive files")


@dataclass(frozen=True, kw_only=True)
class Witness(groups.DriveSearch, groups.Reported):
    """Options of ``witness``."""

    objective: Objective = option(
        "smooth",
        "--objective KIND",
        "any, smooth (default), margin, mild, severe or short",
        choices=groups.OBJECTIVES,
    )
    count: int = option(
        1, "--count K", "find K clearly different drives (default: 1)", read=whole(1), least=1
    )
    verbose: bool = output(False, "--verbose", "print sizes and seconds by stage", keyword=False, rare=True)
    out: str | Path | None = groups.folder_for("drive files, CSV and pictures")
    pictures: bool = groups.pictures_of()
    animate: str | Iterable[str] = output(
        (), "--animate FORMAT", "with --out: write animations: svg, gif or mp4", gather=list
    )


@dataclass(frozen=True, kw_only=True)
class Motion(Settings):
    """Options of ``motion``, which exists in Python only."""

    length: Number = option(Fraction(9, 2))
    width: Number = option(Fraction(9, 5))
    kind: Kind | None = option(None)


@dataclass(frozen=True, kw_only=True)
class Explore(groups.DriveSearch):
    """Options of ``explore``."""

    vary: Mapping[str, tuple[Number, Number]] | None = option(
        None,
        "--vary NAME=LOW:HIGH",
        "vary a parameter, or a limit such as POV.a_lon.min; may be given twice",
        gather=list,
    )
    steps: int | None = option(
        None, "--steps K", "number of values (default: 11; 6 for each of two)", read=whole(2)
    )
    least: Term | None = option(None, "--least TERM", "find the least value of a term", read=text_or_none)
    greatest: Term | None = option(
        None, "--greatest TERM", "find the greatest value of a term", read=text_or_none
    )
    when: What | None = option(None, "--when FORMULA", "measure the term when FORMULA holds, not at time 0")
    precision: Number | None = option(
        None, "--precision P", "width of a bracket in SI units (default: range/60; 0.1 for a term)"
    )
    effort: float = groups.effort_for("a question", 6.0)
    out: str | Path | None = groups.folder_for("drives, certificates, JSON, pictures")
    pictures: bool = groups.pictures_of(command_line_only=True)


@dataclass(frozen=True, kw_only=True)
class Prove(groups.Definitions, groups.Models, groups.Budget, groups.Run, groups.Reported):
    """Options of ``prove``."""

    sets: tuple[str, ...] = groups.one_set()
    file: Path | None = option(
        None, "--claims FILE", "read claims from a file, one a paragraph", read=Path, keyword=False
    )
    declared: bool = option(
        False, "--declared", "use the declared values of all other parameters, not all values"
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
    )
    engine: ProofEngine = search(
        "dense",
        "--engine",
        "dense: for all time (default); smt, milp: drives up to a horizon",
        choices=("dense", "smt", "milp"),
    )
    road: RoadLike | None = search(None, "--road R", "with smt, milp: reference road, .toml file or map")
    horizon: Number = search(
        Fraction(6), "--horizon S", "with smt, milp: seconds to search (default: 6)", read=seconds
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


@dataclass(frozen=True, kw_only=True)
class Check(groups.Answered, groups.Budget, groups.Workers, groups.Reported):
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


@dataclass(frozen=True, kw_only=True)
class Assurance(groups.Answered, groups.Budget, groups.Workers):
    """Options of ``assurance``."""

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
class Page(groups.Workers):
    """Options of ``report``, which is ``page`` in Python."""

    title: str | None = output(None, "--title TEXT", "title of the page")
    solver: Solver = groups.checker_of("solver that checks certificates")
    specs: Iterable[str | Path] = groups.specifications_of("the results")
    progress: Progress | None = option(None)


@dataclass(frozen=True, kw_only=True)
class Requirements(groups.Answered, groups.Workers, groups.Reported):
    """Options of ``trace``, which is ``requirements`` in Python."""

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
class Bundle(groups.Answered, groups.Workers):
    """Options of ``bundle``."""

    specs: Iterable[str | Path] = groups.specifications_of("the evidence")
    wheel: str | Path | None = option(
        None, "--wheel FILE", "the wheel of this version (default: made by pip)", read=Path
    )
    wheels: bool = option(False, "--wheels", "put all packages inside, so that the check needs no network")
    sign: str | Path | None = option(
        None, "--sign KEY", "sign with an Ed25519 key in PEM, into FILE.sig", read=Path
    )
    progress: Progress | None = option(None)
