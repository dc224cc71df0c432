"""The reference line of a road in the plane, along which s is measured: a sequence of curves.

A place (s, d) of the road is d to the left of the line at s, at a right angle to it (ASAM OpenDRIVE 1.8,
section 8.3). Before its beginning and after its end the line is extended straight.
"""

import math
from bisect import bisect_right
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property

from roadproof.runtime.records import dataclass
from roadproof.world.curves import Bend, Curve, Pose

_SPACING = 5.0
"""Metres between the points among which the nearest place of a line is searched first."""
_STEPS, _STEP, _NEAR, _SLOWEST = 50, 1e-4, 1e-10, 0.05
"""Newton's method: most steps, the step of its derivative and the last step (m), the least derivative."""


@dataclass(frozen=True)
class Part:
    """A curve of ``length`` m that starts at (``x``, ``y``) with ``heading`` (rad); ``s``: where it is (m).

    ``backward``: the line runs from the end of the curve to its beginning. ``offset``: the distance (m) of
    the line to the left of the curve, seen along the line.
    """

    s: Fraction
    length: Fraction
    x: Fraction
    y: Fraction
    heading: Fraction
    curve: Curve
    backward: bool = False
    offset: Fraction = Fraction(0)

    @property
    def end(self) -> Fraction:
        return self.s + self.length

    def pose(self, s: float) -> Pose:
        """Return place and direction of the line at ``s``."""
        begin, length, x, y, heading, aside = self._floats
        u = s - begin
        local = self.curve.pose(length - u if self.backward else u, self.length)
        turn = math.cos(heading), math.sin(heading)
        x += local.x * turn[0] - local.y * turn[1]
        y += local.x * turn[1] + local.y * turn[0]
        heading += local.heading + (math.pi if self.backward else 0.0)
        return Pose(x - aside * math.sin(heading), y + aside * math.cos(heading), heading)

    @cached_property
    def _floats(self) -> tuple[float, float, float, float, float, float]:
        """``s``, ``length``, ``x``, ``y``, ``heading`` and ``offset`` as floats, computed once."""
        s, length, x, y, heading, offset = map(
            float, (self.s, self.length, self.x, self.y, self.heading, self.offset)
        )
        return s, length, x, y, heading, offset

    def bends(self) -> Iterator[Bend]:
        """Yield bounds of the curvature of the line, by s."""
        for x in self.curve.bends(self.length):
            if not self.backward:
                yield Bend(self.s + x.begin, self.s + x.end, *self._with_offset(x.low, x.high))
                continue
            low, high = (tuple(-y for y in reversed(z)) for z in (x.high, x.low))
            ends = self.end - x.end, self.end - x.begin
            yield Bend(*ends, *self._with_offset((low[0], low[1]), (high[0], high[1])))

    def _with_offset(
        self, low: tuple[Fraction, Fraction], high: tuple[Fraction, Fraction]
    ) -> tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]:
        """Return the bounds for the line beside the curve: κ/(1 - κ·offset), which grows with κ."""
        if not self.offset:
            return low, high
        least, most = (x / (1 - x * self.offset) for x in (min(low), max(high)))
        return (least, least), (most, most)


@dataclass(frozen=True)
class ReferenceLine:
    """A sequence of ``parts``, each beginning in s where the one before ends."""

    parts: tuple[Part, ...]

    def __post_init__(self) -> None:
        if not self.parts:
            raise ValueError("a reference line needs a part")

    @property
    def begin(self) -> Fraction:
        return self.parts[0].s

    @property
    def end(self) -> Fraction:
        return self.parts[-1].end

    def pose(self, s: float) -> Pose:
        """Return the place of the line at ``s`` (m) and its direction."""
        begins, end = self._places
        inside = min(max(s, begins[0]), end)
        k = bisect_right(begins, inside) - 1
        pose = self.parts[max(k, 0)].pose(inside)
        beyond = s - inside
        return Pose(
            pose.x + beyond * math.cos(pose.heading), pose.y + beyond * math.sin(pose.heading), pose.heading
        )

    @cached_property
    def _places(self) -> tuple[list[float], float]:
        """The s at which each part begins, and at which the last one ends."""
        return [float(x.s) for x in self.parts], float(self.end)

    def curvature_rate(self, s: float) -> float:
        """Return the change of curvature per metre at ``s`` (1/m²), from its bounds; 0 beyond the ends."""
        k = bisect_right(self._bends, s, key=lambda x: float(x.begin)) - 1
        if k < 0 or self._bends[k].end <= s:
            return 0.0
        bend = self._bends[k]
        change = sum(bend.low[1:] + bend.high[1:]) - sum(bend.low[:1] + bend.high[:1])
        return float(change / 2 / (bend.end - bend.begin))

    def place(self, s: float, d: float) -> tuple[float, float]:
        """Return the point (s, d) in coordinates of the plane (m)."""
        pose = self.pose(s)
        return pose.x - d * math.sin(pose.heading), pose.y + d * math.cos(pose.heading)

    def locate(self, x: float, y: float, near: float | None = None) -> tuple[float, float]:
        """Return s and d of a point of the plane (m), by Newton's method for the nearest place of the line.

        ``near``: s of a place some metres away, if one is known.
        """
        s = near
        if s is None:
            s = min(self.samples, key=lambda known: math.hypot(known[1] - x, known[2] - y))[0]
        for _ in range(_STEPS):
            along = self._offset_at(s, x, y)[0]
            ahead = self._offset_at(s + _STEP, x, y)[0]
            rate = (along - ahead) / _STEP
            move = along / rate if rate > _SLOWEST else along
            s += min(max(move, -_SPACING), _SPACING)
            if abs(move) < _NEAR:
                break
        return s, self._offset_at(s, x, y)[1]

    def _offset_at(self, s: float, x: float, y: float) -> tuple[float, float]:
        """Return how far a point is ahead and to the left of the line at ``s`` (m)."""
        pose = self.pose(s)
        cos, sin = math.cos(pose.heading), math.sin(pose.heading)
        x, y = x - pose.x, y - pose.y
        return x * cos + y * sin, y * cos - x * sin

    @cached_property
    def samples(self) -> list[tuple[float, float, float]]:
        """The s, x and y of points that are at most ``_SPACING`` m apart."""
        begin, end = float(self.begin), float(self.end)
        count = max(math.ceil((end - begin) / _SPACING), 1)
        places = (begin + (end - begin) * k / count for k in range(count + 1))
        return [(s, pose.x, pose.y) for s, pose in ((s, self.pose(s)) for s in places)]

    def bends(self) -> tuple[Bend, ...]:
        """Return bounds of the curvature, in the order of s."""
        return self._bends

    @cached_property
    def _bends(self) -> tuple[Bend, ...]:
        return tuple(x for part in self.parts for x in sorted(part.bends(), key=lambda bend: bend.begin))
