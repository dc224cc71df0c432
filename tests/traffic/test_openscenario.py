"""Trajectories of OpenSCENARIO: drives exported and read again, turned roads, and damaged files."""

import math
import re
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree as xml

import numpy as np
import pytest

import roadproof as rp
from exporting.kept import kept
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.recordings.evaluate.one_trace import read_samples
from roadproof.recordings.export.openscenario import files
from roadproof.recordings.export.subject import Subject
from roadproof.recordings.formats import openscenario
from roadproof.recordings.formats.openscenario import RATE, read_columns, read_recording
from roadproof.recordings.formats.sources import find_source
from roadproof.world.motion import state_at
from roadproof.world.signals import RECORDED

NEAR = {"s": 0.012, "d": 0.012, "v_lon": 0.25, "v_lat": 0.25}
"""m and m/s: vertices are rounded to the millimetre, and speeds at them are estimated."""
SOME = [kept()[f"scenario-{number:02d}-base"] for number in (1, 2, 4, 12, 20)]


def put(folder: Path, file: DriveFile) -> Path:
    for name, content in files(Subject("drive", 1, file)).items():
        (folder / name).write_bytes(content)
    return folder / "drive.xosc"


@pytest.mark.parametrize("file", SOME, ids=lambda x: f"{x.scenario}-{x.set_name}")
def test_a_drive_comes_back(file: DriveFile, tmp_path: Path) -> None:
    table, road, _ = read_columns(put(tmp_path, file))
    assert {*table["vehicle"]} == {*file.drive.vehicles}
    right = min(lanelet.d[0] for lanelet in road.lanelets) - min(x.d[0] for x in file.road.lanelets)
    begin = None
    for name, motion in file.drive.vehicles.items():
        rows = table["vehicle"] == name
        assert len(table["time"][rows]) == math.floor(file.horizon * RATE) + 1
        for k, time in enumerate(table["time"][rows]):
            state = state_at(motion, Fraction(round(time * RATE), RATE))
            for signal, most in NEAR.items():
                found, true = table[signal][rows][k], float(getattr(state, signal))
                if signal == "s":  # s begins where the road of the file does
                    begin = found - true if begin is None else begin
                    true += begin
                true += float(right) if signal == "d" else 0.0
                assert abs(found - true) <= most, (name, time, signal)


def test_monitors_say_what_they_say_of_the_drive(tmp_path: Path) -> None:
    """Every scenario of the drive's vehicles, on the whole file as one trace with its names."""
    for file in SOME[:3]:
        path = put(tmp_path, file)
        trace = read_samples(path)
        assert {*trace.lanes} == {*file.drive.vehicles}
        assert file.scenario is not None
        assert rp.monitor(file.scenario, path, rp.load(file.set_name)).verdict == "true"


def turned(path: Path, by: float, at: tuple[float, float]) -> None:
    """The same, with the plane turned about the origin and moved."""
    cos, sin = math.cos(by), math.sin(by)

    def place(x: float, y: float) -> str:
        return f'x="{x * cos - y * sin + at[0]:.6f}" y="{x * sin + y * cos + at[1]:.6f}"'

    def vertex(found: re.Match[str]) -> str:
        x, y, h = map(float, found.groups())
        return f'<WorldPosition {place(x, y)} h="{h + by}"'

    def line(found: re.Match[str]) -> str:
        x, y = map(float, found.groups())
        return f'{place(x, y)} hdg="{by}"'

    path.write_text(re.sub(r'<WorldPosition x="(.*?)" y="(.*?)" h="(.*?)"', vertex, path.read_text("utf-8")))
    road = path.with_suffix(".xodr")
    road.write_text(re.sub(r'x="(.*?)" y="(.*?)" hdg="0"', line, road.read_text("utf-8")))


def test_a_road_may_lie_anywhere(tmp_path: Path) -> None:
    path = put(tmp_path, SOME[1])
    before = read_columns(path)[0]
    turned(path, 2.0, (1000.0, -300.0))
    after = read_columns(path)[0]
    for signal in RECORDED:
        assert np.allclose(before[signal], after[signal], atol=1e-3), signal


def test_it_is_a_format_of_recordings(tmp_path: Path) -> None:
    recording = find_source(put(tmp_path, SOME[0])).read()
    assert recording.rate == RATE
    assert "vehicles are numbered: SV is 1, POV is 2" in recording.notes
    assert recording.vehicles == 2


def without(tag: str) -> Callable[[str], str]:
    """The file without its first element of that tag."""

    def change(text: str) -> str:
        root = xml.fromstring(text)
        parent = next(x for x in root.iter() if x.find(tag) is not None)
        child = parent.find(tag)
        assert child is not None
        parent.remove(child)
        return xml.tostring(root, "unicode")

    return change


