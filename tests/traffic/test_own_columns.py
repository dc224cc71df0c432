"""Own signals and kinds in CSV, Parquet and frames: what is read, and what is refused."""

from pathlib import Path

import polars as pl
import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.recordings.evaluate.one_trace import read_samples
from roadproof.recordings.formats.recording import Recording, keep_vehicles, kind_called, own_numbers
from roadproof.recordings.formats.samples import read_recording
from roadproof.world.signals import KINDS

SPEC = """
signal red: bool
signal jerk(a: vehicle): m/s^3 in [-10, 10]
signal swift(a: vehicle): bool derived by jerk(a) > 2 m/s^3
"""
HOME = rp.load(specs=[SPEC])
BOX = {"d": 3.0, "v_lon": 20.0, "v_lat": 0.0, "a_lon": 0.0, "a_lat": 0.0, "length": 4.5, "width": 1.8}
ROAD = """
[[lanelet]]
id = "a"
lane = "a"
zone = "main"
attribute = "main"
s = [-inf, inf]
d = [0, 4]
"""


def table(**more: object) -> pl.DataFrame:
    """Two vehicles for a second, red from 0.4 s on, jerk 3 at 0.6 s; POV is a truck."""
    rows = [
        {"time": k / 10, "vehicle": name, "s": place + 2 * k, **BOX, "kind": kind}
        | {"red": k >= 4, "jerk": 3.0 if k == 6 else float(k % 3)}
        for k in range(11)
        for name, place, kind in (("SV", 0.0, "Car"), ("POV", 30.0, "Truck"))
    ]
    return pl.DataFrame(rows).with_columns(**more)


def written(folder: Path, frame: pl.DataFrame, ending: str) -> Path:
    path = folder / f"a.{ending}"
    frame.write_csv(path) if ending == "csv" else frame.write_parquet(path)
    path.with_name("a_road.toml").write_text(ROAD)
    return path


@pytest.mark.parametrize("source", ["csv", "parquet", "frame"])
@pytest.mark.parametrize(
    ("formula", "verdict"),
    [
        ("F[0, 1] (red and swift(SV))", "true"),
        ("F[0, 0.3] red", "false"),
        ("G[0, 1] jerk(POV) <= 2 m/s^3", "false"),
        ("kind(POV) = truck and kind(SV) = car", "true"),
        ("kind(SV) = kind(POV)", "false"),
    ],
)
def test_columns_are_read(tmp_path: Path, source: str, formula: str, verdict: str) -> None:
    on = table() if source == "frame" else written(tmp_path, table(), source)
    assert rp.monitor(formula, on, HOME).verdict == verdict


@pytest.mark.parametrize(
    "red", [[k >= 4 for k in range(11)], ["TRUE", "False"] * 5 + ["1"], [0, 1] * 5 + [0]]
)
def test_truth_is_written_as_words_or_as_0_and_1(tmp_path: Path, red: list[object]) -> None:
    told = pl.Series("red", [x for x in red for _ in (0, 1)], strict=False)
    path = written(tmp_path, table(red=told), "csv")
    measured = read_samples(path).batch.signals["red", ""][:, 0]
    assert measured.tolist() == [float(str(x).lower() in ("true", "1")) for x in red]


MISSING = pl.when(pl.col("time") > 0.75).then(None).otherwise(pl.col("jerk"))


@pytest.mark.parametrize("ending", ["csv", "parquet"])
@pytest.mark.parametrize(
    ("more", "formula", "told"),
    [
        ({"jerk": MISSING}, "F[0, 1] swift(SV)", "a.{}: jerk(SV) in trace 0 at sample 8 is missing"),
        ({"jerk": pl.lit("x")}, "swift(SV)", "at sample 0 is missing, or no finite number"),
        ({"jerk": pl.col("jerk") * 5}, "swift(SV)", "jerk(SV)=15 in trace 0 at sample 6: signal jerk"),
        ({"red": pl.lit(2)}, "red", "red=2 in trace 0 at sample 0: it is declared bool"),
        ({"red": pl.col("vehicle") == "SV"}, "red", "a.{}: column red is not the same for all vehicles"),
        ({"red": pl.col("jerk")}, "F[0,1] red", "declared bool"),
    ],
)
def test_wrong_values_are_refused_by_name(
    tmp_path: Path, ending: str, more: dict[str, pl.Expr], formula: str, told: str
) -> None:
    path = written(tmp_path, table(**more), ending)
    with pytest.raises(InputError) as raised:
        rp.monitor(formula, path, HOME)
    assert told.format(ending) in str(raised.value)
    assert rp.monitor("G[0, 1] v_lon(SV) > 0", path, HOME).verdict == "true"  # what nobody asks for is free


def test_a_missing_column_names_the_signal_the_file_and_what_there_is(tmp_path: Path) -> None:
    path = written(tmp_path, table().drop("jerk"), "csv")
    with pytest.raises(InputError) as raised:
        rp.monitor("swift(SV)", path, HOME)
    for part in (str(path), "no column jerk", "signal jerk", "of own signals there are red"):
        assert part in str(raised.value)


def test_a_recording_has_own_signals_by_sample_and_kinds_by_vehicle(tmp_path: Path) -> None:
    recording = read_recording(written(tmp_path, table(), "csv"))
    assert recording.own["red"].tolist() == [float(k >= 4) for k in range(11)] * 2
    assert [KINDS[code - 1] for code in recording.kind_code] == ["car", "truck"]
    kept = keep_vehicles(recording, recording.kind == "Car")
    assert isinstance(kept, Recording)
    assert kept.own["red"].tolist() == recording.own["red"].tolist()[:11]
    assert (
        rp.monitor("kind(SV) = truck and F[0, 1] swift(SV)", f"{tmp_path}/a.csv:2,1", HOME).verdict == "true"
    )


def test_evaluate_reads_own_signals_and_refuses_recordings_without(tmp_path: Path) -> None:
    spec = "signal red: bool def rssViolation(a, b: vehicle) := red"
    home = rp.load(specs=[spec])
    data = tmp_path / "data"
    data.mkdir()
    written(data, table().drop("kind"), "csv")
    assert rp.evaluate(data, tmp_path / "out", home, pictures=False).exit_code == 0
    written(data, table().drop("kind", "red"), "csv")
    with pytest.raises(InputError, match=r"a\.csv: recording a: there is no column red"):
        rp.evaluate(data, tmp_path / "other", home)


def test_what_files_call_kinds() -> None:
    told = {
        "Car": "car",
        "taxi": "car",
        "Truck": "truck",
        "bus": "bus",
        "Motorbike": "motorcycle",
        "van": "other",
    }
    assert {name: kind_called(name) for name in told} == told
    assert [str(x) for x in own_numbers(["", None, "nan", True, "FALSE", "1e3"])] == [
        *("nan", "nan", "nan", "1.0", "0.0", "1000.0")
    ]
