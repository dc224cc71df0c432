"""inD, rounD and uniD on roads of maps: planted drives, who is left out, and damage."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from extensions.maps.test_maps import lane, road, section
from extensions.traffic.make_recording import Track, make_recording
from extensions.traffic.planar_exid import osm_of, write_exid
from extensions.traffic.test_exid import CASES, aside, cell, planted, rampwards, turn_over
from extensions.traffic.test_ngsim import matches, on_road
from extensions.traffic.test_topology import with_ramps
from extensions.traffic.tiny_ind import add_track, write_ind
from roadproof.errors import InputError, UsageError
from roadproof.extensions.traffic.evaluate.one_trace import read_pair
from roadproof.extensions.traffic.formats.recording import Floats
from roadproof.extensions.traffic.formats.sources import find_source, find_sources
from roadproof.reasons import ReasonKind
from tables import read_table

RATE = 25
CHART = "maps/location3.osm"


def main_road(folder: Path) -> str:
    return f"{folder / CHART}#road=1"


def test_a_map_in_degrees_counts_from_the_origin_of_the_recording(tmp_path: Path) -> None:
    recording, _ = planted(-95.0)
    ramps = with_ramps("merge")
    path = write_ind(recording, ramps, tmp_path / "a", rampwards)
    one = find_source(path, road=main_road(tmp_path / "a")).read()
    degrees = osm_of(ramps, rampwards, step=60.0, local=False)
    path = write_ind(recording, ramps, tmp_path / "b", rampwards, degrees)
    other = find_source(path, road=main_road(tmp_path / "b")).read()
    assert np.abs(one.s - other.s).max() < 0.01
    assert np.abs(one.d - other.d).max() < 0.01
    assert one.occupancy.tolist() == other.occupancy.tolist()


def beside_a_line(s: Floats, d: Floats) -> tuple[Floats, Floats, Floats]:
    """To the right of a line that begins in (10, 20), turned by 30 degrees."""
    turn = math.radians(30)
    x, y = s * np.cos(turn) - (d - 7) * np.sin(turn), s * np.sin(turn) + (d - 7) * np.cos(turn)
    return x + 10, y + 20, np.full_like(s, turn)


def test_a_road_in_opendrive(tmp_path: Path) -> None:
    recording, _ = planted(5.0)
    recording = replace(recording, vehicle_id=recording.vehicle_id - 1)
    path = write_ind(recording, with_ramps("merge"), tmp_path, beside_a_line)
    geometry = f'<geometry s="0" x="10" y="20" hdg="{math.radians(30)!r}" length="900"><line/></geometry>'
    chart = tmp_path / "location3.xodr"
    lanes = section(lane(-1) + lane(-2))
    chart.write_text(f"<OpenDRIVE><header/>{road(1, geometry, lanes, length='900')}</OpenDRIVE>")
    read = find_source(path, road=str(chart)).read()
    assert read.s == pytest.approx(recording.s, abs=2e-3)
    assert read.d + 7 == pytest.approx(recording.d, abs=2e-3)
    assert matches(read) == matches(on_road(recording, rp.road("main-2"), RATE))
    assert f"road {chart}: edges of its lanes are up to 0 m from the map's" in read.notes
    assert find_source(path, road=str(chart)).files[0] == chart


def around(radius: float, d: float, begin: float, speed: float = 12.0, count: int = 60) -> list[list[float]]:
    """A car at ``d`` beside a left bend of this radius that begins in the origin along x."""
    out = radius - d
    angles = [begin / radius + speed * k / RATE / out for k in range(count)]
    return [
        [
            out * math.sin(x),
            radius - out * math.cos(x),
            math.degrees(x),
            speed * math.cos(x),
            speed * math.sin(x),
        ]
        for x in angles
    ]


def bend_of(folder: Path, radius: float) -> str:
    """The map of a road with two lanes to the right of a left bend of ``radius``."""
    geometry = f'<geometry s="0" x="0" y="0" hdg="0" length="90"><arc curvature="{1 / radius!r}"/></geometry>'
    chart = folder / "location3.xodr"
    lanes = section(lane(-1) + lane(-2))
    chart.write_text(f"<OpenDRIVE><header/>{road(1, geometry, lanes, length='90')}</OpenDRIVE>")
    return str(chart)


def beside_bend(folder: Path, radius: float, cars: list[tuple[float, float]]) -> str:
    """The map of a bend, beside which recording 07 has these cars (d, begin) from 20 on."""
    for number, (d, begin) in enumerate(cars, start=20):
        add_track(folder, number, "car", (4.4, 1.8), around(radius, d, begin))
    return bend_of(folder, radius)


@pytest.mark.parametrize(("radius", "lost"), [(60.0, True), (400.0, False)])
@pytest.mark.parametrize("far", range(4))
def test_cars_far_beside_the_line_of_a_bend_are_left_out(
    radius: float, lost: bool, far: int, tmp_path: Path
) -> None:
    """At 5.25 m beside a line with a radius of 60 m a way is 8.8 % longer; 1.75 m beside it 2.9 %.

    Whichever car of the file that is: rows of the others stay theirs.
    """
    path = two_cars(tmp_path)
    cars = [(-5.25 if k == far else -1.75, 10.0 + 8 * k) for k in range(4)]
    chart = beside_bend(tmp_path, radius, cars)
    read = find_source(path, road=chart).read()
    expected = {20, 21, 22, 23} - ({20 + far} if lost else set())
    assert expected == {20, 21, 22, 23} & set(read.vehicle_id.tolist())
    names = [x for x in read.notes if "the reference line of the road does not follow their way" in x]
    told = f"left out 1 of {read.vehicles + 1} vehicles ({20 + far}): {ReasonKind.OFF_LINE()}"
    assert names == [told] * lost
    for number, (d, begin) in enumerate(cars, start=20):
        if number in expected:
            first = int(read.start[read.vehicle_id.tolist().index(number)])
            assert read.s[first] == pytest.approx(begin + 2.2, abs=0.1)
            assert read.d[first] == pytest.approx(d + 0.9, abs=0.1)
    if lost:
        with pytest.raises(InputError, match=rf"way of 1 of {read.vehicles + 1} vehicles \({20 + far}\)"):
            find_source(path, strict=True, road=chart).read()


@pytest.mark.parametrize("far", [20, 23])
def test_a_contradiction_is_named_where_it_is_after_a_vehicle_that_is_left_out(
    far: int, tmp_path: Path
) -> None:
    """Car 22 tells 3 m/s² for a second, and no other does."""
    path = two_cars(tmp_path)
    chart = beside_bend(tmp_path, 60.0, [(-5.25 if k + 20 == far else -1.75, 10.0 + 8 * k) for k in range(4)])
    lines = path.read_text().splitlines()
    columns = lines[0].split(",")
    for k, line in enumerate(lines):
        cells = line.split(",")
        if cells[1] == "22" and int(cells[2]) < 25:
            cells[columns.index("xAcceleration")] = "3"
            lines[k] = ",".join(cells)
    path.write_text("\n".join([*lines, ""]))
    read = find_source(path, road=chart).read()
    assert far not in read.vehicle_id
    (note,) = (x for x in read.notes if "accelerations along the road" in x)
    assert note.startswith("07_tracks.csv, row 243, column frame=1, trackId=22: ")


def two_cars(folder: Path) -> Path:
    """Numbers 0 and 1, in both lanes beside the merge lane."""
    rows = [
        [(s + 1.2 * k, d + 0.9, 30.0, 0.0, 0.0, 0.0) for k in range(60)]
        for s, d in ((-150, 1.75), (-60, 5.25))
    ]
    return write_ind(make_recording([Track(2, 4, x, 4.4, 1.8) for x in rows]), with_ramps("merge"), folder)


def going(x: float, y: float, heading: float, v: float, count: int = 60) -> list[list[float]]:
    cos, sin = math.cos(math.radians(heading)), math.sin(math.radians(heading))
    return [[x + v * cos * k / RATE, y + v * sin * k / RATE, heading, v * cos, v * sin] for k in range(count)]


def test_who_is_not_in_traffic_is_left_out_and_counted(tmp_path: Path) -> None:
    path = two_cars(tmp_path)
    add_track(tmp_path, 2, "pedestrian", (0, 0), going(0, -5, 90, 1.5))
    add_track(tmp_path, 3, "bicycle", (0, 0), going(0, -6, 90, 4))
    add_track(tmp_path, 4, "bicycle", (1.8, 0.6), going(10, -6, 90, 4))
    add_track(tmp_path, 5, "car", (4.5, 1.8), going(40, 1.75, 0, 0))
    add_track(tmp_path, 6, "car", (4.5, 1.8), going(40, 80, 0, 12))
    add_track(tmp_path, 7, "truck_bus", (9.0, 2.5), going(60, -40, 90, 8, 250))
    add_track(tmp_path, 9, "car", (4.5, 1.8), going(90, 5.25, 0, 20, 20))
    arc = [[60 + 20 * math.sin(a), 21.75 - 20 * math.cos(a)] for a in np.linspace(-1, 1.4, 100)]
    turning = [
        [x, y, math.degrees(a), 12 * math.cos(a), 12 * math.sin(a)]
        for (x, y), a in zip(arc, np.linspace(-1, 1.4, 100), strict=True)
    ]
    add_track(tmp_path, 8, "car", (4.5, 1.8), turning)
    r = find_source(path, road=main_road(tmp_path)).read()
    assert r.vehicle_id.tolist() == [0, 1, 8]
    for told in (
        "left out 1 of 10 vehicles (2): they are pedestrians",
        "left out 2 of 10 vehicles (3, 4): they are cyclists",
        "left out 1 of 7 vehicles (5): they are parked, or stand all the time",
        "left out 3 of 7 vehicles (6, 7, 9): they are not on the road along it for a second",
        "1 vehicles (8) count while they are on the road, along it",
    ):
        assert told in r.notes
    begin, end = r.start[2:].tolist()
    assert 25 <= end - begin < 100
    assert r.first_frame[2] > 0
    assert r.s[begin] == pytest.approx(turning[int(r.first_frame[2])][0] + 600 + 2.25, abs=0.5)


def test_a_bus_of_ind_is_a_truck(tmp_path: Path) -> None:
    path = two_cars(tmp_path)
    add_track(tmp_path, 2, "truck_bus", (12.0, 2.5), going(40, 1.75, 0, 20))
    assert find_source(path, road=main_road(tmp_path)).read().kind.tolist() == ["Car", "Car", "Truck"]


def test_the_first_frame_is_that_in_which_it_is_on_the_road(tmp_path: Path) -> None:
    """A car that comes in from aside, by two lines of its file."""
    path = two_cars(tmp_path)
    way = [*going(0, 40, -90, 25, 30), *going(0, 5.25, 0, 25, 50)]
    add_track(tmp_path, 2, "car", (4.5, 1.8), way)
    assert find_source(path, road=main_road(tmp_path)).read().first_frame[-1] == 30


@pytest.mark.parametrize("said", [None, "main-2"])
def test_a_road_is_needed(said: str | None, tmp_path: Path) -> None:
    path = two_cars(tmp_path)
    told = r"07_tracks.csv: the files name no lanes: give a road of a map.*; maps near are .*location3.osm"
    with pytest.raises(InputError, match=told):
        find_source(path, road=said).read()


def test_other_formats_have_their_own_road(tmp_path: Path) -> None:
    path = write_exid(
        make_recording([Track(2, 4, [(0.0, 1.0, 30.0, 0, 0, 0)] * 3)]), with_ramps("merge"), tmp_path
    )
    assert find_source(path).format.name == "exiD"
    with pytest.raises(UsageError, match=r"07_tracks\.csv has the road of its recording; omit it"):
        find_source(path, road=main_road(tmp_path))


def test_recordings_of_the_location_of_the_map(tmp_path: Path) -> None:
    """Of several in a folder those of location 3."""
    two_cars(tmp_path)
    for kind in ("recordingMeta", "tracksMeta", "tracks"):
        rows = [line.split(",") for line in (tmp_path / f"07_{kind}.csv").read_text().splitlines()]
        for row in rows[1:]:
            row[0] = "8"
            if kind == "recordingMeta":
                row[1] = "5"
        (tmp_path / f"08_{kind}.csv").write_text("".join(",".join(row) + "\n" for row in rows))
    assert [x.name for x in find_sources(tmp_path)] == ["07", "08"]
    assert [x.name for x in find_sources(tmp_path, road=main_road(tmp_path))] == ["07"]
    (tmp_path / "chart.osm").write_bytes((tmp_path / CHART).read_bytes())
    assert [x.name for x in find_sources(tmp_path, road=f"{tmp_path}/chart.osm#road=1")] == ["07", "08"]


def test_the_road_is_part_of_what_marks_results(tmp_path: Path) -> None:
    path = two_cars(tmp_path)
    one, same, other = (
        find_source(path, road=f"{tmp_path / CHART}#{x}").digests() for x in ("road=1", "road=1", "way=1")
    )
    assert one == same
    assert one != other


def test_commands_take_the_road(tmp_path: Path) -> None:
    path, said = two_cars(tmp_path), main_road(tmp_path)
    names = [x[0] for x in rp.roads(path, said)[0].lanes]
    assert names == ["main-1", "main-2", "merge-1"]
    rp.convert(path, tmp_path / "kept", jobs=1, road=said)
    assert find_source(tmp_path / "kept").read().vehicles == 2
    ours = rp.evaluate(path, road=said, among=[9, 10])
    kept = rp.evaluate(tmp_path / "kept", among=[9, 10])
    assert ours.totals.samples == kept.totals.samples == 120
    assert read_pair(f"{path}:0,1", road=said).lanes == {"SV": "main-1", "POV": "main-2"}
    answer = rp.monitor("s(POV) > s(SV)", f"{path}:0,1", road=said)
    assert str(answer).startswith("s(POV) > s(SV): true")


DAMAGE: dict[str, tuple[Callable[[Path], None], str]] = {
    **{name: (cell(*place), said) for name, *place, said in read_table(__file__, "damaged_cells")},
    "y grows down": (turn_over, "does y grow up, and is heading in degrees"),
    "off the road": (
        aside,
        "no vehicle is on road .*location3.osm#road=1 for a second; do map and positions fit",
    ),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named(name: str, tmp_path: Path) -> None:
    rows = [(-150 + 1.2 * k, 2.65, 30.0, 0.0, 0.0, 0.0) for k in range(60)]
    recording = make_recording([Track(2, 4, rows, 4.4, 1.8)])
    path = write_ind(recording, with_ramps("merge"), tmp_path, rampwards)
    assert find_source(path, road=main_road(tmp_path)).read().vehicles == 1
    damage, said = DAMAGE[name]
    damage(tmp_path)
    with pytest.raises(InputError, match=said):
        find_source(path, road=main_road(tmp_path)).read()


@pytest.mark.parametrize("case", CASES)
def test_planted_drives_have_the_verdicts_of_their_samples(case: str, tmp_path: Path) -> None:
    name, shift, begin, bend = CASES[case]
    recording, who = planted(begin)
    recording = replace(recording, vehicle_id=recording.vehicle_id - 1)  # as the files number them
    path = write_ind(recording, with_ramps(name), tmp_path, bend)
    found = matches(find_source(path, road=main_road(tmp_path)).read())
    assert found == matches(on_road(recording, with_ramps(name), RATE))
    shown = {(sv, pov, scenario) for sv, pov, _, scenario, *_ in found}
    assert {(sv, pov, number + shift) for number, (sv, *_, pov) in who.items() if number != 2} <= shown
