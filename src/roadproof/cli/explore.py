"""``roadproof explore``: for which values a scenario has a drive, and how far a measure can go."""

import argparse
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.evidence import evidence_folder, keep_specifications, write_index
from roadproof.cli.explore_files import draw_all, with_evidence
from roadproof.cli.explore_options import read_knobs, read_precision, read_steps
from roadproof.cli.numbers import whole
from roadproof.cli.options import (
    add_json_option,
    chosen_options,
    load_library_of,
    parameter_values,
    read_seconds,
    write_json,
)
from roadproof.cli.progress import clear, tell
from roadproof.cli.search_options import add_search_options, named, read_means
from roadproof.cli.working import add_working_options, work_in_order
from roadproof.errors import UsageError
from roadproof.study.pool import count_workers
from roadproof.verdict import Verdict, exit_code

if TYPE_CHECKING:
    from roadproof.analysis.explore.extreme import Extreme, Sought
    from roadproof.analysis.explore.measure import Measure
    from roadproof.analysis.explore.search import Reply, Task
    from roadproof.analysis.explore.values import Asked, Finding
    from roadproof.analysis.requests import Request
    from roadproof.spec.library import Library

SUMMARY = "for which values of parameters and limits a scenario has a drive, and how far a measure can go"
SCHEMA = "roadproof/explore/1"

