"""Files that appear whole or not at all: a reader never sees half of one; and reading with a limit."""

import errno
import json
import os
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from roadproof.errors import InputError
from roadproof.runtime.file_kind import other_encoding, other_format


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """A file to write bytes to, by way of a hidden one beside it, which is gone if anything fails.

    The folder must exist. What is no file, such as /dev/null, is written to as it stands; a link is
    followed. Raises ``InputError`` where the file cannot be written.
    """
    if path.is_symlink() and not _is_no_file(path):  # those of /dev are no files, wherever they lead
        path = path.resolve()
    try:
        if _is_no_file(path):
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


def _is_no_file(path: Path) -> bool:
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
    """The error for a file or folder that cannot be written: what the system says, and what helps then."""
    told = (error.strerror or str(error)).replace("No space left", "no space left")
    advice = _ADVICE.get(error.errno or 0, "name another folder")
    return InputError(f"cannot write {path}: {told}; {advice}")


def make_folder(folder: Path) -> None:
    """Make a folder, and those above it, where there is none. Raises ``InputError``, also if read-only."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot write into {folder}: {error.strerror}; name another folder") from None
    if not os.access(folder, os.W_OK):
        raise InputError(f"cannot write into {folder}: no permission; name another folder")


LETTING_GO = 5.0
"""Seconds that the processes of a run which was ended from outside are given to let go of its folder."""


@contextmanager
def hold_folder(folder: Path | None, shared: bool = False) -> Iterator[None]:
    """Keep other runs out of a folder, which is made where there is none; the system lets go of it with us.

    ``shared``: but not runs that share it with this one. Raises ``InputError`` where another process holds
    it: at once where that process lives, and after LETTING_GO where it is gone and others that it began are
    still there. Nothing is kept out where the system or the disk knows no such locks, or where there is no
    folder.
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
    latest = time.monotonic() + LETTING_GO
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
    """Whether a process that has locked a file, ours is ``handle``, lives; False where nothing tells.

    Processes that it began have the lock too, and keep it for a moment when it is gone.
    """
    try:
        inode = os.fstat(handle).st_ino
        rows = [line.split() for line in (_PROC / "locks").read_text().splitlines()]
        holders = [row[4] for row in rows if row[1] == "FLOCK" and row[5].endswith(f":{inode}")]
    except (OSError, IndexError):
        return False
    return any(map(_lives, holders))


def _lives(pid: str) -> bool:
    """False for a process that is gone, or about to be: a zombie, killed, or exiting."""
    try:
        state, *numbers = (_PROC / pid / "stat").read_text().rpartition(")")[2].split()
        lines = (_PROC / pid / "status").read_text().splitlines()
    except OSError:
        return False
    pending = [int(line.split()[1], 16) for line in lines if line.startswith(("SigPnd:", "ShdPnd:"))]
    return state not in "ZX" and not int(numbers[5]) & _EXITING and not any(x & _KILLED for x in pending)


def write_whole(path: Path, content: bytes) -> None:
    """Write a file, and make its folder where there is none. Raises ``InputError``."""
    make_folder(path.parent)
    with whole_file(path) as file:
        file.write(content)


def write_json(path: Path, data: Mapping[str, object]) -> None:
    """Write plain data as a JSON file, as ``write_whole``. Raises ``InputError``."""
    write_whole(path, json_bytes(data))


def json_bytes(data: Mapping[str, object]) -> bytes:
    """Plain data as the bytes of a JSON file."""
    return utf8(json.dumps(data, indent=2, ensure_ascii=False) + "\n")


def utf8(text: str) -> bytes:
    """A text in UTF-8. Bytes of a file's name that are not UTF-8 become escapes, which JSON reads again."""
    return text.encode("utf-8", "backslashreplace")


def refuse_name(path: Path) -> None:
    """Raises ``InputError`` for a path that is no text: evidence may not name it, and polars takes none."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        raise InputError(f"{path}: this path is not UTF-8 text; rename the file or its folder") from None


def read_limited(path: Path, most: int, advice: str) -> bytes:
    """The bytes of a file of at most ``most``. Raises ``InputError``, with ``advice`` where it is larger."""
    try:
        with path.open("rb") as file:
            data = file.read(most + 1)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    if len(data) > most:
        raise InputError(f"{path} is larger than {most} bytes: {advice}")
    return data


def read_text(path: Path, most: int, advice: str) -> str:
    """As ``read_limited``, a text in UTF-8. Raises ``InputError`` that names files of other kinds."""
    return as_text(path, read_limited(path, most, advice))


def as_text(path: Path, data: bytes) -> str:
    """The text in UTF-8 that a file has. Raises ``InputError`` that names files of other kinds."""
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
