"""Straight roads in OpenDRIVE (ASAM, 1.4 to 1.8): one road of lines, with lanes of constant width.

The lanes on the right of the reference line are read, which drive along s where traffic keeps to the right;
d is 0 on the reference line. Lanes of type driving are on the main road, those of ``RAMPS`` are merge and
departure lanes, those of ``NO_LANES`` are left out. In a lane section with a merge lane all lanelets are in
the merge zone, in one with a departure lane in the depart zone, unless the ``userData`` of a lane says which
zone it is in (``ZONE``). A lanelet and the next one are of one lane
where a link says so, or where they have the same bounds. Elevation does not matter, as s is measured in plan.
"""

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from roadproof.errors import InputError
from roadproof.runtime.xml_reader import Element, read_xml
from roadproof.world.road import Attribute, Lanelet, Zone

RAMPS: Mapping[str, Attribute] = {
    "entry": "merge",
    "onRamp": "merge",
    "mwyEntry": "merge",
    "merge": "merge",
    "exit": "departure",
    "offRamp": "departure",
    "mwyExit": "departure",
}
ZONE = "roadproof:zone"
"""The code of the ``userData`` of a lane whose value is its zone."""
NO_LANES = frozenset(
    "shoulder border stop none restricted parking median biking sidewalk walking curb".split()  # noqa: SIM905
)
_ZONES: Mapping[Attribute, Zone] = {"main": "main", "merge": "merge", "departure": "depart"}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,2})?")


@dataclass(frozen=True)
class _Lane:
    """A lane of a section; ``d`` is (right, left), ``successor`` the id that it says it goes on with.

    ``zone`` is what it says itself, None where it says nothing.
    """

    id: int
    d: tuple[Fraction, Fraction]
    attribute: Attribute
    successor: int | None
    zone: Zone | None


def read_lanelets(path: Path) -> tuple[Lanelet, ...]:
    """The lanelets of a file; lanes are called main-1, main-2, …, merge-1, … from the right.

    Raises ``InputError`` that names the file, the element and the rule.
    """
    root = read_xml(path, "OpenDRIVE")
    roads = root.findall("road")
    if len(roads) != 1:
        raise InputError(f"{path}: {len(roads)} roads; a file of one road is needed")
    (road,) = roads
    where = f"{path}: road {road.get('id')}"
    if road.get("rule", "RHT") != "RHT":
        raise InputError(f"{where}: rule={road.get('rule')}: only traffic on the right is supported")
    length = _number(road, "length", where)
    _check_straight(road, length, where)
    offset = _offset(road, where)
    nodes = road.findall("lanes/laneSection")
    begins = [_number(x, "s", f"{where}, laneSection {k}") for k, x in enumerate(nodes, start=1)]
    if not nodes or begins[0] != 0 or any(a >= b for a, b in zip(begins, [*begins[1:], length], strict=True)):
        raise InputError(f"{where}: laneSections must begin at s=0 and follow each other up to the length")
    sections = [_section(x, offset, f"{where}, laneSection {k}") for k, x in enumerate(nodes, start=1)]
    return tuple(_lanelets(sections, [*begins, length], where))


def origin_of(path: Path) -> tuple[float, float, float]:
    """Where the reference line of a straight road begins in the plane (m), and its heading (rad).

    Raises ``InputError``.
    """
    road = read_xml(path, "OpenDRIVE").find("road")
    first = None if road is None else road.find("planView/geometry")
    if first is None:
        raise InputError(f"{path}: the road has no geometry")
    x, y, heading = (float(_number(first, name, f"{path}, geometry 1")) for name in ("x", "y", "hdg"))
    return x, y, heading


def _check_straight(road: Element, length: Fraction, where: str) -> None:
    """Raises ``InputError`` for a plan view that is not one straight line."""
    pieces = road.findall("planView/geometry")
    if not pieces:
        raise InputError(f"{where}: planView has no geometry")
    end, heading = Fraction(0), _number(pieces[0], "hdg", f"{where}, geometry 1")
    for k, piece in enumerate(pieces, start=1):
        at = f"{where}, geometry {k}"
        shapes = [x.tag for x in piece if x.tag != "userData"]
        if shapes != ["line"]:
            told = " and ".join(shapes) or "nothing"
            raise InputError(f"{at}: {told}: only straight roads are supported, whose geometry is line")
        if abs(_number(piece, "hdg", at) - heading) > Fraction(1, 10**6):
            told = f"hdg={piece.get('hdg')}: the road turns; only straight ones are supported"
            raise InputError(f"{at}: {told}")
        if abs(_number(piece, "s", at) - end) > Fraction(1, 10**3):
            raise InputError(f"{at}: s={piece.get('s')}, but the geometry before it ends at {float(end):g}")
        end += _number(piece, "length", at)
    if abs(end - length) > Fraction(1, 10**3):
        raise InputError(f"{where}: length={road.get('length')}, but its geometries end at {float(end):g}")


