"""Manoeuvres in which SV is driven by a sampled controller: exact drives, place by place.

There is no formula for where such a driver collides. Each place that is looked at is decided exactly, from
the whole drive; nothing is claimed of what lies between them.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from itertools import groupby
from math import ceil

from roadproof.errors import InputError
from roadproof.extensions.drivers import manoeuvres
from roadproof.extensions.drivers.fuzzy import HERTZ, TICKS, Controller, Scale, moved, scale_of, slip, step
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Along

PLACES = 121  # of a line
TOLD = (
    f"each place is decided by a drive stepped at {HERTZ} Hz, {PLACES} places a line; "
    "between places looked at nothing is claimed"
)
_MOST_LOOKS = 20_000
_WANDER = Fraction("0.375")  # m: past it POV is seen to cut out


@dataclass(frozen=True)
class Course:
    """The brakings (m/s²) of SV, with for how many looks it holds each; then it goes on.

    ``touches``: whether the boxes touch, and SV has not passed the other vehicle before.
    """

    brakings: tuple[tuple[int, Fraction], ...]
    touches: bool

    @property
    def along(self) -> list[Along]:
        """The pieces of the motion along the road."""
        made: list[Along] = []
        for count, braking in self.brakings:
            made += count * step(braking) if braking else [(Fraction(count, HERTZ), -braking, Fraction(0))]
        return made


@dataclass(frozen=True)
class _Other:
    """The vehicle that SV may touch, in units: where it is, how it goes, and from when on it is in the way.

    ``seen``: the first look at which the controller knows of it.
    """

    scale: Scale
    gap: int
    speed: int
    braking: int
    lengths: int
    beside: int
    lateral: int
    seen: int

    @cached_property
    def begins(self) -> int:
        """The time from which the other is in the way and the controller knows of it; rounded up."""
        return max(ceil(self.in_way), TICKS * self.seen)

    @cached_property
    def in_way(self) -> Fraction:
        """The time at which the boxes begin to be side by side, in units of time."""
        return Fraction(self.beside, self.lateral) if self.beside > 0 else Fraction(0)

    def at(self, time: int) -> tuple[int, int]:
        """Return how far it has gone, and how fast it is."""
        if self.braking * time <= self.speed:
            return time * (2 * self.speed - self.braking * time) // 2, self.speed - self.braking * time
        return self.speed * self.speed // (2 * self.braking), 0


def _other(start: manoeuvres.Start) -> tuple[_Other, int]:
    """The other vehicle, and SV's speed, in units."""
    speed, lateral, seen = start.Ve0, Fraction(0), 0
    beside, braking = Fraction(0), Fraction(0)
    match start:
        case manoeuvres.CutIn():
            gap, other, beside, lateral = start.dx0, speed - start.dV0, start.dy0, start.Vy
        case manoeuvres.CutOut():
            gap, other = start.second - start.length, start.Vf0
            seen = int(_WANDER / start.Vy * HERTZ) + 1
        case manoeuvres.Deceleration():
            gap, other, braking = start.dx0, speed - start.dV0, start.Gx
    stops = other**2 / (2 * braking) if braking else Fraction(0)
    lengths = 2 * start.length
    scale = scale_of(gap, speed, other, lateral, beside, braking, stops, lengths)
    units = _Other(
        scale,
        scale.length(gap),
        scale.speed(other),
        scale.acceleration(braking),
        scale.length(lengths),
        scale.length(beside),
        scale.speed(lateral),
        seen,
    )
    return units, scale.speed(speed)


def course_of(manoeuvre: manoeuvres.Manoeuvre, values: manoeuvres.Values, to_the_end: bool = True) -> Course:
    """Return how SV drives from these values on; if not ``to_the_end``, only whether the boxes touch.

    Raises ``InputError`` where SV would have to look too often.
    """
    other, speed = _other(manoeuvres.start_of(manoeuvre, values))
    controller = Controller(other.scale)
    brakings: list[tuple[int, int]] = []
    gone, time, touches, passed = 0, 0, False, False
    for _ in range(_MOST_LOOKS):
        ahead, its_speed = other.at(time)
        gap, braking = other.gap + ahead - gone, 0
        if time >= TICKS * other.seen:
            beside = other.beside - other.lateral * time
            braking = controller.look(gap, other.lengths, speed, its_speed, beside, other.lateral)
        state = _State(time, gap, speed, its_speed)
        acts = braking > 0 or controller.waits
        if ((touches or passed) and not to_the_end) or _is_over(other, state, acts and to_the_end):
            touches = touches or (not passed and _touches_later(other, state))
            return Course(tuple(_merged_looks(other.scale, brakings)) if to_the_end else (), touches)
        passed = passed or _passes(other, state, braking)
        touches = touches or (not passed and _touches(other, state, braking))
        if not (to_the_end or touches) and _stays_clear(other, state, controller):
            return Course((), False)
        count = 1 if acts else _looks_without(other, state, controller)
        brakings.append((count, braking))
        time += count * TICKS
        gone += (count - 1) * TICKS * speed + moved(speed, braking)  # of several looks none brakes
        speed -= TICKS * braking
    text = ", ".join(f"{name}={value}" for name, value in values.items())
    raise InputError(
        f"{text} (SI): SV's drive is not over after {_MOST_LOOKS} steps of the controller; "
        "choose other values"
    )


@dataclass(frozen=True)
class _State:
    """The state at a look, in units."""

    time: int
    gap: int
    speed: int
    its_speed: int


