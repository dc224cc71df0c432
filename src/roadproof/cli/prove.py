"""``roadproof prove``: claims over dense time, for all horizons and parameter values, with certificates."""

import argparse
import re
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.options import (
    add_json_option,
    add_specification_options,
    chosen_options,
    load_library_of,
    read_seconds,
    write_json,
    write_text,
)
from roadproof.cli.working import tell, work_in_order
from roadproof.errors import RoadproofError, UsageError
from roadproof.files import make_folder
from roadproof.verdict import Verdict, exit_code

if TYPE_CHECKING:
    from roadproof.prove.countermodel import Countermodel
    from roadproof.prove.properties import Task
    from roadproof.prove.prover import Result

SUMMARY = "prove claims for all time, or refute them; without a claim, the template properties"
SCHEMA = "roadproof/verdicts/1"
DRIVE_SECONDS = 5.0
_PROPERTY = re.compile(r"[A-Z]\d+")

_EXAMPLES = """\
examples:
  roadproof prove                                     all template properties and negative controls
  roadproof prove P1 P4 --set base                    some of them
  roadproof prove 'scenario_8(SV,POV,L) -> F danger(SV,POV)' --set ext
  roadproof prove 'scenario_4(SV,POV,L) -> scenario_4@ext(SV,POV,L)'
  roadproof prove 'given A, B: vehicle: danger(A,B) -> danger(B,A)' --out proofs
  roadproof prove --claims mine.txt --json -          one claim a paragraph
  roadproof prove 'dangerArises(SV,POV) -> F aheadOf(SV,POV)' --engine smt --horizon 6 --dt 1/5

A claim is about all traces, all roads, all vehicle sizes and all parameter values within their declared
bounds. PROVED comes with a certificate, which `roadproof check` accepts; REFUTED with a counterexample.
With --engine smt or milp a claim is about drives on one road, up to a horizon: PROVED-BOUNDED says which.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("claims", metavar="CLAIM", nargs="*", help="a formula, or a property such as P1")
    parser.add_argument("--claims", dest="file", type=Path, metavar="FILE", help="claims from a file")
    add_specification_options(parser, None)
    parser.add_argument(
        "--expect",
        choices=[str(Verdict.PROVED), str(Verdict.REFUTED)],
        default=str(Verdict.PROVED),
        help="verdict that is expected of your own claims (default: PROVED)",
    )
    parser.add_argument(
        "--timeout", type=float, default=60.0, metavar="S", help="seconds a claim (default: 60)"
    )
    parser.add_argument(
        "--engine",
        choices=("dense", "smt", "milp"),
        default="dense",
        help="dense: for all time (default); smt, milp: up to a horizon, with the motion of vehicles",
    )
    parser.add_argument("--horizon", metavar="S", default="6", help="with smt, milp: seconds (default: 6)")
    parser.add_argument(
        "--dt", metavar="S", default="3/5", help="with smt, milp: seconds a sample (default: 3/5)"
    )
    parser.add_argument("--road", metavar="R", help="with smt, milp: a reference road or a .toml file")
    parser.add_argument("--jobs", type=int, metavar="N", help="processes (default: one a core)")
    parser.add_argument(
        "--no-drive", action="store_true", help="do not look for a drive that refutes a claim"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates and an index")
    parser.add_argument("--verbose", action="store_true", help="a line for every claim of the list")
    add_json_option(parser)


@dataclass(frozen=True)
class Bounded:
    """How to look for a drive that refutes a claim, up to a horizon; ``horizon`` and ``dt`` in seconds."""

    engine: str
    horizon: Fraction
    dt: Fraction
    road: str | None


@dataclass(frozen=True)
class Job:
    """A task with all that a process needs to settle it."""

    task: "Task"
    specs: tuple[Path, ...]
    options: Mapping[str, str]
    timeout: float
    seek_drive: bool
    bounded: "Bounded | None" = None


@dataclass(frozen=True)
class Settled:
    """A task with its result; ``drive`` is a judged drive on which the claim is false."""

    task: "Task"
    result: "Result"
    drive: Mapping[str, Any] | None

    @property
    def verdict(self) -> Verdict:
        """A drive refutes also where no countermodel over points in time was found."""
        return Verdict.REFUTED if self.drive is not None else self.result.verdict


def run(args: argparse.Namespace) -> int:
    begun = time.monotonic()
    jobs = _jobs(args)
    if args.out is not None:
        make_folder(args.out)
    own = not jobs[0].task.title
    settled: list[Settled] = []
    files: dict[str, str] = {}
    for number, answer in enumerate(work_in_order(settle, jobs, args.jobs), 1):
        settled.append(answer)
        if args.out is not None:
            files |= _write_evidence(answer, args.out)
        tell(f"{number} of {len(jobs)} claims", number == len(jobs))
        if args.json != "-" and (own or args.verbose):
            print(_details(answer) if own else _line(answer), flush=True)
    if args.out is not None:
        index = [_index_entry(s, files.get(s.task.name)) for s in settled]
        write_json({"schema": "roadproof/index/1", "claims": index}, str(args.out / "index.json"))
    if args.json != "-" and not own:
        print(_table(settled))
        print(f"{len(settled)} claims in {time.monotonic() - begun:.1f} s")
    if args.json:
        verdicts = [_as_json(s, files.get(s.task.name)) for s in settled]
        write_json({"schema": SCHEMA, "verdicts": verdicts}, args.json)
    return exit_code((s.verdict, s.task.expected) for s in settled)


# --- what is asked -------------------------------------------------------------------------------


def _jobs(args: argparse.Namespace) -> list[Job]:
    from roadproof.prove.properties import Task, choose, read_claims, template_properties
    from roadproof.spec.elaborate import read_claim

    if not args.timeout > 0 or (args.jobs is not None and args.jobs < 1):
        raise UsageError(f"timeout={args.timeout} and jobs={args.jobs} must be greater than 0")
    library = load_library_of(args)
    options = chosen_options(args)
    named = [claim for claim in args.claims if _PROPERTY.fullmatch(claim)]
    texts = [claim for claim in args.claims if claim not in named]
    texts += read_claims(args.file) if args.file is not None else []
    if named and texts:
        raise UsageError("ask for properties or for claims of your own, not for both at once")
    if texts:
        set_name = args.set_name or "base"
        specification = library.select(set_name, options)
        for text in texts:
            read_claim(specification, text)
        expected = Verdict(args.expect)
        tasks = [
            Task("claim", str(number) if len(texts) > 1 else "", "", None, set_name, text, expected)
            for number, text in enumerate(texts, 1)
        ]
    elif args.file is not None:
        raise UsageError(f"{args.file} holds no claim: write one a paragraph")
    else:
        library.select(args.set_name or "base", options)
        tasks = choose(template_properties(), named, args.set_name)
    bounded = None
    if args.engine != "dense":
        if not texts:
            raise UsageError(f"--engine {args.engine} is for claims of your own: the list is about all time")
        horizon, dt = read_seconds("--horizon", args.horizon), read_seconds("--dt", args.dt)
        bounded = Bounded(args.engine, horizon, dt, args.road)
    if not tasks:
        raise UsageError(f"none of {', '.join(named)} is stated for set={args.set_name}: leave out --set")
    seek_drive = not args.no_drive
    return [Job(task, tuple(args.specs), options, args.timeout, seek_drive, bounded) for task in tasks]


def settle(job: Job) -> Settled:
    """Prove or refute one claim; a refuted or undecided one also by a drive, where there is one."""
    if job.bounded is not None:
        return _settle_bounded(job, job.bounded)
    from roadproof.prove.prover import prove
    from roadproof.spec.library import load_library

    specification = load_library(job.specs).select(job.task.set_name, job.options)
    task = job.task
    label = task.id + (f"-{task.part}" if task.part else "")
    result = prove(specification, task.claim, job.timeout, label, task.scenario)
    drive = None
    if job.seek_drive and result.verdict in (Verdict.REFUTED, Verdict.UNKNOWN):
        drive = _refuting_drive(job)
    return Settled(task, result, drive)


def _settle_bounded(job: Job, bounded: Bounded) -> Settled:
    """Look for a drive that refutes the claim within bounds; where none is possible at all, prove it."""
    from roadproof.prove.prover import Result
    from roadproof.spec.bind import default_values
    from roadproof.spec.library import load_library
    from roadproof.witness.ask import Request
    from roadproof.witness.bounded import check_bounded
    from roadproof.witness.question import Means

    begun = time.monotonic()
    request = Request(
        job.task.claim,
        job.task.set_name,
        job.options,
        job.specs,
        default_values(load_library(job.specs)),
        bounded.road,
        horizon=bounded.horizon,
        dt=bounded.dt,
        means=Means("any", "smt" if bounded.engine == "smt" else "milp", time_limit=job.timeout),
    )
    found = check_bounded(request)
    if found.verdict is Verdict.PROVED:
        return settle(replace(job, bounded=None))
    expected = Verdict.PROVED_BOUNDED if job.task.expected is Verdict.PROVED else job.task.expected
    seconds = time.monotonic() - begun
    result = Result(job.task.claim, job.task.set_name, found.verdict, found.reason, seconds)
    return Settled(replace(job.task, expected=expected), result, found.drive)


def _refuting_drive(job: Job) -> Mapping[str, Any] | None:
    """A judged drive on a reference road on which the claim is false, at declared parameter values."""
    try:
        from roadproof.witness.refute import refuting_drive
    except ImportError:
        return None
    try:
        return refuting_drive(job.task.claim, job.task.set_name, job.options, job.specs, DRIVE_SECONDS)
    except RoadproofError:
        return None


# --- what is answered ----------------------------------------------------------------------------


def _line(settled: Settled) -> str:
    task = settled.task
    scenario = "" if task.scenario is None else f" {task.scenario}"
    mark = "" if settled.verdict is task.expected else f", expected {task.expected}"
    return f"{task.id}{scenario} {task.set_name}: {settled.verdict}{mark} ({settled.result.seconds:.2f} s)"


def _table(settled: Sequence[Settled]) -> str:
    """A line for each property and set; below it what was not as expected."""
    rows: list[str] = []
    for (name, title, set_name), group in groupby(
        settled, key=lambda s: (s.task.id, s.task.title, s.task.set_name)
    ):
        found = list(group)
        verdicts = sorted({str(s.verdict) for s in found})
        expected = str(found[0].task.expected)
        slowest = max(s.result.seconds for s in found)
        mark = "" if verdicts == [expected] else f"   expected {expected}"
        count = f"{len(found)} claim{'s' if len(found) > 1 else ''}"
        rows.append(
            f"{name:3} {set_name:5} {count:10} {', '.join(verdicts):8} {slowest:5.2f} s  {title}{mark}"
        )
        rows += [f"      {_line(s)} {s.result.reason}" for s in found if s.verdict is not s.task.expected]
    return "\n".join(rows)


def _details(settled: Settled) -> str:
    result, task = settled.result, settled.task
    lines = [f"{settled.verdict}  {' '.join(task.claim.split())}"]
    within = "up to a horizon" if settled.verdict is Verdict.PROVED_BOUNDED else "dense time, all horizons"
    lines.append(f"  set {task.set_name}, {within}, {result.seconds:.2f} s")
    if result.reason:
        lines.append(f"  {result.reason}")
    if result.certificate is not None:
        certificate = result.certificate
        count = sum(len(texts) for texts in certificate.instances.values())
        lines.append(
            f"  certificate: {count} instance{'s' if count != 1 else ''}, "
            f"{len(certificate.lemmas)} lemma{'s' if len(certificate.lemmas) != 1 else ''}"
            + (f", for all {', '.join(certificate.assumptions)}" if certificate.assumptions else "")
        )
    if settled.drive is not None:
        lines += _show_drive(settled.drive)
    elif result.countermodel is not None:
        lines += _show_countermodel(result.countermodel)
    return "\n".join(lines)


def _show_drive(drive: Mapping[str, Any]) -> list[str]:
    """Where each vehicle starts and how its speed goes; the whole drive is in the file of --out."""
    lanes = ", ".join(f"{k}={v}" for k, v in (drive.get("lanes") or {}).items()) or str(
        drive.get("lane") or ""
    )
    lines = [f"  false on this drive, judged exactly in dense time{f' (lane {lanes})' if lanes else ''}:"]
    for name, motion in drive["vehicles"].items():
        start = f"starts at s={_short(motion['s'])} m, d={_short(motion['d'])} m"
        speeds, across = [Fraction(motion["v_lon"])], Fraction(motion["d"])
        v_lat = Fraction(motion["v_lat"])
        for piece in motion["pieces"]:
            if piece["duration"] is not None:
                time, a_lat = Fraction(piece["duration"]), Fraction(piece["a_lat"])
                across += v_lat * time + a_lat * time**2 / 2
                v_lat += a_lat * time
                speeds.append(speeds[-1] + Fraction(piece["a_lon"]) * time)
        moved = f", moves to d={_short(str(across))} m" if abs(across - Fraction(motion["d"])) > 1 else ""
        lines.append(f"    {name} {start}, {_short(str(speeds[0]))} -> {_short(str(speeds[-1]))} m/s{moved}")
    return lines


def _short(text: str) -> str:
    return f"{float(Fraction(text)):.4g}"


def _show_countermodel(countermodel: "Countermodel") -> list[str]:
    lines = [
        "  false on this trace over points in time, judged; it may jump, and no drive was found:",
        f"    between two instants it keeps the state of the one {countermodel.held}",
    ]
    if countermodel.parameters:
        shown = ", ".join(f"{n}={_number(v)}" for n, v in sorted(countermodel.parameters.items()))
        lines.append(f"    parameters: {shown}")
    for instant in countermodel.instants:
        true = ", ".join(name for name, holds in instant.atoms.items() if holds) or "none of the predicates"
        lines.append(f"    at {_number(instant.time)} s: {true}")
        values = {n: v for n, v in instant.values.items() if n not in countermodel.parameters}
        if values:
            lines.append(f"      {', '.join(f'{n}={_number(v)}' for n, v in sorted(values.items()))}")
    return lines


def _number(value: Fraction) -> str:
    return f"{float(value):.6g}"


def _as_json(settled: Settled, file: str | None) -> dict[str, Any]:
    task, result = settled.task, settled.result
    return {
        "property": task.id,
        "part": task.part,
        "scenario": task.scenario,
        "set": task.set_name,
        "claim": task.claim,
        "expected": str(task.expected),
        "verdict": str(settled.verdict),
        "view": "grid" if settled.verdict is Verdict.PROVED_BOUNDED else "dense",
        "seconds": round(result.seconds, 4),
        "reason": result.reason,
        "assumptions": list(result.certificate.assumptions) if result.certificate else [],
        "certificate": file if result.certificate is not None else None,
        "counterexample": _counterexample(settled),
    }


def _counterexample(settled: Settled) -> dict[str, Any] | None:
    from roadproof.evidence.refutation import drive_data, trace_data

    if settled.drive is not None:
        return drive_data(settled.drive)
    found = settled.result.countermodel
    if found is None:
        return None
    return trace_data([(i.time, i.values, i.atoms) for i in found.instants], found.parameters, found.held)


# --- files ---------------------------------------------------------------------------------------


def _write_evidence(settled: Settled, folder: Path) -> dict[str, str]:
    """The certificate, or else the refuting drive, as a file; its path by task name."""
    from roadproof.evidence.certificate import to_json

    name = settled.task.name
    if settled.result.certificate is not None:
        path = folder / f"{name}.json"
        write_text(path, to_json(settled.result.certificate))
    elif settled.drive is not None:
        path = folder / f"{name}-drive.json"
        write_json(settled.drive, str(path))
    else:
        return {}
    return {name: str(path)}


def _index_entry(settled: Settled, file: str | None) -> dict[str, Any]:
    """What was asked and answered, and where the evidence is: a file beside the index, or in it."""
    task = settled.task
    entry = {
        "property": task.id,
        "part": task.part,
        "scenario": task.scenario,
        "set": task.set_name,
        "claim": task.claim,
        "verdict": str(settled.verdict),
        "evidence": None if file is None else Path(file).name,
    }
    return entry if file is not None else {**entry, "counterexample": _counterexample(settled)}
