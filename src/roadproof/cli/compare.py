"""``roadproof compare``: two scenarios or formulas, and which implies which."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.options import (
    add_json_option,
    add_quiet_option,
    chosen_options,
    load_library_of,
    write_json,
    write_text,
)
from roadproof.cli.search_options import add_search_options, read_means, read_setting
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
    from roadproof.spec.compose import taken_from
    from roadproof.spec.scenarios import read_query
    from roadproof.witness.ask import Search
    from roadproof.witness.compare import compare

    sets = args.set_names or ["base"]
    if len(sets) > 2:
        raise UsageError(f"--set is given {len(sets)} times: two formulas have at most two spec sets")
    library = load_library_of(args)
    home = library.select(sets[0], chosen_options(args))
    _, first = read_query(home, args.first)
    _, second = read_query(home.in_set(sets[-1]), args.second)
    search = Search(home, first, read_setting(args, library), read_means(args))
    comparison = compare(search, taken_from(home, second, sets[-1]))
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
        f"first   {comparison.first.text}  (set {sets[0]})",
        f"second  {comparison.second.text}  (set {sets[-1]})",
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
    from roadproof.evidence.certificate import to_json

    directions = [
        {
            "claim": direction.claim.text,
            "verdict": str(direction.verdict),
            "reason": direction.reason,
            "certificate": None if direction.certificate is None else to_json(direction.certificate),
            "drive": None if direction.drive is None else direction.drive.as_data(),
        }
        for _, direction in _directions(comparison)
    ]
    return {
        "schema": SCHEMA,
        "first": {"formula": comparison.first.text, "set": sets[0]},
        "second": {"formula": comparison.second.text, "set": sets[-1]},
        "relation": comparison.relation,
        "forward": directions[0],
        "backward": directions[1],
    }


def _write(comparison: "Comparison", folder: Path) -> None:
    from roadproof.evidence.certificate import to_json
    from roadproof.files import make_folder

    make_folder(folder)
    for name, direction in _directions(comparison):
        stem = name.replace(" ", "-")
        if direction.certificate is not None:
            write_text(folder / f"{stem}.json", to_json(direction.certificate))
        elif direction.drive is not None:
            write_json(direction.drive.as_data(), str(folder / f"not-{stem}.json"))
