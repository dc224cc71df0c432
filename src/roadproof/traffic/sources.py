"""Which recordings a path holds, in whatever format, and what tells that their files are the same."""

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

    def stamp(self) -> list[list[int]]:
        """Size and time of change (ns) of each file, [-1, -1] for one that is missing."""
        return [_stamp(path) for path in self.files]


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


def _stamp(path: Path) -> list[int]:
    try:
        status = path.stat()
    except OSError:
        return [-1, -1]
    return [status.st_size, status.st_mtime_ns]
