"""``roadproof overlap``: which scenarios can hold together, with a drive or a proof for every pair."""

import argparse
import time
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.evidence import Evidence, evidence_folder, said_once, write_index
from roadproof.cli.numbers import add_effort_options, read_effort
from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    chosen_options,
    load_library_of,
    parameter_values,
    read_seconds,
    write_json,
    write_text,
)
from roadproof.cli.working import add_working_options, work
from roadproof.errors import UsageError
from roadproof.verdict import Verdict, exit_code

if TYPE_CHECKING:
    from roadproof.analysis.journal import Journal
    from roadproof.analysis.overlap import Asked, Entry, Pair

SUMMARY = "which scenarios can hold together: for every pair a drive, or a proof that there is none"
SCHEMA = "roadproof/overlap/1"

_EXAMPLES = """\
examples:
  roadproof overlap --out overlap                     all 276 pairs of base: matrix, CSV, heat map, evidence
  roadproof overlap --among 1,3-8                     two-vehicle scenarios of the main road
  roadproof overlap --lanes any --roles any           each scenario with a lane and roles of its own
  roadproof overlap --start any --among 1-8           one at 0, the other then or later
  roadproof overlap --set base --set ext --among 1-8  scenarios of one set against those of another

# held together on a judged drive, . proved impossible for all time (certificate and core).
Evidence goes to DIR, or with --json FILE alone to FILE-evidence; `roadproof check DIR` checks it.
A run that was broken off goes on where it was.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser, "base", several=True)
    add_parameter_option(parser)
    for name, what in (
        ("lanes", "both speak of one lane, or each of its own (default: same)"),
        ("roles", "vehicles play the same parts in both, or any (default: same)"),
        ("start", "both start at 0, or one then or later (default: same)"),
    ):
        parser.add_argument(f"--{name}", choices=("same", "any"), default="same", help=what)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1,3-8")
    add_effort_options(parser, 60.0, "a drive")
    parser.add_argument(
        "--horizon", metavar="S", help="seconds of driving searched (default: 6; 9 with --start any)"
    )
    add_working_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write evidence, CSV, JSON and heat map")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no heat map")
    add_json_option(parser)


@dataclass(frozen=True)
class Job:
    asked: "Asked"
    seed: "Pair"
    pairs: "tuple[Pair, ...]"


def run(args: argparse.Namespace) -> int:
    begun = time.monotonic()
    asked, pairs = _asked(args)
    question = {"lanes": args.lanes, "roles": args.roles, "start": args.start}
    folder = evidence_folder(args.out, args.json)
    said = {"set": ",".join(asked.sets), **question, **said_once(asked, folder)}
    verdicts = _settle(asked, pairs, folder, said, args.jobs)
    data = {
        "schema": SCHEMA,
        **said,
        "view": "dense",
        "seconds": round(time.monotonic() - begun, 2),
        "verdicts": verdicts,
    }
    if args.json:
        write_json(data, args.json)
    if folder is not None:
        write_index(folder, data)
    if args.out is not None:
        _write(data, args.out, len(asked.sets) > 1, not args.no_pictures)
    if args.json != "-":
        _print(verdicts, len(asked.sets) > 1, time.monotonic() - begun)
    return exit_code((Verdict(x["verdict"]), Verdict(x["verdict"])) for x in verdicts)


def _asked(args: argparse.Namespace) -> "tuple[Asked, list[Pair]]":
    from roadproof.analysis.meeting import Meeting, read_numbers
    from roadproof.analysis.overlap import Asked, pairs_of

    sets = tuple(args.set_names or ["base"])
    if len(sets) > 2 or len(set(sets)) < len(sets):
        raise UsageError(f"--set {', '.join(sets)}: name one set, or two different ones")
    library = load_library_of(args)
    specification = library.select(sets[0], chosen_options(args))
    asked = Asked(
        sets,
        Meeting(args.lanes, args.roles, args.start),
        specification.options,
        tuple(args.specs),
        parameter_values(args, library),
        _horizon(args),
        read_effort(args),
    )
    numbers = read_numbers(args.among, specification) if args.among else None
    pairs = pairs_of(asked, numbers)
    if not pairs:
        raise UsageError(f"--among {args.among} leaves no pair: name at least two scenarios")
    return asked, pairs


def _horizon(args: argparse.Namespace) -> Fraction:
    """What happens one after the other takes longer than what happens at once."""
    usual = "9" if args.start == "any" else "6"
    return read_seconds("--horizon", args.horizon or usual)


def _settle(
    asked: "Asked",
    pairs: "Sequence[Pair]",
    folder: Path | None,
    said: Mapping[str, Any],
    processes: int | None,
) -> list[dict[str, Any]]:
    """All verdicts in the order of ``pairs``; those that a journal holds are not asked again."""
    from roadproof.analysis.journal import Journal, Question
    from roadproof.analysis.overlap import groups_of

    def key(x: Mapping[str, Any]) -> tuple[int, str, int, str]:
        return x["a"], x["set_a"], x["b"], x["set_b"]

    question = Question(SCHEMA, said, asked.question(), asked.load()[0])
    journal = Journal(folder, question) if folder is not None else None
    known = {key(x["verdict"]): x["verdict"] for x in (journal.answers() if journal is not None else [])}
    wanted = [(a.number, a.set_name, b.number, b.set_name) for a, b in pairs]
    left = [pair for pair, name in zip(pairs, wanted, strict=True) if name not in known]
    jobs = [Job(asked, seed, tuple(group)) for seed, group in groups_of(asked, left)]
    with closing(work(settle, jobs, processes, "groups of pairs", undecided)) as answers:
        for entries in answers:
            for entry in entries:
                verdict = _record(entry, journal)
                known[key(verdict)] = verdict
    return [known[name] for name in wanted]


def settle(job: Job) -> "list[Entry]":
    """The answers for one group of pairs."""
    from roadproof.analysis.overlap import decide_group

    return decide_group(job.asked, job.seed, job.pairs)


def undecided(job: Job, reason: str) -> "list[Entry]":
    """The answers for a group of pairs that nothing is known of."""
    from roadproof.analysis.overlap import Entry

    return [Entry(a, b, Verdict.UNKNOWN, "", reason) for a, b in job.pairs]


def _record(entry: "Entry", journal: "Journal | None") -> dict[str, Any]:
    """The entry as plain data; its evidence in a file, or inside where there is no folder."""
    certificate: str | None = entry.certificate
    drive: object = entry.drive
    stem = f"{entry.a.set_name}-{entry.a.number:02}-{entry.b.set_name}-{entry.b.number:02}.json"
    evidence = Evidence(journal)
    if certificate is not None:
        certificate = evidence.certificate(f"impossible-{stem}", certificate)
    elif entry.drive is not None:
        drive = evidence.drive(f"drive-{stem}", entry.drive)
    verdict = {
        "a": entry.a.number,
        "b": entry.b.number,
        "set_a": entry.a.set_name,
        "set_b": entry.b.set_name,
        "verdict": str(entry.verdict),
        "formula": entry.formula,
        "core": list(dict.fromkeys(part for core in entry.cores for part in core.parts)),
        "cores": [{"formula": core.formula, "parts": list(core.parts)} for core in entry.cores],
        "certificate": certificate,
        "drive": drive,
        "reason": entry.reason,
        "seconds": round(entry.seconds, 3),
    }
    if journal is not None:
        journal.add({"evidence": evidence.files, "verdict": verdict})
    return verdict


def _print(verdicts: Sequence[Mapping[str, Any]], across: bool, seconds: float) -> None:
    from roadproof.report.overlap import as_matrix

    print(as_matrix(verdicts, across))
    for verdict in Verdict:
        found = [x for x in verdicts if x["verdict"] == verdict]
        if not found:
            continue
        few = ", ".join(f"{x['a']}-{x['b']}" for x in found) if len(found) <= 30 else ""
        print(f"{len(found):>4} {verdict}" + (f": {few}" if few else ""))
        reasons = dict.fromkeys(x["reason"] for x in found if x["reason"])
        print("".join(f"       {reason}\n" for reason in reasons), end="")
    print(f"{len(verdicts)} pair{'s' if len(verdicts) > 1 else ''} in {seconds:.1f} s")


def _write(data: Mapping[str, Any], folder: Path, across: bool, pictures: bool) -> None:
    from roadproof.files import write_whole
    from roadproof.report.overlap import as_csv, draw_overlap

    write_text(folder / "overlap.csv", as_csv(data["verdicts"]))
    if pictures:
        title = f"set {data['set']}: lanes {data['lanes']}, roles {data['roles']}, start {data['start']}"
        for kind, content in draw_overlap(data["verdicts"], title, across).items():
            write_whole(folder / f"overlap.{kind}", content)
