"""What ``roadproof explore`` is asked: knobs and measures from the words of the command line."""

import re
from collections.abc import Sequence
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING

from roadproof.cli.options import read_value
from roadproof.errors import UsageError

if TYPE_CHECKING:
    from roadproof.analysis.explore.knobs import Knob
    from roadproof.analysis.requests import Request
    from roadproof.spec.library import Library
    from roadproof.spec.query import Query

_LIMIT = re.compile(r"(\w+)\.(\w+)\.(min|max)")
EVERY_VEHICLE = "vehicle"


def read_knobs(texts: Sequence[str], request: "Request", query: "Query", library: "Library") -> "list[Knob]":
    """The knobs of ``--vary NAME=LOW:HIGH``. Raises ``UsageError``, ``InputError``."""
    if len(texts) > 2:
        raise UsageError(f"--vary is given {len(texts)} times: vary one or two things at once")
    knobs = [_knob(text, request, query, library) for text in texts]
    if len({knob.name for knob in knobs}) < len(knobs):
        raise UsageError(f"--vary {knobs[0].name} is given twice: vary two different things")
    _check_limits(knobs, request, query)
    return knobs


def _knob(text: str, request: "Request", query: "Query", library: "Library") -> "Knob":
    name, equals, ends = (part.strip() for part in text.partition("="))
    low, colon, high = (part.strip() for part in ends.partition(":"))
    if not (name and equals and low and colon and high):
        raise UsageError(f"--vary {text}: write --vary NAME=LOW:HIGH, such as minDanger=0:3")
    knob = (
        _limit(text, name, low, high, request, query)
        if "." in name
        else _parameter(text, name, low, high, query, library)
    )
    if knob.low >= knob.high:
        raise UsageError(f"--vary {text}: the range is empty; the first value must be the smaller one")
    return knob


def _parameter(text: str, name: str, low: str, high: str, query: "Query", library: "Library") -> "Knob":
    from roadproof.analysis.explore.knobs import Knob
    from roadproof.analysis.explore.text import unit_text
    from roadproof.logic.rewrite import parameters_of
    from roadproof.spec.library import unknown
    from roadproof.units import UNITS

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
    ends = [read_value("--vary", name, end, declared.unit) for end in (low, high)]
    if (declared.bound == ">" and ends[0] <= 0) or (declared.bound == ">=" and ends[0] < 0):
        raise UsageError(
            f"--vary {text}: the range leaves the declared bound; the library demands {name} "
            f"{declared.bound} 0"
        )
    return Knob(name, unit_text(UNITS[declared.unit][1]), ends[0], ends[1])


def _limit(text: str, name: str, low: str, high: str, request: "Request", query: "Query") -> "Knob":
    from roadproof.analysis.explore.knobs import Knob
    from roadproof.world.vehicle import LIMITS

    read = _LIMIT.fullmatch(name)
    if read is None or read[2] not in LIMITS:
        raise UsageError(
            f"--vary {text}: write a limit as VEHICLE.LIMIT.min or .max, where LIMIT is "
            f"{', '.join(LIMITS)} and VEHICLE is {', '.join(query.vehicles)} or {EVERY_VEHICLE} for all"
        )
    if read[1] not in (*query.vehicles, EVERY_VEHICLE):
        raise UsageError(
            f"--vary {text}: the formula speaks of {', '.join(query.vehicles)}; {EVERY_VEHICLE} means all"
        )
    unit, limit = LIMITS[read[2]], f"{read[2]}.{read[3]}"
    ends = [read_value("--vary", name, end, unit) for end in (low, high)]
    vehicles = query.vehicles if read[1] == EVERY_VEHICLE else (read[1],)
    return Knob(name, unit, ends[0], ends[1], tuple(vehicles), limit)


def _check_limits(knobs: "Sequence[Knob]", request: "Request", query: "Query") -> None:
    """Raise ``UsageError`` where limits at some point make no vehicle; the corners are the worst of them."""
    from roadproof.world.models import load_vehicle
    from roadproof.world.vehicle import with_limits

    usual = request.vehicles.get("", "car")
    for vehicle in query.vehicles:
        mine = [knob for knob in knobs if vehicle in knob.vehicles]
        if not mine:
            continue
        if len({knob.limit for knob in mine}) < len(mine):
            raise UsageError(
                f"--vary {mine[0].name} and {mine[1].name}: both are {mine[0].limit} of {vehicle}"
            )
        model = load_vehicle(request.vehicles.get(vehicle, usual))
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


def read_precision(text: str | None) -> Fraction | None:
    """``--precision`` in SI units, None where it is not given. Raises ``UsageError``."""
    if text is None:
        return None
    value = read_value("--precision", "precision", text, "unitless")
    if value <= 0:
        raise UsageError(f"--precision {text}: write a number greater than 0, in SI units")
    return value
