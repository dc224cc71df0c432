"""Recordings kept as Parquet: what comes back is what was read, of every format, and damage is named."""

import hashlib
import json
import random
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import roadproof as rp
from extensions.traffic.make_recording import Track, cruise, make_recording
from extensions.traffic.planar import commonroad_of
from extensions.traffic.planar_exid import write_exid
from extensions.traffic.sampled import TWO, toml_of, write_samples
from extensions.traffic.test_exid import bent
from extensions.traffic.test_samples import own_table as table
from extensions.traffic.test_samples import table as sample_table
from extensions.traffic.test_samples import written
from extensions.traffic.test_topology import with_ramps
from extensions.traffic.tiny_commonroad import document
from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.converted import (
    HEAD,
    SAMPLES,
    digest_of,
    divide_converted,
    read_converted,
    same_recording,
    write_converted,
)
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.sources import find_source, find_sources
from roadproof.extensions.traffic.formats.table import polars_module
from roadproof.frontends.cli.main import main
from roadproof.world.models import load_road


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
    more = {"custom_signals": {"x": recording.s}, "moments": np.arange(3), "label": np.array(["x"])}
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
        changed = {**said, **change}
        head.write_text(json.dumps(changed | {"sha256": digest_of(changed)}))
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


def sealed_anew(head: Path, said: dict[str, Any], frame: Any = None) -> None:
    """What a forger writes who knows how digests are made."""
    samples = head.with_name(head.name.replace(HEAD, SAMPLES))
    if frame is not None:
        frame.write_parquet(samples)
    digest = hashlib.sha256(samples.read_bytes()).hexdigest()
    said = {**said, "samples": {**said["samples"], "sha256": digest}}
    head.write_text(json.dumps({**said, "sha256": digest_of(said)}))


def copied(folder: Path, to: Path) -> Path:
    shutil.copytree(folder, to)
    return next(to.glob(f"*{HEAD}"))


