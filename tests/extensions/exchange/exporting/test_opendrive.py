"""OpenDRIVE files: the lanes that they describe are those of the road, section by section."""

import math
import re
import tomllib
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction as F
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from extensions.exchange.exporting.shipped_drives import TURN, motion, shipped_drives, subject, subjects
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.exchange.commonroad import read_commonroad
from roadproof.extensions.exchange.export import commonroad, opendrive, openscenario, points
from roadproof.extensions.exchange.export.subject import MARGIN, ExportSubject, lay_out, span_of
from roadproof.extensions.traffic.formats.recording import ZONES, Recording
from roadproof.world.models import load_road, names_of
from roadproof.world.motion import State, state_at
from roadproof.world.road import Lanelet, Road
from roadproof.world.signals import RECORDED

Element = ElementTree.Element
Cell = tuple[str, str, str, F, F, F, F]
ATTRIBUTES = {"driving": "main", "entry": "merge", "exit": "departure"}


def root_of(made: ExportSubject) -> Element:
    return ElementTree.fromstring(opendrive.road_file(made))


def sections(root: Element) -> list[tuple[F, F, Element]]:
    """Begin and end of each section along x."""
    (road,) = root.findall("road")
    (line,) = road.findall("planView/geometry")
    assert (line.get("hdg"), [x.tag for x in line]) == ("0", ["line"])
    assert line.get("length") == road.get("length")
    places = [F(x.get("s", "")) for x in road.iter("laneSection")] + [F(road.get("length", ""))]
    begin = F(line.get("x", ""))
    each = zip(pairwise(places), road.iter("laneSection"), strict=True)
    return [(begin + a, begin + b, node) for (a, b), node in each]


def cells(root: Element) -> list[Cell]:
    """Lane, zone, attribute and rectangle of each lane in each section, as a reader of the file has them."""
    found = []
    (line,) = root.findall("road/planView/geometry")
    for low, high, section in sections(root):
        edge = F(line.get("y", ""))
        for number, lane in enumerate(section.findall("right/lane"), 1):
            assert lane.get("id") == str(-number)
            (width,) = lane.findall("width")
            right = edge - F(width.get("a", ""))
            if lane.get("type") != "none":
                said = {x.get("code", ""): x.get("value", "") for x in lane.findall("userData")}
                place = (low, high, right, edge)
                kind = ATTRIBUTES[lane.get("type", "")]
                found.append((said["roadproof:lane"], said["roadproof:zone"], kind, *place))
            edge = right
    return found


def expected(made: ExportSubject) -> list[Cell]:
    """The same from the road, cut wherever a lanelet begins or ends."""
    layout = made.layout
    ends = {x for lanelet in made.file.road.lanelets for x in lanelet.s if x is not None}
    places = sorted({layout.low, layout.high, *ends})
    found = []
    for low, high in pairwise(places):
        for x in made.file.road.lanelets:
            if (x.s[0] is None or x.s[0] <= low) and (x.s[1] is None or high <= x.s[1]):
                found.append((x.lane, x.zone, x.attribute, low, high, *x.d))
    return found


@pytest.mark.parametrize("name", names_of("roads"))
def test_lanes_are_those_of_the_road(name: str) -> None:
    made = subject(name)
    assert sorted(cells(root_of(made))) == sorted(expected(made))


@pytest.mark.parametrize("name", names_of("roads"))
def test_our_own_reader_of_such_roads_finds_the_same_lanes(name: str, tmp_path: Path) -> None:
    """s counts from the begin of the file's road there, d from its left edge; ``userData`` says the zones.

    Without it main lanes beside a departure lane are in its zone even beyond it, as types of lanes go.
    """
    made = subject(name)
    for file, content in opendrive.files(made).items():
        (tmp_path / file).write_bytes(content)
    left = max(x.d[1] for x in made.file.road.lanelets)
    begin = made.layout.low

    def zones_read() -> dict[tuple[object, ...], str]:
        return {
            (
                x.lane,
                x.attribute,
                begin + (x.s[0] or 0),
                begin + (x.s[1] or 0),
                left + x.d[0],
                left + x.d[1],
            ): x.zone
            for x in load_road(path).lanelets
        }

    path = tmp_path / "made.xodr"
    ours = {(lane, kind, *place): zone for lane, zone, kind, *place in expected(made)}
    assert zones_read() == ours
    path.write_text(path.read_text().replace("roadproof:zone", "another:zone"))
    read = zones_read()
    assert read.keys() == ours.keys()
    other = {key[0] for key, zone in ours.items() if read[key] != zone}
    assert other == ({"main-1", "main-2"} if name in ("depart", "weave") else set())


