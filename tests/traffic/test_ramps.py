"""Simulated recordings with an on-ramp or an off-ramp: who drives where, and what is read back."""

from fractions import Fraction as F
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from roadproof.recordings.formats.highd import read_highd
from roadproof.recordings.formats.recording import ZONES, Recording
from roadproof.recordings.simulate import simulate as simulating
from roadproof.recordings.simulate.ramps import road_of, zone_of
from roadproof.recordings.simulate.synthetic import markings_of
from roadproof.recordings.simulate.traffic import Traffic
from roadproof.world.models import load_road

SECONDS = 120.0


@pytest.fixture(scope="module", params=["merge", "depart"])
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    folder = tmp_path_factory.mktemp(request.param)
    rp.simulate(folder, seconds=SECONDS, seed=3, ramp=request.param, jobs=1)
    return request.param, folder


def rows_of(recording: Recording, vehicle: int) -> slice:
    return slice(recording.start[vehicle], recording.start[vehicle + 1])


def ramp_of(recording: Recording) -> int:
    return next(k for k, lane in enumerate(recording.lanes) if lane.name in ("merge-1", "departure-1"))


def test_vehicles_go_from_the_ramp_or_to_it(made: tuple[str, Path]) -> None:
    kind, folder = made
    recording = read_highd(folder, "01")
    ramp = ramp_of(recording)
    ways = []
    for vehicle in range(recording.vehicles):
        lanes = recording.lane[rows_of(recording, vehicle)]
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
    begin, end = zone_of(Traffic(ramp=kind))
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
    assert ours.adjacent == road_of(Traffic(ramp=kind), markings_of(Traffic(ramp=kind))[1]).adjacent
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
    monkeypatch.setattr(simulating, "room_ahead", lambda traffic, lane, s, changing: np.full(len(s), never))
    monkeypatch.setattr(simulating, "wish", lambda traffic, lane, side, leaves: np.full(len(lane), -99.0))
    rp.simulate(tmp_path, seconds=60, seed=3, ramp="merge", jobs=1)
    with pytest.raises(AssertionError):
        test_nobody_is_on_a_ramp_where_there_is_none(("merge", tmp_path))


def test_drives_are_not_planted_beside_a_ramp(tmp_path: Path) -> None:
    from exporting.kept import kept

    with pytest.raises(rp.UsageError, match="ramp=merge: drives are planted on main roads only"):
        rp.simulate(tmp_path, ramp="merge", plant=[kept()["scenario-04-base"]])
    with pytest.raises(rp.UsageError, match="ramp='up': write 'none', 'merge', 'depart'"):
        rp.simulate(tmp_path, ramp="up")  # type: ignore[arg-type]