def exchanged(old: str, new: str) -> Callable[[str], str]:
    def change(text: str) -> str:
        assert old in text
        return text.replace(old, new, 1)

    return change


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (without("RoadNetwork"), "a LogicFile with filepath is needed"),
        (exchanged("drive.xodr", "drive.opt"), "a road in OpenDRIVE (.xodr) is needed"),
        (exchanged("drive.xodr", "none.xodr"), "none.xodr"),
        (without("Entities"), "there is no ScenarioObject"),
        (exchanged('<ScenarioObject name="SV"', '<ScenarioObject name="POV"'), "two ScenarioObjects"),
        (without("Vehicle"), "no Vehicle that is written out"),
        (exchanged('vehicleCategory="car"', 'vehicleCategory="tram"'), "vehicleCategory=tram is none of"),
        (
            exchanged('length="4.5"', 'length="long"'),
            "length of the Dimensions of ScenarioObject SV is 'long'",
        ),
        (exchanged('length="4.5"', 'length="$l"'), "parameters are not supported"),
        (without("ManeuverGroup"), "ScenarioObject SV follows no trajectory"),
        (
            exchanged('<EntityRef entityRef="SV"', '<EntityRef entityRef="NN"'),
            "there is no ScenarioObject NN",
        ),
        (exchanged('<EntityRef entityRef="POV"', '<EntityRef entityRef="SV"'), "SV follows two trajectories"),
        (without("TimeReference"), "a Timing with domainAbsoluteRelative=absolute"),
        (exchanged('domainAbsoluteRelative="absolute"', 'domainAbsoluteRelative="relative"'), "absolute"),
        (lambda text: text.replace("Polyline", "Nurbs"), "Shape Nurbs; a Polyline is needed"),
        (lambda text: text.replace("WorldPosition", "LanePosition"), "a WorldPosition is needed"),
        (exchanged('<Vertex time="0"', '<Vertex time="100"'), "each later than the one before"),
        (exchanged('<Vertex time="0"', '<Vertex time="nan"'), "a finite number is needed"),
        (without("RoutingAction"), "is no FollowTrajectoryAction"),
        (exchanged("<OpenSCENARIO>", "<!DOCTYPE x><OpenSCENARIO>"), "document type"),
        (lambda text: text[:900], "no well-formed XML"),
        (lambda text: text.replace("OpenSCENARIO", "OpenDRIVE"), "OpenSCENARIO is needed"),
    ],
)
def test_what_is_wrong_is_said(change: Callable[[str], str], told: str, tmp_path: Path) -> None:
    path = put(tmp_path, SOME[0])
    path.write_text(change(path.read_text("utf-8")), "utf-8")
    with pytest.raises(InputError) as error:
        read_recording(path)
    assert told in str(error.value)
    assert "drive.xosc" in str(error.value) or "xodr" in str(error.value)


# --- planted faults --------------------------------------------------------------------------------


def the_reference_point_is_the_centre(monkeypatch: pytest.MonkeyPatch) -> None:
    made = openscenario.Box
    monkeypatch.setattr(openscenario, "Box", lambda *told: made(*told[:4], (0, 0)))


def the_corner_is_the_centre(monkeypatch: pytest.MonkeyPatch) -> None:
    sampled = openscenario._sampled

    def shifted(path: Path, boxes: dict[str, openscenario.Box], ways: object) -> object:
        table = sampled(path, boxes, ways)  # type: ignore[arg-type]
        table["d"][:] -= table["width"] / 2
        return table

    monkeypatch.setattr(openscenario, "_sampled", shifted)


def speeds_of_the_last_vertex(monkeypatch: pytest.MonkeyPatch) -> None:
    speeds = openscenario._speeds
    monkeypatch.setattr(openscenario, "_speeds", lambda knots, places: np.roll(speeds(knots, places), 1))


def the_road_is_not_where_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(openscenario, "origin_of", lambda path: (0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    "plant",
    [the_corner_is_the_centre, speeds_of_the_last_vertex, the_road_is_not_where_it_is],
)
def test_a_planted_fault_is_noticed(
    plant: Callable[[pytest.MonkeyPatch], None], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    plant(monkeypatch)
    with pytest.raises(AssertionError):
        test_a_drive_comes_back(SOME[1], tmp_path)


def test_a_planted_reference_point_is_noticed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """As s begins anywhere, a box that is moved along shows in what the formulas say, and against samples."""
    honest = read_columns(put(tmp_path, SOME[1]))[0]["s"]
    the_reference_point_is_the_centre(monkeypatch)
    moved = read_columns(put(tmp_path, SOME[1]))[0]["s"]
    assert abs(np.median(honest - moved)) > 1
