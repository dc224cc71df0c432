"""``roadproof redundancy``: which parts of scenarios could be left out, and what shows the others needed."""

import argparse
import json
import time
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    chosen_options,
    load_library_of,
    parameter_values,
    write_json,
    write_text,
)
from roadproof.cli.working import tell, work
from roadproof.errors import InputError, UsageError
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    from roadproof.analysis.meeting import Node
    from roadproof.analysis.overlap import Asked
    from roadproof.analysis.redundancy import Finding

SUMMARY = "which parts of scenarios are redundant, by proof; drives that show the others needed"
SCHEMA = "roadproof/redundancy/1"

_EXAMPLES = """\
examples:
  roadproof redundancy --among 3                one scenario
  roadproof redundancy --set ext --out red      all of ext, evidence in files
  roadproof redundancy --among 3 --whole        also inside rssViolation, aheadOf, atLane

Every occurrence of a part is replaced by true and by false: redundant where the scenario stays
equivalent (proved for all time), needed where a judged drive, or else a judged trace over points in time,
tells the two apart.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser)
    add_parameter_option(parser)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1,3-8")
    parser.add_argument("--whole", action="store_true", help="also the parts of simple predicates")
    parser.add_argument(
        "--timeout", type=float, default=20.0, metavar="S", help="seconds for one drive (default: 20)"
    )
    parser.add_argument("--jobs", type=int, metavar="N", help="processes (default: one a core)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates and drives")
    add_json_option(parser)


@dataclass(frozen=True)
class Job:
    asked: "Asked"
    nodes: "tuple[Node, ...]"
    whole: bool


def run(args: argparse.Namespace) -> int:
    begun = time.monotonic()
    jobs = _jobs(args)
    if args.out is not None:
        try:
            args.out.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"cannot make the folder {args.out}: {error.strerror}") from None
    count = sum(len(job.nodes) for job in jobs)
    findings: list[Finding] = []
    with closing(work(settle, jobs, args.jobs)) as answers:
        for found in answers:
            findings += found
            tell(f"{len({x.node for x in findings})} of {count} scenarios")
    tell(f"{count} scenarios", last=True)
    findings.sort(key=lambda x: x.node.number)
    entries = [_entry(x, number, args.out) for number, x in enumerate(findings, 1)]
    data = {"schema": SCHEMA, "set": args.set_name, "view": "dense", "verdicts": entries}
    if args.json:
        write_json(data, args.json)
    if args.out is not None:
        write_json(data, str(args.out / "index.json"))
    if args.json != "-":
        _print(findings, time.monotonic() - begun)
    doubt = any(x.verdict is Verdict.UNKNOWN for x in findings)
    return ExitCode.UNKNOWN if doubt else ExitCode.AS_EXPECTED


def _jobs(args: argparse.Namespace) -> list[Job]:
    """One job for the scenarios that differ in their road sectors only: they share drives."""
    from roadproof.analysis.meeting import Node, read_numbers, scenario_numbers
    from roadproof.analysis.overlap import Asked, likes_of

    if not args.timeout > 0:
        raise UsageError(f"--timeout {args.timeout} must be greater than 0")
    library = load_library_of(args)
    options = chosen_options(args)
    specification = library.select(args.set_name, options)
    numbers = read_numbers(args.among, specification) if args.among else scenario_numbers(specification)
    asked = Asked(
        (args.set_name,),
        options=options,
        specs=tuple(args.specs),
        values=parameter_values(args, library),
        timeout=args.timeout,
    )
    groups: dict[int, list[Node]] = {}
    likes = likes_of(specification)
    for number in numbers:
        groups.setdefault(likes[number], []).append(Node(number, args.set_name))
    return [Job(asked, tuple(nodes), args.whole) for nodes in groups.values()]


def settle(job: Job) -> "list[Finding]":
    """The findings on the scenarios of one job."""
    from roadproof.analysis.redundancy import examine

    return list(examine(job.asked, job.nodes, job.whole))


def _entry(finding: "Finding", number: int, folder: Path | None) -> dict[str, Any]:
    certificate: str | None = finding.certificate
    drive: object = finding.drive
    if folder is not None and certificate is not None:
        path = folder / f"redundant-{finding.node.number:02}-{number}.json"
        write_text(path, certificate)
        certificate = str(path)
    elif folder is not None and finding.drive is not None:
        path = folder / f"needed-{finding.node.number:02}-{number}.json"
        write_text(path, json.dumps(finding.drive, indent=2, ensure_ascii=False) + "\n")
        drive = str(path)
    change = finding.change
    return {
        "scenario": finding.node.number,
        "part": change.part,
        "where": list(change.where),
        "as": change.value,
        "redundant": None if finding.verdict is Verdict.UNKNOWN else finding.verdict is Verdict.PROVED,
        "verdict": str(finding.verdict),
        "claim": finding.claim,
        "certificate": certificate,
        "drive": drive,
        "trace": finding.trace,
        "reason": finding.reason,
    }


def _print(findings: "Sequence[Finding]", seconds: float) -> None:
    for finding in findings:
        if finding.verdict is Verdict.PROVED:
            print(f"scenario {finding.node.number}: redundant: {finding.change}")
    for finding in findings:
        if finding.verdict is Verdict.UNKNOWN:
            print(f"scenario {finding.node.number}: in doubt: {finding.change}: {finding.reason}")
    redundant = sum(x.verdict is Verdict.PROVED for x in findings)
    drives = sum(x.drive is not None for x in findings)
    traces = sum(x.trace is not None for x in findings)
    doubts = sum(x.verdict is Verdict.UNKNOWN for x in findings)
    print(
        f"{len(findings)} changes: {redundant} redundant, {drives} told apart by a drive, {traces} by a "
        f"trace, {doubts} in doubt, in {seconds:.1f} s"
    )
