"""Recordings kept as Parquet: what comes back is what was read, of every format, and damage is named."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from roadproof.cli.main import main
from roadproof.errors import InputError
from roadproof.formats.converted import HEAD, SAMPLES, read_converted, same_recording, write_converted
from roadproof.formats.sources import find_source, find_sources
from traffic.make_recording import Track, make_recording
from traffic.planar_exid import write_exid
from traffic.test_exid import bent
from traffic.test_own_columns import table, written
from traffic.test_topology import with_ramps
from traffic.tiny_commonroad import document


def highd(folder: Path) -> Path:
    return rp.simulate(folder, recordings=2, seconds=8, seed=3, ramp="merge", jobs=1).folder


def exid(folder: Path) -> Path:
    rows = [(100.0 + k, 5.5, 25.0, 0.0, 0.0, 0.0) for k in range(30)]
    write_exid(make_recording([Track(2, 4, rows, 4.4, 1.8)]), with_ramps("merge"), folder, bent)
    return folder


def commonroad(folder: Path) -> Path:
    (folder / "a.xml").write_text(document())
    return folder


def own(folder: Path) -> Path:
    return written(folder, table(), "csv").parent


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return highd(tmp_path_factory.mktemp("highd"))


@pytest.mark.parametrize("make", [highd, exid, commonroad, own])
def test_what_comes_back_is_what_was_read(make: object, tmp_path: Path) -> None:
    path = make(tmp_path / "in" if make is highd else tmp_path)  # type: ignore[operator]
    made = rp.convert(path, tmp_path / "out", jobs=1)
    before, after = find_sources(path), find_sources(tmp_path / "out")
    assert [x.name for x in after] == [x.name for x in before] == list(made.samples)
    for one, other in zip(before, after, strict=True):
        assert same_recording(one.read(), other.read())
        assert made.samples[one.name] == len(one.read().s)
        assert find_source(other.files[-1]).files == find_source(other.files[0]).files == other.files


def test_answers_are_the_same_bytes(
    simulated: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["convert", str(simulated), "--out", str(tmp_path / "kept"), "--jobs", "2"]) == 0
    assert "2 recordings with" in capsys.readouterr().out
    for name in ("plain", "kept"):
        source = simulated if name == "plain" else tmp_path / "kept"
        assert main(["evaluate", str(source), "--out", str(tmp_path / name / "r"), "--no-pictures"]) == 0
    for name in ("matches.csv", "pairs.csv", "results.json", "results.txt"):
        assert (tmp_path / "plain/r" / name).read_bytes() == (tmp_path / "kept/r" / name).read_bytes()


def test_every_difference_is_seen(simulated: Path) -> None:
    recording = find_sources(simulated)[0].read()
    assert recording.lanelets
    assert same_recording(recording, replace(recording))
    for name in ("s", "v_lat", "occupancy", "lane", "zones", "inside", "length", "kind", "start"):
        values = getattr(recording, name).copy()
        values[-1] = "x" if name == "kind" else ~values[-1] if name == "inside" else values[-1] + 1
        assert not same_recording(recording, replace(recording, **{name: values})), name
    others = {"rate": 1, "notes": ("x",), "beside": frozenset(), "lanes": (), "lanelets": ()}
    more = {"own": {"x": recording.s}, "moments": np.arange(3), "label": np.array(["x"])}
    for name, value in (others | more).items():
        assert not same_recording(recording, replace(recording, **{name: value})), name


def test_damage_is_named(simulated: Path, tmp_path: Path) -> None:
    write_converted(find_sources(simulated)[0], tmp_path)
    head, samples = tmp_path / f"01{HEAD}", tmp_path / f"01{SAMPLES}"
    said, content = json.loads(head.read_text()), samples.read_bytes()
    for change, told in (
        ({"roadproof": "0.0.7"}, "converted by version 0.0.7"),
        ({"schema": "roadproof/recording/9"}, "schema='roadproof/recording/9'"),
        ({"counts": said["counts"][:-1]}, "do not fit"),
        ({"lanes": None}, "not what convert writes"),
        ({"vehicles": {}}, "not what convert writes"),
        ({"samples": {}}, "not what convert writes"),
    ):
        head.write_text(json.dumps({**said, **change}))
        with pytest.raises(InputError, match=told):
            read_converted(head)
    for text in ("", "[]", "{}", "null", '{"schema":', "x" * 100):
        head.write_text(text)
        with pytest.raises(InputError, match="not what convert writes"):
            read_converted(head)
    head.write_text(json.dumps(said))
    samples.write_bytes(content[:-1] + b"x")
    with pytest.raises(InputError, match="its content is not what"):
        read_converted(head)
    samples.unlink()
    with pytest.raises(InputError, match="cannot be read"):
        read_converted(head)


def test_what_is_no_use(simulated: Path, tmp_path: Path) -> None:
    rp.convert(simulated / "01_tracks.csv", tmp_path / "kept", jobs=1)
    with pytest.raises(InputError, match="converted already"):
        rp.convert(tmp_path / "kept", tmp_path / "again")
    with pytest.raises(InputError, match="where the recordings are"):
        rp.convert(simulated, simulated)
    with pytest.raises(InputError, match="no recording in it"):
        rp.convert(tmp_path, tmp_path / "again")
