"""Roads of a map in OpenDRIVE (ASAM, 1.4 to 1.8): reference line, lane sections with widths, links.

Elevation and superelevation are left out, as s is measured in plan. Of a lane its width or
border, its type and its links are read; of a road its traffic rule and whether it is part of a junction.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.errors import InputError
from roadproof.extensions.maps.harmless import OPENDRIVE, OPENDRIVE_FILE
from roadproof.extensions.maps.xml_reader import Element, parts_not_read, read_xml, summary_of
from roadproof.world.curves import Coefficients, Cubic, Curve, Line, Spiral
from roadproof.world.reference_line import Part, ReferenceLine
from roadproof.world.road import Zone

ZONE = "roadproof:zone"
"""The code of the ``userData`` of a lane whose value is its zone."""
ZONES: tuple[Zone, ...] = ("main", "merge", "depart")
Rule: TypeAlias = Literal["RHT", "LHT"]
_RULES: Mapping[str, Rule] = {"RHT": "RHT", "LHT": "LHT"}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?0*\d{1,2})?")
_ZERO = Fraction(0)
_MOST = 10_000
_TOLERANCE = Fraction(1, 10**3)
"""Metres between the end of a geometry and the beginning of the next one."""
_LENGTH_TOLERANCE = Fraction(1, 2)
"""Metres between the end of the last geometry, where a road ends, and the length that the road states."""


@dataclass(frozen=True)
class CubicPiece:
    """A cubic a + b·x + c·x² + d·x³ of x = s - ``s``, up to where the next one begins."""

    s: Fraction
    coefficients: Coefficients

    def at(self, s: Fraction) -> Fraction:
        a, b, c, d = self.coefficients
        x = s - self.s
        return a + x * (b + x * (c + x * d))


Polynomials: TypeAlias = tuple[CubicPiece, ...]


def value_at(pieces: Polynomials, s: Fraction) -> Fraction:
    """Return the value at ``s`` of the last piece that has begun; 0 where none has."""
    return next((x.at(s) for x in reversed(pieces) if x.s <= s), pieces[0].at(s) if pieces else _ZERO)


@dataclass(frozen=True)
class MapLane:
    """A lane of a section; ``width`` by s of the road (m), ``successor`` and ``predecessor`` ids of lanes.

    ``border``: instead of the width, where the outer edge is to the left of the reference line (m).
    ``zone``: what ``userData`` says.
    """

    id: int
    type: str
    width: Polynomials
    border: Polynomials
    predecessor: int | None
    successor: int | None
    zone: Zone | None


@dataclass(frozen=True)
class MapSection:
    """Lanes from ``begin`` to ``end`` (m), by id: positive ones to the left of the reference line."""

    begin: Fraction
    end: Fraction
    lanes: Mapping[int, MapLane]


def outer_edge(offset: Polynomials, section: MapSection, lane: int, s: Fraction) -> Fraction:
    """Return how far (m) the outer edge of a lane is to the left of the reference line; of lane 0, its only
    edge.

    Raises ``KeyError`` for a lane that the section does not have.
    """
    edge, sign = value_at(offset, s), 1 if lane > 0 else -1
    for number in range(1, abs(lane) + 1):
        map_lane = section.lanes[sign * number]
        edge = value_at(map_lane.border, s) if map_lane.border else edge + sign * value_at(map_lane.width, s)
    return edge


@dataclass(frozen=True)
class RoadLink:
    """The road or junction that a road leads to, and which end of a road."""

    kind: str
    id: str
    contact: str | None


@dataclass(frozen=True)
class MapRoad:
    """A road; ``offset`` is how far the lanes begin to the left of the reference line, by s.

    ``unread``: kinds of parts of it that were not read.
    """

    id: str
    name: str
    where: str
    rule: Rule
    junction: str | None
    line: ReferenceLine
    offset: Polynomials
    sections: tuple[MapSection, ...]
    predecessor: RoadLink | None
    successor: RoadLink | None
    unread: tuple[str, ...] = ()

    @property
    def length(self) -> Fraction:
        return self.line.end


@dataclass(frozen=True)
class RoadMap:
    """The roads of a file, in its order. ``refused``: by id, why a road cannot be read.

    ``unread``: kinds of parts of the file, apart from its roads, that were not read.
    """

    roads: tuple[MapRoad, ...]
    refused: Mapping[str, str]
    unread: tuple[str, ...] = ()


def read_map(path: Path) -> RoadMap:
    """The map of a file. Raises ``InputError`` that names file, element and rule, if no road can be read."""
    root = read_xml(path, "OpenDRIVE")
    nodes = root.findall("road")
    if not nodes:
        raise InputError(f"{path}: there is no road")
    if len(nodes) > _MOST:
        raise InputError(f"{path}: {len(nodes)} roads; at most {_MOST} are read")
    if len({x.get("id") for x in nodes}) < len(nodes):
        raise InputError(f"{path}: two roads have the same id")
    roads, refused = list[MapRoad](), dict[str, str]()
    for node in nodes:
        try:
            roads.append(_road(node, f"{path}: road {node.get('id')}"))
        except InputError as error:
            refused[node.get("id", "")] = str(error)
    if not roads:
        raise InputError(next(iter(refused.values())))
    return RoadMap(tuple(roads), refused, summary_of(parts_not_read(root, OPENDRIVE_FILE)))


def _road(node: Element, where: str) -> MapRoad:
    length = _number(node, "length", where)
    if length <= 0:
        raise InputError(f"{where}: length={node.get('length')}: a road is longer than 0 m")
    rule = _RULES.get(node.get("rule", "RHT"))
    if rule is None:
        raise InputError(f"{where}: rule={node.get('rule')}: one of {', '.join(_RULES)} is needed")
    junction, line = node.get("junction", "-1"), _line(node, length, where)
    before, after = _links(node)
    road = MapRoad(
        node.get("id", ""),
        node.get("name") or "",
        where,
        rule,
        None if junction == "-1" else junction,
        line,
        _pieces(node.findall("lanes/laneOffset"), "s", _ZERO, f"{where}, laneOffset"),
        tuple(_sections(node, line.end, where)),
        _link(before),
        _link(after),
    )
    return replace(road, unread=summary_of(parts_not_read(node, OPENDRIVE)))


def _links(node: Element) -> tuple[Element | None, Element | None]:
    """The predecessor and the successor of a road or lane."""
    links = node.find("link")
    return (None, None) if links is None else (links.find("predecessor"), links.find("successor"))


def _link(node: Element | None) -> RoadLink | None:
    if node is None:
        return None
    return RoadLink(node.get("elementType", ""), node.get("elementId", ""), node.get("contactPoint"))


def _line(road: Element, length: Fraction, where: str) -> ReferenceLine:
    pieces = road.findall("planView/geometry")
    if not pieces:
        raise InputError(f"{where}: planView has no geometry")
    parts: list[Part] = []
    end = _ZERO
    for k, node in enumerate(pieces, start=1):
        at = f"{where}, geometry {k}"
        s, long, x, y, heading = (_number(node, a, at) for a in ("s", "length", "x", "y", "hdg"))
        if abs(s - end) > _TOLERANCE:
            raise InputError(f"{at}: s={node.get('s')}, but the geometry before it ends at {float(end):g}")
        end = s + long
        if long > 0:
            parts.append(Part(s, long, x, y, heading, _curve(node, long, at)))
    if not parts or abs(end - length) > _LENGTH_TOLERANCE:
        stated_length = road.get("length")
        raise InputError(f"{where}: length={stated_length}, but its geometries end at {float(end):g}")
    _check_joined(parts, where)
    return ReferenceLine(tuple(parts))


_NEAR, _ANGLE = 0.1, 0.02
"""Metres and radians between the end of a geometry and the beginning of the next one."""


def _check_joined(parts: list[Part], where: str) -> None:
    """Raises ``InputError`` where a geometry does not begin where the one before it ends."""
    for k, (before, after) in enumerate(pairwise(parts), start=2):
        try:
            end, begin = before.pose(float(before.end)), after.pose(float(after.s))
        except (ValueError, ZeroDivisionError, OverflowError) as error:
            raise InputError(f"{where}, geometry {k - 1}: {error}") from None
        apart = ((end.x - begin.x) ** 2 + (end.y - begin.y) ** 2) ** 0.5
        if not apart <= _NEAR:
            problem = (
                f"it begins {apart:.2f} m from where the one before it ends; at most {_NEAR} m are allowed"
            )
            raise InputError(f"{where}, geometry {k}: {problem}")


def _curve(node: Element, length: Fraction, where: str) -> Curve:
    shapes = [x for x in node if x.tag not in ("userData", "include", "dataQuality")]
    if len(shapes) != 1:
        tags = " and ".join(x.tag for x in shapes) or "nothing"
        raise InputError(f"{where}: {tags}: one of {', '.join(_CURVES)} is needed")
    (shape,) = shapes
    shape.note()
    if shape.tag not in _CURVES:
        raise InputError(f"{where}: {shape.tag}: one of {', '.join(_CURVES)} is needed")
    return _CURVES[shape.tag](shape, length, f"{where}, {shape.tag}")


def _arc(node: Element, length: Fraction, where: str) -> Curve:
    curvature = _number(node, "curvature", where)
    return Spiral(curvature, curvature) if curvature else Line()


def _spiral(node: Element, length: Fraction, where: str) -> Curve:
    return Spiral(_number(node, "curvStart", where), _number(node, "curvEnd", where))


def _poly3(node: Element, length: Fraction, where: str) -> Curve:
    v = _coefficients(node, "abcd", where)
    return Cubic((_ZERO, Fraction(1), _ZERO, _ZERO), v, None)


def _parametric(node: Element, length: Fraction, where: str) -> Curve:
    u, v = (_coefficients(node, [f"{x}{y}" for x in "abcd"], where) for y in "UV")
    kind = node.get("pRange", "normalized")
    if kind not in ("normalized", "arcLength"):
        raise InputError(f"{where}: pRange={kind}: one of normalized, arcLength is needed")
    return Cubic(u, v, Fraction(1) if kind == "normalized" else length)


_CURVES: Mapping[str, Callable[[Element, Fraction, str], Curve]] = {
    "line": lambda node, length, where: Line(),
    "arc": _arc,
    "spiral": _spiral,
    "poly3": _poly3,
    "paramPoly3": _parametric,
}


def _coefficients(node: Element, names: str | list[str], where: str) -> Coefficients:
    a, b, c, d = (_number(node, x, where) for x in names)
    return a, b, c, d


def _pieces(nodes: list[Element], name: str, begin: Fraction, where: str) -> Polynomials:
    """Cubics by the s at which they begin, ``name`` m after ``begin``; of several at one s, the last one."""
    pieces = [CubicPiece(begin + _number(x, name, where), _coefficients(x, "abcd", where)) for x in nodes]
    if any(a.s > b.s for a, b in pairwise(pieces)):
        raise InputError(f"{where}: {name} must ascend")
    return tuple({x.s: x for x in pieces}.values())


def _sections(road: Element, length: Fraction, where: str) -> Iterator[MapSection]:
    nodes = road.findall("lanes/laneSection")
    begins = [_number(x, "s", f"{where}, laneSection {k}") for k, x in enumerate(nodes, start=1)]
    ends = [*begins[1:], length]
    if not nodes or begins[0] != 0 or any(a >= b for a, b in zip(begins, ends, strict=True)):
        raise InputError(f"{where}: laneSections must begin at s=0 and follow each other up to the length")
    for k, (node, begin, end) in enumerate(zip(nodes, begins, ends, strict=True), start=1):
        at = f"{where}, laneSection {k}"
        _read_plain(node)
        lanes = dict[int, MapLane]()
        for side, sign in (("left", 1), ("right", -1)):
            for x in node.findall(f"{side}/lane"):
                lane = _lane(x, begin, at)
                if lane.id in lanes or lane.id * sign <= 0:
                    rule = "1, 2, …" if sign > 0 else "-1, -2, …"
                    raise InputError(f"{at}, lane {lane.id}: ids on the {side} are {rule} , each once")
                lanes[lane.id] = lane
        yield MapSection(begin, end, lanes)


def _lane(node: Element, begin: Fraction, where: str) -> MapLane:
    number = int(_number(node, "id", f"{where}, a lane"))
    at = f"{where}, lane {number}"
    before, after = _links(node)
    width = _pieces(node.findall("width"), "sOffset", begin, f"{at}, width")
    borders = node.findall("border")
    if width:  # which has precedence
        for x in borders:
            x.read_all()
        borders = []
    _read_plain(node)
    return MapLane(
        number,
        node.get("type", ""),
        width,
        _pieces(borders, "sOffset", begin, f"{at}, border"),
        None if before is None else int(_number(before, "id", f"{at}, predecessor")),
        None if after is None else int(_number(after, "id", f"{at}, successor")),
        _zone(node, at),
    )


_PLAIN = {
    "advisory": ("none",),
    "direction": ("standard",),
    "dynamicLaneDirection": ("false", "0"),
    "dynamicLaneType": ("false", "0"),
    "roadWorks": ("false", "0"),
    "singleSide": ("false", "0"),
}
"""Attributes of lanes and sections that are read where they have one of these values, and named elsewhere."""


def _read_plain(node: Element) -> None:
    for name, values in _PLAIN.items():
        if node.peek(name) in values:
            node.note(name)


def _zone(lane: Element, where: str) -> Zone | None:
    """Return the zone that a lane itself states."""
    values = [x.peek("value") or "" for x in lane if x.tag == "userData" and x.peek("code") == ZONE]
    stated_zone = next((zone for zone in ZONES if values == [zone]), None)
    if values and stated_zone is None:
        raise InputError(
            f"{where}: userData {ZONE}={', '.join(values)!r}: one of {', '.join(ZONES)} is needed"
        )
    return stated_zone


def _number(node: Element, name: str, where: str) -> Fraction:
    text = node.get(name, "")
    if len(text) > 40 or not _NUMBER.fullmatch(text):
        raise InputError(f"{where}: {name}={node.get(name)!r}: a finite number is needed")
    return Fraction(text)
