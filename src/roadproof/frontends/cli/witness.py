"""``roadproof witness``: drives on which scenarios and formulas hold, each judged exactly."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.cli.basis import in_order, read_definitions, study_keywords
from roadproof.frontends.cli.options import add_what_arguments, some_or_all, write_build_results, write_json
from roadproof.frontends.cli.progress import clear, tell_road, tell_stage
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
    from roadproof.frontends.api.drives import drives_asked, files_written, views_of, witness_all
    from roadproof.frontends.report.witness import as_line

    what = some_or_all(args)
    given = Witness.of(study_keywords(args, Witness))
    views = views_of(given)
    question = drives_asked(what, read_definitions(args, Witness), given)
    plain = args.json != "-"
    written: list[str] = []

    def show(name: str, result: "SearchResult") -> None:
        files = [] if args.out is None else files_written(question, name, result, views, Path(args.out))
        written.extend(files)
        clear()
        told = f"\n  written to {args.out}: {', '.join(files)}" if files else ""
        line = as_line(result, args.verbose)
        print_at_once(line + told, args.out is not None)

    each = in_order(tuple(question.named), show) if plain else None
    with listening(tell_stage if len(question.named) == 1 else None):
        found = witness_all(question, given, each)
    if args.out is not None and not written and plain:
        print(f"no drive was found, so nothing was written to {args.out}")
    write_build_results(args, found)
    if args.json:
        write_json(found.as_data(), args.json)
    if plain and len(found.outcomes) > 1:
        print(found.summary)
    if plain:
        print(*found.supposed, sep="\n", end="\n" * bool(found.supposed))
    tell_road(found.road)
    return found.exit_code
