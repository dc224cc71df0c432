"""The picture of a drive: the road from above, speeds, gaps against RSS distances, and what holds when.

It is drawn as shapes with widths of letters that are known, without a font and without matplotlib. The PNG is
made of the same shapes where it is asked for.
"""

import math
from collections.abc import Sequence

from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.extensions.pages import drive_data as data
from roadproof.extensions.pages.drive_axes import DARK, EDGE, GREY, SMALL, Block, TimeAxis
from roadproof.extensions.pages.drive_curves import curves_block, panels_of, strips_block, strips_width
from roadproof.extensions.pages.drive_road import Snapshots
from roadproof.extensions.pages.letters import lines_of
from roadproof.extensions.pages.shapes import LETTER, Shape, TextShape, element_at, svg_of
from roadproof.frontends.report.colours import COLOURS
from roadproof.frontends.report.picture import Picture
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass
from roadproof.world.length_error import bend_note

TITLE, LEAST_NAMES = 15, 96.0
"""The size of letters of the title, and the least width of the column of names, in px."""
_BETWEEN = 12.0


@dataclass(frozen=True)
class Drawing:
    """Shapes on a sheet of that width and height, in px."""

    shapes: Sequence[Shape]
    width: float
    height: float

    def svg(self) -> bytes:
        """Return the drawing as an SVG file."""
        return svg_of([element_at(x) for x in self.shapes], self.width, self.height)

    def png(self) -> bytes:
        """Return the drawing as a PNG file. Raises ``MissingSolverError`` without matplotlib."""
        from roadproof.extensions.pages.artists import as_png  # here: an SVG file needs no matplotlib

        return as_png(self.shapes, self.width, self.height)


def draw_drive(file: DriveFile, library: Library, title: str = "") -> Picture:
    """Return the picture of a drive; ``title`` replaces its scenario or formula."""
    drawing = drawing_of(file, library, title)
    return Picture(drawing.svg(), drawing.png)


def drawing_of(file: DriveFile, library: Library, title: str = "") -> Drawing:
    """Return the shapes of a drive's picture."""
    judgement = judge_file(file, library).judgement
    strips = () if judgement is None else data.strips_of(judgement, file.horizon)
    dangers = data.dangers_of(file, library)
    vehicles = data.vehicles_of(file)
    colours = dict(zip(vehicles, COLOURS * len(vehicles), strict=False))
    road = Snapshots(file, colours)
    left = EDGE + max(LEAST_NAMES, road.names_width, strips_width(strips)) + 12
    axis = TimeAxis(left, float(file.horizon), dangers)
    heading = _heading(
        title.splitlines() or data.heading_of(file, library), _facts(file, dangers), axis.right
    )
    shapes, y = heading
    drawn = road.block(left, y + _BETWEEN)
    curves = curves_block([*panels_of(file, library, colours)], axis, drawn.bottom + _BETWEEN)
    shapes = [*shapes, *drawn.shapes, *curves.shapes]
    bottom = curves.bottom
    if strips:
        rows = strips_block(strips, axis, bottom + _BETWEEN)
        shapes, bottom = [*shapes, *rows.shapes], rows.bottom
    return Drawing(shapes, math.ceil(axis.right + EDGE), math.ceil(bottom + EDGE))


def _facts(file: DriveFile, dangers: Sequence[data.Danger]) -> list[str]:
    """Return the lines below the title: set, road, lanes, dangers, and what bends do to lengths."""
    lanes = "".join(f", {name} = {lane}" for name, lane in file.lanes.items())
    facts = f"set {file.set_name}, road {file.road.name}{lanes}" + "".join(f"; {x}" for x in dangers)
    return [x for x in (facts, bend_note(file.road)) if x]


def _heading(title: Sequence[str], facts: Sequence[str], right: float) -> Block:
    """Return the title, of which the first line is larger, and the facts below it."""
    first, *others = title
    lines = [(first, TITLE, DARK)]
    lines += [(x, LETTER, DARK) for x in others] + [(x, SMALL, GREY) for x in facts]
    shapes, y = list[Shape](), EDGE
    for text, size, colour in lines:
        for line in lines_of(text, right - EDGE, size):
            y += size + 4
            shapes.append(TextShape(line, [(EDGE, y - 4)], colour, size))
    return Block(shapes, y)
