"""Counts in recordings, as a table beside the answers; no verdict rests on it."""

import csv
import io
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

from roadproof.errors import InputError
from roadproof.evidence.codec import read, write
from roadproof.evidence.strict import LARGEST_INDEX, JsonObject
from roadproof.extensions.surveys.classify.data import ClassesData, SharesData, Situations, add_counts
from roadproof.runtime.files import read_text

SHARES: Final = "shares.csv"
_COLUMNS = ("what", "name", "number")
_TOTALS = ("traces", "covered", "repeated")


def shares_table(shares: SharesData, situations: Mapping[str, int], traces: Mapping[str, int]) -> str:
    """Return the counts as a CSV table: totals, and situations and traces of each class."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(_COLUMNS)
    writer.writerows(_rows(shares, situations, traces))
    return out.getvalue()


def _rows(
    shares: SharesData, situations: Mapping[str, int], traces: Mapping[str, int]
) -> Iterator[tuple[str, str, int | str]]:
    yield "source", shares.source, ""
    yield from (("recording", name, "") for name in shares.recordings)
    yield from (("total", name, getattr(shares, name)) for name in _TOTALS)
    yield "vehicles", "2", shares.situations.pairs
    yield "vehicles", "3", shares.situations.triples
    yield from (("broken", text, "") for text in shares.broken)
    yield from (("situations", name, n) for name, n in sorted(situations.items()))
    yield from (("traces", name, n) for name, n in sorted(traces.items()))


def with_shares(data: JsonObject, folder: Path) -> JsonObject:
    """Return the view of a folder with the counts of its table. Raises ``InputError``."""
    path = folder / SHARES
    if not path.is_file() or path.is_symlink():
        return data
    rows = [*csv.reader(io.StringIO(read_text(path, LARGEST_INDEX, "no table of shares is larger")))]
    if not rows or tuple(rows[0]) != _COLUMNS or any(len(row) != len(_COLUMNS) for row in rows):
        raise InputError(f"{path}: its columns are not {', '.join(_COLUMNS)}")
    try:
        numbers = {(what, name): int(n) for what, name, n in rows[1:] if n}
    except ValueError as error:
        raise InputError(f"{path}: a number is expected: {error}") from None
    names = [(what, name) for what, name, _ in rows[1:]]
    shares = SharesData(
        source=next((name for what, name in names if what == "source"), ""),
        recordings=tuple(name for what, name in names if what == "recording"),
        traces=numbers.get(("total", "traces"), 0),
        covered=numbers.get(("total", "covered"), 0),
        repeated=numbers.get(("total", "repeated"), 0),
        situations=Situations(
            pairs=numbers.get(("vehicles", "2"), 0), triples=numbers.get(("vehicles", "3"), 0)
        ),
        broken=tuple(name for what, name in names if what == "broken"),
    )
    situations, traces = (
        {name: n for (what, name), n in numbers.items() if what == word} for word in ("situations", "traces")
    )
    return write(add_counts(read(ClassesData, data, str(path)), shares, situations, traces))