def _is_over(other: _Other, now: _State, acts: bool) -> bool:
    """Return whether SV, which now ``acts`` or not, never brakes again: it stands, is past, or is no
    faster.
    """
    if now.speed == 0:
        return True
    if acts or now.time < other.begins:
        return False
    if 2 * now.gap + other.lengths < 0:
        return now.speed >= now.its_speed
    return other.braking == 0 and now.speed <= now.its_speed and now.gap > 0


def _stays_clear(other: _Other, now: _State, controller: Controller) -> bool:
    """Return whether SV surely brakes in time, should it ever come within the margin of the other.

    The other keeps its speed, and SV is never faster than now. Where SV is faster and within the margin, it
    is nearer than what is unsafe, and brakes comfortably at least, as soon as it may.
    """
    if now.time < other.begins or (other.braking and now.its_speed):
        return False
    return controller.needs(now.speed - now.its_speed) < min(now.gap, controller.margin)


def _looks_without(other: _Other, now: _State, controller: Controller) -> int:
    """Return for how many looks SV is too far away to see danger without braking; at least one."""
    if other.braking or now.speed <= now.its_speed or now.time < other.begins:
        return 1
    return max(
        1, (now.gap - controller.far(now.speed, now.its_speed)) // (TICKS * (now.speed - now.its_speed))
    )


def _touches(other: _Other, now: _State, braking: int) -> bool:
    """Return whether the boxes touch from this look to the next, both with them."""
    if now.gap > TICKS * now.speed:
        return False
    begin, end = max(Fraction(0), other.in_way - now.time), Fraction(TICKS)
    if begin > end:
        return False
    slows, speed = other.braking if now.its_speed else 0, now.speed - TICKS * braking
    way = _GapCourse(Fraction(now.gap - slip(braking)), Fraction(speed - now.its_speed), Fraction(-slows))
    stands = Fraction(now.its_speed, slows) if slows else end
    if stands >= end:
        return way.meets(begin, end, other.lengths)
    rest = _GapCourse(way.at(stands), Fraction(speed), Fraction(0))
    return way.meets(begin, stands, other.lengths) or rest.meets(Fraction(0), end - stands, other.lengths)


def _passes(other: _Other, now: _State, braking: int) -> bool:
    """Return whether SV is past the other, which keeps its speed, before it is in the way, and by the next
    look.
    """
    if now.time >= other.in_way:
        return False
    lasts = min(Fraction(TICKS), other.in_way - now.time)
    closing = now.speed - TICKS * braking - now.its_speed
    by_then = now.gap - slip(braking) - closing * lasts
    return now.gap < -other.lengths or by_then < -other.lengths


@dataclass(frozen=True)
class _GapCourse:
    """The gap over time: ``gap - closing*s + bend*s^2/2``."""

    gap: Fraction
    closing: Fraction
    bend: Fraction

    def at(self, s: Fraction) -> Fraction:
        return self.gap - self.closing * s + self.bend * s * s / 2

    def meets(self, begin: Fraction, end: Fraction, lengths: int) -> bool:
        """Return whether it is somewhere between touching the other's rear and touching its front."""
        values = [self.at(begin), self.at(end)]
        if self.bend and begin < self.closing / self.bend < end:
            values.append(self.at(self.closing / self.bend))
        return min(values) <= 0 and max(values) >= -lengths


def _touches_later(other: _Other, now: _State) -> bool:
    """Return whether the boxes touch once SV's speed does not change any more; SV has not passed the other
    so far.

    Where the other brakes, SV stands behind it, and the gap has been what it is to be.
    """
    if other.braking:
        return False
    rate = now.its_speed - now.speed
    begin = now.gap + rate * max(Fraction(0), other.in_way - now.time)
    return begin >= -other.lengths and (begin <= 0 or rate < 0)


def _merged_looks(scale: Scale, brakings: list[tuple[int, int]]) -> Iterator[tuple[int, Fraction]]:
    """Looks with equal brakings put together, in m/s^2."""
    for braking, same in groupby(brakings, key=lambda x: x[1]):
        yield sum(count for count, _ in same), scale.to_acceleration(braking)


def places_of(plane: manoeuvres.Plane) -> tuple[Fraction, ...]:
    """The places of each line that are looked at."""
    return tuple(manoeuvres.spread(*plane.along, PLACES))


def labels_of(plane: manoeuvres.Plane) -> tuple[tuple[bool, ...], ...]:
    """Return for each row the places at which the boxes touch; none where a vehicle would reverse."""
    return tuple(tuple(_label(plane, row, place) for place in places_of(plane)) for row in plane.rows)


def _label(plane: manoeuvres.Plane, row: Fraction, place: Fraction) -> bool:
    values = plane.values(row, place)
    return manoeuvres.is_possible(values) and course_of(plane.manoeuvre, values, False).touches


def spans_of(places: tuple[Fraction, ...], labels: tuple[bool, ...]) -> Iterator[tuple[Fraction, Fraction]]:
    """First and last of neighbouring places at which the boxes touch."""
    for is_hit, group in groupby(zip(places, labels, strict=True), key=lambda x: x[1]):
        if is_hit:
            run = [place for place, _ in group]
            yield run[0], run[-1]


def beside_change(
    plane: manoeuvres.Plane, labels: tuple[tuple[bool, ...], ...], label: bool
) -> Iterator[dict[str, Fraction]]:
    """Initial values of that label whose neighbour has the other, those of middle rows first; then any."""
    middle, places = (plane.across[0] + plane.across[1]) / 2, places_of(plane)
    rows = sorted(zip(plane.rows, labels, strict=True), key=lambda x: abs(x[0] - middle))
    for beside in (True, False):
        for row, spans in rows:
            for k, place in enumerate(places):
                differs = any(x is not label for x in spans[max(0, k - 1) : k + 2])
                if spans[k] is label and differs is beside:
                    yield plane.values(row, place)
