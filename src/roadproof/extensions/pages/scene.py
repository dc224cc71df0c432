"""What an animation of a drive shows: shapes in pixels at each instant, drawn as SVG and as frames.

The view follows SV. For each other vehicle an area around SV is shaded up to the RSS distances. It is red
while the vehicle is in it; if that lasts for ``minDanger``, there is danger. Below the road stands a row for
each part of the formula and for danger, with a line at the instant that is shown.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple, TypeAlias

from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.frontends.report import drive_data as data
from roadproof.frontends.report.drive import COLOURS, DANGER, SHADES, TRUE
from roadproof.frontends.report.plane import Point, Points
from roadproof.frontends.report.sheet import excerpt
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass
from roadproof.world.length_error import length_error_of
from roadproof.world.motion import State, states_at

WIDTH, EDGE, NAMES = 860.0, 14.0, 230.0  # pixels: the picture, its margin, the column of names
ROW, TITLE, LETTER = 17.0, 44.0, 12
LANE_PIXELS = 7.0  # a metre across has at least that many
DASH = (3, 9)  # metres of paint and of a gap between lanes
PAUSE = Fraction(1)  # how long the last state stands, in s
MOST_STRIPS, DEEPEST = 9, 2
LONGEST = int(NAMES / 6.2)  # letters of a name
STEPS, MOST_TICKS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000), 12  # whole seconds between ticks


@dataclass(frozen=True)
class Rectangle:
    """Left, top, width and height at each instant, or once; ``red``: whether it is red, at each instant."""

    boxes: Sequence[data.Box]
    fill: str
    opacity: float = 1.0
    red: Sequence[bool] = ()


@dataclass(frozen=True)
class Line:
    """Between two points (x, x, y, y) at each instant, or once; ``dash``: pixels of each dash and gap."""

    ends: Sequence[data.Box]
    stroke: str
    dash: data.Span | None = None


@dataclass(frozen=True)
class Text:
    """A text that begins at a point, or has its middle there; the points at each instant, or once."""

    text: str
    places: Sequence[data.Span]
    fill: str = "#111111"
    size: int = LETTER
    middle: bool = False


@dataclass(frozen=True)
class Polygon:
    """The corners in pixels at each instant, or once; ``red``: whether it is red, at each instant."""

    outlines: Sequence[Points]
    fill: str
    opacity: float = 1.0
    red: Sequence[bool] = ()


@dataclass(frozen=True)
class Strokes:
    """Lines through points in pixels, the same at all instants."""

    lines: Sequence[Points]
    stroke: str


Shape: TypeAlias = Rectangle | Line | Text | Polygon | Strokes


class Shift(NamedTuple):
    """Pixels to the right and down, and after that ``turned`` degrees clockwise about ``Pavement.pivot``."""

    x: float
    y: float = 0.0
    turned: float = 0.0


@dataclass(frozen=True)
class Pavement:
    """Lanes that move by ``shifts``, one for each instant, and are seen in ``window``."""

    window: data.Box
    shapes: Sequence[Shape]
    shifts: tuple[Shift, ...]
    pivot: Point | None = None


@dataclass(frozen=True)
class Scene:
    """A drive that is shown, with what is computed of it once.

    ``width``, ``edge``, ``top``: pixels of the picture, its margin, and above the road; ``lane_pixels``: the
    least for a metre across; ``grain``: seconds between instants.
    """

    file: DriveFile
    library: Library
    width: float = WIDTH
    edge: float = EDGE
    top: float = TITLE
    lane_pixels: float = LANE_PIXELS
    grain: Fraction = data.GRAIN

    @cached_property
    def times(self) -> list[Fraction]:
        """The instants of the picture, in s."""
        return data.times_of(self.file, self.grain)

    @cached_property
    def states(self) -> dict[str, tuple[State, ...]]:
        """The states of each vehicle at these instants, SV first."""
        return {
            name: states_at(self.file.drive.vehicles[name], self.times)
            for name in data.vehicles_of(self.file)
        }

    @cached_property
    def colours(self) -> dict[str, str]:
        """A colour for each vehicle."""
        return dict(zip(self.states, COLOURS * len(self.states), strict=False))

    @cached_property
    def window(self) -> data.Span:
        """What is seen along the road, in m from SV's front."""
        return data.window_of(self.file, self.times)

    @cached_property
    def scale(self) -> tuple[float, float]:
        """Pixels for each metre along and across."""
        low, high = self.window
        along = (self.width - 2 * self.edge) / (high - low)
        return along, max(along, self.lane_pixels)

    @cached_property
    def across(self) -> data.Span:
        """Right and left edge of the road, in m."""
        return data.road_in(self.file.road, self.states[self.subject][0].s, self.window).across

    @property
    def subject(self) -> str:
        """The vehicle that the picture follows."""
        return next(iter(self.states))

    @cached_property
    def dangers(self) -> dict[str, tuple[data.Span, ...]]:
        """When the subject is in danger with each other vehicle, in s, where the library defines that."""
        others = [name for name in self.states if name != self.subject]
        spans = {name: data.danger_spans(self.file, self.library, self.subject, name) for name in others}
        return {name: x for name, x in spans.items() if x is not None}

    @cached_property
    def begins(self) -> float | None:
        """When the first danger begins, in s."""
        return min((spans[0][0] for spans in self.dangers.values() if spans), default=None)

    @property
    def still(self) -> int:
        """The instant that a viewer shows which does not play: the first in danger, else the first."""
        return next((k for k, time in enumerate(self.times) if float(time) >= (self.begins or 0)), 0)

    @property
    def lasts(self) -> Fraction:
        """A round of the picture, in s."""
        return self.times[-1] + PAUSE

    def pixels(self, box: data.Box) -> data.Box:
        """Left, top, width and height of a box in m along, from SV's front, and across."""
        left, right, bottom, top = box
        along, across = self.scale
        x, y = self.edge + (left - self.window[0]) * along, self.top + (self.across[1] - top) * across
        return x, y, (right - left) * along, (top - bottom) * across

    def box(self, name: str, k: int) -> data.Box:
        """A vehicle at an instant, in m along from SV's front, and across."""
        motion, state = self.file.drive.vehicles[name], self.states[name][k]
        s, d = float(state.s - self.states[self.subject][k].s), float(state.d)
        return s - float(motion.length), s, d - float(motion.width), d

    @cached_property
    def instants(self) -> range:
        """The numbers of the instants."""
        return range(len(self.times))

    @cached_property
    def travel(self) -> list[float]:
        """How far the subject has come at each instant, in m."""
        states = self.states[self.subject]
        return [float(state.s - states[0].s) for state in states]

    @cached_property
    def road(self) -> data.ShownRoad:
        """What of the road is seen, in m along from the front of the subject at the start, and across."""
        low, high = self.window
        seen = low + min(self.travel), high + max(self.travel)
        return data.road_in(self.file.road, self.states[self.subject][0].s, seen)

    @cached_property
    def distances(self) -> tuple[data.Distance, ...]:
        """Those of the subject from each other vehicle along the road."""
        return data.distances_of(self.file, self.library, "along", self.grain)

    @cached_property
    def envelopes(self) -> list["Envelope"]:
        """For each other vehicle, the area within RSS distances of the subject."""
        across = {x.other: x for x in data.distances_of(self.file, self.library, "across", self.grain)}
        found = []
        for along in self.distances:
            beside = across.get(along.other)
            if beside is not None:
                boxes = [_around(self.box(self.subject, k), along, beside, k) for k in self.instants]
                near = [
                    along.gap[k] <= along.needed[k] and beside.gap[k] <= beside.needed[k]
                    for k in self.instants
                ]
                found.append(Envelope(along.other, boxes, near))
        return found

    def pavement(self) -> Pavement:
        """The lanes, which move to the left as SV goes on."""
        _, top, _, height = window = self.pixels((*self.window, *self.across))
        dash = (DASH[0] * self.scale[0], DASH[1] * self.scale[0])
        shapes: list[Rectangle | Line] = []
        for zone, along, (right, beyond) in self.road.pieces:
            x, y, wide, high_ = box = self.pixels((*along, right, beyond))
            shapes.append(Rectangle([box], SHADES[zone]))
            for edge in (y, y + high_):
                inner = top + 1 < edge < top + height - 1
                shapes.append(Line([(x, x + wide, edge, edge)], "#888888", dash if inner else None))
        return Pavement(window, tuple(shapes), tuple(Shift(-x * self.scale[0]) for x in self.travel))

    def areas(self) -> Iterator[Shape]:
        """The area within RSS distances of SV, for each other vehicle; red while that vehicle is in it."""
        for x in self.envelopes:
            yield Rectangle([*map(self.pixels, x.boxes)], self.colours[x.other], 0.2, x.near)

    def vehicles(self) -> Iterator[Shape]:
        """The boxes, each with its name inside, or above where it is too short for that."""
        for name, colour in self.colours.items():
            boxes = [self.pixels(self.box(name, k)) for k in self.instants]
            yield Rectangle(boxes, colour)
            fits = boxes[0][2] >= 9 * len(name)
            places = [(x + w / 2, y + h / 2 + (4 if fits else -8)) for x, y, w, h in boxes]
            yield Text(name, places, "white" if fits else colour, size=11, middle=True)

    @cached_property
    def strips(self) -> list[data.Strip]:
        """The parts of the formula that have a row, with the times at which they are true."""
        judgement = judge_file(self.file, self.library).judgement
        strips = () if judgement is None else data.strips_of(judgement, self.file.horizon)
        return [x for x in strips if x.depth <= DEEPEST][:MOST_STRIPS]

    @property
    def road_height(self) -> float:
        """Pixels from the upper to the lower edge of the road."""
        return (self.across[1] - self.across[0]) * self.scale[1]

    @property
    def rows_begin(self) -> float:
        """Where the rows begin, below the road."""
        return self.top + self.road_height + 2 * ROW

    @property
    def height(self) -> float:
        """Pixels from top to bottom."""
        return self.rows_begin + ROW * (len(self.strips) + len(self.dangers) + 1) + EDGE