def gap() -> Road:
    """A ramp that lies beside the main road with 2 m of grass between, and joins it later."""
    main = Lanelet("a", "main-1", "main", "main", (None, None), (F(0), F("3.5")))
    far = Lanelet("b", "ramp", "merge", "merge", (F(0), F(100)), (F("-5.5"), F(-2)))
    return Road("gap", (main, far), frozenset())


def test_what_lies_between_lanes_is_a_lane_of_no_type() -> None:
    made = subject(gap())
    root = root_of(made)
    assert sorted(cells(root)) == sorted(expected(made))
    middle = sections(root)[1][2]
    assert [x.get("type") for x in middle.findall("right/lane")] == ["driving", "none", "entry"]
    assert [x.find("roadMark").get("type") for x in middle.findall("right/lane")] == ["solid"] * 3  # type: ignore[union-attr]


def test_overlapping_lanelets_are_refused() -> None:
    road = gap()
    wide = replace(road.lanelets[1], d=(F(-2), F(1)))
    with pytest.raises(InputError, match="s = 0 m to 100 m: lanelets a and b overlap"):
        opendrive.road_file(subject(replace(road, lanelets=(road.lanelets[0], wide))))


def test_a_road_with_a_gap_along_it_is_refused() -> None:
    here = Lanelet("a", "main-1", "main", "main", (F(0), F(50)), (F(0), F("3.5")))
    there = replace(here, id="b", lane="main-9", s=(F(60), F(90)))
    with pytest.raises(InputError, match="s = 50 m to 60 m: there is no lanelet"):
        opendrive.road_file(subject(Road("torn", (here, there), frozenset())))


def test_lanes_are_linked_along_the_road_and_nowhere_else() -> None:
    """Ids change where a lane begins on the left; a ramp that ends is linked to nothing."""
    base = load_road("merge")
    left = Lanelet("l", "main-3", "merge", "main", (F(-100), F(300)), (F(7), F("10.5")))
    road = replace(base, lanelets=(*base.lanelets, left))
    links = {}
    for k, (_, _, section) in enumerate(sections(root_of(subject(road)))):
        for lane in section.findall("right/lane"):
            ends = {x.tag: x.get("id") for x in lane.findall("link/*")}
            links[k, lane.get("id")] = (ends.get("predecessor"), ends.get("successor"))
    assert links == {
        **{(0, "-1"): (None, None), (0, "-2"): (None, "-2"), (0, "-3"): (None, "-3")},
        **{(1, "-1"): (None, None), (1, "-2"): ("-2", "-2"), (1, "-3"): ("-3", "-3")},
        **{(1, "-4"): (None, None), (2, "-1"): (None, None), (2, "-2"): ("-2", None)},
        (2, "-3"): ("-3", None),
    }


@pytest.mark.parametrize(("speed", "limit"), [("30", "130"), ("36", "130"), ("40", "150")])
def test_the_speed_is_said_twice(speed: str, limit: str) -> None:
    """Some readers look at one place, some at the other."""
    root = root_of(subject(SV=motion((None, "0", "0"), start=("0", "2", speed, "0"))))
    found = {(x.get("max"), x.get("unit")) for x in root.iter("speed")}
    assert found == {(limit, "km/h")}
    assert root.find("road/type/speed") is not None
    driven = [x for x in root.iter("lane") if x.get("type") == "driving"]
    assert all(x.find("speed") is not None for x in driven)


