"""What a storyboard is played on and by: the road, and the vehicles and other objects with their boxes."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.box import Box
from roadproof.extensions.exchange.storyboard.document import Document, open_document
from roadproof.extensions.exchange.storyboard.routes import longer, stretch_of
from roadproof.extensions.exchange.storyboard.run import Play, run_storyboard
from roadproof.runtime.records import dataclass
from roadproof.runtime.xml_reader import Element, number_in
from roadproof.world.models import load_road
from roadproof.world.road import Road
from roadproof.world.unread import LEFT_OUT, unread_note

_KINDS = {
    "car": "Car",
    "van": "Car",
    "truck": "Truck",
    "semitrailer": "Truck",
    "trailer": "Truck",
    "bus": "Truck",
    "motorbike": "Motorcycle",
}
_OTHERS = ("Pedestrian", "MiscObject", "ExternalObjectReference")
_UNRECORDED = ("bicycle", "pedestrian", "wheelchair")


@dataclass(frozen=True)
class Stage:
    """A document, its objects by name, and the road, which is a ``stretch`` of the map at ``road_path``."""

    document: Document
    boxes: Mapping[str, Box]
    road: Road
    road_path: Path
    stretch: str


def open_stage(path: Path) -> Stage:
    """The stage of a file. Raises ``InputError``."""
    document = open_document(path)
    road_path = map_of(document)
    boxes = dict(_boxes(path, document.root))
    if not any(x.recorded for x in boxes.values()):
        raise InputError(f"{path}: no ScenarioObject is a motor vehicle")
    stretch = stretch_of(document, road_path)
    return Stage(document, boxes, load_road(stretch), road_path, stretch)


def played(stage: Stage) -> tuple[Stage, Play]:
    """The play, on a longer road where a vehicle comes to its end. Raises ``InputError``."""
    play = run_storyboard(stage.document, stage.boxes, stage.road)
    while play.at_end and (more := longer(stage.stretch)) is not None:
        try:
            road = load_road(more)
        except InputError:
            break
        stage = replace(stage, road=road, stretch=more)
        play = run_storyboard(stage.document, stage.boxes, road)
    return stage, play


def unread_of(stage: Stage) -> tuple[str, ...]:
    """Notes on parts of a file and of its map that were not read and may have an effect."""
    parts = stage.document.left_out()
    told = (f"{LEFT_OUT}, as it is not supported: {'; '.join(parts)}",) if parts else ()
    return (*told, *unread_note(stage.road_path, stage.road.unread, strict=False))


def map_of(document: Document) -> Path:
    """The map that the file names, or that of the name beside it, as CARLA names maps."""
    path, node = document.path, document.root.find("RoadNetwork/LogicFile")
    named = text_of(path, node, "filepath", "a LogicFile")
    found = document.folder / named
    if "\\" in named and not found.exists():  # written on Windows
        found = document.folder / named.replace("\\", "/")
    if not found.suffix:
        found = found.with_suffix(".xodr")
    if found.suffix != ".xodr":
        raise InputError(f"{path}: LogicFile filepath={found.name}: a road in OpenDRIVE (.xodr) is needed")
    return found


def text_of(path: Path, node: Element | None, attribute: str, what: str) -> str:
    value = None if node is None else node.get(attribute)
    if not value:
        raise InputError(f"{path}: {what} with {attribute} is needed")
    return value


def number_of(path: Path, node: Element | None, attribute: str, what: str) -> float:
    return number_in(path, text_of(path, node, attribute, what), f"{attribute} of {what}")


def _boxes(path: Path, root: Element) -> Iterator[tuple[str, Box]]:
    """The motor vehicles by name."""
    seen: set[str] = set()
    for node in root.findall("Entities/ScenarioObject"):
        name = text_of(path, node, "name", "a ScenarioObject")
        if name in seen:
            raise InputError(f"{path}: two ScenarioObjects are called {name}")
        seen.add(name)
        told = f"ScenarioObject {name}"
        vehicle = node.find("Vehicle")
        other = next((x for x in node if x.tag in _OTHERS), None)
        if vehicle is None and other is not None:
            yield name, _other_box(path, other, told)
            continue
        if vehicle is None:
            raise InputError(f"{path}: {told} is no Vehicle")
        category = vehicle.get("vehicleCategory", "car")
        if category in _UNRECORDED:
            yield name, _other_box(path, vehicle, told)
            continue
        if category not in _KINDS:
            raise InputError(f"{path}: {told}: vehicleCategory={category} is none of {', '.join(_KINDS)}")
        size, centre = vehicle.find("BoundingBox/Dimensions"), vehicle.find("BoundingBox/Center")
        length, width = (number_of(path, size, x, f"the Dimensions of {told}") for x in ("length", "width"))
        ahead, left = (number_of(path, centre, x, f"the Center of {told}") for x in ("x", "y"))
        yield (
            name,
            Box(
                _KINDS[category], category, length, width, (ahead, left), limits=_limits(path, vehicle, told)
            ),
        )
    if not seen:
        raise InputError(f"{path}: there is no ScenarioObject")


def _limits(path: Path, vehicle: Element, told: str) -> tuple[float, float, float]:
    """The largest speed, acceleration and deceleration of a vehicle, infinite where it has no Performance."""
    node = vehicle.find("Performance")
    if node is None:
        return math.inf, math.inf, math.inf
    names = ("maxSpeed", "maxAcceleration", "maxDeceleration")
    speed, *rates = (number_of(path, node, x, f"the Performance of {told}") for x in names)
    return speed, rates[0], rates[1]


def _other_box(path: Path, node: Element, told: str) -> Box:
    """That of an object that is not recorded, without size where the file says none."""
    if node.find("BoundingBox") is None:
        return Box(node.tag, node.tag, 0.0, 0.0, (0.0, 0.0), recorded=False)
    size, centre = node.find("BoundingBox/Dimensions"), node.find("BoundingBox/Center")
    length, width = (number_of(path, size, x, f"the Dimensions of {told}") for x in ("length", "width"))
    ahead, left = (number_of(path, centre, x, f"the Center of {told}") for x in ("x", "y"))
    return Box(node.tag, node.tag, length, width, (ahead, left), recorded=False)