def _offset(road: Element, where: str) -> Fraction:
    """How far the lanes begin to the left of the reference line."""
    offsets = {_constant(x, f"{where}, laneOffset") for x in road.findall("lanes/laneOffset")}
    if len(offsets) > 1:
        raise InputError(f"{where}: laneOffset changes; only one that stays the same is supported")
    return offsets.pop() if offsets else Fraction(0)


def _section(node: Element, offset: Fraction, where: str) -> list[_Lane]:
    """The lanes of a section, from the reference line to the right."""
    lanes: list[_Lane] = []
    left = offset
    known: dict[int, Element] = {}
    for x in node.findall("right/lane"):
        number = int(_number(x, "id", f"{where}, a lane"))
        if number in known or number >= 0:
            raise InputError(f"{where}, lane {number}: ids on the right are -1, -2, … , each once")
        known[number] = x
    for number in sorted(known, reverse=True):
        at = f"{where}, lane {number}"
        lane, kind = known[number], known[number].get("type", "")
        widths = {_constant(x, f"{at}, width") for x in lane.findall("width")}
        if len(widths) != 1 or min(widths) < 0:
            raise InputError(f"{at}: {len(widths)} widths; one that stays the same is needed")
        right = left - widths.pop()
        if kind != "driving" and kind not in RAMPS and kind not in NO_LANES:
            known_types = ", ".join(("driving", *RAMPS, *sorted(NO_LANES)))
            raise InputError(f"{at}: type={kind!r} is none of {known_types}")
        if kind not in NO_LANES and right < left:
            link = lane.find("link/successor")
            successor = None if link is None else int(_number(link, "id", f"{at}, successor"))
            attribute = RAMPS.get(kind, "main")
            lanes.append(_Lane(number, (right, left), attribute, successor, _zone(lane, at)))
        left = right
    if not lanes:
        raise InputError(f"{where}: no lane on the right is driven on")
    ramps = {x.attribute for x in lanes} - {"main"}
    if len(ramps) > 1:
        raise InputError(f"{where}: merge and departure lanes; a section is in one zone, so divide it in two")
    return lanes


def _lanelets(sections: list[list[_Lane]], ends: list[Fraction], where: str) -> Iterator[Lanelet]:
    names: list[dict[int, str]] = [{} for _ in sections]
    counts = Counter[Attribute]()
    for k, lanes in enumerate(sections):
        before = sections[k - 1] if k else []
        zone: Zone = next((_ZONES[x.attribute] for x in lanes if x.attribute != "main"), "main")
        for lane in reversed(lanes):
            known = [names[k - 1][x.id] for x in before if _goes_on(x, lane)]
            if len(known) > 1:
                raise InputError(f"{where}, laneSection {k + 1}, lane {lane.id}: two lanes go on in it")
            if not known:
                counts[lane.attribute] += 1
                known = [f"{lane.attribute}-{counts[lane.attribute]}"]
            (name,) = known
            names[k][lane.id] = name
            s = ends[k], ends[k + 1]
            letter = chr(ord("a") + k) if k < 26 else f".{k + 1}"  # of the section
            yield Lanelet(f"{name}{letter}", name, lane.zone or zone, lane.attribute, s, lane.d)


def _zone(lane: Element, where: str) -> Zone | None:
    """What a lane itself says of its zone."""
    said = [x.get("value", "") for x in lane.findall("userData") if x.get("code") == ZONE]
    found = next((zone for zone in _ZONES.values() if said == [zone]), None)
    if said and found is None:
        known = ", ".join(_ZONES.values())
        raise InputError(f"{where}: userData {ZONE}={', '.join(said)!r}: one of {known} is needed")
    return found


def _goes_on(before: _Lane, lane: _Lane) -> bool:
    if before.attribute != lane.attribute:
        return False
    return before.d == lane.d if before.successor is None else before.successor == lane.id


def _constant(node: Element, where: str) -> Fraction:
    """The a of a polynomial whose other coefficients are 0."""
    for name in "bcd":
        if node.get(name) is not None and _number(node, name, where) != 0:
            raise InputError(f"{where}: {name}={node.get(name)}: it must stay the same along the road")
    return _number(node, "a", where)


def _number(node: Element, name: str, where: str) -> Fraction:
    text = node.get(name, "")
    if len(text) > 40 or not _NUMBER.fullmatch(text):
        raise InputError(f"{where}: {name}={node.get(name)!r}: a finite number is needed")
    return Fraction(text)
