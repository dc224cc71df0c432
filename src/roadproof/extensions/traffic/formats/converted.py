"""Recordings as they were understood, in Parquet: read and checked once, the same in every later run.

NAME.recording.json says what is said once: lanes, vehicles, notes, the version that read the recording, a
digest of NAME.samples.parquet, which has a row a sample, and a digest of itself. Another version may
understand the files that they were made of otherwise, and refuses them. A digest can be made anew, so
whoever reads repeats the checks too (``believable``).
"""

import hashlib
import io
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from roadproof.errors import InputError
from roadproof.evidence.codec import write
from roadproof.extensions.traffic.formats import windows
from roadproof.extensions.traffic.formats.believable import PlausibilityChecks
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.content import require_unchanged, stamp_of
from roadproof.extensions.traffic.formats.recording import (
    BACKWARDS,
    Integers,
    Lane,
    Recording,
    Slack,
    backwards,
    offsets,
    with_notes,
    zones_in,
)
from roadproof.extensions.traffic.formats.samples import CONVERTED
from roadproof.extensions.traffic.formats.source import Files, Format, RecordingSource, with_suffix
from roadproof.extensions.traffic.formats.table import Column, Frame, concatenated, polars_module
from roadproof.extensions.traffic.formats.windows import TimeWindow, WindowedRecording, divide, undivided
from roadproof.runtime.files import read_limited, refuse_name, write_atomic, write_json
from roadproof.runtime.version import VERSION
from roadproof.world.road import Lanelet
from roadproof.world.signals import RECORDED

SCHEMA = "roadproof/recording/3"
HEAD, SAMPLES = ".recording.json", CONVERTED
_UNFIT = (ValueError, KeyError, TypeError, AttributeError, RecursionError)
_NEAR = 100_000  # rows between those of two vehicles that are read with them
_LARGEST_HEAD = 200_000_000  # bytes; two thousand vehicles take 0.3 MB
Metadata: TypeAlias = Mapping[str, Any]
"""What NAME.recording.json says."""
_OF_VEHICLES: Mapping[str, type[Any]] = {
    "vehicle_id": np.int64,
    "direction": np.int64,
    "kind": np.str_,
    "length": np.float64,
    "width": np.float64,
    "first_frame": np.int64,
    "label": np.str_,
}
_OF_SAMPLES: Mapping[str, type[Any]] = {
    **dict.fromkeys(RECORDED, np.float64),
    "occupancy": np.uint32,
    "lane": np.int64,
    "zones": np.uint32,
    "moments": np.int64,
}
_SLACK = tuple(x.name for x in fields(Slack))


def write_converted(source: RecordingSource, folder: Path) -> Recording:
    """Read a recording and write it, each file whole; what is there then is read again and compared.

    Raises ``InputError`` where it cannot be read or written, ``RuntimeError`` where it does not come back.
    """
    digests = dict(zip((path.name for path in source.files), source.digests(), strict=True))
    recording = source.read()
    samples = io.BytesIO()
    frame_of_samples(recording).write_parquet(samples, compression="zstd", statistics=False)
    content = samples.getvalue()
    head, table = folder / f"{source.name}{HEAD}", folder / f"{source.name}{SAMPLES}"
    head.unlink(missing_ok=True)  # it is there when the samples are
    write_atomic(table, content)
    digest = hashlib.sha256(content).hexdigest()
    write_json(head, full_metadata(recording, source.format.name, digests, len(recording.s), digest))
    if not same_recording(read_converted(head), recording):
        raise RuntimeError(f"recording {source.name} does not come back from {head}")
    return recording


def full_metadata(
    recording: Recording, form: str, digests: Mapping[str, str], rows: int, digest: str
) -> Metadata:
    """Return the content of NAME.recording.json for ``rows`` samples in a file with this ``digest``.

    ``digests``: of the files of the format called ``form`` that it was made of.
    """
    contents = {
        "schema": SCHEMA,
        "roadproof": VERSION,
        "made_of": {"format": form, "sha256": dict(digests)},
        "samples": {"rows": rows, "sha256": digest},
        **_metadata_of(recording),
    }
    return {**contents, "sha256": digest_of(contents)}


def digest_of(metadata: Metadata) -> str:
    """The digest of what NAME.recording.json says beside its digest."""
    plain = {name: value for name, value in metadata.items() if name != "sha256"}
    return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest()