@pytest.fixture(scope="module")
def traffic(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Converted recordings by how they were made: with ramps, without, and on a measured road."""
    folder = tmp_path_factory.mktemp("forged")
    made = rp.simulate(folder / "plain-in", seconds=20, seed=1, jobs=1).folder
    ramps = rp.simulate(folder / "ramp-in", seconds=20, seed=3, ramp="merge", jobs=1).folder
    (folder / "measured-in").mkdir()
    for name, path in (("plain", made), ("ramp", ramps), ("measured", commonroad(folder / "measured-in"))):
        rp.convert(path, folder / name, jobs=1)
    return folder


@pytest.mark.parametrize("key", ["name", "rate", "lanes", "beside", "counts", "vehicles", "notes", "made_of"])
def test_a_changed_head_is_refused_by_its_digest(key: str, traffic: Path, tmp_path: Path) -> None:
    head = copied(traffic / "plain", tmp_path / "x")
    said = json.loads(head.read_text())
    said[key] = "x" if key == "name" else 30 if key == "rate" else said[key] and {**said, "more": 1}
    said["notes"] = [*said["notes"], "x"] if key == "notes" else said["notes"]
    head.write_text(json.dumps(said))
    with pytest.raises(InputError, match="sha256 differs"):
        read_converted(head)


VEHICLES = {
    "tiny": (
        lambda v: v | {"length": [0.1] * len(v["length"])},
        "is usually|wider than|say otherwise",
    ),
    "no size": (lambda v: v | {"width": [0.0, *v["width"][1:]]}, "sizes are greater than 0"),
    "huge": (lambda v: v | {"length": [51.0, *v["length"][1:]]}, "at most 50 m"),
    "same id": (lambda v: v | {"vehicle_id": v["vehicle_id"][:1] * 2 + v["vehicle_id"][2:]}, "ids must"),
    "longer": (lambda v: v | {"width": [x + 1.5 for x in v["width"]]}, "usually|say otherwise"),
    "turned": (lambda v: v | {"direction": [3 - x for x in v["direction"]]}, "say otherwise"),
}


@pytest.mark.parametrize("forgery", VEHICLES)
@pytest.mark.parametrize("of", ["plain", "ramp"])
def test_forged_vehicles_with_new_digests_are_refused(
    forgery: str, of: str, traffic: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head = copied(traffic / of, tmp_path / "x")
    said = json.loads(head.read_text())
    change, told = VEHICLES[forgery]
    sealed_anew(head, said | {"vehicles": change(said["vehicles"])})
    with pytest.raises(InputError, match=told):
        read_converted(head)
    monkeypatch.setattr("roadproof.extensions.traffic.formats.windows.MOST_SAMPLES", 2000)
    with pytest.raises(InputError, match=told):
        divide_converted(head)


def _samples(name: str, change: Callable[[Any], Any]) -> Callable[[Any], Any]:
    pl = polars_module()
    return lambda frame: frame.with_columns(change(pl.col(name)).alias(name))


COLUMNS = {
    "km/h": (_samples("v_lon", lambda x: x * 3.6), "km/h"),
    "sign": (_samples("v_lat", lambda x: -x), "sign is turned"),
    "fast": (_samples("v_lon", lambda x: x + 400.0), "must be finite"),
    "jumps": (_samples("s", lambda x: x * 30), "say otherwise|contradict|does not move"),
    "nan": (_samples("a_lon", lambda x: x * float("nan")), "must be finite"),
    "other lanes": (_samples("occupancy", lambda x: x * 0 + 1), "say otherwise"),
    "no such lane": (_samples("occupancy", lambda x: x * 0 + 2**31), "no such bit|say otherwise"),
    "lane": (_samples("lane", lambda x: x * 0), "lane=0"),
    "far lane": (_samples("lane", lambda x: x * 0 + 40), "there are"),
    "zones": (_samples("zones", lambda x: x * 0 + 4), "say otherwise"),
}


@pytest.mark.parametrize("forgery", COLUMNS)
@pytest.mark.parametrize("of", ["plain", "ramp", "measured"])
def test_forged_samples_with_new_digests_are_refused(
    forgery: str, of: str, traffic: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head = copied(traffic / of, tmp_path / "x")
    said = json.loads(head.read_text())
    change, told = COLUMNS[forgery]
    frame = polars_module().read_parquet(head.with_name(head.name.replace(HEAD, SAMPLES)))
    changed = change(frame)
    if changed.equals(frame) or (of == "measured" and forgery in ("km/h", "sign", "jumps", "lane", "zones")):
        return  # too few vehicles, or the tiny road says so anyway
    sealed_anew(head, said, changed)
    with pytest.raises(InputError, match=told):
        read_converted(head)
    monkeypatch.setattr("roadproof.extensions.traffic.formats.windows.MOST_SAMPLES", 2000)
    if said["samples"]["rows"] > 2000:
        with pytest.raises(InputError, match=told):
            divide_converted(head)


def test_notes_that_a_forger_removes_come_back(traffic: Path, tmp_path: Path) -> None:
    """Another 30 m/s for one vehicle is a note of the reader, and stays one."""
    head = copied(traffic / "plain", tmp_path / "x")
    said = json.loads(head.read_text())
    frame = polars_module().read_parquet(head.with_name(head.name.replace(HEAD, SAMPLES)))
    speeds = frame["v_lon"].to_numpy().copy()
    speeds[: said["counts"][0]] *= 1.5
    sealed_anew(head, said | {"notes": []}, frame.with_columns(polars_module().Series("v_lon", speeds)))
    assert any("contradict each other" in note for note in read_converted(head).notes)


def test_straight_lanes_cannot_pass_for_measured_ones(traffic: Path, tmp_path: Path) -> None:
    """Columns of a measured road would turn the comparison with the lanes off."""
    head = copied(traffic / "plain", tmp_path / "x")
    pl = polars_module()
    frame = pl.read_parquet(head.with_name(head.name.replace(HEAD, SAMPLES)))
    more = frame.with_columns(**{f"slack:{x}": pl.lit(0.0) for x in ("along", "across", "turn", "off")})
    sealed_anew(head, json.loads(head.read_text()), more)
    with pytest.raises(InputError, match="no straight bands"):
        read_converted(head)


def test_a_recording_keeps_its_name(traffic: Path, tmp_path: Path) -> None:
    head = copied(traffic / "plain", tmp_path / "x")
    other = head.rename(head.with_name(f"02{HEAD}"))
    with pytest.raises(InputError, match="it is of recording '01'"):
        read_converted(other)


# --- Files of every format, hurt at random: a recording, or an InputError that names a file ---------

PIECES = ("", "0", "-1", "nan", "1e999", ",", "\n", "x", "<x/>", "&a;", '"', "]]>", "\x00", "é", "9" * 30)


def recording_of_two() -> Recording:
    return make_recording([Track(2, 0, cruise(-50, 30, 6, 2.7)), Track(2, 0, cruise(20, 30, 6, 2.7))])


def csv(folder: Path) -> Path:
    return write_samples(folder, "a", sample_table(*TWO), toml_of(load_road("merge")))


def commonroad_of_two(folder: Path) -> Path:
    path = folder / "a.xml"
    path.write_text(
        commonroad_of(recording_of_two(), with_ramps("merge"), types=lambda _: "urban", step=400.0)
    )
    (folder / "a_zones.toml").write_text('[[lanelet]]\nid = "1007"\nzone = "main"\nattribute = "merge"\n')
    return path


def exid_of_two(folder: Path) -> Path:
    return write_exid(recording_of_two(), with_ramps("merge"), folder)


@pytest.mark.parametrize("make", [csv, commonroad_of_two, exid_of_two])
def test_hurt_files(make: Callable[[Path], Path], tmp_path: Path) -> None:
    whole = tmp_path / "whole"
    whole.mkdir()
    name = make(whole).relative_to(whole)
    files = sorted(x.relative_to(whole) for x in whole.rglob("*") if x.is_file())
    chance, refused = random.Random(7), 0
    for turn in range(150):
        folder = tmp_path / str(turn)
        shutil.copytree(whole, folder)
        path = folder / files[turn % len(files)]
        text = path.read_text()
        begin = chance.randrange(len(text))
        end = min(len(text), begin + chance.randrange(0, 30))
        path.write_text(text[:begin] + chance.choice(PIECES) + text[end:])
        said = refusal(folder / name)
        assert said is None or str(folder) in said
        refused += said is not None
        shutil.rmtree(folder)
    assert refused > 60


def refusal(path: Path) -> str | None:
    """Why the recording of ``path`` is refused; None where it is not."""
    try:
        find_source(path).read()
    except InputError as error:
        return str(error)
    return None


@pytest.mark.parametrize("make", [csv, commonroad_of_two, exid_of_two])
@pytest.mark.parametrize(
    "content", [b"", b"\x00" * 300, b"PK\x03\x04", b"<!doctype html><html>", b"\xff\xfe<\x00"]
)
def test_other_files(
    make: Callable[[Path], Path], content: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """From the command line: exit code 3, the file named, no results."""
    path = make(tmp_path)
    for file in [x for x in tmp_path.rglob("*") if x.is_file() and x.suffix in (path.suffix, ".osm")]:
        kept = file.read_bytes()
        file.write_bytes(content)
        out = tmp_path.parent / f"{tmp_path.name}-out"
        assert main(["evaluate", str(path), "--out", str(out), "--no-pictures", "--jobs", "1"]) == 3
        message = capsys.readouterr().err
        assert str(tmp_path) in message
        assert "Traceback" not in message
        assert not (out / "results.json").exists()
        file.write_bytes(kept)
    assert main(["evaluate", str(path), "--list"]) == 0


BOMB = "".join(
    (
        '<!DOCTYPE l [<!ENTITY a0 "haha">',
        *(f'<!ENTITY a{k} "{f"&a{k - 1};" * 10}">' for k in range(1, 12)),
        "]>",
    )
)
FILE = '<!DOCTYPE x SYSTEM "file:///etc/passwd">'
NET = '<!DOCTYPE x [<!ENTITY % p SYSTEM "http://127.0.0.1/x"> %p;]>'


@pytest.mark.parametrize("head", [BOMB, FILE, NET])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_entities_are_never_read(head: str, encoding: str, tmp_path: Path) -> None:
    path = commonroad_of_two(tmp_path)
    text = path.read_text().partition("?>")[2]
    path.write_bytes(f'<?xml version="1.0" encoding="{encoding}"?>{head}{text}'.encode(encoding))
    with pytest.raises(InputError, match=r"a\.xml: the file has a document type"):
        find_source(path).read()
