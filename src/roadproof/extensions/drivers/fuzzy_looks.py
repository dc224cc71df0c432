"""The fuzzy safety model in a test, look by look; states are rounded to its units."""

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction

from roadproof.extensions.drivers.fuzzy import CHANGE, COMFORT, HERTZ, Controller, scale_of, step
from roadproof.extensions.drivers.lanes import VehicleBox
from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.extensions.drivers.response import Phase, Scene
from roadproof.runtime.records import dataclass

_FINE = 10**6
_WANDER = Fraction("0.375")  # m: past it POV is seen to cut out
_EVEN = (Fraction(0), Fraction(0))  # acceleration and jerk
LONGEST = 60
"""Seconds that the controller is followed."""


@dataclass(frozen=True)
class Look:
    """The view of SV at a look.

    The gap along the road (m), both speeds (m/s), the distance across (m), and how fast that shrinks (m/s).
    """

    gap: Fraction
    speed: Fraction
    other: Fraction
    beside: Fraction
    lateral: Fraction

    @staticmethod
    def of(
        me: VehicleBox,
        other: VehicleBox,
        speed: Fraction,
        its_speed: Fraction,
        drift: Fraction,
        its_drift: Fraction,
    ) -> "Look":
        """Return what SV sees of the other vehicle; ``drift``: speeds across the road, to the left."""
        is_left = other.middle >= me.middle
        apart = other.d - other.width - me.d if is_left else me.d - me.width - other.d
        shrinks = drift - its_drift if is_left else its_drift - drift
        return Look(other.s - other.length - me.s, speed, its_speed, apart, shrinks)


@dataclass(frozen=True)
class Sight:
    """The boxes of both vehicles at a look, and their speeds along and across, as they move in the test.

    ``is_even``: from now on both go straight on in the test, as fast as now.
    """

    time: Fraction
    me: VehicleBox
    other: VehicleBox
    speed: Fraction
    its_speed: Fraction
    drift: Fraction
    its_drift: Fraction
    is_even: bool


def known_from(scene: Scene, manoeuvre: ManoeuvreName) -> Fraction | None:
    """Return from when on SV knows of the vehicle ahead; in a cut-out POV1 hides it first."""
    return scene.offset(_WANDER) if manoeuvre == "cut-out" else scene.start


def controlled(looks: Iterable[Sight], known: Fraction | None) -> tuple[Fraction | None, list[Phase]]:
    """Return when SV first brakes, and its motion along the road from then on, from look to look.

    Where it is faster after the last look, but surely brakes in time whatever it sees, it loses that speed at
    once: the controller would lose less and less of it at every look.
    """
    made = _Controlled()
    for now in looks:
        if made.is_over(now):
            return made.onset, made.phases
        made.look(now, known is not None and now.time >= known)
        made.finish(now)
    return made.onset, [*made.phases, *made.rest]


class _Controlled:
    """The motion of SV under the controller: as in the test until it first brakes. Its memory goes on."""

    def __init__(self) -> None:
        self.onset: Fraction | None = None
        self.phases: list[Phase] = []
        self.rest: list[Phase] = []
        self._looks = 0
        self._place = self._speed = self._braking = Fraction(0)
        self._scale = scale_of(Fraction(1, _FINE))
        self._controller = Controller(self._scale)

    def is_over(self, now: Sight) -> bool:
        """Return whether SV stands or has passed, or neither brakes any more nor is faster than the other."""
        if self.onset is None:
            self._place, self._speed = now.me.s, now.speed
        if self._speed <= 0 or self._place - now.me.length > now.other.s:
            return True
        acts = self._braking > 0 or self._controller.waits
        ahead = now.other.s - now.other.length > self._place
        return now.is_even and ahead and not acts and self._looks > 0 and self._speed <= now.its_speed

    def look(self, now: Sight, knows: bool) -> None:
        """Look once, and go on to the next look."""
        mine = replace(now.me, s=self._place)
        seen = Look.of(mine, now.other, self._speed, now.its_speed, now.drift, now.its_drift)
        self._braking = self._brakes(seen, now.me.length + now.other.length) if knows else Fraction(0)
        self._looks += knows
        if self._braking > 0 and self.onset is None:
            self.onset = now.time
        if self.onset is None:
            return
        if self._braking == 0 and self.phases and self.phases[-1][1:] == _EVEN:
            lasts = self.phases.pop()[0]
            assert lasts is not None
            self.phases.append((lasts + Fraction(1, HERTZ), *_EVEN))
        else:
            self.phases += step(self._braking)
        self._speed -= self._braking / HERTZ
        self._place += self._speed / HERTZ + self._braking / HERTZ * CHANGE / 2

    def finish(self, now: Sight) -> None:
        """Note in ``rest`` how it would lose the rest of its speed, if this look were the last."""
        scale, faster = self._scale, self._speed - now.its_speed
        gap = now.other.s + now.its_speed / HERTZ - now.other.length - self._place
        is_clear = self._controller.needs(scale.speed(_rounded(faster))) < min(
            scale.length(_rounded(gap)), self._controller.margin
        )
        self.rest = []
        if now.is_even and self.onset is not None and faster > 0 and is_clear:
            self.rest = [(faster / COMFORT, Fraction(-COMFORT), Fraction(0))]

    def _brakes(self, look: Look, lengths: Fraction) -> Fraction:
        """Return the braking (m/s²) that is held until the next look."""
        scale = self._scale
        units = self._controller.look(
            scale.length(_rounded(look.gap)),
            scale.length(_rounded(lengths)),
            scale.speed(_rounded(look.speed)),
            scale.speed(_rounded(look.other)),
            scale.length(_rounded(look.beside)),
            scale.speed(_rounded(look.lateral)),
        )
        return scale.to_acceleration(units)


def _rounded(value: Fraction) -> Fraction:
    return Fraction(round(value * _FINE), _FINE)
