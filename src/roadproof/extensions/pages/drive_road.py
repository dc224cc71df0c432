"""The road from above at some instants of a drive, all to one scale, driving direction to the right."""

import math
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages import drive_data as data
from roadproof.extensions.pages.drive_axes import (
    DARK,
    EDGE,
    GREY,
    MOST_TICKS,
    PLOT,
    SMALL,
    Block,
    LegendEntry,
    legend,
    ticks_in,
)
from roadproof.extensions.pages.labels import place_labels
from roadproof.extensions.pages.letters import width_of
from roadproof.extensions.pages.plane import Point, Points, RoadView, extent, extent_of, views_along
from roadproof.extensions.pages.shapes import (
    LineShape,
    PolygonShape,
    RectangleShape,
    Shape,
    StrokesShape,
    TextShape,
)
from roadproof.frontends.report.colours import SHADES, ZONES
from roadproof.runtime.records import dataclass
from roadproof.world.motion import state_at

SNAPSHOTS = 5
LANE_PIXELS, HIGHEST = 7.0, 240.0
"""The px of a metre across a straight road, at least; of the height of a road with bends, at most."""
_BETWEEN, _LINE, _NAMES = 9.0, "#888888", 12


@dataclass(frozen=True)
class Snapshots:
    """The road around the vehicles of a drive at some instants; ``colours``: by vehicle, SV first."""

    file: DriveFile
    colours: Mapping[str, str]

    @cached_property
    def times(self) -> list[Fraction]:
        """The instants, in s."""
        return [self.file.horizon * k / (SNAPSHOTS - 1) for k in range(SNAPSHOTS)]

    @cached_property
    def origins(self) -> list[Fraction]:
        """The place of the first vehicle's front at each instant, in m along the road."""
        subject = self.file.drive.vehicles[next(iter(self.colours))]
        return [state_at(subject, time).s for time in self.times]

    @cached_property
    def window(self) -> data.Span:
        """The visible span along the road, in m from the first vehicle's front."""
        return data.window_of(self.file, self.times)

    @cached_property
    def views(self) -> list[RoadView]:
        """The views of a road with bends at the instants; none of a straight road."""
        return views_along(self.file.road, self.origins, self.window)

    @cached_property
    def roads(self) -> list[data.ShownRoad]:
        """The visible part of the road at each instant."""
        return [data.road_in(self.file.road, origin, self.window) for origin in self.origins]

    @cached_property
    def extent(self) -> data.Box:
        """Left, right, bottom and top of all instants, in m."""
        across = self.roads[0].across
        return extent_of(self.views, self.window, across) if self.views else (*self.window, *across)

    @cached_property
    def scale(self) -> tuple[float, float]:
        """Pixels per metre along and across."""
        left, right, bottom, top = self.extent
        along = PLOT / (right - left)
        if self.views:
            along = min(along, HIGHEST / (top - bottom))
            return along, along
        return along, max(along, LANE_PIXELS)

    @property
    def height(self) -> float:
        """The height of the road at an instant, in px."""
        return (self.extent[3] - self.extent[2]) * self.scale[1]

    @cached_property
    def names_width(self) -> float:
        """The px that the times and the names of lanes need beside the road."""
        return max(width_of(_time(x)) for x in self.times) + 20 + self.lanes_width

    @cached_property
    def lanes_width(self) -> float:
        """The px of the longest name of a lane."""
        lanes = {name for road in self.roads for name, _ in road.lanes}
        return max((width_of(x, SMALL) for x in lanes), default=0.0)

    def block(self, left: float, top: float) -> Block:
        """Return the drawings of all instants right of ``left``, below ``top``, with a legend and an axis."""
        zones = dict.fromkeys(zone for road in self.roads for zone in road.zones)
        entries = [LegendEntry(ZONES[x], SHADES[x], is_line=False) for x in zones]
        shapes, y = legend("road from above", entries, (EDGE, left + PLOT - 130), top)
        shapes += _direction(left + PLOT, top)
        for k in range(SNAPSHOTS):
            shapes += _Snapshot(self, k, left, y).shapes()
            y += self.height + _BETWEEN
        axis = self._axis(left, y - _BETWEEN + 2)
        return Block([*shapes, *axis.shapes], axis.bottom)

    def _axis(self, left: float, y: float) -> Block:
        shapes = list[Shape]()
        for place, text in ticks_in(self.extent[:2], MOST_TICKS):
            x = left + (place - self.extent[0]) * self.scale[0]
            shapes.append(LineShape([(x, x, y, y + 4)], GREY))
            shapes.append(TextShape(text, [(x, y + 16)], GREY, SMALL, "middle"))
        first = next(iter(self.colours))
        what = (
            "m to scale, as seen from the middle"
            if self.views
            else f"m along the road from the front of {first}"
        )
        shapes.append(TextShape(what, [(left + PLOT / 2, y + 30)], GREY, SMALL, "middle"))
        return Block(shapes, y + 36)