def frame_of_samples(recording: Recording) -> Frame:
    """All that there is an entry a sample of."""
    pl = polars_module()
    frame: Frame = pl.DataFrame({name: pl.Series(name, x) for name, x in _samples(recording).items()})
    return frame


def read_converted(path: Path, strict: bool = True) -> Recording:
    """The recording of NAME.recording.json, or of the samples beside it. Raises ``InputError``.

    ``strict`` changes nothing: what is left out was left out when it was converted.
    """
    head = _head_path(path)
    with _convert_again_on_error(head):
        return _read_checked(head, _read_metadata(head))


def _read_checked(head: Path, metadata: Metadata) -> Recording:
    """Return the recording of this metadata, checked again. Raises ``InputError``."""
    recording = _recording(
        metadata, _read_samples(_table_of(head), metadata["samples"]["sha256"], _rows(metadata))
    )
    checks = PlausibilityChecks(head, recording.rate, recording.lanes)
    checks.add(recording)
    return with_notes(recording, checks.notes(recording.notes))


def samples_in(head: Path) -> int:
    """Return how many samples a converted recording has. Raises ``InputError``."""
    with _convert_again_on_error(head):
        return _rows(_read_metadata(head))


def divide_converted(path: Path, checked: bool = False) -> WindowedRecording | None:
    """The recording of NAME.recording.json in windows of time, None where it is small. Raises ``InputError``.

    Each is read from the rows of its vehicles. Raises ``InputError`` where the file changes meanwhile.
    ``checked``: this run has written the files and need not repeat the checks.
    """
    head = _head_path(path)
    with _convert_again_on_error(head):
        metadata, table = _read_metadata(head), _table_of(head)
        if _rows(metadata) <= windows.MOST_SAMPLES:
            return None
        stamp = stamp_of(table)
        with table.open("rb") as file:
            _require_digest(
                table, hashlib.file_digest(file, "sha256").hexdigest(), metadata["samples"]["sha256"]
            )
        counts, first_frame = np.array(metadata["counts"]), np.array(metadata["vehicles"]["first_frame"])
        if counts.sum() != _rows(metadata) or counts.shape != first_frame.shape or counts.min() < 1:
            raise ValueError("vehicles and samples do not fit")
        more = () if checked else _checked_in_parts(head, metadata, offsets(counts))
        ids = np.array(metadata["vehicles"]["vehicle_id"])[_backwards_in(table, offsets(counts))]
        more = (*more, *(x for x in backwards(ids) if x not in metadata["notes"]))
        zones = polars_module().scan_parquet(table).select("zones").unique().collect()["zones"].to_list()

    def read() -> Iterator[TimeWindow]:
        start = offsets(counts)
        for there, new in divide(first_frame, first_frame + counts - 1, windows.MOST_SAMPLES):
            with _convert_again_on_error(head):
                vehicles = np.flatnonzero(there)
                recording = _recording(_of_vehicles(metadata, vehicles), _read_rows(table, start, vehicles))
                require_unchanged(table, stamp)
            yield TimeWindow(with_notes(recording, more), new[vehicles])

    return WindowedRecording(_rate(metadata), zones_in(zones), read)


def _backwards_in(table: Path, start: Integers) -> Integers:
    """Return which vehicles drive backwards; of all rows only those are read in which one does."""
    pl = polars_module()
    rows = pl.scan_parquet(table, row_index_name="row").filter(pl.col("v_lon") < BACKWARDS).select("row")
    vehicles: Integers = np.unique(np.searchsorted(start, rows.collect()["row"].to_numpy(), "right") - 1)
    return vehicles


def _checked_in_parts(head: Path, metadata: Metadata, start: Integers) -> tuple[str, ...]:
    """The notes that the checks of the whole add, some vehicles at a time. Raises ``InputError``."""
    checks: PlausibilityChecks | None = None
    group = start[:-1] // windows.MOST_SAMPLES
    for number in np.unique(group):
        vehicles = np.flatnonzero(group == number)
        part = _recording(_of_vehicles(metadata, vehicles), _read_rows(_table_of(head), start, vehicles))
        checks = checks or PlausibilityChecks(head, part.rate, part.lanes)
        checks.add(part)
    return () if checks is None else checks.notes(metadata["notes"])


