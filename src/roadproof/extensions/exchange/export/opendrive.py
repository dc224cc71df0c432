"""A road in OpenDRIVE 1.7: one straight road with a lane section wherever lanelets begin or end.

The reference line is the left edge of the leftmost lanelet, so that all lanes lie to its right and drive
along it; x = s and y = d. A merge lane is an ``entry`` lane, a departure lane an ``exit`` lane. What
OpenDRIVE has no word for, the lane and the zone of a lanelet, is in its ``userData``.

A road that is from a map in OpenDRIVE is exported as that map, byte for byte. From another map it has that
map's reference line, as cubics, and its s from where the drive needs the road.
"""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from math import ceil

from roadproof.extensions.exchange.export import plan_view
from roadproof.extensions.exchange.export.subject import (
    WRITTEN,
    ExportSubject,
    RoadCut,
    Section,
    allow_lane_change,
    monotone_starts,
)
from roadproof.extensions.exchange.export.user_map import checked_map, map_path
from roadproof.extensions.maps.xml_writer import Element, document, element
from roadproof.frontends.report.numbers import decimal
from roadproof.world.motion import state_at
from roadproof.world.road import Attribute, Lanelet

_TYPES: Mapping[Attribute, str] = {"main": "driving", "merge": "entry", "departure": "exit"}
_GAP = "none"
BESIDE, RAMP, HIGHEST_STEP = Fraction(1, 4), Fraction(1), Fraction(1, 2)
"""Metres: between the reference line and lanes with steps; in which an edge goes from one place to the next;
and how far that is at most, as ends of lanes are no steps.
"""
ENDING = ".xodr"
SPEED = 130
"""The speed limit in km/h, which our roads do not have: the recommended speed of German motorways."""


def files(subject: ExportSubject) -> dict[str, bytes]:
    """NAME.xodr, or the map of the road. Raises ``InputError`` for roads that have no lanes side by side."""
    path = checked_map(subject, ENDING)
    return {file_name(subject): road_file(subject) if path is None else path.read_bytes()}


def file_name(subject: ExportSubject) -> str:
    """Return the name of the road's file: NAME.xodr, or the name of the map that it comes from."""
    path = map_path(subject.file.road, ENDING)
    return f"{subject.name}.xodr" if path is None else path.name


def road_file(subject: ExportSubject) -> bytes:
    """The road of the drive, as far as the drive goes."""
    layout = subject.layout
    left = max(x.d[1] for x in layout.road.lanelets) + (BESIDE if _has_steps(layout) else 0)
    right = min(x.d[0] for x in layout.road.lanelets)
    header = element(
        "header",
        revMajor="1",
        revMinor="7",
        name=layout.cut_note,
        version="1",
        date=f"{WRITTEN}T00:00:00",
        north=decimal(left),
        south=decimal(right),
        east=decimal(layout.high),
        west=decimal(layout.low),
        vendor="roadproof",
    )
    return document(element("OpenDRIVE", header, _road(layout, left, _speed_limit(subject))))


def _speed_limit(subject: ExportSubject) -> int:
    """km/h: ``SPEED``, or the next ten above the fastest vehicle where one is faster."""
    horizon = subject.file.horizon
    speeds = [state_at(x, horizon).v_lon for x in subject.vehicles.values()]
    for motion in subject.vehicles.values():
        speeds += [x.v_lon for x in monotone_starts(motion) if x.time <= horizon]
    return max(SPEED, 10 * ceil(max(speeds) * Fraction(36, 100)))


def _road(layout: RoadCut, left: Fraction, limit: int) -> Element:
    line = layout.road.line
    if line is None:
        plan, offset = plan_view.straight(layout.low, layout.high, left), []
    else:
        plan = plan_view.along(line, layout.low, layout.high)
        offset = [element("laneOffset", s="0", a=decimal(left), b="0", c="0", d="0")]
    kind = element("type", element("speed", max=str(limit), unit="km/h"), s="0", type="motorway")
    sections = list(_sections(layout, left, limit))
    return element(
        "road",
        kind,
        plan,
        element("lanes", *offset, *sections),
        name=layout.road.name,
        length=decimal(layout.high - layout.low),
        id="1",
        junction="-1",
        rule="RHT",
    )


def _has_steps(layout: RoadCut) -> bool:
    """Return whether lanes of a map go on with other edges; other tools want edges without steps."""
    if layout.road.line is None:
        return False
    lanes = [{x.lane: x.d for x in section.lanelets} for section in layout.sections]
    return any(a[x] != b[x] for a, b in pairwise(lanes) for x in a.keys() & b.keys())


