"""The interface of a format of recordings: how its files are found, read and named in messages."""

import hashlib
import re
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Protocol, TypeAlias

import numpy as np

from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.recording import BACKWARDS, Recording, backwards, with_notes
from roadproof.extensions.traffic.formats.table import ColumnTable
from roadproof.extensions.traffic.formats.windows import WindowedRecording, undivided
from roadproof.world.drive import Drive
from roadproof.world.road import Road

Files: TypeAlias = tuple[Path, ...]
TRACK_FILES = re.compile(r"(\d+)_(?:recordingMeta|tracksMeta|tracks)\.csv")
"""The names of the files of highD and exiD, with the name of the recording."""


@dataclass(frozen=True)
class Format:
    """A kind of files that recordings are in.

    ``find``: the recordings of this kind, by name, that a folder holds or that a file is of; for each all
    files that it is read from, that of its samples last. A recording of which files are missing is found,
    so that reading it is refused. ``read`` takes the file of its samples, and whether it is strict: then no
    vehicle is left out (reliable.py). It raises ``InputError``.
    ``rate_at``: where the files, {0} being the last, say the ``rate`` (1/s) and ``step`` (s) of samples.
    ``told``: the files in words. ``divide``: a recording that is too large to be read as a whole, in windows,
    None for others, strict or not; formats without it are always read as a whole. ``on_road``: the format for
    recordings on a road of a map, as ``maps.selection`` reads it, where they do not say their own.
    ``is_name``: whether a path names a recording of this kind, though perhaps no file.
    """

    name: str
    told: str
    find: Callable[[Path], dict[str, Files]]
    read: Callable[[Path, bool], Recording]
    rate_at: str
    divide: Callable[[Path, bool], WindowedRecording | None] | None = None
    on_road: "Callable[[str], Format] | None" = None
    is_name: Callable[[Path], bool] = Path.exists


class TraceFile(Protocol):
    """The samples of one trace. ``otherwise``: notes on what was left out, or taken otherwise than written;
    ``faults``: notes on contradictions; ``computed``: whether samples are worked out, and not measured."""

    @property
    def table(self) -> ColumnTable: ...

    @property
    def road(self) -> Road: ...

    @property
    def computed(self) -> bool: ...

    @property
    def faults(self) -> tuple[str, ...]: ...

    @property
    def otherwise(self) -> tuple[str, ...]: ...


class GivenDrive(Protocol):
    """A drive on a road up to its ``horizon`` (s), with a note on how exact it is."""

    @property
    def drive(self) -> Drive: ...

    @property
    def road(self) -> Road: ...

    @property
    def horizon(self) -> Fraction: ...

    @property
    def note(self) -> str: ...


ReadTrace: TypeAlias = Callable[[Path, bool], TraceFile]
"""Reads a file, strict or not. Raises ``InputError``."""
ReadDrive: TypeAlias = Callable[[Path], GivenDrive]
"""Reads a file. Raises ``InputError``."""


@dataclass(frozen=True)
class RecordingSource:
    """A recording that can be read; ``strict``: as a whole or not at all; ``road``: that was selected."""

    format: Format
    name: str
    files: Files
    strict: bool = False
    road: str | None = None

    def read(self) -> Recording:
        """Read and check it. Raises ``InputError``."""
        recording = self.format.read(self.files[-1], self.strict)
        remarks = backwards(
            recording.vehicle_id[np.unique(recording.row_vehicle[recording.v_lon < BACKWARDS])]
        )
        return with_notes(recording, [x for x in remarks if x not in recording.notes])

    def divided(self) -> WindowedRecording:
        """The recording in windows, one where it is small enough. Raises ``InputError``, reading them too."""
        divide = self.format.divide
        return (divide and divide(self.files[-1], self.strict)) or undivided(self.read())

    def digests(self) -> list[str]:
        """A digest of the content of each file, empty for one that cannot be read.

        That of the first one is also of the road, where one was selected.
        """
        first, *others = [file_digest(path) for path in self.files]
        if self.road is not None:
            first = hashlib.sha256(f"{first}{self.road}".encode()).hexdigest()
        return [first, *others]

    def place_of_rate(self, rate: Rate) -> str:
        """Return where the files say how many samples a second there are."""
        return self.format.rate_at.format(*reversed(self.files), rate=rate, step=float(1 / Fraction(rate)))


def with_suffix(path: Path, suffix: str) -> list[Path]:
    """The files of a folder that end in ``suffix``, in order, or the file itself where it does."""
    if path.is_dir():
        return sorted(x for x in path.glob(f"*{suffix}") if x.is_file())
    return [path] if path.is_file() and path.name.endswith(suffix) else []


def first_line(path: Path) -> str:
    """The first line of a text file, without quotes; empty where it cannot be read."""
    try:
        with path.open("rb") as file:
            line = file.readline(4096).decode("utf-8-sig", "replace").strip()
            return ",".join(x.strip() for x in line.partition("\r")[0].replace('"', "").split(","))
    except OSError:
        return ""


def beside(path: Path, ending: str) -> Files:
    """The file beside ``path`` that is called as it but for ``ending``, if there is one."""
    other = path.with_name(f"{path.stem}{ending}")
    return (other,) if other.is_file() else ()


def find_files(path: Path, suffix: str, ending: str) -> dict[str, Files]:
    """The files that end in ``suffix``, by name, each after that beside it with ``ending``."""
    return {x.stem: (*beside(x, ending), x) for x in with_suffix(path, suffix)}


def file_digest(path: Path) -> str:
    """The SHA-256 of a file, empty where it cannot be read."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""
