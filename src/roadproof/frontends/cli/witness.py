"""``roadproof witness``: drives on which scenarios and formulas hold, each judged exactly."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.cli.basis import in_order, read_definitions, study_keywords
from roadproof.frontends.cli.options import add_what_arguments, some_or_all, write_build_results, write_json
from roadproof.frontends.cli.progress import clear, tell_road, tell_stage, warn_of_drive_pictures
from roadproof.frontends.cli.streams import print_at_once
from roadproof.frontends.settings.questions import Witness
from roadproof.runtime.progress import listening

if TYPE_CHECKING:
    from roadproof.questions.witness import SearchResult

SUMMARY = "find a drive on which a scenario or a formula holds"

EXAMPLES = """\
examples:
  roadproof witness 4                                 scenario 4, deceleration ahead, on its reference road
  roadproof witness 12 --out drives --animate gif     drive file, CSV, picture and animation
  roadproof witness 1,3-8                             a drive for each of these scenarios
  roadproof witness --all --set base --set extA --set ext --out drives
  roadproof witness 'scenario_8(SV,POV,L) and not scenario_6(SV,POV,L)' --lane L=main-2 --road main-3
  roadproof witness 1 --objective severe --count 3
  roadproof witness 1 --unpreventable careful         begins with a cut-in that no careful driver survives

A run with --out that was broken off goes on where it was; what is there for the same search stands.
"""
OPTIONS = Witness


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_what_arguments(parser, "all 24 scenarios, in each --set")


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from roadproof.frontends.api.drives import files_written, views_of, witness_all, witness_question
    from roadproof.frontends.report.witness import as_line

    what = some_or_all(args)
    given = Witness.of(study_keywords(args, Witness))
    views = views_of(given)
    question = witness_question(what, read_definitions(args, Witness), given)
    plain = args.json != "-"
    written: list[str] = []

    def show(name: str, result: "SearchResult") -> None:
        """Print a result with the files written for it."""
        files = [] if args.out is None else files_written(question, name, result, views, Path(args.out))
        written.extend(files)
        clear()
        files_note = f"\n  written to {args.out}: {', '.join(files)}" if files else ""
        line = as_line(result, args.verbose)
        print_at_once(line + files_note, args.out is not None)

    each = in_order(tuple(question.named), show) if plain else None
    with listening(tell_stage if len(question.named) == 1 else None):
        witnesses = witness_all(question, given, each)
    if args.out is not None and not written and plain:
        print(f"no drive was found, so nothing was written to {args.out}")
    if args.out is not None:
        warn_of_drive_pictures(given.pictures and bool(witnesses.drives))
    write_build_results(args, witnesses)
    if args.json:
        write_json(witnesses.as_data(), args.json)
    if plain and len(witnesses.outcomes) > 1:
        print(witnesses.summary)
    if plain:
        lines = (*witnesses.supposed, *given.remarks(question, witnesses.found.answers))
        print(*lines, sep="\n", end="\n" * bool(lines))
    tell_road(witnesses.road)
    return witnesses.exit_code
