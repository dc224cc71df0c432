"""NGSIM's files of freeways: planted drives in each zone, the file of all places, and damage."""

import csv
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from extensions.traffic.make_recording import Track, make_recording
from extensions.traffic.sampled import toml_of
from extensions.traffic.test_exid import everything, planted
from extensions.traffic.tiny_ngsim import (
    HEADER,
    LANE,
    ZERO,
    lane_of_ramps,
    lane_through,
    ngsim_text,
    together,
    write_ngsim,
)
from roadproof.errors import InputError
from roadproof.extensions.traffic.evaluate.evaluate import evaluate_recording
from roadproof.extensions.traffic.formats.ngsim import PERIOD, read_ngsim
from roadproof.extensions.traffic.formats.recording import Recording, offsets
from roadproof.extensions.traffic.formats.sources import find_source, find_sources
from roadproof.extensions.traffic.formats.straight import of_road, place_recording
from roadproof.world.models import load_recorded_road
from roadproof.world.road import Road
from roadproof.world.signals import RECORDED
from tables import read_table

RATE = 10


def car(s: float, d: float, v: float, count: int, first: int, **more: float | str) -> Track:
    """At constant speed with its middle at ``d``."""
    rows = [(s + v * k / RATE, d + 0.9, v, 0.0, 0.0, 0.0) for k in range(count)]
    return Track(2, first, rows, 4.5, 1.8, **more)  # type: ignore[arg-type]


def markers(lanes: int, first: int, ramp: bool) -> list[Track]:
    """Long drives in the middle of each lane, one after the other, and one on the ramps from 0 to 1000 m."""
    pause = [first + 400 * k for k in range(lanes + 1)]
    tracks = [car(0, LANE * (k + 0.5), 25, 380, pause[k]) for k in range(lanes)]
    return [*tracks, car(0, -LANE / 2, 26.3, 381, pause[-1])] if ramp else tracks


def with_tracks(recording: Recording, tracks: list[Track]) -> Recording:
    """Vehicles of a recording and others, with ids from 1."""
    ours = [
        Track(2, int(first), rows, float(length), float(width))
        for first, length, width, rows in zip(
            recording.first_frame, recording.length, recording.width, rows_of(recording), strict=True
        )
    ]
    return make_recording([*ours, *tracks], RATE)


def rows_of(recording: Recording) -> Iterator[list[tuple[float, ...]]]:
    columns = np.stack([getattr(recording, name) for name in RECORDED], axis=1)
    for begin, end in zip(recording.start[:-1], recording.start[1:], strict=True):
        yield [tuple(row) for row in columns[begin:end].tolist()]


def on_road(recording: Recording, road: Road, rate: int = RATE) -> Recording:
    """The same motion on a road, from its exact samples."""
    names = ("vehicle_id", "direction", "kind", "length", "width", "first_frame")
    vehicles = {name: getattr(recording, name) for name in names}
    signals = [getattr(recording, name) for name in RECORDED]
    place = of_road(road, 2, Path("road"))
    return place_recording(place, "exact", rate, vehicles, np.diff(recording.start), signals)


def matches(recording: Recording) -> set[tuple[object, ...]]:
    """Vehicles, scenario, set and minDanger of each match."""
    found = evaluate_recording(recording, everything(recording.rate)).matches
    return {(m.sv, m.pov, m.pov2, m.scenario, m.set_name, m.min_danger) for m in found}


@pytest.mark.parametrize(("begin", "shift"), [(-600.0, 0), (20.0, 8), (520.0, 16)])
def test_planted_drives_have_the_verdicts_of_their_samples(begin: float, shift: int, tmp_path: Path) -> None:
    """Before the ramps of US-101, beside the on-ramp, and beside the off-ramp."""
    recording, who = planted(begin, RATE)
    recording = with_tracks(recording, markers(5, 900, ramp=True))
    path = write_ngsim(tmp_path, ngsim_text(recording))
    found = find_source(path).read()
    assert found.zone_names == ("main", "merge", "depart")
    (merge,) = (x for x in found.lanelets if x.attribute == "merge")
    assert [float(x or 0) for x in merge.s] == pytest.approx([0, 450], abs=2)
    (tmp_path / "road.toml").write_text(RAMPS)
    exact = on_road(recording, load_recorded_road(tmp_path / "road.toml")[0])
    assert matches(found) == matches(exact)
    planted_matches = {(sv, pov, scenario) for sv, pov, _, scenario, *_ in matches(found)}
    for number, (sv, pov, *_) in who.items():
        assert (sv + 1, pov + 1, number + shift) in planted_matches


