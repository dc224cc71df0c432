"""Drives in simulated traffic: only what the samples confirm is called planted, and why others are not."""

from dataclasses import fields, replace
from fractions import Fraction
from fractions import Fraction as F
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from extensions.traffic.drives import braking, building_up, cut_in, cut_out, motion
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.extensions.traffic.evaluate.evaluate import Findings, evaluate_recording
from roadproof.extensions.traffic.evaluate.questions import compile_questions, default_settings
from roadproof.extensions.traffic.formats.highd import read_highd
from roadproof.extensions.traffic.formats.overlaps import find_overlaps
from roadproof.extensions.traffic.formats.recording import ZONES, Recording
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.simulate import simulate as simulating
from roadproof.extensions.traffic.simulate.planting import (
    PLANTED_COLUMNS,
    PlantedDrive,
    PlantingPlace,
    lane_width,
    plant,
    plant_drives,
    plantable,
    rows_of,
)
from roadproof.extensions.traffic.simulate.ramp_road import road_of
from roadproof.extensions.traffic.simulate.simulate import markings_of, simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings, zone_of
from roadproof.library.loading import bundled_library
from roadproof.world.drive import Drive
from roadproof.world.models import load_road
from roadproof.world.motion import state_at
from roadproof.world.road import Lanelet, Road, adjacency

ROAD = Road(
    "two lanes",
    tuple(
        Lanelet(f"m{k}", f"main-{k}", "main", "main", (None, None), (F(7 * (k - 1), 2), F(7 * k, 2)))
        for k in (1, 2)
    ),
    adjacency([("main-1", "main-2")]),
)


def drive_file(drive: Drive, scenario: int, lane: str = "main-1") -> DriveFile:
    names = ", ".join(sorted(drive.vehicles, key=lambda name: (name != "SV", name)))
    claim = f"scenario_{scenario}({names}, L)"
    return DriveFile(scenario, "base", claim, F(6), {"L": lane}, {"minDanger": F(3, 5)}, {}, ROAD, drive)


@pytest.fixture(scope="module")
def recording() -> Recording:
    return simulate(TrafficSettings(seconds=22, lane_width=3.5, lanes=2), seed=8)


@pytest.mark.parametrize(("drive", "scenario"), [(cut_in(), 1), (braking(), 4), (cut_out(), 2)])
def test_both_directions_get_a_drive(recording: Recording, drive: Drive, scenario: int) -> None:
    merged, truths, left_out = plant_drives(recording, [drive_file(drive, scenario)], bundled_library())
    assert left_out == []
    ways = {int(merged.direction[merged.vehicle_id == x.sv][0]) for x in truths}
    assert ways == {1, 2}
    for truth in truths:
        assert (truth.scenario, truth.set_name, truth.min_danger) == (scenario, "base", F(3, 5))
        assert (truth.pov2 is not None) == (scenario == 2)
        first = merged.first_frame[merged.vehicle_id == truth.sv][0]
        assert truth.start_frame == first < truth.end_frame
        roles = {"SV": truth.sv, "POV": truth.pov, "POV1": truth.pov, "POV2": truth.pov2}
        row = {name: merged.start[:-1][merged.vehicle_id == roles[name]] for name in drive.vehicles}
        from_behind = sorted(drive.vehicles, key=lambda name: drive.vehicles[name].s)
        assert from_behind == sorted(drive.vehicles, key=lambda name: merged.s[row[name]][0])
    row = next(rows_of(truths))
    assert len(row) == len(PLANTED_COLUMNS)
    assert row[7:10] == ["0.6", "base", scenario]
    assert row[10].endswith("lane keep")


@pytest.mark.parametrize(
    ("file", "reason"),
    [
        (drive_file(cut_in(), 4), "before the scenario is complete"),  # it is no deceleration
        (drive_file(braking(), 4, "main-2"), "is not the one that an evaluation takes"),
        (
            drive_file(Drive({"SV": motion(5, F(13, 5), 25), "POV": motion(150, F(13, 5), 25)}), 4),
            "no danger",
        ),
    ],
)
def test_what_samples_do_not_confirm_is_not_planted(
    recording: Recording, file: DriveFile, reason: str
) -> None:
    merged, truths, left_out = plant_drives(recording, [file], bundled_library())
    assert merged is recording
    assert truths == []
    assert len(left_out) == 1
    assert reason in left_out[0]


