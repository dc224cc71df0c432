"""Recordings in windows of time: the same answers, byte for byte, however small the windows are."""

import copy
import re
import shutil
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import roadproof as rp
from examples import some
from extensions.traffic.drives import cut_in
from extensions.traffic.lies import (
    NOTED,
    REFUSED,
    Files,
    one_vehicle_twice,
    read_columns,
    scaled,
    write_columns,
)
from roadproof.errors import InputError
from roadproof.extensions.traffic.evaluate import evaluate as evaluating
from roadproof.extensions.traffic.evaluate.evaluate import evaluate_recording, evaluate_windows
from roadproof.extensions.traffic.evaluate.questions import compile_questions, default_settings
from roadproof.extensions.traffic.formats import large, plausible, table, windows
from roadproof.extensions.traffic.formats.converted import same_recording
from roadproof.extensions.traffic.formats.highd import read_highd
from roadproof.extensions.traffic.formats.plausible import contradiction_checks
from roadproof.extensions.traffic.formats.recording import Recording, keep_vehicles
from roadproof.extensions.traffic.formats.samples import HEADER
from roadproof.extensions.traffic.formats.sources import find_source, find_sources
from roadproof.extensions.traffic.formats.windows import TimeWindow, divide
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.simulate.planting import PlantingPlace, plant
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.frontends.cli.main import main
from roadproof.runtime.package_data import shipped_folder

FILES = ("matches.csv", "pairs.csv", "results.json", "results.txt", "comparison.txt", "answers.md")


@pytest.fixture(scope="module")
def traffic() -> Recording:
    return simulate(TrafficSettings(seconds=60), seed=6)


def cut(recording: Recording, samples: int) -> list[TimeWindow]:
    return [
        TimeWindow(keep_vehicles(recording, there), new[there])
        for there, new in divide(recording.first_frame, recording.last_frame, samples)
    ]


@settings(max_examples=some(100), deadline=None, derandomize=True)
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
    questions = compile_questions(default_settings(), 25, traffic.zone_names)
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
    questions = compile_questions(default_settings(), 25, traffic.zone_names)
    whole, made = evaluate_recording(traffic, questions), cut(traffic, 15_000)
    for fault in (
        lambda self, *vehicles: np.ones(len(vehicles[0]), bool),
        lambda self, *vehicles: np.logical_and.reduce([self.new[index] for index in vehicles]),
    ):
        monkeypatch.setattr(TimeWindow, "has", fault)
        assert evaluate_windows(made, questions) != whole
    monkeypatch.undo()
    monkeypatch.setitem(evaluating._ORDERS, "matches", lambda match: (match.lane,))
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


# --- Files of samples that are larger than memory may be: kept and evaluated as those that are not --


def frame_of(recording: Recording) -> pl.DataFrame:
    """One way of simulated traffic, on the road main-2, in order of time."""
    way = recording.direction == 2
    rows = np.repeat(way, np.diff(recording.start))
    counts = np.diff(recording.start)[way]
    columns = {
        "time": np.round(recording.row_frame[rows] / 25, 3),
        "vehicle": recording.row_vehicle[rows] + 1,
        **{name: np.round(getattr(recording, name)[rows], 3) for name in HEADER[2:8]},
        "length": np.repeat(recording.length[way], counts),
        "width": np.repeat(recording.width[way], counts),
        "kind": np.repeat(recording.kind[way], counts),
    }
    right = min(lane.d[0] for lane in recording.lanes if lane.direction == 2 and lane.d)
    columns["d"] = np.round(columns["d"] - right, 3)
    frame = pl.DataFrame({name: pl.Series(name, values) for name, values in columns.items()})
    return frame.sort("time", "vehicle", maintain_order=True)


@pytest.fixture(scope="module")
def frame() -> pl.DataFrame:
    return frame_of(simulate(TrafficSettings(seconds=40, lanes=2, lane_width=3.5), 6))


def put(frame: pl.DataFrame, folder: Path, ending: str) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / f"a.{ending}"
    shutil.copy(shipped_folder("models") / "roads" / "main-2.toml", folder / "a_road.toml")
    if ending == "csv":
        frame.write_csv(path)
    else:
        frame.write_parquet(path)
    return path


def answer(path: Path, strict: bool = True) -> str:
    """What becomes of a recording as a whole, as windows have it: its error, or what is odd in it."""
    try:
        recording = find_source(path, strict).read()
    except InputError as error:
        return str(error)
    return "\n".join(recording.notes)


