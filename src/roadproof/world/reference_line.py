"""The reference line of a road in the plane, in which s is measured: curves, one after the other.

A place (s, d) of the road is d to the left of the line at s, at a right angle to it (ASAM OpenDRIVE 1.8,
section 8.3). Before its beginning and after its end the line goes straight on.
"""

import math
from bisect import bisect_right
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property

from roadproof.runtime.records import dataclass
from roadproof.world.curves import Bend, Curve, Pose

_SPACING = 5.0
"""Metres between the points from which the nearest place of a line is looked for."""
_STEPS, _STEP, _NEAR, _SLOWEST = 50, 1e-4, 1e-10, 0.05
"""Newton's method: most steps, the step of its derivative and the last step (m), the least derivative."""


@dataclass(frozen=True)
class Part:
    """A curve of ``length`` m from (``x``, ``y``) on, with ``heading`` (rad) there; ``s``: where it is (m).

    ``backward``: the line goes from the end of the curve to its beginning. ``offset``: it is so far (m) to
    the left of the curve, seen along the line.
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
        """The line at ``s``."""
        begin, length, x, y, heading, aside = self._rounded
        u = s - begin
        local = self.curve.pose(length - u if self.backward else u, self.length)
        turn = math.cos(heading), math.sin(heading)
        x += local.x * turn[0] - local.y * turn[1]
        y += local.x * turn[1] + local.y * turn[0]
        heading += local.heading + (math.pi if self.backward else 0.0)
        return Pose(x - aside * math.sin(heading), y + aside * math.cos(heading), heading)

    @cached_property
    def _rounded(self) -> tuple[float, float, float, float, float, float]:
        """``s``, ``length``, ``x``, ``y``, ``heading`` and ``offset``, to be computed once."""
        s, length, x, y, heading, offset = map(
            float, (self.s, self.length, self.x, self.y, self.heading, self.offset)
        )
        return s, length, x, y, heading, offset

    def bends(self) -> Iterator[Bend]:
        """Bounds of the curvature of the curve, by s and seen along the line."""
        for x in self.curve.bends(self.length):
            if not self.backward:
                yield Bend(self.s + x.begin, self.s + x.end, *self._aside(x.low, x.high))
                continue
            low, high = (tuple(-y for y in reversed(z)) for z in (x.high, x.low))
            ends = self.end - x.end, self.end - x.begin
            yield Bend(*ends, *self._aside((low[0], low[1]), (high[0], high[1])))

    def _aside(
        self, low: tuple[Fraction, Fraction], high: tuple[Fraction, Fraction]
    ) -> tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]:
        """Bounds for the line beside the curve: κ/(1 - κ·offset), which grows with κ."""
        if not self.offset:
            return low, high
        least, most = (x / (1 - x * self.offset) for x in (min(low), max(high)))
        return (least, least), (most, most)


@dataclass(frozen=True)
class ReferenceLine:
    """``parts`` follow each other in s."""

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
        """The place of the line at ``s`` (m) and its direction."""
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
        """s where each part begins, and where the last one ends."""
        return [float(x.s) for x in self.parts], float(self.end)

    def curvature_rate(self, s: float) -> float:
        """The change of curvature per metre at ``s`` (1/m²), by its bounds; 0 beyond the ends."""
        k = bisect_right(self._bends, s, key=lambda x: float(x.begin)) - 1
        if k < 0 or self._bends[k].end <= s:
            return 0.0
        bend = self._bends[k]
        change = sum(bend.low[1:] + bend.high[1:]) - sum(bend.low[:1] + bend.high[:1])
        return float(change / 2 / (bend.end - bend.begin))

    def place(self, s: float, d: float) -> tuple[float, float]:
        """Where (s, d) is in the plane (m)."""
        pose = self.pose(s)
        return pose.x - d * math.sin(pose.heading), pose.y + d * math.cos(pose.heading)

    def locate(self, x: float, y: float, near: float | None = None) -> tuple[float, float]:
        """s and d of a point of the plane (m): those of the nearest place of the line.

        ``near``: s of a place some metres from it, if it is known.
        """
        s = near
        if s is None:
            s = min(self.samples, key=lambda known: math.hypot(known[1] - x, known[2] - y))[0]
        for _ in range(_STEPS):
            along = self._seen(s, x, y)[0]
            ahead = self._seen(s + _STEP, x, y)[0]
            rate = (along - ahead) / _STEP
            move = along / rate if rate > _SLOWEST else along
            s += min(max(move, -_SPACING), _SPACING)
            if abs(move) < _NEAR:
                break
        return s, self._seen(s, x, y)[1]

    def _seen(self, s: float, x: float, y: float) -> tuple[float, float]:
        """How far a point is ahead and to the left of the line at ``s`` (m)."""
        pose = self.pose(s)
        cos, sin = math.cos(pose.heading), math.sin(pose.heading)
        x, y = x - pose.x, y - pose.y
        return x * cos + y * sin, y * cos - x * sin

    @cached_property
    def samples(self) -> list[tuple[float, float, float]]:
        """s and places of points ``_SPACING`` m from each other or less."""
        begin, end = float(self.begin), float(self.end)
        count = max(math.ceil((end - begin) / _SPACING), 1)
        places = (begin + (end - begin) * k / count for k in range(count + 1))
        return [(s, pose.x, pose.y) for s, pose in ((s, self.pose(s)) for s in places)]

    def bends(self) -> tuple[Bend, ...]:
        """Bounds of the curvature, in the order of s."""
        return self._bends

    @cached_property
    def _bends(self) -> tuple[Bend, ...]:
        return tuple(x for part in self.parts for x in sorted(part.bends(), key=lambda bend: bend.begin))
