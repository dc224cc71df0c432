"""A situation: how all vehicles begin, what POVs do, and what the route of SV asks for.

Time runs in steps. Accelerations are constant in a step, so a simulation becomes an exact drive.
"""

from collections.abc import Mapping
from fractions import Fraction

from roadproof.runtime.records import dataclass
from roadproof.world.road import Road
from roadproof.world.signals import Kind


@dataclass(frozen=True)
class Phase:
    """An acceleration (m/s²) in the steps from ``begin`` on, ``count`` of them."""

    begin: int
    count: int
    acceleration: Fraction

    def __str__(self) -> str:
        return f"{float(self.acceleration):g} m/s^2 from step {self.begin} for {self.count}"


@dataclass(frozen=True)
class VehicleCourse:
    """A vehicle: its box (m), its state at time 0 (m, m/s), and its accelerations.

    Of SV, ``across`` is the plan that it follows unless its controller demands otherwise, and ``along`` is
    empty.
    """

    length: Fraction
    width: Fraction
    kind: Kind | None
    s: Fraction
    d: Fraction
    v_lon: Fraction
    v_lat: Fraction = Fraction(0)
    along: tuple[Phase, ...] = ()
    across: tuple[Phase, ...] = ()


@dataclass(frozen=True)
class StepClock:
    """The step of the controller (s), and the number of steps of a simulation."""

    dt: Fraction
    steps: int

    @property
    def horizon(self) -> Fraction:
        """The time that the controller drives (s)."""
        return self.dt * self.steps

    def at(self, seconds: float) -> int:
        """Return the step that is nearest to an instant."""
        return round(seconds / float(self.dt))


@dataclass(frozen=True)
class Limits:
    """The limits of a vehicle: acceleration along the road, greatest speed, and motion across the road.

    ``share``: the greatest |v_lat| as a share of v_lon (``world.vehicle.Vehicle``).
    """

    least: Fraction
    greatest: Fraction
    top: Fraction
    across: Fraction
    sideways: Fraction
    share: Fraction


@dataclass(frozen=True)
class TrafficSituation:
    """The courses of all vehicles by name, SV first, on a road with lanes for the free lanes of a formula."""

    courses: Mapping[str, VehicleCourse]
    road: Road
    lanes: Mapping[str, str]
    clock: StepClock
    limits: Mapping[str, Limits]

    @property
    def subject(self) -> str:
        """The name of the vehicle under test."""
        return next(iter(self.courses))

    @property
    def others(self) -> tuple[str, ...]:
        """The names of the other vehicles."""
        return tuple(self.courses)[1:]


def lane_change(shift: Fraction, begin: int, half: int, dt: Fraction) -> tuple[Phase, ...]:
    """Return the accelerations across the road that move a vehicle by ``shift`` (m) in 2·``half`` steps."""
    push = shift / (half * dt) ** 2
    return Phase(begin, half, push), Phase(begin + half, half, -push)


def values_of(phases: tuple[Phase, ...], steps: int) -> list[Fraction]:
    """Return the acceleration in each step; where phases overlap, that of the later one."""
    values = [Fraction(0)] * steps
    for x in phases:
        begin, end = max(0, x.begin), min(steps, x.begin + x.count)
        values[begin:end] = [x.acceleration] * max(0, end - begin)
    return values
