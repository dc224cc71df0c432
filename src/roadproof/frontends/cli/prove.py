"""``roadproof prove``: claims over dense time, for all horizons and parameter values, with certificates."""

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.frontends.cli.basis import in_order, read_definitions, study_keywords
from roadproof.frontends.cli.options import write_build_results, write_json
from roadproof.frontends.cli.progress import Counter, clear, tell_road, tell_stage
from roadproof.frontends.cli.streams import print_at_once
from roadproof.frontends.settings.questions import Prove
from roadproof.runtime.progress import listening

if TYPE_CHECKING:
    from roadproof.engines.prove.properties import WrittenClaim
    from roadproof.frontends.report.cases import Location
    from roadproof.questions.prove import ClaimResult, ProveQuestion

SUMMARY = "prove claims for all time, or refute them"

EXAMPLES = """\
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
OPTIONS = Prove


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "claims", metavar="CLAIM", nargs="*", help="a formula, a property such as P1, or a scenario such as 4"
    )


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from roadproof.frontends.api.proofs import Proofs
    from roadproof.frontends.report.claims import details, line

    given = Prove.of(study_keywords(args, Prove))
    question = _question(args, given)

    def show(name: str, result: "ClaimResult") -> None:
        clear()
        print_at_once(details(result, question) if question.are_own else line(result), args.out is not None)

    each = None
    if args.json != "-" and (question.are_own or args.verbose):
        each = in_order((x.name for x in question.tasks), show)
    with listening(tell_stage if len(question.tasks) == 1 else None):
        proofs = Proofs.of(question, given, each)
    if args.json != "-" and not question.are_own:
        print(proofs)
    if given.kernel is not None:
        proofs = proofs.put_to_kernel(given.kernel, given.jobs, Counter())
        if args.json != "-":
            print(proofs.kernel_text())
    write_build_results(args, replace(proofs, places=_places(args, question)))
    if args.json:
        write_json(proofs.as_data(), args.json)
    tell_road(proofs.road)
    return proofs.exit_code


def _question(args: argparse.Namespace, given: Prove) -> "ProveQuestion":
    from roadproof.frontends.api.proofs import prove_question
    from roadproof.library.motion import read_assumed_claim

    home = read_definitions(args, Prove)
    written = _written(args)
    if args.file is not None and not (written or args.claims):
        raise UsageError(f"{args.file} contains no claim: write one per paragraph")
    what = [*args.claims, *(read_assumed_claim(home.specification, x.text) for x in written)]
    return prove_question(home, what, args.sets[0] if args.sets else None, given)


def _written(args: argparse.Namespace) -> "list[WrittenClaim]":
    """The claims of the file of ``--claims``, which are asked last."""
    from roadproof.engines.prove.properties import read_claims

    return [] if args.file is None else read_claims(args.file)


def _places(args: argparse.Namespace, question: "ProveQuestion") -> "dict[str, Location]":
    """Return where the claims of a file are written, by ``task.name``."""
    written = _written(args)
    if not written:
        return {}
    from roadproof.frontends.report.cases import Location

    tasks = question.tasks[len(question.tasks) - len(written) :]
    places = (Location(str(args.file), x.at.line, x.at.column) for x in written)
    return dict(zip((x.name for x in tasks), places, strict=True))