def zones_between(low: int, middle: int, high: int) -> str:
    """Five lanes with the zones of a weaving section, and its ramps."""
    ends = ["-inf", low, middle, high, "inf"]
    parts = []
    for k in range(6):
        d = f'd = ["{LANE * (4 - k)}", "{LANE * (5 - k)}"]'
        for j, zone in enumerate(("main", "merge", "depart", "main")):
            ramp = {"merge": "merge", "depart": "departure"}.get(zone)
            name = str(k + 1) if k < 5 else ramp
            if name is not None:
                kind = "main" if k < 5 else ramp
                head = f'id = "{name}.{j}"\nlane = "{name}"\nzone = "{zone}"\nattribute = "{kind}"'
                parts.append(f"[[lanelet]]\n{head}\ns = [{ends[j]}, {ends[j + 1]}]\n{d}\n")
    return "".join(parts)


RAMPS = zones_between(0, 450, 1000)


def test_by_hand(tmp_path: Path) -> None:
    """Two lines of a file, computed with a desk calculator."""
    rows = ["2,13,2,1118846981000,16.5,35.4,6451137.6,1873345.0,14.5,4.9,2,40.0,1.0,2,0,0,0,0"] * 2
    rows[1] = rows[1].replace(",13,", ",14,").replace("1000,16.5,35.4", "1100,16.0,39.4")
    path = write_ngsim(tmp_path, "\n".join((HEADER, *rows)) + "\n")
    r = read_ngsim(path)
    assert (r.rate, r.vehicle_id.tolist(), r.first_frame.tolist(), r.kind.tolist()) == (
        10,
        [2],
        [13],
        ["Car"],
    )
    assert (r.length[0], r.width[0]) == pytest.approx((4.4196, 1.49352))
    assert r.s == pytest.approx([10.78992, 12.00912])
    assert r.d == pytest.approx([-5.0292 + 0.74676, -4.8768 + 0.74676])
    assert r.v_lon == pytest.approx([12.192, 12.192])
    assert r.a_lon == pytest.approx([0.3048, 0.3048])
    assert r.v_lat == pytest.approx([1.524, 1.524])
    assert r.a_lat == pytest.approx([0, 0], abs=1e-9)
    assert [(x.name, x.d) for x in r.lanes] == [("2", pytest.approx((-6.782, -3.124), abs=1e-3))]
    assert any("v_lat and a_lat are differences of Local_X" in x for x in r.notes)


def test_lanes_are_where_vehicles_drive(tmp_path: Path) -> None:
    """Also one that nobody is in, between its neighbours; on I-80 lane 7 is an on-ramp."""
    tracks = [x for k, x in enumerate(markers(6, 0, ramp=False)) if k != 2]
    tracks += [car(100, -LANE / 2, 20, 101, 9000)]
    text = ngsim_text(
        make_recording(tracks, RATE), lambda s, d: 7 if d < 0 else lane_through(6)(s, d), "i-80"
    )
    r = read_ngsim(write_ngsim(tmp_path, text))
    bands = {x.name: x.d for x in r.lanes}
    for k in range(6):
        assert bands[str(k + 1)] == pytest.approx((LANE * (-1 - k), LANE * -k), abs=2e-3)
    assert bands["merge"] == pytest.approx((-7 * LANE, -6 * LANE), abs=2e-3)
    spans = {x.id: (x.zone, x.s) for x in r.lanelets if x.lane in ("merge", "6")}
    assert [zone for zone, _ in spans.values()] == ["main", "merge", "main", "merge"]
    assert [float(x or 0) for x in spans["merge"][1]] == pytest.approx([100, 300], abs=2e-3)
    assert frozenset(("6", "merge")) in r.beside


