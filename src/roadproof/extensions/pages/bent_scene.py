"""Animations of drives on roads with bends: the shapes of ``scene`` as polygons, to scale.

The view moves and turns with the subject: the road at the middle of the window is always level.
"""

import math
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages import drive_data as data
from roadproof.extensions.pages.plane import Point, Points, RoadView, extent, extent_of, views_along
from roadproof.extensions.pages.scene import (
    DASH,
    EDGE,
    LANE_PIXELS,
    WIDTH,
    AnimationScene,
    Pavement,
    PavementShift,
)
from roadproof.extensions.pages.shapes import PolygonShape, Shape, StrokesShape
from roadproof.frontends.report.colours import SHADES
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass

HIGHEST = 0.5
"""The largest height of the road in the picture, as a share of its width."""
EVERY, PARTS = 5, 16
"""The step between views from which the scale is chosen, in instants; the number of parts of a
moving edge.
"""


def scene_of(
    file: DriveFile,
    library: Library,
    width: float = WIDTH,
    edge: float = EDGE,
    above: float | None = None,
    lane_pixels: float = LANE_PIXELS,
    grain: Fraction = data.GRAIN,
) -> AnimationScene:
    """Return the scene of a drive, on a straight road or on one with bends."""
    kind = AnimationScene if file.road.line is None else BentScene
    return kind(file, library, width, edge, above, lane_pixels, grain)


@dataclass(frozen=True)
class BentScene(AnimationScene):
    """A drive on a road with bends; ``scale`` is the same along and across."""

    @cached_property
    def views(self) -> list[RoadView]:
        """The view at each instant, from the middle of the window."""
        return views_along(self.file.road, (x.s for x in self.states[self.subject]), self.window)

    @cached_property
    def extent(self) -> data.Box:
        """The extent of the road within the window in the plane (m), as some of the views see it."""
        return extent_of([*self.views[::EVERY], self.views[-1]], self.window, self.across)

    @cached_property
    def scale(self) -> tuple[float, float]:
        left, right, bottom, top = self.extent
        wide, high = self.width - 2 * self.edge, HIGHEST * self.width
        pixels = min(wide / (right - left), high / (top - bottom))
        return pixels, pixels

    @property
    def road_height(self) -> float:
        return (self.extent[3] - self.extent[2]) * self.scale[1]

    @cached_property
    def road(self) -> data.ShownRoad:
        """The road as far as the corners of the picture may reach."""
        low, high = self.window
        more = (high - low) / 2
        seen = low + min(self.travel) - more, high + max(self.travel) + more
        return data.road_in(self.file.road, self.states[self.subject][0].s, seen)

    def place(self, point: Point) -> Point:
        """Return a point of a view in px."""
        left, right, _, top = self.extent
        x, y = point
        return self.width / 2 + (x - (left + right) / 2) * self.scale[0], self.top + (top - y) * self.scale[1]

    def places(self, points: Points) -> Points:
        """Return points of a view in px."""
        return [self.place(x) for x in points]

    def pavement(self) -> Pavement:
        """Return the lanes as the first view sees them, and how they shift and turn at each instant."""
        first, shapes = self.views[0], list[Shape]()
        for zone, along, (right, left) in self.road.pieces:
            shapes.append(PolygonShape([self.places(first.outline((*along, right, left)))], SHADES[zone]))
            for d in (left, right):
                inner = self.across[0] < d < self.across[1]
                lines = first.dashes(*along, d, DASH) if inner else [first.edge(*along, d)]
                shapes.append(StrokesShape([self.places(x) for x in lines], "#888888"))
        window = self.edge, self.top, self.width - 2 * self.edge, self.road_height
        return Pavement(window, shapes, tuple(self._shifts()), self.place((0.0, 0.0)))

    def _shifts(self) -> Iterator[PavementShift]:
        first = before = self.views[0]
        turned = 0.0
        for view in self.views:
            x, y = first.seen(view.pose.x, view.pose.y)
            turned += math.remainder(view.pose.heading - before.pose.heading, math.tau)
            before = view
            yield PavementShift(-x * self.scale[0], y * self.scale[1], math.degrees(turned))

    def areas(self) -> Iterator[Shape]:
        """Yield the area within RSS distances of SV, for each other vehicle; red while that
        vehicle is in it.
        """
        for x in self.envelopes:
            seen = zip(self.views, x.boxes, strict=True)
            outlines = [self.places(view.outline(box, PARTS)) for view, box in seen]
            yield PolygonShape(outlines, self.colours[x.other], 0.2, x.near)

    def vehicles(self) -> Iterator[Shape]:
        """Yield the vehicles in the direction of the road, then their names inside or beside them."""
        for name, colour in self.colours.items():
            yield PolygonShape([*self.outlines(name)], colour)
        yield from self.names()

    def outlines(self, name: str) -> Iterator[Points]:
        """Yield the corners of a vehicle at each instant in px."""
        for k, view in enumerate(self.views):
            yield self.places(view.vehicle(self.box(name, k)))

    def tracks(self, least: float = 0.0) -> dict[str, list[data.Box]]:
        return {name: [_at_least(extent(x), least) for x in self.outlines(name)] for name in self.states}


def _at_least(box: data.Box, least: float) -> data.Box:
    """Return a box that is longer at both ends, if it is shorter than ``least`` px."""
    more = max(0.0, least - (box[1] - box[0])) / 2
    return box[0] - more, box[1] + more, box[2], box[3]
