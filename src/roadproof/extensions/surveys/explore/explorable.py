"""The variables and measures of an exploration, read from names and numbers.

Messages name the options of the command line, which asks in the same words.
"""

import re
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Literal, TypeAlias

from roadproof.engines.setting import Search, Setting
from roadproof.errors import UsageError
from roadproof.extensions.surveys.composition import comparison, with_parts
from roadproof.extensions.surveys.extremes.measure import DriveMeasure, Sense, read_measure
from roadproof.extensions.surveys.extremes.points import Point
from roadproof.library.bind import Number, exact
from roadproof.library.compose import always
from roadproof.library.specification import Library, Query, unknown_name
from roadproof.logic import syntax
from roadproof.logic.rewrite import parameters_of
from roadproof.runtime.records import dataclass
from roadproof.world.models import load_vehicle
from roadproof.world.units import UNITS, unit_text
from roadproof.world.vehicle import LIMITS, with_limits

_LIMIT = re.compile(r"(\w+)\.(\w+)\.(min|max)")
EVERY_VEHICLE = "vehicle"
# A name, and the least and the greatest value: ``("minDanger", 0, 3)``, ``("POV.a_lon.min", -6, -1)``.
VariableRange: TypeAlias = tuple[str, Number, Number]


@dataclass(frozen=True)
class SweepVariable:
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
        """Return ``steps`` (2 or more) values, evenly spaced, both ends included."""
        return tuple(self.low + (self.high - self.low) * k / (steps - 1) for k in range(steps))


@dataclass(frozen=True)
class Explorable:
    """An exploration: values of ``variables`` with a drive of ``search``, and extremes of ``measures``.

    ``steps``: values of each variable; ``precision``: how far boundaries are narrowed, in SI units of the
    variable (None: a sixtieth of its range), or brackets of measures where there is no variable.
    """

    search: Search
    variables: tuple[SweepVariable, ...]
    steps: int
    precision: Fraction | None = None
    measures: tuple[DriveMeasure, ...] = ()

    @property
    def points(self) -> list[Point]:
        """The grid: the product of the values of the variables; no point where there are no variables."""
        return (
            list(product(*(variable.values(self.steps) for variable in self.variables)))
            if self.variables
            else []
        )

    def at(self, point: Point) -> Search:
        """Return the search with every variable at its value, and limits stated in its query."""
        there = self.placed(point)
        return replace(there, query=with_parts(there.query, self.stated(point)))

    def placed(self, point: Point) -> Search:
        """Return the search with every variable at its value."""
        setting = self.search.setting
        values = dict(setting.values)
        limits = {vehicle: dict(ends) for vehicle, ends in setting.limits.items()}
        for variable, value in zip(self.variables, point, strict=True):
            if not variable.limit:
                values[variable.name] = value
            for vehicle in variable.vehicles:
                limits.setdefault(vehicle, {})[variable.limit] = value
        return replace(self.search, setting=replace(setting, values=values, limits=limits))

    def stated(self, point: Point) -> tuple[Query, ...]:
        """Return the limits at a point as formulas, which are part of a drive's claim and so are judged."""
        parts: list[Query] = []
        specification, given = self.search.specification, self.search.query.claim.given
        for variable, value in zip(self.variables, point, strict=True):
            signal, _, end = variable.limit.partition(".")
            for vehicle in variable.vehicles:
                left = syntax.Call(signal, (syntax.Name(vehicle),))
                op: Literal[">=", "<="] = ">=" if end == "min" else "<="
                dimension = UNITS[variable.unit][1]
                parts.append(always(comparison(specification, given, left, op, value, dimension)))
        return tuple(parts)


def explorable_of(
    search: Search,
    vary: Sequence[VariableRange],
    steps: int | None = None,
    precision: Number | None = None,
    measures: Sequence[tuple[Sense, str]] = (),
    when: str = "",
) -> Explorable:
    """Return the exploration of a search for drives. Raises ``UsageError``, ``InputError``.

    ``measures``: terms whose least or greatest value is wanted, at 0 or ``when`` a formula holds.
    """
    if not vary and not measures:
        raise UsageError("say what to explore: --vary NAME=LOW:HIGH, --least TERM or --greatest TERM")
    if when and not measures:
        raise UsageError(f"--when '{when}' says when to measure: add --least TERM or --greatest TERM")
    if len(vary) > 1 and measures:
        raise UsageError("--least and --greatest go with one --vary at most")
    specification, query = search.specification, search.query
    variables = read_variables(vary, search.setting, query, specification.library)
    return Explorable(
        search,
        tuple(variables),
        read_steps(steps, len(variables)),
        read_precision(precision),
        tuple(read_measure(specification, sense, term, when, query.claim.given) for sense, term in measures),
    )


