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
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

from roadproof.errors import InputError
from roadproof.runtime.files import write_whole

T = TypeVar("T")

SWITCH = "ROADPROOF_CACHE"
_OLD = 60 * 24 * 3600.0  # seconds
MOST_BYTES = 200_000_000
"""So much a folder of the cache holds."""


def private_folder(name: str) -> Path | None:
    """A folder of this user's cache, in which nobody else can write; None where there is none such."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    if os.environ.get(SWITCH) == "off" or not os.path.isabs(base):
        return None
    home = Path(base) / "roadproof" / name
    try:
        for folder in (home.parent, home):  # a mode is that of the last folder, others follow the umask
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError:
        return None
    return home if is_ours(home) and is_ours(home.parent) else None


@contextlib.contextmanager
def one_at_a_time(folder: Path) -> Iterator[None]:
    """Wait until no other process works in a folder of the cache; the system lets go of it with us."""
    with contextlib.ExitStack() as held:
        with contextlib.suppress(ImportError, OSError):  # where there are no locks, two may do the same work
            import fcntl

            handle = os.open(folder, os.O_RDONLY)
            held.callback(os.close, handle)
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield


def is_ours(path: Path) -> bool:
    """Whether a file or folder is no link, belongs to this user, and nobody else may write there."""
    try:
        found = path.lstat()
    except OSError:
        return False
    kind = stat.S_ISDIR(found.st_mode) or stat.S_ISREG(found.st_mode)
    return kind and found.st_uid == os.getuid() and not found.st_mode & 0o022


def remembered(name: str, made_of: bytes, make: Callable[[], T]) -> T:
    """What ``make`` makes of ``made_of`` and nothing else: taken from the cache, or made and put there.

    It must be something that can be pickled. ``name`` tells what it is.
    """
    key = f"{name}-{hashlib.sha256(made_of).hexdigest()[:32]}"
    with contextlib.suppress(Exception):  # whatever it is that cannot be read is made again
        data = kept_bytes("made", key, made_of)
        if data is not None:
            found: T = pickle.loads(data)
            return found
    made = make()
    keep_bytes("made", key, pickle.dumps(made, pickle.HIGHEST_PROTOCOL), made_of)
    make_room("made")
    return made


def kept_bytes(folder: str, name: str, made_of: bytes = b"") -> bytes | None:
    """What was kept under a name in a folder of the cache; None where it is not there as it was written."""
    home = _home(folder)
    if home is None or not is_ours(home / name):
        return None
    with contextlib.suppress(OSError):  # another run may remove it
        content = (home / name).read_bytes()
        digest, data = content[:32], content[32:]
        if digest == hashlib.sha256(name.encode() + made_of + data).digest():
            os.utime(home / name)
            return data
    return None


def keep_bytes(folder: str, name: str, data: bytes, made_of: bytes = b"") -> None:
    """Keep bytes under a name, made of ``made_of``."""
    home = _home(folder)
    if home is not None:
        with contextlib.suppress(InputError, OSError):
            write_whole(home / name, hashlib.sha256(name.encode() + made_of + data).digest() + data)


def make_room(folder: str) -> None:
    """Remove what was used so long ago that its version is hardly in use, and the oldest of too much."""
    total = 0
    for path, said in sorted(files(folder).items(), key=lambda x: -x[1].st_mtime):
        total += said.st_size
        if said.st_mtime < time.time() - _OLD or total > MOST_BYTES:
            with contextlib.suppress(OSError):
                path.unlink()


def files(folder: str) -> dict[Path, os.stat_result]:
    """The files of a folder of the cache, with what the system says of each."""
    home, found = _home(folder), {}
    for path in () if home is None else home.iterdir():
        with contextlib.suppress(OSError):  # another run may remove it
            found[path] = path.lstat()
    return found


def _home(folder: str) -> Path | None:
    return private_folder(folder) if hasattr(os, "getuid") else None
