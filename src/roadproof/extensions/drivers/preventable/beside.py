"""The boundary of a plate, and judged drives on both sides: SV follows its model, and touches POV or not."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import islice, pairwise
from math import ceil

from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.claim import Claim, parameters_in
from roadproof.evidence.judged import JudgedDrive, RejectedError
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import drive_of
from roadproof.extensions.drivers.gradual import RATE
from roadproof.extensions.drivers.lines import Side, boundary_text
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES, CutIn, Manoeuvre, Plane, Values, start_of
from roadproof.extensions.drivers.models import driver_model, parameters_of, passed
from roadproof.extensions.drivers.preventable.boundary import (
    BesideBoundary,
    Labels,
    Truths,
    exact_truths,
    lines_of_labels,
    lines_of_truths,
    reading_of,
    side_file,
)
from roadproof.extensions.drivers.preventable.boundary_file import BoundaryFile
from roadproof.extensions.drivers.preventable.plate import Plate
from roadproof.extensions.drivers.stepped import beside_change, labels_of
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.canonical import digest
from roadproof.semantics.exact.algebraic import Point, bounds
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.truth import TruthSet

_ROWS = 10  # in which a drive of a scenario is looked for
_FINE = 10**9  # of a line, for spans that have no place with few digits
_LOOKED_AT = 400  # candidates for a drive
_NEAR = Fraction(1, 10)  # m from the boundary
_PARTS = (Fraction(1, 2), Fraction(3, 8), Fraction(1, 4), Fraction(1, 8))  # of a span, from its lower end


def decide_lines(claim: Claim, plate: Plate) -> ClaimAnswer:
    """Return where on the lines of a plate the formula of a claim holds."""
    home = claim.home
    if driver_model(plate.model).is_stepped:
        lines = lines_of_labels(plate, _labels(claim, plate))
    else:
        lines = lines_of_truths(plate, _truths(claim, plate))
    file = BoundaryFile(
        set=home.set_name,
        options=dict(home.options),
        claim=claim.query.text,
        parameters={x.name: x.value for x in claim.parameters},
        plate=plate,
        lines=lines,
    )
    return ClaimAnswer(claim, file)


def decide_beside(claim: Claim, mode: BesideBoundary) -> ClaimAnswer:
    """Return a drive on one side of the boundary of a plate, of what is preferred where there is one."""
    home, reading = claim.home, reading_of(claim)
    plane, model, side = mode.plate.plane, mode.plate.model, mode.side
    places: Iterable[dict[str, Fraction]]
    if driver_model(model).is_stepped:
        places = beside_change(plane, _labels(claim, mode.plate), side == "unpreventable")
    else:
        places = beside_boundary(plane, _truths(claim, mode.plate), side)
    if mode.of:
        places = [*places]
        rows = far_apart(plane, places, _ROWS)
        for also in mode.of_texts:
            shown = first_drive(plane, model, rows, side, home, reading, also, most=len(rows))
            if not isinstance(shown, Reason):
                return ClaimAnswer(claim, shown[1])
    drive = first_drive(plane, model, places, side, home, reading)
    return undecided(claim, drive) if isinstance(drive, Reason) else ClaimAnswer(claim, drive[1])


def _truths(claim: Claim, plate: Plate) -> Truths:
    """Return where on each line a collision is unpreventable; worked out once."""
    home, values = claim.home, reading_of(claim).values
    boundary = read_claim(home, boundary_text(MANOEUVRES[plate.manoeuvre], plate.model, plate.fixed))
    of_motion = parameters_of(plate.model) if RATE in plate.fixed else ()
    key = (
        _truths,
        digest(plate, parameters_in(home.library, [boundary.formula], values, further_names=of_motion)),
    )
    known = home.memo
    if key not in known:
        known[key] = exact_truths(home, plate, values)
    truths: Truths = known[key]
    return truths


def _labels(claim: Claim, plate: Plate) -> Labels:
    """Return at which places of each line the boxes touch; worked out once."""
    known, key = claim.home.memo, (_labels, digest(plate))
    if key not in known:
        known[key] = labels_of(plate.plane)
    labels: Labels = known[key]
    return labels


def judged_drive(
    manoeuvre: Manoeuvre,
    model: str,
    values: Values,
    side: Side,
    specification: Specification,
    reading: DriverSettings,
    also: str = "",
) -> JudgedDrive:
    """The drive from these values, judged, on ``also``, too: a formula about it in the lane of SV.

    Raises ``RejectedError``, and ``InputError`` as ``drive_of``.
    """
    file = side_file(manoeuvre, model, values, side, specification, reading, also)
    if also:  # what is about the scenario alone is quickly seen to be false
        JudgedDrive(replace(file, formula=also), specification.library)
    return JudgedDrive(file, specification.library)


def beside_boundary(plane: Plane, lines: tuple[TruthSet, ...], side: Side) -> Iterator[dict[str, Fraction]]:
    """Initial values near the boundary on one side, those of middle rows first."""
    middle = (plane.across[0] + plane.across[1]) / 2
    rows = sorted(zip(plane.rows, lines, strict=True), key=lambda x: abs(x[0] - middle))
    for row, true in rows:
        for place in _places(plane, true, side):
            yield plane.values(row, place)


def _places(plane: Plane, true: TruthSet, side: Side) -> Iterator[Fraction]:
    """Places with few digits that are on the wanted side of an end of a span; then some of each span."""
    low, high = plane.along
    is_inside = side == "unpreventable"
    ends = [cut.point for cut in reversed(true.cuts)] or [high if side == "preventable" else low]
    for end in ends:
        middle = _near(end, _NEAR / 100)
        for step in (_NEAR, -_NEAR, _NEAR / 10, -_NEAR / 10):
            place = Fraction(round((middle + step) * 100), 100)
            if low <= place <= high and true.at(place) is is_inside:
                yield place
    near = (_near(cut.point, (high - low) / _FINE) for cut in true.cuts)
    for one, other in pairwise(sorted((low, *near, high))):
        if true.at((one + other) / 2) is is_inside and one < other:
            yield from (one + (other - one) * part for part in _PARTS)


def _near(point: Point, width: Fraction) -> Fraction:
    """A fraction that is no farther from a point than that."""
    low, high = bounds(point, width)
    return (low + high) / 2


def first_drive(
    plane: Plane,
    model: str,
    candidates: Iterable[dict[str, Fraction]],
    side: Side,
    specification: Specification,
    reading: DriverSettings,
    also: str = "",
    most: int = 3,
) -> tuple[dict[str, Fraction], JudgedDrive] | Reason:
    """A judged drive from one of the candidates, initial values of that side; or why there is none.

    ``also`` as for ``judged_drive``; ``most`` candidates are tried, besides those that have no exact drive.
    A drive that is rejected, though nothing else is asked of it, contradicts the boundary: no other is tried.
    But places of which the boundary says more than a drive can show are passed over once one is rejected.
    """
    reason = ReasonKind.NO_PLACE(side)
    tried, manoeuvre, is_met = 0, plane.manoeuvre, False
    without = partial(_is_without_drive, manoeuvre, model, specification, reading)
    left = (x for x in candidates if not (is_met and without(x)))
    for values in islice(left, _LOOKED_AT):
        try:
            return values, judged_drive(manoeuvre, model, values, side, specification, reading, also)
        except RejectedError as error:
            if not is_met and side == "preventable" and not also and without(values):
                is_met, reason = True, ReasonKind.PASSED()
                continue
            tried, reason = tried + 1, ReasonKind.TOLD(error)
            if not also:
                values_text = ", ".join(f"{name}={value}" for name, value in values.items())
                return ReasonKind.CONTRADICTS_BOUNDARY(values_text, side, reason)
        except InputError as error:
            reason = ReasonKind.TOLD(error)
        if tried == most:
            break
    return reason


def _is_without_drive(
    manoeuvre: Manoeuvre, model: str, home: Specification, reading: DriverSettings, values: Values
) -> bool:
    """Return whether no drive of a preventable cut-in is to be expected from these values.

    Either SV passes POV, which then may hit it from behind; or a gate never opens, and the formula of a
    driver is about one who brakes. False where there is no exact drive.
    """
    start = start_of(manoeuvre, values)
    if not isinstance(start, CutIn):
        return False
    law = driver_model(model).law
    if law is not None and law.never_brakes(start, reading):
        return True
    try:
        drive = drive_of(manoeuvre, model, values, reading)
    except InputError:
        return False
    past = read_claim(home, f"F {passed(manoeuvre.vehicles)}").formula
    return judge(past, drive).holds


def far_apart(
    plane: Plane, candidates: Iterable[dict[str, Fraction]], most: int
) -> list[dict[str, Fraction]]:
    """The first candidate of each row and the last ones, of at most so many rows."""
    rows: dict[Fraction, list[dict[str, Fraction]]] = {}
    for values in candidates:
        rows.setdefault(values[plane.manoeuvre.across], []).append(values)
    some = list(rows.values())[:: ceil(len(rows) / most) or 1]
    return [values for row in some for values in (row[0], *row[1:][-len(_PARTS) :])]
