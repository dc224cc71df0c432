"""``roadproof order``: which scenarios imply which, with a certificate or a drive for every answer."""

import argparse
import time
from collections.abc import Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from itertools import permutations
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.evidence import Evidence, read_drive, said_once, write_index
from roadproof.cli.numbers import add_effort_options, read_effort
from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    chosen_options,
    load_library_of,
    parameter_values,
    write_json,
    write_text,
)
from roadproof.cli.progress import tell
from roadproof.cli.working import add_working_options, work
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.analysis.journal import Journal
    from roadproof.analysis.order.deciding import Decided
    from roadproof.analysis.order.kinds import Kind
    from roadproof.analysis.requests import Asked
    from roadproof.spec.scenarios import Scenario

SUMMARY = "which scenarios imply which: proofs for the implications, drives against the others"
SCHEMA = "roadproof/order/1"

_EXAMPLES = """\
examples:
  roadproof order --out order                    all scenarios of base, extA and ext; DOT, SVG, evidence
  roadproof order --set base --set ext --among 1-8

a -> b: whenever a holds, so does b, with the same roles and the same L. Scenario 2 implies one with two
vehicles if it does so for one of its POVs. `roadproof check DIR` checks the evidence again.
A run with --out that was broken off goes on where it was.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser, "base, extA, ext", several=True)
    add_parameter_option(parser)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1,3-8")
    add_effort_options(parser, 120.0, "a drive")
    add_working_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates, drives, DOT and SVG")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no picture")
    add_json_option(parser)


@dataclass(frozen=True)
class Job:
    asked: "Asked"
    kinds: "tuple[Kind, ...]"
    family: "tuple[Kind, ...]"


def run(args: argparse.Namespace) -> int:
    begun = time.monotonic()
    asked, kinds = _asked(args)
    said = {"sets": list(asked.sets), **said_once(asked, args.out)}
    answers = _settle(asked, kinds, args.out, said, args.jobs)
    data = _as_data(asked, said, kinds, answers)
    data["seconds"] = round(time.monotonic() - begun, 1)
    if args.json:
        write_json(data, args.json)
    if args.out is not None:
        _write_pictures(data, args.out, not args.no_pictures)
    if args.json != "-":
        _print(data)
    return ExitCode.UNKNOWN if data["doubts"] else ExitCode.AS_EXPECTED


def _asked(args: argparse.Namespace) -> "tuple[Asked, tuple[Kind, ...]]":
    from roadproof.analysis.order.kinds import kinds_of
    from roadproof.analysis.requests import Asked
    from roadproof.spec.scenarios import read_numbers

    library = load_library_of(args)
    sets = tuple(dict.fromkeys(args.set_names or ["base", "extA", "ext"]))
    options = chosen_options(args)
    for name in sets:
        library.select(name, options)
    asked = Asked(
        sets,
        options=options,
        specs=tuple(args.specs),
        values=parameter_values(args, library),
        effort=read_effort(args),
    )
    numbers = read_numbers(library.select(sets[0], options), args.among) if args.among else None
    return asked, kinds_of(asked, numbers)


def _settle(
    asked: "Asked",
    kinds: "tuple[Kind, ...]",
    folder: Path | None,
    said: Mapping[str, Any],
    processes: int | None,
) -> list[dict[str, Any]]:
    """The answers for every family of kinds; those that a journal holds are not asked again.

    Doubts are left to the end, when the drives of all families are there to settle them.
    """
    from roadproof.analysis.journal import Journal, Question
    from roadproof.analysis.order.deciding import settle_doubts
    from roadproof.analysis.order.kinds import families_of

    families = {str(family[0].node): family for family in families_of(kinds)}
    journal = None
    if folder is not None:
        more = {"order": " ".join(str(kind.node) for kind in kinds), **asked.question()}
        journal = Journal(folder, Question(SCHEMA, said, more, asked.load()[0]))
    known = {x["family"]: x for x in (journal.answers() if journal is not None else [])}
    jobs = [Job(asked, kinds, family) for name, family in families.items() if name not in known]
    doubtful: dict[str, Decided] = {}
    with closing(work(settle, jobs, processes, "families of scenarios", known=len(known))) as answers:
        for family, decided in answers:
            if decided.doubts:
                doubtful[family] = decided
            else:
                known[family] = _record(family, decided, journal)
    if doubtful:
        tell(f"{len(doubtful)} families in doubt: trying the drives of the others")
        sure = [known[name] for name in families if name in known]
        unsure = [(name, doubtful[name]) for name in families if name in doubtful]
        drives = [*_drives(sure), *(x.data for _, decided in unsure for x in decided.drives)]
        for family, decided in unsure:
            known[family] = _record(family, settle_doubts(asked, decided, drives), journal)
    return [known[name] for name in families]


def settle(job: Job) -> "tuple[str, Decided]":
    """What is found for one family, which has the name of its first node."""
    from roadproof.analysis.order.deciding import decide_family

    return str(job.family[0].node), decide_family(job.asked, job.kinds, job.family)


def _drives(answers: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The drive files of recorded answers."""
    return [read_drive(drive["drive"]) for answer in answers for drive in answer["drives"]]


