"""Two runs on one folder: the second one is refused, however short after the first it begins."""

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.runtime.files import hold_folder

HOLD = """
import sys, time
from pathlib import Path
from roadproof.runtime.files import hold_folder
with hold_folder(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(float(sys.argv[2]))
"""
LEAVE_A_CHILD = """
import os, sys, time
from pathlib import Path
from roadproof.runtime.files import hold_folder
with hold_folder(Path(sys.argv[1])):
    if os.fork() == 0:
        print("held", flush=True)
        time.sleep(float(sys.argv[2]))
    os._exit(0)
"""
linux = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")


def started(script: str, folder: Path, seconds: float) -> subprocess.Popen[str]:
    arguments = [sys.executable, "-c", script, str(folder), str(seconds)]
    holder = subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    assert holder.stdout.readline() == "held\n"
    return holder


@linux
def test_a_run_that_ends_soon_refuses_others_too(tmp_path: Path) -> None:
    """Others once waited up to five seconds for it, and then wrote into the same folder."""
    holder = started(HOLD, tmp_path, 2.0)
    before = time.monotonic()
    with pytest.raises(InputError, match="another run is writing"), hold_folder(tmp_path):
        pass
    assert time.monotonic() - before < 1.5
    assert holder.wait() == 0
    with hold_folder(tmp_path):
        pass


@linux
def test_processes_that_a_dead_run_leaves_are_waited_for(tmp_path: Path) -> None:
    holder = started(LEAVE_A_CHILD, tmp_path, 1.0)
    assert holder.wait() == 0
    with hold_folder(tmp_path):
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
    threading.Timer(0.3, os.close, (other,)).start()
    begin = time.monotonic()
    if (state, flags, pending) == ("S", 0, (0, 0)):
        with pytest.raises(InputError, match="another run is writing"), hold_folder(folder):
            pass
        assert time.monotonic() - begin < 0.3
    else:
        with hold_folder(folder):
            assert time.monotonic() - begin >= 0.25


@linux
@pytest.mark.parametrize("apart", [0.0, 0.01, 0.03, 0.05])
def test_two_evaluations_that_begin_together(apart: float, tmp_path: Path) -> None:
    made = rp.simulate(tmp_path / "made", recordings=2, seconds=30, seed=1, jobs=1).folder
    command = [sys.executable, "-m", "roadproof", "evaluate", str(made), "--out", str(tmp_path / "out")]
    command += ["--jobs", "1", "--no-pictures", "--quiet"]
    runs = []
    for _ in range(2):
        runs.append(subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))
        time.sleep(apart)
    said = [run.communicate() for run in runs]
    codes = [run.returncode for run in runs]
    assert sorted(codes) == [0, 3], said
    assert "another run is writing into this folder" in said[codes.index(3)][1]
    assert not [x for x in os.listdir(tmp_path / "out") if x.startswith(".")]
