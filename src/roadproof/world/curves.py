"""Curves in the plane by their length: line, arc, spiral, cubic, parametric cubic, polyline.

Each begins at (0, 0) with heading 0. Shapes and coefficients are those of ASAM OpenDRIVE 1.8, section 9. A
point on a cubic is found by arc length, so that the curve has the length that its file states. If a
parametric cubic is longer or shorter than that, all lengths along it are scaled.
"""

import math
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Literal, TypeAlias, assert_never

from roadproof.runtime.records import dataclass

Coefficients: TypeAlias = tuple[Fraction, Fraction, Fraction, Fraction]
Range: TypeAlias = tuple[float, float]
Order: TypeAlias = Literal[0, 1, 2]

_NODES = (
    (0.1834346424956498, 0.3626837833783620),
    (0.5255324099163290, 0.3137066458778873),
    (0.7966664774136267, 0.2223810344533745),
    (0.9602898564975363, 0.1012285362903763),
)
"""Gauss-Legendre quadrature with eight nodes: the positive ones and their weights."""
_TURN = 0.25
"""The largest turn, in radians, of the parts in which a spiral is integrated."""
_PARTS = 32
"""Parts of a cubic for its arc length and the bounds of its curvature."""
_ROUNDING = 1e-9
"""The share by which bounds of a curvature are widened, because floats are rounded."""


@dataclass(frozen=True)
class Pose:
    """A place (m) and the direction of a curve there (rad)."""

    x: float
    y: float
    heading: float


@dataclass(frozen=True)
class Bend:
    """Bounds of the curvature (1/m, positive to the left) on a part of a curve.

    At ``begin`` + t·(``end`` - ``begin``), 0 <= t <= 1, the curvature lies between two linear functions: one
    from ``low[0]`` to ``low[1]``, one from ``high[0]`` to ``high[1]``. ``begin`` and ``end`` in m.
    """

    begin: Fraction
    end: Fraction
    low: tuple[Fraction, Fraction]
    high: tuple[Fraction, Fraction]

    @property
    def greatest(self) -> Fraction:
        """The greatest absolute value of the bounds."""
        return max(abs(x) for x in (*self.low, *self.high))


@dataclass(frozen=True)
class Line:
    """A straight line."""

    def pose(self, s: float, _: Fraction) -> Pose:
        return Pose(s, 0.0, 0.0)

    def bends(self, length: Fraction) -> Iterator[Bend]:
        yield Bend(Fraction(0), length, *_exact(Fraction(0), Fraction(0)))


@dataclass(frozen=True)
class Spiral:
    """A clothoid: its curvature goes linearly from ``begin`` to ``end`` (1/m). Equal values make an arc."""

    begin: Fraction
    end: Fraction

    def pose(self, s: float, length: Fraction) -> Pose:
        """Return the pose ``s`` m along a spiral of ``length`` m, by numerical integration."""
        begin, growth = float(self.begin), float((self.end - self.begin) / length)

        def heading(u: float) -> float:
            return u * (begin + u * growth / 2)

        turning = abs(s) * max(abs(begin), abs(begin + growth * s))
        parts = 1 + int(turning / _TURN)
        x = sum(_integral(lambda u: math.cos(heading(u)), a, b) for a, b in _subdivide(s, parts))
        y = sum(_integral(lambda u: math.sin(heading(u)), a, b) for a, b in _subdivide(s, parts))
        return Pose(x, y, heading(s))

    def bends(self, length: Fraction) -> Iterator[Bend]:
        """Yield the curvature, which is known exactly."""
        yield Bend(Fraction(0), length, *_exact(self.begin, self.end))


