"""``roadproof redundancy``: which parts of scenarios could be left out, and what shows the others needed."""

import argparse
import time
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.evidence import Evidence, read_drive, said_once, write_index
from roadproof.cli.numbers import add_effort_options, read_effort
from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    chosen_options,
    load_library_of,
    parameter_values,
    write_json,
)
from roadproof.cli.working import add_working_options, work
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    from roadproof.analysis.journal import Journal
    from roadproof.analysis.redundancy import Finding, Learned
    from roadproof.analysis.requests import Asked
    from roadproof.spec.scenarios import Scenario

SUMMARY = "which parts of scenarios are redundant, by proof; drives that show the others needed"
SCHEMA = "roadproof/redundancy/1"

_EXAMPLES = """\
examples:
  roadproof redundancy --among 3                one scenario
  roadproof redundancy --set ext --out red      all of ext, evidence in files
  roadproof redundancy --among 3 --whole        also inside rssViolation, aheadOf, atLane

Every occurrence of a part is replaced by true and by false: redundant where the scenario stays
equivalent (proved for all time), needed where a judged drive, or else a judged trace over points in time,
tells the two apart. Redundant for motion: equivalent on all traces on which a vehicle that leaves L has a
first moment outside it, as every motion without jumps does.
A run with --out that was broken off goes on where it was.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser)
    add_parameter_option(parser)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1,3-8")
    parser.add_argument("--whole", action="store_true", help="also the parts of simple predicates")
    add_effort_options(parser, 20.0, "a drive")
    add_working_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates and drives")
    add_json_option(parser)


@dataclass(frozen=True)
class Job:
    asked: "Asked"
    node: "Scenario"
    whole: bool
    learned: "Learned"


def run(args: argparse.Namespace) -> int:
    begun = time.monotonic()
    asked, numbers = _asked(args)
    said = {"set": args.set_name, **said_once(asked, args.out)}
    verdicts = _settle(asked, numbers, args.whole, args.out, said, args.jobs)
    data = {
        "schema": SCHEMA,
        **said,
        "view": "dense",
        "seconds": round(time.monotonic() - begun, 1),
        "verdicts": verdicts,
    }
    if args.json:
        write_json(data, args.json)
    if args.out is not None:
        write_index(args.out, data)
    if args.json != "-":
        _print(verdicts, time.monotonic() - begun)
    doubt = any(x["verdict"] == Verdict.UNKNOWN for x in verdicts)
    return ExitCode.UNKNOWN if doubt else ExitCode.AS_EXPECTED


def _asked(args: argparse.Namespace) -> "tuple[Asked, tuple[int, ...]]":
    from roadproof.analysis.requests import Asked
    from roadproof.spec.scenarios import numbers_of, read_numbers

    library = load_library_of(args)
    options = chosen_options(args)
    specification = library.select(args.set_name, options)
    numbers = read_numbers(specification, args.among) if args.among else numbers_of(specification)
    asked = Asked(
        (args.set_name,),
        options=options,
        specs=tuple(args.specs),
        values=parameter_values(args, library),
        effort=read_effort(args),
    )
    return asked, numbers


def _settle(
    asked: "Asked",
    numbers: Sequence[int],
    whole: bool,
    folder: Path | None,
    said: Mapping[str, Any],
    processes: int | None,
) -> list[dict[str, Any]]:
    """All verdicts in order; those that a journal holds are not asked again.

    One scenario of each kind comes first; those that differ from it in their road sector learn from it.
    """
    from roadproof.analysis.journal import Journal, Question
    from roadproof.analysis.redundancy import Learned
    from roadproof.spec.scenarios import Scenario, likes_of

    library, specification = asked.load()
    journal = None
    if folder is not None:
        more = {"whole": str(whole), "effort": f"{asked.effort.units:g}", **asked.question()}
        journal = Journal(folder, Question(SCHEMA, said, more, library))
    known: dict[int, list[dict[str, Any]]] = {
        x["scenario"]: x["verdicts"] for x in (journal.answers() if journal is not None else [])
    }
    likes = likes_of(specification)
    first: dict[int, int] = {}
    for number in numbers:
        first.setdefault(likes[number], number)
    leaders = [n for n in first.values() if n not in known]
    followers = [n for n in numbers if n not in known and n not in leaders]

    def settle_all(chosen: Sequence[int], learned: Mapping[int, Learned]) -> None:
        jobs = [
            Job(asked, Scenario(n, specification.set_name), whole, learned.get(likes[n], Learned()))
            for n in chosen
        ]
        with closing(work(settle, jobs, processes, "scenarios", known=len(known))) as answers:
            for number, findings in answers:
                known[number] = _record(number, findings, journal)

    settle_all(leaders, {})
    settle_all(followers, {kind: _learned(asked, known[leader]) for kind, leader in first.items()})
    return [verdict for number in numbers for verdict in known[number]]


def settle(job: Job) -> "tuple[int, tuple[Finding, ...]]":
    """The findings on the scenario of a job."""
    from roadproof.analysis.redundancy import examine

    return job.node.number, examine(job.asked, job.node, job.whole, job.learned)


def _learned(asked: "Asked", verdicts: Sequence[Mapping[str, Any]]) -> "Learned":
    from roadproof.analysis.placing import Shown
    from roadproof.analysis.redundancy import learn

    told = [x for x in verdicts if x["drive"] is not None]
    drives = [(x["changed"], Shown(x["claim"], dict(read_drive(x["drive"])))) for x in told]
    vain = [x["changed"] for x in verdicts if x["drive"] is None and not x["redundant"] and not x["late"]]
    return learn(asked, drives, vain)


def _record(number: int, findings: "Sequence[Finding]", journal: "Journal | None") -> list[dict[str, Any]]:
    """The findings on a scenario as plain data; evidence in files, or inside where there is no folder."""
    evidence = Evidence(journal)
    verdicts = []
    for place, finding in enumerate(findings, 1):
        certificate: str | None = finding.certificate
        drive: object = finding.drive
        if certificate is not None:
            certificate = evidence.certificate(f"redundant-{number:02}-{place:03}.json", certificate)
        elif finding.drive is not None:
            drive = evidence.drive(f"needed-{number:02}-{place:03}.json", finding.drive)
        change = finding.change
        verdicts.append(
            {
                "scenario": number,
                "part": change.part,
                "where": list(change.where),
                "as": change.value,
                "changed": change.changed,
                "redundant": None
                if finding.verdict is Verdict.UNKNOWN
                else finding.verdict is Verdict.PROVED,
                "verdict": str(finding.verdict),
                "assuming": finding.assuming,
                "claim": finding.claim,
                "certificate": certificate,
                "drive": drive,
                "trace": finding.trace,
                "reason": finding.reason,
                "late": finding.late,
            }
        )
    if journal is not None:
        journal.add({"evidence": evidence.files, "scenario": number, "verdicts": verdicts})
    return verdicts


def _print(verdicts: Sequence[Mapping[str, Any]], seconds: float) -> None:
    def say(verdict: Mapping[str, Any]) -> str:
        value = str(verdict["as"]).lower()
        return f"{verdict['part']} in {verdict['where'][-1]} as {value}"

    for verdict in verdicts:
        if verdict["redundant"]:
            where = " for motion" if verdict["assuming"] else ""
            print(f"scenario {verdict['scenario']}: redundant{where}: {say(verdict)}")
    doubts = [x for x in verdicts if x["verdict"] == Verdict.UNKNOWN]
    for verdict in doubts:
        print(f"scenario {verdict['scenario']}: in doubt: {say(verdict)}: {verdict['reason']}")
    redundant = sum(x["redundant"] is True and not x["assuming"] for x in verdicts)
    moving = sum(x["redundant"] is True and bool(x["assuming"]) for x in verdicts)
    drives = sum(x["drive"] is not None for x in verdicts)
    traces = sum(x["trace"] is not None for x in verdicts)
    print(
        f"{len(verdicts)} changes: {redundant} redundant, {moving} more for motion, {drives} told apart by a "
        f"drive, {traces} by a trace, {len(doubts)} in doubt, in {seconds:.1f} s"
    )
