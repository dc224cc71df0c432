"""Parts of a drive's picture that its road and its curves share: its columns, axes, legends and rows."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from roadproof.extensions.pages.drive_data import Box, Danger, Span
from roadproof.extensions.pages.letters import width_of
from roadproof.extensions.pages.shapes import LineShape, RectangleShape, Shape, StrokesShape, TextShape
from roadproof.runtime.records import dataclass

EDGE, PLOT = 16.0, 680.0
"""The margin of the picture, and the width of its roads and curves, in px."""
SMALL = 11
"""The size of letters of labels, in px."""
GREY, FAINT, DARK = "#666666", "#e4e4e4", "#222222"
DASHES = (5.0, 3.0)
MOST_TICKS, FEW_TICKS = 12, 6
_SWATCH = (16.0, 9.0)


class Block(NamedTuple):
    """Shapes of a part of the picture, and the y at which it ends, in px."""

    shapes: list[Shape]
    bottom: float


class LegendEntry(NamedTuple):
    """The meaning of a colour: of an area, or of a line, which may be dashed."""

    text: str
    colour: str
    is_line: bool = True
    dash: Span | None = None
    opacity: float = 1.0


@dataclass(frozen=True)
class TimeAxis:
    """The columns of a picture and its axis of time: ``left`` of the curves in px; ``horizon`` in s."""

    left: float
    horizon: float
    dangers: Sequence[Danger] = ()

    @property
    def right(self) -> float:
        """The x at which the curves end."""
        return self.left + PLOT

    def x(self, time: float) -> float:
        """Return the x of a time in s."""
        return self.left + PLOT * time / self.horizon

    def ticks(self, y: float) -> Block:
        """Return the ticks of time below ``y``."""
        shapes = list[Shape]()
        places = ticks_in((0.0, self.horizon), MOST_TICKS)
        for k, (time, number) in enumerate(places):
            text = number + " s" if k == len(places) - 1 else number
            shapes.append(LineShape([(self.x(time), self.x(time), y, y + 4)], GREY))
            middle = min(self.x(time), self.right + EDGE - width_of(text, SMALL) / 2)
            shapes.append(TextShape(text, [(middle, y + 16)], GREY, SMALL, "middle"))
        return Block(shapes, y + 22)

    def grid(self, top: float, bottom: float) -> Iterator[Shape]:
        """Yield upright lines at the ticks."""
        for time, _ in ticks_in((0.0, self.horizon), MOST_TICKS):
            yield LineShape([(self.x(time), self.x(time), top, bottom)], FAINT)


def ticks_in(span: Span, most: int) -> list[tuple[float, str]]:
    """Return round values in a span with their texts, at most so many."""
    low, high = span
    least = (high - low) / most
    power = 10.0 ** math.floor(math.log10(least)) if least > 0 else 1.0
    step = next(x * power for x in (1, 2, 5, 10, 20) if (high - low) / (x * power) <= most - 1)
    digits = max(0, -math.floor(math.log10(step) + 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [(k * step, f"{k * step:.{digits}f}") for k in range(first, last + 1)]


def legend(heading: str, entries: Sequence[LegendEntry], span: Span, top: float) -> Block:
    """Return a heading with the entries behind it, in as many rows as they need; ``span``: left and right."""
    left, right = span
    shapes: list[Shape] = [TextShape(heading, [(left, top + 11)], DARK)]
    x, y = left + (width_of(heading) + 22 if heading else 0), top
    begin = x
    for entry in entries:
        width = _SWATCH[0] + 5 + width_of(entry.text, SMALL)
        if x + width > right and x > begin:
            x, y = begin, y + 15
        shapes += _swatch(entry, x, y + 7)
        shapes.append(TextShape(entry.text, [(x + _SWATCH[0] + 5, y + 11)], DARK, SMALL))
        x += width + 16
    return Block(shapes, y + 18)


def _swatch(entry: LegendEntry, x: float, y: float) -> Iterator[Shape]:
    wide, high = _SWATCH
    if entry.is_line:
        yield StrokesShape([[(x, y), (x + wide, y)]], entry.colour, 2, entry.dash)
    else:
        yield RectangleShape([(x, y - high / 2, wide, high)], entry.colour, entry.opacity)


def danger_labels(axis: TimeAxis, colour: str, top: float) -> Block:
    """Return the names of the lines where dangers begin, in as many rows as they need."""
    shapes, ends = list[Shape](), list[float]()
    for danger in axis.dangers:
        text = f"danger with {danger.other} begins" if len(axis.dangers) > 1 else "danger begins"
        half = width_of(text, SMALL) / 2
        middle = min(max(axis.x(danger.begins), axis.left + half), axis.right - half)
        row = next((k for k, end in enumerate(ends) if end + 8 <= middle - half), len(ends))
        ends[row : row + 1] = [middle + half]
        shapes.append(TextShape(text, [(middle, top + 11 + 14 * row)], colour, SMALL, "middle"))
    return Block(shapes, top + 14 * len(ends) + (2 if ends else 0))


def danger_lines(axis: TimeAxis, colour: str, top: float, bottom: float) -> Iterator[Shape]:
    """Yield a line where each danger begins."""
    for danger in axis.dangers:
        x = axis.x(danger.begins)
        yield LineShape([(x, x, top, bottom)], colour, (4, 2))


def edges(box: Box) -> StrokesShape:
    """Return the lines around a box (left, top, width, height)."""
    x, y, wide, high = box
    corners = [(x, y), (x + wide, y), (x + wide, y + high), (x, y + high), (x, y)]
    return StrokesShape([corners], "#aaaaaa")
