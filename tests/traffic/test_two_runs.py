"""Two runs on one folder: the second one is refused, however short after the first it begins."""

import os
import subprocess
import sys
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
