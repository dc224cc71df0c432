"""Lanelets of a map in CommonRoad XML, with their links and the attributes that their types say."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.runtime.xml_reader import Element, by_id, number_in, read_xml
from roadproof.world.maps.topology import Floats, MeasuredLanelet
from roadproof.world.road import Attribute

VERSIONS = ("2020a", "2018b")
ATTRIBUTES: Mapping[str, Attribute] = {
    "accessRamp": "merge",
    "exitRamp": "departure",
    "mainCarriageWay": "main",
}
"""Lanelet types that say what is main road and what is not, and the paper's attribute for them."""


def read_map(path: Path) -> dict[str, MeasuredLanelet]:
    """The lanelets of a file by id. Raises ``InputError``."""
    root = read_xml(path, "commonRoad")
    version = root.get("commonRoadVersion")
    if version not in VERSIONS:
        told = f"commonRoadVersion={version}: commonRoad of version {' or '.join(VERSIONS)} is needed"
        raise InputError(f"{path}: {told}")
    return lanelets_of(path, root)


def lanelets_of(path: Path, root: Element) -> dict[str, MeasuredLanelet]:
    """The lanelets by id. Raises ``InputError``."""
    nodes = by_id(path, root.findall("lanelet"))
    if not nodes:
        raise InputError(f"{path}: the file has no lanelet; a road is needed to place vehicles on")
    return {name: _read_lanelet(path, node, nodes) for name, node in nodes.items()}


def _read_lanelet(path: Path, node: Element, known: Mapping[str, Element]) -> MeasuredLanelet:
    name = node.get("id", "")
    where = f"lanelet {name}"
    left, right = (_read_line(path, node.find(x), f"{x} of {where}") for x in ("leftBound", "rightBound"))
    if len(left) != len(right):
        raise InputError(f"{path}: {where} has bounds of {len(left)} and {len(right)} points; must be equal")
    types = {(x.text or "").strip() for x in node.findall("laneletType")}

    def refs(*tags: str) -> tuple[str, ...]:
        found = [x for tag in tags for x in node.findall(tag)]
        for x in found:
            if x.get("ref") not in known:
                raise InputError(f"{path}: {where}: {x.tag} {x.get('ref')} is no lanelet of the file")
        return tuple(x.get("ref", "") for x in found if x.get("drivingDir", "same") == "same")

    refs("predecessor")
    attribute = next((ATTRIBUTES[x] for x in sorted(types) if x in ATTRIBUTES), None)
    return MeasuredLanelet(
        name, left, right, attribute, refs("successor"), refs("adjacentLeft", "adjacentRight")
    )


def _read_line(path: Path, node: Element | None, what: str) -> Floats:
    points = [] if node is None else node.findall("point")
    if len(points) < 2:
        raise InputError(f"{path}: {what} has {len(points)} points; at least two are needed")
    return np.array([[number_in(path, p.findtext(x), f"{x} in {what}") for x in "xy"] for p in points])
