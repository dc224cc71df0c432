"""One trace from a file of samples or cut out of a recording: signals, sizes, and who is in which lane."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from roadproof.errors import InputError
from roadproof.library.bind import occupies
from roadproof.logic.rewrite import with_values
from roadproof.recordings.evaluate.one_trace import cut_trace, read_samples
from roadproof.recordings.formats.neighbours import NONE, find_neighbours
from roadproof.recordings.formats.samples import HEADER
from roadproof.world.models import load_road
from traffic.make_recording import LANES, Track, cruise, make_recording

ROAD = load_road("main-2")
# A in the right lane, B ahead of it in the left one and faster.
A, B = "0,5.3,20,0,0,0,4.5,1.8", "40,6.1,30,0,0,0,5,2"


def written(path: Path, *rows: str) -> Path:
    path.write_text("\n".join((",".join(HEADER), *rows)) + "\n", "utf-8")
    return path


def test_two_times_are_enough(tmp_path: Path) -> None:
    path = written(tmp_path / "two.csv", f"1.5,A,{A}", f"1.5,B,{B}", f"1.9,A,{A}", f"1.9,B,{B}")
    trace = read_samples(path, ROAD)
    assert (trace.batch.dt, trace.batch.samples, trace.first) == (Fraction(2, 5), 2, "1.5 s")
    assert trace.batch.signals["v_lon", "B"].ravel().tolist() == [30, 30]
    assert trace.batch.sizes["length", "A"].tolist() == [4.5]
    assert (trace.source, trace.road) == (str(path), ROAD)
    with pytest.raises(InputError, match="1 times; at least two samples are needed"):
        read_samples(written(path, f"1.5,A,{A}", f"1.5,B,{B}"), ROAD)


def of_way(way: int) -> list[str]:
    return [lane.name for lane in LANES if lane.direction == way]


@pytest.mark.parametrize("way", [1, 2])
def test_a_cut_knows_the_lanes_of_its_direction(way: int) -> None:
    """SV changes from one lane to the next; what it occupies is told frame by frame."""
    first, second = [lane for lane in LANES if lane.direction == way][:2]
    assert first.d is not None
    assert second.d is not None
    middles = [sum(lane.d) / 2 + 0.9 for lane in (first, second)]
    rows = [*cruise(0, 30, 4, middles[0]), *cruise(4.8, 30, 6, middles[1])]
    recording = make_recording([Track(way, 0, cruise(50, 30, 10, middles[0])), Track(way, 0, rows)])
    trace = cut_trace(recording, "here", {"SV": 1, "POV": 0}, (2, 7))
    assert [x.lane for x in trace.road.lanelets] == of_way(way)
    assert trace.lanes == {"SV": first.name, "POV": first.name}
    assert (trace.first, trace.batch.samples) == ("frame 2", 6)
    assert len(trace.batch.given) == 2 * len(of_way(way))

    def held(vehicle: str, lane: str) -> list[bool]:
        (lanelet,) = trace.road.lanelets_of(lane)
        known: np.ndarray = trace.batch.given[with_values(occupies(vehicle, lanelet), {})]
        return [bool(x) for x in known.ravel()]

    assert held("SV", first.name) == [True] * 2 + [False] * 4
    assert held("SV", second.name) == [False] * 2 + [True] * 4
    assert held("POV", first.name) == [True] * 6
    assert held("POV", second.name) == [False] * 6


def test_a_vehicle_beside_the_road_has_no_neighbours() -> None:
    band = LANES[1].d
    assert LANES[1].direction == 1
    assert band is not None
    for off in (-100.0, 100.0):
        recording = make_recording(
            [Track(1, 0, [(0.0, off, 20, 0, 0, 0)]), Track(1, 0, [(5.0, band[1], 20, 0, 0, 0)])]
        )
        assert recording.lane.tolist()[0] == NONE
        found = find_neighbours(recording)
        for rows in (found.preceding, found.following, *found.beside.values()):
            assert rows.tolist() == [NONE, NONE]
