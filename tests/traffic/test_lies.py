"""Recordings that contradict themselves are refused, or noted; honest ones are neither."""

import copy
import re
from pathlib import Path

import numpy as np
import pytest

from roadproof.errors import InputError
from roadproof.recordings.evaluate.evaluate import evaluate_recording
from roadproof.recordings.evaluate.questions import ask, default_settings
from roadproof.recordings.formats.highd import read_highd
from roadproof.recordings.formats.plausible import find_doubts
from roadproof.recordings.formats.write_highd import write_highd
from roadproof.recordings.simulate.plant import Place, plant
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic
from traffic.drives import cut_in
from traffic.lies import NOTED, REFUSED, Files, one_vehicle_twice, read_columns, scaled, write_columns


@pytest.fixture(scope="module")
def honest(tmp_path_factory: pytest.TempPathFactory) -> Files:
    """Both directions, trucks, lane changes, and a planted drive."""
    recording = simulate(Traffic(seconds=40, lane_width=3.5), seed=4)
    right = min(lane.d[0] for lane in recording.lanes if lane.direction == 2 and lane.d)
    recording, _ = plant(recording, cut_in(), Place(2, 20, 6, 10.0, right))
    folder = tmp_path_factory.mktemp("honest")
    write_highd(recording, folder)
    return read_columns(folder)


def test_the_honest_recording_has_no_note(honest: Files, tmp_path: Path) -> None:
    recording = read_highd(write_columns(honest, tmp_path), "01")
    assert recording.notes == ()
    assert evaluate_recording(recording, ask(default_settings(), 25)).notes == ()


@pytest.mark.parametrize("name", REFUSED)
def test_lies_are_refused(name: str, honest: Files, tmp_path: Path) -> None:
    """The message names the file, a cell of it and the rule."""
    lie, message = REFUSED[name]
    files = copy.deepcopy(honest)
    lie(files)
    with pytest.raises(InputError, match=message) as raised:
        read_highd(write_columns(files, tmp_path), "01")
    said = str(raised.value)
    assert "01_tracks" in said
    assert "column" in said


def test_speeds_that_are_less_than_one_percent_off_have_no_note(honest: Files, tmp_path: Path) -> None:
    files = copy.deepcopy(honest)
    scaled(1.008, "xVelocity")(files)
    assert read_highd(write_columns(files, tmp_path), "01").notes == ()


@pytest.mark.parametrize("name", NOTED)
def test_small_lies_are_noted(name: str, honest: Files, tmp_path: Path) -> None:
    lie, message = NOTED[name]
    files = copy.deepcopy(honest)
    lie(files)
    recording = read_highd(write_columns(files, tmp_path), "01")
    notes = "\n".join(recording.notes)
    assert any(re.search(message, note) for note in recording.notes), notes
    assert "row " in notes


def test_a_vehicle_that_stands_there_twice_is_noted(honest: Files, tmp_path: Path) -> None:
    files = copy.deepcopy(honest)
    one_vehicle_twice(files)
    recording = read_highd(write_columns(files, tmp_path), "01")
    notes = evaluate_recording(recording, ask(default_settings(), 25)).notes
    assert any("overlap in" in note for note in notes), notes


@pytest.mark.parametrize(
    "traffic",
    [
        Traffic(seconds=30),
        Traffic(seconds=30, lanes=2),
        Traffic(seconds=30, lanes=4, flow=6000),
        Traffic(seconds=30, lane_width=3.0, truck_share=0.4),
        Traffic(seconds=30, lane_width=5.0, truck_share=0.0),
        Traffic(seconds=60, flow=200),
        Traffic(seconds=30, section=100.0),
        Traffic(seconds=20, section=2000.0),
        Traffic(seconds=30, rate=10),
    ],
    ids=str,
)
@pytest.mark.parametrize("seed", [1, 2])
def test_simulated_traffic_contradicts_nothing(traffic: Traffic, seed: int, tmp_path: Path) -> None:
    write_highd(simulate(traffic, seed), tmp_path)
    assert read_highd(tmp_path, "01").notes == ()


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_measured_traffic_contradicts_nothing(seed: int) -> None:
    """With the noise of a good measurement: 3 cm in places, 6 cm/s in speeds, 0.3 m/s² in accelerations."""
    random = np.random.default_rng(seed)
    recording = simulate(Traffic(seconds=40), seed)
    count = len(recording.s)
    slow = np.sin(np.arange(count) / random.uniform(8, 20) + random.uniform(0, 6))
    for name, noise in (("s", 0.02), ("d", 0.02), ("v_lon", 0.05), ("v_lat", 0.03)):
        getattr(recording, name)[:] += noise * slow + random.uniform(-0.01, 0.01, count)
    recording.a_lon[:] += 0.1 * slow + random.uniform(-0.2, 0.2, count)
    assert find_doubts(recording) == []
