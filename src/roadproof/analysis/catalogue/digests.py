"""The digest of a test: it tells whether its files have changed since they were judged."""

import hashlib
from pathlib import Path

from roadproof.errors import InputError
from roadproof.recordings.evaluate.one_trace import is_pair
from roadproof.recordings.formats.samples import ROAD_ENDING
from roadproof.recordings.formats.source import beside
from roadproof.recordings.formats.sources import find_source


def digest_of(place: str) -> str:
    """SHA-256 of the file of a concrete test, in hexadecimal digits; empty where a file cannot be read.

    Of several files, such as those of a recording or samples with their road, it is that of the digests of
    all, one after the other.
    """
    digests = [_sha256(path) for path in files_of(place)]
    if not digests or not all(digests):
        return ""
    return digests[0] if len(digests) == 1 else hashlib.sha256("".join(digests).encode()).hexdigest()


def files_of(place: str) -> tuple[Path, ...]:
    """The files that a concrete test is read from; none where there is no recording of that name."""
    if is_pair(place):
        try:
            return find_source(Path(place.rpartition(":")[0])).files
        except InputError:
            return ()
    path = Path(place)
    return (path, *(beside(path, ROAD_ENDING) if path.suffix in (".csv", ".parquet") else ()))


def _sha256(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""
