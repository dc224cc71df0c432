"""Recordings in windows of time: the same answers, byte for byte, however small the windows are."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import roadproof as rp
from roadproof.errors import InputError
from roadproof.frontends.cli.main import main
from roadproof.recordings.evaluate import evaluate as evaluating
from roadproof.recordings.evaluate.evaluate import evaluate_recording, evaluate_windows
from roadproof.recordings.evaluate.questions import ask, default_settings
from roadproof.recordings.formats import windows
from roadproof.recordings.formats.recording import Recording, keep_vehicles
from roadproof.recordings.formats.sources import find_sources
from roadproof.recordings.formats.windows import Window, divide
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic

FILES = ("matches.csv", "pairs.csv", "results.json", "results.txt", "comparison.txt", "answers.md")


@pytest.fixture(scope="module")
def traffic() -> Recording:
    return simulate(Traffic(seconds=60), seed=6)


def cut(recording: Recording, samples: int) -> list[Window]:
    return [
        Window(keep_vehicles(recording, there), new[there])
        for there, new in divide(recording.first_frame, recording.last_frame, samples)
    ]


@settings(max_examples=100, deadline=None, derandomize=True)
@given(
    st.lists(st.tuples(st.integers(0, 30), st.integers(1, 20)), min_size=1, max_size=30), st.integers(1, 200)
)
def test_vehicles_that_share_a_frame_share_a_window(tracks: list[tuple[int, int]], samples: int) -> None:
    first, counts = (np.array(x) for x in zip(*tracks, strict=True))
    last = first + counts - 1
    made = list(divide(first, last, samples))
    assert np.array_equal(np.sum([new for _, new in made], axis=0), np.ones(len(first)))
    for a in range(len(first)):
        for b in range(a + 1):
            together = [there[a] and there[b] and (new[a] or new[b]) for there, new in made]
            if max(first[a], first[b]) <= min(last[a], last[b]):
                assert sum(together) == 1
    for there, new in made:
        entered = len({int(x) for x in first[new]})
        assert counts[there].sum() <= samples or entered == 1
        assert not (new & ~there).any()


@pytest.mark.parametrize("samples", [1, 6_000, 12_000])
def test_findings_are_the_same(traffic: Recording, samples: int) -> None:
    questions = ask(default_settings(), 25, traffic.zone_names)
    whole = evaluate_recording(traffic, questions)
    made = cut(traffic, samples)
    assert len(made) > 3
    assert max(len(x.recording.s) for x in made) < len(traffic.s) / 2
    assert evaluate_windows(made, questions) == whole
    assert {m.pov2 is None for m in whole.matches} == {True, False}


def test_windows_that_forget_or_repeat_are_caught(
    traffic: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Planted faults: what is in two windows counted twice, and what is new with what is not left out."""
    questions = ask(default_settings(), 25, traffic.zone_names)
    whole, made = evaluate_recording(traffic, questions), cut(traffic, 15_000)
    for fault in (
        lambda self, *vehicles: np.ones(len(vehicles[0]), bool),
        lambda self, *vehicles: np.logical_and.reduce([self.new[index] for index in vehicles]),
    ):
        monkeypatch.setattr(Window, "has", fault)
        assert evaluate_windows(made, questions) != whole
    monkeypatch.undo()
    monkeypatch.setattr(evaluating, "_order", lambda match: (match.lane,))
    assert evaluate_windows(made, questions) != whole


def results(path: Path, out: Path) -> dict[str, bytes]:
    assert main(["evaluate", str(path), "--out", str(out), "--no-pictures", "--jobs", "1"]) == 0
    return {name: (out / name).read_bytes() for name in FILES}


def test_converted_recordings_in_windows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rp.simulate(tmp_path / "in", recordings=2, seconds=20, seed=3, ramp="merge", jobs=1)
    rp.convert(tmp_path / "in", tmp_path / "kept", jobs=1)
    expected = results(tmp_path / "kept", tmp_path / "whole")
    monkeypatch.setattr(windows, "MOST_SAMPLES", 5_000)
    source = find_sources(tmp_path / "kept")[0]
    assert len(list(source.divided().windows())) > 3
    assert results(tmp_path / "kept", tmp_path / "windows") == expected


def test_a_file_that_changes_between_windows_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rp.simulate(tmp_path / "in", recordings=1, seconds=20, seed=3, jobs=1)
    rp.convert(tmp_path / "in", tmp_path / "kept", jobs=1)
    monkeypatch.setattr(windows, "MOST_SAMPLES", 5_000)
    source = find_sources(tmp_path / "kept")[0]
    reading = source.divided().windows()
    next(reading)
    content = source.files[-1].read_bytes()
    source.files[-1].write_bytes(content + b" ")
    with pytest.raises(InputError, match=r"changed while it was read|not what convert writes"):
        next(reading)
    with pytest.raises(InputError, match="is not what"):
        source.divided()
