"""Files appear whole or not at all; what is no file is written to and stays what it is."""

import errno
import json
import os
import shutil
import stat
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import pytest

from roadproof.errors import InputError
from roadproof.frontends.cli.main import main
from roadproof.runtime.files import atomic_file, write_atomic


def test_a_pipe_is_written_to(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    heard: list[bytes] = []
    reader = threading.Thread(target=lambda: heard.append(pipe.read_bytes()))
    reader.start()
    write_atomic(pipe, b"told")
    reader.join(30)
    assert heard == [b"told"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_link_is_followed(tmp_path: Path) -> None:
    real, link = tmp_path / "real", tmp_path / "link"
    real.write_bytes(b"old")
    link.symlink_to(real)
    write_atomic(link, b"new")
    assert link.is_symlink()
    assert real.read_bytes() == b"new"


def test_half_a_file_is_none(tmp_path: Path) -> None:
    path = tmp_path / "answer"
    path.write_bytes(b"old")

    def write_half() -> None:
        with atomic_file(path) as file:
            file.write(b"half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_half()
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="Is a directory"):
        write_atomic(tmp_path, b"x")


def test_a_link_to_a_pipe_is_followed(tmp_path: Path) -> None:
    pipe, link = tmp_path / "pipe", tmp_path / "link"
    os.mkfifo(pipe)
    link.symlink_to(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_atomic(link, b"told")
    assert os.read(reader, 100) == b"told"
    os.close(reader)
    assert link.is_symlink()
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_full_disk_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(**_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(tempfile, "mkstemp", fail)
    assert main(["list", "--json", str(tmp_path / "answer")]) == 3
    assert "no space left on device" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full device")
def test_stdout_on_a_full_disk_is_told() -> None:
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-m", "roadproof.frontends.cli.main", "list"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 3
    assert done.stderr.startswith("roadproof: cannot write the answer: no space left on device")
    assert len(done.stderr.splitlines()) == 1


DRIVE = Path(__file__).parents[1] / "examples" / "catalogue" / "tests" / "drives" / "braking.json"
NO_TEXT = os.fsdecode(b"gr\xf6sse")
"""A name in Latin-1, which is no UTF-8."""


@pytest.fixture
def latin(tmp_path: Path) -> Path:
    """A folder with a drive and with samples, under a name that is no UTF-8."""
    folder = tmp_path / NO_TEXT
    try:
        folder.mkdir()
    except OSError:
        pytest.skip("this file system has no such names")
    shutil.copy(DRIVE, folder)
    (folder / "samples.csv").write_text("time,vehicle,s\n0,SV,1\n")
    return folder


def test_names_that_are_no_text_are_escaped(latin: Path, tmp_path: Path) -> None:
    """JSON has an escape that is read as the same name; a page shows it."""
    answer, page, build = tmp_path / "answer.json", tmp_path / "page.html", tmp_path / "build.xml"
    assert main(["check", str(latin), "--json", str(answer), "--junit", str(build)]) == 0
    [finding] = json.loads(answer.read_text("utf-8"))["findings"]
    assert finding["where"] == str(latin / DRIVE.name)
    assert main(["report", str(latin), "--out", str(page)]) == 0
    assert "\\udcf6" in page.read_text("utf-8")
    assert "\\udcf6" in build.read_text("utf-8")


@pytest.mark.parametrize(
    "command",
    [
        "monitor 4 {}/samples.csv",
        "evaluate {}/samples.csv --out out",
        "convert {}/samples.csv --out out",
        "catalogue {} --out out",
        "catalogue {}/braking.json --out out",
        "witness 4 --spec {}/mine.spec",
        "bundle {} --out out.tar.gz",
    ],
)
def test_what_evidence_names_has_to_be_text(
    command: str,
    latin: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """``check`` refuses such a name, and polars does not read such files."""
    monkeypatch.chdir(tmp_path)
    assert main(command.replace("{}", latin.name).split()) == 3
    assert "this path is not UTF-8 text" in capsys.readouterr().err
