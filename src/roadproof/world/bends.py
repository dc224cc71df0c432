"""Limits of a vehicle on a bend, where the road's curvature κ adds v_lon²·κ to the lateral acceleration.

On a road with a reference line, the acceleration of a vehicle to its left in the plane is v_lon²·κ + a_lat at
d = 0; elsewhere the factor is at most 1 + |κ·d| (``length_error``). Its absolute value is at most
``Vehicle.a_bend``.
"""

from dataclasses import replace
from fractions import Fraction
from math import isqrt

from roadproof.errors import UsageError
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.vehicle import Vehicle

_HUNDREDTHS = 100


def on_bends(vehicle: Vehicle, line: ReferenceLine | None) -> Vehicle:
    """Return ``vehicle`` with speeds and ``a_lat`` limited so that all combinations are possible on bends.

    This is sufficient, not necessary; the vehicle's name states it, since NONE-WITHIN is about such vehicles
    only. Raises ``UsageError`` if the vehicle cannot drive that slowly.
    """
    bends = () if line is None else line.bends()
    sharpest = max((x.greatest for x in bends), default=Fraction(0))
    if sharpest == 0:
        return vehicle
    across = min(max(map(abs, vehicle.a_lat)), vehicle.a_bend / 2)
    a_lat = max(vehicle.a_lat[0], -across), min(vehicle.a_lat[1], across)
    square = (vehicle.a_bend - across) / sharpest
    most = Fraction(isqrt(int(square * _HUNDREDTHS**2)), _HUNDREDTHS)
    slow, fast = vehicle.v_lon
    radius = f"{float(1 / sharpest):.4g} m"
    if most <= slow:
        raise UsageError(
            f"vehicle {vehicle.name}: on a bend of radius {radius} it drives at most {float(most):g} m/s, as "
            f"|v_lon²·κ + a_lat| <= {vehicle.a_bend} m/s², but at least {slow} m/s: choose another stretch "
            "or a vehicle with another a_bend"
        )
    rule = f"|v_lon²·κ + a_lat| <= {vehicle.a_bend} m/s²"
    name = f"{vehicle.name} on bends of radius {radius} or more ({rule})"
    fast = min(fast, most)
    cruise = max(slow, vehicle.cruise[0]), min(fast, vehicle.cruise[1])
    cruise = cruise if cruise[0] < cruise[1] else (slow, fast)
    return replace(vehicle, name=name, v_lon=(slow, fast), a_lat=a_lat, cruise=cruise)
