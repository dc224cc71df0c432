"""Speeds, gaps against RSS distances, and the times at which parts hold, over one axis of time."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages import drive_data as data
from roadproof.extensions.pages.drive_axes import (
    DARK,
    DASHES,
    EDGE,
    FAINT,
    FEW_TICKS,
    GREY,
    PLOT,
    SMALL,
    Block,
    LegendEntry,
    TimeAxis,
    danger_labels,
    danger_lines,
    edges,
    legend,
    ticks_in,
)
from roadproof.extensions.pages.letters import width_of
from roadproof.extensions.pages.plane import Points
from roadproof.extensions.pages.shapes import (
    LineShape,
    PolygonShape,
    RectangleShape,
    Shape,
    StrokesShape,
    TextShape,
)
from roadproof.frontends.report.colours import DANGER, TRUE
from roadproof.frontends.report.sheet import excerpt
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass
from roadproof.world.motion import states_at

HIGH, ROW, INDENT = 116.0, 15.0, 9.0
"""The height of a panel, and of a row of a part; how far parts are moved in below the whole; in px."""
_NEAR, _LONGEST = 0.15, 90
_ROOM = 0.06  # of the height, above and below the curves


@dataclass(frozen=True)
class Curve:
    """Values over time as points (s, value) in pieces, between which it jumps; ``name``: in the legend."""

    name: str
    pieces: Sequence[Points]
    colour: str
    is_dashed: bool = False


@dataclass(frozen=True)
class Panel:
    """Curves with one axis of values; ``areas``: outlines (s, value) with colours; ``shading`` names them."""

    heading: str
    curves: Sequence[Curve]
    areas: Sequence[tuple[Points, str]] = ()
    shading: str = ""
    has_zero: bool = False

    @property
    def span(self) -> data.Span:
        """The span of the values, with room above and below."""
        values = [value for x in self.curves for piece in x.pieces for _, value in piece]
        low, high = min(values, default=0.0), max(values, default=1.0)
        if self.has_zero:
            low, high = min(low, 0.0), max(high, 0.0)
        if high - low < 1e-6:
            low, high = low - 1.0, high + 1.0
        room = _ROOM * (high - low)
        return low - room, high + room

    @property
    def entries(self) -> Iterator[LegendEntry]:
        """The legend: each curve, dashed lines once, areas once."""
        named = [x for x in self.curves if x.name and not x.is_dashed]
        yield from (LegendEntry(x.name, x.colour) for x in named)
        dashed = dict.fromkeys(x.name for x in self.curves if x.is_dashed)
        yield from (LegendEntry(x, GREY, dash=DASHES) for x in dashed)
        if self.areas:
            yield LegendEntry(self.shading, GREY, is_line=False, opacity=2 * _NEAR)

    def block(self, axis: TimeAxis, top: float, above: Block | None = None) -> Block:
        """Return the panel with its legend; ``above``: labels between the two that begin at y 0."""
        shapes, y = legend(self.heading, [*self.entries], (EDGE, axis.right), top)
        if above is not None:
            shapes += [_lowered(x, y) for x in above.shapes]
            y += above.bottom
        low, high = self.span

        def places(points: Points) -> Points:
            return [(axis.x(t), y + HIGH * (high - v) / (high - low)) for t, v in points]

        shapes += axis.grid(y, y + HIGH)
        for value, text in ticks_in((low, high), FEW_TICKS):
            [(_, level)] = places([(0.0, value)])
            shapes.append(LineShape([(axis.left, axis.right, level, level)], FAINT if value else "#999999"))
            shapes.append(TextShape(text, [(axis.left - 6, level + 4)], GREY, SMALL, "end"))
        shapes += (PolygonShape([places(points)], colour, _NEAR) for points, colour in self.areas)
        for curve in self.curves:
            lines = [places(x) for x in curve.pieces]
            dash, width = (DASHES, 1.2) if curve.is_dashed else (None, 1.8)
            shapes.append(StrokesShape(lines, curve.colour, width, dash))
        shapes += danger_lines(axis, DANGER, y, y + HIGH)
        shapes.append(edges((axis.left, y, PLOT, HIGH)))
        return Block(shapes, y + HIGH + 6)


def _lowered(shape: Shape, y: float) -> Shape:
    """Return a text moved down."""
    assert isinstance(shape, TextShape)
    places = [(x, y + there) for x, there in shape.places]
    return TextShape(shape.text, places, shape.fill, shape.size, shape.anchor)


def panels_of(file: DriveFile, library: Library, colours: Mapping[str, str]) -> Iterator[Panel]:
    """Yield the panels of a drive: speeds along, across where there are any, and gaps of several vehicles."""
    times = data.times_of(file)
    states = {name: states_at(file.drive.vehicles[name], times) for name in colours}
    seconds = [float(x) for x in times]
    along = {name: [float(x.v_lon) for x in each] for name, each in states.items()}
    across = {name: [float(x.v_lat) for x in each] for name, each in states.items()}
    across = {name: values for name, values in across.items() if any(values)}
    for heading, speeds in (
        ("speed along, m/s", along),
        ("speed across, m/s, to the left above 0", across),
    ):
        if speeds:
            curves = [
                Curve(name, [[*zip(seconds, values, strict=True)]], colours[name])
                for name, values in speeds.items()
            ]
            yield Panel(heading, curves, has_zero=speeds is across)
    directions: tuple[data.Direction, ...] = ("along", "across")
    for direction in directions if len(colours) > 1 else ():
        distances = data.distances_of(file, library, direction)
        yield _gaps(direction, distances, seconds, colours)


def _gaps(
    direction: data.Direction,
    distances: Sequence[data.Distance],
    seconds: Sequence[float],
    colours: Mapping[str, str],
) -> Panel:
    """Return distances between boxes and the RSS distances that they need, shaded where they are below."""
    curves, areas = list[Curve](), list[tuple[Points, str]]()
    for x in distances:
        colour = colours[x.other]
        curves.append(Curve(f"{x.one} to {x.other}", [[*zip(seconds, x.gap, strict=True)]], colour))
        needed = [[*zip(seconds[run], x.needed[run], strict=True)] for run in x.runs]
        curves.append(Curve("RSS distance", needed, colour, is_dashed=True))
        near = [gap <= needed for gap, needed in zip(x.gap, x.needed, strict=True)]
        for is_near, run in groupby(range(len(near)), lambda k: near[k]):  # noqa: B023
            if is_near:
                those = [*run]
                below = [(seconds[k], x.gap[k]) for k in those]
                areas.append(([*below, *((seconds[k], x.needed[k]) for k in reversed(those))], colour))
    return Panel(f"gap {direction}, m", curves, areas, "nearer than that", has_zero=True)


def curves_block(panels: Sequence[Panel], axis: TimeAxis, top: float) -> Block:
    """Return all panels below each other, then the ticks of time; the first has the names of dangers."""
    shapes, y = list[Shape](), top
    for k, panel in enumerate(panels):
        labels = danger_labels(axis, DANGER, 0.0) if k == 0 and axis.dangers else None
        drawn = panel.block(axis, y, labels)
        shapes += drawn.shapes
        y = drawn.bottom
    ticks = axis.ticks(y - 6)
    return Block([*shapes, *ticks.shapes], ticks.bottom)


def name_of(strip: data.Strip) -> str:
    """Return the name of a part as it is written; the middle of a very long one is left out."""
    return excerpt(strip.name, _LONGEST)


def strips_width(strips: Sequence[data.Strip]) -> float:
    """Return the px that the names of parts need."""
    return max((INDENT * x.depth + width_of(name_of(x), SMALL) for x in strips), default=0.0)


def strips_block(strips: Sequence[data.Strip], axis: TimeAxis, top: float) -> Block:
    """Return a row for each part, its name moved in below what it is part of, and bars while it holds."""
    entries = [LegendEntry("holds", TRUE, is_line=False)]
    shapes, y = legend("parts of the formula", entries, (EDGE, axis.right), top)
    bottom = y + ROW * len(strips)
    shapes += axis.grid(y, bottom)
    for row, strip in enumerate(strips):
        middle = y + ROW * (row + 0.5)
        place = (EDGE + INDENT * strip.depth, middle + 4)
        shapes.append(TextShape(name_of(strip), [place], DARK, SMALL))
        shapes.append(LineShape([(axis.left, axis.right, middle, middle)], FAINT))
        for begin, end in strip.spans:
            wide = max(1.5, axis.x(end) - axis.x(begin))
            shapes.append(RectangleShape([(axis.x(begin), middle - 5, wide, 10)], TRUE))
    shapes += danger_lines(axis, DANGER, y, bottom)
    shapes.append(edges((axis.left, y, PLOT, bottom - y)))
    ticks = axis.ticks(bottom)
    return Block([*shapes, *ticks.shapes], ticks.bottom)