@dataclass(frozen=True)
class Cubic:
    """(u(p), v(p)) for 0 <= p <= ``last``, each a + b·p + c·p² + d·p³; ``last`` None: up to the length."""

    u: Coefficients
    v: Coefficients
    last: Fraction | None

    def pose(self, s: float, length: Fraction) -> Pose:
        """Return the pose ``s`` m along a cubic of ``length`` m."""
        p = _parameter_at(self, length, s)
        du, dv = _value(self.u, p, 1), _value(self.v, p, 1)
        return Pose(_value(self.u, p), _value(self.v, p), math.atan2(dv, du))

    def bends(self, length: Fraction) -> Iterator[Bend]:
        """Yield constant bounds of the curvature for each of ``_PARTS`` parts."""
        parameters, lengths = _table(self, length)
        for (p, q), (a, b) in zip(pairwise(parameters), pairwise(lengths), strict=True):
            low, high = _curvature(self, (p, q))
            bounds = Fraction(low), Fraction(high)
            begin = Fraction(a) if a else Fraction(0)
            end = length if b == lengths[-1] else Fraction(b)
            yield Bend(begin, end, (bounds[0],) * 2, (bounds[1],) * 2)


@dataclass(frozen=True)
class Polyline:
    """Straight lines between points (m), the first at (0, 0); the direction changes linearly along each.

    The direction at a point is the mean of those before and after it. If the line is a sampled curve, it is
    at most h²·κ/8 from the curve, for points h apart.
    """

    points: tuple[tuple[Fraction, Fraction], ...]

    @cached_property
    def measured(self) -> tuple[Sequence[float], Sequence[float]]:
        """Lengths up to the points (m), and the directions there (rad), which do not jump by a full turn."""
        places, ways = [0.0], list[float]()
        for (x, y), (x1, y1) in pairwise(self.places):
            places.append(places[-1] + math.hypot(x1 - x, y1 - y))
            way = math.atan2(y1 - y, x1 - x)
            ways.append(way if not ways else ways[-1] + math.remainder(way - ways[-1], math.tau))
        middles = [(a + b) / 2 for a, b in pairwise(ways)]
        return places, [ways[0], *middles, ways[-1]]

    @cached_property
    def places(self) -> Sequence[tuple[float, float]]:
        """The points as floats."""
        return [(float(x), float(y)) for x, y in self.points]

    def pose(self, s: float, _: Fraction) -> Pose:
        """Return the pose ``s`` m along the line, extended straight beyond its ends."""
        places, headings = self.measured
        k = min(max(bisect_right(places, s) - 1, 0), len(places) - 2)
        share = (s - places[k]) / (places[k + 1] - places[k])
        (x, y), (x1, y1) = self.places[k : k + 2]
        turned = headings[k] + min(max(share, 0.0), 1.0) * (headings[k + 1] - headings[k])
        return Pose(x + share * (x1 - x), y + share * (y1 - y), turned)

    def bends(self, length: Fraction) -> Iterator[Bend]:
        """Yield the change of direction per metre for each of the straight lines."""
        places, headings = self.measured
        scale = float(length) / places[-1]
        for (a, b), (before, after) in zip(pairwise(places), pairwise(headings), strict=True):
            curvature = Fraction((after - before) / (b - a))
            end = length if b == places[-1] else Fraction(b * scale)
            yield Bend(Fraction(a * scale), end, *_exact(curvature, curvature))


Curve: TypeAlias = Line | Spiral | Cubic | Polyline


def length_of(line: Polyline) -> float:
    """Return the length of all straight lines together (m)."""
    return line.measured[0][-1]


def _exact(begin: Fraction, end: Fraction) -> tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]:
    """Return equal lower and upper bounds, for a curvature that is known."""
    return (begin, end), (begin, end)


def _subdivide(end: float, parts: int) -> Iterator[Range]:
    return pairwise([end * k / parts for k in range(parts + 1)])


def _integral(function: Callable[[float], float], begin: float, end: float) -> float:
    middle, half = (begin + end) / 2, (end - begin) / 2
    return half * sum(w * (function(middle - half * x) + function(middle + half * x)) for x, w in _NODES)


