"""A moving picture of a drive: the road from above, the RSS distances around SV, and what is true when.

It is one SVG file that a browser plays without scripts. The view follows SV. For each other vehicle an area
around SV is shaded up to the RSS distances. It is red while the vehicle is in it; if that lasts for
``minDanger``, there is danger.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from xml.etree.ElementTree import Element

from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.frontends.report.drive import COLOURS, DANGER, SHADES, TRUE
from roadproof.frontends.report.drive_data import (
    GRAIN,
    Box,
    Distance,
    ShownRoad,
    Span,
    Strip,
    danger_spans,
    distances_of,
    heading_of,
    road_in,
    strips_of,
    times_of,
    vehicles_of,
    window_of,
)
from roadproof.frontends.report.sheet import excerpt
from roadproof.library.specification import Library
from roadproof.recordings.export.xml import document, element
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
class Scene:
    """A drive that is shown, with what is computed of it once.

    ``width``, ``edge``, ``top``: pixels of the picture, its margin, and above the road; ``lane_pixels``: the
    least for a metre across.
    """

    file: DriveFile
    library: Library
    width: float = WIDTH
    edge: float = EDGE
    top: float = TITLE
    lane_pixels: float = LANE_PIXELS

    @cached_property
    def times(self) -> list[Fraction]:
        """The instants of the picture, in s."""
        return times_of(self.file)

    @cached_property
    def states(self) -> dict[str, tuple[State, ...]]:
        """The states of each vehicle at these instants, SV first."""
        return {
            name: states_at(self.file.drive.vehicles[name], self.times) for name in vehicles_of(self.file)
        }

    @cached_property
    def colours(self) -> dict[str, str]:
        """A colour for each vehicle."""
        return dict(zip(self.states, COLOURS * len(self.states), strict=False))

    @cached_property
    def window(self) -> Span:
        """What is seen along the road, in m from SV's front."""
        return window_of(self.file, self.times)

    @cached_property
    def scale(self) -> tuple[float, float]:
        """Pixels for each metre along and across."""
        low, high = self.window
        along = (self.width - 2 * self.edge) / (high - low)
        return along, max(along, self.lane_pixels)

    @cached_property
    def across(self) -> Span:
        """Right and left edge of the road, in m."""
        return road_in(self.file.road, self.states[self.subject][0].s, self.window).across

    @property
    def subject(self) -> str:
        """The vehicle that the picture follows."""
        return next(iter(self.states))

    @cached_property
    def dangers(self) -> dict[str, tuple[Span, ...]]:
        """When the subject is in danger with each other vehicle, in s, where the library defines that."""
        others = [name for name in self.states if name != self.subject]
        spans = {name: danger_spans(self.file, self.library, self.subject, name) for name in others}
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

    def pixels(self, box: Box) -> Box:
        """Left, top, width and height of a box in m along, from SV's front, and across."""
        left, right, bottom, top = box
        along, across = self.scale
        x, y = self.edge + (left - self.window[0]) * along, self.top + (self.across[1] - top) * across
        return x, y, (right - left) * along, (top - bottom) * across

    def box(self, name: str, k: int) -> Box:
        """A vehicle at an instant, in m along from SV's front, and across."""
        motion, state = self.file.drive.vehicles[name], self.states[name][k]
        s, d = float(state.s - self.states[self.subject][k].s), float(state.d)
        return s - float(motion.length), s, d - float(motion.width), d

    @cached_property
    def travel(self) -> list[float]:
        """How far the subject has come at each instant, in m."""
        states = self.states[self.subject]
        return [float(state.s - states[0].s) for state in states]

    @cached_property
    def road(self) -> ShownRoad:
        """What of the road is seen, in m along from the front of the subject at the start, and across."""
        low, high = self.window
        seen = low + min(self.travel), high + max(self.travel)
        return road_in(self.file.road, self.states[self.subject][0].s, seen)

    @cached_property
    def distances(self) -> tuple[Distance, ...]:
        """Those of the subject from each other vehicle along the road."""
        return distances_of(self.file, self.library, "along")

    @cached_property
    def envelopes(self) -> list["Envelope"]:
        """For each other vehicle, the area within RSS distances of the subject."""
        across = {x.other: x for x in distances_of(self.file, self.library, "across")}
        instants = range(len(self.times))
        found = []
        for along in self.distances:
            beside = across.get(along.other)
            if beside is not None:
                boxes = [_around(self.box(self.subject, k), along, beside, k) for k in instants]
                near = [
                    along.gap[k] <= along.needed[k] and beside.gap[k] <= beside.needed[k] for k in instants
                ]
                found.append(Envelope(along.other, [*map(self.pixels, boxes)], near))
        return found


