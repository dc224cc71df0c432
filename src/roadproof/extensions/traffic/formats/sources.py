"""Finds the recordings of a path. Extensions add formats to those of this folder."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

from roadproof.errors import InputError, UsageError
from roadproof.extension import entries, imported
from roadproof.extensions.maps.selection import is_map, read_selection
from roadproof.extensions.traffic.formats import converted, exid, highd, ind, ngsim, samples
from roadproof.extensions.traffic.formats.large import divide_large
from roadproof.extensions.traffic.formats.source import (
    TRACK_FILES,
    Files,
    Format,
    RecordingSource,
    find_files,
    first_line,
)


def has_numbers(path: Path) -> bool:
    """Return whether a CSV file is of a recording in a format whose vehicles have numbers, by name or
    content.
    """
    return TRACK_FILES.fullmatch(path.name) is not None or ngsim.is_ngsim(path)


def _find_csv(path: Path) -> dict[str, Files]:
    """Return the files of a folder whose header is that of samples, or may be meant to be."""
    files = find_files(path, ".csv", samples.ROAD_ENDING)
    if path.is_dir():
        needed = {"time", "vehicle"}
        return {x: y for x, y in files.items() if needed <= set(first_line(y[-1]).split(","))}
    return {} if has_numbers(path) else files


def _find_parquet(path: Path) -> dict[str, Files]:
    files = find_files(path, ".parquet", samples.ROAD_ENDING)
    return {x: y for x, y in files.items() if not y[-1].name.endswith(samples.CONVERTED)}


def _of_samples(name: str, description: str, find: Callable[[Path], dict[str, Files]]) -> Format:
    """A format of samples, on the road beside them or on one that is named: a model or a stretch of a map."""

    def on(road: str) -> Format:
        read, divide = partial(samples.read_recording, road=road), partial(divide_large, road=road)
        return replace(made, read=read, divide=divide)

    rate_at = "{0}, column time in steps of 1/{rate} s"
    made = Format(name, description, find, samples.read_recording, rate_at, divide_large, on)
    return made


CSV = _of_samples("CSV", f"NAME.csv with the header {','.join(samples.HEADER)}", _find_csv)
PARQUET = _of_samples("Parquet", "NAME.parquet with the same columns", _find_parquet)
_MEASURED = (highd.FORMAT, exid.FORMAT, ind.FORMAT, ngsim.FORMAT)
_TABLES = (CSV, PARQUET, converted.FORMAT)


@cache
def formats() -> tuple[Format, ...]:
    """All formats of recordings, with those that extensions add."""
    return (*_MEASURED, *(imported("formats", name) for name in entries("formats")), *_TABLES)


def find_sources(path: Path, strict: bool = False, road: str | None = None) -> tuple[RecordingSource, ...]:
    """The recordings of a folder, or the one that a file is of. Raises ``InputError``.

    ``strict``: a recording is read as a whole or not at all. ``road``: for recordings that do not say theirs;
    ``UsageError`` for others.
    """
    if not any(x.is_name(path) for x in formats()):
        raise InputError(f"recordings={path}: not a folder and not a file; check the path")
    by_format = {x: files_by_name for x in formats() if (files_by_name := x.find(path))}
    if not by_format:
        descriptions = "; ".join(f"{x.name}: {x.told}" for x in formats())
        what = "no recording in it" if path.is_dir() else "no recording"
        raise InputError(f"recordings={path}: {what}; recordings are {descriptions}")
    if len(by_format) > 1:
        names = " and ".join(x.name for x in by_format)
        raise InputError(
            f"recordings={path}: {names} files in one folder; put them into folders of their own"
        )
    ((chosen, files_by_name),) = by_format.items()
    if road is not None:
        if chosen.on_road is None:
            raise UsageError(f"road {road}: {path} has the road of its recording; omit it")
        if is_map(road):
            read_selection(road)
        chosen = chosen.on_road(road)
        files_by_name = chosen.find(path)
    return tuple(RecordingSource(chosen, name, files, strict, road) for name, files in files_by_name.items())


def find_source(path: Path, strict: bool = False, road: str | None = None) -> RecordingSource:
    """The only recording of a path, on a ``road`` as for ``find_sources``. Raises ``InputError``."""
    sources = find_sources(path, strict, road)
    if len(sources) > 1:
        names = ", ".join(str(source.files[-1].name) for source in sources[:3])
        raise InputError(f"{path}: {len(sources)} recordings; name the file of one, such as {names}")
    return sources[0]


def copies_among(sources: Sequence[RecordingSource], digests: Mapping[str, Sequence[str]]) -> dict[str, str]:
    """The recordings whose samples are those of an earlier one: evaluated, they would count twice."""
    first: dict[str, RecordingSource] = {}
    copies = {}
    for source in sources:
        samples = digests[source.name][-1]
        if samples and samples in first:
            other = first[samples].files[-1]
            copies[source.name] = f"{source.files[-1]}: the same content as {other}; remove one of the two"
        first.setdefault(samples, source)
    return copies
