"""The shape of a search: which knobs turn a drive that shows a scenario into other situations of its kind.

A shape is derived from a drive of the core: who is ahead of whom, in which lanes vehicles begin, and who
changes lanes. Its knobs are gaps, speeds, accelerations with their instants, and speeds across the road.
"""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from math import ceil, sqrt

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.closed_loop.situation import (
    Limits,
    Phase,
    StepClock,
    TrafficSituation,
    VehicleCourse,
    lane_change,
)
from roadproof.library.scenarios import SUBJECT
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Drive, Motion
from roadproof.world.motion import state_at
from roadproof.world.vehicle import Vehicle

FRICTION = Fraction("9.81")
"""The hardest braking of a vehicle under test (m/s²): that of full friction."""
_SHIFT = Fraction(1)  # m: what moves less across the road keeps its lane
_GAPS, _BESIDE = (1.0, 110.0), -12.0
_SPEEDS, _FASTER = (8.0, 38.0), 18.0
_BEGINS, _LASTS = (0.0, 4.0), (0.4, 5.0)
_CHANGES, _ASIDE = (0.0, 3.0), (0.35, 1.0)
_PLACES = 60.0
_FIT = Fraction(3)  # s over which the acceleration of the drive is averaged


@dataclass(frozen=True)
class Knob:
    """A parameter of a situation with its range; ``grain``: values are its multiples."""

    name: str
    low: float
    high: float
    grain: Fraction

    def value(self, x: float) -> Fraction:
        """Return the multiple of the grain in the range that is nearest to a number."""
        steps = round(min(max(x, self.low), self.high) / float(self.grain))
        return steps * self.grain