@dataclass(frozen=True)
class Envelope:
    """Where ``other`` is too near to the subject at each instant, in m as ``Scene.box`` is, and whether it
    is ``near``.
    """

    other: str
    boxes: Sequence[data.Box]
    near: Sequence[bool]


def headings(scene: Scene) -> Iterator[Text]:
    """The title, which is the scenario in words or the formula, and a legend."""
    yield Text(data.heading_of(scene.file, scene.library)[0], [(EDGE, 20)], size=14)
    told = [f"the view follows {scene.subject}"]
    if len(scene.states) > 1:
        told.append("shaded: within RSS distances, red if violated")
    if scene.begins is not None:
        told.append(f"danger begins at {scene.begins:.1f} s")
    yield Text("; ".join(told), [(EDGE, 37)], "#555555")
    error = length_error_of(scene.file.road)
    if error is not None:
        said = f"lengths differ by up to {float(100 * error.share):.2g} %, {float(error.metres):.2g} m"
        yield Text(said, [(EDGE, scene.rows_begin - 11)], "#555555", size=10)


def _around(box: data.Box, along: data.Distance, across: data.Distance, k: int) -> data.Box:
    """Where the other vehicle would be too near: from the box of SV as far as the RSS distances reach.

    Where a distance is negative, as that of a faster vehicle ahead can be, it reaches less far than the box.
    """
    left, right, bottom, top = box
    if along.one_behind[k]:
        right += along.needed[k]
    else:
        left -= along.needed[k]
    if across.one_behind[k]:
        top += across.needed[k]
    else:
        bottom -= across.needed[k]
    return left, max(left, right), bottom, max(bottom, top)


