"""Values of parameters, and binding: a formula on a road with values compares signals and sizes only."""

import math
import re
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from numbers import Integral, Real
from typing import TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.library.specification import Library, satisfies_bound, source_of, unknown_name
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of, leaves_of, parameters_of, with_values
from roadproof.world.road import Lanelet, Road
from roadproof.world.units import UNITS


def default_values(library: Library) -> dict[str, Fraction]:
    """Return the declared value of every parameter, in SI units."""
    return {name: p.value * UNITS[p.unit][0] for name, p in library.parameters.items()}


def values_with(library: Library, overrides: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Return the value of every parameter in SI units: from ``overrides``, else as declared.

    Raises ``InputError`` for a name that is not declared and for a value outside its declared bound.
    """
    for name, value in overrides.items():
        if name not in library.parameters:
            raise InputError(f"{name}={value}: {unknown_name('parameter', name, library.parameters)}")
        declared = library.parameters[name]
        if not satisfies_bound(declared.bound, value):
            where = source_of(library, declared).name
            at = f"{where}, line {declared.at.line}, column {declared.at.column}: "
            raise InputError(f"{name}={value}: {at}the library demands {name} {declared.bound} 0")
    return {**default_values(library), **overrides}


def bind(formula: Formula, road: Road, lanes: Mapping[str, str], values: Mapping[str, Fraction]) -> Formula:
    """Return ``formula`` on ``road``, with free lanes replaced by ``lanes`` and parameters by ``values``.

    Quantifiers become finite conjunctions and disjunctions, and ``occ`` becomes comparisons. The result has
    no ``Some``, ``Every``, ``Occupies`` or ``Parameter``. Raises ``InputError`` for a lane that the road does
    not have or that ``lanes`` does not name, and for a number without value.
    """
    return _bound(formula, road, tuple(sorted(lanes.items())), tuple(sorted(values.items())))


# A search binds the same formula for its start, its engines and the judge.
@lru_cache(maxsize=32)
def _bound(
    formula: Formula, road: Road, lanes: tuple[tuple[str, str], ...], values: tuple[tuple[str, Fraction], ...]
) -> Formula:
    refuse_variables(formula)
    return with_values(_Grounder(road, dict(lanes)).visit(formula, {}), dict(values))


def refuse_variables(formula: Formula) -> None:
    """Raise ``InputError`` if a number that is declared with ``given`` occurs, as it has no value."""
    for leaf in leaves_of(formula):
        if isinstance(leaf, t.Variable):
            raise InputError(
                f"'{leaf.name}' stands for every number, and has no value on a drive or in a recording: "
                "write a number, or declare a parameter in a specification file"
            )


def occupies(vehicle: str, lanelet: Lanelet) -> Formula:
    """Return occ(vehicle, lanelet) on a straight road: their areas overlap (semantics §4)."""
    front: t.Term = t.Signal("s", vehicle)
    left: t.Term = t.Signal("d", vehicle)
    metres = (1, 0)
    low, high = lanelet.s
    inside: list[Formula] = []
    if low is not None:
        inside.append(f.Compare(front, ">", t.Number(low, metres)))
    if high is not None:
        inside.append(f.Compare(t.subtract(front, t.Size("length", vehicle)), "<", t.Number(high, metres)))
    right_edge, left_edge = lanelet.d
    inside.append(f.Compare(left, ">", t.Number(right_edge, metres)))
    inside.append(f.Compare(t.subtract(left, t.Size("width", vehicle)), "<", t.Number(left_edge, metres)))
    return f.conjunction(*inside)


class _Grounder:
    def __init__(self, road: Road, lanes: Mapping[str, str]) -> None:
        self.road = road
        self.lanes = lanes
        self.lanelets = {x.id: x for x in road.lanelets}
        self.known: dict[tuple[Formula, tuple[tuple[str, str], ...]], Formula] = {}

    def visit(self, formula: Formula, scope: Mapping[str, str]) -> Formula:
        """Return the bound formula; ``scope`` maps each bound variable to a lane or lanelet."""
        key = (formula, tuple(sorted(scope.items())))
        if key not in self.known:
            self.known[key] = self._visit(formula, scope)
        return self.known[key]

    def _visit(self, formula: Formula, scope: Mapping[str, str]) -> Formula:
        match formula:
            case f.Occupies(vehicle, lanelet):
                return occupies(vehicle, self._lanelet(scope.get(lanelet, lanelet)))
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):
                join = f.disjunction if isinstance(formula, f.Some) else f.conjunction
                elements = self._elements(domain, scope)
                return join(*(self.visit(body, {**scope, variable: x}) for x in elements))
            case f.Application(name, arguments, body):
                shown = tuple(scope.get(a, self.lanes.get(a, a)) for a in arguments)
                return f.Application(name, shown, self.visit(body, scope))
            case f.Truth() | f.Compare() | f.Not() | f.And() | f.Or():
                parts = tuple(self.visit(child, scope) for child in f.children(formula))
                return f.with_children(formula, parts)
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                parts = tuple(self.visit(child, scope) for child in f.children(formula))
                return f.with_children(formula, parts)

    def _lanelet(self, name: str) -> Lanelet:
        if name not in self.lanelets:
            raise InputError(f"lanelet={name}: {unknown_name('lanelet', name, self.lanelets)}")
        return self.lanelets[name]

    def _lane(self, name: str, scope: Mapping[str, str]) -> str:
        lane = scope.get(name, self.lanes.get(name, name))
        if lane not in self.road.lanes:
            raise InputError(
                f"lane {name}={lane}: road '{self.road.name}' has the lanes {', '.join(self.road.lanes)}"
            )
        return lane

    def _elements(self, domain: f.Domain, scope: Mapping[str, str]) -> tuple[str, ...]:
        match domain.kind:
            case "lanes":
                return self.road.lanes
            case "adjacent":
                return self.road.adjacent_lanes(self._lane(domain.of, scope))
            case "lanelets":
                return tuple(x.id for x in self.road.lanelets_of(self._lane(domain.of, scope)))
            case "zone":
                return tuple(x.id for x in self.road.lanelets_in(domain.of))


Number: TypeAlias = int | float | Fraction | Decimal | str

_VALUE = re.compile(r"([+-]?\d{1,30}(?:\.\d{1,30})?(?:/\d{1,30})?)\s*([A-Za-z][A-Za-z/^0-9]*)?")


def exact(name: str, value: Number, unit: str) -> Fraction:
    """Return a value in SI units; a bare number is in ``unit``, a float is the decimal that Python shows.

    Numbers of numpy are accepted. Raises ``InputError`` that names ``name``.
    """
    if isinstance(value, str):
        return read_value(name, value, unit)
    if isinstance(value, bool) or not isinstance(value, Real | Decimal):
        raise InputError(f"{name}={value!r}: this is no number; write 3, 0.6, Fraction(3, 5) or '600 ms'")
    if not math.isfinite(value):
        raise InputError(f"{name}={value}: the number must be finite")
    return _fraction(value) * UNITS[unit][0]


def _fraction(value: Real | Decimal) -> Fraction:
    match value:
        case Fraction() | Decimal():
            return Fraction(value)
        case Integral():  # a numpy integer has 64 bits; a Fraction made of it would, too
            return Fraction(int(value))
        case _:  # open: floats of Python and numpy
            return Fraction(str(value))


def read_value(name: str, text: str, unit: str) -> Fraction:
    """Parse a value and return it in SI units; without a unit it is in ``unit``.

    Raises ``InputError`` that names ``name``.
    """
    short = name.rpartition(" ")[2]
    match = _VALUE.fullmatch(text.strip())
    if match is None:
        raise InputError(
            f"{name}={text}: this is no value; write a decimal or a fraction, with a unit if you "
            f"like, such as {short}=0.6, {short}=3/5 or '{short}=0.6 {unit}'"
        )
    number, given_unit = match[1], match[2] or unit
    if given_unit not in UNITS:
        raise InputError(f"{name}={text}: {unknown_name('unit', given_unit, UNITS)}")
    if UNITS[given_unit][1] != UNITS[unit][1]:
        raise InputError(f"{name}={text}: {short} is in {unit}, which {given_unit} does not measure")
    top, _, bottom = number.partition("/")
    if bottom and Fraction(bottom) == 0:
        raise InputError(f"{name}={text}: the denominator is zero")
    return Fraction(top) / Fraction(bottom or 1) * UNITS[given_unit][0]


def without_empty_windows(formula: Formula) -> Formula:
    """Return ``formula`` with operators over empty intervals replaced: G by true, F and U by false.

    Raises ``InputError`` if a bound has no value.
    """

    def visit(current: Formula) -> Formula:
        """Replace an operator whose interval is empty."""
        if not any(map(_is_empty, f.intervals(current))):
            return current
        match current:
            case f.Always():
                return f.TRUE
            case f.Until() | f.Since() | f.Eventually():
                return f.FALSE
            case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.Not() | f.And() | f.Or():
                return current
            case f.Application():
                return current
            case _:
                assert_never(current)

    return f.transform(formula, visit)


def _is_empty(interval: f.Interval) -> bool:
    try:
        low, high = bounds_of(interval)
    except ValueError as error:
        raise InputError(str(error)) from None
    return high is not None and high < low


def used_values(library: Library, formula: Formula, values: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Return the values of the parameters in ``formula``, and of those that the user has changed."""
    declared = default_values(library)
    used = parameters_of(formula)
    return {n: v for n, v in values.items() if n in used or v != declared.get(n)}
