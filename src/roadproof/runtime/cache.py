"""What takes long to make and never changes, kept for the next run in a folder where only this user writes.

Nothing rests on it: what is not there, or not as it was written, is made again. It is kept under a digest of
all that it is made of. ``ROADPROOF_CACHE=off`` keeps nothing.
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
from roadproof.runtime.files import write_whole

T = TypeVar("T")

SWITCH = "ROADPROOF_CACHE"
_OLD = 60 * 24 * 3600.0  # seconds


def private_folder(name: str) -> Path | None:
    """A folder of this user's cache, in which nobody else can write; None where there is none such."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    if os.environ.get(SWITCH) == "off" or not os.path.isabs(base):
        return None
    home = Path(base) / "roadproof" / name
    try:
        home.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError:
        return None
    return home if is_ours(home) and is_ours(home.parent) else None


def is_ours(path: Path) -> bool:
    """Whether a file or folder is no link, belongs to this user, and nobody else may write there."""
    try:
        found = path.lstat()
    except OSError:
        return False
    kind = stat.S_ISDIR(found.st_mode) or stat.S_ISREG(found.st_mode)
    return kind and found.st_uid == os.getuid() and not found.st_mode & 0o022


def _forget_old(folder: Path) -> None:
    """Remove what was written so long ago that its version is hardly in use."""
    with contextlib.suppress(OSError):
        for path in folder.iterdir():
            if path.stat().st_mtime < time.time() - _OLD:
                path.unlink()


def remembered(name: str, made_of: bytes, make: Callable[[], T]) -> T:
    """What ``make`` makes of ``made_of`` and nothing else: taken from the cache, or made and put there.

    It must be something that can be pickled. ``name`` tells what it is.
    """
    folder = private_folder("made") if hasattr(os, "getuid") else None
    if folder is None:
        return make()
    key = hashlib.sha256(made_of).hexdigest()
    path = folder / f"{name}-{key[:32]}"
    with contextlib.suppress(Exception):  # whatever it is that cannot be read is made again
        if is_ours(path):
            content = path.read_bytes()
            digest, data = content[:32], content[32:]
            if digest == hashlib.sha256(made_of + data).digest():
                found: T = pickle.loads(data)
                return found
    made = make()
    _forget_old(folder)
    data = pickle.dumps(made, pickle.HIGHEST_PROTOCOL)
    with contextlib.suppress(InputError, OSError):
        write_whole(path, hashlib.sha256(made_of + data).digest() + data)
    return made
