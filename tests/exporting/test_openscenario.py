"""OpenSCENARIO files read by what the format says of them, and played against the exact motion."""

import math
import re
import xml.etree.ElementTree as ElementTree
from fractions import Fraction as F
from pathlib import Path

import pytest

from exporting.kept import TURN, kept, motion, subject, subjects
from roadproof.evidence.drive_file import DriveFile
from roadproof.recordings.export import openscenario
from roadproof.recordings.export.subject import Subject
from roadproof.world.motion import state_at

Element = ElementTree.Element


def root_of(made: Subject) -> Element:
    return ElementTree.fromstring(openscenario.scenario_file(made))


def only(root: Element, path: str) -> Element:
    (found,) = root.findall(path)
    return found


def numbers(node: Element, *names: str) -> list[float]:
    return [float(node.get(name, "nan")) for name in names]


def boxes(root: Element, name: str, times: list[float]) -> list[tuple[float, float, float]]:
    """Centre and heading of a vehicle's box as a player of the file has it, straight between vertices."""
    thing = only(root, f".//ScenarioObject[@name='{name}']")
    (ahead,) = numbers(only(thing, ".//Center"), "x")
    groups = [x for x in root.iter("ManeuverGroup") if only(x, "Actors/EntityRef").get("entityRef") == name]
    (group,) = groups
    course = [
        (*numbers(x, "time"), *numbers(only(x, "Position/WorldPosition"), "x", "y", "h"))
        for x in group.iter("Vertex")
    ]
    found = []
    for time in times:
        k = max(k for k, x in enumerate(course[:-1]) if x[0] <= time)
        (begin, *a), (end, *b) = course[k], course[k + 1]
        x, y, turned = (p + (time - begin) / (end - begin) * (q - p) for p, q in zip(a, b, strict=True))
        found.append((x + ahead * math.cos(turned), y + ahead * math.sin(turned), turned))
    return found


def farthest(root: Element, file: DriveFile) -> float:
    """How far a box of the file is from that of the drive, at 300 times."""
    times = [file.horizon * F(k, 300) for k in range(301)]
    found = 0.0
    for name, car in file.drive.vehicles.items():
        for time, (x, y, _) in zip(times, boxes(root, name, [*map(float, times)]), strict=True):
            state = state_at(car, time)
            middle = float(state.s - car.length / 2), float(state.d - car.width / 2)
            found = max(found, math.dist((x, y), middle))
    return found


@pytest.mark.parametrize("made", subjects()[::5], ids=lambda x: x.name)
def test_a_player_of_the_file_is_within_its_bound_of_the_drive(made: Subject) -> None:
    root = root_of(made)
    said = re.search(r"within ([0-9.]+) m of the drive", only(root, "FileHeader").get("description", ""))
    assert said is not None
    assert farthest(root, made.file) <= float(said[1]) <= 0.01


@pytest.mark.parametrize(
    ("planted", "shift"),
    [("front axle", 2.7), ("centre", 1.35), ("a vertex is 2 cm to the left", 0.02)],
)
def test_planted_fault_another_reference_point_is_noticed(planted: str, shift: float) -> None:
    made = subject(SV=TURN)
    root = root_of(made)
    assert farthest(root, made.file) <= 0.01
    for vertex in root.iter("Vertex"):
        place = only(vertex, "Position/WorldPosition")
        name = "y" if shift < 1 else "x"
        place.set(name, str(float(place.get(name, "")) + shift))
    assert farthest(root, made.file) > 0.01


def test_the_heading_is_that_of_the_motion_at_every_vertex() -> None:
    made = subject(SV=TURN)
    for vertex in root_of(made).iter("Vertex"):
        state = state_at(TURN, F(vertex.get("time", "")))
        (turned,) = numbers(only(vertex, "Position/WorldPosition"), "h")
        assert turned == pytest.approx(math.atan2(state.v_lat, state.v_lon), abs=1e-12)


def test_boxes_are_those_of_the_drive_and_corners_are_as_far_off_as_said() -> None:
    made = subject(SV=TURN, POV=motion((None, "0", "0"), start=("60", "3", "20", "0"), size=("9", "2.5")))
    root = root_of(made)
    box = only(root, ".//ScenarioObject[@name='POV']//Dimensions")
    assert numbers(box, "length", "width") == [9, 2.5]
    kinds = [x.get("vehicleCategory") for x in root.iter("Vehicle")]
    assert kinds == ["car", "truck"]
    turned = max(abs(x[2]) for x in boxes(root, "SV", [k / 50 for k in range(200)]))
    said = re.search(r"corners up to ([0-9.]+) m", only(root, "FileHeader").get("description", ""))
    assert said is not None
    corner = math.hypot(4.5, 1.8) / 2
    assert 2 * math.sin(turned / 2) * corner == pytest.approx(float(said[1]), abs=2e-3)


def test_what_the_format_demands_is_there() -> None:
    made = subject(SV=TURN)
    root = root_of(made)
    header = only(root, "FileHeader")
    assert [header.get(x) for x in ("revMajor", "revMinor")] == ["1", "2"]
    assert only(root, "RoadNetwork/LogicFile").get("filepath") == "made.xodr"
    assert {*openscenario.files(made)} == {"made.xosc", "made.xodr"}
    assert {x.get("domainAbsoluteRelative") for x in root.iter("Timing")} == {"absolute"}
    assert {x.get("followingMode") for x in root.iter("TrajectoryFollowingMode")} == {"position"}
    assert {x.get("priority") for x in root.iter("Event")} == {"override"}
    starts = [x for node in root.iter("StartTrigger") for x in node.iter("SimulationTimeCondition")]
    assert {(x.get("value"), x.get("rule")) for x in starts} == {("0", "greaterOrEqual")}
    assert only(root, "Storyboard/StopTrigger//SimulationTimeCondition").get("value") == "4"
    assert only(root, ".//Init//AbsoluteTargetSpeed").get("value") == "30"
    first = only(root, ".//Init//WorldPosition").attrib
    assert first == next(root.iter("Vertex")).find("Position/WorldPosition").attrib  # type: ignore[union-attr]


def test_a_name_that_xml_cannot_hold_is_written_plainly(tmp_path: Path) -> None:
    made = subject(SV=TURN)
    file = next(iter(kept().values()))
    odd = Subject("odd", 1, DriveFile(**{**vars(made.file), "formula": "\x01<&>", "values": file.values}))
    assert only(root_of(odd), "FileHeader").get("description", "").startswith("?<&> (base)")
