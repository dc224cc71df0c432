"""Whether a spec set misses a disturbance between two vehicles, and what is asked of a drive that shows it.

A gap of a set is a drive that starts in safety (initSafe), comes into danger later, and on which no
scenario of the set holds at the start, for any lane and with the two vehicles in either role.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from roadproof.analysis.placing import zones_of
from roadproof.analysis.requests import Asked
from roadproof.effort import Late
from roadproof.errors import UsageError
from roadproof.evidence.certificate import to_json
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.prove.prover import prove
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Library, Specification
from roadproof.spec.scenarios import Scenario, numbers_of, vehicles_of
from roadproof.verdict import Verdict
from roadproof.world.road import Road

STARTS = "initSafe(SV,POV) and F danger(SV,POV)"
PROOF = 60.0  # units of work for a claim of coverage


@dataclass(frozen=True)
class Covered:
    """The answer to one claim of coverage; ``certificate`` is a file's text where it is proved."""

    claim: str
    verdict: Verdict
    certificate: str | None
    reason: str


def two_vehicle_numbers(specification: Specification) -> tuple[int, ...]:
    """The scenarios between SV and one POV."""
    name = specification.set_name
    numbers = numbers_of(specification)
    return tuple(n for n in numbers if len(vehicles_of(specification, Scenario(n, name))) == 2)


def sectors_of(specification: Specification) -> tuple[tuple[int, ...], ...]:
    """The two-vehicle scenarios, those of one road sector together, in the order of their numbers."""
    sectors: dict[Formula, list[int]] = {}
    for number in two_vehicle_numbers(specification):
        sector = read_claim(specification, f"roadSector_{number}(SV,POV)").formula
        sectors.setdefault(without_names(sector), []).append(number)
    return tuple(map(tuple, sectors.values()))


def numbers_on(specification: Specification, road: Road) -> tuple[int, ...]:
    """The two-vehicle scenarios whose sector's zones the road has; the others cannot hold on it."""
    zones = {lanelet.zone for lanelet in road.lanelets}
    found: list[int] = []
    for sector in sectors_of(specification):
        if zones_of(read_claim(specification, f"roadSector_{sector[0]}(SV,POV)").formula) <= zones:
            found += sector
    return tuple(found)


def claims_of(specification: Specification) -> tuple[str, ...]:
    """Claims that together say that the set has no gap on a road all of whose lanelets are in a zone.

    One for each road sector: where SV is in L, one of the sector's scenarios holds for L. A last one:
    vehicles that are each in a zone are in one of the sectors.
    """
    sectors = sectors_of(specification)
    claims = [
        f"roadSector_{numbers[0]}(SV,POV) and atLane(SV,L) and {STARTS} -> {some_scenario(numbers)}"
        for numbers in sectors
    ]
    somewhere = " and ".join(
        f"(onMainRoad({v}) or inMergeZone({v}) or inDepartZone({v}))" for v in ("SV", "POV")
    )
    some_sector = " or ".join(f"roadSector_{numbers[0]}(SV,POV)" for numbers in sectors)
    return (*claims, f"{somewhere} -> {some_sector}")


def prove_claim(asked: Asked, claim: str) -> Covered:
    """Try to prove one claim about the first set of ``asked``."""
    _, specification = asked.load()
    try:
        result = prove(specification, read_claim(specification, claim), asked.effort.of(PROOF), "coverage")
    except Late as late:
        return Covered(claim, Verdict.UNKNOWN, None, str(late))
    certificate = None if result.certificate is None else to_json(result.certificate)
    return Covered(claim, result.verdict, certificate, result.reason)


def some_scenario(numbers: Sequence[int], lane: str = "L", set_name: str = "") -> str:
    """That one of the scenarios holds, in either role; ``set_name``: those of another set."""
    at = f"@{set_name}" if set_name else ""
    roles = (("SV", "POV"), ("POV", "SV"))
    return " or ".join(f"scenario_{n}{at}({a},{b},{lane})" for a, b in roles for n in numbers)


def missed(numbers: Sequence[int]) -> str:
    """Safety and later danger, and none of the scenarios for any lane and either role."""
    none = [f"not (some M in lanes: {x})" for x in some_scenario(numbers, "M").split(" or ")]
    return " and ".join([STARTS, *none])


def caught(numbers: Sequence[int], set_name: str) -> str:
    """That one of the scenarios of a set holds, for some lane and either role."""
    return f"(some M in lanes: {some_scenario(numbers, 'M', set_name)})"


def replaced_in(narrow: Specification, wide: Specification) -> tuple[str, ...]:
    """The names of the definitions that differ between two sets."""
    return tuple(n for n, d in wide.definitions.items() if narrow.definitions.get(n) != d)


def wider_sets(library: Library, narrow: str, wide: str) -> tuple[str, ...]:
    """The sets from the first extension of ``narrow`` to ``wide``. Raises ``UsageError`` for no extension."""
    chain: list[str] = []
    name = wide
    while name and name != narrow:
        chain.insert(0, name)
        name = library.sets[name].parent
    if name != narrow or not chain:
        raise UsageError(f"--wider {wide} does not extend --set {narrow}: name a set that extends it")
    return tuple(chain)
