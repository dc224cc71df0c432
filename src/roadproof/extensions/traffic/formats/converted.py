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
from roadproof.extensions.traffic.formats.table import Column, Frame, joined, polars_module
from roadproof.extensions.traffic.formats.windows import Window, WindowedRecording, divide, undivided
from roadproof.runtime.files import read_limited, refuse_name, write_json, write_whole
from roadproof.runtime.version import VERSION
from roadproof.world.road import Lanelet
from roadproof.world.signals import RECORDED

SCHEMA = "roadproof/recording/3"
HEAD, SAMPLES = ".recording.json", CONVERTED
_UNFIT = (ValueError, KeyError, TypeError, AttributeError, RecursionError)
_NEAR = 100_000  # rows between those of two vehicles that are read with them
_LARGEST_HEAD = 200_000_000  # bytes; two thousand vehicles take 0.3 MB
Head: TypeAlias = Mapping[str, Any]
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
    write_whole(table, content)
    digest = hashlib.sha256(content).hexdigest()
    write_json(head, head_of(recording, source.format.name, digests, len(recording.s), digest))
    if not same_recording(read_converted(head), recording):
        raise RuntimeError(f"recording {source.name} does not come back from {head}")
    return recording


def head_of(recording: Recording, form: str, digests: Mapping[str, str], rows: int, digest: str) -> Head:
    """What NAME.recording.json says of so many ``rows``; their file has the ``digest``.

    ``digests``: of the files of the format called ``form`` that it was made of.
    """
    said = {
        "schema": SCHEMA,
        "roadproof": VERSION,
        "made_of": {"format": form, "sha256": dict(digests)},
        "samples": {"rows": rows, "sha256": digest},
        **_said(recording),
    }
    return {**said, "sha256": digest_of(said)}


def digest_of(said: Head) -> str:
    """The digest of what NAME.recording.json says beside its digest."""
    plain = {name: value for name, value in said.items() if name != "sha256"}
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
    head = _head_of(path)
    with _as_written(head):
        return _whole(head, _read_head(head))


def _whole(head: Path, said: Head) -> Recording:
    """The recording of which the head says this. Raises ``InputError``, and what ``_as_written`` takes."""
    recording = _recording(said, _read_samples(_table_of(head), said["samples"]["sha256"], _rows(said)))
    believing = PlausibilityChecks(head, recording.rate, recording.lanes)
    believing.add(recording)
    return with_notes(recording, believing.notes(recording.notes))


def samples_in(head: Path) -> int:
    """How many samples a converted recording has. Raises ``InputError``."""
    with _as_written(head):
        return _rows(_read_head(head))


def divide_converted(path: Path, checked: bool = False) -> WindowedRecording | None:
    """The recording of NAME.recording.json in windows of time, None where it is small. Raises ``InputError``.

    Each is read from the rows of its vehicles. Raises ``InputError`` where the file changes meanwhile.
    ``checked``: this run has written the files and need not repeat the checks.
    """
    head = _head_of(path)
    with _as_written(head):
        said, table = _read_head(head), _table_of(head)
        if _rows(said) <= windows.MOST_SAMPLES:
            return None
        stamp = stamp_of(table)
        with table.open("rb") as file:
            _require_digest(table, hashlib.file_digest(file, "sha256").hexdigest(), said["samples"]["sha256"])
        counts, first_frame = np.array(said["counts"]), np.array(said["vehicles"]["first_frame"])
        if counts.sum() != _rows(said) or counts.shape != first_frame.shape or counts.min() < 1:
            raise ValueError("vehicles and samples do not fit")
        more = () if checked else _checked_in_parts(head, said, offsets(counts))
        ids = np.array(said["vehicles"]["vehicle_id"])[_backwards_in(table, offsets(counts))]
        more = (*more, *(x for x in backwards(ids) if x not in said["notes"]))
        zones = polars_module().scan_parquet(table).select("zones").unique().collect()["zones"].to_list()

    def read() -> Iterator[Window]:
        start = offsets(counts)
        for there, new in divide(first_frame, first_frame + counts - 1, windows.MOST_SAMPLES):
            with _as_written(head):
                vehicles = np.flatnonzero(there)
                recording = _recording(_of_vehicles(said, vehicles), _read_rows(table, start, vehicles))
                require_unchanged(table, stamp)
            yield Window(with_notes(recording, more), new[vehicles])

    return WindowedRecording(_rate(said), zones_in(zones), read)


