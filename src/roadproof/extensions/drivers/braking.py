"""The braking of a driver over time: ramps, and how AEB changes them; exact.

It is worked out from times, apart from the formulas of ``driver.spec``.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import pairwise
from math import isqrt
from typing import Literal, TypeAlias

from roadproof.errors import InputError
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Along

_NONE = Fraction(0)
Joined: TypeAlias = Literal["none", "replace", "max", "add"]
"""What AEB makes of the braking of a driver: the option ``cc_aeb``."""


@dataclass(frozen=True)
class Ramp:
    """A braking that grows from ``onset`` (s) on in ``duration`` (s, > 0) to ``full`` (m/s²), and stays."""

    onset: Fraction
    duration: Fraction
    full: Fraction

    @property
    def end(self) -> Fraction:
        """The instant of full braking (s)."""
        return self.onset + self.duration

    def at(self, time: Fraction) -> Fraction:
        """Return the braking (m/s²) at a time (s)."""
        return self.full * max(_NONE, min(Fraction(1), (time - self.onset) / self.duration))


@dataclass(frozen=True)
class AssistedBraking:
    """The braking of a driver, and of AEB from its onset on, joined as the option ``cc_aeb`` says.

    AEB brakes at least as hard as the driver, in a ramp of the same duration; ``aeb`` None is no AEB.
    """

    driver: Ramp
    aeb: Ramp | None = None
    joined: Joined = "none"

    def at(self, time: Fraction) -> Fraction:
        """Return the braking (m/s²) at a time (s), right of a jump."""
        driver, aeb = self.driver, self.aeb
        if aeb is None:
            return driver.at(time)
        if self.joined == "replace":
            takes_over = Ramp(min(driver.onset, aeb.onset), aeb.duration, aeb.full)
            return takes_over.at(time) if time >= aeb.onset else driver.at(time)
        if self.joined == "max":
            return max(driver.at(time), aeb.at(time))
        return min(driver.at(time) + aeb.at(time), aeb.full)

    @property
    def knots(self) -> list[Fraction]:
        """The times (s) between which braking is affine; after the last it is constant."""
        driver, aeb = self.driver, self.aeb
        knots = {_NONE, driver.onset, driver.end}
        if aeb is not None:
            a, b = driver.full, aeb.full
            knots |= {aeb.onset, aeb.end, aeb.onset + aeb.duration * a / b}  # max, on the driver's plateau
            knots |= {
                (a * driver.onset + b * aeb.end) / (a + b),
                aeb.onset + aeb.duration * (b - a) / b,
            }  # add
            if b > a:
                knots.add((b * aeb.onset - a * driver.onset) / (b - a))  # max, on both ramps
        return sorted(x for x in knots if x >= 0)

    def pieces(self, speed: Fraction) -> list[Along]:
        """The motion from ``speed`` (m/s) at time 0 until it stands.

        Raises ``InputError`` where it stands while braking grows, at an irrational instant.
        """
        return pieces_of(speed, self.phases)

    @property
    def phases(self) -> list[tuple[Fraction | None, Fraction, Fraction]]:
        """Durations (s, None for ever) with acceleration and jerk, as if the vehicle never stood."""
        made: list[tuple[Fraction | None, Fraction, Fraction]] = []
        for time, end in pairwise([*self.knots, None]):
            assert time is not None
            braking, growth = self.at(time), _NONE
            if end is not None:
                middle = (time + end) / 2
                growth = (self.at(middle) - braking) / (middle - time)
            made.append((None if end is None else end - time, -braking, -growth))
        return made

    def state(self, speed: Fraction, time: Fraction) -> tuple[Fraction, Fraction]:
        """Return speed (m/s) and braking (m/s²) at a time; both are 0 once it stands."""
        for duration, acceleration, jerk in self.pieces(speed):
            if time < duration:
                return speed + acceleration * time + jerk * time**2 / 2, -acceleration - jerk * time
            speed += acceleration * duration + jerk * duration**2 / 2
            time -= duration
        return _NONE, _NONE


def pieces_of(speed: Fraction, phases: Iterable[tuple[Fraction | None, Fraction, Fraction]]) -> list[Along]:
    """Return the motion from ``speed`` (m/s) through phases until it stands.

    Raises ``InputError`` where it stands while braking grows, at an irrational instant.
    """
    made: list[Along] = []
    for lasts, acceleration, jerk in phases:
        brakes = acceleration < 0 or jerk < 0
        stands = _stands(speed, -acceleration, -jerk, lasts) if brakes else None
        duration = lasts if stands is None else stands
        assert duration is not None, "the last braking is constant, and more than none"
        if duration > 0:
            made.append((duration, acceleration, jerk))
        if stands is not None:
            break
        speed += acceleration * duration + jerk * duration**2 / 2
    return _joined(made)


def _stands(
    speed: Fraction, braking: Fraction, growth: Fraction, duration: Fraction | None
) -> Fraction | None:
    """Return after what time it stands within ``duration``, or None. Raises ``InputError``."""
    if duration is not None and speed > braking * duration + growth * duration**2 / 2:
        return None
    if speed == 0:
        return _NONE
    if growth == 0:
        return speed / braking
    square = braking**2 + 2 * growth * speed
    root = Fraction(isqrt(square.numerator), isqrt(square.denominator))
    if root**2 != square:
        raise InputError(
            f"speed={float(speed):.6g} m/s: from there a vehicle stands while its braking grows, at an "
            "instant that is no fraction, so no drive says it exactly; take a higher speed or another place"
        )
    return (root - braking) / growth


def _joined(pieces: Sequence[Along]) -> list[Along]:
    """Merge each piece that continues the one before it."""
    made: list[Along] = []
    for duration, acceleration, jerk in pieces:
        if made:
            before, start, growing = made[-1]
            if jerk == growing and acceleration == start + growing * before:
                made[-1] = (before + duration, start, jerk)
                continue
        made.append((duration, acceleration, jerk))
    return made
