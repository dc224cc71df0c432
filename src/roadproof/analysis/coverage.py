"""Which disturbances a spec set misses: a proof that there is none, or drives, sorted by what catches them.

A gap of a set is a drive that starts in safety (initSafe), comes into danger later, and on which no
scenario of the set holds at the start, for any lane and with the two vehicles in either role. A wider set
replaces definitions; each replacement is left out in turn, so that a drive which is missed then shows
what it is for.
"""

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path
from typing import Any

from roadproof.analysis.meeting import Node, scenario_numbers, vehicles_of
from roadproof.analysis.overlap import Asked
from roadproof.analysis.placing import as_data, zones_of
from roadproof.evidence.certificate import to_json
from roadproof.evidence.witness import DriveFile, from_json, judge_file
from roadproof.judge.exact import judge
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.logic.show import text
from roadproof.prove.prover import prove
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Library, Source, Specification, build_library
from roadproof.verdict import Verdict
from roadproof.witness.ask import Request, ask
from roadproof.witness.question import Means
from roadproof.world.models import load_road

STARTS = "initSafe(SV,POV) and F danger(SV,POV)"
TRIAL = "trial"


@dataclass(frozen=True)
class Covered:
    """The answer to one claim of coverage; ``certificate`` is a file's text where it is proved."""

    claim: str
    verdict: Verdict
    certificate: str | None
    reason: str


@dataclass(frozen=True)
class Gap:
    """A judged drive that ``set_name`` misses. ``without``: the definitions that were left out of the wider
    set when it was found; ``caught_by``: the smallest choices of definitions of the wider set that catch it.
    """

    set_name: str
    road: str
    without: tuple[str, ...]
    caught_by: tuple[tuple[str, ...], ...]
    formula: str
    drive: Mapping[str, Any]


@dataclass(frozen=True)
class NoGap:
    """No drive was found that needs ``without``; ``reason`` says within which limits."""

    road: str
    without: tuple[str, ...]
    verdict: Verdict
    reason: str


def two_vehicle_numbers(specification: Specification) -> tuple[int, ...]:
    """The scenarios between SV and one POV."""
    name = specification.set_name
    numbers = scenario_numbers(specification)
    return tuple(n for n in numbers if len(vehicles_of(specification, Node(n, name))) == 2)


def claims_of(specification: Specification) -> tuple[str, ...]:
    """Claims that together say that the set has no gap on a road all of whose lanelets are in a zone.

    One for each road sector: where SV is in L, one of the sector's scenarios holds for L. A last one:
    vehicles that are each in a zone are in one of the sectors.
    """
    sectors: dict[Formula, list[int]] = {}
    for number in two_vehicle_numbers(specification):
        sector = read_claim(specification, f"roadSector_{number}(SV,POV)").formula
        sectors.setdefault(without_names(sector), []).append(number)
    claims = [
        f"roadSector_{numbers[0]}(SV,POV) and atLane(SV,L) and {STARTS} -> {' or '.join(_either(numbers))}"
        for numbers in sectors.values()
    ]
    somewhere = " and ".join(
        f"(onMainRoad({v}) or inMergeZone({v}) or inDepartZone({v}))" for v in ("SV", "POV")
    )
    some_sector = " or ".join(f"roadSector_{numbers[0]}(SV,POV)" for numbers in sectors.values())
    return (*claims, f"{somewhere} -> {some_sector}")


def _either(numbers: Sequence[int], lane: str = "L", at: str = "") -> list[str]:
    return [f"scenario_{n}{at}({a},{b},{lane})" for a, b in (("SV", "POV"), ("POV", "SV")) for n in numbers]


def prove_coverage(asked: Asked) -> list[Covered]:
    """Try to prove every claim of ``claims_of`` for the first set of ``asked``."""
    _, specification = asked.load()
    answers: list[Covered] = []
    for claim in claims_of(specification):
        result = prove(specification, claim, 5 * asked.proof_seconds, "coverage")
        certificate = None if result.certificate is None else to_json(result.certificate)
        answers.append(Covered(claim, result.verdict, certificate, result.reason))
    return answers


