"""Judged drives on both sides of a boundary: SV follows its model, and touches POV, or never does."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import islice, pairwise
from math import ceil

from roadproof.drivers.driving import OWN_LANE, DriverSettings, drive_of, rest_of, road_of
from roadproof.drivers.lines import Side, claim_of, with_also
from roadproof.drivers.manoeuvres import CutIn, Manoeuvre, Plane, Values, start_of
from roadproof.drivers.models import ModelName, passed
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, RejectedError
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import LANE
from roadproof.library.specification import Specification
from roadproof.reasons import Reason, Why
from roadproof.semantics.exact.algebraic import Point, bounds
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.truth import TruthSet

_FINE = 10**9  # of a line, for spans that have no place with few digits
_LOOKED_AT = 400  # candidates for a drive
_NEAR = Fraction(1, 10)  # m from the boundary
_PARTS = (Fraction(1, 2), Fraction(3, 8), Fraction(1, 4), Fraction(1, 8))  # of a span, from its lower end


def judged_drive(
    manoeuvre: Manoeuvre,
    model: ModelName,
    values: Values,
    side: Side,
    specification: Specification,
    reading: DriverSettings,
    also: str = "",
) -> JudgedDrive:
    """The drive from these values, judged, on ``also``, too: a formula about it in the lane of SV.

    Raises ``RejectedError``, and ``InputError`` as ``drive_of``.
    """
    drive = drive_of(manoeuvre, model, values, reading)
    file = DriveFile(
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
    wanted = side == "unpreventable"
    ends = [cut.point for cut in reversed(true.cuts)] or [high if side == "preventable" else low]
    for end in ends:
        middle = _near(end, _NEAR / 100)
        for step in (_NEAR, -_NEAR, _NEAR / 10, -_NEAR / 10):
            place = Fraction(round((middle + step) * 100), 100)
            if low <= place <= high and true.at(place) is wanted:
                yield place
    near = (_near(cut.point, (high - low) / _FINE) for cut in true.cuts)
    for one, other in pairwise(sorted((low, *near, high))):
        if true.at((one + other) / 2) is wanted and one < other:
            yield from (one + (other - one) * part for part in _PARTS)


def _near(point: Point, width: Fraction) -> Fraction:
    """A fraction that is no farther from a point than that."""
    low, high = bounds(point, width)
    return (low + high) / 2


def first_drive(
    plane: Plane,
    model: ModelName,
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
    reason = Why.NO_PLACE(side)
    tried, manoeuvre, is_met = 0, plane.manoeuvre, False
    without = partial(_is_without_drive, manoeuvre, model, specification, reading)
    left = (x for x in candidates if not (is_met and without(x)))
    for values in islice(left, _LOOKED_AT):
        try:
            return values, judged_drive(manoeuvre, model, values, side, specification, reading, also)
        except RejectedError as error:
            if not is_met and side == "preventable" and not also and without(values):
                is_met, reason = True, Why.PASSED()
                continue
            tried, reason = tried + 1, Why.TOLD(error)
            if not also:
                told = ", ".join(f"{name}={value}" for name, value in values.items())
                return Why.CONTRADICTS_BOUNDARY(told, side, reason)
        except InputError as error:
            reason = Why.TOLD(error)
        if tried == most:
            break
    return reason


def _is_without_drive(
    manoeuvre: Manoeuvre, model: ModelName, home: Specification, reading: DriverSettings, values: Values
) -> bool:
    """Whether no drive of a preventable cut-in is to be expected from these values.

    Either SV passes POV, which then may hit it from behind; or a gate never opens, and the formula of a
    driver is about one who brakes. False where there is no exact drive.
    """
    start = start_of(manoeuvre, values)
    if not isinstance(start, CutIn):
        return False
    if model == "careful" and reading.choices.cc_gate != "none" and start.dV0 <= 0:
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
