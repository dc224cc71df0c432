"""``roadproof trace``: check which requirements are shown by evidence."""

import argparse
from pathlib import Path

from roadproof.errors import UsageError
from roadproof.extensions.assurance.settings import Requirements
from roadproof.frontends.cli.options import print_answer, write_build_results
from roadproof.frontends.cli.progress import Counter, clear
from roadproof.frontends.settings.flags import read_keywords

SUMMARY = "link requirements to evidence, and say which are shown"

EXAMPLES = """\
examples:
  roadproof trace requirements.toml                      the state of each requirement and link
  roadproof trace requirements.toml --out trace          also as page, CSV, Markdown and JSON
  roadproof trace requirements.toml --accept             remember what each link rests on
  roadproof trace requirements.toml --reqif states.reqif for a requirements tool
  roadproof trace --baseline old/trace.json new/trace.json    links that are better, worse, new or gone

requirements.toml:
  [trace]
  evidence = ["proofs", "drives"]          # folders of --out; all of it is checked again
  [[requirement]]
  id = "LEAD-1"
  text = "The vehicle keeps its distance from a vehicle ahead that brakes."
  claims = ["scenario_4(SV,POV,L) -> F danger(SV,POV)"]   # or a name that check prints: needs a proof
  scenarios = [4]                          # a number, name, class or formula: needs a judged drive
  tests = ["cut-in-3"]                     # tests of a catalogue; also: drivers, plates, evidence, parent

Other fields of [trace]: specs, set, options, parameters, vehicles, and source, a file of requirements in
another format (.reqif, .sdoc of StrictDoc, a folder of Doorstop) to which [[requirement]] adds links.
States: proved, witnessed; unknown; missing, rejected, refuted, stale. A link is stale where a definition,
parameter, vehicle model, text, file or version that it rests on is another than when it was accepted.
Exit code 0 where all is shown, 10 where something is missing, rejected, refuted or stale, 20 where a link is
not decided.
"""
OPTIONS = Requirements


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "file", metavar="FILE", nargs="?", type=Path, help="requirements: .toml, .reqif, .sdoc, or a folder"
    )
    parser.add_argument(
        "--baseline", metavar=("A", "B"), nargs=2, type=Path, help="compare two answers, saved as JSON"
    )


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.assurance.tracing import requirement_changes, requirements

    if (args.file is None) == (args.baseline is None):
        raise UsageError("name a file of requirements, or two answers with --baseline A B")
    if args.baseline is not None:
        if args.accept or any(x is not None for x in (args.out, args.reqif, args.junit, args.sarif)):
            remedy = "omit --accept, --out, --reqif, --junit and --sarif"
            raise UsageError(f"--baseline compares saved answers: {remedy}")
        changes = requirement_changes(*args.baseline)
        print_answer(changes, args.json)
        return changes.exit_code
    traced = requirements(args.file, **read_keywords(args, Requirements) | {"progress": Counter()})
    clear()
    if args.out is not None:
        traced.save(args.out)
    if args.reqif is not None:
        traced.save_reqif(args.reqif)
    write_build_results(args, traced)
    print_answer(traced, args.json)
    return traced.exit_code