def _backwards_in(table: Path, start: Integers) -> Integers:
    """Which vehicles drive backwards; of all rows only those are read in which one does."""
    pl = polars_module()
    rows = pl.scan_parquet(table, row_index_name="row").filter(pl.col("v_lon") < BACKWARDS).select("row")
    found: Integers = np.unique(np.searchsorted(start, rows.collect()["row"].to_numpy(), "right") - 1)
    return found


def _checked_in_parts(head: Path, said: Head, start: Integers) -> tuple[str, ...]:
    """The notes that the checks of the whole add, some vehicles at a time. Raises ``InputError``."""
    believing: PlausibilityChecks | None = None
    group = start[:-1] // windows.MOST_SAMPLES
    for number in np.unique(group):
        vehicles = np.flatnonzero(group == number)
        part = _recording(_of_vehicles(said, vehicles), _read_rows(_table_of(head), start, vehicles))
        believing = believing or PlausibilityChecks(head, part.rate, part.lanes)
        believing.add(part)
    return () if believing is None else believing.notes(said["notes"])


def _of_vehicles(said: Head, vehicles: Integers) -> Head:
    """What is said, of some of the vehicles."""
    chosen = vehicles.tolist()
    counts = [said["counts"][v] for v in chosen]
    of = {name: [x[v] for v in chosen] if x else x for name, x in said["vehicles"].items()}
    return {**said, "counts": counts, "vehicles": of, "samples": {"rows": sum(counts)}}


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
        wanted = np.zeros(high - low + 1, np.int64)
        np.add.at(wanted, begin[group] - low, 1)
        np.add.at(wanted, end[group] - low, -1)
        parts.append(frame.filter(pl.Series(np.cumsum(wanted)[:-1] > 0)))
    whole = pl.concat(parts)
    return {name: whole[name].to_numpy() for name in whole.columns}


@contextmanager
def _as_written(head: Path) -> Iterator[None]:
    """Raise ``InputError`` where a file is not what ``convert`` writes."""
    try:
        yield
    except (*_UNFIT, polars_module().exceptions.PolarsError) as error:
        told = f"{type(error).__name__}: {error}"[:120]
        raise InputError(f"{head}: it is not what convert writes ({told}); convert again") from None
    except OSError as error:
        told = f"{_table_of(head)}: the file cannot be read ({error.strerror})"
        raise InputError(f"{told}; convert again") from None


def _table_of(head: Path) -> Path:
    return head.with_name(f"{head.name.removesuffix(HEAD)}{SAMPLES}")


def _head_of(path: Path) -> Path:
    """The head of a table; another path stays as it is."""
    is_table = path.name.endswith(SAMPLES)
    return path.with_name(f"{path.name.removesuffix(SAMPLES)}{HEAD}") if is_table else path


def _rate(said: Head) -> Rate:
    rate = Fraction(said["rate"])
    return int(rate) if rate.denominator == 1 else rate


def _rows(said: Head) -> int:
    return int(said["samples"]["rows"])


def _read_head(head: Path) -> Head:
    said: Head = json.loads(read_limited(head, _LARGEST_HEAD, "it is none of ours"))
    if said["schema"] != SCHEMA:
        raise InputError(f"{head}: schema={said['schema']!r}, but must be {SCHEMA!r}")
    if said["roadproof"] != VERSION:
        raise InputError(
            f"{head}: it was converted by version {str(said['roadproof'])[:40]}, and this is "
            f"{VERSION}, which may read recordings otherwise; convert them again"
        )
    if said["sha256"] != digest_of(said):
        raise InputError(f"{head}: its content is not what convert wrote (sha256 differs); convert again")
    if said["name"] != head.name.removesuffix(HEAD):
        raise InputError(f"{head}: it is of recording {str(said['name'])[:40]!r}; give the file that name")
    return said


