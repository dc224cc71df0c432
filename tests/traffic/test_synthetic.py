"""Simulated recordings: the format, the shape of highD, and that no two vehicles are in one place."""

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from roadproof.errors import UsageError
from roadproof.recordings.formats.highd import read_highd
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.formats.write_highd import write_highd
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic


@pytest.fixture(scope="module", params=[2, 3])
def recording(request: pytest.FixtureRequest) -> Recording:
    return simulate(Traffic(seconds=120, lanes=request.param), seed=7)


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


def test_own_reader_has_no_complaints(recording: Recording, tmp_path: Path) -> None:
    write_highd(recording, tmp_path)
    found = read_highd(tmp_path, "01")
    assert found.notes == ()
    assert same(found, recording)


def test_no_overlaps(recording: Recording) -> None:
    assert count_overlaps(recording) == 0
    # The check can fail: a vehicle put where another one is.
    moved = recording.s.copy()
    pair = [k for k in range(recording.vehicles) if recording.first_frame[k] == 1][:2]
    a, b = recording.start[pair]
    spoiled = replace(recording, s=moved, d=recording.d.copy(), direction=np.ones_like(recording.direction))
    spoiled.s[b], spoiled.d[b] = spoiled.s[a] + 0.5, spoiled.d[a]
    assert count_overlaps(spoiled) > 0


def test_same_seed_same_recording() -> None:
    traffic = Traffic(seconds=20)
    assert same(simulate(traffic, seed=3, number=2), simulate(traffic, seed=3, number=2))
    assert not np.array_equal(simulate(traffic, 3, 2).s, simulate(traffic, 3, 1).s)
    assert not np.array_equal(simulate(traffic, 3, 2).s, simulate(traffic, 4, 2).s)


def test_motion_is_consistent(recording: Recording) -> None:
    """Positions are the integrals of velocities, velocities those of accelerations, up to rounding."""
    inside = np.diff(recording.row_vehicle) == 0
    for position, velocity, rounding in (
        ("s", "v_lon", 0.0105),
        ("d", "v_lat", 0.0105),
        ("v_lat", "a_lat", 0.012),
    ):
        x, v = getattr(recording, position), getattr(recording, velocity)
        step = np.diff(x) - (v[1:] + v[:-1]) / (2 * recording.rate)
        assert np.abs(step[inside]).max() < rounding, position
    assert recording.v_lon.min() >= 0


def test_shape_of_highd() -> None:
    r = simulate(Traffic(seconds=300), seed=1)
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
    r = simulate(Traffic(seconds=20), seed=5)
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
        Traffic(**wrong)  # type: ignore[arg-type]
