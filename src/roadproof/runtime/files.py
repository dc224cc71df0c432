"""Atomic writing of files (a reader never sees half of one), locks on folders, and limited reading."""

import errno
import json
import os
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from roadproof.errors import InputError


@contextmanager
def atomic_file(path: Path) -> Iterator[BinaryIO]:
    """Open a file to write bytes to; it appears under its name only when all is written.

    It is a hidden file until then, and is removed if anything fails. The folder must exist. A device such as
    /dev/null is written to directly; a link is followed. Raises ``InputError`` if the file cannot be written.
    """
    if path.is_symlink() and not _is_device(path):  # a link in /dev is a device, whatever its target
        path = path.resolve()
    try:
        if _is_device(path):
            with path.open("ab") as file:
                yield file
            return
        import tempfile  # here: most commands write nothing

        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                yield file
            os.chmod(temporary, 0o644)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise
    except OSError as error:
        raise cannot_write(path, error) from None


def _is_device(path: Path) -> bool:
    if path.is_dir() or not path.exists():
        return False
    return not path.is_file() or path.absolute().parts[1:2] in (("dev",), ("proc",))


_ADVICE = {
    errno.ENOENT: "name a folder that exists",
    errno.ENOTDIR: "name a folder that exists",
    errno.ENOSPC: "make room there, or name a folder on another disk",
    errno.EDQUOT: "make room there, or name a folder on another disk",
    errno.EFBIG: "raise the limit on the size of files, or name a folder on another disk",
}


def cannot_write(path: Path, error: OSError) -> InputError:
    """Return the error for a file or folder that cannot be written: the system's message and a remedy."""
    message = (error.strerror or str(error)).replace("No space left", "no space left")
    advice = _ADVICE.get(error.errno or 0, "name another folder")
    return InputError(f"cannot write {path}: {message}; {advice}")


def make_folder(folder: Path) -> None:
    """Make a folder and its parents if missing. Raises ``InputError``, also for a read-only folder."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot write into {folder}: {error.strerror}; name another folder") from None
    if not os.access(folder, os.W_OK):
        raise InputError(f"cannot write into {folder}: no permission; name another folder")


RELEASE_SECONDS = 5.0
"""Seconds that the processes of a killed run get to release its folder."""


@contextmanager
def lock_folder(folder: Path | None, shared: bool = False) -> Iterator[None]:
    """Lock a folder, which is made if missing, against other runs; the lock ends with this process.

    ``shared``: allow runs that also lock it as shared. Raises ``InputError`` if another process holds the
    lock: at once if that process lives, after RELEASE_SECONDS if only its children are left. Does nothing if
    the system or the disk has no such locks, or ``folder`` is None.
    """
    if folder is None:
        yield
        return
    make_folder(folder)
    try:
        import fcntl

        handle = os.open(folder, os.O_RDONLY)
    except (ImportError, OSError):
        yield
        return
    latest = time.monotonic() + RELEASE_SECONDS
    try:
        while True:
            try:
                fcntl.flock(handle, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                if time.monotonic() > latest or _holder_lives(handle):
                    raise
                time.sleep(0.05)
    except BlockingIOError:
        os.close(handle)
        raise InputError(
            f"{folder}: another run is writing into this folder; wait until it is done, or name another"
        ) from None
    except OSError:
        pass
    try:
        yield
    finally:
        os.close(handle)


_PROC = Path("/proc")
_KILLED = 1 << (9 - 1)  # SIGKILL in the masks of pending signals
_EXITING = 0x4  # PF_EXITING of Linux


def _holder_lives(handle: int) -> bool:
    """Return whether a process that has locked the file of ``handle`` lives; False if that is not known.

    Its children inherit the lock, and keep it for a moment when it is gone.
    """
    try:
        inode = os.fstat(handle).st_ino
        rows = [line.split() for line in (_PROC / "locks").read_text().splitlines()]
        holders = [row[4] for row in rows if row[1] == "FLOCK" and row[5].endswith(f":{inode}")]
    except (OSError, IndexError):
        return False
    return any(map(_is_alive, holders))


def _is_alive(pid: str) -> bool:
    """Return whether a process lives: it is neither gone, nor a zombie, nor killed, nor exiting."""
    try:
        state, *numbers = (_PROC / pid / "stat").read_text().rpartition(")")[2].split()
        lines = (_PROC / pid / "status").read_text().splitlines()
    except OSError:
        return False
    pending = [int(line.split()[1], 16) for line in lines if line.startswith(("SigPnd:", "ShdPnd:"))]
    return state not in "ZX" and not int(numbers[5]) & _EXITING and not any(x & _KILLED for x in pending)


def write_atomic(path: Path, content: bytes) -> None:
    """Write a file atomically, and make its folder if it is missing. Raises ``InputError``."""
    make_folder(path.parent)
    with atomic_file(path) as file:
        file.write(content)


def write_json(path: Path, data: Mapping[str, object]) -> None:
    """Write plain data as a JSON file atomically. Raises ``InputError``."""
    write_atomic(path, json_bytes(data))


def json_bytes(data: Mapping[str, object]) -> bytes:
    """Return plain data as the bytes of a JSON file."""
    return utf8(json.dumps(data, indent=2, ensure_ascii=False) + "\n")


def utf8(text: str) -> bytes:
    """Encode a text as UTF-8; bytes of a file name that are not UTF-8 become escapes that JSON reads back."""
    return text.encode("utf-8", "backslashreplace")


def refuse_name(path: Path) -> None:
    """Raise ``InputError`` for a path that is no UTF-8 text: neither evidence nor polars can name it."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        raise InputError(f"{path}: this path is not UTF-8 text; rename the file or its folder") from None


def read_limited(path: Path, most: int, advice: str) -> bytes:
    """Return the bytes of a file of at most ``most`` bytes.

    Raises ``InputError`` if it cannot be read, and with ``advice`` if it is larger.
    """
    try:
        with path.open("rb") as file:
            data = file.read(most + 1)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    if len(data) > most:
        raise InputError(f"{path} is larger than {most} bytes: {advice}")
    return data


def read_text(path: Path, most: int, advice: str) -> str:
    """Return a file of at most ``most`` bytes as UTF-8 text; see ``read_limited``. Raises ``InputError``."""
    return as_text(path, read_limited(path, most, advice))


def as_text(path: Path, data: bytes) -> str:
    """Decode the bytes of a file as UTF-8. Raises ``InputError`` that names the format of other files."""
    from roadproof.runtime.file_kind import other_encoding, other_format  # here: it has a table of formats

    other = other_format(data)
    if other is not None:
        raise InputError(f"{path}: the file {other}")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        other = other_encoding(data)
        if other is not None:
            raise InputError(f"{path}: the file {other}") from None
        strange = f"byte {error.start} is 0x{data[error.start]:02x}"
        raise InputError(f"{path} is not UTF-8 text: {strange}; save it as UTF-8") from None
