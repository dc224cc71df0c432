"""Draws an animation as frames with matplotlib; the shapes are those of the animated SVG."""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from math import ceil
from typing import Any, TypeVar

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.bent_scene import scene_of
from roadproof.extensions.pages.film import Film
from roadproof.extensions.pages.scene import (
    PAUSE,
    WIDTH,
    LineShape,
    PavementShift,
    PolygonShape,
    RectangleShape,
    Shape,
    StrokesShape,
    TextShape,
    headings,
    timeline_rows,
)
from roadproof.frontends.report.drive import DANGER
from roadproof.frontends.report.drive_data import Box
from roadproof.frontends.report.figures import make_page
from roadproof.frontends.report.plane import Point, Points
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass

RATE, MOST_FRAMES = 12, 720  # frames a second; of a long drive in all, so that there are fewer a second
DOTS = 100  # pixels an inch
POINTS = 72 / DOTS  # points a pixel
LETTERS = 0.88  # the font is wider than that of the moving picture
V = TypeVar("V")


@dataclass(frozen=True)
class _AnimatedShape:
    """A shape and the artist that draws it; ``shifts`` move the pavement about ``pivot`` at each instant."""

    shape: Shape
    artist: Any
    shifts: Sequence[PavementShift] = ()
    pivot: Point = (0.0, 0.0)

    @property
    def moves(self) -> bool:
        """Return whether the shape differs between instants."""
        return bool(self.shifts) or _state_count(self.shape) > 1

    def show(self, k: int) -> None:
        """Set the artist to instant ``k``."""
        shape, shift = self.shape, self.shifts[k] if self.shifts else PavementShift(0.0)
        if isinstance(shape, RectangleShape):
            self.artist.set_xy([*zip(*_corners(_value_at(shape.boxes, k), shift.x), strict=True)])
        elif isinstance(shape, PolygonShape):
            self.artist.set_xy(_shifted(_value_at(shape.outlines, k), shift, self.pivot))
        elif isinstance(shape, StrokesShape):
            lines = [_shifted(x, shift, self.pivot) for x in shape.lines]
            self.artist.set_data(*_polyline_points(lines))
        elif isinstance(shape, LineShape):
            self.artist.set_data(*_line_points(_value_at(shape.ends, k), shape.dash, shift.x))
        else:
            self.artist.set_position(_value_at(shape.places, k))
        if isinstance(shape, RectangleShape | PolygonShape) and shape.red:
            self.artist.set_color(DANGER if shape.red[k] else shape.fill)


def draw_film(file: DriveFile, library: Library) -> Film:
    """Return the film of a drive. Raises ``MissingSolverError`` without matplotlib."""
    grain = max(Fraction(1, RATE), file.horizon / MOST_FRAMES)
    scene = scene_of(file, library, grain=grain)
    size = int(WIDTH), 2 * ceil(scene.height / 2)  # films need even numbers
    figure = make_page(size[0] / DOTS, size[1] / DOTS, DOTS)
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, size[0]), ylim=(size[1], 0))
    axes.set_axis_off()
    lanes = scene.pavement()
    pivot = lanes.pivot or (0.0, 0.0)
    road = [_AnimatedShape(x, _draw(axes, x), lanes.shifts, pivot) for x in lanes.shapes]
    road += [_AnimatedShape(x, _draw(axes, x)) for x in scene.areas()]
    left, top, width, height = lanes.window
    window = _draw(axes, RectangleShape([(left, top - 1, width, height + 2)], "none"))  # with the edge lines
    for x in road:
        x.artist.set_clip_path(window)
    others = [
        _AnimatedShape(x, _draw(axes, x))
        for x in (*headings(scene), *scene.vehicles(), *timeline_rows(scene))
    ]
    for order, x in enumerate((*road, *others)):
        x.artist.set_zorder(order)
    moving = [x for x in (*road, *others) if x.moves]
    pixels = draw_again(figure, [x.artist for x in moving])

    def frame(k: int) -> bytes:
        for x in moving:
            x.show(k)
        return pixels()

    return Film(size, frame, len(scene.times), grain, PAUSE, scene.still)


