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
from roadproof.extensions.pages.labels import PlacedLabel, place_labels
from roadproof.extensions.pages.letters import lines_of, width_of
from roadproof.extensions.pages.plane import Point
from roadproof.extensions.pages.shapes import LETTER, LineShape, RectangleShape, Shape, TextShape
from roadproof.frontends.report.colours import COLOURS, SHADES
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass
from roadproof.world.motion import State, states_at

WIDTH, EDGE, NAMES = 860.0, 14.0, 230.0  # pixels: the picture, its margin, the column of names
ROW, LINE, ARROW = 17.0, 17.0, 150.0  # pixels: of a part, of a line of the heading, of the driving direction
HEADING, NAME, ABOVE = 14, 11, 16.0  # letters of the title and of names; the room for names beside the road
LANE_PIXELS = 7.0  # a metre across has at least that many
DASH = (3, 9)  # metres of paint and of a gap between lanes
PAUSE = Fraction(1)  # how long the last state stands, in s
MOST_STRIPS, DEEPEST = 9, 2


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

    ``width``, ``edge``: px of the picture and its margin; ``above``: of the space above the road, if it has
    no title;
    ``lane_pixels``: the least px of a metre across; ``grain``: seconds between instants.
    """

    file: DriveFile
    library: Library
    width: float = WIDTH
    edge: float = EDGE
    above: float | None = None
    lane_pixels: float = LANE_PIXELS
    grain: Fraction = data.GRAIN

    @cached_property
    def title(self) -> list[str]:
        """The lines of the title: the scenario in words, or the formula."""
        whole = data.heading_of(self.file, self.library)[0]
        return lines_of(whole, self.width - 2 * self.edge, HEADING)

    @cached_property
    def notes(self) -> list[str]:
        """The lines below the title: what is seen, and when danger begins."""
        notes = [f"the view follows {self.subject}"]
        if len(self.states) > 1:
            notes.append("shaded: within RSS distances, red if violated")
        if self.begins is not None:
            notes.append(f"danger begins at {self.begins:.1f} s")
        return lines_of("; ".join(notes), self.width - 2 * self.edge - ARROW, LETTER)

    @cached_property
    def top(self) -> float:
        """The y at which the road begins, in px."""
        if self.above is not None:
            return self.above
        return EDGE + LINE * (len(self.title) + len(self.notes)) + ABOVE

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
        """Yield the vehicles, then their names inside or beside them."""
        for name, colour in self.colours.items():
            yield RectangleShape([self.pixels(self.box(name, k)) for k in self.instants], colour)
        yield from self.names()

    def names(self) -> Iterator[TextShape]:
        """Yield the names of the vehicles: on no other name, and within the picture at all times."""
        for name, placed in self.labels(NAME).items():
            colour = "white" if placed.is_inside else self.colours[name]
            places = [_baseline(x) for x in placed.boxes]
            before = {k: _baseline(x) for k, x in placed.before.items()}
            yield TextShape(name, places, colour, NAME, "middle", before)

    def labels(self, letter: float, least: float = 0.0, inside: bool = True) -> dict[str, PlacedLabel]:
        """Return the places of the names of vehicles in letters of a size (px).

        ``least``: the least length of a vehicle that is drawn (px); ``inside``: whether names may be inside.
        """
        sizes = {name: (width_of(name, letter) + letter / 2, letter + 1.0) for name in self.states}
        room = min(ABOVE, self.top)
        within = self.edge, self.width - self.edge, self.top - room, self.top + self.road_height + room
        return place_labels(self.tracks(least), sizes, within, inside)

    def tracks(self, least: float = 0.0) -> dict[str, list[data.Box]]:
        """Return the boxes (left, right, top, bottom; px) of each vehicle at all instants, as drawn."""
        tracks = dict[str, list[data.Box]]()
        for name in self.states:
            boxes = [self.pixels(self.box(name, k)) for k in self.instants]
            tracks[name] = [
                (x + wide - max(wide, least), x + wide, y, y + high) for x, y, wide, high in boxes
            ]
        return tracks

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


def _baseline(box: data.Box) -> data.Span:
    """Return where the middle of a name is written whose box is given."""
    left, right, _, bottom = box
    return (left + right) / 2, bottom - 2.5


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
