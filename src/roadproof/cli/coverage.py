"""``roadproof coverage``: which disturbances a spec set misses, or a proof that it misses none."""

import argparse
import json
import time
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
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    from roadproof.analysis.coverage import Covered, Gap, NoGap

SUMMARY = "which disturbances a spec set misses, by drives; or a proof that it misses none"
SCHEMA = "roadproof/coverage/1"

_EXAMPLES = """\
examples:
  roadproof coverage --set complete --out complete    proved to have no gap between two vehicles
  roadproof coverage --set ext --out gaps             a drive for each class of gaps, judged
  roadproof coverage --set base --wider ext           what base misses and ext catches, on the way to complete

A gap: initSafe at the start, danger later, and no two-vehicle scenario for any lane and either role. Gaps
are sorted by the definitions of the wider set that are the smallest choice to catch them.
Exit code 0 where coverage is proved, 10 where there are gaps, 20 where neither was found.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser)
    add_parameter_option(parser)
    parser.add_argument("--wider", metavar="S", default="complete", help="set to compare (default: complete)")
    parser.add_argument(
        "--road", dest="roads", metavar="R", action="append", help="may be repeated (default: main-2)"
    )
    parser.add_argument(
        "--timeout", type=float, default=60.0, metavar="S", help="seconds for one drive (default: 60)"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates, drives and pictures")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no pictures")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.analysis.coverage import Gap, find_gaps, prove_coverage, replaced_in
    from roadproof.analysis.overlap import Asked

    begun = time.monotonic()
    if not args.timeout > 0:
        raise UsageError(f"--timeout {args.timeout} must be greater than 0")
    library = load_library_of(args)
    specification = library.select(args.set_name, chosen_options(args))
    wide = specification.in_set(args.wider)
    asked = Asked(
        (args.set_name,),
        options=specification.options,
        specs=tuple(args.specs),
        values=parameter_values(args, library),
        timeout=args.timeout,
    )
    if args.out is not None:
        make_folder(args.out)
    covered = prove_coverage(asked)
    proved = all(x.verdict is Verdict.PROVED for x in covered)
    found: list[Gap | NoGap] = []
    if not proved:
        if not replaced_in(specification, wide):
            raise UsageError(
                f"--wider {args.wider} replaces nothing of --set {args.set_name}: name a wider set"
            )
        for road in args.roads or ["main-2"]:
            for one in find_gaps(asked, args.wider, road):
                found.append(one)
                tell(f"road {road}: {len(found)} questions answered")
                if args.json != "-":
                    print(_line(one), flush=True)
    gaps = [x for x in found if isinstance(x, Gap)]
    data = {
        "schema": SCHEMA,
        "set": args.set_name,
        "wider": args.wider,
        "view": "dense",
        "verdict": "COVERED" if proved else "GAPS" if gaps else str(Verdict.UNKNOWN),
        "claims": [_claim(x, number, args.out) for number, x in enumerate(covered, 1)],
        "gaps": [_gap(x, number, args.out) for number, x in enumerate(gaps, 1)],
        "none_found": [
            {"road": x.road, "without": list(x.without), "verdict": str(x.verdict), "reason": x.reason}
            for x in found
            if not isinstance(x, Gap)
        ],
        "seconds": round(time.monotonic() - begun, 1),
    }
    if args.json:
        write_json(data, args.json)
    if args.out is not None:
        write_json(data, str(args.out / "index.json"))
        if not args.no_pictures:
            _draw(gaps, args.out, args)
    if args.json != "-":
        _print(covered, gaps, args, proved)
    return ExitCode.AS_EXPECTED if proved else ExitCode.UNEXPECTED if gaps else ExitCode.UNKNOWN


def _claim(covered: "Covered", number: int, folder: Path | None) -> dict[str, Any]:
    certificate = covered.certificate
    if folder is not None and certificate is not None:
        path = folder / f"covered-{number}.json"
        write_text(path, certificate)
        certificate = str(path)
    return {
        "claim": covered.claim,
        "verdict": str(covered.verdict),
        "certificate": certificate,
        "reason": covered.reason,
    }


def _gap(gap: "Gap", number: int, folder: Path | None) -> dict[str, Any]:
    drive: object = dict(gap.drive)
    if folder is not None:
        path = folder / f"gap-{number}.json"
        write_text(path, json.dumps(gap.drive, indent=2, ensure_ascii=False) + "\n")
        drive = str(path)
    caught = [list(names) for names in gap.caught_by]
    return {"road": gap.road, "without": list(gap.without), "caught_by": caught, "drive": drive}


def _draw(gaps: "list[Gap]", folder: Path, args: argparse.Namespace) -> None:
    from roadproof.files import write_whole
    from roadproof.report.drive import draw_drive

    library = load_library_of(args)
    for number, gap in enumerate(gaps, 1):
        for kind, content in draw_drive(gap.drive, library).items():
            write_whole(folder / f"gap-{number}.{kind}", content)


def _line(one: "Gap | NoGap") -> str:
    from roadproof.analysis.coverage import Gap

    left_out = ", ".join(one.without)
    if isinstance(one, Gap):
        caught = " or ".join(" with ".join(names) for names in one.caught_by)
        return f"road {one.road}: a drive that needs {left_out}; smallest to catch it: {caught or 'nothing'}"
    return f"road {one.road}: no drive was found that needs {left_out}: {one.reason}"


def _print(covered: "list[Covered]", gaps: "list[Gap]", args: argparse.Namespace, proved: bool) -> None:
    if proved:
        for one in covered:
            print(f"proved: {one.claim}")
        print(f"set {args.set_name} misses no danger that arises from safety between two vehicles")
        return
    classes = {gap.caught_by for gap in gaps}
    print(f"set {args.set_name}: {len(gaps)} gaps in {len(classes)} classes, each with a judged drive")
