"""``roadproof compare``: two scenarios or formulas, and which implies which."""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.options import add_json_option, add_quiet_option, load_library_of, write_json, write_text
from roadproof.cli.search_options import add_search_options, read_request
from roadproof.errors import UsageError
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.witness.compare import Comparison, Direction

SUMMARY = "compare two formulas: equivalent, stronger, weaker or incomparable"
SCHEMA = "roadproof/compare/1"

_EXAMPLES = """\
examples:
  roadproof compare 'scenario_3(SV,POV,L)' 'scenario_4(POV,SV,L)'
  roadproof compare 4 4 --set base --set ext          the same scenario in two spec sets
  roadproof compare 1 4 --out differences             drives that tell the two apart
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("first", metavar="F1", help="a scenario's number, or a formula")
    parser.add_argument("second", metavar="F2", help="another; in the second --set where two are given")
    add_search_options(parser)
    add_quiet_option(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates and drive files")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.witness.compare import compare

    sets = args.set_names or ["base"]
    if len(sets) > 2:
        raise UsageError(f"--set is given {len(sets)} times: two formulas have at most two spec sets")
    request = read_request(args, load_library_of(args))
    first = replace(request, what=args.first, set_name=sets[0])
    comparison = compare(first, replace(request, what=args.second, set_name=sets[-1]))
    if args.out is not None:
        _write(comparison, args.out)
    if args.json:
        write_json(_as_json(comparison, sets), args.json)
    if args.json != "-":
        print(_as_text(comparison, sets))
    return ExitCode.UNKNOWN if comparison.relation == "unknown" else ExitCode.AS_EXPECTED


_SENTENCES = {
    "equivalent": "the two are equivalent",
    "stronger": "the first is stronger: it implies the second, but not the reverse",
    "weaker": "the first is weaker: the second implies it, but not the reverse",
    "incomparable": "the two are incomparable: neither implies the other",
    "unknown": "not decided",
}


def _as_text(comparison: "Comparison", sets: list[str]) -> str:
    lines = [
        f"first   {comparison.first}  (set {sets[0]})",
        f"second  {comparison.second}  (set {sets[-1]})",
        _SENTENCES[comparison.relation],
    ]
    for name, direction in _directions(comparison):
        shown = f"  {name}: {direction.verdict}"
        shown += " for all time, on every road" if direction.certificate else ""
        shown += " by a judged drive" if direction.drive else ""
        shown += f"; {direction.reason}" if direction.reason else ""
        lines.append(shown)
    return "\n".join(lines)


def _directions(comparison: "Comparison") -> "list[tuple[str, Direction]]":
    return [
        ("first implies second", comparison.forward),
        ("second implies first", comparison.backward),
    ]


def _as_json(comparison: "Comparison", sets: list[str]) -> dict[str, Any]:
    directions = [
        {
            "claim": direction.claim,
            "verdict": str(direction.verdict),
            "reason": direction.reason,
            "certificate": direction.certificate,
            "drive": direction.drive,
        }
        for _, direction in _directions(comparison)
    ]
    return {
        "schema": SCHEMA,
        "first": {"formula": comparison.first, "set": sets[0]},
        "second": {"formula": comparison.second, "set": sets[-1]},
        "relation": comparison.relation,
        "forward": directions[0],
        "backward": directions[1],
    }


def _write(comparison: "Comparison", folder: Path) -> None:
    from roadproof.files import make_folder

    make_folder(folder)
    for name, direction in _directions(comparison):
        stem = name.replace(" ", "-")
        if direction.certificate is not None:
            write_text(folder / f"{stem}.json", direction.certificate)
        elif direction.drive is not None:
            write_json(direction.drive, str(folder / f"not-{stem}.json"))
