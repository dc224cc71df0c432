"""What a drive on a side of a boundary has to show, as a formula."""

from fractions import Fraction
from typing import Literal, TypeAlias, assert_never

from roadproof.drivers.driving import DriverSettings, is_aided, speeds_of
from roadproof.drivers.manoeuvres import Manoeuvre, Values, lane_width
from roadproof.drivers.models import GRADUAL, MODELS, follows, foreseen, touched, unpreventable, untouched

Side: TypeAlias = Literal["unpreventable", "preventable"]
SIDES: tuple[Side, ...] = ("unpreventable", "preventable")


def claim_of(manoeuvre: Manoeuvre, model: str, values: Values, side: Side, reading: DriverSettings) -> str:
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
        case "deceleration":
            numbers = (speed, _number(values["Gx"], "m/s^2"))
            if "dGdt" not in values:
                return numbers
            other = _number(values["Ve0"] - values["dV0"], "m/s")
            return (speed, other, numbers[1], _number(values["dGdt"], "m/s^3"))
        case _:
            assert_never(manoeuvre.name)


def _number(value: Fraction, unit: str) -> str:
    """A value in the language, exactly."""
    return f"{value} {unit}" if value.denominator == 1 else f"{value}*1 {unit}"


def with_also(claim: str, also: str) -> str:
    """A claim about a drive, and what else is true of it; empty where nothing else is said."""
    return f"{claim} and {also}" if also else claim
