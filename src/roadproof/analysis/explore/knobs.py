"""What is varied in an exploration: parameters of the specification, and limits of vehicles."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.analysis.explore.measure import compared
from roadproof.engines.search.ask import Search
from roadproof.library.compose import always
from roadproof.library.specification import Query
from roadproof.logic import syntax
from roadproof.world.units import UNITS

# A value for each knob, in order, in SI units.
Point: TypeAlias = tuple[Fraction, ...]


@dataclass(frozen=True)
class Variable:
    """A parameter, or the ``limit`` (such as ``a_lon.min``) of ``vehicles``, from ``low`` to ``high``.

    ``name`` is how the user names it; values are in SI units and printed in ``unit``.
    """

    name: str
    unit: str
    low: Fraction
    high: Fraction
    vehicles: tuple[str, ...] = ()
    limit: str = ""

    def values(self, steps: int) -> tuple[Fraction, ...]:
        """``steps`` (2 or more) values, evenly spaced, both ends included."""
        return tuple(self.low + (self.high - self.low) * k / (steps - 1) for k in range(steps))


def with_point(search: Search, knobs: Sequence[Variable], point: Point) -> Search:
    """``search`` with every knob at its value."""
    values = dict(search.setting.values)
    limits = {vehicle: dict(ends) for vehicle, ends in search.setting.limits.items()}
    for knob, value in zip(knobs, point, strict=True):
        if not knob.limit:
            values[knob.name] = value
        for vehicle in knob.vehicles:
            limits.setdefault(vehicle, {})[knob.limit] = value
    return replace(search, setting=replace(search.setting, values=values, limits=limits))


def stated(search: Search, knobs: Sequence[Variable], point: Point) -> list[Query]:
    """The limits at a point as formulas, so that a drive file says them and whoever judges it checks them."""
    parts: list[Query] = []
    for knob, value in zip(knobs, point, strict=True):
        signal, _, end = knob.limit.partition(".")
        for vehicle in knob.vehicles:
            left = syntax.Call(signal, (syntax.Name(vehicle),))
            op: Literal[">=", "<="] = ">=" if end == "min" else "<="
            parts.append(always(compared(search, left, op, value, UNITS[knob.unit][1])))
    return parts


def between(one: Fraction, other: Fraction, grains: Sequence[Fraction] = ()) -> Fraction:
    """A plain number strictly between two: a multiple of the first grain that has one, near the middle.

    Else the decimal with the fewest digits in the middle half.

    >>> str(between(Fraction(0), Fraction(3), [Fraction(3, 5)])), str(between(Fraction(1, 3), Fraction(1)))
    ('6/5', '7/10')
    """
    low, high = sorted((one, other))
    middle, quarter = (low + high) / 2, (high - low) / 4
    for grain in grains:
        multiple = round(middle / grain) * grain
        if low < multiple < high:
            return multiple
    for digits in range(-9, 12):
        unit = Fraction(10) ** -digits
        rounded = round(middle / unit) * unit
        if low + quarter <= rounded <= high - quarter:
            return rounded
    return middle