def read_variables(
    vary: Sequence[VariableRange], setting: Setting, query: Query, library: Library
) -> list[SweepVariable]:
    """Return the variables of an exploration. Raises ``UsageError``, ``InputError``."""
    if len(vary) > 2:
        raise UsageError(f"--vary is given {len(vary)} times: vary one or two things at once")
    variables = [_variable(*one, query, library) for one in vary]
    if len({variable.name for variable in variables}) < len(variables):
        raise UsageError(f"--vary {variables[0].name} is given twice: vary two different things")
    _check_limits(variables, setting, query)
    return variables


def _variable(name: str, low: Number, high: Number, query: Query, library: Library) -> SweepVariable:
    text = f"{name}={low}:{high}"
    variable = (
        _limit(text, name, low, high, query)
        if "." in name
        else _parameter(text, name, low, high, query, library)
    )
    if variable.low >= variable.high:
        raise UsageError(f"--vary {text}: the range is empty; the first value must be the smaller one")
    return variable


def _parameter(
    text: str, name: str, low: Number, high: Number, query: Query, library: Library
) -> SweepVariable:

    if name not in library.parameters:
        hint = "; a limit of a vehicle is written as POV.a_lon.min=-6:-1"
        raise UsageError(f"--vary {text}: {unknown_name('parameter', name, library.parameters)}{hint}")
    spoken = parameters_of(query.formula)
    if name not in spoken:
        raise UsageError(
            f"--vary {text}: the formula does not depend on {name}; "
            f"its parameters are {', '.join(spoken) or 'none'}"
        )
    declared = library.parameters[name]
    ends = [exact(f"--vary {name}", end, declared.unit) for end in (low, high)]
    if (declared.bound == ">" and ends[0] <= 0) or (declared.bound == ">=" and ends[0] < 0):
        raise UsageError(
            f"--vary {text}: the range leaves the declared bound; the library demands {name} "
            f"{declared.bound} 0"
        )
    return SweepVariable(name, unit_text(UNITS[declared.unit][1]), ends[0], ends[1])


def _limit(text: str, name: str, low: Number, high: Number, query: Query) -> SweepVariable:

    read = _LIMIT.fullmatch(name)
    if read is None or read[2] not in LIMITS:
        raise UsageError(
            f"--vary {text}: write a limit as VEHICLE.LIMIT.min or .max, where LIMIT is "
            f"{', '.join(LIMITS)} and VEHICLE is {', '.join(query.vehicles)} or {EVERY_VEHICLE} for all"
        )
    if read[1] not in (*query.vehicles, EVERY_VEHICLE):
        raise UsageError(
            f"--vary {text}: the formula mentions {', '.join(query.vehicles)}; {EVERY_VEHICLE} means all"
        )
    unit, limit = LIMITS[read[2]], f"{read[2]}.{read[3]}"
    ends = [exact(f"--vary {name}", end, unit) for end in (low, high)]
    vehicles = query.vehicles if read[1] == EVERY_VEHICLE else (read[1],)
    return SweepVariable(name, unit, ends[0], ends[1], tuple(vehicles), limit)


def _check_limits(variables: Sequence[SweepVariable], setting: Setting, query: Query) -> None:
    """Raise ``UsageError`` where limits at some point make no vehicle; the corners are the worst of them."""

    usual = setting.vehicles.get("") or load_vehicle("car")
    for vehicle in query.vehicles:
        mine = [variable for variable in variables if vehicle in variable.vehicles]
        if not mine:
            continue
        if len({variable.limit for variable in mine}) < len(mine):
            raise UsageError(
                f"--vary {mine[0].name} and {mine[1].name}: both are {mine[0].limit} of {vehicle}"
            )
        model = setting.vehicles.get(vehicle, usual)
        for corner in product(*((variable.low, variable.high) for variable in mine)):
            limits = {variable.limit: value for variable, value in zip(mine, corner, strict=True)}
            try:
                with_limits(model, limits)
            except UsageError as error:
                at = ", ".join(
                    f"{variable.name}={float(v):g}" for variable, v in zip(mine, corner, strict=True)
                )
                raise UsageError(f"--vary: at {at}, {vehicle} ({model.name}): {error}") from None


def read_steps(steps: int | None, variables: int) -> int:
    """Return the number of values of each variable. Raises ``UsageError``."""
    if steps is None:
        return 11 if variables == 1 else 6
    most = 201 if variables == 1 else 41
    if not 2 <= steps <= most:
        raise UsageError(f"--steps {steps}: write a number from 2 to {most}")
    return steps


def read_precision(given: Number | None) -> Fraction | None:
    """Return ``--precision`` in SI units; None if it is not given. Raises ``UsageError``, ``InputError``."""
    if given is None:
        return None
    value = exact("--precision precision", given, "unitless")
    if value <= 0:
        raise UsageError(f"--precision {given}: write a number greater than 0, in SI units")
    return value
