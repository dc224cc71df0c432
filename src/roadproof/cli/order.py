"""``roadproof order``: which scenarios imply which, with a certificate or a drive for every answer."""

import argparse
import json
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

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
from roadproof.cli.working import tell
from roadproof.errors import UsageError
from roadproof.files import make_folder
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.analysis.meeting import Node
    from roadproof.analysis.order import Order

SUMMARY = "which scenarios imply which: proofs for the implications, drives against the others"
SCHEMA = "roadproof/order/1"

_EXAMPLES = """\
examples:
  roadproof order --out order                    all scenarios of base, extA and ext; DOT, SVG, evidence
  roadproof order --set base --set ext --among 1-8

a -> b: whenever a holds, so does b, with the same roles and the same L. Scenario 2 implies one with two
vehicles if it does so for one of its POVs. `roadproof check DIR` checks the evidence again.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser, "base, extA, ext", several=True)
    add_parameter_option(parser)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1,3-8")
    parser.add_argument(
        "--timeout", type=float, default=120.0, metavar="S", help="seconds for one drive (default: 120)"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates, drives, DOT and SVG")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no picture")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.analysis.meeting import read_numbers
    from roadproof.analysis.order import find_order
    from roadproof.analysis.overlap import Asked

    begun = time.monotonic()
    library = load_library_of(args)
    sets = tuple(dict.fromkeys(args.set_names or ["base", "extA", "ext"]))
    options = chosen_options(args)
    if not args.timeout > 0:
        raise UsageError(f"--timeout {args.timeout} must be greater than 0")
    for name in sets:
        library.select(name, options)
    if args.out is not None:
        make_folder(args.out)
    asked = Asked(
        sets,
        options=options,
        specs=tuple(args.specs),
        values=parameter_values(args, library),
        timeout=args.timeout,
    )
    numbers = read_numbers(args.among, library.select(sets[0], options)) if args.among else None
    found = find_order(asked, numbers, tell)
    tell("all decided" if not found.doubts else f"{len(found.doubts)} in doubt", last=True)
    data = _as_data(found, args.out)
    data["seconds"] = round(time.monotonic() - begun, 1)
    if args.json:
        write_json(data, args.json)
    if args.out is not None:
        _write_pictures(data, args.out, not args.no_pictures)
    if args.json != "-":
        _print(data)
    return ExitCode.UNKNOWN if found.doubts else ExitCode.AS_EXPECTED


def _as_data(found: "Order", folder: Path | None) -> dict[str, Any]:
    """The order as plain data; evidence in files of ``folder``, or inside where there is none."""
    edges = []
    for edge in found.edges:
        certificate = edge.certificate
        if folder is not None:
            certificate = str(folder / f"edge-{_file(edge.above)}-{_file(edge.below)}.json")
            write_text(Path(certificate), edge.certificate)
        names = {"from": str(edge.above), "to": str(edge.below), "claim": edge.claim}
        edges.append({**names, "certificate": certificate})
    drives: list[dict[str, Any]] = []
    for number, drive in enumerate(found.drives, 1):
        content: object = dict(drive.data)
        if folder is not None:
            path = folder / f"drive-{_file(drive.node)}-{number}.json"
            write_text(path, json.dumps(drive.data, indent=2, ensure_ascii=False) + "\n")
            content = str(path)
        others = sorted({str(node) for node in drive.others})
        drives.append({"number": number, "holds": str(drive.node), "fails": others, "drive": content})
    doubts = [{"from": str(a), "to": str(b), "reason": why} for a, b, why in found.doubts]
    return {
        "schema": SCHEMA,
        "sets": list(dict.fromkeys(node.set_name for kind in found.kinds for node in kind.nodes)),
        "view": "dense",
        "kinds": [[str(node) for node in kind.nodes] for kind in found.kinds],
        "edges": edges,
        "missing": _missing(found),
        "drives": drives,
        "doubts": doubts,
    }


def _file(node: "Node") -> str:
    return f"{node.set_name}-{node.number:02}"


def _missing(found: "Order") -> list[dict[str, Any]]:
    """The pairs of kinds without implication, with the numbers of the drives that show it."""
    doubtful = {(a, b) for a, b, _ in found.doubts}
    drives: dict[tuple[Node, Node], list[int]] = {}
    for number, drive in enumerate(found.drives, 1):
        for other in set(drive.others):
            drives.setdefault((drive.node, other), []).append(number)
    missing = []
    for above in found.kinds:
        for below in found.kinds:
            pair = (above.node, below.node)
            if above is below or pair in doubtful or found.implies(*pair):
                continue
            missing.append({"from": str(above.node), "to": str(below.node), "drives": drives[pair]})
    return missing


def _write_pictures(data: Mapping[str, Any], folder: Path, pictures: bool) -> None:
    from roadproof.files import write_whole
    from roadproof.report.order import as_dot, draw_order

    write_json(data, str(folder / "index.json"))
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
