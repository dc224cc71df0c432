"""Recordings in CSV and Parquet files with a row for each sample, with a road beside them."""

from pathlib import Path

from roadproof.recordings.formats.large import divide_large
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.formats.samples import CONVERTED, HEADER, ROAD_ENDING, read_recording
from roadproof.recordings.formats.source import TRACK_FILES, Files, Format, beside, first_line, with_suffix


def _is_header(line: str) -> bool:
    """Whether ``line`` may be the header of such a file, if one that has to be put right."""
    return {"time", "vehicle"} <= set(line.split(","))


def _find_csv(path: Path) -> dict[str, Files]:
    if path.is_dir():
        found = [x for x in with_suffix(path, ".csv") if _is_header(first_line(x))]
    else:
        found = [x for x in with_suffix(path, ".csv") if not TRACK_FILES.fullmatch(x.name)]
    return {x.stem: (*beside(x, ROAD_ENDING), x) for x in found}


def _find_parquet(path: Path) -> dict[str, Files]:
    found = (x for x in with_suffix(path, ".parquet") if not x.name.endswith(CONVERTED))
    return {x.stem: (*beside(x, ROAD_ENDING), x) for x in found}


def _read(files: Files) -> Recording:
    return read_recording(files[-1])


def _rate_at(files: Files, rate: int) -> str:
    return f"{files[-1]}, column time in steps of 1/{rate} s"


CSV = Format("CSV", f"NAME.csv with the header {','.join(HEADER)}", _find_csv, _read, _rate_at, divide_large)
PARQUET = Format(
    "Parquet", "NAME.parquet with the same columns", _find_parquet, _read, _rate_at, divide_large
)
