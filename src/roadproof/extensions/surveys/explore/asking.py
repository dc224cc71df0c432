"""What is asked of an exploration: knobs and measures, from names and numbers.

Messages name the options of the command line, which asks in the same words.
"""

import re
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Literal, TypeAlias

from roadproof.engines.search.outcome import Search
from roadproof.engines.search.question import Setting
from roadproof.errors import UsageError
from roadproof.extensions.surveys.extremes.measure import Measure, Sense, read_measure
from roadproof.extensions.surveys.extremes.points import Point
from roadproof.library.bind import Number, exact
from roadproof.library.compose import always, comparison, with_parts
from roadproof.library.specification import Library, Query, unknown
from roadproof.logic import syntax
from roadproof.logic.rewrite import parameters_of
from roadproof.runtime.records import dataclass
from roadproof.world.models import load_vehicle
from roadproof.world.units import UNITS, unit_text
from roadproof.world.vehicle import LIMITS, with_limits

_LIMIT = re.compile(r"(\w+)\.(\w+)\.(min|max)")
EVERY_VEHICLE = "vehicle"
# A name, and the least and the greatest value: ``("minDanger", 0, 3)``, ``("POV.a_lon.min", -6, -1)``.
Varied: TypeAlias = tuple[str, Number, Number]


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


@dataclass(frozen=True)
class Explorable:
    """For which values of ``knobs`` the query of ``search`` has a drive, and how far ``measures`` can go.

    ``steps``: values of each knob; ``precision``: how far boundaries are narrowed, in SI units of the
    knob (None: a sixtieth of its range), or brackets of measures where there is no knob.
    """

    search: Search
    knobs: tuple[Variable, ...]
    steps: int
    precision: Fraction | None = None
    measures: tuple[Measure, ...] = ()

    @property
    def points(self) -> list[Point]:
        """The grid: the product of the values of the knobs; no point where there are none."""
        return list(product(*(knob.values(self.steps) for knob in self.knobs))) if self.knobs else []

    def at(self, point: Point) -> Search:
        """The search with every knob at its value, limits stated in its query."""
        there = self.placed(point)
        return replace(there, query=with_parts(there.query, self.stated(point)))

    def placed(self, point: Point) -> Search:
        """The search with every knob at its value."""
        setting = self.search.setting
        values = dict(setting.values)
        limits = {vehicle: dict(ends) for vehicle, ends in setting.limits.items()}
        for knob, value in zip(self.knobs, point, strict=True):
            if not knob.limit:
                values[knob.name] = value
            for vehicle in knob.vehicles:
                limits.setdefault(vehicle, {})[knob.limit] = value
        return replace(self.search, setting=replace(setting, values=values, limits=limits))

    def stated(self, point: Point) -> tuple[Query, ...]:
        """The limits at a point as formulas, so that a drive says them and whoever judges it checks them."""
        parts: list[Query] = []
        specification, given = self.search.specification, self.search.query.claim.given
        for knob, value in zip(self.knobs, point, strict=True):
            signal, _, end = knob.limit.partition(".")
            for vehicle in knob.vehicles:
                left = syntax.Call(signal, (syntax.Name(vehicle),))
                op: Literal[">=", "<="] = ">=" if end == "min" else "<="
                dimension = UNITS[knob.unit][1]
                parts.append(always(comparison(specification, given, left, op, value, dimension)))
        return tuple(parts)