@dataclass(frozen=True)
class SituationShape:
    """A kind of situation: a drive as the pattern, the clock, and the limits of all vehicles."""

    pattern: DriveFile
    clock: StepClock
    limits: Mapping[str, Limits]

    @cached_property
    def vehicles(self) -> tuple[str, ...]:
        """All vehicles, SV first, then POVs in the order of their names."""
        names = sorted(self.pattern.drive.vehicles)
        return (SUBJECT, *(x for x in names if x != SUBJECT))

    @cached_property
    def knobs(self) -> tuple[Knob, ...]:
        """The knobs, in a fixed order."""
        return tuple(self._knobs())

    def _knobs(self) -> Iterator[Knob]:
        tenth, dt = Fraction(1, 10), self.clock.dt
        for name in self.vehicles:
            if name == SUBJECT:
                yield Knob("SV.speed", *_SPEEDS, tenth)
                if any(None not in x.s or x.s != (None, None) for x in self.pattern.road.lanelets):
                    yield Knob("SV.place", -_PLACES, _PLACES, Fraction(1))
            else:
                low = _GAPS[0] if self._same_way(name) else _BESIDE
                yield Knob(f"{name}.gap", low, _GAPS[1], tenth)
                yield Knob(f"{name}.faster", -_FASTER, _FASTER, tenth)
                least, most = (float(x) for x in (self.limits[name].least, self.limits[name].greatest))
                yield Knob(f"{name}.a_lon", least, most, tenth)
                yield Knob(f"{name}.begin", *_BEGINS, dt)
                yield Knob(f"{name}.lasts", *_LASTS, dt)
            if self.shifts[name]:
                yield Knob(f"{name}.change_begin", *_CHANGES, dt)
                yield Knob(f"{name}.change_speed", *_ASIDE, Fraction(1, 20))

    def _motion(self, name: str) -> Motion:
        return self.pattern.drive.vehicles[name]

    def _same_way(self, name: str) -> bool:
        """Return whether a vehicle begins in the way of the one that its gap refers to."""
        one, other = self._motion(name), self._motion(self._reference(name))
        return one.d >= other.d - other.width and other.d >= one.d - one.width

    def _reference(self, name: str) -> str:
        """Return the vehicle to which the gap of a POV refers: the one before it in the order."""
        return self.vehicles[self.vehicles.index(name) - 1]

    def _is_ahead(self, name: str) -> bool:
        return self._motion(name).s > self._motion(self._reference(name)).s

    @cached_property
    def shifts(self) -> Mapping[str, Fraction]:
        """The way of each vehicle across the road in the pattern; 0 where it keeps its lane (m)."""
        ends = {
            name: state_at(x, self.pattern.horizon).d - x.d for name, x in self.pattern.drive.vehicles.items()
        }
        return {
            name: Fraction(round(x * 20), 20) if abs(x) >= _SHIFT else Fraction(0) for name, x in ends.items()
        }

    def situation(self, values: Sequence[float]) -> TrafficSituation:
        """Return the situation of some values of the knobs, which are rounded to their grains."""
        known = {x.name: x.value(v) for x, v in zip(self.knobs, values, strict=True)}
        courses: dict[str, VehicleCourse] = {}
        for name in self.vehicles:
            courses[name] = self._course(name, known, courses)
        return TrafficSituation(courses, self.pattern.road, dict(self.pattern.lanes), self.clock, self.limits)

    def _course(
        self, name: str, known: Mapping[str, Fraction], before: Mapping[str, VehicleCourse]
    ) -> VehicleCourse:
        motion, along = self._motion(name), tuple[Phase, ...]()
        if name == SUBJECT:
            s, speed = _round(motion.s) + known.get("SV.place", 0), known["SV.speed"]
        else:
            gap, reference = known[f"{name}.gap"], before[self._reference(name)]
            ahead = self._is_ahead(name)
            s = reference.s + gap + motion.length if ahead else reference.s - reference.length - gap
            top = self.limits[name].top
            speed = min(max(before[SUBJECT].v_lon + known[f"{name}.faster"], Fraction(0)), top)
            begin, lasts = (int(known[f"{name}.{x}"] / self.clock.dt) for x in ("begin", "lasts"))
            along = (Phase(begin, lasts, known[f"{name}.a_lon"]),)
        across = self._change(name, known)
        return VehicleCourse(
            motion.length, motion.width, motion.kind, s, _round(motion.d), speed, along=along, across=across
        )

    def _change(self, name: str, known: Mapping[str, Fraction]) -> tuple[Phase, ...]:
        shift, limits, dt = self.shifts[name], self.limits[name], self.clock.dt
        if not shift:
            return ()
        mean = known[f"{name}.change_speed"]
        half = ceil(abs(shift) / mean / 2 / dt)
        half = max(half, ceil(sqrt(float(abs(shift) / limits.across)) / float(dt)))
        half = max(half, ceil(abs(shift) / limits.sideways / dt))
        return lane_change(shift, int(known[f"{name}.change_begin"] / dt), half, dt)

    @cached_property
    def seed(self) -> tuple[float, ...]:
        """The values of the knobs that come nearest to the pattern itself."""
        return self.fitted(self.pattern.drive)

    def fits(self, drive: Drive) -> bool:
        """Return whether a drive has the vehicles of the pattern in the same order along the road."""
        if {*drive.vehicles} != {*self.vehicles}:
            return False
        order = sorted(self.vehicles, key=lambda name: drive.vehicles[name].s)
        return order == sorted(self.vehicles, key=lambda name: self._motion(name).s)

    def fitted(self, drive: Drive) -> tuple[float, ...]:
        """Return the values of the knobs that come nearest to a drive that ``fits``."""
        return tuple(float(x.value(self._fitted(x.name, drive))) for x in self.knobs)

    def _fitted(self, knob: str, drive: Drive) -> float:
        name, _, quantity = knob.partition(".")
        motion = drive.vehicles[name]
        match quantity:
            case "speed":
                return float(motion.v_lon)
            case "gap":
                other = drive.vehicles[self._reference(name)]
                ahead, behind = (motion, other) if self._is_ahead(name) else (other, motion)
                return float(ahead.s - ahead.length - behind.s)
            case "faster":
                return float(motion.v_lon - drive.vehicles[SUBJECT].v_lon)
            case "a_lon":
                return float((state_at(motion, _FIT).v_lon - motion.v_lon) / _FIT)
            case "lasts":
                return float(_FIT)
            case "change_speed":
                return _ASIDE[1]
            case _:  # open: instants and places, which begin at 0
                return 0.0


def _round(value: Fraction) -> Fraction:
    return Fraction(round(value * 100), 100)


def limits_of(model: Vehicle, is_subject: bool) -> Limits:
    """Return the limits of a vehicle of a model; a vehicle under test may brake with full friction."""
    low, high = model.a_lon
    return Limits(
        -FRICTION if is_subject else low,
        high,
        model.v_lon[1],
        min(abs(x) for x in model.a_lat),
        min(abs(x) for x in model.v_lat),
        model.lateral_share,
    )
