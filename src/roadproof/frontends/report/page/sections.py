"""A section of the page for a result; one that has none of its own is shown as the tables it is made of."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.answers import compare, drives
from roadproof.evidence.codec import read
from roadproof.evidence.finding import Finding
from roadproof.frontends.report.page import catalogues, values
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.results import Result, Words
from roadproof.frontends.report.page.templates import render
from roadproof.frontends.report.preventable import page_plates

Values: TypeAlias = Mapping[str, object]
_HEADING = ("schema", "roadproof", "library", "seconds", "options", "parameters", "specs", "view")
_EMPTY: tuple[object, ...] = (None, "", [], {})


def section(result: Result, context: PageContext, words: Words) -> str:
    """A result of any kind as HTML; ``words`` are what scenarios are called. Raises ``InputError``."""
    title, template, values_of = _SECTIONS.get(
        result.kind, (_TITLES.get(result.kind, result.kind), "plain", _plain)
    )
    rejected = () if result.folder is None else context.rejected.get(str(result.folder / "index.json"), ())
    frame = {"title": title, "set": result.data.get("set"), "rejections": rejected}
    known = {number: x for number, x in words.items() if x}
    try:
        said = values_of(result, context, known)
        return render(f"{template}.html", page=context, result=result, words=known, **frame, **said)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        reason = f"{type(error).__name__}: {error}"[:200]
        raise InputError(
            f"{result.name}: it is no result that can be shown: what it says is not of the form of "
            f"{result.schema} ({reason}); make it again"
        ) from None


def evidence_section(findings: Sequence[Finding], context: PageContext, solver: str) -> str:
    """Evidence that no result names, as HTML."""
    said = values.evidence(findings, context)
    return render("evidence.html", page=context, solver=solver, count=len(findings), **said)


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


_SECTIONS: Mapping[str, tuple[str, str, Callable[[Result, PageContext, Words], Values]]] = {
    "index": ("Claims", "claims", values.claims),
    "verdicts": ("Claims", "claims", values.claims),
    "witness": ("Drives that were looked for", "witness", _read_as(drives.Answer)),
    "compare": ("Two formulas side by side", "compare", _read_as(compare.Answer)),
    "overlap": ("Which scenarios can hold together", "overlap", values.overlap),
    "coverage": ("Which dangers are missed", "coverage", values.coverage),
    "classify": ("Classes that exclude each other", "classify", values.classes),
    "order": ("Which scenarios imply which", "order", values.order),
    "redundancy": ("Which parts could be left out", "redundancy", values.redundancy),
    "explore": ("How far it can go", "explore", values.explored),
    "monitor": ("Where it holds on one trace", "monitor", values.monitored),
    "catalogue": ("What a catalogue of tests covers", "catalogue", catalogues.catalogue),
    "preventable": ("From where a driver prevents a collision", "preventable", page_plates),
    "traffic-results": ("Recordings, evaluated", "traffic-results", values.traffic),
}
"""The title of a section, its template, and the function that gives the values for it."""
_TITLES = {"list": "What the library holds", "show": "A definition", "check": "Evidence that was checked"}