def _record(family: str, decided: "Decided", journal: "Journal | None") -> dict[str, Any]:
    """The answers for a family as plain data; evidence in files, or inside where there is no folder."""
    evidence = Evidence(journal)
    edges = []
    for edge in decided.edges:
        name = f"edge-{_file(edge.above)}-{_file(edge.below)}.json"
        names = {"from": str(edge.above), "to": str(edge.below), "claim": edge.claim}
        edges.append({**names, "certificate": evidence.certificate(name, edge.certificate)})
    drives = []
    for number, drive in enumerate(decided.drives, 1):
        kept = evidence.drive(f"drive-{_file(drive.node)}-{number}.json", drive.data)
        others = sorted({str(node) for node in drive.others})
        drives.append({"holds": str(drive.node), "fails": others, "drive": kept})
    doubts = [{"from": str(x.above), "to": str(x.below), "reason": x.reason} for x in decided.doubts]
    answer = {"family": family, "proved": edges, "drives": drives, "doubts": doubts}
    if journal is not None:
        journal.add({"evidence": [] if doubts else evidence.files, **answer})
    return answer


def _file(node: "Scenario") -> str:
    return f"{node.set_name}-{node.number:02}"


def _as_data(
    asked: "Asked",
    said: Mapping[str, Any],
    kinds: "tuple[Kind, ...]",
    answers: Sequence[Mapping[str, Any]],
) -> dict[str, Any]:
    """All answers together: the edges of the Hasse diagram, and for the other pairs what refutes them."""
    from roadproof.analysis.order.relation import reachable, transitive_reduction

    proved = [edge for answer in answers for edge in answer["proved"]]
    pairs = {(edge["from"], edge["to"]) for edge in proved}
    doubts = [
        doubt
        for answer in answers
        for doubt in answer["doubts"]
        if doubt["to"] not in reachable(doubt["from"], pairs)
    ]
    drives = [
        {"number": number, **drive}
        for number, drive in enumerate((drive for answer in answers for drive in answer["drives"]), 1)
    ]
    names = [str(kind.node) for kind in kinds]
    reduced = transitive_reduction(pairs)
    return {
        "schema": SCHEMA,
        **said,
        "view": "dense",
        "kinds": [[str(node) for node in kind.nodes] for kind in kinds],
        "proved": proved,
        "edges": [edge for edge in proved if (edge["from"], edge["to"]) in reduced],
        "missing": _missing(names, pairs, drives, {(x["from"], x["to"]) for x in doubts}),
        "drives": drives,
        "doubts": doubts,
    }


def _missing(
    names: Sequence[str],
    proved: set[tuple[str, str]],
    drives: Sequence[Mapping[str, Any]],
    doubtful: set[tuple[str, str]],
) -> list[dict[str, Any]]:
    """The pairs of kinds without implication, with the numbers of the drives that show it."""
    from roadproof.analysis.order.relation import reachable

    refuting: dict[tuple[str, str], list[int]] = {}
    for drive in drives:
        for other in drive["fails"]:
            refuting.setdefault((drive["holds"], other), []).append(drive["number"])
    implied = {(above, below) for above in names for below in reachable(above, proved)}
    return [
        {"from": above, "to": below, "drives": refuting[above, below]}
        for above, below in permutations(names, 2)
        if (above, below) not in implied | doubtful
    ]


def _write_pictures(data: Mapping[str, Any], folder: Path, pictures: bool) -> None:
    from roadproof.files import write_whole
    from roadproof.report.order import as_dot, draw_order

    write_index(folder, data)
    write_text(folder / "order.dot", as_dot(data["kinds"], data["edges"]))
    if pictures:
        title = f"implications in {', '.join(data['sets'])}; an arrow leads to what is implied"
        for kind, content in draw_order(data["kinds"], data["edges"], title).items():
            write_whole(folder / f"order.{kind}", content)


def _print(data: Mapping[str, Any]) -> None:
    shared = [kind for kind in data["kinds"] if len(kind) > 1]
    for edge in data["edges"]:
        print(f"{edge['from']} -> {edge['to']}")
    for kind in shared:
        print(f"one formula: {', '.join(kind)}")
    for doubt in data["doubts"]:
        print(f"in doubt: {doubt['from']} -> {doubt['to']}: {doubt['reason']}")
    count = sum(len(kind) for kind in data["kinds"])
    print(
        f"{count} scenarios, {len(data['kinds'])} formulas: {len(data['edges'])} edges proved, "
        f"{len(data['missing'])} implications refuted by {len(data['drives'])} drives, "
        f"{len(data['doubts'])} in doubt, in {data['seconds']:.1f} s"
    )
