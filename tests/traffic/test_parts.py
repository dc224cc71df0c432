"""Parts of readers that recordings in tests pass by: medians that are put into files, lanes that are told."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.formats.believable import _check_lanelets
from roadproof.formats.median import Median
from roadproof.formats.sources import find_sources


@pytest.mark.parametrize("seed", range(20))
def test_a_median_of_numbers_in_a_file_is_that_of_all(seed: int) -> None:
    rng = np.random.default_rng(seed)
    parts = [rng.normal(size=rng.integers(1, 40)).round(1) for _ in range(rng.integers(2, 12))]
    for most in (1, 5, 30, 10_000):
        median = Median(most)
        for part in parts:
            median.add(part)
        assert median.value() == np.median(np.concatenate(parts))


def test_a_box_is_on_the_lane_that_is_told_for_it(tmp_path: Path) -> None:
    """The first lane is checked as every other one."""
    folder = rp.simulate(tmp_path, seconds=20, seed=3, ramp="merge", jobs=1).folder
    [source] = find_sources(folder / "01_tracks.csv")
    recording = source.read()
    head = tmp_path / "head.json"
    _check_lanelets(head, recording)
    for lane in range(len(recording.lanes)):
        row = int(np.flatnonzero((recording.lane >= 0) & (recording.lane != lane))[0])
        wrong = recording.lane.copy()
        wrong[row] = lane
        if recording.occupancy[row] >> lane & 1:
            continue
        with pytest.raises(InputError, match="the box is not on that lane"):
            _check_lanelets(head, replace(recording, lane=wrong))
