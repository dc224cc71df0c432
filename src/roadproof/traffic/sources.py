"""Which recordings a path holds, in whatever format, and what tells that their files are the same."""

import hashlib
from dataclasses import dataclass
from pathlib import Path

from roadproof.errors import InputError
from roadproof.traffic.commonroad import read_commonroad
from roadproof.traffic.highd import find_recordings, read_highd
from roadproof.traffic.recording import Recording

HIGHD_FILES = ("recordingMeta", "tracksMeta", "tracks")


@dataclass(frozen=True)
class RecordingSource:
    """A recording that can be read: ``files`` are all that it is read from."""

    name: str
    files: tuple[Path, ...]

    def read(self) -> Recording:
        """Read and check it. Raises ``InputError``."""
        if self.files[0].suffix == ".xml":
            return read_commonroad(self.files[0])
        return read_highd(self.files[0].parent, self.name)

    def digests(self) -> list[str]:
        """A digest of the content of each file, empty for one that cannot be read."""
        return [_digest(path) for path in self.files]

    def place_of_rate(self, rate: int) -> str:
        """Where the files say how many samples a second there are."""
        if self.files[0].suffix == ".xml":
            return f"{self.files[0]}: timeStepSize={1 / rate:g}"
        return f"{self.files[0]}, row 2, column frameRate={rate}"


def find_sources(path: Path) -> tuple[RecordingSource, ...]:
    """The recordings of a folder of highD files or CommonRoad files, or of one CommonRoad file."""
    if path.is_file() and path.suffix == ".xml":
        return (RecordingSource(path.stem, (path,)),)
    found = sorted(path.glob("*.xml")) if path.is_dir() else []
    if found:
        if any(path.glob("*_tracks.csv")):
            raise InputError(
                f"recordings={path}: highD and CommonRoad files in one folder; put them into two"
            )
        return tuple(RecordingSource(x.stem, (x,)) for x in found)
    names = find_recordings(path)
    return tuple(
        RecordingSource(name, tuple(path / f"{name}_{x}.csv" for x in HIGHD_FILES)) for name in names
    )


def _digest(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""
