"""The boundary of a plate, worked out from its formula or from the motion of its model, and drives beside it.

A drive from given initial values is a function of these, so a file is compared with the drive that the model
makes from the place at which the drive of the file begins.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Protocol, TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.claim import Claim
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import OWN_LANE, drive_of, rest_of, road_of
from roadproof.extensions.drivers.lines import (
    PlateLine,
    Side,
    boundary_text,
    claim_of,
    end_of,
    line_of_truth,
    truths,
    with_also,
)
from roadproof.extensions.drivers.manoeuvres import (
    FIRST,
    MANOEUVRES,
    Manoeuvre,
    Values,
    is_possible,
    signals_of,
)
from roadproof.extensions.drivers.models import driver_model
from roadproof.extensions.drivers.preventable.plate import Plate, PlateLineData
from roadproof.extensions.drivers.stepped import labels_of, places_of, spans_of
from roadproof.library.bind import values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import LANE, SUBJECT
from roadproof.library.specification import Library, Specification
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.truth import TruthSet
from roadproof.world.drive import Drive
from roadproof.world.signals import STARTING

if TYPE_CHECKING:
    from roadproof.extensions.drivers.preventable.boundary_file import BoundaryFile

Truths: TypeAlias = tuple[TruthSet, ...]
Labels: TypeAlias = tuple[tuple[bool, ...], ...]


def exact_truths(home: Specification, plate: Plate, values: Mapping[str, Fraction]) -> Truths:
    """Return where on each line a collision is unpreventable; ``values``: of parameters (SI)."""
    return tuple(truths(home, plate.plane, plate.model, values))


def lines_of_truths(plate: Plate, true: Truths) -> tuple[PlateLineData, ...]:
    """Return the lines of a plate as files have them."""
    return tuple(
        PlateLineData.of(line_of_truth(row, x)) for row, x in zip(plate.plane.rows, true, strict=True)
    )


def lines_of_labels(plate: Plate, labels: Labels) -> tuple[PlateLineData, ...]:
    """Return the lines of a plate of a controller that is stepped, as files have them."""
    places, rows = places_of(plate.plane), plate.plane.rows
    spans = (tuple((end_of(a), end_of(b)) for a, b in spans_of(places, x)) for x in labels)
    return tuple(PlateLineData.of(PlateLine(row, x)) for row, x in zip(rows, spans, strict=True))


def fault_of(file: "BoundaryFile", library: Library) -> str:
    """Return where a file says otherwise than what is worked out from its plate, or nothing.

    Raises ``InputError`` and ``UsageError`` for a plate that is none.
    """
    home, plate = library.select(file.set, file.options), file.plate
    expected = boundary_text(MANOEUVRES[plate.manoeuvre], plate.model, plate.fixed)
    if plate.manoeuvre not in driver_model(plate.model).manoeuvres:
        raise InputError(f"model={plate.model} says nothing of manoeuvre={plate.manoeuvre}")
    if read_claim(home, file.claim).formula != read_claim(home, expected).formula:
        return f"its formula is {file.claim[:80]}, but that of its model is {expected}"
    if plate.lines != len(file.lines):
        return f"it has {len(file.lines)} lines, but {plate.lines} are asked for"
    known = _worked_out(home, plate, values_with(library, file.parameters))
    wrong = next((x for stated, x in zip(file.lines, known, strict=True) if stated != x), None)
    if wrong is None:
        return ""
    across = MANOEUVRES[plate.manoeuvre].across
    return f"it says otherwise at {across}={wrong.at} than its formula or its motion"


def _worked_out(
    home: Specification, plate: Plate, values: Mapping[str, Fraction]
) -> tuple[PlateLineData, ...]:
    if driver_model(plate.model).is_stepped:
        return lines_of_labels(plate, labels_of(plate.plane))
    return lines_of_truths(plate, exact_truths(home, plate, values))


# --- drives ------------------------------------------------------------------------------------------


def side_file(
    manoeuvre: Manoeuvre,
    model: str,
    values: Values,
    side: Side,
    specification: Specification,
    reading: DriverSettings,
    also: str = "",
) -> DriveFile:
    """Return the drive from these values, as one that shows its side, and ``also`` in the lane of SV.

    Raises ``InputError`` as ``drive_of``.
    """
    drive = drive_of(manoeuvre, model, values, reading)
    return DriveFile(
        None,
        specification.set_name,
        with_also(claim_of(manoeuvre, model, values, side, reading), also),
        rest_of(drive),
        {LANE: OWN_LANE} if also else {},
        reading.values,
        reading.options,
        road_of(manoeuvre, values),
        drive,
        overlaps_allowed=True,
    )


def reading_of(claim: Claim) -> DriverSettings:
    """Return the values of parameters and the options with which a model moves in a claim."""
    return DriverSettings({x.name: x.value for x in claim.parameters}, dict(claim.home.options))


class BesideBoundary(Protocol):
    """A form of claims about drives beside a boundary (``claims.Beside``)."""

    @property
    def plate(self) -> Plate: ...

    @property
    def side(self) -> Side: ...

    @property
    def of(self) -> tuple[Formula, ...]: ...

    @property
    def of_texts(self) -> tuple[str, ...]: ...


def start_of(claim: Claim, mode: BesideBoundary, file: DriveFile) -> tuple[dict[str, Fraction], str] | None:
    """Return from which initial values a drive begins that decides a claim, and what it is of besides.

    None: it is not the drive of the model from a place of the plate, or shows another side.
    """
    manoeuvre, model, reading = MANOEUVRES[mode.plate.manoeuvre], mode.plate.model, reading_of(claim)
    for at in _starts(mode.plate, file.drive):
        for also in ("", *mode.of_texts):
            expected = side_file(manoeuvre, model, at, mode.side, claim.home, reading, also)
            if expected == file:
                return at, also
            if expected.drive != file.drive:
                break
    return None


def _starts(plate: Plate, drive: Drive) -> Iterator[dict[str, Fraction]]:
    """Yield initial values of the plate from which a drive may begin: the gap says the place on a line."""
    plane, manoeuvre = plate.plane, MANOEUVRES[plate.manoeuvre]
    if {*drive.vehicles} != {*manoeuvre.vehicles}:
        return
    ahead = drive.vehicles[manoeuvre.vehicles[-1]]
    behind = drive.vehicles[FIRST if FIRST in drive.vehicles else SUBJECT]
    place = ahead.s - ahead.length - behind.s
    if plane.along[0] <= place <= plane.along[1]:
        for row in plane.rows:
            at = plane.values(row, place)
            if is_possible(at) and _begins_at(manoeuvre, at, drive):
                yield at


def _begins_at(manoeuvre: Manoeuvre, at: Values, drive: Drive) -> bool:
    """Return whether the vehicles of a drive are where initial values say, and as fast."""
    states = signals_of(manoeuvre, at)
    every = ((x, name, motion) for name, motion in drive.vehicles.items() for x in STARTING)
    return all(getattr(motion, x) == states[x, name] for x, name, motion in every)