def _value_at(values: Sequence[V], k: int) -> V:
    """Return the value at instant ``k``, or the only value of a shape that does not move."""
    return values[k] if len(values) > 1 else values[0]


def _state_count(shape: Shape) -> int:
    """Return the number of states of a shape: one for each instant, or one."""
    match shape:
        case (
            RectangleShape(boxes=values)
            | LineShape(ends=values)
            | TextShape(places=values)
            | PolygonShape(outlines=values)
        ):
            return len(values)
        case StrokesShape():
            return 1


def _shifted(points: Points, shift: PavementShift, pivot: Point) -> list[Point]:
    """Return points moved by a shift, then turned clockwise (y grows downwards)."""
    turned = math.radians(shift.turned)
    cos, sin = math.cos(turned), math.sin(turned)
    moved = ((x + shift.x - pivot[0], y + shift.y - pivot[1]) for x, y in points)
    return [(pivot[0] + x * cos - y * sin, pivot[1] + x * sin + y * cos) for x, y in moved]


def _polyline_points(lines: Sequence[Points]) -> tuple[list[float], list[float]]:
    """Return x and y of the points of lines, separated by NaN."""
    gap = (math.nan, math.nan)
    points = [point for line in lines for point in (*line, gap)]
    return [x for x, _ in points], [y for _, y in points]


def _draw(axes: Any, shape: Shape) -> Any:
    """Return a new artist for a shape at the first instant."""
    if isinstance(shape, RectangleShape):
        return axes.fill(*_corners(shape.boxes[0]), color=shape.fill, alpha=shape.opacity, lw=0)[0]
    if isinstance(shape, PolygonShape):
        corners = zip(*shape.outlines[0], strict=True)
        return axes.fill(*corners, color=shape.fill, alpha=shape.opacity, lw=0)[0]
    if isinstance(shape, LineShape | StrokesShape):
        strokes = (
            _line_points(shape.ends[0], shape.dash)
            if isinstance(shape, LineShape)
            else _polyline_points(shape.lines)
        )
        return axes.plot(*strokes, color=shape.stroke, lw=POINTS, solid_capstyle="butt")[0]
    look = {"fontsize": shape.size * POINTS * LETTERS, "color": shape.fill, "parse_math": False}
    return axes.text(*shape.places[0], shape.text, ha="center" if shape.middle else "left", **look)


def _corners(box: Box, shift: float = 0.0) -> tuple[list[float], list[float]]:
    """Return x and y of the corners of a box (left, top, width, height)."""
    left, top, width, height = box
    x, right, bottom = left + shift, left + shift + width, top + height
    return [x, right, right, x], [top, top, bottom, bottom]


def _line_points(
    ends: Box, dash: tuple[float, float] | None, shift: float = 0.0
) -> tuple[list[float], list[float]]:
    """Return x and y of the points of a line, with NaN between dashes.

    The dashes of matplotlib itself do not move along with the line.
    """
    x, x2, y, y2 = ends
    length = abs(x2 - x) + abs(y2 - y)  # a line is level or upright
    on, off = dash or (length, 0.0)
    steps = range(ceil(length / (on + off))) if length else range(0)
    parts = [(k * (on + off) / length, min(1.0, (k * (on + off) + on) / length)) for k in steps]
    points = [part for begin, end in parts for part in (begin, end, float("nan"))]
    return [x + shift + (x2 - x) * p for p in points], [y + (y2 - y) * p for p in points]


def draw_again(figure: Any, moving: Sequence[Any]) -> Callable[[], bytes]:
    """A function that draws ``moving`` artists where they are then, above all others, as RGBA bytes."""
    for artist in moving:
        artist.set_animated(True)
    canvas = figure.canvas
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)

    def pixels() -> bytes:
        """Return the pixels (RGBA) of the figure with the moving artists."""
        canvas.restore_region(still)
        for artist in moving:
            figure.draw_artist(artist)
        return bytes(canvas.buffer_rgba())

    return pixels
