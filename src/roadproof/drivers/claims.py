"""What a drive on a side of a boundary has to show, as a formula."""

from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.drivers.driving import DriverSettings, speeds_of
from roadproof.drivers.manoeuvres import CutIn, CutOut, Deceleration, Manoeuvre, Start, Values, start_of
from roadproof.drivers.models import GRADUAL, MODELS, follows, foreseen, touched, unpreventable, untouched

Side: TypeAlias = Literal["unpreventable", "preventable"]
SIDES: tuple[Side, ...] = ("unpreventable", "preventable")


def claim_of(manoeuvre: Manoeuvre, model: str, values: Values, side: Side, reading: DriverSettings) -> str:
    """What the drive from these values shows: its side, the model followed, and what comes of it.

    Of a controller that is stepped: only how the drive begins, and what comes of it. Where POV's braking
    grows at a finite rate: that SV follows its model, and what comes of it.
    """
    vehicles, start = manoeuvre.vehicles, start_of(manoeuvre, values)
    met = touched(vehicles) if side == "unpreventable" else untouched(vehicles)
    numbers = _numbers(start, reading, reading.has_aeb(model))
    if isinstance(start, Deceleration) and start.dGdt is not None:
        driven = follows(GRADUAL, model, vehicles, numbers)
        return f"{foreseen(GRADUAL, vehicles)} and {driven} and {met}"
    begins = foreseen(manoeuvre.name, vehicles)
    if MODELS[model].is_stepped:
        return f"{begins} and {met}"
    boundary = unpreventable(manoeuvre.name, model, vehicles)
    driven = follows(manoeuvre.name, model, vehicles, numbers)
    if side == "unpreventable":
        return f"{boundary} and {driven} and {met}"
    return f"{begins} and not {boundary} and {driven} and {met}"


def _numbers(start: Start, reading: DriverSettings, has_aeb: bool) -> tuple[str, ...]:
    speed = _number(start.Ve0, "m/s")
    match start:
        case CutIn():
            aided = speeds_of(start, reading) if has_aeb else ()
            place = _number(start.middle + start.lane, "m")
            return (place, _number(start.dy0, "m"), speed, *(_number(x, "m/s") for x in aided))
        case CutOut():
            return (_number(start.middle, "m"), speed)
        case Deceleration():
            braking = _number(start.Gx, "m/s^2")
            if start.dGdt is None:
                return (speed, braking)
            return (speed, _number(start.Ve0 - start.dV0, "m/s"), braking, _number(start.dGdt, "m/s^3"))


def _number(value: Fraction, unit: str) -> str:
    """A value in the language, exactly."""
    return f"{value} {unit}" if value.denominator == 1 else f"{value}*1 {unit}"


def with_also(claim: str, also: str) -> str:
    """A claim about a drive, and what else is true of it; empty where nothing else is said."""
    return f"{claim} and {also}" if also else claim
