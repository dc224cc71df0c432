"""A deceleration in which POV's braking grows at a finite rate: the gap that SV needs, exactly.

POV's final braking and its rate are no part of a state, so there is no formula about the first instant. What
SV gains does not depend on the gap: so the collision is unpreventable up to the most that SV ever gains. That
is worked out here from the motion: a fraction, or a root of a quadratic polynomial.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import cmp_to_key
from itertools import pairwise

from roadproof.errors import UsageError
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import motion_under
from roadproof.extensions.drivers.manoeuvres import Deceleration, Plane, Values, is_possible, start_of
from roadproof.extensions.drivers.models import driver_model, law_of
from roadproof.semantics.exact.algebraic import Point, Root, compare, real_roots
from roadproof.semantics.exact.polynomial import polynomial
from roadproof.semantics.exact.truth import NEVER, TruthSet, intersection, interval
from roadproof.world.drive import Along

RATE = "dGdt"
"""The initial value that asks for it."""
TOLD = (
    "the ends are worked out from the motion, exactly; with a finite dGdt there is no formula of the state "
    "and no lemma, and the drives say what POV and SV do"
)

_NONE = Fraction(0)
# Coefficients, lowest power first.
_Coefficients = list[Fraction]


def check_gradual(model: str, values: Values, settings: DriverSettings) -> None:
    """Check that a model and its speed are supported with a finite rate. Raises ``UsageError``."""
    law = driver_model(model).law
    if law is None:
        raise UsageError(f"model={model} does not support a finite {RATE}; omit one of the two")
    ramp = settings.values.get(law.ramp, _NONE)
    least = settings.values[law.braking] * ramp / 2
    speed = values.get("Ve0", _NONE)
    if speed < least:
        raise UsageError(
            f"Ve0={float(speed):g} m/s with {RATE}: SV would stop before it brakes fully, which is "
            f"not supported; use Ve0 of at least {law.braking}*{law.ramp}/2 = {float(least):g} m/s, or omit "
            f"{RATE}"
        )


def line(plane: Plane, model: str, reading: DriverSettings, row: Fraction) -> TruthSet:
    """Return the gaps on a row's line with an unpreventable collision; none where POV would reverse."""
    values = plane.values(row)
    if not is_possible(values):
        return NEVER
    start = start_of(plane.manoeuvre, values)
    assert isinstance(start, Deceleration)
    motion = motion_under(law_of(model), plane.manoeuvre.name, start, reading)
    if not motion and start.Ve0 > 0:
        return interval(*plane.along)
    most = most_gained(motion, start)
    if compare(most, _NONE) <= 0:
        return NEVER
    return intersection([interval(_NONE, most, "[)"), interval(*plane.along)])


def most_gained(motion: Sequence[Along], start: Deceleration) -> Point:
    """The most that SV, which moves so until it stands, ever gains on POV (m)."""
    speed, rate, braking = start.Ve0, start.dGdt, start.Gx
    assert rate is not None
    other = speed - start.dV0
    full = braking / rate
    slow = other - rate * full**2 / 2  # how fast POV is once it brakes fully
    way: Point
    if slow > 0:
        stands: Point = full + slow / braking
        way = other * full - rate * full**3 / 6 + slow**2 / (2 * braking)
    else:
        stands = _upper(-2 * other, _NONE, rate)
        way = _upper(-8 * other**3, _NONE, 9 * rate)
    gains: list[Point] = [_NONE]
    place, time = _NONE, _NONE
    for duration, acceleration, jerk in motion:
        end = time + duration
        cuts = sorted({time, end, *([full] if time < full < end else [])})
        for low, high in pairwise(cuts):
            mine = _moved([place, speed, acceleration / 2, jerk / 6], time)
            ahead = [_NONE, other, _NONE, -rate / 6]
            if low >= full:
                gone = other * full - rate * full**3 / 6
                ahead = _moved([gone, slow, -braking / 2, _NONE], full)
            gains += _turns([x - y for x, y in zip(mine, ahead, strict=True)], low, high, stands)
        place += speed * duration + acceleration * duration**2 / 2 + jerk * duration**3 / 6
        speed += acceleration * duration + jerk * duration**2 / 2
        time = end
    if compare(stands, time) <= 0:
        gains.append(_less(place, way))
    return max(gains, key=cmp_to_key(compare))


def _moved(coefficients: _Coefficients, by: Fraction) -> _Coefficients:
    """The cubic polynomial of t - ``by``, as one of t."""
    a, b, c, d = coefficients
    return [a - b * by + c * by**2 - d * by**3, b - 2 * c * by + 3 * d * by**2, c - 3 * d * by, d]


def _turns(gain: _Coefficients, low: Fraction, high: Fraction, stands: Point) -> list[Point]:
    """Return the values of a cubic gain at its extremes in [low, high] while POV moves."""
    _, b, c, d = gain
    slope = polynomial(b, 2 * c, 3 * d)
    return [
        _value(gain, turn, k == 0)
        for k, (turn, _) in enumerate(real_roots(slope.numerators))
        if compare(low, turn) <= 0 and compare(turn, high) <= 0 and compare(turn, stands) < 0
    ]


def _value(gain: _Coefficients, turn: Point, is_lower: bool) -> Point:
    """A cubic at a fraction, or at the lower or upper root of a quadratic polynomial."""
    a, b, c, d = gain
    if not isinstance(turn, Root):
        return a + b * turn + c * turn**2 + d * turn**3
    e, f, g = (Fraction(x) for x in turn.polynomial)
    p, q = -f / g, -e / g  # t² = p·t + q, so t³ = (p² + q)·t + p·q
    constant, linear = a + c * q + d * p * q, b + c * p + d * (p**2 + q)
    if linear == 0:
        return constant
    # y = constant + linear·t
    coefficients = (g * constant**2 - f * linear * constant + e * linear**2, f * linear - 2 * g * constant, g)
    lower, upper = (x for x, _ in real_roots(polynomial(*coefficients).numerators))
    return lower if is_lower == (linear > 0) else upper


def _less(place: Fraction, way: Point) -> Point:
    """``place - way``, where ``way`` is a fraction or the root of a rational number."""
    if not isinstance(way, Root):
        return place - way
    e, _, g = (Fraction(x) for x in way.polynomial)
    return real_roots(polynomial(g * place**2 + e, -2 * g * place, g).numerators)[0][0]


def _upper(*coefficients: Fraction) -> Point:
    return real_roots(polynomial(*coefficients).numerators)[-1][0]