def test_the_file_of_all_places(tmp_path: Path) -> None:
    """Two freeways, one of them at two times with the same ids, and a street that is left out."""
    one = ngsim_text(make_recording(markers(5, 10, ramp=False), RATE))
    two = ngsim_text(make_recording(markers(5, 30, ramp=False), RATE), zero=ZERO + 900_000)
    other = ngsim_text(
        make_recording(markers(6, 10, ramp=False), RATE), lane_through(6), "i-80", ZERO + 10**10
    )
    text = together({"us-101": [one, two], "i-80": [other], "lankershim": [one.replace(",2\n", ",0\n")]})
    r = read_ngsim(write_ngsim(tmp_path, text, "all"))
    assert r.vehicle_id.tolist() == [
        k + PERIOD * n for n, many in ((0, 5), (1, 5), (2, 6)) for k in range(1, many + 1)
    ]
    assert r.direction.tolist() == [1] * 10 + [2] * 6
    assert [x.name for x in r.lanes] == [f"us-101.{k}" for k in range(1, 6)] + [
        f"i-80.{k}" for k in range(1, 7)
    ]
    assert (r.lane >= 0).all()
    frames = np.stack((r.first_frame, r.last_frame), axis=1).reshape(-1).tolist()
    assert frames[9] < frames[10]
    assert frames[19] < frames[20]
    assert (
        "left out 1900 of 7980 rows: lankershim are streets with crossings, and only freeways are read"
        in r.notes
    )
    assert "us-101, 2005-06-15 14:49 UTC: frames from 0, ids from 0" in r.notes
    alone = read_ngsim(write_ngsim(tmp_path, one, "one"))
    assert r.s[: len(alone.s)] == pytest.approx(alone.s)
    assert r.d[: len(alone.s)] == pytest.approx(alone.d)


def test_numbers_with_parted_thousands(tmp_path: Path) -> None:
    """As data.gov writes them: "1,118,846,979,700" in quotes."""
    text = ngsim_text(make_recording([car(0, 1.75, 30, 150, 0)], RATE))
    plain = read_ngsim(write_ngsim(tmp_path, text, "a"))
    rows = [line.split(",") for line in text.splitlines()]
    for row in rows[1:]:
        row[3], row[5] = f'"{int(row[3]):,}"', f'"{float(row[5]):,}"'
    parted = read_ngsim(write_ngsim(tmp_path, "\n".join(map(",".join, rows)) + "\n", "b"))
    assert parted.s.tolist() == plain.s.tolist()
    assert (tmp_path / "b.csv").read_text().count('"1,') > 100


def test_names_of_columns_in_any_case_and_order(tmp_path: Path) -> None:
    text = ngsim_text(make_recording([car(0, 1.75, 30, 15, 0)], RATE))
    with_rows = [dict(row) for row in csv.DictReader(text.splitlines())]
    names = HEADER.split(",")[::-1]
    lines = [",".join(names).upper(), *(",".join(row[name] for name in names) for row in with_rows)]
    path = write_ngsim(tmp_path, "\n".join(lines) + "\n", "turned")
    assert find_source(path).format.name == "NGSIM"
    assert read_ngsim(path).s.tolist() == read_ngsim(write_ngsim(tmp_path, text)).s.tolist()


def test_a_road_beside_the_file_replaces_measured_lanes(tmp_path: Path) -> None:
    path = write_ngsim(tmp_path, ngsim_text(make_recording([car(0, 1.75, 30, 15, 0)], RATE)))
    road = load_recorded_road("main-2")[0]
    lanelets = tuple(replace(x, d=(x.d[0] - 18, x.d[1] - 18)) for x in road.lanelets)
    path.with_name(f"{path.stem}_road.toml").write_text(toml_of(replace(road, lanelets=lanelets)))
    (source,) = find_sources(tmp_path)
    assert [x.name for x in source.files] == [f"{path.stem}_road.toml", path.name]
    assert [x.name for x in source.read().lanes] == ["main-1", "main-2"]


def changed(row: int, column: str, value: str) -> Callable[[str], str]:
    def damage(text: str) -> str:
        rows = [line.split(",") for line in text.splitlines()]
        for k in range(1, len(rows)) if row == 0 else (row - 1,):
            rows[k][rows[0].index(column)] = value
        return "\n".join(map(",".join, rows)) + "\n"

    return damage


