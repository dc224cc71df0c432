"""``roadproof prove``: claims over dense time, for all horizons and parameter values, with certificates."""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.frontends.cli.basis import in_order, read_definitions
from roadproof.frontends.cli.numbers import add_effort_options, read_effort
from roadproof.frontends.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    write_json,
)
from roadproof.frontends.cli.progress import Counter, clear, tell_stage, warn
from roadproof.frontends.cli.streams import print_at_once
from roadproof.frontends.settings.flags import add_flags
from roadproof.frontends.settings.groups import Workers
from roadproof.frontends.settings.readers import named, read_seconds
from roadproof.runtime.progress import listening
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.analysis.claims import ClaimResult, Claims

SUMMARY = "prove claims for all time, or refute them"

_EXAMPLES = """\
examples:
  roadproof prove                                     all template properties and negative controls
  roadproof prove P1 P4 --set base                    some of them
  roadproof prove 4                                   scenario 4, deceleration ahead; also 1-3 or scenario_4
  roadproof prove 'scenario_8(SV,POV,L) -> F danger(SV,POV)' --set ext
  roadproof prove 'scenario_4(SV,POV,L) -> scenario_4@ext(SV,POV,L)'
  roadproof prove 'given A, B: vehicle: danger(A,B) -> danger(B,A)' --out proofs
  roadproof prove --claims mine.txt --json -          one claim a paragraph
  roadproof prove 'danger(SV,POV) -> G[0, 0.6 s] rssViolation(SV,POV)' --param minDanger=0.6
  roadproof prove 1-8 --declared --out declared       at the declared values of all parameters
  roadproof prove 4 --kernel coq                      each proof is put to the kernel of Coq, too
  roadproof prove --assume motion 'G v_lon(SV) <= v_lon(POV) and s(SV) < s(POV) -> G s(SV) < s(POV)'
  roadproof prove 'dangerArises(SV,POV) -> F aheadOf(SV,POV)' --engine smt --horizon 3 --dt 3/5

A claim is about all traces, all roads, all vehicle sizes and all parameter values within their declared
bounds. PROVED comes with a certificate, which `roadproof check` accepts; REFUTED with a counterexample: a
drive, or a trace that may jump. With --assume motion a claim is about all motions: places and speeds are
continuous, speeds the rates of places, lanes are left through their edge; then only a drive refutes. A claim
may say so itself: 'assuming motion: CLAIM'. With --param or --declared a claim is about these values of
parameters alone, as in 'at minDanger = 0.6 s: CLAIM'; its verdict and its certificate say so.
With --engine smt or milp a claim is about drives on one road, up to a horizon: PROVED-BOUNDED says which.
A folder of --out grows: what it has evidence for is not asked again, also where a run was broken off.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "claims", metavar="CLAIM", nargs="*", help="a formula, a property such as P1, or a scenario such as 4"
    )
    parser.add_argument("--claims", dest="file", type=Path, metavar="FILE", help="claims from a file")
    add_specification_options(parser, None)
    add_parameter_option(parser)
    parser.add_argument(
        "--declared",
        action="store_true",
        help="at the declared values of all other parameters, and not for all values",
    )
    parser.add_argument(
        "--expect",
        choices=[str(Verdict.PROVED), str(Verdict.REFUTED)],
        default=str(Verdict.PROVED),
        help="verdict that is expected of your own claims (default: PROVED)",
    )
    parser.add_argument(
        "--assume",
        choices=("motion",),
        help="your claims are about traces that are motions of vehicles",
    )
    parser.add_argument(
        "--vehicle",
        dest="vehicles",
        metavar="[NAME=]MODEL",
        action="append",
        default=[],
        help="with --assume motion or an engine: within the limits of a model, for all vehicles or for one",
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
    parser.add_argument(
        "--road", metavar="R", help="with smt, milp: a reference road, or a .toml or .xodr file"
    )
    parser.add_argument(
        "--kernel", choices=("coq",), help="put each proof to the kernel of Coq, too, with coqc"
    )
    add_flags(parser, Workers)
    parser.add_argument(
        "--no-drive", action="store_true", help="do not look for a drive that refutes a claim"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates and an index")
    parser.add_argument("--verbose", action="store_true", help="a line for every claim of the list")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.analysis.claims import name_of
    from roadproof.frontends.api.proofs import Proofs, ask_kernel
    from roadproof.frontends.report.claims import details, line

    asked = _asked(args)
    if args.kernel is not None:
        ask_kernel(args.kernel, args.engine)

    def show(name: str, answer: "ClaimResult") -> None:
        clear()
        print_at_once(details(answer, asked) if asked.are_own else line(answer), args.out is not None)

    each = None
    if args.json != "-" and (asked.are_own or args.verbose):
        each = in_order(map(name_of, asked.tasks), show)
    with listening(tell_stage if len(asked.tasks) == 1 else None):
        found = Proofs.asked(asked, args.out, args.jobs, Counter(), warn, each)
    if args.json != "-" and not asked.are_own:
        print(found)
    if args.kernel is not None:
        found = found.put_to_kernel(args.jobs, Counter())
        if args.json != "-":
            print(found.kernel_text())
    if args.json:
        write_json(found.as_data(), args.json)
    return found.exit_code


def _asked(args: argparse.Namespace) -> "Claims":
    from roadproof.engines.prove.properties import read_claims
    from roadproof.frontends.api.proofs import assuming, claims_of, values_put_in, within_limits
    from roadproof.library.motion import read_under
    from roadproof.verdict import claim_verdict

    home = read_definitions(args, [args.set_name or "base"])
    written = [] if args.file is None else read_claims(args.file)
    if args.file is not None and not (written or args.claims):
        raise UsageError(f"{args.file} holds no claim: write one a paragraph")
    what = [*args.claims, *(read_under(home.specification, claim) for claim in written)]
    values = values_put_in(home, args.declared) if args.engine == "dense" else {}
    models = dict(map(named(""), args.vehicles))
    said = assuming(args.assume, models if args.engine == "dense" else None, values)
    asked = claims_of(home, what, args.set_name, claim_verdict(args.expect), said)
    asked = replace(asked, effort=read_effort(args), seek_drive=not args.no_drive)
    if args.engine == "dense":
        return asked
    if not asked.are_own:
        raise UsageError(f"--engine {args.engine} is for claims of your own: the list is about all time")
    horizon = read_seconds("--horizon", args.horizon)
    dt = None if args.dt is None else read_seconds("--dt", args.dt)
    return within_limits(asked, home, args.engine, args.road, horizon, dt, models)