def _initial_widths(
    strips: Sequence[tuple[Lanelet | None, Fraction]], before: Section | None, left: Fraction
) -> list[Fraction]:
    """Widths where a section begins: edges are where lanes of the section before have them."""
    known = {} if before is None else {x.lane: x.d for x in before.lanelets}
    edges, own = [left], left
    for (lanelet, width), (following, _) in zip(strips, [*strips[1:], (None, 0)], strict=True):
        own -= width
        edge = own
        if lanelet is not None and lanelet.lane in known:
            edge = known[lanelet.lane][0]
        elif following is not None and following.lane in known:
            edge = known[following.lane][1]
        edges.append(edge if abs(edge - own) <= HIGHEST_STEP and edge < edges[-1] else own)
    return [a - b for a, b in pairwise(edges)]


def _sections(layout: RoadCut, left: Fraction, limit: int) -> Iterator[Element]:
    strips = [_strips(section, left) for section in layout.sections]
    steps = _has_steps(layout)
    numbers = [{x: -k for k, (x, _) in enumerate(each, 1) if x is not None} for each in strips]
    linked = [{x.lane: number for x, number in each.items()} for each in numbers]
    around = [{}, *linked, {}]
    for k, section in enumerate(layout.sections):
        lanes = []
        begins = _initial_widths(strips[k], layout.sections[k - 1] if k and steps else None, left)
        ramp = min(RAMP, (section.high - section.low) / 2)
        for place, (lanelet, width) in enumerate(strips[k]):
            neighbour = strips[k][place + 1][0] if place + 1 < len(strips[k]) else None
            marked = _right_marking(lanelet, neighbour, layout)
            before = None if lanelet is None else around[k].get(lanelet.lane)
            after = None if lanelet is None else around[k + 2].get(lanelet.lane)
            widths = _widths(begins[place], width, ramp)
            lanes.append(_lane(-place - 1, lanelet, widths, marked, (before, after), limit))
        first = strips[k][0][0]
        middle = element(
            "lane", _road_mark("none" if first is None else "solid"), id="0", type="none", level="false"
        )
        yield element(
            "laneSection",
            element("center", middle),
            element("right", *lanes),
            s=decimal(section.low - layout.low),
        )


def _strips(section: Section, left: Fraction) -> list[tuple[Lanelet | None, Fraction]]:
    """Lanelets from the reference line to the right with their widths, None for what lies between them."""
    strips: list[tuple[Lanelet | None, Fraction]] = []
    edge = left
    for lanelet in section.lanelets:
        if lanelet.d[1] < edge:
            strips.append((None, edge - lanelet.d[1]))
        strips.append((lanelet, lanelet.d[1] - lanelet.d[0]))
        edge = lanelet.d[0]
    return strips


def _right_marking(lanelet: Lanelet | None, right: Lanelet | None, layout: RoadCut) -> str:
    """The marking on the right of a strip."""
    if lanelet is None and right is None:
        return "none"
    if lanelet is None or right is None:
        return "solid"
    return "broken" if allow_lane_change(lanelet, right, layout.road) else "solid"


def _road_mark(kind: str) -> Element:
    if kind == "none":
        return element("roadMark", sOffset="0", type="none", color="standard", laneChange="none")
    change = "both" if kind == "broken" else "none"
    mark = {"type": kind, "weight": "standard", "color": "standard", "width": "0.15", "laneChange": change}
    return element("roadMark", sOffset="0", **mark)


def _widths(begin: Fraction, width: Fraction, ramp: Fraction) -> list[Element]:
    """The width of a lane, which it has at once, or after some metres in which it grows or falls."""
    whole = {"a": decimal(width), "b": "0", "c": "0", "d": "0"}
    if begin == width:
        return [element("width", sOffset="0", **whole)]
    grows = {"a": decimal(begin), "b": decimal((width - begin) / ramp), "c": "0", "d": "0"}
    return [element("width", sOffset="0", **grows), element("width", sOffset=decimal(ramp), **whole)]


def _lane(
    number: int,
    lanelet: Lanelet | None,
    widths: list[Element],
    marking: str,
    links: tuple[int | None, int | None],
    limit: int,
) -> Element:
    parts = []
    ends = zip(("predecessor", "successor"), links, strict=True)
    linked = [element(tag, id=str(end)) for tag, end in ends if end is not None]
    if linked:
        parts.append(element("link", *linked))
    parts += widths
    parts.append(_road_mark(marking))
    if lanelet is not None:
        parts.append(element("speed", sOffset="0", max=str(limit), unit="km/h"))
        user_data = {"lane": lanelet.lane, "zone": lanelet.zone}
        parts += [element("userData", code=f"roadproof:{code}", value=x) for code, x in user_data.items()]
    kind = _GAP if lanelet is None else _TYPES[lanelet.attribute]
    return element("lane", *parts, id=str(number), type=kind, level="false")
