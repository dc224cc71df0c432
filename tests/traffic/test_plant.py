"""Planted drives: exact samples, room around them, and refusals."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from roadproof.errors import UsageError
from roadproof.recordings.formats.highd import read_highd
from roadproof.recordings.formats.overlaps import find_overlaps
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.formats.write_highd import write_highd
from roadproof.recordings.simulate.plant import Place, plant
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at
from traffic.drives import braking, building_up, cut_in, cut_out


@pytest.fixture(scope="module")
def recording() -> Recording:
    return simulate(Traffic(seconds=40), seed=21)


def place_in(recording: Recording, direction: int) -> Place:
    """The drive's right lane is the rightmost lane of the direction."""
    right_edge = min(lane.d[0] for lane in recording.lanes if lane.direction == direction and lane.d)
    return Place(direction, 200, Fraction(6), -410.0 if direction == 1 else 10.0, right_edge)


@pytest.mark.parametrize("direction", [1, 2])
@pytest.mark.parametrize(
    "drive",
    [cut_in(), braking(), building_up(), cut_out()],
    ids=["cut-in", "braking", "building-up", "cut-out"],
)
def test_planted_samples_and_room(recording: Recording, direction: int, drive: Drive, tmp_path: Path) -> None:
    place = place_in(recording, direction)
    merged, truth = plant(recording, drive, place)
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
    assert set(truth.removed) == set(recording.vehicle_id) - set(merged.vehicle_id)
    write_highd(merged, tmp_path)
    found = read_highd(tmp_path, "01")
    assert found.notes == ()
    assert np.array_equal(found.s, merged.s)
    assert np.array_equal(found.occupancy, merged.occupancy)


def test_without_clearing_there_would_be_overlaps(recording: Recording) -> None:
    """The check above can fail: keep those that stand in the way."""
    place = place_in(recording, 2)
    tight = replace(place, clear_along=-1000.0)
    merged, truth = plant(recording, cut_in(), tight)
    assert truth.removed == ()
    assert list(find_overlaps(merged))


def test_vehicles_of_the_other_direction_stay(recording: Recording) -> None:
    _, truth = plant(recording, cut_in(), place_in(recording, 1))
    gone = np.isin(recording.vehicle_id, truth.removed)
    assert (recording.direction[gone] == 1).all()


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
def test_refusals(recording: Recording, changes: dict[str, object], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        plant(recording, cut_in(), replace(place_in(recording, 2), **changes))  # type: ignore[arg-type]
