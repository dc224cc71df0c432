"""``roadproof prove``: claims over dense time, for all horizons and parameter values, with certificates."""

import argparse
import re
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

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
from roadproof.cli.prove_answers import Answered, as_data, details, line, table
from roadproof.cli.prove_files import ProofFolder
from roadproof.cli.working import add_working_options, work_in_order
from roadproof.errors import UsageError
from roadproof.files import hold_if_any
from roadproof.verdict import Verdict, exit_code

if TYPE_CHECKING:
    from roadproof.effort import Effort
    from roadproof.prove.properties import Task
    from roadproof.spec.library import Specification
    from roadproof.witness.question import Means, Setting

SUMMARY = "prove claims for all time, or refute them; without a claim, the template properties"
SCHEMA = "roadproof/verdicts/1"
_PROPERTY = re.compile(r"[A-Z]\d+")
_SCENARIOS = re.compile(r"(scenario_)?\d[\d,\s-]*")

_EXAMPLES = """\
examples:
  roadproof prove                                     all template properties and negative controls
  roadproof prove P1 P4 --set base                    some of them
  roadproof prove 4                                   what the list says of scenario 4; also 1-3 or scenario_4
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
    parser.add_argument(
        "claims", metavar="CLAIM", nargs="*", help="a formula, a property such as P1, or a scenario such as 4"
    )
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
        "--dt", metavar="S", help="with smt, milp: seconds a sample (default: the coarsest that fits)"
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
    tasks, how = _asked(args)
    with hold_if_any(args.out):
        return _settle_all(args, tasks, how, begun)


def _settle_all(args: argparse.Namespace, tasks: "list[Task]", how: "How", begun: float) -> int:
    own = not tasks[0].title
    folder = None if args.out is None else ProofFolder(args.out, chosen_options(args), args.specs)
    found: list[Answered] = []
    doubt = partial(undecided, how)
    for answer in work_in_order(partial(settle, how), tasks, args.jobs, "claims", doubt):
        found.append(answer)
        if folder is not None:
            folder.add(answer)
        if args.json != "-" and (own or args.verbose):
            clear()
            print(details(answer) if own else line(answer), flush=True)
    if args.json != "-" and not own:
        print(table(found))
        print(f"{len(found)} claims in {time.monotonic() - begun:.1f} s")
    if args.json:
        files = {} if folder is None else folder.files
        verdicts = [as_data(x, files.get(x.task.name)) for x in found]
        write_json({"schema": SCHEMA, "verdicts": verdicts}, args.json)
    return exit_code((x.verdict, x.expected) for x in found)


@dataclass(frozen=True)
class How:
    """How the claims of a run are settled; processes that are forked know it from the start.

    ``within``: where and by whom drives are looked for that refute a claim up to a horizon.
    """

    specifications: "Mapping[str, Specification]"
    effort: "Effort"
    seek_drive: bool
    within: "tuple[Setting, Means] | None"


def settle(how: How, task: "Task") -> Answered:
    """One claim settled: in dense time, or within bounds."""
    from roadproof.spec.elaborate import read_claim
    from roadproof.witness import settle as ways
    from roadproof.witness.ask import Search

    specification = how.specifications[task.set_name]
    query = read_claim(specification, task.claim)
    if how.within is not None:
        return Answered(task, ways.settle_bounded(Search(specification, query, *how.within)))
    label = task.id + (f"-{task.part}" if task.part else "")
    return Answered(task, ways.settle(specification, query, how.effort, label, task.scenario, how.seek_drive))


def undecided(how: How, task: "Task", reason: str) -> Answered:
    """What is said of a claim that nothing is known of."""
    from roadproof.witness.settle import in_doubt

    return Answered(task, replace(in_doubt(reason), bounded=how.within is not None))


# --- what is asked -------------------------------------------------------------------------------


def _asked(args: argparse.Namespace) -> "tuple[list[Task], How]":
    from roadproof.prove.properties import choose, template_properties
    from roadproof.spec.elaborate import read_claim
    from roadproof.spec.scenarios import read_numbers

    library = load_library_of(args)
    options = chosen_options(args)
    named = [claim for claim in args.claims if _PROPERTY.fullmatch(claim)]
    about = [claim for claim in args.claims if _SCENARIOS.fullmatch(claim)]
    own = _own_claims(args, [claim for claim in args.claims if claim not in (*named, *about)])
    if (named or about) and own:
        raise UsageError("ask for properties or for claims of your own, not for both at once")
    home = library.select(args.set_name or "base", options)
    numbers = sorted({number for text in about for number in read_numbers(home, text)})
    tasks = own or choose(template_properties(), named, args.set_name, numbers)
    if not tasks:
        asked = ", ".join([*named, *about])
        raise UsageError(f"no claim of {asked} is stated for set={args.set_name or 'any'}: ask for others")
    specifications = {name: library.select(name, options) for name in {task.set_name for task in tasks}}
    for task in own:
        read_claim(specifications[task.set_name], task.claim)
    return tasks, How(specifications, read_effort(args), not args.no_drive, _within(args, bool(own)))


def _own_claims(args: argparse.Namespace, given: "list[str]") -> "list[Task]":
    from roadproof.prove.properties import OWN, Task, read_claims

    texts = given + (read_claims(args.file) if args.file is not None else [])
    if args.file is not None and not texts:
        raise UsageError(f"{args.file} holds no claim: write one a paragraph")
    parts = [str(number) if len(texts) > 1 else "" for number in range(1, len(texts) + 1)]
    set_name, expected = args.set_name or "base", Verdict(args.expect)
    return [
        Task(OWN, part, "", None, set_name, text, expected) for part, text in zip(parts, texts, strict=True)
    ]


def _within(args: argparse.Namespace, own: bool) -> "tuple[Setting, Means] | None":
    """Where and by whom is searched with --engine smt or milp, None in dense time."""
    from roadproof.witness.question import Means, Setting
    from roadproof.world.models import load_road

    if args.engine == "dense":
        return None
    if not own:
        raise UsageError(f"--engine {args.engine} is for claims of your own: the list is about all time")
    road = None if args.road is None else load_road(args.road)
    horizon = read_seconds("--horizon", args.horizon)
    dt = None if args.dt is None else read_seconds("--dt", args.dt)
    setting = Setting(road=road, horizon=horizon, dt=dt)
    return setting, Means("any", args.engine, effort=read_effort(args))
