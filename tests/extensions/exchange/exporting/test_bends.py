"""Drives on a bent road: limits on bends, and exports against an independent integration."""

import json
import math
import random
from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import roadproof as rp
from extensions.exchange.exporting.integration import integrated
from roadproof.errors import InputError, UsageError
from roadproof.evidence.drive_file import DriveFile, drive_data, load_drive, read_drive
from roadproof.evidence.judged import judge_file
from roadproof.extensions.exchange.commonroad import read_commonroad
from roadproof.extensions.exchange.export import commonroad, openscenario
from roadproof.extensions.exchange.export.points import centre
from roadproof.extensions.exchange.export.subject import subject_of
from roadproof.extensions.exchange.openscenario import read_scenario
from roadproof.library.loading import bundled_library
from roadproof.semantics.exact.algebraic import as_float
from roadproof.semantics.exact.replay import first_breach
from roadproof.world.bends import on_bends
from roadproof.world.drive import Drive, motion_of
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.motion import state_at

pytestmark = pytest.mark.usefixtures("searched_once")

ROOT = Path(__file__).parents[4]
MAP = ROOT / "examples/maps/motorway.xodr"
DRIVES = sorted((ROOT / "examples/traffic/drives").glob("*.json"))
CAR, ROAD = load_vehicle("car"), load_road(f"{MAP}#lanes=right")


def turning(speed: str, a_lat: str = "0") -> Drive:
    """A car that enters the bend at 250 m."""
    across = [(F(1), F(a_lat))] if F(a_lat) else []
    return Drive({"SV": motion_of((F(9, 2), F(9, 5)), (F(250), F(-4)), (F(speed), F(0)), [], across)})


def file_of(drive: Drive) -> DriveFile:
    return DriveFile(None, "base", "v_lon(SV) > 0 m/s", F(8), {}, {}, {}, ROAD, drive)


def test_a_drive_that_is_too_fast_for_a_bend_breaks_a_limit() -> None:
    assert ROAD.line is not None
    limits = {"SV": CAR}
    assert first_breach(turning("39"), limits, None, ROAD.line) is None  # 3.8 m/s² at most
    broken = first_breach(turning("40"), limits, None, ROAD.line)
    assert broken is None  # 40² / 400 = 4 m/s², no more
    swerving = first_breach(turning("39", "0.3"), limits, F(8), ROAD.line)
    assert swerving is None  # the swerve is over before the bend
    narrow = replace(CAR, a_bend=F(3))
    broken = first_breach(turning("39"), {"SV": narrow}, F(20), ROAD.line)
    assert broken is not None
    assert broken.rule.startswith("|v_lon²·κ + a_lat| <= 3 m/s²")
    # On the spiral, which begins at 300 m: κ = 3/39², so (3/39² / (1/400)) of 120 m.
    place = 250 + 39 * float(as_float(broken.time))
    assert place == pytest.approx(300 + 120 * 400 * 3 / 39**2, abs=0.01)


def test_a_search_slows_vehicles_down_and_says_so() -> None:
    slower = on_bends(CAR, ROAD.line)
    assert slower.v_lon == (15, F(3162, 100))
    assert (slower.v_lon[1] ** 2 / 400 + F(3, 2)) <= 4 < (slower.v_lon[1] + F(1, 100)) ** 2 / 400 + F(3, 2)
    assert slower.name == "car on bends of radius 400 m or more (|v_lon²·κ + a_lat| <= 4 m/s²)"
    assert on_bends(CAR, None) == CAR
    assert on_bends(CAR, load_road(f"{MAP}#lanes=right").line).cruise == (22, F(3162, 100))


def test_a_bend_that_is_too_tight_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.xodr"
    begin = '<geometry s="0" x="0" y="0" hdg="0" length="90">'
    tight = f'<planView>{begin}<arc curvature="0.05"/></geometry></planView>'
    lane = '<right><lane id="-1" type="driving"><width sOffset="0" a="4" b="0" c="0" d="0"/></lane></right>'
    lanes = f'<lanes><laneSection s="0"><center/>{lane}</laneSection></lanes>'
    path.write_text(f'<OpenDRIVE><road id="1" length="90" junction="-1">{tight}{lanes}</road></OpenDRIVE>')
    with pytest.raises(UsageError, match=r"on a bend of radius 20 m it drives at most 7\.07 m/s"):
        on_bends(CAR, load_road(path).line)


