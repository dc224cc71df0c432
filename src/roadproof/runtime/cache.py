"""A cache on disk for values that take long to compute, in a folder where only this user may write.

Each entry is stored under a digest of everything that it depends on. Entries that are missing or damaged are
computed again. ``ROADPROOF_CACHE=off`` disables the cache.
"""

import contextlib
import hashlib
import os
import pickle
import stat
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from roadproof.errors import InputError
from roadproof.runtime.files import write_atomic

T = TypeVar("T")

SWITCH = "ROADPROOF_CACHE"
_OLD = 60 * 24 * 3600.0  # seconds
MOST_BYTES = 200_000_000
"""The largest size of a folder of the cache."""


def private_folder(name: str) -> Path | None:
    """Return a folder of this user's cache in which nobody else can write; None if there cannot be one."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    if os.environ.get(SWITCH) == "off" or not os.path.isabs(base):
        return None
    home = Path(base) / "roadproof" / name
    try:
        for folder in (home.parent, home):  # mkdir sets the mode of the last folder only
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError:
        return None
    return home if is_private(home) and is_private(home.parent) else None


def is_private(path: Path) -> bool:
    """Return whether a path is no link, belongs to this user, and is writable by nobody else."""
    try:
        status = path.lstat()
    except OSError:
        return False
    kind = stat.S_ISDIR(status.st_mode) or stat.S_ISREG(status.st_mode)
    return kind and status.st_uid == os.getuid() and not status.st_mode & 0o022


def cached(name: str, made_of: bytes, make: Callable[[], T]) -> T:
    """Return ``make()``, from the cache if it is there.

    ``make`` must depend on ``made_of`` alone, and its result must be picklable. ``name``: the first part of
    the file's name.
    """
    key = f"{name}-{hashlib.sha256(made_of).hexdigest()[:32]}"
    with contextlib.suppress(Exception):  # an entry that cannot be read is computed again
        data = load_bytes("made", key, made_of)
        if data is not None:
            value: T = pickle.loads(data)
            return value
    made = make()
    store_bytes("made", key, pickle.dumps(made, pickle.HIGHEST_PROTOCOL), made_of)
    evict_old("made")
    return made


def load_bytes(folder: str, name: str, made_of: bytes = b"") -> bytes | None:
    """Return what was stored under a name; None if it is missing or damaged, or made of something else."""
    home = _home(folder)
    if home is None or not is_private(home / name):
        return None
    with contextlib.suppress(OSError):  # another run may remove it
        content = (home / name).read_bytes()
        digest, data = content[:32], content[32:]
        if digest == hashlib.sha256(name.encode() + made_of + data).digest():
            os.utime(home / name)
            return data
    return None


def store_bytes(folder: str, name: str, data: bytes, made_of: bytes = b"") -> None:
    """Store bytes under a name; ``made_of``: everything that they depend on."""
    home = _home(folder)
    if home is not None:
        with contextlib.suppress(InputError, OSError):
            write_atomic(home / name, hashlib.sha256(name.encode() + made_of + data).digest() + data)


def evict_old(folder: str) -> None:
    """Remove entries that were not used for 60 days, and the oldest beyond ``MOST_BYTES``."""
    total = 0
    for path, status in sorted(files(folder).items(), key=lambda x: -x[1].st_mtime):
        total += status.st_size
        if status.st_mtime < time.time() - _OLD or total > MOST_BYTES:
            with contextlib.suppress(OSError):
                path.unlink()


def files(folder: str) -> dict[Path, os.stat_result]:
    """Return the files of a folder of the cache with their status."""
    home, statuses = _home(folder), {}
    for path in () if home is None else home.iterdir():
        with contextlib.suppress(OSError):  # another run may remove it
            statuses[path] = path.lstat()
    return statuses


def _home(folder: str) -> Path | None:
    return private_folder(folder) if hasattr(os, "getuid") else None
