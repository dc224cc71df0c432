"""The fuzzy safety model (UN R157, 01 series, Annex 3) as a controller that looks ten times a second.

Formulas: UN R157 Am.4, pp. 56-58. Constants, the clock, and what the regulation leaves open: the public
implementation of the Joint Research Centre, github.com/ec-jrc/JRC-FSM at commit 01b05c2, utility/vehicle.py
(FSM_*), utility/models.py (FSM_check_safety, FSM_react) and utility/fuzzy_functs.py (PFS, CFS).

Everything is in whole numbers: a ``Scale`` has so many units of length to a metre, and 1/20 s is the unit of
time, so that the reaction time of 0.75 s is one, too. What is divided is rounded to a millionth of 1 m/s²,
without which the digits of an exact drive would double at every look.
"""

from fractions import Fraction
from math import lcm

from roadproof.runtime.records import dataclass
from roadproof.world.drive import Along

HERTZ = 10
CHANGE = Fraction(1, 100_000)
"""Seconds in which the speed changes after a look.

The implementation moves at the new speed from the look on. A drive cannot jump, and is off by half of this
time multiplied by the speed that is lost: 0.15 mm at 108 km/h.
"""
ROUNDING = Fraction(1, 10**6)  # m/s²
TICKS = 2  # units of time from look to look
_SECOND = TICKS * HERTZ
_REACTION = 15  # 0.75 s
_WAITS = -(-_REACTION // TICKS)  # looks for which it sees danger before it brakes
COMFORT, _GREATEST, _OTHER = 4, 6, 7  # m/s²: of SV, of SV, of POV
_MARGIN = 2  # m, d_1
_JERK = Fraction("12.65")  # m/s³
_LATER = 2  # 0.1 s


@dataclass(frozen=True)
class Scale:
    """``metre``: units of length to a metre."""

    metre: int

    def length(self, metres: Fraction) -> int:
        """Raises ``ValueError`` for what the scale cannot say; so do the others."""
        return _whole(metres * self.metre)

    def speed(self, speed: Fraction) -> int:
        return _whole(speed * self.metre / _SECOND)

    def acceleration(self, acceleration: Fraction | int) -> int:
        return _whole(Fraction(acceleration) * self.metre / _SECOND**2)

    def to_acceleration(self, units: int) -> Fraction:
        """Return an acceleration in m/s²."""
        return Fraction(units * _SECOND**2, self.metre)


def scale_of(*values: Fraction) -> Scale:
    """The scale in which these values, SI units, are whole, and stay so."""
    whole = 2 * _SECOND**2 * ROUNDING.denominator * (CHANGE * _SECOND).denominator
    return Scale(whole * lcm(*(x.denominator for x in values)))


def moved(speed: int, braking: int) -> int:
    """Return how far SV goes from look to look, in units, where it brakes from ``speed`` by ``braking``."""
    return TICKS * (speed - TICKS * braking) + slip(braking)


def slip(braking: int) -> int:
    """Return how far SV goes beyond its new speed while its speed changes, in units."""
    part = CHANGE * _SECOND * TICKS * braking / 2
    assert part.denominator == 1
    return part.numerator


def step(braking: Fraction) -> list[Along]:
    """Return the motion from look to look with a braking in m/s²."""
    if braking == 0:
        return [(Fraction(1, HERTZ), Fraction(0), Fraction(0))]
    change = -braking / HERTZ / CHANGE
    return [(CHANGE, change, Fraction(0)), (Fraction(1, HERTZ) - CHANGE, Fraction(0), Fraction(0))]


def _whole(value: Fraction) -> int:
    if value.denominator != 1:
        raise ValueError(f"{value} is not whole in this scale")
    return value.numerator


class Controller:
    """The braking of SV from look to look. It remembers how long it has seen danger, and how it has braked.

    As in the implementation, neither is forgotten when danger is over. ``waits``: at the last look it saw
    danger, and its reaction time was not over.
    """

    def __init__(self, scale: Scale) -> None:
        self.comfort = scale.acceleration(COMFORT)
        self.greatest = scale.acceleration(_GREATEST)
        self.other = scale.acceleration(_OTHER)
        self.margin = _MARGIN * scale.metre
        self.step = scale.acceleration(_JERK / HERTZ)
        self.rounding = scale.acceleration(ROUNDING)
        self.waited = 0
        self.asked = 0
        self.held = 0
        self.waits = False

    def look(self, gap: int, lengths: int, speed: int, other: int, beside: int, lateral: int) -> int:
        """The braking (>= 0) that is held until the next look.

        ``gap``: from SV's front to the rear of the other; ``lengths``: of both; ``speed``, ``other``: along
        the road; ``beside``: between them across it (<= 0: side by side); ``lateral``: how fast that shrinks.
        """
        self.waits = False
        if 2 * gap + lengths < 0 or _goes_by(gap + lengths, speed - other, beside, lateral):
            self.held = 0
            return 0
        critical = self._critical(gap, speed - other)
        proactive = self._proactive(gap, speed, other)
        required = proactive if critical is None else critical
        self.waits = required is not None and self.waited < _WAITS
        self.waited += self.waits
        if required is None or self.waits:
            self.held = 0
        else:
            self.asked = min(self.asked + self.step, required)
            # Half of the speed in a unit of time, over two of them, is a stand.
            self.held = min(self.asked, speed // TICKS)
        return self.held

    def far(self, speed: int, other: int) -> int:
        """Up to which gap SV, which does not brake, may begin to wait or to brake at these speeds."""
        product, faster = 2 * self.comfort * self.greatest * self.other, speed - other
        near, whole = self._room(0, speed, other)
        if self.waited == _WAITS and not self.asked:  # a braking that is rounded to nothing changes nothing
            near -= self.rounding * whole // (2 * self.comfort)
        closing = _REACTION * faster + faster * faster // (2 * self.comfort) + 1
        return max(near // product + 1, closing)

    def needs(self, faster: int) -> int:
        """Return the gap in which SV loses that speed with comfortable braking, rounded up.

        It may have to go on to the next look, to wait, to raise its braking from none look by look, and to
        brake by less in the look in which it comes to a stand.
        """
        if faster <= 0:
            return 0
        looks = 1 + _WAITS - self.waited - (-self.comfort // self.step)
        return TICKS * looks * faster - (-faster * faster // (2 * self.comfort))

    def _proactive(self, gap: int, speed: int, other: int) -> int | None:
        """The braking for PFS > 0."""
        near, whole = self._room(gap, speed, other)
        return None if near <= 0 else self._rounded(self.comfort * min(near, whole), whole)

    def _room(self, gap: int, speed: int, other: int) -> tuple[int, int]:
        """Return how far the gap is from safe, and how far unsafe is; over a common divisor."""
        b, full, c = self.comfort, self.greatest, self.other
        safe = 2 * b * full * c * (speed * _REACTION + 2 * self.margin - gap)
        near = safe + speed * speed * full * c - other * other * b * full
        return near, 2 * b * full * c * self.margin + speed * speed * c * (full - b)

    def _critical(self, gap: int, faster: int) -> int | None:
        """The braking for CFS > 0."""
        if faster <= 0:
            return None
        b, full = self.comfort, self.greatest
        later = faster - min(self.held, b) * _REACTION
        if later <= 0:
            return full if 2 * self.held * gap < faster * faster else None
        near = b * full * ((faster + later) * _REACTION - 2 * gap) + later * later * full
        whole = later * later * (full - b)
        return None if near <= 0 else b + self._rounded((full - b) * min(near, whole), whole)

    def _rounded(self, part: int, whole: int) -> int:
        """``part / whole``, to the nearest multiple of the rounding, halves up."""
        unit = self.rounding
        return (2 * part + unit * whole) // (2 * unit * whole) * unit


def _goes_by(clear: int, faster: int, beside: int, lateral: int) -> bool:
    """Return whether SV is past for 0.1 s when POV would be beside it; ``clear``: the way it has to go."""
    if beside <= 0:
        return False
    if lateral <= 0:
        return True
    # Multiplied by the difference of the speeds, which may be negative; at equal speeds it never goes by.
    slack = beside * faster - lateral * (clear + _LATER * faster)
    return slack > 0 if faster > 0 else slack < 0 and faster < 0