def test_markings_are_broken_between_lanes_of_one_zone() -> None:
    kinds = [
        [x.find("roadMark").get("type") for x in section.findall("right/lane")]  # type: ignore[union-attr]
        for _, _, section in sections(root_of(subject("depart")))
    ]
    assert kinds == [["broken", "solid"], ["broken", "broken", "solid"], ["broken", "solid", "solid"]]


def test_the_road_goes_as_far_as_the_drive_and_a_margin() -> None:
    car = motion(("2", "-10", "0"), (None, "0", "0"), start=("0", "2", "15", "0"))
    assert span_of([car], F(2)) == (F("-4.5"), F("11.25"))  # foremost at 1.5 s, 10 m at the end
    layout = lay_out(load_road("main-2"), (F("-4.5"), F("11.25")))
    assert (layout.low, layout.high) == (-5 - MARGIN, 12 + MARGIN)
    assert layout.cut_note == "road main-2, cut to s = -105 m to 112 m"
    assert root_of(subject()).find("header").get("name") == subject().layout.cut_note  # type: ignore[union-attr]


# --- CommonRoad files: what the format demands, and what comes back of them is what was written -----


def commonroad_root(made: ExportSubject) -> Element:
    return ElementTree.fromstring(commonroad.files(made)[f"{made.name}.xml"])


def read(made: ExportSubject, folder: Path) -> Recording:
    for name, content in commonroad.files(made).items():
        (folder / name).write_bytes(content)
    return read_commonroad(folder / f"{made.name}.xml")


def occupied(state: State, length: F, width: F, lanelet: Lanelet) -> bool:
    """Positive overlap along and across, exactly."""
    low, high = lanelet.s
    along = (low is None or state.s > low) and (high is None or state.s - length < high)
    return along and state.d > lanelet.d[0] and state.d - width < lanelet.d[1]


def faults(made: ExportSubject, recording: Recording) -> list[str]:
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
def test_what_is_read_back_is_the_drive(made: ExportSubject, tmp_path: Path) -> None:
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
    root = commonroad_root(made)
    for state in root.findall(".//dynamicObstacle//state") + root.findall(".//dynamicObstacle/initialState"):
        for node in state.findall(f".//{tag}"):
            number = node if tag in "xy" else node.find("exact")
            assert number is not None
            number.text = str(float(number.text or "") + planted)
    path = tmp_path / "wrong.xml"
    path.write_bytes(ElementTree.tostring(root))
    assert faults(made, read_commonroad(path))


def test_neighbours_are_those_beside_also_after_a_zone() -> None:
    """After the departure zone the ramp lies beside the road, which the file with zones calls main."""
    lanelets = commonroad_root(subject("depart")).findall("lanelet")
    near = {
        x.get("id"): tuple(y.get("ref") for y in x if y.tag in ("adjacentLeft", "adjacentRight"))
        for x in lanelets
    }
    assert near["1004"] == ("1003", "1005")
    assert near["1007"] == ("1006", "1008")
    assert near["1008"] == ("1007",)
    zones = tomllib.loads(commonroad.files(subject("depart"))["made_zones.toml"].decode())
    assert zones == {"lanelet": [{"id": 1006, "zone": "main"}, {"id": 1007, "zone": "main"}]}


def test_what_lies_apart_is_no_neighbour(tmp_path: Path) -> None:
    made = subject(gap(), SV=motion((None, "0", "0"), start=("10", "2.6", "20", "0")))
    assert not any(x.tag.startswith("adjacent") for x in commonroad_root(made).iter())


# --- OpenSCENARIO files read by what the format says of them, and played against the exact motion ---


def openscenario_root(made: ExportSubject) -> Element:
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
def test_a_player_of_the_file_is_within_its_bound_of_the_drive(made: ExportSubject) -> None:
    root = openscenario_root(made)
    said = re.search(r"within ([0-9.]+) m of the drive", only(root, "FileHeader").get("description", ""))
    assert said is not None
    assert farthest(root, made.file) <= float(said[1]) <= 0.01


