"""Lanelets of a map in CommonRoad XML, with their links and the attributes that their types say."""

import math
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.maps.harmless import COMMONROAD_MAP
from roadproof.extensions.maps.topology import Floats, MeasuredLanelet
from roadproof.extensions.maps.xml_element import text_of
from roadproof.extensions.maps.xml_reader import (
    Element,
    by_id,
    number_in,
    parts_not_read,
    read_xml,
    summary_of,
)
from roadproof.world.road import Attribute

SAME = 0.05
"""m: points of two bounds so near are one point."""
VERSIONS = ("2020a", "2018b")
ATTRIBUTES: Mapping[str, Attribute] = {
    "accessRamp": "merge",
    "exitRamp": "departure",
    "mainCarriageWay": "main",
}
"""Lanelet types that say what is main road and what is not, and the paper's attribute for them."""


def read_map(path: Path) -> tuple[dict[str, MeasuredLanelet], tuple[str, ...]]:
    """The lanelets of a file by id, and kinds of parts that were not read. Raises ``InputError``."""
    root = read_xml(path, "commonRoad")
    version = root.get("commonRoadVersion")
    if version not in VERSIONS:
        problem = f"commonRoadVersion={version}: commonRoad of version {' or '.join(VERSIONS)} is needed"
        raise InputError(f"{path}: {problem}")
    lanelets = lanelets_of(path, root)
    return lanelets, summary_of(parts_not_read(root, COMMONROAD_MAP))


def lanelets_of(path: Path, root: Element) -> dict[str, MeasuredLanelet]:
    """The lanelets by id. Raises ``InputError``."""
    nodes = by_id(path, root.findall("lanelet"))
    if not nodes:
        raise InputError(f"{path}: the file has no lanelet; a road is needed to place vehicles on")
    return _with_neighbours({name: _read_lanelet(path, node, nodes) for name, node in nodes.items()})


def _with_neighbours(lanelets: Mapping[str, MeasuredLanelet]) -> dict[str, MeasuredLanelet]:
    """The lanelets, with those beside them in the same direction whose bound is theirs."""
    neighbours: dict[str, list[str]] = {name: [] for name in lanelets}
    ends: dict[tuple[int, ...], list[str]] = defaultdict(list)
    for x in lanelets.values():
        ends[_cell(x.right[0])].append(x.id)
    for x in lanelets.values():
        row, column = _cell(x.left[0])
        near = [y for i in (-1, 0, 1) for j in (-1, 0, 1) for y in ends.get((row + i, column + j), ())]
        for other in near:
            if other != x.id and other not in x.beside and _same_line(x.left, lanelets[other].right):
                neighbours[x.id].append(other)
                neighbours[other].append(x.id)
    return {
        name: replace(x, beside=(*x.beside, *neighbours[name]), by_bound=tuple(neighbours[name]))
        for name, x in lanelets.items()
    }


def _cell(point: Floats) -> tuple[int, int]:
    """The square of a grid that a point is in."""
    return math.floor(point[0] / SAME), math.floor(point[1] / SAME)


def _same_line(one: Floats, other: Floats) -> bool:
    """Return whether two lines have the same ends and the same points between them, up to SAME."""
    if np.hypot(*(one[[0, -1]] - other[[0, -1]]).T).max() > SAME:
        return False
    shares = [np.append(0, np.cumsum(np.hypot(*np.diff(x, axis=0).T))) for x in (one, other)]
    if min(x[-1] for x in shares) <= 0 or abs(shares[0][-1] - shares[1][-1]) > SAME * len(one):
        return False
    at = np.union1d(*(x / x[-1] for x in shares))
    lines = [
        np.stack([np.interp(at, share / share[-1], x[:, k]) for k in range(2)], axis=1)
        for share, x in zip(shares, (one, other), strict=True)
    ]
    return bool(np.hypot(*(lines[0] - lines[1]).T).max() <= SAME)


def _read_lanelet(path: Path, node: Element, known: Mapping[str, Element]) -> MeasuredLanelet:
    name = node.get("id", "")
    where = f"lanelet {name}"
    left, right = (_read_line(path, node.find(x), f"{x} of {where}") for x in ("leftBound", "rightBound"))
    if len(left) != len(right):
        raise InputError(f"{path}: {where} has bounds of {len(left)} and {len(right)} points; must be equal")
    types = {(x.text or "").strip() for x in node.findall("laneletType")}
    _read_users(node)

    def refs(*tags: str) -> tuple[str, ...]:
        links = [x for tag in tags for x in node.findall(tag)]
        for x in links:
            if x.get("ref") not in known:
                raise InputError(f"{path}: {where}: {x.tag} {x.get('ref')} is no lanelet of the file")
        return tuple(x.get("ref", "") for x in links if x.get("drivingDir", "same") == "same")

    refs("predecessor")
    attribute = next((ATTRIBUTES[x] for x in sorted(types) if x in ATTRIBUTES), None)
    return MeasuredLanelet(
        name, left, right, attribute, refs("successor"), refs("adjacentLeft", "adjacentRight")
    )


_VEHICLES = ("vehicle", "car", "truck", "bus", "motorcycle", "taxi", "priorityVehicle")


def _read_users(node: Element) -> None:
    """Count users as read that change no lane: vehicles along it, and others where vehicles drive, too.

    Vehicles that drive both ways, and a lanelet that no vehicle uses, are left to be named.
    """
    along, both = (
        [x for x in node if x.tag == tag and (text_of(x) or "").strip()]
        for tag in ("userOneWay", "userBidirectional")
    )
    is_driven = not along or any((text_of(x) or "").strip() in _VEHICLES for x in along)
    for x in (*(along if is_driven else ()), *both):
        if x.tag == "userOneWay" or (text_of(x) or "").strip() not in _VEHICLES:
            x.read_all()


def _read_line(path: Path, node: Element | None, what: str) -> Floats:
    points = [] if node is None else node.findall("point")
    if len(points) < 2:
        raise InputError(f"{path}: {what} has {len(points)} points; at least two are needed")
    return np.array([[number_in(path, p.findtext(x), f"{x} in {what}") for x in "xy"] for p in points])
