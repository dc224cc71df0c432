"""The open points of results: untested situations, faulty and doubtful tests, and what a reader left out."""

from collections.abc import Iterator
from typing import Final

from roadproof.evidence.codec import read
from roadproof.evidence.strict import Json
from roadproof.extensions.catalogue.catalogue_data import CatalogueData, Remarks
from roadproof.extensions.pages.page.results import PageResult
from roadproof.extensions.pages.page.section_kind import OpenItem

NOT_TESTED: Final = "not tested"
LEFT_OUT: Final = "left out"
UNDECIDED: Final = "undecided"


def parts_left_out(result: PageResult) -> Iterator[OpenItem]:
    """Yield the parts of files that a reader left out of a result."""
    for text in _texts(result.data.get("left_out")):
        yield OpenItem(LEFT_OUT, text, f"result-{result.id}")


def catalogue_points(result: PageResult) -> Iterator[OpenItem]:
    """Yield the open points of a catalogue: what is not tested, at fault, in doubt or undecided."""
    points = _of_catalogue(read(CatalogueData, result.data, result.name), result.id)
    yield from (OpenItem(*x) for x in points)


def _of_catalogue(data: CatalogueData, number: int) -> Iterator[tuple[str, str, str]]:
    places = {x.id: f"test-{number}-{k}" for k, x in enumerate(data.tests)}
    whole = f"result-{number}"
    words = {x.name: x.words for x in (*data.targets, *data.gaps.targets)}
    for name in data.not_tested:
        yield NOT_TESTED, f"{name}: {words[name]}" if words.get(name) else name, whole
    for y in data.figures:
        if y.tested < y.total and not y.sector and y.set_name != data.set.partition(",")[0]:
            yield NOT_TESTED, f"{y.total - y.tested} of {y.total} {y.kind} of set {y.set_name}", whole
    remarks: tuple[tuple[str, Remarks], ...] = (
        ("fault", data.faults),
        ("in doubt", data.doubts),
        ("contradiction", data.contradictions),
    )
    for word, these in remarks:
        yield from ((word, f"{', '.join(x.tests)}: {x.told}", places.get(x.tests[0], whole)) for x in these)
    yield from (("in doubt", f"{name}: {reason}", whole) for name, reason in data.gaps.open.items())
    models: dict[tuple[str, str], list[str]] = {}
    for x in data.decisions:
        if x.side == UNDECIDED:
            models.setdefault((x.test, x.scenario), []).append(x.driver)
    for (test, scenario), drivers in models.items():
        yield UNDECIDED, f"{test}, {scenario}: {', '.join(drivers)}", places.get(test, whole)


def _texts(value: Json) -> Iterator[str]:
    """Yield the texts of a list, or of lists by name, each with the name."""
    if isinstance(value, dict):
        for name, texts in value.items():
            yield from (f"{name}: {x}" for x in _texts(texts))
    elif isinstance(value, list):
        yield from (str(x) for x in value)
