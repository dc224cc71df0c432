"""``roadproof prove``: claims over dense time, for all horizons and parameter values, with certificates."""

import argparse
import re
import time
from pathlib import Path

from roadproof.cli.numbers import add_effort_options, read_effort
from roadproof.cli.options import (
    add_json_option,
    add_specification_options,
    chosen_options,
    load_library_of,
    read_seconds,
    write_json,
)
from roadproof.cli.progress import clear
from roadproof.cli.prove_answers import as_data, details, line, table
from roadproof.cli.prove_files import ProofFolder
from roadproof.cli.prove_settle import Bounded, Job, Settled, settle, undecided
from roadproof.cli.working import add_working_options, work_in_order
from roadproof.errors import UsageError
from roadproof.verdict import Verdict, exit_code

SUMMARY = "prove claims for all time, or refute them; without a claim, the template properties"
SCHEMA = "roadproof/verdicts/1"
_PROPERTY = re.compile(r"[A-Z]\d+")

_EXAMPLES = """\
examples:
  roadproof prove                                     all template properties and negative controls
  roadproof prove P1 P4 --set base                    some of them
  roadproof prove 'scenario_8(SV,POV,L) -> F danger(SV,POV)' --set ext
  roadproof prove 'scenario_4(SV,POV,L) -> scenario_4@ext(SV,POV,L)'
  roadproof prove 'given A, B: vehicle: danger(A,B) -> danger(B,A)' --out proofs
  roadproof prove --claims mine.txt --json -          one claim a paragraph
  roadproof prove 'dangerArises(SV,POV) -> F aheadOf(SV,POV)' --engine smt --horizon 3 --dt 3/5

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
    add_effort_options(parser, each="a claim")
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
    add_working_options(parser)
    parser.add_argument(
        "--no-drive", action="store_true", help="do not look for a drive that refutes a claim"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates and an index")
    parser.add_argument("--verbose", action="store_true", help="a line for every claim of the list")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    begun = time.monotonic()
    jobs = _jobs(args)
    folder = None if args.out is None else ProofFolder(args.out, jobs[0].options, args.specs)
    own = not jobs[0].task.title
    settled: list[Settled] = []
    for answer in work_in_order(settle, jobs, args.jobs, "claims", undecided):
        settled.append(answer)
        if folder is not None:
            folder.add(answer)
        if args.json != "-" and (own or args.verbose):
            clear()
            print(details(answer) if own else line(answer), flush=True)
    if args.json != "-" and not own:
        print(table(settled))
        print(f"{len(settled)} claims in {time.monotonic() - begun:.1f} s")
    if args.json:
        files = {} if folder is None else folder.files
        verdicts = [as_data(s, files.get(s.task.name)) for s in settled]
        write_json({"schema": SCHEMA, "verdicts": verdicts}, args.json)
    return exit_code((s.verdict, s.task.expected) for s in settled)


# --- what is asked -------------------------------------------------------------------------------


def _jobs(args: argparse.Namespace) -> list[Job]:
    from roadproof.prove.properties import Task, choose, read_claims, template_properties
    from roadproof.spec.elaborate import read_claim

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
    seek_drive, effort = not args.no_drive, read_effort(args)
    return [Job(task, tuple(args.specs), options, effort, seek_drive, bounded) for task in tasks]
