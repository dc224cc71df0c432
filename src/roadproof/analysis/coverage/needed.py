"""Whether a set that covers everything needs each definition that it replaces."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from roadproof.analysis.basis import Basis
from roadproof.analysis.coverage.claims import (
    PROOF,
    claims_of,
    missed,
    replaced_in,
    two_vehicle_numbers,
)
from roadproof.analysis.coverage.found import Trials
from roadproof.analysis.coverage.simple import HORIZON, ZERO, simple_drives
from roadproof.engines.prove.prover import prove
from roadproof.evidence.answers.coverage import NeedVerdict
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind
from roadproof.library.scenarios import PAIR, danger_comes
from roadproof.library.specification import Specification
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.runtime.budget import BudgetExceeded
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.road import Lanelet, Road, pairs


@dataclass(frozen=True)
class Need:
    """WITNESSED: ``drive`` is missed without the definition, as it is in ``parent``, and caught with it.

    PROVED: the set covers everything without it, too. UNKNOWN: neither was found. The formula of the drive
    says what is missed with all definitions written out, as no shipped set is the one without the definition.
    """

    definition: str
    parent: str
    verdict: NeedVerdict
    drive: JudgedDrive | None = None


# Two cars fit side by side in its lane, as they do not on the reference roads.
WIDE = Road(
    "one lane of 5 m",
    (Lanelet("m1", "main-1", "main", "main", (None, None), (ZERO, Fraction(5))),),
    pairs([]),
)


def parent_of(specification: Specification) -> str:
    """The set that a set extends, empty where it extends none."""
    return specification.library.sets[specification.set_name].parent


def replaced_by(specification: Specification) -> tuple[str, ...]:
    """The definitions that a set replaces in the set that it extends, if it does."""
    parent = parent_of(specification)
    return replaced_in(specification.in_set(parent), specification) if parent else ()


def find_need(basis: Basis, name: str) -> Need:
    """Whether a set needs the definition ``name``, one of ``replaced_by``."""
    wide, parent = basis.specification.set_name, parent_of(basis.specification)
    trials = Trials(replace(basis, specification=basis.specification.in_set(parent)), (wide,))
    kept = tuple(n for n in replaced_by(basis.specification) if n != name)
    without = trials.trial(wide, kept)
    for road in (load_road("main-2"), WIDE):
        for drive in _dangerous(trials, road):
            options = basis.specification.options
            file = DriveFile(None, wide, "", HORIZON, {}, trials.values, options, road, drive)
            if trials.misses(file, wide, kept):
                return Need(name, parent, Verdict.WITNESSED, _judged(basis, without, file))
    return Need(name, parent, _covers(basis, without))


def _dangerous(trials: Trials, road: Road) -> Iterator[Drive]:
    """The simple drives on which danger arises, within the limits of the vehicles."""
    if trials.specification.library.freedom:
        return  # simple drives say nothing of own signals
    car = load_vehicle("car")
    begins = bind(danger_comes(trials.specification, *PAIR).formula, road, {}, trials.values)
    for drive in simple_drives(road, car):
        if not judge(begins, drive).holds or first_overlap(drive, HORIZON) is not None:
            continue
        if first_breach(drive, dict.fromkeys(drive.vehicles, car), None) is None:
            yield drive


def _judged(basis: Basis, without: Specification, file: DriveFile) -> JudgedDrive:
    """The drive as one that is missed without the definition, judged as a reader would."""
    query = missed(without, two_vehicle_numbers(without))
    formula = text(as_syntax(query.formula, expand=True))
    return JudgedDrive(replace(file, formula=formula), basis.library)


def _covers(basis: Basis, without: Specification) -> NeedVerdict:
    """PROVED where coverage is proved without the definition, too, else UNKNOWN."""
    effort = basis.effort.of(PROOF)
    try:
        proved = all(prove(without, x, effort).verdict is Verdict.PROVED for x in claims_of(without))
    except BudgetExceeded:
        return Verdict.UNKNOWN
    return Verdict.PROVED if proved else Verdict.UNKNOWN
