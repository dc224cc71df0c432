"""Turns a state that refutes a claim about one instant into a drive of constant accelerations."""

from collections.abc import Mapping
from fractions import Fraction

from roadproof.engines.prove.states import TYPICAL_SIZE
from roadproof.errors import RoadproofError
from roadproof.evidence.countermodel import NOWHERE, Countermodel
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import values_with
from roadproof.library.compose import negation
from roadproof.library.specification import Query, Specification
from roadproof.logic.custom_names import kind_of
from roadproof.logic.formula import is_state
from roadproof.logic.initial_conditions import forced_values
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.signals import FIXED, SIGNALS, SIZES, STARTING

_JERK = "j_lon"


def steady_drive(
    specification: Specification,
    claim: Query,
    countermodel: Countermodel,
    parameters: Mapping[str, Fraction] | None = None,
) -> JudgedDrive | None:
    """Return the first state of ``countermodel`` with constant accelerations, judged to refute ``claim``.

    None where the claim is about vehicles at more than one instant, has numbers or custom signals of its own,
    or needs jerk or other values than ``parameters`` (by default the declared ones and those that its
    premise forces); and where the judge rejects the drive.
    """
    if claim.vehicles and not is_state(claim.formula):
        return None
    values = countermodel.instants[0].values
    known = {
        f"{name}({vehicle})" for vehicle in claim.vehicles for name in (*SIGNALS, *FIXED) if name != _JERK
    }
    jerks = {f"{_JERK}({vehicle})" for vehicle in claim.vehicles}
    if any(name not in known | jerks for name in values) or any(values.get(name, 0) for name in jerks):
        return None
    library = specification.library
    expected = values_with(library, forced_values(claim.formula)) if parameters is None else parameters
    if any(expected.get(name) != value for name, value in countermodel.parameters.items()):
        return None
    refuted = negation(claim)
    drive = Drive({vehicle: _steady(vehicle, values) for vehicle in claim.vehicles})
    lanes = {lane: lane for lane in claim.lanes}
    file = DriveFile(
        None,
        specification.set_name,
        refuted.text,
        Fraction(0),
        lanes,
        countermodel.parameters,
        specification.options,
        countermodel.road or NOWHERE,
        drive,
        overlaps_allowed=True,
    )
    try:
        return JudgedDrive(file, library)
    except RoadproofError:
        return None


def _steady(vehicle: str, values: Mapping[str, Fraction]) -> Motion:
    """Return a motion from a state; missing signals are 0 and missing sizes typical."""

    def of(name: str, usual: Fraction = Fraction(0)) -> Fraction:
        return values.get(f"{name}({vehicle})", usual)

    kind = values.get(f"kind({vehicle})")
    length, width = (of(name, TYPICAL_SIZE[name]) for name in SIZES)
    begins = {name: of(name) for name in STARTING}
    pieces = (Piece(None, of("a_lon"), of("a_lat")),)
    return Motion(length, width, **begins, pieces=pieces, kind=None if kind is None else kind_of(kind))