def test_one_refused_drive_does_not_stop_the_others(recording: Recording) -> None:
    files = [drive_file(cut_in(), 4), drive_file(braking(), 4)]
    _, truths, left_out = plant_drives(recording, files, bundled_library())
    assert len(left_out) == 1
    assert {x.scenario for x in truths} == {4}


def test_roads_that_do_not_fit(recording: Recording) -> None:
    file = drive_file(braking(), 4)
    third = Lanelet("m3", "main-3", "main", "main", (None, None), (F(7), F(21, 2)))
    wide = replace(file, road=Road("three", (*ROAD.lanelets, third), ROAD.adjacent))
    with pytest.raises(UsageError, match="has 3 lanes, the recording 2"):
        plant_drives(recording, [wide], bundled_library())
    narrow = Lanelet("n", "main-3", "main", "main", (None, None), (F(7), F(10)))
    with pytest.raises(UsageError, match=r"are 3, 3.5 m wide"):
        lane_width([replace(file, road=Road("odd", (*ROAD.lanelets, narrow), ROAD.adjacent))])
    assert lane_width([file]) == 3.5
    assert plantable(file) == ""
    assert "no scenario" in plantable(replace(file, scenario=None))
    short = Lanelet("s", "main-3", "main", "main", (F(0), None), (F(7), F(21, 2)))
    merging = Lanelet("s", "merge-1", "merge", "main", (None, None), (F(7), F(21, 2)))
    for other in (short, merging):
        road = Road("x", (other,), adjacency([]))
        assert "more than a straight main road" in plantable(replace(file, road=road))


# --- Planted drives: exact samples, room around them, and refusals ----------------------------------


@pytest.fixture(scope="module")
def busy() -> Recording:
    return simulate(TrafficSettings(seconds=40), seed=21)


def place_in(recording: Recording, direction: int) -> PlantingPlace:
    """The drive's right lane is the rightmost lane of the direction."""
    right_edge = min(lane.d[0] for lane in recording.lanes if lane.direction == direction and lane.d)
    return PlantingPlace(direction, 200, Fraction(6), -410.0 if direction == 1 else 10.0, right_edge)


@pytest.mark.parametrize("direction", [1, 2])
@pytest.mark.parametrize(
    "drive",
    [cut_in(), braking(), building_up(), cut_out()],
    ids=["cut-in", "braking", "building-up", "cut-out"],
)
def test_planted_samples_and_room(busy: Recording, direction: int, drive: Drive, tmp_path: Path) -> None:
    place = place_in(busy, direction)
    merged, truth = plant(busy, drive, place)
    assert (truth.first_frame, truth.last_frame) == (200, 350)
    assert set(truth.vehicles) == set(drive.vehicles)
    for name, number in truth.vehicles.items():
        v = int(np.flatnonzero(merged.vehicle_id == number)[0])
        rows = slice(int(merged.start[v]), int(merged.start[v + 1]))
        assert (merged.first_frame[v], merged.last_frame[v], merged.kind[v]) == (200, 350, "Car")
        for k in (0, 1, 40, 77, 150):
            exact = state_at(drive.vehicles[name], Fraction(k, 25))
            assert merged.s[rows][k] == pytest.approx(float(exact.s) + place.s, abs=0.00501)
            assert merged.d[rows][k] == pytest.approx(float(exact.d) + place.d, abs=0.00501)
            assert merged.v_lon[rows][k] == pytest.approx(float(exact.v_lon), abs=0.00501)
            assert merged.a_lon[rows][k] == pytest.approx(float(exact.a_lon), abs=0.00501)
            assert merged.a_lat[rows][k] == pytest.approx(float(exact.a_lat), abs=0.00501)
    assert list(find_overlaps(merged)) == []
    assert truth.removed
    assert set(truth.removed) == set(busy.vehicle_id) - set(merged.vehicle_id)
    write_highd(merged, tmp_path)
    found = read_highd(tmp_path, "01")
    assert found.notes == ()
    assert np.array_equal(found.s, merged.s)
    assert np.array_equal(found.occupancy, merged.occupancy)


