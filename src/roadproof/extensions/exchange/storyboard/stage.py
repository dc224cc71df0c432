"""The stage of a storyboard: the road, and the vehicles and other objects with their boxes."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.document import Document, open_document
from roadproof.extensions.exchange.storyboard.play import Play
from roadproof.extensions.exchange.storyboard.routes import extended_stretch, stretch_of
from roadproof.extensions.exchange.storyboard.run import run_storyboard
from roadproof.extensions.maps.xml_reader import Element, number_in
from roadproof.runtime.records import dataclass
from roadproof.world.models import load_road
from roadproof.world.not_read import LEFT_OUT, not_read_note
from roadproof.world.road import Road

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
class StoryboardStage:
    """A document, its objects by name, and the road, which is a ``stretch`` of the map at ``road_path``."""

    document: Document
    boxes: Mapping[str, ObjectBox]
    road: Road
    road_path: Path
    stretch: str


def open_stage(path: Path) -> StoryboardStage:
    """The stage of a file. Raises ``InputError``."""
    document = open_document(path)
    road_path = map_of(document)
    boxes = dict(_boxes(path, document.root))
    if not any(x.recorded for x in boxes.values()):
        raise InputError(f"{path}: no ScenarioObject is a motor vehicle")
    stretch = stretch_of(document, road_path)
    return StoryboardStage(document, boxes, load_road(stretch), road_path, stretch)


def run_stage(stage: StoryboardStage) -> tuple[StoryboardStage, Play]:
    """The play, on a longer road where a vehicle comes to its end. Raises ``InputError``."""
    play = run_storyboard(stage.document, stage.boxes, stage.road)
    while play.at_end and (more := extended_stretch(stage.stretch)) is not None:
        try:
            road = load_road(more)
        except InputError:
            break
        stage = replace(stage, road=road, stretch=more)
        play = run_storyboard(stage.document, stage.boxes, road)
    return stage, play


def omission_notes(stage: StoryboardStage) -> tuple[str, ...]:
    """Notes on parts of a file and of its map that were not read and may have an effect."""
    parts = stage.document.left_out()
    notes = (f"{LEFT_OUT}, as it is not supported: {'; '.join(parts)}",) if parts else ()
    return (*notes, *not_read_note(stage.road_path, stage.road.unread, strict=False))


def map_of(document: Document) -> Path:
    """The map that the file names, or that of the name beside it, as CARLA names maps."""
    path, node = document.path, document.root.find("RoadNetwork/LogicFile")
    file_name = text_of(path, node, "filepath", "a LogicFile")
    map_path = document.folder / file_name
    if "\\" in file_name and not map_path.exists():  # written on Windows
        map_path = document.folder / file_name.replace("\\", "/")
    if not map_path.suffix:
        map_path = map_path.with_suffix(".xodr")
    if map_path.suffix != ".xodr":
        raise InputError(f"{path}: LogicFile filepath={map_path.name}: a road in OpenDRIVE (.xodr) is needed")
    return map_path


def text_of(path: Path, node: Element | None, attribute: str, what: str) -> str:
    value = None if node is None else node.get(attribute)
    if not value:
        raise InputError(f"{path}: {what} with {attribute} is needed")
    return value


def number_of(path: Path, node: Element | None, attribute: str, what: str) -> float:
    return number_in(path, text_of(path, node, attribute, what), f"{attribute} of {what}")


def _boxes(path: Path, root: Element) -> Iterator[tuple[str, ObjectBox]]:
    """The motor vehicles by name."""
    seen: set[str] = set()
    for node in root.findall("Entities/ScenarioObject"):
        name = text_of(path, node, "name", "a ScenarioObject")
        if name in seen:
            raise InputError(f"{path}: two ScenarioObjects are called {name}")
        seen.add(name)
        where = f"ScenarioObject {name}"
        vehicle = node.find("Vehicle")
        other = next((x for x in node if x.tag in _OTHERS), None)
        if vehicle is None and other is not None:
            yield name, _other_box(path, other, where)
            continue
        if vehicle is None:
            raise InputError(f"{path}: {where} is no Vehicle")
        category = vehicle.get("vehicleCategory", "car")
        if category in _UNRECORDED:
            yield name, _other_box(path, vehicle, where)
            continue
        if category not in _KINDS:
            raise InputError(f"{path}: {where}: vehicleCategory={category} is none of {', '.join(_KINDS)}")
        size, centre = vehicle.find("BoundingBox/Dimensions"), vehicle.find("BoundingBox/Center")
        length, width = (number_of(path, size, x, f"the Dimensions of {where}") for x in ("length", "width"))
        ahead, left = (number_of(path, centre, x, f"the Center of {where}") for x in ("x", "y"))
        yield (
            name,
            ObjectBox(
                _KINDS[category],
                category,
                length,
                width,
                (ahead, left),
                limits=_performance_limits(path, vehicle, where),
            ),
        )
    if not seen:
        raise InputError(f"{path}: there is no ScenarioObject")


def _performance_limits(path: Path, vehicle: Element, where: str) -> tuple[float, float, float]:
    """The largest speed, acceleration and deceleration of a vehicle, infinite where it has no Performance."""
    node = vehicle.find("Performance")
    if node is None:
        return math.inf, math.inf, math.inf
    names = ("maxSpeed", "maxAcceleration", "maxDeceleration")
    speed, *rates = (number_of(path, node, x, f"the Performance of {where}") for x in names)
    return speed, rates[0], rates[1]


def _other_box(path: Path, node: Element, where: str) -> ObjectBox:
    """Return the box of an object that is not recorded; without size where the file has none."""
    if node.find("BoundingBox") is None:
        return ObjectBox(node.tag, node.tag, 0.0, 0.0, (0.0, 0.0), recorded=False)
    size, centre = node.find("BoundingBox/Dimensions"), node.find("BoundingBox/Center")
    length, width = (number_of(path, size, x, f"the Dimensions of {where}") for x in ("length", "width"))
    ahead, left = (number_of(path, centre, x, f"the Center of {where}") for x in ("x", "y"))
    return ObjectBox(node.tag, node.tag, length, width, (ahead, left), recorded=False)
