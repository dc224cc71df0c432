"""The lines of a plate: on each, between which values a collision is unpreventable, with its exact ends.

A drive on a side of such an end has to show a formula.
"""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.extensions.drivers import gradual, manoeuvres, models
from roadproof.extensions.drivers.driver_model import Law
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.library.bind import bind
from roadproof.library.elaborate import apply_definition
from roadproof.library.specification import Specification
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.algebraic import Point, Root, as_float
from roadproof.semantics.exact.truth import TruthSet
from roadproof.world.road import Road

Side: TypeAlias = Literal["unpreventable", "preventable"]
SIDES: tuple[Side, ...] = ("unpreventable", "preventable")


def claim_of(
    manoeuvre: manoeuvres.Manoeuvre,
    model: str,
    values: manoeuvres.Values,
    side: Side,
    reading: DriverSettings,
) -> str:
    """Return the claim about the drive from these values: its side, the model, and the outcome.

    Of a controller that is stepped: only how the drive begins, and what comes of it. Where POV's braking
    grows at a finite rate: that SV follows its model, and what comes of it.
    """
    start = manoeuvres.start_of(manoeuvre, values)
    numbers = _numbers(start, models.driver_model(model).law, reading)
    return _shown(manoeuvre, model, side, _is_gradual(start), numbers)


def open_claim(
    specification: Specification,
    manoeuvre: manoeuvres.Manoeuvre,
    model: str,
    fixed: manoeuvres.Values,
    side: Side,
) -> str:
    """Return what a drive of a side shows for some initial values: ``claim_of`` with names for numbers."""
    is_gradual = gradual.RATE in fixed
    if models.driver_model(model).is_stepped:
        return _shown(manoeuvre, model, side, is_gradual, ())
    course = models.GRADUAL if is_gradual else manoeuvre.name
    declared = specification.definitions[models.follows_name(course, model)].parameters
    numbers = declared[len(manoeuvre.vehicles) :]
    given = "; ".join(f"{x.name}: {x.sort}" for x in numbers)
    names = tuple(x.name for x in numbers)
    return f"given {given}: {_shown(manoeuvre, model, side, is_gradual, names)}"


def boundary_text(manoeuvre: manoeuvres.Manoeuvre, model: str, fixed: manoeuvres.Values) -> str:
    """Return what is true where a collision is unpreventable: of the state there, or of the drive."""
    if gradual.RATE in fixed:
        return models.touched(manoeuvre.vehicles)
    return models.boundary_of(manoeuvre.name, model, manoeuvre.vehicles)


def _is_gradual(start: manoeuvres.Start) -> bool:
    return isinstance(start, manoeuvres.Deceleration) and start.dGdt is not None


def _shown(
    manoeuvre: manoeuvres.Manoeuvre,
    model: str,
    side: Side,
    is_gradual: bool,
    numbers: tuple[str, ...],
) -> str:
    vehicles = manoeuvre.vehicles
    met = models.touched(vehicles) if side == "unpreventable" else models.untouched(vehicles)
    if is_gradual:
        driven = models.follows(models.GRADUAL, model, vehicles, numbers)
        return f"{models.foreseen(models.GRADUAL, vehicles)} and {driven} and {met}"
    begins = models.foreseen(manoeuvre.name, vehicles)
    if models.driver_model(model).is_stepped:
        return f"{begins} and {met}"
    boundary = models.unpreventable(manoeuvre.name, model, vehicles)
    driven = models.follows(manoeuvre.name, model, vehicles, numbers)
    if side == "unpreventable":
        return f"{boundary} and {driven} and {met}"
    return f"{begins} and not {boundary} and {driven} and {met}"


def _numbers(start: manoeuvres.Start, law: Law | None, reading: DriverSettings) -> tuple[str, ...]:
    speed = _number(start.Ve0, "m/s")
    match start:
        case manoeuvres.CutIn():
            aided = () if law is None else law.speeds(start, reading)
            place = _number(start.middle + start.lane, "m")
            return (place, _number(start.dy0, "m"), speed, *(_number(x, "m/s") for x in aided))
        case manoeuvres.CutOut():
            return (_number(start.middle, "m"), speed)
        case manoeuvres.Deceleration():
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


_PLACES = 6
_NO_ROAD = Road("none", (), frozenset())


@dataclass(frozen=True)
class SpanEnd:
    """An end of a span: a number near it, and what it is exactly: a fraction, or a root of a polynomial."""

    near: float
    exact: str


@dataclass(frozen=True)
class PlateLine:
    """A line of a plate: the value of the other side (SI), and the spans where a collision is unpreventable.

    Of a controller that is stepped, spans are from the first to the last of neighbouring places looked at.
    """

    at: Fraction
    spans: tuple[tuple[SpanEnd, SpanEnd], ...]


def truths(
    specification: Specification, plane: manoeuvres.Plane, model: str, values: Mapping[str, Fraction]
) -> Iterator[TruthSet]:
    """Return where a model that is not stepped cannot prevent a collision on each line of a plane, in order.

    By the formula of its boundary, or from the motion where POV's braking grows at a finite rate; ``values``
    are those of all parameters (SI).
    """
    if gradual.RATE in plane.fixed:
        reading = DriverSettings(values, specification.options)
        return (gradual.line(plane, model, reading, row) for row in plane.rows)
    name, vehicles = models.boundary_name(plane.manoeuvre.name, model), plane.manoeuvre.vehicles
    formula = bind(apply_definition(specification, name, vehicles).formula, _NO_ROAD, {}, values)
    return (manoeuvres.line(plane, formula, row) for row in plane.rows)


def line_of_truth(row: Fraction, true: TruthSet) -> PlateLine:
    """Return a row's line with the spans on which the formula is true."""
    spans = tuple((end_of(x.begin.point), end_of(x.end.point)) for x in true.spans() if x.end is not None)
    return PlateLine(row, spans)


def sides_in(
    lines: Sequence[PlateLine], along: tuple[Fraction, Fraction], is_stepped: bool
) -> frozenset[Side]:
    """The sides of the boundary that a plate has more than single places of.

    ``along``: the range of every line. Of a controller that is stepped a single place is a side, too.
    """
    whole = tuple(end_of(x) for x in along)
    sides: set[Side] = set()
    for one in lines:
        if any(is_stepped or a != b for a, b in one.spans):
            sides.add("unpreventable")
        if one.spans != (whole,):
            sides.add("preventable")
    return frozenset(sides)


def end_of(point: Point) -> SpanEnd:
    """A point of a line, told."""
    if isinstance(point, Root):
        return SpanEnd(round(as_float(point), _PLACES), f"root of {list(point.polynomial)}, constant first")
    return SpanEnd(round(float(point), _PLACES), str(point))