def same_recording(one: Recording, other: Recording) -> bool:
    """Whether two recordings say the same, NaN in columns of users' own included."""
    ours, theirs = frame_of_samples(one), frame_of_samples(other)
    same = len(one.moments) == len(other.moments) and _said(one) == _said(other)
    return same and ours.schema == theirs.schema and ours.equals(theirs)


def _samples(recording: Recording) -> dict[str, Column]:
    """All that there is an entry a sample of, by the name of its column."""
    rows = len(recording.s)
    found = {name: getattr(recording, name) for name in _OF_SAMPLES}
    found = {name: values for name, values in found.items() if len(values) == rows}
    if recording.slack is not None:
        found |= {f"slack:{name}": getattr(recording.slack, name) for name in _SLACK}
    found |= {f"inside:{k}": recording.inside[:, k] for k in range(recording.inside.shape[1])}
    return found | {f"own:{name}": values for name, values in recording.own.items()}


def _said(recording: Recording) -> Head:
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


def _lanelet(data: Head) -> Lanelet:
    low, high = (None if x is None else Fraction(x) for x in data["s"])
    right, left = map(Fraction, data["d"])
    return Lanelet(data["id"], data["lane"], data["zone"], data["attribute"], s=(low, high), d=(right, left))


def _read_samples(path: Path, digest: str, rows: int) -> dict[str, Column]:
    content = path.read_bytes()
    _require_digest(path, hashlib.sha256(content).hexdigest(), digest)
    frame = polars_module().read_parquet(io.BytesIO(content))
    if frame.height != rows:
        raise ValueError(f"{frame.height} rows of {rows}")
    return {name: joined(frame[name].get_chunks()) for name in frame.columns}


def _require_digest(path: Path, found: str, digest: str) -> None:
    if found != digest:
        raise InputError(f"{path}: its content is not what {path.stem} was converted to; convert again")


def _recording(said: Head, columns: Mapping[str, Column]) -> Recording:
    def group(prefix: str) -> dict[str, Column]:
        return {x.removeprefix(prefix): values for x, values in columns.items() if x.startswith(prefix)}

    plain = {
        name: columns[name].astype(kind, copy=False) for name, kind in _OF_SAMPLES.items() if name in columns
    }
    vehicles = {name: np.array(said["vehicles"][name], kind) for name, kind in _OF_VEHICLES.items()}
    slack, inside, rows = group("slack:"), group("inside:"), int(said["samples"]["rows"])
    counts = np.array(said["counts"], np.int64)
    if counts.sum() != rows or len(counts) != len(vehicles["vehicle_id"]):
        raise ValueError("vehicles and samples do not fit")
    lanelets = tuple(map(_lanelet, said["lanelets"]))
    if inside:
        plain["inside"] = np.column_stack([inside[str(k)] for k in range(len(inside))])
    elif lanelets:
        plain["inside"] = np.zeros((rows, 0), np.bool_)
    return Recording(
        name=said["name"],
        rate=_rate(said),
        lanes=tuple(Lane(x["name"], x["direction"], x["d"] and tuple(x["d"])) for x in said["lanes"]),
        beside=frozenset(frozenset(pair) for pair in said["beside"]),
        start=offsets(counts),
        notes=tuple(said["notes"]),
        computed=bool(said["computed"]),
        faults=tuple(map(str, said["faults"])),
        lanelets=lanelets,
        slack=Slack(**slack) if slack else None,
        own=group("own:"),
        **vehicles,
        **plain,
    )


def _find(path: Path) -> dict[str, Files]:
    found = with_suffix(_head_of(path), HEAD)
    return {x.name.removesuffix(HEAD): (x, _table_of(x)) for x in found}


def _divide(path: Path, strict: bool) -> WindowedRecording | None:
    """Vehicles were left out, or not, where the recording was converted."""
    head = _head_of(path)
    with _as_written(head):
        said = _read_head(head)
        if _rows(said) <= windows.MOST_SAMPLES:
            return undivided(_whole(head, said))
    return divide_converted(path)


FORMAT = Format(
    "converted",
    f"NAME{HEAD} and NAME{SAMPLES}, of roadproof convert",
    _find,
    read_converted,
    "{1}, rate={rate}",
    _divide,
)
