"""Folders that one process makes and all processes of a run of tests read."""

import fcntl
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import rmtree

HOMES: list[Path] = []
"""The folder of this run, which all of its processes have (see conftest.py)."""


@contextmanager
def one_at_a_time(folder: Path) -> Iterator[None]:
    """Wait until no other process works in a folder."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def made_once(name: str, make: Callable[[Path], object]) -> Path:
    """The folder that ``make`` fills, in whichever process asks first. Nobody may change it."""
    folder = HOMES[-1] / name
    done = folder / "done"
    folder.mkdir(parents=True, exist_ok=True)
    with one_at_a_time(folder):
        if not done.exists():
            rmtree(folder / "made", ignore_errors=True)  # by a process that has ended
            (folder / "made").mkdir()
            make(folder / "made")
            done.touch()
    return folder / "made"