def _time(time: Fraction) -> str:
    return f"{float(time):.1f} s"


def _direction(right: float, top: float) -> Iterator[Shape]:
    """Yield an arrow in the driving direction, at the right end of the legend."""
    yield TextShape("driving direction", [(right - 36, top + 11)], DARK, SMALL, "end")
    x, y = right, top + 7
    yield StrokesShape([[(x - 30, y), (x, y)], [(x - 6, y - 3), (x, y), (x - 6, y + 3)]], DARK)


@dataclass(frozen=True)
class _Snapshot:
    """The drawing of instant ``k``: the road right of ``left`` and below ``top``, in px."""

    whole: Snapshots
    k: int
    left: float
    top: float

    def shapes(self) -> Iterator[Shape]:
        """Yield the road, then the vehicles with their names."""
        road = self.whole.roads[self.k]
        middle = self.top + self.whole.height / 2
        place = (self.left - 20 - self.whole.lanes_width, middle + 4)
        yield TextShape(_time(self.whole.times[self.k]), [place], DARK, anchor="end")
        yield from self._bent(road) if self.whole.views else self._straight(road)
        yield from self._vehicles()

    def place(self, point: Point) -> Point:
        """Return a point in m, of the view or along and across, in px."""
        (low, _, _, high), (along, across) = self.whole.extent, self.whole.scale
        return self.left + (point[0] - low) * along, self.top + (high - point[1]) * across

    def places(self, points: Points) -> list[Point]:
        """Return points in px."""
        return [self.place(x) for x in points]

    def _straight(self, road: data.ShownRoad) -> Iterator[Shape]:
        for zone, (low, high), (right, left) in road.pieces:
            (x, y), (x2, y2) = self.place((low, left)), self.place((high, right))
            yield RectangleShape([(x, y, x2 - x, y2 - y)], SHADES[zone])
            yield from (LineShape([(x, x2, edge, edge)], _LINE) for edge in (y, y2))
        for name, middle in road.lanes:
            y = self.place((0.0, middle))[1] + 4
            yield TextShape(name, [(self.left - 6, y)], GREY, SMALL, "end")

    def _bent(self, road: data.ShownRoad) -> Iterator[Shape]:
        view = self.whole.views[self.k]
        for zone, along, (right, left) in road.pieces:
            yield PolygonShape([self.places(view.outline((*along, right, left)))], SHADES[zone])
            yield StrokesShape([self.places(view.edge(*along, d)) for d in (right, left)], _LINE)
        begin = min(along[0] for _, along, _ in road.pieces)
        places = sorted((self.place(view.at(begin, middle))[1] + 4, name) for name, middle in road.lanes)
        last = -math.inf
        for y, name in places:
            last = max(y, last + _NAMES)
            yield TextShape(name, [(self.left - 6, last)], GREY, SMALL, "end")

    def _box(self, name: str) -> data.Box:
        """Return a vehicle's box in m along from the first vehicle's front and across."""
        motion, time = self.whole.file.drive.vehicles[name], self.whole.times[self.k]
        state = state_at(motion, time)
        s, d = float(state.s - self.whole.origins[self.k]), float(state.d)
        return s - float(motion.length), s, d - float(motion.width), d

    def _outline(self, name: str) -> Sequence[Point]:
        """Return the corners of a vehicle in px."""
        left, right, bottom, top = box = self._box(name)
        if self.whole.views:
            return self.places(self.whole.views[self.k].vehicle(box))
        return self.places([(left, bottom), (right, bottom), (right, top), (left, top)])

    def _vehicles(self) -> Iterator[Shape]:
        """Yield the vehicles on the road and their names, beside which nothing else is."""
        outlines = {name: self._outline(name) for name in self.whole.colours}
        boxes = {name: extent(x) for name, x in outlines.items()}
        low, high = self.top, self.top + self.whole.height
        boxes = {name: x for name, x in boxes.items() if x[2] < high and x[3] > low}  # others are beside
        sizes = {name: (width_of(name, SMALL) + 4, float(_NAMES)) for name in boxes}
        within = self.left, self.left + PLOT, low - _BETWEEN / 2, high + _BETWEEN / 2
        names = place_labels({name: [x] for name, x in boxes.items()}, sizes, within)
        for name in boxes:
            yield PolygonShape([_clipped(outlines[name], low - 2, high + 2)], self.whole.colours[name])
        for name, placed in names.items():
            [(left, right, top, _)] = placed.boxes
            place = ((left + right) / 2, top + _NAMES - 2.5)
            yield RectangleShape([(left, top, right - left, _NAMES)], "#ffffff", 0.7)
            yield TextShape(name, [place], self.whole.colours[name], SMALL, "middle")


def _clipped(points: Sequence[Point], low: float, high: float) -> list[Point]:
    """Return points moved into a band of y, so that no vehicle reaches into the next drawing."""
    return [(x, min(max(y, low), high)) for x, y in points]
