"""One step of a vehicle, the same for floats and fractions.

A demand is cut to the limits of the vehicle: it never reverses, and its heading stays small. Speeds are
linear in a step, so a limit on them that holds at both ends holds between.
"""

from typing import Generic, TypeVar

from roadproof.extensions.closed_loop.situation import Limits
from roadproof.world.signals import RECORDED

N = TypeVar("N")
FINE = 1000
"""Demands are rounded to a thousandth."""


class Body(Generic[N]):
    """The state of a vehicle: front, left side (m), speeds (m/s), and accelerations of the last step.

    ``number``: makes a number of its kind, float or Fraction, of a fraction.
    """

    __slots__ = (*RECORDED, "dt", "goal", "half", "left", "limits", "pushes")

    def __init__(self, s: N, d: N, v_lon: N, v_lat: N, dt: N, half: N, limits: tuple[N, ...]) -> None:
        self.s, self.d, self.v_lon, self.v_lat = s, d, v_lon, v_lat
        self.a_lon = self.a_lat = v_lat - v_lat  # type: ignore[operator]
        self.dt, self.half, self.limits = dt, half, limits
        self.goal = ""
        self.pushes: list[N] = []

    def move(self: "Body[float]", a_lon: float, a_lat: float) -> None:
        """Advance by a step with these accelerations, cut to the limits."""
        least, greatest, top, across, sideways, share = self.limits
        dt, v = self.dt, self.v_lon
        a_lon = least if a_lon < least else greatest if a_lon > greatest else a_lon
        faster = v + a_lon * dt
        if faster < 0:
            a_lon, faster = -v / dt, v - v
        elif faster > top:
            a_lon, faster = (top - v) / dt, top
        u = self.v_lat
        if a_lat or u:
            a_lat = -across if a_lat < -across else across if a_lat > across else a_lat
            most = share * faster
            most = sideways if most > sideways else most
            aside = u + a_lat * dt
            if aside > most or aside < -most:
                aside = most if aside > 0 else -most
                a_lat = (aside - u) / dt
            self.d += dt * (u + aside) * self.half
            self.v_lat = aside
        self.s += dt * (v + faster) * self.half
        self.v_lon = faster
        self.a_lon, self.a_lat = a_lon, a_lat

    def towards(self: "Body[float]", velocity: float) -> float:
        """Return the acceleration that gives a velocity across the road at the end of the step."""
        return (velocity - self.v_lat) / self.dt

    def push_to(self: "Body[float]", lane: str, place: float) -> float:
        """Return the acceleration that moves its left side to ``place``; each change is planned once."""
        if self.goal != lane and not self.pushes:
            if self.v_lat:
                return -self.v_lat / self.dt
            self.goal = lane
            shift = place - self.d
            count = max(2, int(abs(shift) / (2 * self.dt)) + 1)
            span = count * self.dt
            push = shift / (span * span)
            self.pushes = [-push] * count + [push] * count  # the next one is last
        return self.pushes.pop() if self.pushes else self.towards(self.v_lat - self.v_lat)


def limits_as(limits: Limits, number: type[N]) -> tuple[N, ...]:
    """Return the limits as numbers of one kind."""
    values = (
        limits.least,
        limits.greatest,
        limits.top,
        limits.across,
        limits.sideways,
        limits.share,
    )
    return tuple(number(x) for x in values)  # type: ignore[call-arg]
