"""Whether a set that covers everything needs each definition that it replaces."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from roadproof.analysis.coverage.catalogue import HORIZON, ZERO, catalogue
from roadproof.analysis.coverage.claims import (
    PROOF,
    STARTS,
    claims_of,
    missed,
    replaced_in,
    two_vehicle_numbers,
)
from roadproof.analysis.coverage.trial import TRIAL, Trials
from roadproof.analysis.placing import as_data
from roadproof.analysis.requests import Asked
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.judge.exact import judge
from roadproof.judge.replay import first_breach, first_overlap
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.prove.prover import prove
from roadproof.spec.bind import bind
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Source, Specification, build_library
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.road import Lanelet, Road, pairs


@dataclass(frozen=True)
class Need:
    """WITNESSED: ``drive`` is missed without the definition, as it is in ``parent``, and caught with it.

    PROVED: the set covers everything without it, too. UNKNOWN: neither was found. ``formula`` says what is
    missed with all definitions written out, as no shipped set is the one without the definition.
    """

    definition: str
    parent: str
    verdict: Verdict
    road: str = ""
    formula: str = ""
    drive: Mapping[str, Any] | None = None


# Two cars fit side by side in its lane, as they do not on the reference roads.
WIDE = Road(
    "one lane of 5 m",
    (Lanelet("m1", "main-1", "main", "main", (None, None), (ZERO, Fraction(5))),),
    pairs([]),
)


def replaced_by(asked: Asked) -> tuple[str, ...]:
    """The definitions that the first set of ``asked`` replaces in the set that it extends, if it does."""
    library, specification = asked.load()
    parent = library.sets[asked.sets[0]].parent
    return replaced_in(specification.in_set(parent), specification) if parent else ()


def find_need(asked: Asked, name: str) -> Need:
    """Whether the first set of ``asked`` needs the definition ``name``, one of ``replaced_by``."""
    library, _ = asked.load()
    wide = asked.sets[0]
    parent = library.sets[wide].parent
    trials = Trials(replace(asked, sets=(parent,)), (wide,))
    kept = tuple(n for n in replaced_by(asked) if n != name)
    written = trials.written(wide, kept)
    for road in (load_road("main-2"), WIDE):
        for drive in _dangerous(trials, road):
            if trials.misses(_file(asked, parent, trials, road, drive), wide, kept):
                return _need(asked, trials, name, written, road, drive)
    return _spare(asked, trials, name, written)


def _dangerous(trials: Trials, road: Road) -> Iterator[Drive]:
    """The drives of the catalogue on which danger arises, within the limits of the vehicles."""
    car = load_vehicle("car")
    begins = bind(read_claim(trials.specification, STARTS).formula, road, {}, trials.values)
    for drive in catalogue(road, car):
        if not judge(begins, drive).holds or first_overlap(drive, HORIZON) is not None:
            continue
        if first_breach(drive, dict.fromkeys(drive.vehicles, car), None) is None:
            yield drive


def _file(asked: Asked, set_name: str, trials: Trials, road: Road, drive: Drive) -> DriveFile:
    options = trials.specification.options
    return DriveFile(None, set_name, "", HORIZON, {}, trials.values, options, road, drive)


def _need(asked: Asked, trials: Trials, name: str, written: str, road: Road, drive: Drive) -> Need:
    """The drive as evidence about the set ``written``, judged as a reader would."""
    specification = _select(asked, trials, written)
    query = read_claim(specification, missed(two_vehicle_numbers(specification)))
    formula = text(as_syntax(query.formula, expand=True))
    file = replace(_file(asked, asked.sets[0], trials, road, drive), formula=formula)
    ruling = judge_file(file, trials.library)
    assert ruling.accepted, ruling.reason
    data = as_data(file, ruling)
    return Need(name, trials.asked.sets[0], Verdict.WITNESSED, road.name, formula, data)


def _spare(asked: Asked, trials: Trials, name: str, written: str) -> Need:
    specification = _select(asked, trials, written)
    claims = claims_of(specification)
    effort = asked.effort.of(PROOF)
    proved = all(
        prove(specification, read_claim(specification, c), effort).verdict is Verdict.PROVED for c in claims
    )
    verdict = Verdict.PROVED if proved else Verdict.UNKNOWN
    return Need(name, trials.asked.sets[0], verdict)


def _select(asked: Asked, trials: Trials, written: str) -> Specification:
    library = build_library([Source("trial.spec", written)], trials.library)
    return library.select(TRIAL, asked.options)
