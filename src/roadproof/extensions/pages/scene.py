"""The content of an animation of a drive: shapes in px at each instant, to be drawn as SVG or as frames.

The view follows SV. For each other vehicle an area around SV is shaded up to the RSS distances. It is red
while the vehicle is in it; if that lasts for ``minDanger``, there is danger. Below the road stands a row for
each part of the formula and for danger, with a line at the instant that is shown.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.extensions.pages import drive_data as data
from roadproof.extensions.pages.plane import Point
from roadproof.extensions.pages.shapes import LineShape, RectangleShape, Shape, TextShape
from roadproof.frontends.report.colours import COLOURS, DANGER, SHADES, TRUE
from roadproof.frontends.report.sheet import excerpt
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass
from roadproof.world.length_error import length_error_of
from roadproof.world.motion import State, states_at

WIDTH, EDGE, NAMES = 860.0, 14.0, 230.0  # pixels: the picture, its margin, the column of names
ROW, TITLE = 17.0, 44.0
LANE_PIXELS = 7.0  # a metre across has at least that many
DASH = (3, 9)  # metres of paint and of a gap between lanes
PAUSE = Fraction(1)  # how long the last state stands, in s
MOST_STRIPS, DEEPEST = 9, 2
LONGEST = int(NAMES / 6.2)  # letters of a name
STEPS, MOST_TICKS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000), 12  # whole seconds between ticks


class PavementShift(NamedTuple):
    """A shift to the right and down in px, then a turn by ``turned`` degrees clockwise about
    ``Pavement.pivot``.
    """

    x: float
    y: float = 0.0
    turned: float = 0.0


@dataclass(frozen=True)
class Pavement:
    """Lanes that move by ``shifts``, one for each instant, and are visible in ``window``."""

    window: data.Box
    shapes: Sequence[Shape]
    shifts: tuple[PavementShift, ...]
    pivot: Point | None = None


@dataclass(frozen=True)
class AnimationScene:
    """A drive to be animated, with everything that is computed from it once.

    ``width``, ``edge``, ``top``: px of the picture, its margin, and the space above the road;
    ``lane_pixels``: the least px of a metre across; ``grain``: seconds between instants.
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
        """The states of each vehicle at the instants, SV first."""
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
        """The visible span along the road, in m from SV's front."""
        return data.window_of(self.file, self.times)

    @cached_property
    def scale(self) -> tuple[float, float]:
        """Pixels per metre along and across."""
        low, high = self.window
        along = (self.width - 2 * self.edge) / (high - low)
        return along, max(along, self.lane_pixels)

    @cached_property
    def across(self) -> data.Span:
        """The right and left edge of the road, in m."""
        return data.road_in(self.file.road, self.states[self.subject][0].s, self.window).across

    @property
    def subject(self) -> str:
        """The vehicle that the picture follows."""
        return next(iter(self.states))

    @cached_property
    def dangers(self) -> dict[str, tuple[data.Span, ...]]:
        """The spans (s) of danger between the subject and each other vehicle, where the library defines
        danger.
        """
        others = [name for name in self.states if name != self.subject]
        spans = {name: data.danger_spans(self.file, self.library, self.subject, name) for name in others}
        return {name: x for name, x in spans.items() if x is not None}

    @cached_property
    def begins(self) -> float | None:
        """The instant at which the first danger begins, in s."""
        return min((spans[0][0] for spans in self.dangers.values() if spans), default=None)

    @property
    def still(self) -> int:
        """The number of the instant that a viewer without animation shows: the first in danger, else the
        first.
        """
        return next((k for k, time in enumerate(self.times) if float(time) >= (self.begins or 0)), 0)

    @property
    def duration(self) -> Fraction:
        """The duration of one loop of the picture, in s."""
        return self.times[-1] + PAUSE

    def pixels(self, box: data.Box) -> data.Box:
        """Return left, top, width and height in px of a box in m, along from SV's front and across."""
        left, right, bottom, top = box
        along, across = self.scale
        x, y = self.edge + (left - self.window[0]) * along, self.top + (self.across[1] - top) * across
        return x, y, (right - left) * along, (top - bottom) * across

    def box(self, name: str, k: int) -> data.Box:
        """Return a vehicle's box at instant ``k``, in m along from SV's front and across."""
        motion, state = self.file.drive.vehicles[name], self.states[name][k]
        s, d = float(state.s - self.states[self.subject][k].s), float(state.d)
        return s - float(motion.length), s, d - float(motion.width), d

    @cached_property
    def instants(self) -> range:
        """The numbers of the instants."""
        return range(len(self.times))

    @cached_property
    def travel(self) -> list[float]:
        """The distance that the subject has covered at each instant, in m."""
        states = self.states[self.subject]
        return [float(state.s - states[0].s) for state in states]

    @cached_property
    def road(self) -> data.ShownRoad:
        """The visible part of the road, in m along from the subject's front at the start, and across."""
        low, high = self.window
        seen = low + min(self.travel), high + max(self.travel)
        return data.road_in(self.file.road, self.states[self.subject][0].s, seen)

    @cached_property
    def distances(self) -> tuple[data.Distance, ...]:
        """The distances from the subject to each other vehicle along the road."""
        return data.distances_of(self.file, self.library, "along", self.grain)

    @cached_property
    def envelopes(self) -> "list[Envelope]":
        """The area within RSS distances of the subject, for each other vehicle."""
        across = {x.other: x for x in data.distances_of(self.file, self.library, "across", self.grain)}
        envelopes = []
        for along in self.distances:
            beside = across.get(along.other)
            if beside is not None:
                boxes = [_envelope_box(self.box(self.subject, k), along, beside, k) for k in self.instants]
                near = [
                    along.gap[k] <= along.needed[k] and beside.gap[k] <= beside.needed[k]
                    for k in self.instants
                ]
                envelopes.append(Envelope(along.other, boxes, near))
        return envelopes

    def pavement(self) -> Pavement:
        """Return the lanes, which move to the left as SV drives on."""
        _, top, _, height = window = self.pixels((*self.window, *self.across))
        dash = (DASH[0] * self.scale[0], DASH[1] * self.scale[0])
        shapes: list[RectangleShape | LineShape] = []
        for zone, along, (right, beyond) in self.road.pieces:
            x, y, wide, high_ = box = self.pixels((*along, right, beyond))
            shapes.append(RectangleShape([box], SHADES[zone]))
            for edge in (y, y + high_):
                inner = top + 1 < edge < top + height - 1
                shapes.append(LineShape([(x, x + wide, edge, edge)], "#888888", dash if inner else None))
        return Pavement(window, tuple(shapes), tuple(PavementShift(-x * self.scale[0]) for x in self.travel))

    def areas(self) -> Iterator[Shape]:
        """Yield the area within RSS distances of SV, for each other vehicle; red while that
        vehicle is in it.
        """
        for x in self.envelopes:
            yield RectangleShape([*map(self.pixels, x.boxes)], self.colours[x.other], 0.2, x.near)

    def vehicles(self) -> Iterator[Shape]:
        """Yield the vehicles, each with its name inside, or above where it does not fit."""
        for name, colour in self.colours.items():
            boxes = [self.pixels(self.box(name, k)) for k in self.instants]
            yield RectangleShape(boxes, colour)
            fits = boxes[0][2] >= 9 * len(name)
            places = [(x + w / 2, y + h / 2 + (4 if fits else -8)) for x, y, w, h in boxes]
            yield TextShape(name, places, "white" if fits else colour, size=11, anchor="middle")

    @cached_property
    def strips(self) -> list[data.Strip]:
        """The parts of the formula that have a row, with the times at which they are true."""
        judgement = judge_file(self.file, self.library).judgement
        strips = () if judgement is None else data.strips_of(judgement, self.file.horizon)
        return [x for x in strips if x.depth <= DEEPEST][:MOST_STRIPS]

    @property
    def road_height(self) -> float:
        """The height of the road in px."""
        return (self.across[1] - self.across[0]) * self.scale[1]

    @property
    def rows_begin(self) -> float:
        """The y at which the rows below the road begin, in px."""
        return self.top + self.road_height + 2 * ROW

    @property
    def height(self) -> float:
        """The height of the picture in px."""
        return self.rows_begin + ROW * (len(self.strips) + len(self.dangers) + 1) + EDGE


