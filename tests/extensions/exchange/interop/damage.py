"""Damaged copies of exported files, which clients have to refuse: what is wrong, and how it is made so."""

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Mapping

Damage = Callable[[str], str]


def without(pattern: str) -> Damage:
    """The text with the first place that fits the pattern left out."""
    return lambda text: re.sub(pattern, "", text, count=1, flags=re.DOTALL)


def changed(pattern: str, by: str, count: int = 1) -> Damage:
    """The text with something else where the pattern fits first, or everywhere where ``count`` is 0."""
    return lambda text: re.sub(pattern, by, text, count=count, flags=re.DOTALL)


def moved(pattern: str, metres: float) -> Damage:
    """The text with all numbers that the pattern's group finds made greater."""

    def by(match: re.Match[str]) -> str:
        begin, end = match.start(1) - match.start(), match.end(1) - match.start()
        return match[0][:begin] + repr(float(match[1]) + metres) + match[0][end:]

    return lambda text: re.sub(pattern, by, text)


def of_vehicles(path: str, more: float, first: int = 1, last: int = 99) -> Damage:
    """A CommonRoad file with a number greater in every state of vehicles from ``first`` to ``last``."""

    def by(text: str) -> str:
        root = ElementTree.fromstring(text.encode())
        for vehicle in root.findall("dynamicObstacle"):
            for node in vehicle.findall(f".//{path}") if first <= int(vehicle.get("id", "")) <= last else ():
                node.text = repr(float(node.text or "") + more)
        return ElementTree.tostring(root, encoding="unicode")

    return by


DAMAGES: Mapping[str, Mapping[str, Damage]] = {
    "asam-qc-openscenarioxml": {
        "a vehicle that nobody declared": changed(r'<EntityRef entityRef="SV"', '<EntityRef entityRef="XY"'),
        "no RoadNetwork": without(r"<RoadNetwork>.*?</RoadNetwork>"),
        "an unknown priority": changed('priority="override"', 'priority="first"'),
        "no end": without(r"</OpenSCENARIO>"),
    },
    "scenariogeneration": {
        "the rear axle where the centre is": moved(r'<WorldPosition x="([^"]*)"', 1.35),
        "times that are relative": changed('Relative="absolute"', 'Relative="relative"'),
        "a vehicle without a width": without(r'width="[^"]*" (?=length)'),
        "a second that is lost": moved(r'<Vertex time="([1-9][^"]*)"', 0.1),
    },
    "asam-qc-opendrive": {
        "an unknown type of lane": changed('type="driving"', 'type="lane"'),
        "an unknown marking": changed('type="solid"', 'type="unbroken"'),
        "an unknown type of road": changed('type="motorway"', 'type="highway"'),
        "no end": without(r"</OpenDRIVE>"),
    },
    "eclipse-sumo": {
        "a lane of 3 m": changed('a="3.5"', 'a="3"'),
        "no speed of lanes": changed(r"<speed sOffset[^>]*/>", "", 0),
        "a lane too few": without(r'<lane id="-1".*?</lane>'),
        "no end": without(r"</OpenDRIVE>"),
    },
    "commonroad-io": {
        "no planning problem": without(r"<planningProblem.*</planningProblem>"),
        "a lanelet that is nowhere": changed(r'(<adjacent\w+ ref=)"\d+"', r'\1"77"'),
        "the corner where the centre is": moved(r"<state>\s*<position>\s*<point>\s*<x>([^<]*)", 2.25),
        "no end": without(r"</commonRoad>"),
    },
    "commonroad-crime": {
        "another vehicle's front where its centre is": of_vehicles("position/point/x", 2.25, first=2),
        "speeds of SV 1 m/s greater": of_vehicles("velocity/exact", 1, last=1),
    },
}
"""By client and what is wrong, a function of the text of a file."""
