"""An animation of a drive as frames: the scene of the moving picture, drawn with matplotlib."""

import math
from collections.abc import Sequence
from fractions import Fraction
from math import ceil
from typing import Any, TypeVar

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.bent_scene import scene_of
from roadproof.extensions.pages.film import Film
from roadproof.extensions.pages.scene import (
    PAUSE,
    WIDTH,
    Line,
    Polygon,
    Rectangle,
    Shape,
    Shift,
    Strokes,
    Text,
    headings,
    rows,
)
from roadproof.frontends.report.drive import DANGER
from roadproof.frontends.report.drive_data import Box
from roadproof.frontends.report.figures import draw_again, make_page
from roadproof.frontends.report.plane import Point, Points
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass

RATE, MOST_FRAMES = 12, 720  # frames a second; of a long drive in all, so that there are fewer a second
DOTS = 100  # pixels an inch
POINTS = 72 / DOTS  # points a pixel
LETTERS = 0.88  # the font is wider than that of the moving picture
V = TypeVar("V")


@dataclass(frozen=True)
class _Mobile:
    """A shape and the artist that draws it; ``shifts`` of the pavement about ``pivot`` at each instant."""

    shape: Shape
    artist: Any
    shifts: Sequence[Shift] = ()
    pivot: Point = (0.0, 0.0)

    @property
    def moves(self) -> bool:
        """Whether it is not the same at all instants."""
        return bool(self.shifts) or _count(self.shape) > 1

    def show(self, k: int) -> None:
        """Bring the artist to an instant."""
        shape, shift = self.shape, self.shifts[k] if self.shifts else Shift(0.0)
        if isinstance(shape, Rectangle):
            self.artist.set_xy([*zip(*_corners(_at(shape.boxes, k), shift.x), strict=True)])
        elif isinstance(shape, Polygon):
            self.artist.set_xy(_shifted(_at(shape.outlines, k), shift, self.pivot))
        elif isinstance(shape, Strokes):
            lines = [_shifted(x, shift, self.pivot) for x in shape.lines]
            self.artist.set_data(*_joined(lines))
        elif isinstance(shape, Line):
            self.artist.set_data(*_strokes(_at(shape.ends, k), shape.dash, shift.x))
        else:
            self.artist.set_position(_at(shape.places, k))
        if isinstance(shape, Rectangle | Polygon) and shape.red:
            self.artist.set_color(DANGER if shape.red[k] else shape.fill)


def draw_film(file: DriveFile, library: Library) -> Film:
    """The frames of a drive. Raises ``MissingSolverError`` without matplotlib."""
    grain = max(Fraction(1, RATE), file.horizon / MOST_FRAMES)
    scene = scene_of(file, library, grain=grain)
    size = int(WIDTH), 2 * ceil(scene.height / 2)  # films need even numbers
    figure = make_page(size[0] / DOTS, size[1] / DOTS, DOTS)
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, size[0]), ylim=(size[1], 0))
    axes.set_axis_off()
    lanes = scene.pavement()
    pivot = lanes.pivot or (0.0, 0.0)
    road = [_Mobile(x, _draw(axes, x), lanes.shifts, pivot) for x in lanes.shapes]
    road += [_Mobile(x, _draw(axes, x)) for x in scene.areas()]
    left, top, width, height = lanes.window
    window = _draw(axes, Rectangle([(left, top - 1, width, height + 2)], "none"))  # with the edge lines
    for x in road:
        x.artist.set_clip_path(window)
    others = [_Mobile(x, _draw(axes, x)) for x in (*headings(scene), *scene.vehicles(), *rows(scene))]
    for order, x in enumerate((*road, *others)):
        x.artist.set_zorder(order)
    moving = [x for x in (*road, *others) if x.moves]
    pixels = draw_again(figure, [x.artist for x in moving])

    def frame(k: int) -> bytes:
        for x in moving:
            x.show(k)
        return pixels()

    return Film(size, frame, len(scene.times), grain, PAUSE, scene.still)


def _at(values: Sequence[V], k: int) -> V:
    """The value at an instant of a shape that moves, or the only one."""
    return values[k] if len(values) > 1 else values[0]


def _count(shape: Shape) -> int:
    """How many states a shape has: one for each instant, or one."""
    match shape:
        case Rectangle(boxes=values) | Line(ends=values) | Text(places=values) | Polygon(outlines=values):
            return len(values)
        case Strokes():
            return 1


def _shifted(points: Points, shift: Shift, pivot: Point) -> list[Point]:
    """Points moved and then turned clockwise as y grows downwards."""
    turned = math.radians(shift.turned)
    cos, sin = math.cos(turned), math.sin(turned)
    moved = ((x + shift.x - pivot[0], y + shift.y - pivot[1]) for x, y in points)
    return [(pivot[0] + x * cos - y * sin, pivot[1] + x * sin + y * cos) for x, y in moved]


def _joined(lines: Sequence[Points]) -> tuple[list[float], list[float]]:
    """The points of lines, with none between one and the next."""
    gap = (math.nan, math.nan)
    points = [point for line in lines for point in (*line, gap)]
    return [x for x, _ in points], [y for _, y in points]


def _draw(axes: Any, shape: Shape) -> Any:
    """The artist of a shape at the first instant."""
    if isinstance(shape, Rectangle):
        return axes.fill(*_corners(shape.boxes[0]), color=shape.fill, alpha=shape.opacity, lw=0)[0]
    if isinstance(shape, Polygon):
        corners = zip(*shape.outlines[0], strict=True)
        return axes.fill(*corners, color=shape.fill, alpha=shape.opacity, lw=0)[0]
    if isinstance(shape, Line | Strokes):
        strokes = _strokes(shape.ends[0], shape.dash) if isinstance(shape, Line) else _joined(shape.lines)
        return axes.plot(*strokes, color=shape.stroke, lw=POINTS, solid_capstyle="butt")[0]
    look = {"fontsize": shape.size * POINTS * LETTERS, "color": shape.fill, "parse_math": False}
    return axes.text(*shape.places[0], shape.text, ha="center" if shape.middle else "left", **look)


def _corners(box: Box, shift: float = 0.0) -> tuple[list[float], list[float]]:
    """The corners of a box of left, top, width and height."""
    left, top, width, height = box
    x, right, bottom = left + shift, left + shift + width, top + height
    return [x, right, right, x], [top, top, bottom, bottom]


def _strokes(
    ends: Box, dash: tuple[float, float] | None, shift: float = 0.0
) -> tuple[list[float], list[float]]:
    """The points of a line; between dashes there is none, since dashes of matplotlib do not move along."""
    x, x2, y, y2 = ends
    length = abs(x2 - x) + abs(y2 - y)  # a line is level or upright
    on, off = dash or (length, 0.0)
    steps = range(ceil(length / (on + off))) if length else range(0)
    parts = [(k * (on + off) / length, min(1.0, (k * (on + off) + on) / length)) for k in steps]
    points = [part for begin, end in parts for part in (begin, end, float("nan"))]
    return [x + shift + (x2 - x) * p for p in points], [y + (y2 - y) * p for p in points]