def test_a_drive_file_keeps_road_and_map() -> None:
    file = file_of(turning("30"))
    data = drive_data(file, None)
    assert read_drive(data, "here").road == ROAD
    broken = {**data, "road": {**data["road"], "line": [{**data["road"]["line"][1], "curvature": None}]}}
    with pytest.raises(InputError, match="line 1: curvature is missing"):
        read_drive(broken, "here")


@pytest.mark.parametrize("path", DRIVES, ids=lambda x: x.stem)
def test_a_verdict_is_the_same_on_every_road_with_the_same_lanelets(path: Path) -> None:
    file, library = load_drive(path), bundled_library()
    bent = replace(file, road=replace(file.road, line=ROAD.line))
    one, other = judge_file(file, library), judge_file(bent, library)
    assert (one.accepted, one.reason) == (other.accepted, other.reason)
    moved = random.Random(path.stem).choice(list(file.drive.vehicles))
    motion = file.drive.vehicles[moved]
    vehicles = {**file.drive.vehicles, moved: replace(motion, s=motion.s + 3)}
    changed = Drive(vehicles, file.drive.custom_signals)
    one, other = (judge_file(replace(x, drive=changed), library) for x in (file, bent))
    assert (one.accepted, one.reason) == (other.accepted, other.reason)


def test_exports_agree_with_an_integration() -> None:
    drive = turning("30", "0.5")
    subject = subject_of("one", 1, file_of(drive), 10)
    motion = drive.vehicles["SV"]
    states = subject.samples["SV"]
    s, d = np.array([[float(v) for v in centre(x, motion.length, motion.width)] for x in states]).T
    x, y, turned = integrated(s, d)
    root = ElementTree.fromstring(commonroad.files(subject)["one.xml"])
    nodes = next(root.iter("dynamicObstacle"))
    places = [*nodes.findall("initialState"), *nodes.findall("trajectory/state")]
    for k, node in enumerate(places):
        told = [float(node.findtext(f"position/point/{v}", "")) for v in "xy"]
        assert math.hypot(told[0] - x[k], told[1] - y[k]) < 0.01
        assert abs(float(node.findtext("orientation/exact", "")) - turned[k]) < 1e-5
    speeds = np.array([float(node.findtext("velocity/exact", "")) for node in places])
    measured = np.hypot(np.diff(x), np.diff(y)) * 10
    aside = np.array([float(v.v_lat) for v in states])
    assert np.abs(np.hypot(speeds, aside)[:-1] - measured).max() < 0.05  # means over 0.1 s
    middle = (np.hypot(speeds, aside)[1:] + np.hypot(speeds, aside)[:-1]) / 2
    assert np.abs(middle - measured).max() < 0.02
    along = [float(node.findtext("acceleration/exact", "")) for node in places]
    yaw = np.gradient(turned, 0.1)  # the rate of the speed along the box, less the speed aside times this
    inner = np.abs(np.subtract.outer(s, [300, 420])).min(axis=1) > 6  # where no curve ends
    assert np.abs(along - (np.gradient(speeds, 0.1) - aside * yaw))[inner].max() < 0.005


def test_motion_is_read_back_from_commonroad(tmp_path: Path) -> None:
    drive = turning("30", "0.5")
    subject = subject_of("one", 1, file_of(drive), 25)
    (tmp_path / "one.xml").write_bytes(commonroad.files(subject)["one.xml"])
    found = read_commonroad(tmp_path / "one.xml")
    states = subject.samples["SV"]
    v_lon, v_lat, a_lat = (
        np.array([float(getattr(x, v)) for x in states]) for v in ("v_lon", "v_lat", "a_lat")
    )
    assert np.abs(np.gradient(found.s, 1 / 25) - found.v_lon).max() < 0.01
    # s is measured along the middle of the right lane, 1.875 m outside of the map's line.
    bend = np.interp(
        found.s - float(drive.vehicles["SV"].length) / 2, [300, 420, 1020], [0, 1 / 400, 1 / 400]
    )
    assert np.abs(found.v_lon - v_lon * (1 + 1.875 * bend)).max() < 0.01
    assert np.abs(found.v_lat - v_lat).max() < 0.02
    assert np.abs(found.a_lat - a_lat).max() < 0.001
    smooth = np.abs(np.subtract.outer(found.s, [300, 420])).min(axis=1) > 30  # where no curve ends
    assert np.abs(found.a_lon - np.gradient(v_lon * (1 + 1.875 * bend), 1 / 25))[smooth].max() < 0.01
    assert np.count_nonzero(smooth & (found.s > 330) & (found.s < 390)) > 40


