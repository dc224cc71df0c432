"""``roadproof coverage``: which disturbances a spec set misses, or a proof that it misses none."""

import argparse
import time
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.coverage_files import Evidence
from roadproof.cli.coverage_traffic import count_in_traffic
from roadproof.cli.evidence import write_index
from roadproof.cli.numbers import add_effort_options, read_effort
from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    chosen_options,
    load_library_of,
    parameter_values,
    write_json,
)
from roadproof.cli.working import add_working_options, work, work_in_order
from roadproof.errors import UsageError
from roadproof.files import hold_if_any
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    from roadproof.analysis.coverage.claims import Covered
    from roadproof.analysis.coverage.classes import Answer, Found, Group, Survey
    from roadproof.analysis.coverage.needed import Need
    from roadproof.analysis.requests import Asked

SUMMARY = "which disturbances a spec set misses, by drives in classes; or a proof that it misses none"
SCHEMA = "roadproof/coverage/1"
CHUNKS = 7

_EXAMPLES = """\
examples:
  roadproof coverage --set complete --out complete    proved to have no gap between two vehicles
  roadproof coverage --set complete --needed          and which of its definitions it needs for that
  roadproof coverage --set ext --out gaps             the classes of gaps, each with a drive or a proof
  roadproof coverage --set base --jobs 2              what base misses, and which wider set catches it
  roadproof coverage --set ext --on recordings        and how often each class occurs in traffic

A gap: initSafe at the start, danger later, and no two-vehicle scenario for any lane and either role. Its
classes say why: scenario 4 would hold but for its component behaviourPOV_4, or for one condition of it.
Of each class: a judged drive, or a proof that it is empty, or how far it was looked. Behind a drive's
number: the first wider set that catches it, and the smallest choice of its definitions that does.
Evidence goes to DIR, `roadproof check DIR` checks it; a run that was broken off goes on where it was.
Exit code 0 where coverage is proved, 10 where there are gaps, 20 where neither was found.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser)
    add_parameter_option(parser)
    parser.add_argument(
        "--wider", metavar="S", help="the set that catches all (default: complete, where it extends the set)"
    )
    parser.add_argument(
        "--road",
        dest="roads",
        metavar="R",
        action="append",
        help="where to look for drives; may be repeated (default: main-2, then main-3)",
    )
    add_effort_options(parser, 10.0, "a search, half of it for one more that another set catches")
    parser.add_argument(
        "--needed", action="store_true", help="of a set that covers: a drive for each definition it needs"
    )
    parser.add_argument(
        "--on", type=Path, metavar="DIR", help="count the classes in recordings, as roadproof simulate makes"
    )
    add_working_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates, drives and pictures")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no pictures")
    add_json_option(parser)


@dataclass(frozen=True)
class ClaimJob:
    asked: "Asked"
    claim: str


@dataclass(frozen=True)
class NeedJob:
    asked: "Asked"
    name: str


@dataclass(frozen=True)
class CatalogueJob:
    survey: "Survey"
    road: str
    chunk: int


@dataclass(frozen=True)
class GroupJob:
    survey: "Survey"
    group: "Group"
    known: "tuple[Found, ...]"


def run(args: argparse.Namespace) -> int:
    begun = time.monotonic()
    asked, survey = _asked(args)
    with hold_if_any(args.out):
        return _answer(args, asked, survey, begun)


def _answer(args: argparse.Namespace, asked: "Asked", survey: "Survey", begun: float) -> int:
    evidence = Evidence(args.out, survey)
    covered = _prove(asked, args.jobs)
    proved = all(x.verdict is Verdict.PROVED for x in covered)
    needs: list[Need] = []
    if not proved:
        _settle(survey, evidence, args.jobs)
    elif args.needed:
        needs = _find_needs(asked, args.jobs)
    classes, gaps = evidence.entries(survey)
    traffic = None if args.on is None else count_in_traffic(asked, args.on, classes)
    broken = _broken(proved, classes, traffic)
    data = {
        "schema": SCHEMA,
        **evidence.said,
        "view": "dense",
        "verdict": str(Verdict.CROSSCHECK_FAILED)
        if broken
        else str(Verdict.COVERED)
        if proved
        else str(Verdict.GAPS)
        if gaps
        else str(Verdict.UNKNOWN),
        "claims": evidence.claims(covered),
        "classes": classes,
        "gaps": gaps,
        "needs": evidence.needs(needs),
        "traffic": traffic,
        "seconds": round(time.monotonic() - begun, 1),
    }
    if args.json:
        write_json(data, args.json)
    if args.out is not None:
        write_index(args.out, data)
        if not args.no_pictures:
            evidence.draw(args.jobs)
    if args.json != "-":
        _print(data)
    if broken:
        return ExitCode.CROSSCHECK_FAILED
    return ExitCode.AS_EXPECTED if proved else ExitCode.UNEXPECTED if gaps else ExitCode.UNKNOWN


def _broken(proved: bool, classes: list[dict[str, Any]], traffic: dict[str, Any] | None) -> bool:
    """Whether traffic shows what is proved not to be."""
    if traffic is None:
        return False
    return any(x["verdict"] == str(Verdict.CROSSCHECK_FAILED) for x in classes) or (
        proved and bool(traffic["missed"])
    )


def _asked(args: argparse.Namespace) -> "tuple[Asked, Survey]":
    from roadproof.analysis.coverage.classes import survey_of
    from roadproof.analysis.requests import Asked
    from roadproof.world.models import load_road

    library = load_library_of(args)
    specification = library.select(args.set_name, chosen_options(args))
    asked = Asked(
        (args.set_name,),
        options=specification.options,
        specs=tuple(args.specs),
        values=parameter_values(args, library),
        effort=read_effort(args),
    )
    roads = args.roads or ["main-2", "main-3"]
    for road in roads:
        load_road(road)
    if args.on is not None:
        from roadproof.traffic.sources import find_sources

        find_sources(args.on)
    elsewhere = ("main-3", "merge", "depart")
    if args.wider is not None:
        library.select(args.wider)
        return asked, survey_of(asked, args.wider, roads, elsewhere)
    wide = "complete" if args.set_name != "complete" else ""
    try:
        return asked, survey_of(asked, wide, roads, elsewhere)
    except UsageError:
        return asked, survey_of(asked, "", roads, elsewhere)


def _prove(asked: "Asked", processes: int | None) -> "list[Covered]":
    from roadproof.analysis.coverage.claims import claims_of

    jobs = [ClaimJob(asked, claim) for claim in claims_of(asked.load()[1])]
    with closing(work_in_order(prove_one, jobs, processes, "claims", unproved)) as answers:
        return list(answers)


def prove_one(job: ClaimJob) -> "Covered":
    """The answer to one claim of coverage."""
    from roadproof.analysis.coverage.claims import prove_claim

    return prove_claim(job.asked, job.claim)


def unproved(job: ClaimJob, reason: str) -> "Covered":
    """The answer to a claim that nothing is known of."""
    from roadproof.analysis.coverage.claims import Covered

    return Covered(job.claim, Verdict.UNKNOWN, None, reason)


def _find_needs(asked: "Asked", processes: int | None) -> "list[Need]":
    from roadproof.analysis.coverage.needed import replaced_by

    jobs = [NeedJob(asked, name) for name in replaced_by(asked)]
    needs: list[Need] = []
    with closing(work(find_one_need, jobs, processes, "definitions", unknown_need)) as answers:
        for need in answers:
            needs.append(need)
    return sorted(needs, key=lambda need: need.definition)


def find_one_need(job: NeedJob) -> "Need":
    """Whether one definition is needed."""
    from roadproof.analysis.coverage.needed import find_need

    return find_need(job.asked, job.name)


def unknown_need(job: NeedJob, reason: str) -> "Need":
    """The answer for a definition that nothing is known of."""
    from roadproof.analysis.coverage.needed import Need

    return Need(job.name, "", Verdict.UNKNOWN)


def _settle(survey: "Survey", evidence: Evidence, processes: int | None) -> None:
    """Answers for all groups of classes go to ``evidence``; what it holds already is not asked again."""
    from roadproof.analysis.coverage.classes import groups_of

    groups = groups_of(survey)
    left = [group for group in groups if not evidence.has(group)]
    if not left:
        return
    catalogue = [CatalogueJob(survey, road, k) for road in survey.roads for k in range(CHUNKS)]
    known: list[Found] = []
    with closing(work_in_order(look_up, catalogue, processes, "parts of the catalogue")) as chunks:
        for found in chunks:
            known += found
    jobs = [GroupJob(survey, group, _concerning(group, known)) for group in left]
    with closing(work(settle, jobs, processes, "components", undecided, len(groups) - len(left))) as results:
        for group, answers in results:
            evidence.keep(group, answers)


def _concerning(group: "Group", known: "Sequence[Found]") -> "tuple[Found, ...]":
    keys = {part.key for part in group.parts if part is not None}
    return tuple(x for x in known if not keys or keys & set(x.classes))


def look_up(job: CatalogueJob) -> "list[Found]":
    """The gaps in one part of the catalogue."""
    from roadproof.analysis.coverage.settling import find_in_catalogue

    return find_in_catalogue(job.survey, job.road, job.chunk, CHUNKS)


def settle(job: GroupJob) -> "tuple[Group, list[Answer]]":
    """The answers for one group of classes."""
    from roadproof.analysis.coverage.settling import settle_group

    return job.group, settle_group(job.survey, job.group, job.known)


def undecided(job: GroupJob, reason: str) -> "tuple[Group, list[Answer]]":
    """The answers for a group of classes that nothing is known of."""
    from roadproof.analysis.coverage.classes import Answer

    parts = job.group.parts
    return job.group, [Answer(part, Verdict.UNKNOWN, reason=reason) for part in parts]


def _print(data: dict[str, Any]) -> None:
    from roadproof.report.coverage import as_table, summary

    name = data["set"]
    if data["classes"]:
        print(as_table(data["classes"], data["gaps"]))
        print(f"set {name}:", "\n".join(summary(data["classes"], data["gaps"])))
        print(f"{len(data['gaps'])} gaps in {data['seconds']:.1f} s")
    for claim in data["claims"]:
        if not data["classes"]:
            print(f"proved: {claim['claim']}")
    for need in data["needs"]:
        found = {"WITNESSED": f"needed, by a drive on {need['road']}", "PROVED": "not needed, by proof"}
        print(f"{need['definition']}: {found.get(need['verdict'], 'neither shown needed nor spare')}")
    if data["traffic"] is not None:
        traffic = data["traffic"]
        print(f"of {traffic['disturbances']} disturbances in traffic {len(traffic['missed'])} are missed")
    if data["verdict"] == str(Verdict.COVERED):
        print(f"set {name} misses no danger that arises from safety between two vehicles")
    if data["verdict"] == str(Verdict.CROSSCHECK_FAILED):
        print("traffic shows what is proved not to be, which is our fault: please report it")
