"""Every command takes every format: one traffic in several of them gives one answer."""

import csv
import dataclasses
import json
from pathlib import Path

import polars as pl
import pytest

from roadproof.analysis.basis import Basis
from roadproof.analysis.coverage.traffic import disturbances_in, recordings_in
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library
from roadproof.recordings.formats.highd import read_highd
from roadproof.recordings.formats.recording import Recording, keep_vehicles
from roadproof.recordings.formats.samples import read_columns
from roadproof.recordings.formats.write_highd import write_highd
from roadproof.recordings.simulate.plant import Place, plant
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic
from traffic.drives import braking, cut_in
from traffic.planar import commonroad_of
from traffic.sampled import csv_of, lower_road, toml_of, write_samples

FORMATS = {"highD": "01_tracks.csv", "CSV": "01.csv", "Parquet": "01.parquet", "CommonRoad": "01.xml"}


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The same vehicles, which drive on lower lanes only, in each format; frames are counted from 0."""
    root = tmp_path_factory.mktemp("formats")
    recording = simulate(Traffic(seconds=20, lane_width=3.5), seed=4)
    right = min(lane.d[0] for lane in recording.lanes if lane.direction == 2 and lane.d)
    for drive, frame in ((cut_in(), 20), (braking(), 250)):
        recording, _ = plant(recording, drive, Place(2, frame, 6, 10.0, right))
    ours = keep_vehicles(recording, recording.direction == 2)
    shifted = dataclasses.replace(ours, first_frame=ours.first_frame - ours.first_frame.min())
    write_highd(shifted, root / "highD")
    read = read_highd(root / "highD", "01")
    path = write_samples(root / "CSV", "01", csv_of(read), toml_of(lower_road(read)))
    (root / "Parquet").mkdir()
    (root / "Parquet" / "01_road.toml").write_bytes(path.with_name("01_road.toml").read_bytes())
    pl.DataFrame(dict(read_columns(path).columns)).write_parquet(root / "Parquet" / "01.parquet")
    (root / "CommonRoad").mkdir()
    (root / "CommonRoad" / "01.xml").write_text(commonroad_of(read, lower_road(read)))
    return {name: root / name for name in FORMATS}


def evaluated(folder: Path, out: Path) -> list[str]:
    """Matches without the name of the recording, and without whether they are uncertain."""
    assert main(["evaluate", str(folder), "--out", str(out), "--no-pictures", "--jobs", "1"]) == 0
    lines = (out / "matches.csv").read_text().splitlines()
    return [line.partition(",")[2].rpartition(",")[0] for line in lines]


def test_evaluate(folders: dict[str, Path], tmp_path: Path) -> None:
    expected = evaluated(folders["highD"], tmp_path / "highD")
    assert len(expected) > 10
    for name, file in FORMATS.items():
        assert evaluated(folders[name] / file, tmp_path / f"{name}-file") == expected, name


def test_monitor(folders: dict[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A match of scenario 1 and one of 4, and what is not one, as an evaluation has them."""
    rows = list(csv.reader(evaluated(folders["highD"], tmp_path / "o")[1:]))
    chosen = [next(row for row in rows if row[6:9] == ["0.6", "base", number]) for number in ("1", "4")]
    capsys.readouterr()
    for sv, pov, _, lane, first, last, _, _, number, _ in chosen:
        for name, file in FORMATS.items():
            trace = f"{folders[name] / file}:{sv},{pov}"
            for asked, code in ((number, 0), (str(5 - int(number)), 10)):
                assert main(["monitor", asked, trace, "--frames", f"{first}-{last}", "--json", "-"]) in (
                    code,
                    20,
                )
                told = json.loads(capsys.readouterr().out)
                assert (told["verdict"] == "true") == (code == 0)
                assert told["lanes"]["L"] == lane


def test_coverage(folders: dict[str, Path]) -> None:
    basis = Basis(bundled_library().select())
    expected = list(disturbances_in(basis, recordings_in(folders["highD"])))
    assert any(trace.missed for trace in expected)
    assert not all(trace.missed for trace in expected)
    for name in ("CommonRoad", "CSV"):
        assert list(disturbances_in(basis, recordings_in(folders[name]))) == expected, name


def test_classify(folders: dict[str, Path]) -> None:
    """Shares are counted on what an evaluation reads."""
    from roadproof.frontends.api.classifying import _recordings

    for folder in folders.values():
        source, recordings = _recordings(folder)
        (recording,) = recordings
        assert isinstance(recording, Recording)
        assert source == str(folder)