@pytest.mark.parametrize(
    ("planted", "shift"),
    [("front axle", 2.7), ("centre", 1.35), ("a vertex is 2 cm to the left", 0.02)],
)
def test_planted_fault_another_reference_point_of_a_box_is_noticed(planted: str, shift: float) -> None:
    made = subject(SV=TURN)
    root = openscenario_root(made)
    assert farthest(root, made.file) <= 0.01
    for vertex in root.iter("Vertex"):
        place = only(vertex, "Position/WorldPosition")
        name = "y" if shift < 1 else "x"
        place.set(name, str(float(place.get(name, "")) + shift))
    assert farthest(root, made.file) > 0.01


def test_the_heading_is_that_of_the_motion_at_every_vertex() -> None:
    made = subject(SV=TURN)
    for vertex in openscenario_root(made).iter("Vertex"):
        state = state_at(TURN, F(vertex.get("time", "")))
        (turned,) = numbers(only(vertex, "Position/WorldPosition"), "h")
        assert turned == pytest.approx(math.atan2(state.v_lat, state.v_lon), abs=1e-12)


def test_boxes_are_those_of_the_drive_and_corners_are_as_far_off_as_said() -> None:
    made = subject(SV=TURN, POV=motion((None, "0", "0"), start=("60", "3", "20", "0"), size=("9", "2.5")))
    root = openscenario_root(made)
    box = only(root, ".//ScenarioObject[@name='POV']//Dimensions")
    assert numbers(box, "length", "width") == [9, 2.5]
    kinds = [x.get("vehicleCategory") for x in root.iter("Vehicle")]
    assert kinds == ["car", "truck"]
    turned = max(abs(x[2]) for x in boxes(root, "SV", [k / 50 for k in range(200)]))
    said = re.search(r"corners up to ([0-9.]+) m", only(root, "FileHeader").get("description", ""))
    assert said is not None
    corner = math.hypot(4.5, 1.8) / 2
    assert 2 * math.sin(turned / 2) * corner == pytest.approx(float(said[1]), abs=2e-3)


def test_a_name_that_xml_cannot_hold_is_written_plainly(tmp_path: Path) -> None:
    made = subject(SV=TURN)
    file = next(iter(shipped_drives().values()))
    odd = ExportSubject(
        "odd", 1, DriveFile(**{**vars(made.file), "formula": "\x01<&>", "values": file.values})
    )
    assert only(openscenario_root(odd), "FileHeader").get("description", "").startswith("?<&> (base)")


# --- Reference points, by hand: a car of 4.5 m by 1.8 m whose front-left corner is at s = 10 m, d = 2.6 m

CAR = motion((None, "0", "0"))
STATE = state_at(CAR, F(0))


def test_the_centre_is_half_a_length_behind_and_half_a_width_to_the_right() -> None:
    assert points.centre(STATE, CAR.length, CAR.width) == (F("7.75"), F("1.7"))


def test_upper_left_is_the_rear_left_corner_of_a_box_that_drives_right_with_y_down() -> None:
    assert points.upper_left(STATE, CAR.length) == (F("5.5"), F("-2.6"))


def test_the_rear_axle_is_a_fifth_of_the_length_ahead_of_the_rear() -> None:
    assert points.axle_to_centre(CAR.length) == F("1.35")
    assert points.rear_axle(STATE, CAR, 0.0) == pytest.approx((5.5 + 0.9, 1.7))


def test_a_turned_box_is_turned_about_its_centre() -> None:
    x, y = points.rear_axle(STATE, CAR, math.pi / 2)
    assert (x, y) == pytest.approx((7.75, 1.7 - 1.35))


@pytest.mark.parametrize(
    ("v_lon", "v_lat", "turned"), [(30, 0, 0.0), (1, 1, math.pi / 4), (20, -2, -math.atan(0.1)), (0, 0, None)]
)
def test_the_heading_is_that_of_the_motion(v_lon: int, v_lat: int, turned: float | None) -> None:
    state = State(F(0), F(0), F(0), F(v_lon), F(v_lat), F(0), F(0), F(0))
    assert points.heading(state) == pytest.approx(turned)
