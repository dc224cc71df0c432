"""Runs that are hurt: two in one folder, full disks, other inputs, copies, files of other kinds."""

import bz2
import errno
import gzip
import json
import lzma
import os
import pickle
import shutil
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from types import SimpleNamespace

import pytest

import roadproof as rp
from extensions.traffic.tiny_highd import tiny_files, write_files
from roadproof.errors import InputError
from roadproof.extensions.exchange.commonroad import read_commonroad
from roadproof.extensions.traffic.evaluate import experiment as module
from roadproof.extensions.traffic.evaluate import results
from roadproof.extensions.traffic.evaluate.experiment import Experiment, run_experiment
from roadproof.extensions.traffic.evaluate.one_trace import read_samples
from roadproof.extensions.traffic.evaluate.questions import default_settings
from roadproof.extensions.traffic.formats.highd import read_highd
from roadproof.extensions.traffic.formats.windows import TimeWindow, WindowedRecording
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.frontends.cli.main import main
from roadproof.runtime.files import lock_folder, write_atomic
from roadproof.world.models import load_road

TABLES = ("matches.csv", "pairs.csv", "results.json", "results.txt", "comparison.md", "answers.md")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings")
    for number in (1, 2):
        write_highd(simulate(TrafficSettings(seconds=15, lane_width=3.5), seed=6, number=number), path)
    return path


def evaluate(recordings: Path, out: Path, *options: str) -> int:
    return main(["evaluate", str(recordings), "--out", str(out), "--jobs", "1", "--no-pictures", *options])


def spoil(folder: Path, file: str, old: str, new: str) -> None:
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new, 1))