def in_windows(path: Path, monkeypatch: pytest.MonkeyPatch, strict: bool = True, most: int = 3_000) -> str:
    with monkeypatch.context() as patched:
        patched.setattr(windows, "MOST_SAMPLES", most)
        try:
            made = list(find_source(path, strict).divided().windows())
        except InputError as error:
            return str(error)
    assert len(made) > 1
    return "\n".join(made[0].recording.notes)


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_what_is_kept_of_a_large_file_is_what_is_kept_of_it_as_a_whole(
    frame: pl.DataFrame, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    named = frame.with_columns(
        ("car " + pl.col("vehicle").cast(pl.String)).alias("vehicle"),
        (pl.col("v_lon") / 2).alias("half"),
        pl.when(pl.col("s") > 100).then(None).otherwise(pl.col("s")).alias("gaps"),
    )
    for number, each in enumerate((frame, named)):
        path = put(each, tmp_path / f"in-{number}", ending)
        rp.convert(path, tmp_path / f"whole-{number}", jobs=1)
        with monkeypatch.context() as patched:
            patched.setattr(windows, "MOST_SAMPLES", 3_000)
            made = rp.convert(path, tmp_path / f"parts-{number}", jobs=1)
        whole, parts = (find_source(tmp_path / f"{x}-{number}").read() for x in ("whole", "parts"))
        assert same_recording(whole, parts)
        assert made.samples == {"a": len(frame)}
        assert not list((tmp_path / f"parts-{number}").glob(".*"))


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_answers_about_a_large_file_are_the_same_bytes(
    frame: pl.DataFrame, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = put(frame, tmp_path / "in", ending)
    expected = results(path, tmp_path / "whole")
    assert expected["matches.csv"].count(b"\n") > 20
    monkeypatch.setattr(windows, "MOST_SAMPLES", 2_000)
    assert results(path, tmp_path / "parts") == expected


def test_findings_of_a_large_file(
    frame: pl.DataFrame, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = put(frame, tmp_path, "parquet")
    recording = find_source(path).read()
    questions = compile_questions(default_settings(), 25, recording.zone_names)
    monkeypatch.setattr(windows, "MOST_SAMPLES", 1_500)
    assert evaluate_windows(find_source(path).divided().windows(), questions) == evaluate_recording(
        recording, questions
    )


def where(condition: pl.Expr, column: str, value: pl.Expr | float) -> pl.Expr:
    """A column with another value in some rows."""
    return pl.when(condition).then(value).otherwise(pl.col(column)).alias(column)


VEHICLE, S, D, SPEED = (pl.col(name) for name in ("vehicle", "s", "d", "v_lon"))
DOUBTFUL = {
    "a sign": SPEED * -1,
    "miles an hour": SPEED * 2.237,
    "sometimes another speed": where(VEHICLE % 13 == 0, "v_lon", 3.0),
    "one turned around": where(VEHICLE == 40, "v_lon", -SPEED),
    "a corner": D + 0.8,
    "another corner": D + 0.35,
    "beside the road": where(VEHICLE > 30, "d", D + 40),
    "one beside the road": where(VEHICLE == 31, "d", D + 40),
    "sizes": where(VEHICLE > 20, "length", 1.4),
    "hard": where(S > 300, "a_lon", 16.0),
    "too fast": where(VEHICLE == 40, "v_lon", 400.0),
    "backwards": (500 - S).alias("s"),
    "other sizes": where(S > 300, "length", 6.0),
    "a gap": where(pl.col("time") > 20, "time", pl.col("time") + 0.04),
}


@pytest.mark.parametrize("strict", [True, False])
@pytest.mark.parametrize("what", DOUBTFUL)
def test_what_is_odd_or_refused_is_so_in_parts(
    frame: pl.DataFrame, what: str, strict: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Word for word: what is counted, what it is of, and which row is named."""
    path = put(frame.with_columns(DOUBTFUL[what]), tmp_path, "parquet")
    expected = answer(path, strict)
    assert expected != answer(put(frame, tmp_path / "honest", "parquet"))
    assert in_windows(path, monkeypatch, strict) == expected


def test_windows_without_bad_vehicles(
    frame: pl.DataFrame, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same vehicles and samples as of the whole recording, which has lost the same ones."""
    bad = [where(VEHICLE % 5 == 0, "v_lon", SPEED * 2), where(VEHICLE == 31, "a_lon", 900.0)]
    path = put(frame.with_columns(bad), tmp_path, "parquet")
    whole = find_source(path).read()
    assert not {31, 40} & {*whole.vehicle_id.tolist()}
    assert sum("left out" in x for x in whole.notes) == 2
    monkeypatch.setattr(windows, "MOST_SAMPLES", 3_000)
    made = [window.recording for window in find_source(path).divided().windows()]
    assert len(made) > 1
    assert {*np.concatenate([x.vehicle_id for x in made]).tolist()} == {*whole.vehicle_id.tolist()}
    assert all(x.notes == whole.notes for x in made)
    for one in made:
        for k, number in enumerate(one.vehicle_id.tolist()):
            v = int(np.flatnonzero(whole.vehicle_id == number)[0])
            ours, theirs = (x.s[x.start[n] : x.start[n + 1]] for x, n in ((one, k), (whole, v)))
            assert np.array_equal(ours, theirs)


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_cells_that_are_missing_or_not_finite_are_named(
    frame: pl.DataFrame, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roadproof.extensions.traffic.formats.samples.PIECE", 1_000)
    monkeypatch.setattr("roadproof.extensions.traffic.formats.table.PIECE", 50_000)
    late = pl.int_range(pl.len()) == 5_000
    for wrong in (None, float("nan"), float("inf")):
        path = put(
            frame.with_columns(pl.when(late).then(wrong).otherwise(pl.col("s")).alias("s")), tmp_path, ending
        )
        expected = answer(path)
        assert "row 5002, column s" in expected
        assert in_windows(path, monkeypatch) == expected


@pytest.mark.parametrize("most", [3_000, 1_000_000])
def test_a_file_that_changes_while_it_is_read_is_refused(
    frame: pl.DataFrame, most: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, honest = put(frame, tmp_path, "csv"), table._read_fast

    def disturbed(*given: object) -> object:
        with path.open("ab") as file:
            file.write(b" ")
        return honest(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(windows, "MOST_SAMPLES", most)
    monkeypatch.setattr(table, "_read_fast", disturbed)
    with pytest.raises(InputError, match="changed while it was read"):
        find_source(path).divided()


def test_rows_out_of_order_are_refused(
    frame: pl.DataFrame, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = put(frame.reverse(), tmp_path, "parquet")
    assert "order of time" in answer(path)
    assert "order of time" in in_windows(path, monkeypatch)


def test_parts_that_go_wrong_are_caught(
    frame: pl.DataFrame, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Planted faults: sums that do not go on, windows of a second that begin anew, rows that are lost."""
    path = put(frame.with_columns(DOUBTFUL["sometimes another speed"]), tmp_path, "parquet")
    expected, honest = answer(path), plausible._seconds
    monkeypatch.setattr(plausible, "_seconds", lambda recording, before: honest(recording, 0))
    assert in_windows(path, monkeypatch) != expected
    monkeypatch.undo()
    monkeypatch.setattr(large._GroupReader, "cell", lambda self, row, column: (f"row {row}", ""))
    assert in_windows(path, monkeypatch) != expected


def test_the_command_says_how_many(
    frame: pl.DataFrame, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = put(frame, tmp_path / "in", "csv")
    monkeypatch.setattr(windows, "MOST_SAMPLES", 3_000)
    assert main(["convert", str(path), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    assert f"1 recordings with {len(frame)} samples" in capsys.readouterr().out


# --- Recordings that contradict themselves are refused, or noted; honest ones are neither -----------


@pytest.fixture(scope="module")
def honest(tmp_path_factory: pytest.TempPathFactory) -> Files:
    """Both directions, trucks, lane changes, and a planted drive."""
    recording = simulate(TrafficSettings(seconds=40, lane_width=3.5), seed=4)
    right = min(lane.d[0] for lane in recording.lanes if lane.direction == 2 and lane.d)
    recording, _ = plant(recording, cut_in(), PlantingPlace(2, 20, 6, 10.0, right))
    folder = tmp_path_factory.mktemp("honest")
    write_highd(recording, folder)
    return read_columns(folder)


def test_the_honest_recording_has_no_note(honest: Files, tmp_path: Path) -> None:
    recording = read_highd(write_columns(honest, tmp_path), "01")
    assert recording.notes == ()
    assert evaluate_recording(recording, compile_questions(default_settings(), 25)).notes == ()


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
    notes = evaluate_recording(recording, compile_questions(default_settings(), 25)).notes
    assert any("overlap in" in note for note in notes), notes


@pytest.mark.parametrize(
    "traffic",
    [
        TrafficSettings(seconds=30),
        TrafficSettings(seconds=30, lanes=2),
        TrafficSettings(seconds=30, lanes=4, flow=6000),
        TrafficSettings(seconds=30, lane_width=3.0, truck_share=0.4),
        TrafficSettings(seconds=30, lane_width=5.0, truck_share=0.0),
        TrafficSettings(seconds=60, flow=200),
        TrafficSettings(seconds=30, section=100.0),
        TrafficSettings(seconds=20, section=2000.0),
        TrafficSettings(seconds=30, rate=10),
    ],
    ids=str,
)
@pytest.mark.parametrize("seed", [1, 2])
def test_simulated_traffic_contradicts_nothing(traffic: TrafficSettings, seed: int, tmp_path: Path) -> None:
    write_highd(simulate(traffic, seed), tmp_path)
    assert read_highd(tmp_path, "01").notes == ()


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_measured_traffic_contradicts_nothing(seed: int) -> None:
    """With the noise of a good measurement: 3 cm in places, 6 cm/s in speeds, 0.3 m/s² in accelerations."""
    random = np.random.default_rng(seed)
    recording = simulate(TrafficSettings(seconds=40), seed)
    count = len(recording.s)
    slow = np.sin(np.arange(count) / random.uniform(8, 20) + random.uniform(0, 6))
    for name, noise in (("s", 0.02), ("d", 0.02), ("v_lon", 0.05), ("v_lat", 0.03)):
        getattr(recording, name)[:] += noise * slow + random.uniform(-0.01, 0.01, count)
    recording.a_lon[:] += 0.1 * slow + random.uniform(-0.2, 0.2, count)
    assert contradiction_checks(recording).contradictions() == []
