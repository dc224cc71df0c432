"""``roadproof classify``: classes of scenarios that exclude each other and together cover the same."""

import argparse
import time
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.cli.evidence import evidence_folder
from roadproof.cli.numbers import add_effort_options, read_effort
from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    chosen_options,
    load_library_of,
    parameter_values,
)
from roadproof.cli.progress import tell
from roadproof.cli.working import add_working_options, work, work_in_order
from roadproof.effort import Late
from roadproof.errors import UsageError
from roadproof.files import make_folder
from roadproof.verdict import ExitCode, Verdict, exit_code

if TYPE_CHECKING:
    from roadproof.analysis.classify.cells import Axis, Cell
    from roadproof.analysis.classify.classes import Class, Classes, Plan
    from roadproof.analysis.classify.drives import Example
    from roadproof.analysis.classify.shares import Shares
    from roadproof.analysis.classify.text import Claim
    from roadproof.analysis.requests import Asked
    from roadproof.prove.prover import Result
    from roadproof.spec.library import Specification
    from roadproof.traffic.recording import Recording

SUMMARY = "classes of scenarios, proved to exclude each other and to cover the same, with their shares"
SEED, SECONDS = 1, 600.0
CLAIMS_IN_A_JOB = 8

_EXAMPLES = """\
examples:
  roadproof classify --out classes                    scenarios 1-24 of base: what happens, and where
  roadproof classify --among 1-8 --out classes        those of the main road
  roadproof classify --set ext --on highd/data        shares on recordings of yours
  roadproof prove --spec classes/classes.spec --set classes --claims classes/claims.txt
  roadproof witness 'class_4_8_main(SV,POV,L)' --spec classes/classes.spec --set classes --road main-2

A class is a choice of scenarios that hold together on one trace, for the same vehicles and lane, while the
others do not. Choices that are proved impossible are left out. Classes of SV and POV and of SV, POV1, POV2
are kept apart. Evidence goes to DIR, or with --json FILE alone to FILE-evidence; `roadproof check DIR`
checks it. Exit code 20 where a claim is not proved or a class has no drive.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser)
    add_parameter_option(parser)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1-8")
    parser.add_argument("--on", type=Path, metavar="DIR", help="recordings (default: simulated for this)")
    parser.add_argument("--no-shares", action="store_true", help="no recordings, so no shares")
    add_effort_options(parser, 60.0, "a drive or a proof")
    add_working_options(parser)
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="write classes.spec, claims, evidence, picture"
    )
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no picture")
    add_json_option(parser)


@dataclass(frozen=True)
class Refining:
    """One cell that is to be said with few words."""

    asked: "Asked"
    axis: "Axis"
    holds: tuple[int, ...]
    others: tuple[int, ...]


@dataclass(frozen=True)
class Settling:
    """Classes that want drives, or claims that want proofs, about the classes that ``text`` defines."""

    asked: "Asked"
    text: str
    plan: "Plan"
    classes: "tuple[Class, ...]"
    claims: "tuple[Claim, ...]"


@dataclass(frozen=True)
class Settled:
    examples: "tuple[Example, ...]" = ()
    proofs: "tuple[tuple[Claim, Result], ...]" = ()


def run(args: argparse.Namespace) -> int:
    from roadproof.analysis.classify.classes import plan_of
    from roadproof.analysis.classify.text import claims_of, with_classes, write_classes
    from roadproof.cli.classify_output import Answers, as_data, summary, write
    from roadproof.report.classify import as_table
    from roadproof.spec.scenarios import numbers_of, read_numbers

    begun = time.monotonic()
    asked = _asked(args)
    _, specification = asked.load()
    numbers = read_numbers(specification, args.among) if args.among else numbers_of(specification)
    plan = plan_of(specification, numbers)
    folder = evidence_folder(args.out, args.json)
    if folder is not None:
        make_folder(folder)
    source, recordings = _recordings(args)
    classes, empty = _divide(asked, plan, args.jobs)
    text = write_classes(classes, specification, [path.name for path in asked.specs])
    shares = None
    if not args.no_shares:
        tell(f"shares on {source}")
        in_force = with_classes(text, specification)
        shares = count_on(classes, in_force, asked, recordings)
    examples, proofs = _settle(asked, text, classes, claims_of(classes, empty), args.jobs)
    answers = Answers(asked, specification, classes, text, examples, proofs, shares, source)
    data, files = as_data(answers, folder, time.monotonic() - begun)
    write(data, files, folder, args)
    if args.json != "-":
        print(as_table(data))
        print("\n".join(summary(data)))
    verdicts = [Verdict(x["verdict"]) for x in (*data["classes"], *data["claims"])]
    code = exit_code((_for_exit(verdict), Verdict.PROVED) for verdict in verdicts)
    return max(code, ExitCode.CROSSCHECK_FAILED) if shares is not None and shares.broken else code


def _for_exit(verdict: Verdict) -> Verdict:
    """A class without a drive is in doubt, whatever the limits of the search; a vacuous claim holds."""
    if verdict in (Verdict.WITNESSED, Verdict.VACUOUS):
        return Verdict.PROVED
    return Verdict.UNKNOWN if verdict is Verdict.NONE_WITHIN else verdict


def _asked(args: argparse.Namespace) -> "Asked":
    from roadproof.analysis.requests import Asked

    if args.on is not None and args.no_shares:
        raise UsageError("--on and --no-shares: shares are counted on recordings; leave out one of the two")
    library = load_library_of(args)
    specification = library.select(args.set_name, chosen_options(args))
    return Asked(
        (args.set_name,),
        options=specification.options,
        specs=tuple(args.specs),
        values=parameter_values(args, library),
        effort=read_effort(args),
    )


def _recordings(args: argparse.Namespace) -> "tuple[str, Iterator[Recording]]":
    """What the shares are counted on, in words, and the recordings one by one."""
    if args.on is not None:
        from roadproof.traffic.sources import find_sources

        sources = find_sources(args.on)
        return str(args.on), (source.read() for source in sources)
    return f"a simulated recording of {SECONDS:g} s, seed {SEED}", _simulated()


def _simulated() -> "Iterator[Recording]":
    from roadproof.traffic.simulate import Traffic
    from roadproof.traffic.synthetic import simulate

    yield simulate(Traffic(seconds=SECONDS), SEED)


def count_on(
    classes: "Classes", specification: "Specification", asked: "Asked", recordings: "Iterator[Recording]"
) -> "Shares":
    """The shares of the classes of ``specification`` on recordings, under the values that were asked for."""
    from roadproof.analysis.classify.shares import count_shares
    from roadproof.spec.bind import default_values

    values = {**default_values(specification.library), **asked.values}
    return count_shares(classes, specification, values, recordings)


def _divide(
    asked: "Asked", plan: "Plan", processes: int | None
) -> "tuple[Classes, dict[tuple[str, ...], tuple[str, ...]]]":
    """The cells of every axis of a plan, and the claims why there are no more, by vehicles."""
    from roadproof.analysis.classify.cells import outline
    from roadproof.analysis.classify.classes import Classes, what_axis, where_axis

    _, specification = asked.load()
    axes = [what_axis(plan, group, specification) for group in plan.groups]
    if plan.has_places:
        axes.append(where_axis(plan, plan.groups[0].vehicles))
    outlines = [outline(axis, specification, asked.effort.of(asked.proof)) for axis in axes]
    jobs = [
        Refining(asked, axis, *cell) for axis, made in zip(axes, outlines, strict=True) for cell in made.cells
    ]
    cells: list[Cell] = []
    with closing(work_in_order(refine_one, jobs, processes, "cells")) as answers:
        for cell in answers:
            cells.append(cell)
    waiting = iter(cells)
    by_axis = [tuple(next(waiting) for _ in made.cells) for made in outlines]
    count = len(plan.groups)
    empty = {group.vehicles: made.empty for group, made in zip(plan.groups, outlines, strict=False)}
    if plan.has_places:
        first = plan.groups[0].vehicles
        empty[first] = (*empty[first], *outlines[-1].empty)
    return Classes(plan, tuple(by_axis[:count]), by_axis[-1] if plan.has_places else ()), empty


def refine_one(job: Refining) -> "Cell":
    """One cell with few words."""
    from roadproof.analysis.classify.cells import refine

    return refine(job.axis, job.asked.load()[1], job.holds, job.others, job.asked.effort)


def _settle(
    asked: "Asked", text: str, classes: "Classes", claims: "Sequence[Claim]", processes: int | None
) -> "tuple[dict[str, Example], list[tuple[Claim, Result]]]":
    """A drive for each class, by its name, and the verdict on each claim, in order."""
    groups = [
        tuple(one for one in classes.of(group) if one.what == cell)
        for group, cells in zip(classes.plan.groups, classes.what, strict=True)
        for cell in cells
    ]
    few = [tuple(claims[k : k + CLAIMS_IN_A_JOB]) for k in range(0, len(claims), CLAIMS_IN_A_JOB)]
    jobs = [Settling(asked, text, classes.plan, those, ()) for those in groups]
    jobs += [Settling(asked, text, classes.plan, (), those) for those in few]
    examples: dict[str, Example] = {}
    proofs: dict[str, tuple[Claim, Result]] = {}
    with closing(work(settle, jobs, processes, "groups of drives and claims", undecided)) as answers:
        for settled in answers:
            examples |= {example.name: example for example in settled.examples}
            proofs |= {claim.name: (claim, result) for claim, result in settled.proofs}
    return examples, [proofs[claim.name] for claim in claims]


def undecided(job: Settling, reason: str) -> Settled:
    """What is said of classes and claims that nothing is known of."""
    from roadproof.analysis.classify.drives import Example
    from roadproof.prove.prover import Result

    return Settled(
        tuple(Example(one.name, Verdict.UNKNOWN, reason, None) for one in job.classes),
        tuple((claim, Result(Verdict.UNKNOWN, reason, 0.0)) for claim in job.claims),
    )


def settle(job: Settling) -> Settled:
    """The drives or the proofs of one job."""
    from roadproof.analysis.classify.drives import find_examples
    from roadproof.analysis.classify.text import with_classes
    from roadproof.prove.prover import Result, prove
    from roadproof.spec.elaborate import read_claim

    if job.classes:
        return Settled(examples=tuple(find_examples(job.asked, job.text, job.plan, job.classes)))
    specification = with_classes(job.text, job.asked.load()[1])

    def decide(claim: "Claim") -> Result:
        try:
            return prove(specification, read_claim(specification, claim.text), job.asked.effort, claim.name)
        except Late as late:
            return Result(Verdict.UNKNOWN, str(late), late.seconds)

    return Settled(proofs=tuple((claim, decide(claim)) for claim in job.claims))
