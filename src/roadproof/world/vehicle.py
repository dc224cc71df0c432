"""Models of vehicles: the box, and the limits of its motion (semantics §2)."""

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

    ``lateral_share``: the largest |v_lat| as a share of v_lon, which keeps the heading below arctan(share).
    ``cruise``: the initial speeds of a natural drive. ``jump_lon`` and ``jump_lat``: the largest change of
    its acceleration from one piece to the next. ``kind``: None if the model does not say. ``a_bend``: on a
    bend, the greatest absolute value of the lateral acceleration in the plane (``world.bends``).
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
    a_bend: Fraction = field(default=Fraction(4), repr=False)  # ``bends.on_bends`` puts it into ``name``


# Ranges whose ends a user can change, and their units.
LIMITS: Mapping[str, str] = {name: SIGNALS[name].unit for name in LIMITED}


def with_limits(vehicle: Vehicle, limits: Mapping[str, Fraction]) -> Vehicle:
    """Return ``vehicle`` with other limits, named ``v_lon.max`` or ``a_lon.min``; its name lists them.

    Cruising speeds are cut to the new range. Raises ``UsageError`` for a range that is empty, allows to
    reverse, or excludes driving straight on at a steady speed.
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
    changed_vehicle = replace(vehicle, **ranges)
    slow, fast = changed_vehicle.v_lon
    cruise = max(slow, vehicle.cruise[0]), min(fast, vehicle.cruise[1])
    cruise = cruise if cruise[0] < cruise[1] else (slow, fast)
    changed = ", ".join(f"{limit}={value}" for limit, value in limits.items())
    return replace(changed_vehicle, name=f"{vehicle.name} with {changed}", cruise=cruise)
