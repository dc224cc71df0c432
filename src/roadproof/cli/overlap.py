"""``roadproof overlap``: which scenarios can hold together, with a drive or a proof for every pair."""

import argparse
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.cli.basis import among, read_basis
from roadproof.cli.evidence import evidence_folder
from roadproof.cli.numbers import add_effort_options
from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    read_seconds,
    write_json,
    write_text,
)
from roadproof.cli.progress import Counter, warn
from roadproof.cli.working import add_working_options
from roadproof.errors import UsageError
from roadproof.verdict import exit_code

if TYPE_CHECKING:
    from roadproof.analysis.overlap import Overlap, PairVerdict

SUMMARY = "which scenarios can hold together: for every pair a drive, or a proof that there is none"

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


def run(args: argparse.Namespace) -> int:
    from roadproof.analysis.overlap import name_of
    from roadproof.report.overlap import as_text
    from roadproof.study.frame import conduct
    from roadproof.study.shelf import write_index

    begun = time.monotonic()
    study = _study(args)
    folder = evidence_folder(args.out, args.json)
    found = conduct(study, folder, args.jobs, Counter(), "groups of pairs", warn)
    verdicts, across = study.verdicts(found.answers), len(study.basis.set_names) > 1
    seconds = time.monotonic() - begun
    data = {
        "schema": study.question.schema,
        **study.question.said,
        "view": "dense",
        "seconds": round(seconds, 2),
        "verdicts": [found.records[name_of(*pair)]["verdict"] for pair in study.pairs],
    }
    if args.json:
        write_json(data, args.json)
    if folder is not None:
        write_index(folder, data)
    if args.out is not None:
        _write(study, verdicts, args.out, across, not args.no_pictures)
    if args.json != "-":
        print(as_text(verdicts, across))
        print(f"{len(verdicts)} pair{'s' if len(verdicts) > 1 else ''} in {seconds:.1f} s")
    return exit_code((x.verdict, x.verdict) for x in verdicts)


def _study(args: argparse.Namespace) -> "Overlap":
    from roadproof.analysis.meeting import Meeting
    from roadproof.analysis.overlap import Overlap, pairs_of

    sets = tuple(args.set_names or ["base"])
    if len(sets) > 2 or len(set(sets)) < len(sets):
        raise UsageError(f"--set {', '.join(sets)}: name one set, or two different ones")
    # What happens one after the other takes longer than what happens at once.
    usual = "9" if args.start == "any" else "6"
    basis = replace(read_basis(args, sets), horizon=read_seconds("--horizon", args.horizon or usual))
    pairs = pairs_of(basis, among(args, basis.specification))
    if not pairs:
        raise UsageError(f"--among {args.among} leaves no pair: name at least two scenarios")
    return Overlap(basis, pairs, Meeting(args.lanes, args.roles, args.start))


def _write(
    study: "Overlap", verdicts: "Sequence[PairVerdict]", folder: Path, across: bool, pictures: bool
) -> None:
    from roadproof.files import write_whole
    from roadproof.report.overlap import as_csv, draw_overlap

    write_text(folder / "overlap.csv", as_csv(verdicts))
    if pictures:
        said = study.question.said
        title = f"set {said['set']}: lanes {said['lanes']}, roles {said['roles']}, start {said['start']}"
        for kind, content in draw_overlap(verdicts, title, across).items():
            write_whole(folder / f"overlap.{kind}", content)