def test_a_scenario_is_read_back_where_it_was(tmp_path: Path) -> None:
    drive = turning("30", "0.5")
    subject = subject_of("one", 1, file_of(drive), 25)
    for name, content in openscenario.files(subject).items():
        (tmp_path / name).write_bytes(content)
    assert (tmp_path / "motorway.xodr").read_bytes() == MAP.read_bytes()
    found = read_scenario(tmp_path / "one.xosc")
    table, road = found.table, found.road
    assert road.lanelets == ROAD.lanelets
    motion = drive.vehicles["SV"]
    for k, time in enumerate(table.columns["time"]):
        state = state_at(motion, F(float(time)))
        assert abs(table.columns["s"][k] - float(state.s)) < 0.01
        assert abs(table.columns["d"][k] - float(state.d)) < 0.01
        assert abs(table.columns["v_lon"][k] - float(state.v_lon)) < 0.02


def test_a_witness_on_the_motorway_is_judged_again_with_check(tmp_path: Path) -> None:
    found = rp.witness(9, road=f"{MAP}#lanes=right", out=tmp_path, pictures=False)
    assert found.verdict is rp.Verdict.WITNESSED
    assert rp.check(tmp_path).accepted


def test_answers_on_a_bent_road_state_the_largest_error_of_lengths(tmp_path: Path) -> None:
    road = f"{MAP}#lanes=right"
    # The curvature is at most 1/400 1/m, on 840 m. The merge lane reaches to d = -11 m, main lanes to 7.5 m.
    said = {"per_cent": pytest.approx(100 * 11 / 400), "metres": pytest.approx(840 * 7.5 / 400)}
    found = rp.witness(9, road=road, pictures=False)
    file = found.drives[0].file
    formula = "v_lon(SV) > 0 m/s"
    answers = [
        found,
        rp.compare(formula, formula, road=road),
        rp.prove(formula, engine="milp", road=road, horizon=1),
        rp.explore(formula, vary={"SV.a_lon.min": (-3, -1)}, steps=2, road=road, out=tmp_path),
        rp.monitor(9, file),
    ]
    for x in answers:
        assert x.as_data()["length_error"] == said
        assert x.length_error is not None
        assert float(100 * x.length_error.share) == said["per_cent"]
    straight = replace(file, road=replace(file.road, line=None))
    assert "length_error" not in rp.monitor(9, straight).as_data()
    assert rp.monitor(9, straight).length_error is None
    assert rp.check(tmp_path).accepted


def test_a_map_that_is_another_one_is_not_exported(tmp_path: Path) -> None:
    """Also no file that a drive of somebody else names as its map."""
    path = tmp_path / "a.xodr"
    path.write_bytes(MAP.read_bytes())
    own = replace(file_of(turning("30")), road=load_road(f"{path}#lanes=right"))
    path.write_text(MAP.read_text().replace('a="3.75"', 'a="3.5"'))
    with pytest.raises(InputError, match="the map has another road than drive one"):
        openscenario.files(subject_of("one", 1, own, 25))
    path.write_text("secret")
    with pytest.raises(InputError, match="no well-formed XML"):
        openscenario.files(subject_of("one", 1, own, 25))


def test_two_maps_of_one_name_are_not_exported_together(tmp_path: Path) -> None:
    drives = []
    for k, name in enumerate(("A 99", "A 98")):
        path = tmp_path / str(k) / "a.xodr"
        path.parent.mkdir()
        path.write_text(MAP.read_text().replace('name="A 99"', f'name="{name}"'))
        data = drive_data(replace(file_of(turning("30")), road=load_road(f"{path}#lanes=right")), None)
        drives.append(tmp_path / f"drive{k}.json")
        drives[-1].write_text(json.dumps(data | {"verdict": None}))
    with pytest.raises(InputError, match="drive1: another drive has another a"):
        rp.export(drives, to="opendrive", out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_drives_on_one_map_share_it(tmp_path: Path) -> None:
    rp.witness("4", "8", road=f"{MAP}#lanes=left", out=tmp_path / "found", pictures=False)
    made = rp.export(tmp_path / "found", to="openscenario", out=tmp_path / "out")
    assert sorted(x.name for x in made.files) == sorted(x.name for x in (tmp_path / "out").iterdir())
    assert str(made).startswith("2 drives as openscenario: 3 files in ")


def test_a_catalogue_says_which_tests_are_on_bends(tmp_path: Path) -> None:
    (tmp_path / "one.json").write_text(json.dumps(drive_data(file_of(turning("30")), None)), "utf-8")
    told = "one: road motorway bends: lengths in its lanes differ from those in s by up to 2.8 %, 16 m"
    assert [x for x in rp.catalogue(tmp_path).notes if x.startswith(told)]