_EXAMPLES = """\
examples:
  roadproof explore 4 --vary minSafe=0:6                     a parameter: 11 values, then the boundary
  roadproof explore 4 --vary minDanger=0:3 --vary rho=0:2    two: a map
  roadproof explore 4 --vary POV.a_lon.min=-6:0              a limit of a vehicle; vehicle.… is that of all
  roadproof explore 1 --least 'v_lon(SV) - v_lon(POV)'       the least value of a measure at the start
  roadproof explore 4 --greatest 's(POV) - s(SV)' --when 'danger(SV,POV)'    at a moment of danger
  roadproof explore --all --vary minDanger=0:30 --out explored

Limits are v_lon, v_lat, a_lon and a_lat, each .min and .max. Where durations change, dt is the coarsest step
that divides them, and --dt its upper bound. A drive that was found is judged at every other value, so
most values take no search. A value that none is found for costs up to three times the --effort.
Nothing is claimed of values between those looked at, and no extreme is called the best there is: the
other side of the bracket is printed with what is known of it.

# drive judged at this value, . proved impossible, - none within the limits printed, ? not decided.
Exit code 20 where anything is not decided.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("what", metavar="N|FORMULA", nargs="*", help="a scenario's number, or a formula")
    parser.add_argument("--all", action="store_true", help="all scenarios of each --set")
    parser.add_argument(
        "--vary",
        metavar="NAME=LOW:HIGH",
        action="append",
        default=[],
        help="a parameter, or a limit such as POV.a_lon.min; may be given twice",
    )
    parser.add_argument(
        "--steps", type=whole("--steps", 2), metavar="K", help="values of each (default: 11; of two: 6)"
    )
    for sense in ("least", "greatest"):
        parser.add_argument(f"--{sense}", metavar="TERM", help=f"the {sense} value of a term")
    parser.add_argument("--when", metavar="FORMULA", help="measure at a moment at which this holds, not at 0")
    parser.add_argument(
        "--precision",
        metavar="P",
        help="width of a bracket, in SI units (default: range/60; of a measure 0.1)",
    )
    add_search_options(parser, 6.0)
    add_working_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write drives, certificates, JSON, pictures")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no pictures")
    add_json_option(parser)


@dataclass(frozen=True)
class Job:
    """One formula to be explored: the map, where there are knobs, and the measures."""

    scenario: int | None
    asked: "Asked"
    measures: "tuple[Measure, ...]"
    processes: int | None


def run(args: argparse.Namespace) -> int:
    from roadproof.report.explore import as_text

    begun = time.monotonic()
    library = load_library_of(args)
    jobs = _jobs(args, library)
    folder = evidence_folder(args.out, args.json)
    _make_ready(folder, count_workers(range(1000), args.jobs))
    if len(jobs) > 1:
        jobs = [replace(job, processes=1) for job in jobs]
    explored: list[dict[str, Any]] = []
    for number, data in enumerate(work_in_order(carry_out, jobs, args.jobs, "formulas"), 1):
        explored.append(with_evidence(data, number, folder))
        if args.json != "-":
            clear()
            print(as_text(data), flush=True)
    seconds = round(time.monotonic() - begun, 1)
    whole = {"schema": SCHEMA, **_said_once(jobs[0], folder), "view": "dense", "seconds": seconds}
    whole["explored"] = explored
    if args.json:
        write_json(whole, args.json)
    if folder is not None:
        write_index(folder, whole)
    if args.out is not None and not args.no_pictures:
        draw_all(explored, args.out, library)
    return exit_code((verdict, verdict) for data in explored for verdict in _verdicts(data))


def _said_once(job: Job, folder: Path | None) -> dict[str, Any]:
    """What the index says of all findings; the values of what is varied are those of each finding."""
    request = job.asked.request
    varied = {knob.name for knob in job.asked.knobs}
    values = {name: str(value) for name, value in sorted(request.values.items()) if name not in varied}
    return {
        "options": dict(request.options),
        "parameters": values,
        "specs": keep_specifications(folder, request.specs),
    }


def _jobs(args: argparse.Namespace, library: "Library") -> list[Job]:
    if args.all == bool(args.what):
        raise UsageError("name scenarios or formulas, or ask for --all: one of the two")
    if not args.vary and not (args.least or args.greatest):
        raise UsageError("say what to explore: --vary NAME=LOW:HIGH, --least TERM or --greatest TERM")
    if args.when and not (args.least or args.greatest):
        raise UsageError(f"--when '{args.when}' says when to measure: add --least TERM or --greatest TERM")
    if len(args.vary) > 1 and (args.least or args.greatest):
        raise UsageError("--least and --greatest go with one --vary at most")
    request = read_request(args, library)
    jobs: list[Job] = []
    for name in (name for text in args.set_names or ["base"] for name in text.split(",")):
        specification = library.select(name, request.options)
        whats = args.what
        if args.all:
            from roadproof.spec.scenarios import numbers_of

            whats = [str(number) for number in numbers_of(specification)]
        jobs += [_job(args, what, replace(request, set_name=name), library) for what in whats]
    return jobs


def _job(args: argparse.Namespace, what: str, request: "Request", library: "Library") -> Job:
    from roadproof.analysis.explore.measure import read_measure
    from roadproof.analysis.explore.text import given_of
    from roadproof.analysis.explore.values import Asked
    from roadproof.spec.scenarios import read_query

    specification = library.select(request.set_name, request.options)
    scenario, query = read_query(specification, what)
    request = replace(request, what=query.text)
    knobs = read_knobs(args.vary, request, query, library)
    given = {assignment.partition("=")[0].strip() for assignment in args.params}
    for knob in knobs:
        if knob.name in given:
            raise UsageError(f"{knob.name} is given by --param and varied by --vary: leave one out")
    measures: list[Measure] = []
    when, names = args.when or "", given_of(query.claim)
    if args.least:
        measures.append(read_measure(specification, "least", args.least, when, names))
    if args.greatest:
        measures.append(read_measure(specification, "greatest", args.greatest, when, names))
    steps = read_steps(args.steps, len(knobs))
    asked = Asked(request, tuple(knobs), steps, read_precision(args.precision))
    return Job(scenario, asked, tuple(measures), args.jobs)


def read_request(args: argparse.Namespace, library: "Library") -> "Request":
    """The request that the options make, for no formula yet. Raises ``UsageError``, ``InputError``."""
    from roadproof.analysis.requests import Request

    return Request(
        what="",
        options=dict(library.select("base", chosen_options(args)).options),
        specs=tuple(args.specs),
        values=parameter_values(args, library),
        road=args.road,
        lanes=dict(named(args.lanes, "L")),
        vehicles=dict(named(args.vehicles, "")),
        horizon=read_seconds("--horizon", args.horizon),
        dt=read_seconds("--dt", args.dt or "3/5"),
        reach=read_seconds("--reach", args.reach),
        collisions=args.allow_collisions,
        means=read_means(args),
    )


def _make_ready(folder: Path | None, processes: int) -> None:
    """Fail before the work where the folder cannot be written; import once what every process needs."""
    from roadproof.files import make_folder

    if folder is not None:
        make_folder(folder)
    if processes > 1:
        from roadproof.solve.milp import prepare

        prepare()


def carry_out(job: Job) -> dict[str, Any]:
    """Explore one formula; what was found as plain data, evidence inside."""
    from roadproof.analysis.explore.extreme import Sought, find_extremes
    from roadproof.analysis.explore.search import look
    from roadproof.analysis.explore.values import explore

    begun = time.monotonic()
    asked, request = job.asked, job.asked.request

    def look_all(tasks: "Sequence[Task]") -> "Iterable[Reply]":
        return work_in_order(look, tasks, job.processes, lost=undecided)

    data: dict[str, Any] = {"scenario": job.scenario, "set": request.set_name, "formula": request.what}
    data["vary"] = [
        {"name": knob.name, "unit": knob.unit, "low": str(knob.low), "high": str(knob.high)}
        for knob in asked.knobs
    ]
    data |= {"values": [], "boundaries": [], "searches": 0, "drives": 0}
    if asked.knobs:
        explored = explore(asked, look_all, tell)
        data["values"] = [_plain(finding) for finding in explored.findings]
        data["boundaries"] = [
            {name: _plain(getattr(boundary, name)) for name in ("held", "missed", "surely")}
            for boundary in explored.boundaries
        ]
        data |= {"searches": explored.searches, "drives": explored.drives}
        points = [finding.at for finding in explored.findings if finding.found]
    else:
        points = [()]
    precision = asked.precision if asked.precision is not None and not asked.knobs else Fraction(1, 10)
    data["extremes"] = []
    for measure in job.measures:
        sought = [Sought(request, measure, precision, asked.knobs, point) for point in points]
        extremes = find_extremes(sought, lambda some: work_in_order(_seek, some, job.processes))
        data["extremes"] += [_extreme(one, found) for one, found in zip(sought, extremes, strict=True)]
    data["searches"] += sum(x["searches"] for x in data["extremes"])
    return data | {"seconds": round(time.monotonic() - begun, 1)}


def undecided(task: "Task", reason: str) -> "Reply":
    """The reply to a search that nothing is known of."""
    from roadproof.analysis.explore.search import Reply

    return Reply(Verdict.UNKNOWN, reason)


def _seek(sought: "Sought") -> "Extreme":
    from roadproof.analysis.explore.extreme import find_extreme

    return find_extreme(sought, say=tell)


def _plain(finding: "Finding | None") -> dict[str, Any] | None:
    if finding is None:
        return None
    return {
        "at": [str(value) for value in finding.at],
        "verdict": str(finding.verdict),
        "formula": finding.formula,
        "reason": finding.reason,
        "number": finding.number,
        "drive": finding.drive,
        "certificate": finding.certificate,
    }


def _extreme(sought: "Sought", extreme: "Extreme") -> dict[str, Any]:
    from roadproof.analysis.explore.text import unit_text

    measure = extreme.measure
    data: dict[str, Any] = {"sense": measure.sense, "measure": measure.text, "when": measure.when}
    data |= {"unit": unit_text(measure.dimension), "point": [str(value) for value in sought.point]}
    data |= {name: _plain(getattr(extreme, name)) for name in ("best", "missed", "surely")}
    return data | {"endless": extreme.endless, "searches": extreme.searches}


def _verdicts(data: Mapping[str, Any]) -> Iterable[Verdict]:
    """The verdicts that decide the exit code: of all values, and of both sides of every bracket."""
    found = [*data["values"]]
    for bracket in (*data["boundaries"], *data["extremes"]):
        found += [x for name, x in bracket.items() if name in ("held", "best", "missed") and x is not None]
    return [Verdict(x["verdict"]) for x in found]