def _of_vehicles(metadata: Metadata, vehicles: Integers) -> Metadata:
    """Return the metadata of some of the vehicles."""
    chosen = vehicles.tolist()
    counts = [metadata["counts"][v] for v in chosen]
    of = {name: [x[v] for v in chosen] if x else x for name, x in metadata["vehicles"].items()}
    return {**metadata, "counts": counts, "vehicles": of, "samples": {"rows": sum(counts)}}


def _read_rows(table: Path, start: Integers, vehicles: Integers) -> dict[str, Column]:
    """The samples of some vehicles, in order; those that lie near each other are read at once."""
    refuse_name(table)
    pl = polars_module()
    begin, end = start[vehicles], start[vehicles + 1]
    apart = np.flatnonzero(begin[1:] - end[:-1] > _NEAR) + 1
    parts = []
    for group in np.split(np.arange(len(vehicles)), apart):
        low, high = int(begin[group[0]]), int(end[group[-1]])
        frame = pl.scan_parquet(table).slice(low, high - low).collect()
        selected = np.zeros(high - low + 1, np.int64)
        np.add.at(selected, begin[group] - low, 1)
        np.add.at(selected, end[group] - low, -1)
        parts.append(frame.filter(pl.Series(np.cumsum(selected)[:-1] > 0)))
    whole = pl.concat(parts)
    return {name: whole[name].to_numpy() for name in whole.columns}


@contextmanager
def _convert_again_on_error(head: Path) -> Iterator[None]:
    """Raise ``InputError`` where a file is not what ``convert`` writes."""
    try:
        yield
    except (*_UNFIT, polars_module().exceptions.PolarsError) as error:
        message = f"{type(error).__name__}: {error}"[:120]
        raise InputError(f"{head}: it is not what convert writes ({message}); convert again") from None
    except OSError as error:
        message = f"{_table_of(head)}: the file cannot be read ({error.strerror})"
        raise InputError(f"{message}; convert again") from None


def _table_of(head: Path) -> Path:
    return head.with_name(f"{head.name.removesuffix(HEAD)}{SAMPLES}")


def _head_path(path: Path) -> Path:
    """The head of a table; another path stays as it is."""
    is_table = path.name.endswith(SAMPLES)
    return path.with_name(f"{path.name.removesuffix(SAMPLES)}{HEAD}") if is_table else path


def _rate(metadata: Metadata) -> Rate:
    rate = Fraction(metadata["rate"])
    return int(rate) if rate.denominator == 1 else rate


def _rows(metadata: Metadata) -> int:
    return int(metadata["samples"]["rows"])


def _read_metadata(head: Path) -> Metadata:
    metadata: Metadata = json.loads(read_limited(head, _LARGEST_HEAD, "it is none of ours"))
    if metadata["schema"] != SCHEMA:
        raise InputError(f"{head}: schema={metadata['schema']!r}, but must be {SCHEMA!r}")
    if metadata["roadproof"] != VERSION:
        raise InputError(
            f"{head}: it was converted by version {str(metadata['roadproof'])[:40]}, and this is "
            f"{VERSION}, which may read recordings otherwise; convert them again"
        )
    if metadata["sha256"] != digest_of(metadata):
        raise InputError(f"{head}: its content is not what convert wrote (sha256 differs); convert again")
    if metadata["name"] != head.name.removesuffix(HEAD):
        raise InputError(
            f"{head}: it is of recording {str(metadata['name'])[:40]!r}; give the file that name"
        )
    return metadata


def same_recording(one: Recording, other: Recording) -> bool:
    """Return whether two recordings say the same, NaN in columns of users' own included."""
    ours, theirs = frame_of_samples(one), frame_of_samples(other)
    same = len(one.moments) == len(other.moments) and _metadata_of(one) == _metadata_of(other)
    return same and ours.schema == theirs.schema and ours.equals(theirs)


def _samples(recording: Recording) -> dict[str, Column]:
    """All that there is an entry a sample of, by the name of its column."""
    rows = len(recording.s)
    columns = {name: getattr(recording, name) for name in _OF_SAMPLES}
    columns = {name: values for name, values in columns.items() if len(values) == rows}
    if recording.slack is not None:
        columns |= {f"slack:{name}": getattr(recording.slack, name) for name in _SLACK}
    columns |= {f"inside:{k}": recording.inside[:, k] for k in range(recording.inside.shape[1])}
    return columns | {f"own:{name}": values for name, values in recording.custom_signals.items()}


