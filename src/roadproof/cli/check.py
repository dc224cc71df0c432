"""``roadproof check``: certificates and drive files, checked again without what made them."""

import argparse
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from roadproof.cli.numbers import add_effort_options, read_effort
from roadproof.cli.options import add_json_option, write_json
from roadproof.cli.progress import clear
from roadproof.cli.working import add_working_options, work_in_order
from roadproof.effort import Effort, Late
from roadproof.errors import InputError, RoadproofError
from roadproof.verdict import ExitCode

SUMMARY = "check certificates and drive files again, without the programs that made them"
SCHEMA = "roadproof/check/1"

_EXAMPLES = """\
examples:
  roadproof check proofs/                          every certificate of a folder
  roadproof check proofs/ --solver cvc5            ask another solver
  roadproof check drives/scenario-04-base.json     judge a drive again, exactly

A certificate is accepted when the claim, read with the library at hand, and the certificate's instances
give the very query that is stored, and the solver answers unsat to it. A drive file is accepted when its
formula holds on its drive, judged exactly in dense time. Exit code 10 where something is rejected, else
3 where a file is neither. Where the index of a folder names specification files in it, such as classes.spec,
these are put on top of the library, unless they would change what is there.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("paths", metavar="FILE|DIR", nargs="+", type=Path)
    parser.add_argument("--solver", choices=("z3", "cvc5"), default="z3", help="who is asked (default: z3)")
    add_effort_options(parser, each="a query")
    parser.add_argument(
        "--spec",
        dest="specs",
        metavar="FILE",
        action="append",
        type=Path,
        default=[],
        help="a specification file that the claims were made with; may be repeated",
    )
    add_working_options(parser)
    add_json_option(parser)


@dataclass(frozen=True)
class Job:
    path: Path
    specs: tuple[Path, ...]
    solver: str
    effort: Effort


@dataclass(frozen=True)
class Finding:
    """``reason`` says why a file is rejected, and is empty where it is accepted."""

    path: Path
    what: str
    reason: str

    @property
    def accepted(self) -> bool:
        return not self.reason


def run(args: argparse.Namespace) -> int:
    given, effort = tuple(args.specs), read_effort(args)
    beside = {folder: names for path in args.paths for folder, names in _specifications(path, given).items()}
    jobs = [Job(path, (*given, *_around(path, beside)), args.solver, effort) for path in _files(args.paths)]
    if args.json != "-":
        for name in dict.fromkeys(name for names in beside.values() for name in names):
            print(f"read with {name}", flush=True)
    findings: list[Finding] = []
    for finding in work_in_order(examine, jobs, args.jobs, "files", undecided):
        findings.append(finding)
        if not finding.accepted and args.json != "-":
            clear()
            said = "undecided" if finding.what == "undecided" else "rejected "
            print(f"{said} {finding.path}: {finding.reason}", flush=True)
    accepted = sum(finding.accepted for finding in findings)
    if args.json != "-":
        print(f"{accepted} of {len(findings)} accepted by {args.solver} and the exact judge")
    if args.json:
        entries = [
            {"file": str(x.path), "kind": x.what, "accepted": x.accepted, "reason": x.reason}
            for x in findings
        ]
        write_json({"schema": SCHEMA, "solver": args.solver, "findings": entries}, args.json)
    if accepted == len(findings):
        return ExitCode.AS_EXPECTED
    rejected = any(not x.accepted and x.what in ("certificate", "drive") for x in findings)
    if rejected:
        return ExitCode.UNEXPECTED
    damaged = any(x.what in ("unknown", "damaged") for x in findings)
    return ExitCode.BAD_INPUT if damaged else ExitCode.UNKNOWN


def _files(paths: Sequence[Path]) -> list[Path]:
    """The files named, and the JSON files of the folders named, but for their index."""
    files: list[Path] = []
    for path in paths:
        if path.is_dir():
            inside = sorted(p for p in path.rglob("*.json") if p.name != "index.json")
            if not inside:
                raise InputError(
                    f"{path} holds no .json file: name a folder with certificates or drive files"
                )
            files += inside
        elif path.exists():
            files.append(path)
        else:
            raise InputError(f"{path} does not exist")
    return files


def _specifications(path: Path, given: Sequence[Path]) -> dict[Path, tuple[Path, ...]]:
    """The specification files that the indices in a folder name, by the folder that they lie in.

    Raises ``InputError`` where one would change the library: evidence must not redefine what it is about.
    """
    found: dict[Path, tuple[Path, ...]] = {}
    for index in sorted(path.rglob("index.json")) if path.is_dir() else ():
        try:
            data = json.loads(index.read_text("utf-8"))
        except (OSError, ValueError, RecursionError):
            continue
        names = data.get("specs") if isinstance(data, dict) else None
        if isinstance(names, list) and names:
            found[index.parent] = tuple(index.parent / Path(str(name)).name for name in names)
    for names_there in found.values():
        _check_adds_only(names_there, given)
    return found


def _check_adds_only(names: Sequence[Path], given: Sequence[Path]) -> None:
    from roadproof.spec.library import load_library

    below, above = load_library(given), load_library((*given, *names))
    changed: list[str] = []
    for kind in ("parameters", "options", "definitions", "sets"):
        after: Mapping[str, object] = getattr(above, kind)
        changed += [name for name, meaning in getattr(below, kind).items() if after.get(name) != meaning]
    # One more variant replaces definitions under a value that may be the default one.
    for choice, definitions in above.variants.items():
        if definitions != below.variants.get(choice):
            changed += [definition.name for definition in definitions]
    if changed:
        raise InputError(
            f"{', '.join(map(str, names))}: changes '{changed[0]}' of the library, so what the evidence says "
            "is not what it seems; name the file with --spec if that is meant"
        )


def _around(path: Path, beside: Mapping[Path, tuple[Path, ...]]) -> tuple[Path, ...]:
    """The specification files of the nearest folder around ``path`` that has some."""
    return next((beside[folder] for folder in path.parents if folder in beside), ())


def undecided(job: Job, reason: str) -> Finding:
    """The finding on a file that nothing is known of."""
    return Finding(job.path, "undecided", reason)


def examine(job: Job) -> Finding:
    """Check one file by what its schema says that it is."""
    from roadproof.evidence import certificate, witness

    try:
        schema = _schema(job.path)
        if schema == certificate.SCHEMA:
            return Finding(job.path, "certificate", _examine_certificate(job))
        if schema == witness.SCHEMA:
            return Finding(job.path, "drive", _examine_drive(job))
        known = f"{certificate.SCHEMA} or {witness.SCHEMA}"
        return Finding(job.path, "unknown", f"its schema is {schema!r}, but must be {known}")
    except Late as late:
        return Finding(job.path, "undecided", str(late))
    except RoadproofError as error:
        return Finding(job.path, "damaged", str(error))


def _schema(path: Path) -> object:
    try:
        data = json.loads(path.read_text("utf-8"))
    except OSError as error:
        raise InputError(f"it cannot be read: {error.strerror or error}") from None
    except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
        raise InputError(f"it is no JSON text: {error}") from None
    return data.get("schema") if isinstance(data, dict) else None


def _examine_certificate(job: Job) -> str:
    from roadproof.evidence.certificate import read_certificate, refusal
    from roadproof.solve.smt import ask
    from roadproof.spec.library import load_library

    def answer(script: str) -> str:
        return ask(script, job.solver, job.effort.meter())

    return refusal(read_certificate(job.path), load_library(job.specs), answer) or ""


def _examine_drive(job: Job) -> str:
    from roadproof.evidence.witness import judge_file, load_drive
    from roadproof.spec.library import load_library

    return judge_file(load_drive(job.path), load_library(job.specs)).reason