def _value(coefficients: Coefficients, p: float, order: Order = 0) -> float:
    """Return the value of a cubic, or of its first or second derivative."""
    a, b, c, d = map(float, coefficients)
    match order:
        case 0:
            return a + p * (b + p * (c + p * d))
        case 1:
            return b + p * (2 * c + 3 * p * d)
        case 2:
            return 2 * c + 6 * p * d
        case _:
            assert_never(order)


def _speed(curve: Cubic, p: float) -> float:
    return math.hypot(_value(curve.u, p, 1), _value(curve.v, p, 1))


@lru_cache(maxsize=4096)
def _table(curve: Cubic, length: Fraction) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return parameters, and the lengths (m) up to them, the last one ``length``."""
    total = float(length)
    last = _parameter_at_end(curve, total) if curve.last is None else float(curve.last)
    parameters = tuple(last * k / _PARTS for k in range(_PARTS + 1))
    lengths = [0.0]
    for p, q in pairwise(parameters):
        lengths.append(lengths[-1] + _integral(lambda x: _speed(curve, x), p, q))
    if lengths[-1] <= 0:
        raise ValueError("a cubic of length 0")
    return parameters, (*(x * total / lengths[-1] for x in lengths[:-1]), total)


def _parameter_at_end(curve: Cubic, length: float) -> float:
    """Return the parameter at which a graph v(u) is ``length`` m long, by bisection from 0 to ``length``."""
    low, high = 0.0, length
    for _ in range(60):
        middle = (low + high) / 2
        parts = _subdivide(middle, _PARTS)
        long = sum(_integral(lambda x: _speed(curve, x), p, q) for p, q in parts)
        low, high = (middle, high) if long < length else (low, middle)
    return (low + high) / 2


def _parameter_at(curve: Cubic, length: Fraction, s: float) -> float:
    """Return the parameter ``s`` m along the curve; beyond its ends the speed stays constant."""
    parameters, lengths = _table(curve, length)
    k = min(max(bisect_right(lengths, s) - 1, 0), _PARTS - 1)
    begin, end = parameters[k], parameters[k + 1]
    scale = (lengths[k + 1] - lengths[k]) / _integral(lambda x: _speed(curve, x), begin, end)
    p = begin + (end - begin) * (s - lengths[k]) / (lengths[k + 1] - lengths[k])
    for _ in range(4):
        far = lengths[k] + scale * _integral(lambda x: _speed(curve, x), begin, p) - s
        p -= far / (scale * _speed(curve, p))
    return p


def _curvature(curve: Cubic, part: Range) -> Range:
    """Return bounds of the curvature for parameters within ``part``, by interval arithmetic."""
    u1, v1 = (_bounds(x, part, 1) for x in (curve.u, curve.v))
    u2, v2 = (_bounds(x, part, 2) for x in (curve.u, curve.v))
    first, second = _times(u1, v2), _times(v1, u2)
    turning = first[0] - second[1], first[1] - second[0]
    slowest = math.hypot(*(max(low, -high, 0.0) for low, high in (u1, v1)))
    fastest = math.hypot(*(max(abs(low), abs(high)) for low, high in (u1, v1)))
    if slowest == 0:
        raise ValueError("a cubic that stands still")
    ends = [x / y**3 for x in turning for y in (slowest, fastest)]
    wider = _ROUNDING * max(map(abs, ends))
    return min(ends) - wider, max(ends) + wider


def _bounds(coefficients: Coefficients, part: Range, order: Order) -> Range:
    """Return the least and the greatest value of a derivative of a cubic, which is a parabola or a line."""
    _, _, c, d = map(float, coefficients)
    places = [*part]
    if order == 1 and d and part[0] < -c / (3 * d) < part[1]:
        places.append(-c / (3 * d))
    values = [_value(coefficients, p, order) for p in places]
    return min(values), max(values)


def _times(one: Range, other: Range) -> Range:
    products = [x * y for x in one for y in other]
    return min(products), max(products)
