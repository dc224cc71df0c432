"""The projection from (s, d) of a road with bends to a picture, which all pictures use.

A view looks at the road from above, so that its direction at one place is to the right. Boxes are in m:
s from ``origin``, and d. Vehicles are rectangles in the direction of the road at their centre.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from typing import TypeAlias

from roadproof.extensions.pages.drive_data import Box, Span, road_in
from roadproof.runtime.records import dataclass
from roadproof.world.curves import Pose
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Road

Point: TypeAlias = tuple[float, float]
Points: TypeAlias = Sequence[Point]
STEP = 2.0
"""Metres between the points of an edge, at most."""


@dataclass(frozen=True)
class RoadView:
    """The plane in m from the place (``s``, ``d``) of a road; x along the road there, y to its left."""

    line: ReferenceLine
    origin: float
    s: float
    d: float

    @cached_property
    def pose(self) -> Pose:
        """The place in the plane from which is looked, and the direction of the road there."""
        here = self.line.pose(self.origin + self.s)
        x, y = self.line.place(self.origin + self.s, self.d)
        return Pose(x, y, here.heading)

    def seen(self, x: float, y: float) -> Point:
        """A point of the plane."""
        cos, sin = math.cos(self.pose.heading), math.sin(self.pose.heading)
        x, y = x - self.pose.x, y - self.pose.y
        return x * cos + y * sin, y * cos - x * sin

    def at(self, s: float, d: float) -> Point:
        """A place of the road."""
        return self.seen(*self.line.place(self.origin + s, d))

    def turned(self, s: float) -> float:
        """The direction of the road at ``s``, in rad to the left of that of the view."""
        return self.line.pose(self.origin + s).heading - self.pose.heading

    def edge(self, begin: float, end: float, d: float, parts: int | None = None) -> list[Point]:
        """The way from ``begin`` to ``end`` at ``d``, in so many ``parts``, or such that are short."""
        count = parts or max(math.ceil(abs(end - begin) / STEP), 1)
        return [self.at(begin + (end - begin) * k / count, d) for k in range(count + 1)]

    def outline(self, box: Box, parts: int | None = None) -> list[Point]:
        """The edge of an area between two places and two offsets, which follows the road."""
        begin, end, right, left = box
        return [*self.edge(begin, end, left, parts), *self.edge(end, begin, right, parts)]

    def vehicle(self, box: Box) -> list[Point]:
        """The corners of a vehicle: rear right, front right, front left, rear left."""
        begin, end, right, left = box
        x, y = self.at((begin + end) / 2, (right + left) / 2)
        ahead, aside = (end - begin) / 2, (left - right) / 2
        turned = self.turned((begin + end) / 2)
        cos, sin = math.cos(turned), math.sin(turned)
        corners = ((-ahead, -aside), (ahead, -aside), (ahead, aside), (-ahead, aside))
        return [(x + a * cos - b * sin, y + a * sin + b * cos) for a, b in corners]

    def dashes(self, begin: float, end: float, d: float, dash: Span) -> Iterator[list[Point]]:
        """The strokes of a broken line; ``dash``: metres of paint and of a gap."""
        place = begin
        while place < end:
            yield self.edge(place, min(place + dash[0], end), d)
            place += sum(dash)


def views_along(road: Road, origins: Iterable[Fraction], window: Span) -> list[RoadView]:
    """Views from the middle of a ``window`` around each of some places; none where the road is straight."""
    if road.line is None:
        return []
    middle = sum(window) / 2, sum(road_in(road, Fraction(0), window).across) / 2
    return [RoadView(road.line, float(origin), *middle) for origin in origins]


def extent_of(views: Iterable[RoadView], window: Span, across: Span) -> Box:
    """Return the box (m) of the road's part in a window, as some views see it."""
    box = (*window, *across)
    return extent(point for view in views for point in view.outline(box))


def extent(points: Iterable[Point]) -> Box:
    """Left, right, bottom and top of points."""
    xs, ys = zip(*points, strict=True)
    return min(xs), max(xs), min(ys), max(ys)
