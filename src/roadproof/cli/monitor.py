"""``roadproof monitor``: where a formula holds on one trace."""

import argparse
import re
import sys
from collections.abc import Iterator, Mapping
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    load_library_of,
    parameter_values,
    select_specification,
    write_json,
)
from roadproof.errors import InputError, UsageError
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.evidence.drive_file import DriveFile
    from roadproof.report.one_trace import Observed
    from roadproof.spec.library import Library, Specification
    from roadproof.spec.query import Query
    from roadproof.traffic.one_trace import OneTrace

SUMMARY = "say where a formula holds on one trace: a drive, samples, or vehicles of a recording"

_EXAMPLES = """\
FORMULA is a formula or a scenario's number. TRACE is one of
  drive.json               a drive file of roadproof witness; judged exactly, in dense time, unless
                           --view recorded asks for samples of it; what the file says of parameters,
                           options and set holds unless the command line says otherwise
  samples.csv              a row a time and vehicle, with the header
                           time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width
                           (SI units, s along the road, d to the left, front-left corner of the box)
  highd/01_tracks.csv:12,15     vehicles of a highD recording: SV, POV (or SV, POV1, POV2)

exit codes: 0 true, 10 false, 20 undecided (it depends on what comes after the trace)

examples:
  roadproof monitor 4 drives/scenario-04-base.json
  roadproof monitor 'initSafe(SV,POV)' samples.csv --road main-3
  roadproof monitor 1 highd/01_tracks.csv:12,15 --set ext --picture pair.png
  roadproof monitor 'F danger(SV,POV)' highd/01_tracks.csv:12,15 --frames 100-400 --end clip
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("formula", metavar="FORMULA", help="a formula, or a scenario's number")
    parser.add_argument("trace", metavar="TRACE", help="a drive, samples, or vehicles of a recording")
    add_specification_options(parser, None)
    add_parameter_option(parser)
    parser.add_argument(
        "--lane",
        dest="lanes",
        metavar="[L=]LANE",
        action="append",
        default=[],
        help="the lane that L stands for: its name, or a vehicle, whose lane at the start it is "
        "(default: SV's, POV's for scenario 7; a drive file names its own)",
    )
    parser.add_argument("--road", metavar="R", default="main-2", help="road of a CSV file (default: main-2)")
    parser.add_argument(
        "--view", choices=("dense", "recorded"), help="how a drive file is read (default: dense)"
    )
    parser.add_argument("--dt", metavar="S", default="1/25", help="seconds between samples of a drive")
    parser.add_argument("--frames", metavar="A-B", help="frames of a recording (default: all common ones)")
    parser.add_argument(
        "--end",
        choices=("truncated", "clip"),
        default="truncated",
        help="what the end of a recorded trace means (default: truncated)",
    )
    parser.add_argument("--picture", metavar="FILE", type=Path, help="draw strips into FILE (.png or .svg)")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.report.one_trace import as_text, draw_strips

    if args.picture is not None and args.picture.suffix not in (".png", ".svg"):
        raise UsageError(f"--picture {args.picture}: name a file that ends in .png or .svg")
    observed, told = _observe(args, load_library_of(args))
    if args.json:
        write_json({**observed.as_json(), **told}, args.json)
    if args.json != "-":
        print(as_text(observed))
        print("; ".join(f"{name}: {value}" for name, value in told.items()))
    if args.picture is not None:
        from roadproof.files import write_whole

        write_whole(args.picture, draw_strips(observed)[args.picture.suffix[1:]])
    codes = {
        "true": ExitCode.AS_EXPECTED,
        "false": ExitCode.UNEXPECTED,
        "undecided": ExitCode.UNKNOWN,
    }
    return codes[observed.verdict]


def _observe(args: argparse.Namespace, library: "Library") -> "tuple[Observed, dict[str, str]]":
    from roadproof.traffic.one_trace import is_pair, read_pair, read_samples
    from roadproof.world.models import load_road

    if args.trace.endswith(".json"):
        return _observe_drive(args, library)
    if args.view == "dense":
        raise UsageError("--view dense: only a drive file says what is true between samples")
    specification = select_specification(args, library)
    if is_pair(args.trace):
        trace = read_pair(args.trace, _frames(args.frames))
        for note in trace.notes:
            print(f"note: {note}", file=sys.stderr)
    elif args.trace.endswith(".csv"):
        trace = read_samples(Path(args.trace), load_road(args.road))
    else:
        raise InputError(
            f"{args.trace}: a trace is a drive (.json), samples (.csv), or vehicles of a highD recording "
            "such as highd/01_tracks.csv:12,15"
        )
    return _observe_trace(args, specification, trace, parameter_values(args, library), {})


def _observe_drive(args: argparse.Namespace, library: "Library") -> "tuple[Observed, dict[str, str]]":
    from roadproof.evidence.drive_file import load_drive
    from roadproof.report.one_trace import observe_drive
    from roadproof.spec.bind import bind
    from roadproof.traffic.one_trace import sample_drive

    file = load_drive(Path(args.trace))
    options = [f"{name}={value}" for name, value in file.options.items()]
    chosen = argparse.Namespace(set_name=args.set_name or file.set_name, options=[*options, *args.options])
    specification = select_specification(chosen, library)
    given = {text.partition("=")[0].strip() for text in args.params}
    values = parameter_values(args, library)
    values |= {name: value for name, value in file.values.items() if name not in given}
    dt = _positive("--dt", args.dt)
    trace = sample_drive(file.drive, file.road, file.horizon, dt, args.trace)
    overruled = dict(_overruled(file, specification, values))
    if args.view == "recorded":
        observed, told = _observe_trace(args, specification, trace, values, file.lanes)
        return observed, told | overruled
    query, number = _read(specification, args.formula)
    lanes = _lanes(args, query, number, trace, file.lanes)
    _check_vehicles(query, trace)
    formula = bind(query.formula, file.road, lanes, values)
    told = _told(trace, specification, lanes) | overruled
    return observe_drive(query.text, formula, file.drive, file.horizon, dt), told


def _overruled(
    file: "DriveFile", specification: "Specification", values: Mapping[str, Fraction]
) -> "Iterator[tuple[str, str]]":
    """What the command line asks for otherwise than the drive file, which was judged as it says."""
    for name, value in file.values.items():
        if values[name] != value:
            yield f"parameter {name}", f"{values[name]} (the file says {value})"
    for name, reading in file.options.items():
        if specification.options.get(name) != reading:
            yield f"option {name}", f"{specification.options.get(name)} (the file says {reading})"
    if specification.set_name != file.set_name:
        yield "set of the file", file.set_name


def _observe_trace(
    args: argparse.Namespace,
    specification: "Specification",
    trace: "OneTrace",
    values: Mapping[str, Fraction],
    known: Mapping[str, str],
) -> "tuple[Observed, dict[str, str]]":
    from roadproof.report.one_trace import observe_samples
    from roadproof.spec.bind import bind

    query, number = _read(specification, args.formula)
    _check_vehicles(query, trace)
    lanes = _lanes(args, query, number, trace, known)
    formula = bind(query.formula, trace.road, lanes, values)
    return observe_samples(query.text, formula, trace.batch, args.end), _told(trace, specification, lanes)


def _told(trace: "OneTrace", specification: "Specification", lanes: Mapping[str, str]) -> dict[str, str]:
    told = {"trace": trace.source, "start": trace.first, "set": specification.set_name}
    return told | {"road": trace.road.name} | {f"lane {name}": lane for name, lane in lanes.items()}


def _read(specification: "Specification", what: str) -> "tuple[Query, int | None]":
    """The formula, and the number of the scenario where one was asked for by number."""
    from roadproof.spec.elaborate import read_claim, signature

    text, number = what.strip(), None
    if text.isdecimal() and len(text) <= 3:
        number = int(text)
        name = f"scenario_{number}"
        text = f"{name}({', '.join(signature(specification, name))})"
    return read_claim(specification, text), number


def _check_vehicles(query: "Query", trace: "OneTrace") -> None:
    missing = [name for name in query.vehicles if name not in trace.lanes]
    if missing:
        raise InputError(
            f"{query.text}: speaks of {', '.join(missing)}, but {trace.source} has "
            f"{', '.join(trace.lanes)}; name other vehicles or another formula"
        )


def _lanes(
    args: argparse.Namespace,
    query: "Query",
    number: int | None,
    trace: "OneTrace",
    known: Mapping[str, str],
) -> dict[str, str]:
    """A lane for each free lane of the formula: as asked for, as in the file, or a vehicle's."""
    lanes = dict(known)
    for text in args.lanes:
        name, _, lane = text.rpartition("=")
        lanes[name or "L"] = trace.lanes.get(lane, lane)
    usual = "POV" if number is not None and number % 8 == 7 else "SV"  # semantics §5
    for name in query.lanes:
        if not lanes.get(name):
            lanes[name] = trace.lanes.get(usual, "")
        if not lanes[name]:
            raise InputError(f"lane {name}: {usual} is in no lane at the start; say --lane {name}=LANE")
    return {name: lanes[name] for name in query.lanes}


def _frames(text: str | None) -> tuple[int | None, int | None]:
    if text is None:
        return None, None
    read = re.fullmatch(r"(\d{1,9})-(\d{1,9})", text)
    if read is None:
        raise UsageError(f"--frames {text[:40]}: write the first and the last frame, such as 100-400")
    return int(read[1]), int(read[2])


def _positive(option: str, text: str) -> Fraction:
    try:
        value = Fraction(text) if len(text) <= 40 and "e" not in text.lower() else None
    except (ValueError, ZeroDivisionError):
        value = None
    if value is None or value <= 0:
        raise UsageError(f"{option} {text[:40]}: write a number greater than 0, such as 0.04 or 1/25")
    return value
