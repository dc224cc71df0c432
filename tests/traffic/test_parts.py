"""Parts of readers that recordings in tests pass by: medians that are put into files, lanes that are told."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.recordings.formats import large, topology
from roadproof.recordings.formats.believable import _check_lanelets
from roadproof.recordings.formats.median import Median
from roadproof.recordings.formats.plain import plain_text
from roadproof.recordings.formats.plausible import _worst
from roadproof.recordings.formats.repeats import see_pair
from roadproof.recordings.formats.samples import HEADER
from roadproof.recordings.formats.sources import find_sources
from roadproof.world.signals import KINDS


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


def test_text_that_is_no_table_stays_as_it_is() -> None:
    for content in (b'<a b="1,2"/>\n', b'{"a": "1,2"}\n', b'["1,2"]\n'):
        assert plain_text(Path("x"), content) == content
    assert plain_text(Path("x"), b'"a","b"\r\n1,"2"\r\n') == b"a,b\n1,2\n"
    with pytest.raises(InputError, match="row 1: a comma or a quote within a quoted cell"):
        plain_text(Path("x"), b'"a,b"\n')


@pytest.mark.parametrize("place", range(1, 6))
def test_the_sample_before_which_two_courses_differ_most(place: int) -> None:
    signal = np.arange(8.0)
    signal[place:] += 3
    assert _worst(signal, np.arange(8.0), 0, 6) == place
    assert _worst(np.concatenate((np.zeros(2), signal)), np.arange(-2, 8.0), 2, 8) == place + 2


def test_the_kind_of_a_vehicle_is_that_of_its_label(tmp_path: Path) -> None:
    folder = rp.simulate(tmp_path, seconds=5, seed=1, jobs=1).folder
    [source] = find_sources(folder / "01_tracks.csv")
    recording = source.read()
    plain = replace(recording, kind=np.full(recording.vehicles, "Car"))
    assert {*plain.kind_code.tolist()} == {KINDS.index("car") + 1}
    labelled = replace(plain, label=np.full(recording.vehicles, "bus"))
    assert {*labelled.kind_code.tolist()} == {KINDS.index("bus") + 1}


def test_pairs_are_known_by_the_moments_of_both(tmp_path: Path) -> None:
    """The order of the two does not matter, and no other pair has the same keys."""
    folder = rp.simulate(tmp_path, seconds=20, seed=1, jobs=1).folder
    [source] = find_sources(folder / "01_tracks.csv")
    recording = source.read()
    recording = replace(recording, moments=np.arange(1, len(recording.s) + 1))
    seen: dict[int, set[int]] = {}
    for first in range(4):
        for second in range(first + 1, 5):
            one = see_pair(recording, first, second, False)
            assert one.keys == see_pair(recording, second, first, False).keys
            for key in one.keys:
                seen.setdefault(key, set()).add(10 * first + second)
    assert seen
    assert all(len(pairs) == 1 for pairs in seen.values())


def test_the_middle_is_that_of_the_lanelets_beside_the_main_road(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(topology, "length_of", lambda lanelets, chain: len(chain))
    links: Any = SimpleNamespace(lanelets={})
    with_main = [False, True, True, True, False, False]
    assert topology._middle(links, tuple("abcdef"), with_main) == 2
    assert topology._middle(links, tuple("abcdef"), with_main[::-1]) == 3
    assert topology._middle(links, tuple("abcd"), [False] * 4) == 2


def test_rows_of_vehicles_that_were_not_counted_are_told(tmp_path: Path) -> None:
    path = tmp_path / "x.csv"
    path.write_text(f"{','.join(HEADER)}\n" + "".join(f"{k / 25},1,0,0,1,0,0,0,4,2\n" for k in range(5)))
    survey: Any = SimpleNamespace(counts=np.array([5]), index={"2": 0})
    with pytest.raises(InputError, match="the file changed while it was read"):
        large._divide_rows(path, survey, tmp_path)
