"""Files of samples that are larger than memory may be: kept and evaluated as those that are not."""

import shutil
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.frontends.cli.main import main
from roadproof.recordings.evaluate.evaluate import evaluate_recording, evaluate_windows
from roadproof.recordings.evaluate.questions import ask, default_settings
from roadproof.recordings.formats import large, plausible, table, windows
from roadproof.recordings.formats.converted import same_recording
from roadproof.recordings.formats.median import Median
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.formats.samples import HEADER
from roadproof.recordings.formats.sources import find_source
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic
from roadproof.runtime.package_data import shipped
from traffic.test_windows import results


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
    return frame_of(simulate(Traffic(seconds=40, lanes=2, lane_width=3.5), 6))


def put(frame: pl.DataFrame, folder: Path, ending: str) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / f"a.{ending}"
    shutil.copy(shipped("models") / "roads" / "main-2.toml", folder / "a_road.toml")
    if ending == "csv":
        frame.write_csv(path)
    else:
        frame.write_parquet(path)
    return path


def answer(path: Path) -> str:
    """What becomes of a recording: its error, or what it is."""
    try:
        recording = find_source(path).read()
    except InputError as error:
        return str(error)
    return "\n".join(recording.notes)


def in_windows(path: Path, monkeypatch: pytest.MonkeyPatch, most: int = 3_000) -> str:
    with monkeypatch.context() as patched:
        patched.setattr(windows, "MOST_SAMPLES", most)
        try:
            made = list(find_source(path).divided().windows())
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
    questions = ask(default_settings(), 25, recording.zone_names)
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


@pytest.mark.parametrize("what", DOUBTFUL)
def test_what_is_odd_or_refused_is_so_in_parts(
    frame: pl.DataFrame, what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Word for word: what is counted, what it is of, and which row is named."""
    path = put(frame.with_columns(DOUBTFUL[what]), tmp_path, "parquet")
    expected = answer(path)
    assert expected != answer(put(frame, tmp_path / "honest", "parquet"))
    assert in_windows(path, monkeypatch) == expected


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_cells_that_are_missing_or_not_finite_are_named(
    frame: pl.DataFrame, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roadproof.recordings.formats.parquet.PIECE", 1_000)
    monkeypatch.setattr("roadproof.recordings.formats.table.PIECE", 50_000)
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


@pytest.mark.parametrize("count", [1, 2, 5, 1000, 4001])
def test_a_median_that_does_not_fit(count: int) -> None:
    random = np.random.default_rng(count)
    for numbers in (random.normal(size=count), np.round(random.normal(size=count), 1), np.zeros(count)):
        found = Median(100)
        for part in np.array_split(numbers, 7):
            found.add(part)
        assert found.value() == np.median(numbers)


def test_the_command_says_how_many(
    frame: pl.DataFrame, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = put(frame, tmp_path / "in", "csv")
    monkeypatch.setattr(windows, "MOST_SAMPLES", 3_000)
    assert main(["convert", str(path), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    assert f"1 recordings with {len(frame)} samples" in capsys.readouterr().out
