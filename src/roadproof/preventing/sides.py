"""Judged drives on both sides of a boundary: SV follows its model, and touches POV, or never does."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import islice, pairwise
from math import ceil
from typing import Literal, TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import Judged, RejectedError
from roadproof.judge.algebraic import Point, bounds
from roadproof.judge.truth import TruthSet
from roadproof.preventing.boundary import Plane
from roadproof.preventing.driving import OWN_LANE, Reading, drive_of, is_aided, rest_of, road_of, speeds_of
from roadproof.preventing.manoeuvres import Manoeuvre, Values, lane_width
from roadproof.preventing.models import GRADUAL, MODELS, follows, foreseen, touched, unpreventable, untouched
from roadproof.spec.library import Specification
from roadproof.spec.scenarios import LANE
from roadproof.world.drive import Drive

Side: TypeAlias = Literal["unpreventable", "preventable"]
SIDES: tuple[Side, ...] = ("unpreventable", "preventable")
_FINE = 10**9  # of a line, for spans that have no place with few digits
_LOOKED_AT = 400  # candidates for a drive
_NEAR = Fraction(1, 10)  # m from the boundary
_PARTS = (Fraction(1, 2), Fraction(3, 8), Fraction(1, 4), Fraction(1, 8))  # of a span, from its lower end


def claim_of(manoeuvre: Manoeuvre, model: str, values: Values, side: Side, reading: Reading) -> str:
    """What the drive from these values shows: its side, the model followed, and what comes of it.

    Of a controller that is stepped: only how the drive begins, and what comes of it. Where POV's braking
    grows at a finite rate: that SV follows its model, and what comes of it.
    """
    vehicles = manoeuvre.vehicles
    met = touched(vehicles) if side == "unpreventable" else untouched(vehicles)
    if "dGdt" in values:
        driven = follows(GRADUAL, model, vehicles, _numbers(manoeuvre, values))
        return f"{foreseen(GRADUAL, vehicles)} and {driven} and {met}"
    begins = foreseen(manoeuvre.name, vehicles)
    if MODELS[model].is_stepped:
        return f"{begins} and {met}"
    boundary = unpreventable(manoeuvre.name, model, vehicles)
    numbers = _numbers(manoeuvre, values)
    if manoeuvre.name == "cut-in" and is_aided(model, reading):
        numbers += tuple(_number(speed, "m/s") for speed in speeds_of(values, reading))
    driven = follows(manoeuvre.name, model, vehicles, numbers)
    if side == "unpreventable":
        return f"{boundary} and {driven} and {met}"
    return f"{begins} and not {boundary} and {driven} and {met}"


def _numbers(manoeuvre: Manoeuvre, values: Values) -> tuple[str, ...]:
    lane, speed = lane_width(values), _number(values["Ve0"], "m/s")
    beside = (lane + values["width"]) / 2
    match manoeuvre.name:
        case "cut-in":
            return (_number(beside + lane, "m"), _number(values["dy0"], "m"), speed)
        case "cut-out":
            return (_number(beside, "m"), speed)
        case _:
            numbers = (speed, _number(values["Gx"], "m/s^2"))
            if "dGdt" not in values:
                return numbers
            other = _number(values["Ve0"] - values["dV0"], "m/s")
            return (speed, other, numbers[1], _number(values["dGdt"], "m/s^3"))


def _number(value: Fraction, unit: str) -> str:
    """A value in the language, exactly."""
    return f"{value} {unit}" if value.denominator == 1 else f"{value}*1 {unit}"


def with_also(claim: str, also: str) -> str:
    """A claim about a drive, and what else is true of it; empty where nothing else is said."""
    return f"{claim} and {also}" if also else claim


def judged_drive(
    manoeuvre: Manoeuvre,
    model: str,
    values: Values,
    side: Side,
    specification: Specification,
    reading: Reading,
    also: str = "",
) -> Judged:
    """The drive from these values, judged, on ``also``, too: a formula about it in the lane of SV.

    Raises ``RejectedError``, and ``InputError`` as ``drive_of``.
    """
    drive = drive_of(manoeuvre, model, values, reading)
    return _judged(drive, manoeuvre, model, values, side, specification, reading, also)


def _judged(
    drive: Drive,
    manoeuvre: Manoeuvre,
    model: str,
    values: Values,
    side: Side,
    specification: Specification,
    reading: Reading,
    also: str,
) -> Judged:
    file = DriveFile(
        None,
        specification.set_name,
        with_also(claim_of(manoeuvre, model, values, side, reading), also),
        rest_of(drive),
        {LANE: OWN_LANE} if also else {},
        reading.values,
        reading.options,
        road_of(values),
        drive,
        overlaps_allowed=True,
    )
    if also:  # what is about the scenario alone is quickly seen to be false
        Judged(replace(file, formula=also), specification.library)
    return Judged(file, specification.library)


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
    model: str,
    candidates: Iterable[dict[str, Fraction]],
    side: Side,
    specification: Specification,
    reading: Reading,
    also: str = "",
    most: int = 3,
) -> tuple[dict[str, Fraction], Judged] | str:
    """A judged drive from one of the candidates, initial values of that side; or why there is none.

    ``also`` as for ``judged_drive``; ``most`` candidates are tried, besides those that have no exact drive.
    A drive that is rejected, though nothing else is asked of it, contradicts the boundary: no other is tried.
    """
    reason = f"no place of the plane is {side}"
    tried = 0
    for values in islice(candidates, _LOOKED_AT):
        try:
            drive = drive_of(plane.manoeuvre, model, values, reading)
            tried += 1
            judged = _judged(drive, plane.manoeuvre, model, values, side, specification, reading, also)
            return values, judged
        except RejectedError as error:
            reason = str(error)
            if not also:
                told = ", ".join(f"{name}={value}" for name, value in values.items())
                return f"the drive from {told} (SI) is not {side}, as the boundary says it is: {reason}"
        except InputError as error:
            reason = str(error)
        if tried == most:
            break
    return reason


def far_apart(
    plane: Plane, candidates: Iterable[dict[str, Fraction]], most: int
) -> list[dict[str, Fraction]]:
    """The first candidate of each row and the last ones, of at most so many rows."""
    rows: dict[Fraction, list[dict[str, Fraction]]] = {}
    for values in candidates:
        rows.setdefault(values[plane.manoeuvre.across], []).append(values)
    some = list(rows.values())[:: ceil(len(rows) / most) or 1]
    return [values for row in some for values in (row[0], *row[1:][-len(_PARTS) :])]