def _metadata_of(recording: Recording) -> Metadata:
    """All that is said once, or of vehicles."""
    return {
        "name": recording.name,
        "rate": recording.rate if isinstance(recording.rate, int) else str(recording.rate),
        "lanes": list(map(write, recording.lanes)),
        "beside": sorted(sorted(pair) for pair in recording.beside),
        "lanelets": list(map(write, recording.lanelets)),
        "counts": np.diff(recording.start).tolist(),
        "vehicles": {name: getattr(recording, name).tolist() for name in _OF_VEHICLES},
        "notes": list(recording.notes),
        "computed": recording.computed,
        "faults": list(recording.faults),
    }


def _lanelet(data: Metadata) -> Lanelet:
    low, high = (None if x is None else Fraction(x) for x in data["s"])
    right, left = map(Fraction, data["d"])
    return Lanelet(data["id"], data["lane"], data["zone"], data["attribute"], s=(low, high), d=(right, left))


def _read_samples(path: Path, digest: str, rows: int) -> dict[str, Column]:
    content = path.read_bytes()
    _require_digest(path, hashlib.sha256(content).hexdigest(), digest)
    frame = polars_module().read_parquet(io.BytesIO(content))
    if frame.height != rows:
        raise ValueError(f"{frame.height} rows of {rows}")
    return {name: concatenated(frame[name].get_chunks()) for name in frame.columns}


def _require_digest(path: Path, actual: str, digest: str) -> None:
    if actual != digest:
        raise InputError(f"{path}: its content is not what {path.stem} was converted to; convert again")


def _recording(metadata: Metadata, columns: Mapping[str, Column]) -> Recording:
    def group(prefix: str) -> dict[str, Column]:
        return {x.removeprefix(prefix): values for x, values in columns.items() if x.startswith(prefix)}

    plain = {
        name: columns[name].astype(kind, copy=False) for name, kind in _OF_SAMPLES.items() if name in columns
    }
    vehicles = {name: np.array(metadata["vehicles"][name], kind) for name, kind in _OF_VEHICLES.items()}
    slack, inside, rows = group("slack:"), group("inside:"), int(metadata["samples"]["rows"])
    counts = np.array(metadata["counts"], np.int64)
    if counts.sum() != rows or len(counts) != len(vehicles["vehicle_id"]):
        raise ValueError("vehicles and samples do not fit")
    lanelets = tuple(map(_lanelet, metadata["lanelets"]))
    if inside:
        plain["inside"] = np.column_stack([inside[str(k)] for k in range(len(inside))])
    elif lanelets:
        plain["inside"] = np.zeros((rows, 0), np.bool_)
    return Recording(
        name=metadata["name"],
        rate=_rate(metadata),
        lanes=tuple(Lane(x["name"], x["direction"], x["d"] and tuple(x["d"])) for x in metadata["lanes"]),
        beside=frozenset(frozenset(pair) for pair in metadata["beside"]),
        start=offsets(counts),
        notes=tuple(metadata["notes"]),
        computed=bool(metadata["computed"]),
        faults=tuple(map(str, metadata["faults"])),
        lanelets=lanelets,
        slack=Slack(**slack) if slack else None,
        custom_signals=group("own:"),
        **vehicles,
        **plain,
    )


def _find(path: Path) -> dict[str, Files]:
    heads = with_suffix(_head_path(path), HEAD)
    return {x.name.removesuffix(HEAD): (x, _table_of(x)) for x in heads}


def _divide(path: Path, strict: bool) -> WindowedRecording | None:
    """Vehicles were left out, or not, where the recording was converted."""
    head = _head_path(path)
    with _convert_again_on_error(head):
        metadata = _read_metadata(head)
        if _rows(metadata) <= windows.MOST_SAMPLES:
            return undivided(_read_checked(head, metadata))
    return divide_converted(path)


FORMAT = Format(
    "converted",
    f"NAME{HEAD} and NAME{SAMPLES}, of roadproof convert",
    _find,
    read_converted,
    "{1}, rate={rate}",
    _divide,
)
