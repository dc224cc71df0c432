"""``roadproof evaluate``: the highD experiment on a folder of recordings."""

import argparse
import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_reading_options,
    load_library_of,
    parameter_values,
    read_seconds,
    select_specification,
    write_json,
)
from roadproof.cli.progress import note
from roadproof.cli.working import add_working_options
from roadproof.errors import UsageError
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    from roadproof.traffic.experiment import Experiment, Outcome
    from roadproof.traffic.questions import Settings
    from roadproof.traffic.results import Totals

SUMMARY = "find disturbances in recorded traffic and match them with the scenarios"

MOST_FACTS = 12
_HALF_WRITTEN = re.compile(r"\..+\.(json|csv|txt|md|tex|png|svg)\.[a-z0-9_]{8}")

_EXAMPLES = """\
PATH is a folder of highD files (XX_recordingMeta.csv, XX_tracksMeta.csv, XX_tracks.csv), or of
CommonRoad 2020a files, or one CommonRoad file. A run that was killed goes on where it was.

examples:
  roadproof evaluate highd/data --out out --jobs 2
  roadproof evaluate highd/data --out out --sets base,ext --min-danger 0 --param rho=1
  roadproof evaluate highd/data --out out --class Car --class Truck --end clip --keep-going
  roadproof evaluate highd/data --out out --option lateral_rss=signed --check
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("path", metavar="PATH", type=Path, help="the recordings")
    parser.add_argument("--out", metavar="DIR", type=Path, required=True, help="where results go")
    parser.add_argument("--sets", metavar="S,S", default="base,extA,ext", help="default: base,extA,ext")
    parser.add_argument("--scenarios", metavar="N,N", default="1-8", help="default: 1-8")
    parser.add_argument("--min-danger", metavar="S,S", default="0,0.6", help="seconds (default: 0,0.6)")
    parser.add_argument("--min-safe", metavar="S", help="seconds (default: the library's 0.6)")
    parser.add_argument(
        "--class",
        dest="classes",
        metavar="C",
        action="append",
        help="vehicle class that is looked at; may be repeated (default: Car)",
    )
    parser.add_argument(
        "--end",
        choices=("truncated", "clip"),
        default="truncated",
        help="what the end of a trace means (default: truncated)",
    )
    add_reading_options(parser)
    add_parameter_option(parser)
    add_working_options(parser)
    parser.add_argument("--keep-going", action="store_true", help="leave out recordings that cannot be used")
    parser.add_argument("--check", action="store_true", help="ask the plain recursive evaluator again (slow)")
    parser.add_argument("--no-detectors", action="store_true", help="leave out those of earlier works")
    parser.add_argument(
        "--no-pictures", action="store_true", help="no figures, for which matplotlib is needed"
    )
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.files import hold_folder
    from roadproof.traffic.experiment import Experiment
    from roadproof.traffic.sources import find_sources

    jobs = os.cpu_count() or 1 if args.jobs is None else args.jobs
    if jobs < 1:
        raise UsageError(f"--jobs {jobs}: at least one process is needed")
    experiment = Experiment(args.path, args.out, _settings(args), jobs, args.keep_going)
    find_sources(args.path)
    with hold_folder(args.out):
        return _evaluate(args, experiment)


def _evaluate(args: argparse.Namespace, experiment: "Experiment") -> int:
    """The experiment, in a folder that no other run is writing into."""
    from roadproof.report.answers import answer_questions
    from roadproof.report.tables import as_text
    from roadproof.report.traffic import comparison_table, results_table
    from roadproof.report.write_traffic import remove_report, write_report
    from roadproof.traffic.experiment import run_experiment
    from roadproof.traffic.results import as_json

    remove_report(args.out)
    outcome = run_experiment(experiment, note)
    totals, failed = outcome.totals, outcome.failed
    denied = list(_recheck(experiment, outcome)) if args.check else []
    write_report(args.out, totals, failed, not args.no_pictures)
    if args.json:
        write_json(as_json(totals), args.json)
    if args.json != "-":
        print(as_text(results_table(totals, failed)))
        compared = comparison_table(totals, failed)
        if compared is not None:
            print(as_text(compared))
        section = answer_questions(totals, failed).partition("## Facts")[2].partition("\n\n")[2]
        facts = section.partition("\n\n")[0].splitlines()
        print("\n".join(facts[:MOST_FACTS]))
        if len(facts) > MOST_FACTS:
            print(f"… {len(facts) - MOST_FACTS} more in {args.out / 'answers.md'}")
    _sweep(args.out)
    _tell_notes(args.out, totals)
    for name, reason in failed.items():
        print(f"left out: recording {name}: {reason}", file=sys.stderr)
    note(f"written to {args.out}: " + ", ".join(sorted(x.name for x in args.out.iterdir())))
    return max(_verdict(totals.broken, denied), ExitCode.UNKNOWN if outcome.lost else ExitCode.AS_EXPECTED)


def _tell_notes(out: Path, totals: "Totals") -> None:
    """What is odd in the recordings, on the screen; all of it is in the results."""
    remarks = [(name, remark) for name, each in totals.notes.items() for remark in each]
    for name, remark in remarks[:MOST_FACTS]:
        print(f"note: recording {name}: {remark}", file=sys.stderr)
    if len(remarks) > MOST_FACTS:
        print(f"… {len(remarks) - MOST_FACTS} more notes in {out / 'results.json'}", file=sys.stderr)


def _sweep(out: Path) -> None:
    """Remove what a killed run may have left: hidden files that were never put in their place."""
    for folder in (out, out / "recordings", out / "figures"):
        for path in folder.glob(".*"):
            if _HALF_WRITTEN.fullmatch(path.name):
                path.unlink(missing_ok=True)


def _verdict(broken: list[str], denied: list[str]) -> int:
    if not broken and not denied:
        return ExitCode.AS_EXPECTED
    print(f"{Verdict.CROSSCHECK_FAILED}: {len(broken)} facts violated, {len(denied)} answers denied")
    for line in (*broken, *denied)[:20]:
        print(f"  {line}")
    return ExitCode.CROSSCHECK_FAILED


def _settings(args: argparse.Namespace) -> "Settings":
    from roadproof.traffic.questions import COMPARISON, Settings

    library = load_library_of(args)
    values = parameter_values(args, library)
    if any(text.partition("=")[0].strip() == "minDanger" for text in args.params):
        raise UsageError("--param minDanger: evaluate takes several values of it; use --min-danger 0,0.6")
    if args.min_safe is not None:
        values["minSafe"] = read_seconds("--min-safe", args.min_safe, or_zero=True)
    sets = _items("--sets", args.sets)
    chosen = [
        select_specification(argparse.Namespace(set_name=name, options=args.options), library)
        for name in sets
    ]
    return Settings(
        library,
        chosen[0].options,
        values,
        sets=tuple(sets),
        min_danger=tuple(
            read_seconds("--min-danger", x, or_zero=True) for x in _items("--min-danger", args.min_danger)
        ),
        scenarios=tuple(_numbers(args.scenarios)),
        classes=tuple(args.classes or ["Car"]),
        convention=args.end,
        detectors=() if args.no_detectors else COMPARISON,
    )


def _items(option: str, text: str) -> list[str]:
    items = [item.strip() for item in text.split(",")]
    if not all(items):
        raise UsageError(f"{option} {text}: write values separated by commas")
    return items


def _numbers(text: str) -> Iterator[int]:
    """``1-3,7`` as 1, 2, 3, 7."""
    for item in _items("--scenarios", text):
        low, dash, high = item.partition("-")
        ends = (low, high) if dash else (low, low)
        if not all(x.isdecimal() and len(x) <= 2 for x in ends):
            raise UsageError(f"--scenarios {text}: write numbers and ranges, such as 1-8 or 1,4")
        yield from range(int(ends[0]), int(ends[1]) + 1)


def _recheck(experiment: "Experiment", outcome: "Outcome") -> Iterator[str]:
    """Every answer again, recording by recording, from what was saved."""
    from roadproof.traffic.experiment import saved_findings
    from roadproof.traffic.questions import ask
    from roadproof.traffic.recheck import recheck

    for source, findings in saved_findings(experiment, outcome):
        recording = source.read()
        denied = list(recheck(recording, ask(experiment.settings, recording.rate), findings))
        note(f"checked {source.name}: {len(denied)} answers denied")
        yield from denied
