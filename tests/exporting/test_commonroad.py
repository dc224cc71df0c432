"""CommonRoad files: what the format demands, and what comes back of them is what was written."""

import xml.etree.ElementTree as ElementTree
from fractions import Fraction as F
from pathlib import Path

import numpy as np
import pytest

from exporting.kept import TURN, motion, subject, subjects
from exporting.test_opendrive import gap
from roadproof.recordings.export import commonroad
from roadproof.recordings.export.subject import Subject
from roadproof.recordings.formats.commonroad import read_commonroad
from roadproof.recordings.formats.recording import ZONES, Recording
from roadproof.world.models import names_of
from roadproof.world.motion import State
from roadproof.world.road import Lanelet
from roadproof.world.signals import RECORDED

Element = ElementTree.Element


def root_of(made: Subject) -> Element:
    (content,) = commonroad.files(made).values()
    return ElementTree.fromstring(content)


def read(made: Subject, folder: Path) -> Recording:
    for name, content in commonroad.files(made).items():
        (folder / name).write_bytes(content)
    return read_commonroad(folder / f"{made.name}.xml")


def occupied(state: State, length: F, width: F, lanelet: Lanelet) -> bool:
    """Positive overlap along and across, exactly."""
    low, high = lanelet.s
    along = (low is None or state.s > low) and (high is None or state.s - length < high)
    return along and state.d > lanelet.d[0] and state.d - width < lanelet.d[1]


def faults(made: Subject, recording: Recording) -> list[str]:
    """Where signals, lanes and zones of a recording are not those of the drive at its samples."""
    found = []
    for v, (name, car) in enumerate(made.vehicles.items()):
        rows = slice(recording.start[v], recording.start[v + 1])
        for signal in RECORDED:
            ours = np.array([float(getattr(x, signal)) for x in made.samples[name]])
            theirs = getattr(recording, signal)[rows]
            if signal in ("s", "d"):
                ours, theirs = ours - ours[0], theirs - theirs[0]
            wrong = np.abs(ours - theirs) > 1e-9
            if signal == "a_lat":  # which follows from velocityY, from one sample to the next
                wrong = wrong & np.roll(wrong, 1)
            found += [f"{name}: {signal} at sample {k}" for k in np.flatnonzero(wrong)]
        for k, state in enumerate(made.samples[name]):
            there = [x for x in made.file.road.lanelets if occupied(state, car.length, car.width, x)]
            row = recording.start[v] + k
            zones = {zone for bit, zone in enumerate(ZONES) if recording.zones[row] >> np.uint32(bit) & 1}
            if zones != {x.zone for x in there}:
                found.append(f"{name}: zones at sample {k}")
            if int(recording.occupancy[row]).bit_count() != len({x.lane for x in there}):
                found.append(f"{name}: lanes at sample {k}")
    return found


@pytest.mark.parametrize("made", subjects(), ids=lambda x: x.name)
def test_what_is_read_back_is_the_drive(made: Subject, tmp_path: Path) -> None:
    recording = read(made, tmp_path)
    assert not faults(made, recording)
    assert len(recording.lanes) == len(made.file.road.lanes)
    assert {len(pair) for pair in recording.beside} == {2}
    assert len(recording.beside) == len(made.file.road.adjacent)


@pytest.mark.parametrize("name", names_of("roads"))
def test_every_road_comes_back(name: str, tmp_path: Path) -> None:
    """Cars along all lanes from one end to the other, one of them where a ramp may be."""
    starts = [("-350", "3", "90", "0"), ("-350", "6", "80", "0")]
    if not name.startswith("main"):
        starts.append(("-350", "-1", "60", "0"))
    cars = {f"V{k}": motion((None, "0", "0"), start=x) for k, x in enumerate(starts, 1)}
    made = subject(name, "9", **cars)
    assert not faults(made, read(made, tmp_path))


def test_a_change_of_lane_crosses_the_marking_when_the_drive_does(tmp_path: Path) -> None:
    made = subject(SV=TURN)
    recording = read(made, tmp_path)
    both = [int(mask).bit_count() == 2 for mask in recording.occupancy]
    assert any(both)
    assert not faults(made, recording)


@pytest.mark.parametrize(
    ("tag", "planted"), [("x", 2.25), ("y", 0.9), ("velocityY", 0.02), ("orientation", 0.01)]
)
def test_planted_fault_another_reference_point_is_noticed(tag: str, planted: float, tmp_path: Path) -> None:
    """The corner in place of the centre, or a box that is turned, is not what was judged."""
    made = subject(
        "merge", SV=TURN, POV=motion(("1", "0", "0"), (None, "-2", "0"), start=("295", "0", "20", "0"))
    )
    root = root_of(made)
    for state in root.findall(".//dynamicObstacle//state") + root.findall(".//dynamicObstacle/initialState"):
        for node in state.findall(f".//{tag}"):
            number = node if tag in "xy" else node.find("exact")
            assert number is not None
            number.text = str(float(number.text or "") + planted)
    path = tmp_path / "wrong.xml"
    path.write_bytes(ElementTree.tostring(root))
    assert faults(made, read_commonroad(path))


def test_what_the_format_demands_is_there() -> None:
    made = subject("merge", SV=TURN, POV=motion((None, "0", "0"), start=("60", "3", "20", "0")))
    root = root_of(made)
    assert {"commonRoadVersion": "2020a", "timeStepSize": "0.04"}.items() <= root.attrib.items()
    kinds = ["location", "scenarioTags", *["lanelet"] * 7, *["dynamicObstacle"] * 2, "planningProblem"]
    assert [x.tag for x in root] == kinds
    ids = [x.get("id") for x in root if x.get("id")]
    assert len(set(ids)) == len(ids)
    refs = {x.get("ref") for x in root.iter() if x.get("ref")}
    assert refs < {*ids}
    types = {x.get("id"): [y.text for y in x.findall("laneletType")] for x in root.findall("lanelet")}
    assert [types[str(1001 + k)][1] for k in range(7)].count("accessRamp") == 1
    for node in root.findall("dynamicObstacle"):
        steps = [int(x.text or "") for x in node.findall(".//time/exact")]
        assert steps == [*range(101)]
    problem = root.find("planningProblem")
    assert problem is not None
    assert problem.findtext("initialState/velocity/exact") == "30"
    assert problem.findtext("goalState/time/intervalStart") == "100"


def test_neighbours_are_those_of_one_zone() -> None:
    """After the departure zone the ramp lies beside the road, but is no part of it."""
    lanelets = root_of(subject("depart")).findall("lanelet")
    near = {
        x.get("id"): tuple(y.get("ref") for y in x if y.tag in ("adjacentLeft", "adjacentRight"))
        for x in lanelets
    }
    assert near["1004"] == ("1003", "1005")
    assert near["1007"] == ("1006",)
    assert near["1008"] == ()


def test_what_lies_apart_is_no_neighbour(tmp_path: Path) -> None:
    made = subject(gap(), SV=motion((None, "0", "0"), start=("10", "2.6", "20", "0")))
    assert not any(x.tag.startswith("adjacent") for x in root_of(made).iter())