def mirrored(text: str) -> str:
    """Local_X grows to the left."""
    rows = [line.split(",") for line in text.splitlines()]
    for row in rows[1:]:
        row[4] = str(60 - float(row[4]))
    return "\n".join(map(",".join, rows)) + "\n"


def in_metres(text: str) -> str:
    """Local_Y, while v_Vel is in feet."""
    rows = [line.split(",") for line in text.splitlines()]
    for row in rows[1:]:
        row[5] = str(float(row[5]) * 0.3048)
    return "\n".join(map(",".join, rows)) + "\n"


DAMAGE: dict[str, tuple[Callable[[str], str], str]] = {
    **{name: (changed(*place), said) for name, *place, said in read_table(__file__, "damaged_cells")},
    "a gap": (lambda text: "\n".join((*text.split("\n")[:5], *text.split("\n")[6:])), "have no gaps"),
    "turned to the left": (mirrored, "vehicles of Lane_ID 5 drive -11.5 ft right of those of Lane_ID 4"),
    "places in metres": (in_metres, "by a factor of 3.28"),
    "cut off": (lambda text: text[:-3], "the file was cut off"),
}


def two_cars() -> str:
    tracks = [car(0, 1.75, 30, 40, 0), car(100, 5.25, 30, 40, 0), car(200, 1.75, 30, 40, 0)]
    return ngsim_text(make_recording(tracks, RATE), lane_of_ramps)


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named(name: str, tmp_path: Path) -> None:
    damage, said = DAMAGE[name]
    path = write_ngsim(tmp_path, damage(two_cars()))
    with pytest.raises(InputError, match=said):
        find_source(path, strict=True).read()


def test_a_bad_vehicle_is_left_out(tmp_path: Path) -> None:
    path = write_ngsim(tmp_path, changed(5, "v_Vel", "900")(two_cars()))
    r = find_source(path).read()
    assert r.vehicle_id.tolist() == [2, 3]
    assert "left out 1 of 3 vehicles (1): row 5, column v_Vel=900.0: must lie between -820 and 820" in r.notes
    assert offsets(np.diff(r.start)).tolist() == r.start.tolist()


def test_rows_that_occur_twice_are_read_once(tmp_path: Path) -> None:
    lines = two_cars().splitlines()
    path = write_ngsim(tmp_path, "\n".join((*lines, *lines[3:9])) + "\n")
    r = find_source(path).read()
    assert r.s.tolist() == read_ngsim(write_ngsim(tmp_path, two_cars(), "plain")).s.tolist()
    assert "6 of 126 rows occur twice; they were read once" in r.notes
    with pytest.raises(InputError, match="row 122, column Frame_ID=2: vehicle and frame occur together once"):
        find_source(path, strict=True).read()
    other = lines[3].replace(lines[3].split(",")[4], "30.0")
    path = write_ngsim(tmp_path, "\n".join((*lines, other)) + "\n")
    assert find_source(path).read().vehicle_id.tolist() == [2, 3]


def test_commands_read_it(tmp_path: Path) -> None:
    """Kept as Parquet it is the same, and vehicles are named by their ids."""
    path = write_ngsim(tmp_path, two_cars())
    rp.convert(path, tmp_path / "kept", jobs=1)
    kept, plain = find_source(tmp_path / "kept").read(), find_source(path).read()
    assert (kept.s.tolist(), kept.lanes, kept.notes) == (plain.s.tolist(), plain.lanes, plain.notes)
    one = rp.monitor("s(POV) > s(SV)", f"{path}:1,2")
    other = rp.monitor("s(POV) > s(SV)", path, roles={"SV": "1", "POV": "2"})
    assert str(one).startswith("s(POV) > s(SV): true")
    assert str(one).rpartition("trace:")[0] == str(other).rpartition("trace:")[0]


def test_lanes_that_are_not_straight_are_refused(tmp_path: Path) -> None:
    """Lane_ID says another lane than the place across the road, for a third of the samples."""
    text = two_cars()
    rows = [line.split(",") for line in text.splitlines()]
    for row in rows[81:111]:
        row[13] = "4"
    with pytest.raises(
        InputError, match=r"row 82, column Lane_ID=4: Lane_ID is not the lane of the box's centre"
    ):
        read_ngsim(write_ngsim(tmp_path, "\n".join(map(",".join, rows)) + "\n"))