def rows(scene: Scene) -> Iterator[Shape]:
    """A row for each part and for danger, an axis of time, and a line that goes through all of them."""
    told = [(x.depth, x.name, x.spans, TRUE) for x in scene.strips]
    for other, spans in scene.dangers.items():
        told.append((0, f"danger between {scene.subject} and {other}", spans, DANGER))
    top = scene.rows_begin
    bottom = top + ROW * len(told)
    begin, end = EDGE + NAMES, WIDTH - EDGE
    pixels = (end - begin) / float(scene.file.horizon)
    for row, (depth, name, spans, colour) in enumerate(told):
        y = top + ROW * row
        yield Text(excerpt("\u2002" * depth + name, LONGEST), [(EDGE, y + 12)], "#333333", size=11)
        yield Line([(begin, end, y + 8, y + 8)], "#dddddd")
        for since, until in spans:
            x, width = begin + since * pixels, max(1.5, (until - since) * pixels)
            yield Rectangle([(x, y + 3, width, 10)], colour)
    step = next((x for x in STEPS if scene.file.horizon <= MOST_TICKS * x), STEPS[-1])
    for second in range(0, int(scene.file.horizon) + 1, step):
        place = (begin + second * pixels, bottom + 14)
        yield Text(f"{second} s", [place], "#555555", size=10, middle=True)
    if scene.begins is not None:
        x = begin + scene.begins * pixels
        yield Line([(x, x, top - 8, bottom)], DANGER, (4, 2))
        yield Text("danger begins", [(x, top - 11)], DANGER, size=11, middle=True)
    places = [begin + float(time) * pixels for time in scene.times]
    yield Line([(x, x, top - 4, bottom) for x in places], "#222222")
