"""The sections of pages that come with roadproof, which the record of the extension names."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from roadproof.evidence.codec import read
from roadproof.extensions.pages.page import catalogues, claims, values
from roadproof.extensions.pages.page.open_points import catalogue_points
from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.plates import plate_values
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.section_kind import SectionKind, Values
from roadproof.questions.compare import ComparisonData

_HEADING = ("schema", "roadproof", "library", "seconds", "options", "parameters", "specs", "view")
_EMPTY: tuple[object, ...] = (None, "", [], {})


@dataclass(frozen=True)
class _AnswerValue:
    """A value of an answer; ``columns``: the keys of its entries, None where it is no list of entries."""

    key: str
    value: Any
    columns: Sequence[str] | None


def plain(result: PageResult, context: PageContext, words: Words) -> Values:
    """Return each value of an answer."""
    parts = [
        _AnswerValue(key, value, _columns(value))
        for key, value in result.data.items()
        if key not in _HEADING and value not in _EMPTY
    ]
    return {"parts": parts}


def _columns(value: object) -> Sequence[str] | None:
    if not isinstance(value, list) or not all(isinstance(x, Mapping) for x in value):
        return None
    names = dict.fromkeys(key for x in value for key in x)
    return [key for key in names if any(x.get(key) not in _EMPTY for x in value)]


def _read_as(answer: type) -> Callable[[PageResult, PageContext, Words], Values]:
    """Return a function for the values of a section that needs only the answer itself."""
    return lambda result, context, words: {"answer": read(answer, result.data, result.name)}


CLAIMS = SectionKind("Claims", "Which claims hold in all traffic?", "claims", claims.claims)
WITNESS = SectionKind("Drives", "Does a drive show each formula?", "witness", values.witnessed)
COMPARE = SectionKind("Two formulas", "Does one imply the other?", "compare", _read_as(ComparisonData))
OVERLAP = SectionKind("Compatible scenarios", "Which pairs can one drive show?", "overlap", values.overlap)
COVERAGE = SectionKind("Gaps", "Which dangers does the set of scenarios miss?", "coverage", values.coverage)
CLASSIFY = SectionKind("Classes", "Which classes partition the scenarios?", "classify", values.classes)
ORDER = SectionKind("Implications", "Which scenarios imply which?", "order", values.order)
REDUNDANCY = SectionKind("Redundant parts", "Which parts change nothing?", "redundancy", values.redundancy)
EXPLORE = SectionKind("Extremes", "How far can a drive of the formula go?", "explore", values.explored)
MONITOR = SectionKind("One trace", "Where does the formula hold on it?", "monitor", values.monitored)
CATALOGUE = SectionKind(
    "Catalogue of tests",
    "Which scenarios do they cover?",
    "catalogue",
    catalogues.catalogue,
    catalogue_points,
)
PREVENTABLE = SectionKind(
    "Preventable collisions", "From which states does a driver prevent one?", "preventable", plate_values
)
TRAFFIC = SectionKind(
    "Recordings", "How often do the scenarios occur in traffic?", "traffic-results", values.traffic
)
LIST = SectionKind("Library", "Which definitions does it hold?", "plain", plain)
SHOW = SectionKind("Definition", "What does it say?", "plain", plain)
CHECK = SectionKind("Check of evidence", "Does independent code accept it?", "plain", plain)