def replaced_in(narrow: Specification, wide: Specification) -> tuple[str, ...]:
    """The names of the definitions that differ between two sets."""
    return tuple(n for n, d in wide.definitions.items() if narrow.definitions.get(n) != d)


def find_gaps(asked: Asked, wider: str, road: str) -> Iterator[Gap | NoGap]:
    """Drives on ``road`` that the first set of ``asked`` misses, one for each definition of ``wider``.

    Definitions that are needed by no drive alone are left out together at the end.
    """
    _, specification = asked.load()
    names = replaced_in(specification, specification.in_set(wider))
    finding = _Finding(asked, wider, road, names)
    spare: list[str] = []
    for name in names:
        found = finding.without((name,))
        if isinstance(found, NoGap):
            spare.append(name)
        yield found
    if len(spare) > 1:
        yield finding.without(tuple(spare))


class _Finding:
    def __init__(self, asked: Asked, wider: str, road: str, names: tuple[str, ...]) -> None:
        self.asked = asked
        self.wider = wider
        self.names = names
        self.library, self.specification = asked.load()
        self.wide = self.specification.in_set(wider)
        self.road = load_road(road)
        self.numbers = two_vehicle_numbers(self.specification)
        self.values = {**default_values(self.library), **asked.values}

    def without(self, left_out: tuple[str, ...]) -> Gap | NoGap:
        """A drive that is missed even with all definitions of the wider set but those ``left_out``."""
        kept = tuple(name for name in self.names if name not in left_out)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "trial.spec"
            path.write_text(self._trial(kept), "utf-8")
            request = Request(
                missed(self._here()),
                TRIAL,
                self.asked.options,
                (*self.asked.specs, path),
                self.values,
                self.road.name,
                horizon=self.asked.horizon,
                means=Means("smooth", time_limit=self.asked.timeout, explain=False),
            )
            outcome = ask(request)
        if not outcome.drives:
            limits = f"{self.asked.timeout:g} s of search, {self.asked.horizon} s of driving"
            return NoGap(self.road.name, left_out, outcome.verdict, f"{outcome.reason} ({limits})")
        formula = missed(self.numbers)
        found = from_json(dict(outcome.drives[0]), "drive")
        file = replace(found, set_name=self.asked.sets[0], formula=formula)
        ruling = judge_file(file, self.library)
        if not ruling.accepted:
            return NoGap(self.road.name, left_out, Verdict.UNKNOWN, f"a drive was rejected: {ruling.reason}")
        data = as_data(file, ruling)
        return Gap(self.asked.sets[0], self.road.name, left_out, self._smallest(file), formula, data)

    def _here(self) -> tuple[int, ...]:
        """The scenarios whose sector's zones the road has; the others cannot hold on it."""
        zones = {lanelet.zone for lanelet in self.road.lanelets}
        sectors = {n: read_claim(self.specification, f"roadSector_{n}(SV,POV)") for n in self.numbers}
        return tuple(n for n, sector in sectors.items() if zones_of(sector.formula) <= zones)

    def _trial(self, names: Sequence[str]) -> str:
        body = "\n".join(f"  {text(self.wide.definitions[name])}" for name in names)
        return f"set {TRIAL} extends {self.asked.sets[0]} {{\n{body}\n}}\n"

    def _smallest(self, file: DriveFile) -> tuple[tuple[str, ...], ...]:
        """The smallest choices of definitions of the wider set with which a scenario holds."""
        for size in range(1, len(self.names) + 1):
            catching = tuple(x for x in combinations(self.names, size) if not self._misses(file, x))
            if catching:
                return catching
        return ()

    def _misses(self, file: DriveFile, names: Sequence[str]) -> bool:
        library: Library = build_library([Source("trial.spec", self._trial(names))], self.library)
        query = read_claim(library.select(TRIAL, self.asked.options), missed(self._here()))
        values = {**self.values, **file.values}
        return judge(bind(query.formula, file.road, file.lanes, values), file.drive).holds


def missed(numbers: Sequence[int]) -> str:
    """Safety and later danger, and none of the scenarios for any lane and either role."""
    none = [f"not (some M in lanes: {scenario})" for scenario in _either(numbers, "M")]
    return " and ".join([STARTS, *none])
