"""The section about a vehicle under test in place of recorded ones, on a report page."""

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from roadproof.evidence.codec import read
from roadproof.extensions.closed_loop.resimulation.data import (
    OccurrenceResult,
    RecordedOccurrence,
    ResimulationData,
)
from roadproof.extensions.pages.page.page_context import DriveCard, PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.section_kind import OpenItem, SectionKind, Values

_HERE = Path()


class OccurrenceRow(NamedTuple):
    """An occurrence on the page: what it is, its finding, and cards of its drives where it fails."""

    occurrence: RecordedOccurrence
    result: OccurrenceResult
    cards: tuple[DriveCard, ...]


def _resimulated(result: PageResult, context: PageContext, words: Words) -> Values:
    """Return the values of the template: the answer, and a row for each occurrence."""
    answer = read(ResimulationData, result.data, result.name)
    results = {x.id: x for x in answer.occurrences}
    rows = [
        OccurrenceRow(x, results[x.id], _cards(results[x.id], result, context))
        for x in answer.request.occurrences
        if x.id in results
    ]
    return {"answer": answer, "rows": rows}


def _cards(x: OccurrenceResult, result: PageResult, context: PageContext) -> tuple[DriveCard, ...]:
    if x.finding != "FAILS":
        return ()
    drives = {"": x.drive, **x.driven}
    return tuple(_card(name, drive, x, result, context) for name, drive in drives.items())


def _card(
    driver: str, drive: object, x: OccurrenceResult, result: PageResult, context: PageContext
) -> DriveCard:
    place = "-".join(filter(None, ("breaks", str(result.id), x.id, driver)))
    shown = drive if isinstance(drive, Mapping) else (result.folder or _HERE) / str(drive)
    if not driver:
        return DriveCard(context.drive(shown), "FAILS", x.id, place, title="your vehicle fails")
    verdict = next(y for y in x.drivers if y.driver == driver)
    margin = "" if verdict.gap is None else f", {verdict.gap:g} m left"
    title = f"{driver} drives instead: {verdict.side}{margin}"
    return DriveCard(context.drive(shown), "WITNESSED", x.id, place, title=title)


def _points(result: PageResult) -> Iterator[OpenItem]:
    """Yield the occurrences in which the vehicle fails, or that are not decided."""
    for x in read(ResimulationData, result.data, result.name).occurrences:
        if x.finding in ("FAILS", "ERROR"):
            reason = f": {x.reason}" if x.reason else ""
            yield OpenItem(x.finding, f"{x.id}{reason}", f"result-{result.id}")


def _counts(result: PageResult) -> str:
    """Return how many occurrences have each finding."""
    counts = Counter(x.finding for x in read(ResimulationData, result.data, result.name).occurrences)
    return ", ".join(f"{n} {finding}" for finding, n in counts.items())


RESIMULATE = SectionKind(
    "Vehicle under test in recordings",
    "What would it have done?",
    "resimulate",
    _resimulated,
    _points,
    _counts,
)