def test_without_clearing_there_would_be_overlaps(busy: Recording) -> None:
    """The check above can fail: keep those that stand in the way."""
    place = place_in(busy, 2)
    tight = replace(place, clear_along=-1000.0)
    merged, truth = plant(busy, cut_in(), tight)
    assert truth.removed == ()
    assert list(find_overlaps(merged))


def test_vehicles_of_the_other_direction_stay(busy: Recording) -> None:
    _, truth = plant(busy, cut_in(), place_in(busy, 1))
    gone = np.isin(busy.vehicle_id, truth.removed)
    assert (busy.direction[gone] == 1).all()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"start_frame": 950}, r"start_frame=950, seconds=6: the drive must lie within the frames"),
        ({"seconds": Fraction(0)}, "seconds=0"),
        ({"s": 300.0}, "vehicle POV is at s=.* in frame .*: it must stay within"),
        ({"d": 100.0}, "it must stay within .* on the lanes"),
        ({"direction": 3}, "direction=3 has no vehicles"),
    ],
)
def test_refusals(busy: Recording, changes: dict[str, object], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        plant(busy, cut_in(), replace(place_in(busy, 2), **changes))  # type: ignore[arg-type]


# --- Judged drives of all eight scenarios, woven into traffic, written, read and found again --------
# The drive files are made by ``roadproof witness`` for the formulas that they name: a trace ends with its
# last danger, so where a vehicle changes lanes there is danger after that too.

DRIVES = Path(__file__).parent / "planted"
SCENARIOS = range(1, 9)


@pytest.fixture(scope="module", params=[1, 2])
def found(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Findings, dict[int, PlantedDrive]]:
    """All drives one after the other in one recording that went through its files."""
    recording = simulate(TrafficSettings(seconds=70, flow=1000, lane_width=3.5), seed=12)
    right = min(x.d[0] for x in recording.lanes if x.direction == request.param and x.d)
    truths = {}
    for number in SCENARIOS:
        drive = load_drive(DRIVES / f"scenario-{number:02d}.json").drive
        rear = min(float(m.s - m.length) for m in drive.vehicles.values())
        begin = (-415.0 if request.param == 1 else 5.0) - rear
        place = PlantingPlace(request.param, 25 + 200 * (number - 1), Fraction(7), begin, right)
        recording, truths[number] = plant(recording, drive, place)
    assert list(find_overlaps(recording)) == []
    folder = tmp_path_factory.mktemp("planted")
    write_highd(recording, folder)
    return evaluate_recording(read_highd(folder, "01"), compile_questions(default_settings(), 25)), truths


@pytest.mark.parametrize("number", SCENARIOS)
@pytest.mark.parametrize("set_name", ["base", "extA", "ext"])
def test_planted_scenario_is_found(
    number: int, set_name: str, found: tuple[Findings, dict[int, PlantedDrive]]
) -> None:
    findings, truths = found
    truth = truths[number]
    who = truth.vehicles
    names = (who["SV"], who.get("POV", who.get("POV1")), who.get("POV2"))
    starts = {
        m.start_frame
        for m in findings.matches
        if (m.sv, m.pov, m.pov2) == names and (m.scenario, m.set_name, m.min_danger) == (number, set_name, 1)
    }
    assert starts == {truth.first_frame}


# --- Simulated recordings: the format, the shape of highD, and that no two vehicles are in one place


@pytest.fixture(scope="module", params=[2, 3])
def simulated(request: pytest.FixtureRequest) -> Recording:
    return simulate(TrafficSettings(seconds=120, lanes=request.param), seed=7)


def same(a: Recording, b: Recording) -> bool:
    return all(np.array_equal(getattr(a, f.name), getattr(b, f.name)) for f in fields(Recording))


def count_overlaps(r: Recording) -> int:
    """Pairs of boxes of one direction and frame that overlap with positive area, by brute force."""
    vehicle, frame, found = r.row_vehicle, r.row_frame, 0
    for f in np.unique(frame):
        rows = np.flatnonzero(frame == f)
        s, d = r.s[rows], r.d[rows]
        rear, right = s - r.length[vehicle[rows]], d - r.width[vehicle[rows]]
        along = (s[:, None] > rear + 1e-6) & (s > rear[:, None] + 1e-6)
        across = (d[:, None] > right + 1e-6) & (d > right[:, None] + 1e-6)
        same_way = r.direction[vehicle[rows]][:, None] == r.direction[vehicle[rows]]
        found += int((np.triu(along & across & same_way, 1)).sum())
    return found


def test_own_reader_has_no_complaints(simulated: Recording, tmp_path: Path) -> None:
    write_highd(simulated, tmp_path)
    found = read_highd(tmp_path, "01")
    assert found.notes == ()
    assert same(found, simulated)


def test_no_overlaps(simulated: Recording) -> None:
    assert count_overlaps(simulated) == 0
    # The check can fail: a vehicle put where another one is.
    moved = simulated.s.copy()
    pair = [k for k in range(simulated.vehicles) if simulated.first_frame[k] == 1][:2]
    a, b = simulated.start[pair]
    spoiled = replace(simulated, s=moved, d=simulated.d.copy(), direction=np.ones_like(simulated.direction))
    spoiled.s[b], spoiled.d[b] = spoiled.s[a] + 0.5, spoiled.d[a]
    assert count_overlaps(spoiled) > 0


def test_same_seed_same_recording() -> None:
    traffic = TrafficSettings(seconds=20)
    assert same(simulate(traffic, seed=3, number=2), simulate(traffic, seed=3, number=2))
    assert not np.array_equal(simulate(traffic, 3, 2).s, simulate(traffic, 3, 1).s)
    assert not np.array_equal(simulate(traffic, 3, 2).s, simulate(traffic, 4, 2).s)


def test_motion_is_consistent(simulated: Recording) -> None:
    """Positions are the integrals of velocities, velocities those of accelerations, up to rounding."""
    inside = np.diff(simulated.row_vehicle) == 0
    for position, velocity, rounding in (
        ("s", "v_lon", 0.0105),
        ("d", "v_lat", 0.0105),
        ("v_lat", "a_lat", 0.012),
    ):
        x, v = getattr(simulated, position), getattr(simulated, velocity)
        step = np.diff(x) - (v[1:] + v[:-1]) / (2 * simulated.rate)
        assert np.abs(step[inside]).max() < rounding, position
    assert simulated.v_lon.min() >= 0


def test_shape_of_highd() -> None:
    r = simulate(TrafficSettings(seconds=300), seed=1)
    assert 5500 < r.vehicles * 3600 / 300 < 8500  # 110,500 vehicles in 16.5 hours
    seconds = np.diff(r.start) / r.rate
    assert 12 < np.median(seconds) < 15.5
    assert 0.12 < (r.kind == "Truck").mean() < 0.24
    mean = np.add.reduceat(r.v_lon, r.start[:-1]) / np.diff(r.start)
    bins, edges = np.histogram(mean, np.arange(18, 44, 2))
    assert edges[np.argmax(bins[:4])] == 22, bins
    assert 30 <= edges[4 + np.argmax(bins[4:])] <= 34, bins
    changes = np.mean([len(set(r.lane[a:b])) > 1 for a, b in zip(r.start, r.start[1:], strict=False)])
    assert 0.1 < changes < 0.4
    assert r.a_lon.min() < -2  # braking waves
    assert (r.lane >= 0).all()


def test_columns_of_neighbours(tmp_path: Path) -> None:
    """preceding and following ids, dhw and thw against a plain reading of one frame in ten."""
    r = simulate(TrafficSettings(seconds=20), seed=5)
    write_highd(r, tmp_path)
    lines = (tmp_path / "01_tracks.csv").read_text().splitlines()
    names = lines[0].split(",")
    rows = [dict(zip(names, line.split(","), strict=True)) for line in lines[1:]]
    by_frame: dict[int, list[dict[str, str]]] = {}
    for row in rows:
        by_frame.setdefault(int(row["frame"]), []).append(row)
    checked = 0
    for frame, present in by_frame.items():
        if frame % 10:
            continue
        for me in present:
            way = 1 if int(me["laneId"]) > 5 else -1
            front = front_of(me, way)
            rear = front - float(me["width"])
            mine = [o for o in present if o["laneId"] == me["laneId"] and o is not me]
            ahead = min(
                (o for o in mine if front_of(o, way) > front), key=lambda o: front_of(o, way), default=None
            )
            assert me["precedingId"] == (ahead["id"] if ahead else "0")
            if ahead:
                gap = front_of(ahead, way) - float(ahead["width"]) - front
                assert float(me["dhw"]) == pytest.approx(gap, abs=0.006)
                assert float(me["thw"]) == pytest.approx(gap / abs(float(me["xVelocity"])), abs=0.006)
            left_lane = str(int(me["laneId"]) - way)  # ids grow down; left is up for those towards +x
            beside = [o for o in present if o["laneId"] == left_lane and same_way(o, me)]
            level = {
                o["id"]
                for o in beside
                if front_of(o, way) > rear + 1e-6 and front_of(o, way) - float(o["width"]) < front - 1e-6
            }
            assert (me["leftAlongsideId"] in level) if level else me["leftAlongsideId"] == "0"
            behind = max(
                (o for o in beside if front_of(o, way) <= rear + 1e-6),
                key=lambda o: front_of(o, way),
                default=None,
            )
            assert me["leftFollowingId"] == (behind["id"] if behind else "0")
            checked += 1
    assert checked > 500


def front_of(row: dict[str, str], way: int) -> float:
    return float(row["x"]) + float(row["width"]) if way > 0 else -float(row["x"])


def same_way(a: dict[str, str], b: dict[str, str]) -> bool:
    return (int(a["laneId"]) > 5) == (int(b["laneId"]) > 5)


@pytest.mark.parametrize(
    "wrong", [{"lanes": 1}, {"flow": 1e6}, {"truck_share": -0.1}, {"seconds": 0}, {"rate": 24}]
)
def test_wrong_settings_are_named(wrong: dict[str, float]) -> None:
    with pytest.raises(UsageError, match=next(iter(wrong))):
        TrafficSettings(**wrong)  # type: ignore[arg-type]


# --- Simulated recordings with an on-ramp or an off-ramp: who drives where, and what is read back ---

SECONDS = 120.0


@pytest.fixture(scope="module", params=["merge", "depart"])
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    folder = tmp_path_factory.mktemp(request.param)
    rp.simulate(folder, seconds=SECONDS, seed=3, ramp=request.param, jobs=1)
    return request.param, folder


def samples_of(recording: Recording, vehicle: int) -> slice:
    return slice(recording.start[vehicle], recording.start[vehicle + 1])


def ramp_of(recording: Recording) -> int:
    return next(k for k, lane in enumerate(recording.lanes) if lane.name in ("merge-1", "departure-1"))


def test_vehicles_go_from_the_ramp_or_to_it(made: tuple[str, Path]) -> None:
    kind, folder = made
    recording = read_highd(folder, "01")
    ramp = ramp_of(recording)
    ways = []
    for vehicle in range(recording.vehicles):
        lanes = recording.lane[samples_of(recording, vehicle)]
        ways.append((bool(lanes[0] == ramp), bool(lanes[-1] == ramp)))
    entered, left = ways.count((True, False)), ways.count((False, True))
    assert (entered > 5 and left == 0) if kind == "merge" else (left > 3 and entered == 0)
    upper = recording.direction == 1
    assert upper.any()
    assert not any(a or b for (a, b), up in zip(ways, upper, strict=True) if up)


def test_nobody_is_on_a_ramp_where_there_is_none(made: tuple[str, Path]) -> None:
    """The whole box of whoever is not on the main road is on the ramp, also at its end or beginning."""
    kind, folder = made
    recording = read_highd(folder, "01")
    begin, end = zone_of(TrafficSettings(ramp=kind))
    low = np.array([lane.d[0] for lane in recording.lanes if lane.d and lane.name == "main-1"])[0]
    ours = np.repeat(recording.direction == 2, np.diff(recording.start))
    width = recording.width[recording.row_vehicle]
    beyond = ours & (recording.d - width < low - 0.01)
    assert beyond.any()
    rear = (recording.s - recording.length[recording.row_vehicle])[beyond]
    assert (recording.s[beyond] <= end).all() if kind == "merge" else (rear >= begin - 25).all()
    zones = {ZONES[bit] for bit in range(3) if (recording.zones[ours] >> np.uint32(bit) & 1).any()}
    assert zones == {"main", kind}


def test_the_road_beside_it_is_that_of_the_models_moved(made: tuple[str, Path]) -> None:
    kind, folder = made
    ours, model = load_road(folder / "01_road.toml"), load_road(kind)
    assert {(x.zone, x.attribute) for x in ours.lanelets} == {(x.zone, x.attribute) for x in model.lanelets}
    assert len(ours.lanes) == len(model.lanes) + 1
    assert (
        ours.adjacent
        == road_of(TrafficSettings(ramp=kind), markings_of(TrafficSettings(ramp=kind))[1]).adjacent
    )
    ramp = next(x for x in ours.lanelets if x.attribute != "main")
    assert ramp.s == ((None, F(378)) if kind == "merge" else (F(42), None))


def test_vehicles_keep_apart_and_recordings_are_believed(made: tuple[str, Path]) -> None:
    _, folder = made
    notes = read_highd(folder, "01").notes
    assert not [x for x in notes if "contradict" in x or "overlap" in x], notes


def test_scenarios_of_the_zone_are_asked_of_it(made: tuple[str, Path], tmp_path: Path) -> None:
    kind, folder = made
    found = rp.evaluate(folder, among="1,3-8,9,11-16,17,19-24", detectors=False, pictures=False, jobs=1)
    matched = set(found.matches()["scenario"].to_list()) if found.findings else set()
    zone = {*range(9, 17)} if kind == "merge" else {*range(17, 25)}
    assert matched & zone
    assert not matched & ({*range(9, 25)} - zone)


def test_the_same_seed_gives_the_same_files(made: tuple[str, Path], tmp_path: Path) -> None:
    kind, folder = made
    rp.simulate(tmp_path, seconds=SECONDS, seed=3, ramp=kind, jobs=1)
    for path in folder.iterdir():
        assert (tmp_path / path.name).read_bytes() == path.read_bytes()


def test_planted_fault_a_ramp_that_nobody_has_to_leave_is_noticed(monkeypatch, tmp_path: Path) -> None:
    """Without the end of the lane in sight, vehicles drive beyond it."""
    never = np.inf
    monkeypatch.setattr(
        simulating.traffic_settings, "room_ahead", lambda traffic, lane, s, changing: np.full(len(s), never)
    )
    monkeypatch.setattr(
        simulating.traffic_settings,
        "incentive",
        lambda traffic, lane, side, leaves: np.full(len(lane), -99.0),
    )
    rp.simulate(tmp_path, seconds=60, seed=3, ramp="merge", jobs=1)
    with pytest.raises(AssertionError):
        test_nobody_is_on_a_ramp_where_there_is_none(("merge", tmp_path))


def test_drives_are_not_planted_beside_a_ramp(tmp_path: Path) -> None:
    from extensions.exchange.exporting.shipped_drives import shipped_drives

    with pytest.raises(rp.UsageError, match="ramp=merge: drives are planted on main roads only"):
        rp.simulate(tmp_path, ramp="merge", plant=[shipped_drives()["scenario-04-base"]])
    with pytest.raises(rp.UsageError, match="ramp='up': write 'none', 'merge', 'depart'"):
        rp.simulate(tmp_path, ramp="up")  # type: ignore[arg-type]
