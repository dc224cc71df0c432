"""Drives on a map in CommonRoad are exported with its lanelets, and read back with the same verdicts."""

import re
from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path
from xml.etree import ElementTree

import pytest

import roadproof as rp
from extensions.maps.measured_lanelets import RAMP, commonroad
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.exchange.export import commonroad as made
from roadproof.extensions.exchange.export import opendrive
from roadproof.extensions.exchange.export.registry import vehicle_ids_in
from roadproof.extensions.exchange.export.subject import ExportSubject
from roadproof.world.drive import Drive, motion_of
from roadproof.world.models import load_road

SIZE = (F(9, 2), F(9, 5))
SIGN = '<trafficSign id="1204"><trafficSignElement><trafficSignID>274</trafficSignID></trafficSignElement>'
MORE = f'<location><geoNameId>7</geoNameId></location>{SIGN}</trafficSign><dynamicObstacle id="1"/>'


def map_in(folder: Path, name: str = "mine", more: str = MORE, version: str = "2020a") -> Path:
    path = folder / f"{name}.xml"
    path.write_text(commonroad(RAMP, 1 / 400, version).replace("</commonRoad>", f"{more}</commonRoad>"))
    return path


def file_on(path: Path) -> DriveFile:
    """SV in the right lane; POV comes from the merge lane and brakes."""
    road = load_road(path)
    lanes = {x.lane: x.d for x in road.lanelets if x.zone == "merge"}
    centre, merging = (F(round(sum(lanes[x]) / 2 * 1000), 1000) for x in ("main-1", "merge-1"))
    begin = {
        "SV": (F(125), centre + SIZE[1] / 2),
        "POV": (F(160), merging + F(13, 10)),
    }  # 0.4 m to the left of SV in the end
    across = [(F(1), F(0)), (F(2), F(7, 8)), (F(2), F(-7, 8))]
    vehicles = {
        "SV": motion_of(SIZE, begin["SV"], (F(25), F(0)), [], []),
        "POV": motion_of(SIZE, begin["POV"], (F(22), F(0)), [(F(6), F(-1, 2), F(0))], across),
    }
    formula = "F danger(SV, POV) and F inMergeZone(POV) and F sameLane(SV, POV, L)"
    return DriveFile(None, "base", formula, F(6), {"L": "main-1"}, {}, {}, road, Drive(vehicles))


def test_the_lanelets_are_those_of_the_map(tmp_path: Path) -> None:
    path = map_in(tmp_path)
    subject = ExportSubject("one", 1, file_on(path))
    root = ElementTree.fromstring(made.files(subject)["one.xml"])
    theirs = ElementTree.parse(path).getroot()
    for tag in ("lanelet", "trafficSign", "location"):
        ours = [ElementTree.canonicalize(ElementTree.tostring(x), strip_text=True) for x in root.iter(tag)]
        wanted = [
            ElementTree.canonicalize(ElementTree.tostring(x), strip_text=True) for x in theirs.iter(tag)
        ]
        assert ours == wanted
        assert ours
    assert [x.get("id") for x in root.iter("dynamicObstacle")] == ["2001", "2002"]
    assert vehicle_ids_in("commonroad", subject) == {"SV": 2001, "POV": 2002}
    assert vehicle_ids_in("highd", subject) == {"SV": 1, "POV": 2}
    ids = [x.get("id") for x in root if x.get("id")]
    assert len(ids) == len({*ids})


def test_a_drive_on_a_map_is_read_back_with_the_same_verdicts(tmp_path: Path) -> None:
    file = file_on(map_in(tmp_path))
    done = rp.export(file, to="commonroad", out=tmp_path / "out")
    (exported,) = done.drives
    names = ",".join(map(str, exported.ids.values()))
    found = rp.monitor(file.formula, f"{exported.files[0]}:{names}")
    ours = rp.monitor(file.formula, file, view="recorded")
    assert found.verdict == ours.verdict == "true"
    for one, other in zip(ours.observed.strips, found.observed.strips, strict=True):
        assert re.sub("main-1", "21", one.name) == other.name
        assert len(one.true) == len(other.true), one.name
        for each, again in zip(one.true, other.true, strict=True):
            assert again == pytest.approx(each, abs=0.08), one.name


def test_zones_that_are_said_beside_the_map_come_with_it(tmp_path: Path) -> None:
    path = map_in(tmp_path)
    (tmp_path / "mine_zones.toml").write_text('[[lanelet]]\nid = "32"\nattribute = "main"\n')
    file = replace(file_on(map_in(tmp_path, "other")), road=load_road(path))
    exported = made.files(ExportSubject("one", 1, file))
    assert exported["one_zones.toml"] == (tmp_path / "mine_zones.toml").read_bytes()
    assert "other_zones.toml" not in made.files(ExportSubject("one", 1, file_on(tmp_path / "other.xml")))


def test_an_older_map_gives_lanelets_of_the_road(tmp_path: Path) -> None:
    """Other tools read files of 2020a, whose lanelets are said otherwise."""
    exported = made.files(ExportSubject("one", 1, file_on(map_in(tmp_path, version="2018b"))))
    root = ElementTree.fromstring(exported["one.xml"])
    assert {x.get("id") for x in root.iter("dynamicObstacle")} == {"1", "2"}
    assert min(int(x.get("id", "")) for x in root.iter("lanelet")) == made.FIRST_LANELET


def test_a_map_that_was_changed_is_refused(tmp_path: Path) -> None:
    path = map_in(tmp_path)
    subject = ExportSubject("one", 1, file_on(path))
    path.write_text(commonroad(RAMP, 1 / 300))
    with pytest.raises(InputError, match="the map has another road than drive one; find the drive again"):
        made.files(subject)


def test_an_opendrive_file_of_lanelets_has_no_steps_where_lanes_go_on(tmp_path: Path) -> None:
    """Edges of lanes are constant on lanelets; in the file they go over into each other in a metre."""
    shifted = (replace(x, d=(x.d[0] + 0.06, x.d[1] + 0.06)) if x.s[0] == 120 else x for x in RAMP)
    path = tmp_path / "mine.xml"
    path.write_text(commonroad([*shifted], 1 / 400))
    file = file_on(path)
    (made,) = opendrive.files(ExportSubject("one", 1, file)).values()
    (tmp_path / "one.xodr").write_bytes(made)
    sections = list(ElementTree.fromstring(made).iter("laneSection"))
    assert len(sections) == 3
    ends: dict[str, float] = {}
    for section in sections:
        begins, edge, edges = {}, 0.0, {}
        total = 0.0
        for lane in section.iter("lane"):
            widths = [{k: float(v) for k, v in x.attrib.items()} for x in lane.findall("width")]
            if not widths:
                continue
            first, last = widths[0], widths[-1]
            if len(widths) == 2:
                assert first["a"] + first["b"] * last["sOffset"] == pytest.approx(last["a"])
            name = next((x.get("value", "") for x in lane.findall("userData")), "")
            begins[name] = (edge, edge + first["a"])
            edge += first["a"]
            edges[name] = (total, total + last["a"])
            total += last["a"]
        for name in (begins.keys() & ends.keys()) - {""}:
            assert begins[name] == pytest.approx(ends[name])
        ends = edges
    again = load_road(tmp_path / "one.xodr")
    for x in file.road.lanelets:
        low, high = x.s
        assert low is not None
        assert high is not None
        there = [y for y in again.lanelets if y.lane == x.lane and y.s[0] < (low + high) / 2 < y.s[1]]
        assert [tuple(map(float, y.d)) for y in there] == [pytest.approx(tuple(map(float, x.d)))]