@pytest.mark.parametrize(
    ("file", "row", "column", "value", "said"),
    [
        (
            "02_recordingMeta.csv",
            1,
            1,
            "24.00",
            "row 2, column frameRate=24: ",
        ),
        ("02_tracks.csv", 40, 6, "1e155", "row 41, column xVelocity=1e+155: must lie between -250 and 250"),
    ],
)
def test_a_cell_that_breaks_the_evaluation_is_named(
    file: str,
    row: int,
    column: int,
    value: str,
    said: str,
    folder: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Exit 3, or with --keep-going the other recordings; both name file, row, column, value and rule."""
    ours = tmp_path / "ours"
    shutil.copytree(folder, ours)
    lines = (ours / file).read_text().splitlines()
    cells = lines[row].split(",")
    cells[column] = value
    lines[row] = ",".join(cells)
    (ours / file).write_text("\n".join(lines) + "\n")
    assert evaluate(ours, tmp_path / "a", "--strict") == 3
    assert f"{ours / file}, {said}" in capsys.readouterr().err
    assert evaluate(ours, tmp_path / "b", "--strict", "--keep-going") == 0
    printed = capsys.readouterr()
    assert "left out: 02" in printed.out
    assert said in printed.err
    assert json.loads((tmp_path / "b" / "results.json").read_text())["recordings"] == 1


def test_our_own_fault_names_the_recording(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(recording: object, questions: object) -> None:
        raise FloatingPointError("overflow")

    monkeypatch.setattr(module, "evaluate_windows", broken)
    with pytest.raises(RuntimeError, match="recording 01: FloatingPointError: overflow"):
        run_experiment(Experiment(folder, tmp_path, default_settings()))


@pytest.mark.parametrize("while_reading", [True, False])
def test_a_fault_of_a_window_has_the_name_of_its_file_once(
    while_reading: bool,
    folder: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A reader names the file itself, perhaps another one; nobody else does."""
    tracks, meta = folder / "01_tracks.csv", folder / "01_tracksMeta.csv"

    def refuse(recording: object) -> Iterator[TimeWindow]:
        raise InputError(f"{meta}: the file changed" if while_reading else "a value leaves the range")
        yield

    if while_reading:
        monkeypatch.setattr(
            "roadproof.extensions.traffic.formats.source.undivided",
            lambda x: WindowedRecording(x.rate, x.zone_names, lambda: refuse(x)),
        )
    else:
        monkeypatch.setattr(module, "evaluate_windows", lambda windows, questions: [*refuse(windows)])
    assert evaluate(folder, tmp_path) == 3
    message = capsys.readouterr().err.splitlines()[-1]
    expected = f"{meta}: the file changed" if while_reading else f"{tracks}: a value leaves the range"
    assert message.endswith(f"roadproof: {expected}")


def test_notes_are_on_the_screen_and_in_the_results(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ours = tmp_path / "ours"
    shutil.copytree(folder, ours)
    lines = (ours / "01_tracks.csv").read_text().splitlines()
    cells = lines[30].split(",")
    cells[-1] = "1"
    lines[30] = ",".join(cells)
    (ours / "01_tracks.csv").write_text("\n".join(lines) + "\n")
    assert evaluate(ours, tmp_path / "out") == 0
    printed = capsys.readouterr()
    note = "01_tracks.csv, row 31, column laneId=1: laneId is not the lane of the box's centre in 1 rows"
    assert f"note: recording 01: {note}" in printed.err
    assert "There is 1 note on 1 recordings" in printed.out
    assert note in (tmp_path / "out" / "answers.md").read_text()
    assert note in (tmp_path / "out" / "results.json").read_text()


def test_a_failing_run_leaves_no_tables_of_another_input(folder: Path, tmp_path: Path) -> None:
    out, ours = tmp_path / "out", tmp_path / "ours"
    assert evaluate(folder, out) == 0
    assert all((out / name).exists() for name in TABLES)
    shutil.copytree(folder, ours)
    (ours / "01_tracks.csv").write_text("")
    assert evaluate(ours, out) == 3
    assert not any((out / name).exists() for name in TABLES)
    assert evaluate(folder, out) == 0
    assert all((out / name).exists() for name in TABLES)


def test_a_mistake_in_the_options_costs_no_tables(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert evaluate(folder, out) == 0
    assert evaluate(folder, out, "--among", "99") == 3
    assert evaluate(tmp_path / "nowhere", out) == 3
    assert all((out / name).exists() for name in TABLES)


def test_two_runs_in_one_folder(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The second is refused and touches nothing; a run that was killed holds nothing."""
    out = tmp_path / "out"
    other = started(HOLD, out, 600.0)
    try:
        (out / "results.txt").write_text("another's")
        assert evaluate(folder, out) == 3
        said = capsys.readouterr().err
        assert f"{out}: another run is writing into this folder; wait until it is done" in said
        assert (out / "results.txt").read_text() == "another's"
    finally:
        other.kill()
        other.wait()
    assert evaluate(folder, out) == 0


def test_a_folder_is_let_go_of(tmp_path: Path) -> None:
    for _ in range(2):
        with lock_folder(tmp_path / "out"):
            second = lock_folder(tmp_path / "out")
            with pytest.raises(InputError, match="another run"):
                second.__enter__()
    assert not list((tmp_path / "out").iterdir())


@pytest.mark.parametrize(
    ("number", "said"),
    [
        (errno.ENOSPC, "no space left on device; make room there"),
        (errno.EDQUOT, "make room there"),
        (errno.EROFS, "Read-only file system; name another folder"),
        (errno.ENOENT, "name a folder that exists"),
    ],
)
def test_a_full_disk_is_called_full(
    number: int, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(source: str, target: Path) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(InputError, match=said):
        write_atomic(tmp_path / "file", b"content")
    assert not list(tmp_path.iterdir())


def test_results_are_kept_by_content_not_by_time(folder: Path, tmp_path: Path) -> None:
    """Other content of the same size and time is evaluated again; the same content of another time is not."""
    ours, out = tmp_path / "ours", tmp_path / "out"
    shutil.copytree(folder, ours)

    def evaluated() -> int:
        told: list[str] = []
        run_experiment(Experiment(ours, out, default_settings()), told.append)
        return sum(line.startswith("[") for line in told)

    assert evaluated() == 2
    meta = ours / "01_recordingMeta.csv"
    times = meta.stat()
    spoil(ours, meta.name, "12:00", "12:01")
    os.utime(meta, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert (meta.stat().st_size, meta.stat().st_mtime_ns) == (times.st_size, times.st_mtime_ns)
    assert evaluated() == 1
    os.utime(meta, ns=(1, 1))
    assert evaluated() == 0


def test_results_of_another_program_are_not_kept(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    run_experiment(Experiment(folder, tmp_path, default_settings()))
    monkeypatch.setattr(results, "program_digest", lambda: "another program")
    run_experiment(Experiment(folder, tmp_path, default_settings()), told.append)
    assert sum(line.startswith("[") for line in told) == 2


def test_results_that_were_changed_are_not_kept(folder: Path, tmp_path: Path) -> None:
    run_experiment(Experiment(folder, tmp_path, default_settings()))
    before = (tmp_path / "matches.csv").read_bytes()
    saved = tmp_path / "recordings" / "01.json"
    data = json.loads(saved.read_text())
    data["findings"]["matches"].pop()
    saved.write_text(json.dumps(data))
    told: list[str] = []
    run_experiment(Experiment(folder, tmp_path, default_settings()), told.append)
    assert [line for line in told if line.startswith("[")] == ["[1/1] 01"]
    assert (tmp_path / "matches.csv").read_bytes() == before


def test_results_that_are_no_findings_are_not_kept(folder: Path, tmp_path: Path) -> None:
    run_experiment(Experiment(folder, tmp_path, default_settings()))
    saved = tmp_path / "recordings" / "01.json"
    whole = saved.read_text()
    data = json.loads(whole)
    del data["findings"]["triples"]
    data["seal"] = results.seal(data["fingerprint"], data["findings"])
    for text in (json.dumps(data), "[" * 100_000):
        saved.write_text(text)
        told: list[str] = []
        run_experiment(Experiment(folder, tmp_path, default_settings()), told.append)
        assert [line for line in told if line.startswith("[")] == ["[1/1] 01"]
        assert saved.read_text() == whole


def test_a_recording_under_two_names_counts_once(folder: Path, tmp_path: Path) -> None:
    ours = tmp_path / "ours"
    shutil.copytree(folder, ours)
    for name in ("recordingMeta", "tracksMeta", "tracks"):
        shutil.copy2(ours / f"01_{name}.csv", ours / f"03_{name}.csv")
    spoil(ours, "03_recordingMeta.csv", "\n1,", "\n3,")
    with pytest.raises(InputError, match=r"03_tracks\.csv: the same content as .*01_tracks\.csv"):
        run_experiment(Experiment(ours, tmp_path / "a", default_settings()))
    outcome = run_experiment(Experiment(ours, tmp_path / "b", default_settings(), keep_going=True))
    assert list(outcome.failed) == ["03"]
    assert outcome.totals.recordings == 2


def test_equal_settings_are_compiled_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers get a copy of the settings with every recording."""
    asked, honest = [], module.compile_questions
    monkeypatch.setattr(
        module,
        "compile_questions",
        lambda settings, *on: asked.append(on) or honest(settings, *on),
    )
    monkeypatch.setattr(module, "_compiled", {})
    settings = replace(default_settings(), scenarios=(3,))
    question = results.question_digest(settings)
    recording = read_highd(folder, "01")
    for _ in range(3):
        copy = pickle.loads(pickle.dumps(settings))
        assert copy is not settings
        assert results.question_digest(copy) == question
        module.questions_for(copy, question, recording)
    assert asked == [(25, ("main",))]
    other = replace(settings, scenarios=(4,))
    module.questions_for(other, results.question_digest(other), recording)
    assert asked == [(25, ("main",))] * 2


def zipped(content: bytes) -> bytes:
    file = BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("01_tracks.csv", content)
    return file.getvalue()


KINDS = {
    "semicolons": (lambda c: c.replace(b",", b";"), "has its columns separated by semicolons"),
    "decimal commas": (lambda c: c.replace(b",", b";").replace(b".", b","), "no table|semicolons"),
    "tabs": (lambda c: c.replace(b",", b"\t"), "has its columns separated by tabs"),
    "gzip": (gzip.compress, "is compressed by gzip; unpack it first"),
    "bzip2": (bz2.compress, "is compressed by bzip2"),
    "xz": (lzma.compress, "is compressed by xz"),
    "zip": (zipped, "is a ZIP archive or a spreadsheet"),
    "UTF-16": (lambda c: c.decode().encode("utf-16"), "is text in UTF-16; save it as UTF-8"),
    "UTF-16 without a mark": (lambda c: c.decode().encode("utf-16-le"), "is text in UTF-16"),
    "HTML": (lambda c: b"<!DOCTYPE html>\n<html><body>Log in</body></html>\n", "is a page of HTML"),
    "HTML without a type": (lambda c: b"\n  <HTML>\n<p>404</p>\n", "is a page of HTML"),
    "XML": (lambda c: b'<?xml version="1.0"?>\n<a/>\n', "is XML or HTML"),
    "JSON": (lambda c: b'{"frame": 1}\n', "is JSON, not a table of numbers"),
    "Parquet": (lambda c: b"PAR1" + c, "is a Parquet file"),
    "a pointer": (
        lambda c: b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
        "a pointer of Git LFS",
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_files_of_other_kinds_are_called_by_their_names(kind: str, tmp_path: Path) -> None:
    change, said = KINDS[kind]
    write_files(tiny_files(), tmp_path)
    for name in ("01_tracks.csv", "01_tracksMeta.csv", "01_recordingMeta.csv"):
        path = tmp_path / name
        honest = path.read_bytes()
        path.write_bytes(change(honest))
        if kind == "semicolons" and name == "01_recordingMeta.csv":
            assert b";" in honest  # its markings
        with pytest.raises(InputError, match=f"{name}: the file .*({said})"):
            read_highd(tmp_path, "01")
        path.write_bytes(honest)
    samples = tmp_path / "samples.csv"
    samples.write_bytes(
        change(b"time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width\n0,SV,1,2,3,0,0,0,4,2\n")
    )
    with pytest.raises(InputError, match=said):
        read_samples(samples, load_road("main-2"))


@pytest.mark.parametrize("kind", ["gzip", "zip", "HTML", "a pointer"])
def test_commonroad_files_of_other_kinds(kind: str, tmp_path: Path) -> None:
    change, said = KINDS[kind]
    path = tmp_path / "a.xml"
    path.write_bytes(change(b"<commonRoad/>"))
    with pytest.raises(InputError, match=f"a.xml: the file .*{said}"):
        read_commonroad(path)


# --- Two runs on one folder: the second one is refused, however short after the first it begins -----

HOLD = """
import sys, time
from pathlib import Path
from roadproof.runtime.files import lock_folder
with lock_folder(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(float(sys.argv[2]))
"""
LEAVE_A_CHILD = """
import os, sys, time
from pathlib import Path
from roadproof.runtime.files import lock_folder
with lock_folder(Path(sys.argv[1])):
    if os.fork() == 0:
        print("held", flush=True)
        time.sleep(float(sys.argv[2]))
    os._exit(0)
"""
HANGS = 120.0
linux = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")


def started(script: str, folder: Path, seconds: float) -> subprocess.Popen[str]:
    arguments = [sys.executable, "-c", script, str(folder), str(seconds)]
    holder = subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    assert holder.stdout.readline() == "held\n"
    return holder


def waiting(monkeypatch: pytest.MonkeyPatch, wait: Callable[[], None]) -> list[float]:
    """The seconds that a run which waits for a folder sleeps, without doing so; it does ``wait`` then."""
    asked: list[float] = []

    def sleep(seconds: float) -> None:
        asked.append(seconds)
        wait()

    clock = SimpleNamespace(monotonic=lambda: sum(asked), sleep=sleep)
    monkeypatch.setattr("roadproof.runtime.files.time", clock)
    return asked


@linux
def test_a_run_that_lives_refuses_others_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Others once waited up to five seconds for it, and then wrote into the same folder."""
    holder = started(HOLD, tmp_path, 600.0)
    asked = waiting(monkeypatch, lambda: None)
    try:
        with pytest.raises(InputError, match="another run is writing"), lock_folder(tmp_path):
            pass
    finally:
        holder.kill()
        holder.wait()
    assert asked == []
    with lock_folder(tmp_path):
        pass


@linux
def test_processes_that_a_dead_run_leaves_are_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roadproof.runtime.files.RELEASE_SECONDS", 60.0)
    holder = started(LEAVE_A_CHILD, tmp_path, 1.0)
    assert holder.wait() == 0
    with lock_folder(tmp_path):
        pass


@linux
@pytest.mark.parametrize(
    ("state", "flags", "pending"),
    [("Z", 0, (0, 0)), ("R", 4, (0, 0)), ("S", 0, (1 << 8, 0)), ("D", 0, (0, 1 << 8)), ("S", 0, (0, 0))],
)
def test_a_dying_run_is_waited_for(
    state: str, flags: int, pending: tuple[int, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A zombie, one that exits, one with SIGKILL pending; a run that lives refuses others at once."""
    import fcntl

    proc, folder = tmp_path / "proc", tmp_path / "out"
    (proc / "77").mkdir(parents=True)
    folder.mkdir()
    (proc / "locks").write_text(f"1: FLOCK  ADVISORY  WRITE 77 fe:00:{folder.stat().st_ino} 0 EOF\n")
    (proc / "77" / "stat").write_text(f"77 (a (b) c) {state} 1 77 77 0 -1 {flags} 0 0\n")
    masks = "".join(
        f"{name}:\t{mask:016x}\n" for name, mask in zip(("SigPnd", "ShdPnd"), pending, strict=True)
    )
    (proc / "77" / "status").write_text(f"Name:\ta\n{masks}")
    monkeypatch.setattr("roadproof.runtime.files._PROC", proc)
    other = os.open(folder, os.O_RDONLY)
    fcntl.flock(other, fcntl.LOCK_EX)
    asked = waiting(monkeypatch, lambda: os.close(other))
    if (state, flags, pending) == ("S", 0, (0, 0)):
        with pytest.raises(InputError, match="another run is writing"), lock_folder(folder):
            pass
        assert asked == []
        os.close(other)
    else:
        with lock_folder(folder):
            assert len(asked) == 1


# The run that has the folder waits until the other one has ended, however slow that is.
RACE = """
import sys, time
from pathlib import Path
from roadproof.extensions.traffic import evaluating as recordings
from roadproof.frontends.cli.main import main
run = recordings.run_experiment
def wait(*arguments):
    while not Path("ended").exists():
        time.sleep(0.01)
    return run(*arguments)
recordings.run_experiment = wait
sys.exit(main(sys.argv[1:]))
"""


@linux
@pytest.mark.parametrize("apart", [0.0, 0.01, 0.03, 0.05])
def test_two_evaluations_that_begin_together(apart: float, tmp_path: Path) -> None:
    made = rp.simulate(tmp_path / "made", recordings=2, seconds=30, seed=1, jobs=1).folder
    command = [sys.executable, "-c", RACE, "evaluate", str(made), "--out", str(tmp_path / "out")]
    command += ["--jobs", "1", "--no-pictures", "--quiet"]
    runs, pipe = [], subprocess.PIPE
    for _ in range(2):
        runs.append(subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, cwd=tmp_path))
        time.sleep(apart)
    latest = time.monotonic() + HANGS
    while all(run.poll() is None for run in runs) and time.monotonic() < latest:
        time.sleep(0.01)
    (tmp_path / "ended").touch()
    said = [run.communicate() for run in runs]
    codes = [run.returncode for run in runs]
    assert sorted(codes) == [0, 3], said
    assert "another run is writing into this folder" in said[codes.index(3)][1]
    assert not [x for x in os.listdir(tmp_path / "out") if x.startswith(".")]
