"""``roadproof witness``: drives on which scenarios and formulas hold, each judged exactly."""

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.cli.numbers import whole
from roadproof.cli.options import add_json_option, chosen_options, json_text, load_library_of, write_json
from roadproof.cli.progress import clear
from roadproof.cli.search_options import add_search_options, read_means, read_setting
from roadproof.cli.working import add_working_options, work_in_order
from roadproof.errors import UsageError
from roadproof.files import make_folder, write_whole
from roadproof.study.pool import count_workers
from roadproof.verdict import Verdict, exit_code

if TYPE_CHECKING:
    from roadproof.spec.library import Library
    from roadproof.witness.ask import Outcome, Search

SUMMARY = "find a drive on which a scenario or a formula holds, and judge it exactly"
SCHEMA = "roadproof/witness/1"

_EXAMPLES = """\
examples:
  roadproof witness 4                                 a drive for scenario 4 on its reference road
  roadproof witness 12 --set ext --out drives         drive file, CSV and picture
  roadproof witness --all --set base --set extA --set ext --out drives
  roadproof witness 'scenario_8(SV,POV,L) and not scenario_6(SV,POV,L)' --lane L=main-2 --road main-3
  roadproof witness 1 --objective severe --count 3
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("what", metavar="N|FORMULA", nargs="*", help="a scenario's number, or a formula")
    parser.add_argument("--all", action="store_true", help="all 24 scenarios, in each --set")
    add_search_options(parser)
    parser.add_argument(
        "--objective",
        choices=("any", "smooth", "margin", "mild", "severe", "short"),
        default="smooth",
        help="what the drive should be like (default: smooth)",
    )
    parser.add_argument(
        "--count", type=whole("--count", 1), default=1, metavar="K", help="K clearly different drives"
    )
    add_working_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write drive files, CSV and pictures")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no pictures")
    parser.add_argument("--verbose", action="store_true", help="print sizes and seconds by stage")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    begun = time.monotonic()
    library = load_library_of(args)
    searches = list(_searches(args, library))
    if args.out is not None:
        make_folder(args.out)
    outcomes: list[Outcome] = []
    tasks = [Task(s, k + 1, args.out, not args.no_pictures) for k, s in enumerate(searches)]
    if count_workers(tasks, args.jobs) > 1:
        _warm_up()
    written = False
    for done in work_in_order(fulfil, tasks, args.jobs, "questions", undecided):
        outcomes.append(done.outcome)
        written = written or bool(done.files)
        if args.json != "-":
            clear()
            print(_line(done.outcome, args.verbose), flush=True)
            if done.files:
                print(f"  written to {args.out}: {', '.join(done.files)}", flush=True)
    if args.out is not None and not written and args.json != "-":
        print(f"nothing is written to {args.out}, as there is no drive")
    if args.json:
        verdicts = [outcome.as_data() for outcome in outcomes]
        write_json({"schema": SCHEMA, "verdicts": verdicts}, args.json)
    if args.json != "-" and len(outcomes) > 1:
        found = sum(o.verdict is Verdict.WITNESSED for o in outcomes)
        print(f"{found} of {len(outcomes)} witnessed in {time.monotonic() - begun:.1f} s")
    return exit_code((outcome.verdict, Verdict.WITNESSED) for outcome in outcomes)


def _searches(args: argparse.Namespace, library: "Library") -> "Iterator[Search]":
    from roadproof.spec.scenarios import numbers_of, read_query
    from roadproof.witness.ask import Search

    if args.all == bool(args.what):
        raise UsageError("name scenarios or formulas, or ask for --all: one of the two")
    sets = [name for text in args.set_names or ["base"] for name in text.split(",")]
    specifications = [library.select(name, chosen_options(args)) for name in sets]
    whats = [str(n) for n in numbers_of(specifications[0])] if args.all else list(args.what)
    setting = read_setting(args, library)
    means = replace(read_means(args), objective=args.objective)
    for specification in specifications:
        for what in whats:
            scenario, query = read_query(specification, what)
            yield Search(specification, query, setting, means, args.count, scenario)


@dataclass(frozen=True)
class Task:
    """One search of a run, and where its drives go."""

    search: "Search"
    number: int
    folder: Path | None
    pictures: bool


def _warm_up() -> None:
    """Import what every worker needs before they are forked, so that it is imported once."""
    from roadproof.solve.milp import prepare

    prepare()


def _line(outcome: "Outcome", verbose: bool) -> str:
    name = f"scenario {outcome.scenario}" if outcome.scenario is not None else outcome.query.text
    shown = f"{name:<12} {outcome.set_name:<5} {outcome.verdict:<11} road {outcome.road:<7}"
    if outcome.drives:
        file = outcome.drives[0].file
        shown += f" lane {file.lanes['L']}" if "L" in file.lanes else ""
        shown += "".join(f" {k}={v}" for k, v in file.lanes.items() if k != "L")
        shown += f" horizon {file.horizon} s"
        shown += "" if outcome.natural else " (not natural: within the vehicles' limits only)"
        shown += f" {len(outcome.drives)} drives" if len(outcome.drives) > 1 else ""
    shown += f" {outcome.seconds['all']:.2f} s"
    if outcome.reason:
        shown += f"\n  {outcome.reason}"
    if outcome.impossibility is not None:
        kind = "minimal core" if outcome.impossibility.minimal else "core, not minimised with the work given"
        shown += f"\n  proved for all time, on every road; {kind}:"
        shown += "".join(f"\n    {part}" for part in outcome.impossibility.told)
    if verbose:
        shown += f"\n  sizes {dict(outcome.sizes)}"
        shown += "\n  seconds " + ", ".join(f"{k} {v:.3f}" for k, v in outcome.seconds.items())
    return shown


@dataclass(frozen=True)
class Done:
    """The outcome of a task, and the names of the files with its drives."""

    outcome: "Outcome"
    files: tuple[str, ...] = ()


def undecided(task: Task, reason: str) -> Done:
    """The outcome of a search that nothing is known of."""
    from roadproof.witness.ask import undecided

    return Done(undecided(task.search, reason))


def fulfil(task: Task) -> Done:
    """Answer one search and write its drives: drive file, CSV, picture."""
    from roadproof.export.drive_csv import csv_of
    from roadproof.report.drive import draw_drive
    from roadproof.witness.ask import answer

    outcome = answer(task.search)
    if task.folder is None:
        return Done(outcome)
    files: list[str] = []

    def write(name: str, content: bytes) -> None:
        write_whole(folder / name, content)
        files.append(name)

    folder = task.folder
    name = f"formula-{task.number:02d}" if outcome.scenario is None else f"scenario-{outcome.scenario:02d}"
    for k, judged in enumerate(outcome.drives):
        stem = f"{name}-{outcome.set_name}" + (f"-{k + 1}" if len(outcome.drives) > 1 else "")
        write(f"{stem}.json", json_text(judged.as_data()).encode())
        write(f"{stem}.csv", csv_of(judged.file).encode())
        if task.pictures:
            for kind, content in draw_drive(judged.file, task.search.specification.library).items():
                write(f"{stem}.{kind}", content)
    return Done(outcome, tuple(files))