def ask_for(
    search: Search,
    vary: Sequence[Varied],
    steps: int | None = None,
    precision: Number | None = None,
    measures: Sequence[tuple[Sense, str]] = (),
    when: str = "",
) -> Explorable:
    """What is asked of a search for drives. Raises ``UsageError``, ``InputError``.

    ``measures``: terms whose least or greatest value is wanted, at 0 or ``when`` a formula holds.
    """
    if not vary and not measures:
        raise UsageError("say what to explore: --vary NAME=LOW:HIGH, --least TERM or --greatest TERM")
    if when and not measures:
        raise UsageError(f"--when '{when}' says when to measure: add --least TERM or --greatest TERM")
    if len(vary) > 1 and measures:
        raise UsageError("--least and --greatest go with one --vary at most")
    specification, query = search.specification, search.query
    knobs = read_knobs(vary, search.setting, query, specification.library)
    return Explorable(
        search,
        tuple(knobs),
        read_steps(steps, len(knobs)),
        read_precision(precision),
        tuple(read_measure(specification, sense, term, when, query.claim.given) for sense, term in measures),
    )


def read_knobs(vary: Sequence[Varied], setting: Setting, query: Query, library: Library) -> list[Variable]:
    """What is varied, as knobs. Raises ``UsageError``, ``InputError``."""
    if len(vary) > 2:
        raise UsageError(f"--vary is given {len(vary)} times: vary one or two things at once")
    knobs = [_knob(*one, query, library) for one in vary]
    if len({knob.name for knob in knobs}) < len(knobs):
        raise UsageError(f"--vary {knobs[0].name} is given twice: vary two different things")
    _check_limits(knobs, setting, query)
    return knobs


def _knob(name: str, low: Number, high: Number, query: Query, library: Library) -> Variable:
    text = f"{name}={low}:{high}"
    knob = (
        _limit(text, name, low, high, query)
        if "." in name
        else _parameter(text, name, low, high, query, library)
    )
    if knob.low >= knob.high:
        raise UsageError(f"--vary {text}: the range is empty; the first value must be the smaller one")
    return knob


def _parameter(text: str, name: str, low: Number, high: Number, query: Query, library: Library) -> Variable:

    if name not in library.parameters:
        hint = "; a limit of a vehicle is written as POV.a_lon.min=-6:-1"
        raise UsageError(f"--vary {text}: {unknown('parameter', name, library.parameters)}{hint}")
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
    return Variable(name, unit_text(UNITS[declared.unit][1]), ends[0], ends[1])


def _limit(text: str, name: str, low: Number, high: Number, query: Query) -> Variable:

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
    return Variable(name, unit, ends[0], ends[1], tuple(vehicles), limit)


def _check_limits(knobs: Sequence[Variable], setting: Setting, query: Query) -> None:
    """Raise ``UsageError`` where limits at some point make no vehicle; the corners are the worst of them."""

    usual = setting.vehicles.get("") or load_vehicle("car")
    for vehicle in query.vehicles:
        mine = [knob for knob in knobs if vehicle in knob.vehicles]
        if not mine:
            continue
        if len({knob.limit for knob in mine}) < len(mine):
            raise UsageError(
                f"--vary {mine[0].name} and {mine[1].name}: both are {mine[0].limit} of {vehicle}"
            )
        model = setting.vehicles.get(vehicle, usual)
        for corner in product(*((knob.low, knob.high) for knob in mine)):
            limits = {knob.limit: value for knob, value in zip(mine, corner, strict=True)}
            try:
                with_limits(model, limits)
            except UsageError as error:
                at = ", ".join(f"{knob.name}={float(v):g}" for knob, v in zip(mine, corner, strict=True))
                raise UsageError(f"--vary: at {at}, {vehicle} ({model.name}): {error}") from None


def read_steps(steps: int | None, knobs: int) -> int:
    """How many values of each knob. Raises ``UsageError``."""
    if steps is None:
        return 11 if knobs == 1 else 6
    most = 201 if knobs == 1 else 41
    if not 2 <= steps <= most:
        raise UsageError(f"--steps {steps}: write a number from 2 to {most}")
    return steps


def read_precision(given: Number | None) -> Fraction | None:
    """``--precision`` in SI units, None where it is not given. Raises ``UsageError``, ``InputError``."""
    if given is None:
        return None
    value = exact("--precision precision", given, "unitless")
    if value <= 0:
        raise UsageError(f"--precision {given}: write a number greater than 0, in SI units")
    return value
