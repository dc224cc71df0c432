"""Draws an animation as frames with matplotlib; the shapes are those of the animated SVG."""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from math import ceil
from typing import Any

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.artists import artist_of, canvas, corners_of, line_points, polyline_points
from roadproof.extensions.pages.bent_scene import scene_of
from roadproof.extensions.pages.film import Film
from roadproof.extensions.pages.plane import Point, Points
from roadproof.extensions.pages.scene import PAUSE, WIDTH, PavementShift
from roadproof.extensions.pages.scene_rows import headings, timeline_rows
from roadproof.extensions.pages.shapes import (
    LineShape,
    PolygonShape,
    RectangleShape,
    Shape,
    StrokesShape,
    TextShape,
    value_at,
)
from roadproof.frontends.report.colours import DANGER
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass

RATE, MOST_FRAMES = 12, 720  # frames a second; of a long drive in all, so that there are fewer a second


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
            self.artist.set_xy([*zip(*corners_of(value_at(shape.boxes, k), shift.x), strict=True)])
        elif isinstance(shape, PolygonShape):
            self.artist.set_xy(_shifted(value_at(shape.outlines, k), shift, self.pivot))
        elif isinstance(shape, StrokesShape):
            lines = [_shifted(x, shift, self.pivot) for x in shape.lines]
            self.artist.set_data(*polyline_points(lines))
        elif isinstance(shape, LineShape):
            self.artist.set_data(*line_points(value_at(shape.ends, k), shape.dash, shift.x))
        else:
            self.artist.set_position(value_at(shape.places, k))
        if isinstance(shape, RectangleShape | PolygonShape) and shape.red:
            self.artist.set_color(DANGER if shape.red[k] else shape.fill)


def draw_film(file: DriveFile, library: Library) -> Film:
    """Return the film of a drive. Raises ``MissingSolverError`` without matplotlib."""
    grain = max(Fraction(1, RATE), file.horizon / MOST_FRAMES)
    scene = scene_of(file, library, grain=grain)
    size = int(WIDTH), 2 * ceil(scene.height / 2)  # films need even numbers
    figure, axes = canvas(*size)
    lanes = scene.pavement()
    pivot = lanes.pivot or (0.0, 0.0)
    road = [_AnimatedShape(x, artist_of(axes, x), lanes.shifts, pivot) for x in lanes.shapes]
    road += [_AnimatedShape(x, artist_of(axes, x)) for x in scene.areas()]
    left, top, width, height = lanes.window
    window = artist_of(
        axes, RectangleShape([(left, top - 1, width, height + 2)], "none")
    )  # with the edge lines
    for x in road:
        x.artist.set_clip_path(window)
    others = [
        _AnimatedShape(x, artist_of(axes, x))
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
