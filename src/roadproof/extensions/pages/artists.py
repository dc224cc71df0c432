"""Artists of matplotlib for the shapes of drawings of drives: frames of films, and PNG on request."""

import io
import math
from collections.abc import Sequence
from math import ceil
from typing import Any

from roadproof.extensions.pages.drive_data import Box
from roadproof.extensions.pages.plane import Points
from roadproof.extensions.pages.shapes import (
    Anchor,
    LineShape,
    PolygonShape,
    RectangleShape,
    Shape,
    StrokesShape,
)
from roadproof.frontends.report.figures import make_page

DOTS = 100  # pixels an inch
POINTS = 72 / DOTS  # points a pixel
LETTERS = 0.88  # the font is wider than that of SVG files
SHARP = 1.5  # pixels of a PNG for each of its SVG
_ANCHORS: dict[Anchor, str] = {"start": "left", "middle": "center", "end": "right"}


def canvas(width: float, height: float, dots: float = DOTS) -> tuple[Any, Any]:
    """Return a figure of a size (px) and axes that cover it, y downwards. Raises ``MissingSolverError``."""
    figure = make_page(width / DOTS, height / DOTS, dots)
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(height, 0))
    axes.set_axis_off()
    return figure, axes


def as_png(shapes: Sequence[Shape], width: float, height: float) -> bytes:
    """Return shapes as PNG. Raises ``MissingSolverError`` without matplotlib."""
    figure, axes = canvas(width, height, DOTS * SHARP)
    for order, shape in enumerate(shapes):
        artist_of(axes, shape).set_zorder(order)
    out = io.BytesIO()
    figure.savefig(out, format="png")
    return out.getvalue()


def artist_of(axes: Any, shape: Shape) -> Any:
    """Return a new artist for a shape at the first instant."""
    if isinstance(shape, RectangleShape):
        return axes.fill(*corners_of(shape.boxes[0]), color=shape.fill, alpha=shape.opacity, lw=0)[0]
    if isinstance(shape, PolygonShape):
        corners = zip(*shape.outlines[0], strict=True)
        return axes.fill(*corners, color=shape.fill, alpha=shape.opacity, lw=0)[0]
    look: dict[str, Any] = {"solid_capstyle": "butt", "dash_capstyle": "butt"}
    if isinstance(shape, LineShape):
        strokes = line_points(shape.ends[0], shape.dash)
        return axes.plot(*strokes, color=shape.stroke, lw=POINTS, **look)[0]
    if isinstance(shape, StrokesShape):
        if shape.dash is not None:
            look["linestyle"] = (0, tuple(x / shape.width for x in shape.dash))  # in widths of the line
        strokes = polyline_points(shape.lines)
        return axes.plot(*strokes, color=shape.stroke, lw=shape.width * POINTS, **look)[0]
    letters = {"fontsize": shape.size * POINTS * LETTERS, "color": shape.fill, "parse_math": False}
    return axes.text(*shape.places[0], shape.text, ha=_ANCHORS[shape.anchor], **letters)


def corners_of(box: Box, shift: float = 0.0) -> tuple[list[float], list[float]]:
    """Return x and y of the corners of a box (left, top, width, height)."""
    left, top, width, height = box
    x, right, bottom = left + shift, left + shift + width, top + height
    return [x, right, right, x], [top, top, bottom, bottom]


def line_points(
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


def polyline_points(lines: Sequence[Points]) -> tuple[list[float], list[float]]:
    """Return x and y of the points of lines, separated by NaN."""
    gap = (math.nan, math.nan)
    points = [point for line in lines for point in (*line, gap)]
    return [x for x, _ in points], [y for _, y in points]
