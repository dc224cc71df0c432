"""The section about a vehicle under test in place of recorded ones, on a report page."""

from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

from roadproof.evidence.codec import read
from roadproof.extensions.closed_loop.failure_cards import failure_cards
from roadproof.extensions.closed_loop.resimulation.data import (
    OccurrenceResult,
    RecordedOccurrence,
    ResimulationData,
)
from roadproof.extensions.pages.page.page_context import DriveCard, PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.section_kind import OpenItem, SectionKind, Values


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
    return failure_cards("breaks", x.id, drives, x.drivers, result, context)


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
