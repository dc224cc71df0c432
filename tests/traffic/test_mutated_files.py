"""Files of every format, hurt at random: a recording, or an InputError that names a file."""

import random
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from roadproof.errors import InputError
from roadproof.frontends.cli.main import main
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.formats.sources import find_source
from roadproof.world.models import load_road
from traffic.make_recording import Track, cruise, make_recording
from traffic.planar import commonroad_of
from traffic.planar_exid import write_exid
from traffic.sampled import TWO, toml_of, write_samples
from traffic.test_samples import table
from traffic.test_topology import with_ramps

PIECES = ("", "0", "-1", "nan", "1e999", ",", "\n", "x", "<x/>", "&a;", '"', "]]>", "\x00", "é", "9" * 30)


def recording_of_two() -> Recording:
    return make_recording([Track(2, 0, cruise(-50, 30, 6, 2.7)), Track(2, 0, cruise(20, 30, 6, 2.7))])


def csv(folder: Path) -> Path:
    return write_samples(folder, "a", table(*TWO), toml_of(load_road("merge")))


def commonroad(folder: Path) -> Path:
    path = folder / "a.xml"
    path.write_text(
        commonroad_of(recording_of_two(), with_ramps("merge"), types=lambda _: "urban", step=400.0)
    )
    (folder / "a_zones.toml").write_text('[[lanelet]]\nid = "1007"\nzone = "main"\nattribute = "merge"\n')
    return path


def exid(folder: Path) -> Path:
    return write_exid(recording_of_two(), with_ramps("merge"), folder)


@pytest.mark.parametrize("make", [csv, commonroad, exid])
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


@pytest.mark.parametrize("make", [csv, commonroad, exid])
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
    path = commonroad(tmp_path)
    text = path.read_text().partition("?>")[2]
    path.write_bytes(f'<?xml version="1.0" encoding="{encoding}"?>{head}{text}'.encode(encoding))
    with pytest.raises(InputError, match=r"a\.xml: the file has a document type"):
        find_source(path).read()