@dataclass(frozen=True)
class Envelope:
    """Where ``other`` is too near to the subject at each instant, in pixels, and whether it is ``near``."""

    other: str
    boxes: Sequence[Box]
    near: Sequence[bool]


def draw_moving(file: DriveFile, library: Library, title: str = "") -> bytes:
    """The moving picture of a drive as SVG; the title is its scenario in words, or its formula."""
    scene = Scene(file, library)
    judgement = judge_file(file, library).judgement
    strips = () if judgement is None else strips_of(judgement, file.horizon)
    shown = [x for x in strips if x.depth <= DEEPEST][:MOST_STRIPS]
    road_ends = TITLE + (scene.across[1] - scene.across[0]) * scene.scale[1]
    below = road_ends + 2 * ROW
    height = below + ROW * (len(shown) + len(scene.dangers) + 1) + EDGE
    root = element(
        "svg",
        element("rect", width="100%", height="100%", fill="white"),
        _text(title or heading_of(file, library)[0], EDGE, 20, size=14),
        _text(_legend(scene), EDGE, 37, fill="#555555"),
        *_road(scene),
        *_vehicles(scene),
        *_over_time(scene, shown, below),
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {WIDTH:g} {height:g}",
        width=f"{WIDTH:g}",
        height=f"{height:g}",
        **{"font-family": "Helvetica, Arial, sans-serif"},
    )
    return document(root)


def _legend(scene: Scene) -> str:
    told = [f"the view follows {scene.subject}"]
    if len(scene.states) > 1:
        told.append("shaded: within RSS distances, red if violated")
    if scene.begins is not None:
        told.append(f"danger begins at {scene.begins:.1f} s")
    return "; ".join(told)


# --- the road from above ------------------------------------------------------------------------


def _road(scene: Scene) -> Iterator[Element]:
    """The lanes, which move to the left as SV goes on, and RSS distances; both end at the window."""
    low, high = scene.window
    left, top, width, height = scene.pixels((low, high, *scene.across))
    cut = element("rect", x=_n(left), y=_n(top), width=_n(width), height=_n(height))
    yield element("clipPath", cut, id="window")
    pieces: list[Element] = []
    for zone, along, (right, beyond) in scene.road.pieces:
        x, y, wide, high_ = scene.pixels((*along, right, beyond))
        pieces.append(element("rect", x=_n(x), y=_n(y), width=_n(wide), height=_n(high_), fill=SHADES[zone]))
        for edge in (y, y + high_):
            dash = " ".join(_n(x * scene.scale[0]) for x in DASH) if top + 1 < edge < top + height - 1 else ""
            pieces.append(_line((x, edge), (x + wide, edge), "#888888", dash))
    shift = [-x * scene.scale[0] for x in scene.travel]
    moved = element("g", *pieces, _moved(scene, shift), transform=f"translate({_n(shift[scene.still])} 0)")
    yield element("g", moved, *_envelopes(scene), **{"clip-path": "url(#window)"})


def _vehicles(scene: Scene) -> Iterator[Element]:
    """The boxes, each with its name inside, or above where it is too short for that."""
    for name, colour in scene.colours.items():
        boxes = [scene.pixels(scene.box(name, k)) for k in range(len(scene.times))]
        yield _moving_box(scene, boxes, colour)
        fits = boxes[0][2] >= 9 * len(name)
        places = [(x + w / 2, y + h / 2 + (4 if fits else -8)) for x, y, w, h in boxes]
        label = _text(name, *places[scene.still], "white" if fits else colour, size=11, middle=True)
        label.extend(_animated(scene, {"x": [x for x, _ in places], "y": [y for _, y in places]}))
        yield label


def _envelopes(scene: Scene) -> Iterator[Element]:
    """The area within RSS distances of SV, for each other vehicle; red while that vehicle is in it."""
    for x in scene.envelopes:
        area = _moving_box(scene, x.boxes, scene.colours[x.other])
        area.attrib |= {"fill-opacity": "0.2"}
        area.append(_switched(scene, x.near, DANGER, scene.colours[x.other]))
        yield area


def _around(box: Box, along: Distance, across: Distance, k: int) -> Box:
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


# --- over time ----------------------------------------------------------------------------------


