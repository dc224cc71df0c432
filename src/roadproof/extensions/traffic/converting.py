"""Recordings of any format, kept as Parquet."""

from collections.abc import Mapping
from contextlib import closing
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.converted import FORMAT, HEAD, SAMPLES, samples_in, write_converted
from roadproof.extensions.traffic.formats.large import is_large, write_large
from roadproof.extensions.traffic.formats.source import RecordingSource
from roadproof.extensions.traffic.formats.sources import CSV, PARQUET, find_sources
from roadproof.runtime import pool
from roadproof.runtime.files import lock_folder
from roadproof.runtime.pool import Progress
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Conversion:
    """``samples``: of each recording, how many it has; ``files``: what was written; ``sizes`` in bytes."""

    folder: Path
    samples: Mapping[str, int]
    files: tuple[Path, ...]
    sizes: tuple[int, int]

    def __str__(self) -> str:
        before, after = (size / 1e6 for size in self.sizes)
        return (
            f"{len(self.samples)} recordings with {sum(self.samples.values())} samples in {self.folder}: "
            f"{after:.1f} MB, before {before:.1f} MB; each was read again and is the same"
        )


def convert(
    path: str | Path,
    out: str | Path,
    jobs: int | None = None,
    progress: Progress | None = None,
    strict: bool = False,
    road: str | None = None,
) -> Conversion:
    """Write recordings of any format as Parquet, as they were read and checked, for quicker reading.

    Whatever reads recordings reads the folder ``out`` with the same answers. ``path``: a folder of recordings
    in one format, or the file of one. Raises ``InputError`` for the first that cannot be read; those that are
    done stay. ``strict``: reject a recording of which vehicles would be left out. ``road``: of a map,
    for recordings that name no lanes (such as inD).
    """
    sources, folder = find_sources(Path(path), strict, road), Path(out)
    if sources[0].format is FORMAT:
        raise InputError(f"recordings={path}: they are converted already")
    if folder.resolve() == (Path(path) if Path(path).is_dir() else Path(path).parent).resolve():
        raise InputError(f"--out {out} is where the recordings are: name another folder")
    with lock_folder(folder):
        working = pool.work(_Converter(folder), sources, jobs, None, progress, "recordings", fresh=True)
        with closing(pool.in_order(working)) as made:
            counts = list(made)
    files = tuple(folder / f"{source.name}{ending}" for source in sources for ending in (HEAD, SAMPLES))
    before = sum(file.stat().st_size for source in sources for file in source.files)
    after = sum(file.stat().st_size for file in files)
    samples = {source.name: count for source, count in zip(sources, counts, strict=True)}
    return Conversion(folder, samples, files, (before, after))


@dataclass(frozen=True)
class _Converter:
    folder: Path

    def __call__(self, source: RecordingSource) -> int:
        if source.format in (CSV, PARQUET) and source.files[-1].is_file() and is_large(source.files[-1]):
            digests = dict(zip((path.name for path in source.files), source.digests(), strict=True))
            name = source.format.name
            return samples_in(write_large(source.files[-1], self.folder, digests, name, source.strict))
        return len(write_converted(source, self.folder).s)
