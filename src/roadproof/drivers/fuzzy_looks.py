"""What the fuzzy safety model sees in a test, look by look, rounded to what it computes with."""

from fractions import Fraction

from roadproof.drivers.fuzzy import Controller, scale_of
from roadproof.drivers.lanes import Box
from roadproof.runtime.records import dataclass

_FINE = 10**6


@dataclass(frozen=True)
class Look:
    """What SV sees at a look.

    The gap along the road (m), both speeds (m/s), the distance across (m), and how fast that shrinks (m/s).
    """

    gap: Fraction
    speed: Fraction
    other: Fraction
    beside: Fraction
    lateral: Fraction

    @staticmethod
    def of(
        me: Box, other: Box, speed: Fraction, its_speed: Fraction, drift: Fraction, its_drift: Fraction
    ) -> "Look":
        """Return what SV sees of the other vehicle; ``drift``: speeds across the road, to the left."""
        is_left = other.middle >= me.middle
        apart = other.d - other.width - me.d if is_left else me.d - me.width - other.d
        shrinks = drift - its_drift if is_left else its_drift - drift
        return Look(other.s - other.length - me.s, speed, its_speed, apart, shrinks)


class Looks:
    """The controller in a test. Its memory goes on from look to look."""

    def __init__(self, lengths: Fraction) -> None:
        self._scale = scale_of(Fraction(1, _FINE))
        self._controller = Controller(self._scale)
        self._lengths = self._scale.length(_rounded(lengths))

    def braking(self, look: Look) -> Fraction:
        """Return the braking (m/s²) that is held until the next look."""
        scale = self._scale
        units = self._controller.look(
            scale.length(_rounded(look.gap)),
            self._lengths,
            scale.speed(_rounded(look.speed)),
            scale.speed(_rounded(look.other)),
            scale.length(_rounded(look.beside)),
            scale.speed(_rounded(look.lateral)),
        )
        return scale.to_acceleration(units)


def _rounded(value: Fraction) -> Fraction:
    return Fraction(round(value * _FINE), _FINE)
