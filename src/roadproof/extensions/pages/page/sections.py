"""A section of the page for a result; one that has none of its own is shown as the tables it is made of."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from roadproof.errors import InputError
from roadproof.evidence.codec import read
from roadproof.evidence.finding import Finding, checkers
from roadproof.extension import entries, imported
from roadproof.extensions.pages.page import catalogues, claims, values
from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.plates import page_plates
from roadproof.extensions.pages.page.results import Result, Words
from roadproof.extensions.pages.page.section_kind import SectionKind, Values
from roadproof.extensions.pages.page.summary import Overview, Statement, overview
from roadproof.extensions.pages.page.templates import render
from roadproof.library.words import spans
from roadproof.questions.compare import ComparisonData
from roadproof.questions.data import QUESTION

_HEADING = ("schema", "roadproof", "library", "seconds", "options", "parameters", "specs", "view")
_EMPTY: tuple[object, ...] = (None, "", [], {})


class Section(NamedTuple):
    """A section as HTML, and what the summary says of it."""

    overview: Overview
    html: str


def section(result: Result, context: PageContext, words: Words) -> Section:
    """A result of any kind as HTML; ``words`` are what scenarios are called. Raises ``InputError``."""
    kind = _kind_of(result)
    rejected = () if result.folder is None else context.rejected.get(str(result.folder / QUESTION), ())
    frame = {"title": kind.title, "question": kind.question, "set": result.data.get("set")}
    known = {number: x for number, x in words.items() if x}
    try:
        told = kind.values(result, context, known)
        html = render(
            f"{kind.template}.html",
            page=context,
            result=result,
            words=known,
            rejections=rejected,
            **frame,
            **told,
        )
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        reason = f"{type(error).__name__}: {error}"[:200]
        raise InputError(
            f"{result.name}: it is no result that can be shown: what it says is not of the form of "
            f"{result.schema} ({reason}); make it again"
        ) from None
    wrong = len(rejected) + context.rejected_in(result.folder)
    return Section(overview(result, kind.title, kind.question, wrong), html)


def _kind_of(result: Result) -> SectionKind:
    own = entries("sections")
    if result.kind in own:
        found: SectionKind = imported(own[result.kind])
        return found
    return _KINDS.get(result.kind, SectionKind(result.kind, "", "plain", _plain))


def drive_section(findings: Sequence[Finding], context: PageContext) -> Section:
    """The gallery of accepted drives that no result names."""
    cards = values.drives_alone(findings, context)
    said = [Statement(x.verdict, x.drive.title or x.claim, x.place) for x in cards]
    scenarios = {x.drive.scenario for x in cards if x.drive.scenario is not None}
    subject = f"scenarios {spans(scenarios)}" if scenarios else ""
    head = Overview("Drives", "Which drives show the scenarios?", "drives", "", subject, statements=said)
    return Section(head, render("drives.html", page=context, cards=cards, head=head))


def evidence_section(findings: Sequence[Finding], context: PageContext, solver: str) -> Section:
    """Evidence that no result names: a row for each file."""
    said = values.evidence(findings)
    proofs = [Statement(x.verdict, x.label, "evidence") for x in findings if x.kind == "certificate"]
    told = "" if proofs else f"{len(findings)} files"
    head = Overview("Evidence", "Does independent code accept it?", "evidence", told=told, statements=proofs)
    by = checkers(findings, solver)
    html = render("evidence.html", page=context, checkers=by, count=len(findings), head=head, **said)
    return Section(head, html)


@dataclass(frozen=True)
class _Part:
    """A value of an answer; ``columns``: the keys of its entries, None where it is no list of entries."""

    key: str
    value: Any
    columns: Sequence[str] | None


def _plain(result: Result, context: PageContext, words: Words) -> Values:
    """Each value of an answer."""
    parts = [
        _Part(key, value, _columns(value))
        for key, value in result.data.items()
        if key not in _HEADING and value not in _EMPTY
    ]
    return {"parts": parts}


def _columns(value: object) -> Sequence[str] | None:
    if not isinstance(value, list) or not all(isinstance(x, Mapping) for x in value):
        return None
    names = dict.fromkeys(key for x in value for key in x)
    return [key for key in names if any(x.get(key) not in _EMPTY for x in value)]


def _read_as(answer: type) -> Callable[[Result, PageContext, Words], Values]:
    """Values of a section that needs no more than the answer itself."""
    return lambda result, context, words: {"answer": read(answer, result.data, result.name)}


_CLAIMS = SectionKind("Claims", "Which claims hold in all traffic?", "claims", claims.claims)
_KINDS: Mapping[str, SectionKind] = {
    "index": _CLAIMS,
    "verdicts": _CLAIMS,
    "witness": SectionKind("Drives", "Does a drive show each formula?", "witness", values.witnessed),
    "compare": SectionKind("Two formulas", "Does one imply the other?", "compare", _read_as(ComparisonData)),
    "overlap": SectionKind(
        "Compatible scenarios", "Which pairs can one drive show?", "overlap", values.overlap
    ),
    "coverage": SectionKind(
        "Gaps", "Which dangers does the set of scenarios miss?", "coverage", values.coverage
    ),
    "classify": SectionKind("Classes", "Which classes partition the scenarios?", "classify", values.classes),
    "order": SectionKind("Implications", "Which scenarios imply which?", "order", values.order),
    "redundancy": SectionKind(
        "Redundant parts", "Which parts change nothing?", "redundancy", values.redundancy
    ),
    "explore": SectionKind("Extremes", "How far can a drive of the formula go?", "explore", values.explored),
    "monitor": SectionKind("One trace", "Where does the formula hold on it?", "monitor", values.monitored),
    "catalogue": SectionKind(
        "Catalogue of tests", "Which scenarios do they cover?", "catalogue", catalogues.catalogue
    ),
    "preventable": SectionKind(
        "Preventable collisions", "From which states does a driver prevent one?", "preventable", page_plates
    ),
    "traffic-results": SectionKind(
        "Recordings", "How often do the scenarios occur in traffic?", "traffic-results", values.traffic
    ),
    "list": SectionKind("Library", "Which definitions does it hold?", "plain", _plain),
    "show": SectionKind("Definition", "What does it say?", "plain", _plain),
    "check": SectionKind("Check of evidence", "Does independent code accept it?", "plain", _plain),
}