@dataclass(frozen=True)
class Envelope:
    """The area in which ``other`` is too near to the subject, at each instant (m, as ``AnimationScene.box``).

    ``near``: whether the other vehicle is in it.
    """

    other: str
    boxes: Sequence[data.Box]
    near: Sequence[bool]


def headings(scene: AnimationScene) -> Iterator[TextShape]:
    """Yield the title, which is the scenario in words or the formula, and a legend."""
    yield TextShape(data.heading_of(scene.file, scene.library)[0], [(EDGE, 20)], size=14)
    notes = [f"the view follows {scene.subject}"]
    if len(scene.states) > 1:
        notes.append("shaded: within RSS distances, red if violated")
    if scene.begins is not None:
        notes.append(f"danger begins at {scene.begins:.1f} s")
    yield TextShape("; ".join(notes), [(EDGE, 37)], "#555555")
    error = length_error_of(scene.file.road)
    if error is not None:
        length_note = f"lengths differ by up to {float(100 * error.share):.2g} %, {float(error.metres):.2g} m"
        yield TextShape(length_note, [(EDGE, scene.rows_begin - 11)], "#555555", size=10)


def _envelope_box(box: data.Box, along: data.Distance, across: data.Distance, k: int) -> data.Box:
    """Return the box in which the other vehicle would be too near: SV's box, extended by the RSS distances.

    A negative distance, as to a faster vehicle ahead, makes it smaller than SV's box.
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


def timeline_rows(scene: AnimationScene) -> Iterator[Shape]:
    """Yield a row for each part and for danger, an axis of time, and a line at the present instant."""
    entries = [(x.depth, x.name, x.spans, TRUE) for x in scene.strips]
    for other, spans in scene.dangers.items():
        entries.append((0, f"danger between {scene.subject} and {other}", spans, DANGER))
    top = scene.rows_begin
    bottom = top + ROW * len(entries)
    begin, end = EDGE + NAMES, WIDTH - EDGE
    pixels = (end - begin) / float(scene.file.horizon)
    for row, (depth, name, spans, colour) in enumerate(entries):
        y = top + ROW * row
        yield TextShape(excerpt("\u2002" * depth + name, LONGEST), [(EDGE, y + 12)], "#333333", size=11)
        yield LineShape([(begin, end, y + 8, y + 8)], "#dddddd")
        for since, until in spans:
            x, width = begin + since * pixels, max(1.5, (until - since) * pixels)
            yield RectangleShape([(x, y + 3, width, 10)], colour)
    step = next((x for x in STEPS if scene.file.horizon <= MOST_TICKS * x), STEPS[-1])
    for second in range(0, int(scene.file.horizon) + 1, step):
        place = (begin + second * pixels, bottom + 14)
        yield TextShape(f"{second} s", [place], "#555555", size=10, anchor="middle")
    if scene.begins is not None:
        x = begin + scene.begins * pixels
        yield LineShape([(x, x, top - 8, bottom)], DANGER, (4, 2))
        yield TextShape("danger begins", [(x, top - 11)], DANGER, size=11, anchor="middle")
    places = [begin + float(time) * pixels for time in scene.times]
    yield LineShape([(x, x, top - 4, bottom) for x in places], "#222222")