def _over_time(scene: Scene, strips: Sequence[Strip], top: float) -> Iterator[Element]:
    """A row for each part and for danger, an axis of time, and a line that goes through all of them."""
    rows = [(x.depth, x.name, x.spans, TRUE) for x in strips]
    for other, spans in scene.dangers.items():
        rows.append((0, f"danger between {scene.subject} and {other}", spans, DANGER))
    bottom = top + ROW * len(rows)
    begin, end = EDGE + NAMES, WIDTH - EDGE
    pixels = (end - begin) / float(scene.file.horizon)
    for row, (depth, name, spans, colour) in enumerate(rows):
        y = top + ROW * row
        yield _text(excerpt("\u2002" * depth + name, LONGEST), EDGE, y + 12, fill="#333333", size=11)
        yield _line((begin, y + 8), (end, y + 8), "#dddddd")
        for since, until in spans:
            x, width = begin + since * pixels, max(1.5, (until - since) * pixels)
            yield element("rect", x=_n(x), y=_n(y + 3), width=_n(width), height="10", fill=colour)
    step = next((x for x in STEPS if scene.file.horizon <= MOST_TICKS * x), STEPS[-1])
    for second in range(0, int(scene.file.horizon) + 1, step):
        yield _text(f"{second} s", begin + second * pixels, bottom + 14, fill="#555555", size=10, middle=True)
    if scene.begins is not None:
        x = begin + scene.begins * pixels
        yield _line((x, top - 8), (x, bottom), DANGER, "4 2")
        yield _text("danger begins", x, top - 11, DANGER, size=11, middle=True)
    places = [begin + float(time) * pixels for time in scene.times]
    cursor = _line((places[scene.still], top - 4), (places[scene.still], bottom), "#222222")
    cursor.extend(_animated(scene, {"x1": places, "x2": places}))
    yield cursor


# --- shapes and their changes -------------------------------------------------------------------


def _n(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")


def _text(
    text: str, x: float, y: float, fill: str = "#111111", size: int = LETTER, middle: bool = False
) -> Element:
    """A text that begins at ``x``, or has its middle there."""
    anchor = {"text-anchor": "middle"} if middle else {}
    return element("text", text=text, x=_n(x), y=_n(y), fill=fill, **{"font-size": str(size)}, **anchor)


def _line(begin: Span, end: Span, stroke: str, dash: str = "") -> Element:
    """A line between two points, dashed where the lengths of dash and gap are given."""
    ends = {"x1": _n(begin[0]), "x2": _n(end[0]), "y1": _n(begin[1]), "y2": _n(end[1])}
    return element("line", **ends, stroke=stroke, **({"stroke-dasharray": dash} if dash else {}))


def _moving_box(scene: Scene, boxes: Sequence[Box], fill: str) -> Element:
    names = ("x", "y", "width", "height")
    made = element("rect", **{n: _n(v) for n, v in zip(names, boxes[scene.still], strict=True)}, fill=fill)
    made.extend(_animated(scene, {n: [box[k] for box in boxes] for k, n in enumerate(names)}))
    return made


def _animated(scene: Scene, values: Mapping[str, Sequence[float]]) -> Iterator[Element]:
    """The changes of attributes that change, as the instants have them."""
    for name, numbers in values.items():
        if len({_n(x) for x in numbers}) > 1:
            yield element("animate", attributeName=name, values=_played(numbers), **_clock(scene))


def _moved(scene: Scene, shift: Sequence[float]) -> Element:
    clock = _clock(scene)
    return element(
        "animateTransform", attributeName="transform", type="translate", values=_played(shift), **clock
    )


def _played(numbers: Sequence[float]) -> str:
    """The values of a round: the last stands for the pause."""
    return ";".join(map(_n, [*numbers, *[numbers[-1]] * int(PAUSE / GRAIN)]))


def _switched(scene: Scene, flags: Sequence[bool], within: str, outside: str) -> Element:
    """The fill of a shape: one colour at instants where a flag is set, another elsewhere."""
    changes = [k for k, flag in enumerate(flags) if k == 0 or flag != flags[k - 1]]
    return element(
        "animate",
        attributeName="fill",
        calcMode="discrete",
        keyTimes=";".join(f"{float(scene.times[k] / scene.lasts):.4f}" for k in changes),
        values=";".join(within if flags[k] else outside for k in changes),
        **_clock(scene),
    )


def _clock(scene: Scene) -> dict[str, str]:
    return {"dur": f"{float(scene.lasts):g}s", "repeatCount": "indefinite"}
