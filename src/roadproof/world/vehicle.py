"""What a vehicle can do: its box and the limits of its motion (semantics §2)."""

from collections.abc import Mapping
from dataclasses import field, replace
from fractions import Fraction

from roadproof.errors import UsageError
from roadproof.runtime.records import dataclass
from roadproof.world.signals import LIMITED, SIGNALS, Kind

Range = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Vehicle:
    """A point mass with a box. Lengths in m, speeds in m/s, accelerations in m/s².

    ``lateral_share``: |v_lat| is at most this share of v_lon, which keeps the heading below
    arctan(share); ``cruise`` is the range of speeds that a natural drive starts with, and
    ``jump_lon`` and ``jump_lat`` bound how far the acceleration of a natural drive
    changes from one piece to the next. ``kind`` None: the model does not say. ``a_bend``: on a bend, the
    greatest absolute value of the acceleration across in the plane (``world.bends``).
    """

    name: str
    length: Fraction
    width: Fraction
    v_lon: Range
    v_lat: Range
    a_lon: Range
    a_lat: Range
    lateral_share: Fraction
    cruise: Range
    jump_lon: Fraction
    jump_lat: Fraction
    kind: Kind | None = None
    a_bend: Fraction = field(default=Fraction(4), repr=False)  # a search on bends has it in ``name``


# Ranges whose ends can be moved, and their units.
LIMITS: Mapping[str, str] = {name: SIGNALS[name].unit for name in LIMITED}


def with_limits(vehicle: Vehicle, limits: Mapping[str, Fraction]) -> Vehicle:
    """``vehicle`` with other ends of its ranges, given as ``v_lon.max`` or ``a_lon.min``; its name says so.

    The cruising speeds are cut to the speeds that are left. Raises ``UsageError`` for a range that is empty,
    that lets a vehicle reverse, or that leaves out going straight on at a steady speed.
    """
    if not limits:
        return vehicle
    ranges = {name: getattr(vehicle, name) for name in LIMITS}
    for limit, value in limits.items():
        name, _, end = limit.partition(".")
        low, high = ranges[name]
        ranges[name] = (value, high) if end == "min" else (low, value)
    for name, (low, high) in ranges.items():
        unit = LIMITS[name]
        if low >= high:
            raise UsageError(
                f"{name} from {low} to {high} {unit} is empty: its least must be the smaller one"
            )
        if name == "v_lon" and low < 0:
            raise UsageError(f"v_lon from {low} {unit}: a vehicle never reverses: use 0 or more")
        if name != "v_lon" and not low <= 0 <= high:
            raise UsageError(f"{name} from {low} to {high} {unit} leaves out 0, so no vehicle could drive on")
    made = replace(vehicle, **ranges)
    slow, fast = made.v_lon
    cruise = max(slow, vehicle.cruise[0]), min(fast, vehicle.cruise[1])
    cruise = cruise if cruise[0] < cruise[1] else (slow, fast)
    changed = ", ".join(f"{limit}={value}" for limit, value in limits.items())
    return replace(made, name=f"{vehicle.name} with {changed}", cruise=cruise)
