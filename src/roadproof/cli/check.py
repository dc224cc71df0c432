"""``roadproof check``: certificates and drive files, checked again without what made them."""

import argparse
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.cli.numbers import add_effort_options, read_effort
from roadproof.cli.options import add_json_option, write_json
from roadproof.cli.working import add_working_options, work_in_order
from roadproof.effort import Effort

if TYPE_CHECKING:
    from roadproof.evidence.finding import Finding

SUMMARY = "check certificates and drive files again, without the programs that made them"
SCHEMA = "roadproof/check/2"

_EXAMPLES = """\
examples:
  roadproof check proofs/                          every claim of a folder, with its index
  roadproof check proofs/ --solver cvc5            ask another solver
  roadproof check drives/scenario-04-base.json     judge a drive again, exactly
  roadproof check mine/ --spec mine.spec           claims that were made with definitions of yours

A certificate is accepted when the claim, read with the library at hand, and the certificate's instances
give the very query that is stored, and the solver answers unsat to it. A drive file is accepted when its
formula holds on its drive, judged exactly in dense time. The index of a folder is a part of the evidence:
each entry must be that of its file, and no file may be without one; kept answers (answers.jsonl) too. Where
an index names specification files beside it, such as classes.spec, these are put on top of the library,
unless they would change what is there.

A line for each claim says what was checked, and what was not. Exit code 10 where something is rejected, 20
where the solver did not decide, 3 where a file is damaged or speaks of definitions that are not at hand.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("paths", metavar="FILE|DIR", nargs="+", type=Path)
    parser.add_argument("--solver", choices=("z3", "cvc5"), default="z3", help="who is asked (default: z3)")
    add_effort_options(parser, each="a query")
    parser.add_argument(
        "--spec",
        dest="specs",
        metavar="FILE",
        action="append",
        type=Path,
        default=[],
        help="a specification file that the claims were made with; may be repeated",
    )
    add_working_options(parser)
    add_json_option(parser)


@dataclass(frozen=True)
class Job:
    path: Path
    specs: tuple[Path, ...]
    solver: str
    effort: Effort


def run(args: argparse.Namespace) -> int:
    from roadproof.evidence.finding import Outcome, exit_code, summary
    from roadproof.evidence.folder import conclude, survey
    from roadproof.prove.properties import find_label
    from roadproof.solve.smt import ask

    ask("(set-logic QF_UF)(check-sat)", args.solver)  # a solver that is missing is said once, before any work
    surveyed = survey(args.paths, tuple(args.specs), find_label)
    effort = read_effort(args)
    jobs = [Job(path, specs, args.solver, effort) for path, specs in surveyed.files.items()]
    found = dict(
        zip(surveyed.files, work_in_order(examine, jobs, args.jobs, "files", undecided), strict=True)
    )
    findings = list(conclude(surveyed, found))
    if args.json != "-":
        for path in (path for told in surveyed.told for path in told.specs):
            print(f"read with {path}")
        print("\n".join(map(str, findings)))
        print(summary(findings, args.solver))
    if args.json:
        entries = [{**asdict(x), "accepted": x.outcome is Outcome.ACCEPTED} for x in findings]
        write_json({"schema": SCHEMA, "solver": args.solver, "findings": entries}, args.json)
    return exit_code(findings)


def undecided(job: Job, reason: str) -> "Finding":
    """The finding on a file that nothing is known of."""
    from roadproof.evidence.finding import Finding, Outcome

    return Finding(str(job.path), "", Outcome.UNDECIDED, reason)


def examine(job: Job) -> "Finding":
    """Check one file by what its schema says that it is."""
    from roadproof.evidence.checking import Checker
    from roadproof.prove.properties import find_label
    from roadproof.solve.smt import ask
    from roadproof.spec.library import load_library

    def answer(script: str) -> str:
        return ask(script, job.solver, job.effort.meter())

    return Checker(load_library(job.specs), answer, find_label).check(job.path)
