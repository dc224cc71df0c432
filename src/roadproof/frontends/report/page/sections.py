"""A section of the page for a result; one that has none of its own is shown as the tables it is made of."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from roadproof.errors import InputError
from roadproof.evidence.finding import Finding
from roadproof.frontends.report.page import (
    catalogues,
    claims,
    explored,
    implied,
    matrices,
    plates,
    shares,
    traced,
)
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import behind, filtered, folded, short, verdict
from roadproof.frontends.report.page.results import Result

Section = Callable[[Result, PageContext, Mapping[int, str]], Markup]
MOST_ROWS, MOST_REASONS = 2000, 20
_HEADING = ("schema", "roadproof", "library", "seconds", "options", "parameters", "specs", "view")
_EMPTY: tuple[object, ...] = (None, "", [], {})


def section(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """A result of any kind; ``words`` are what scenarios are called. Raises ``InputError``."""
    title, made = _SECTIONS.get(result.kind, (_TITLES.get(result.kind, result.kind), _plain))
    of_set = result.data.get("set")
    told = f"{title}: {result.name}" + (f" (set {of_set})" if isinstance(of_set, str) else "")
    try:
        shown = made(result, context, words)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        reason = f"{type(error).__name__}: {error}"[:200]
        raise InputError(
            f"{result.name}: it is no result that can be shown: what it says is not of the form of "
            f"{result.schema} ({reason}); make it again"
        ) from None
    return tag("section", tag("h2", told), _rejection(result, context), shown, id=f"result-{result.id}")


def _rejection(result: Result, context: PageContext) -> Markup | None:
    """In red, above all else, what is wrong with the answer as a whole."""
    reasons = () if result.folder is None else context.rejected.get(str(result.folder / "index.json"), ())
    if not reasons:
        return None
    listed = tag("ul", *(tag("li", x) for x in reasons[:MOST_REASONS]))
    more = f" ({len(reasons)} reasons)" if len(reasons) > 1 else ""
    return tag("div", tag("p", f"roadproof check rejects this answer{more}:"), listed, class_="wrong")


def evidence_section(findings: Sequence[Finding], context: PageContext, solver: str) -> Markup:
    """Evidence that no result names."""
    return tag("section", tag("h2", "Evidence"), claims.evidence(findings, context, solver))


def _plain(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """Each list of entries as a table, with the drives that they name below it; what is left in lines."""
    parts: list[Content] = []
    for key, value in result.data.items():
        if key in _HEADING or value in _EMPTY:
            continue
        if not isinstance(value, list) or not all(isinstance(x, Mapping) for x in value):
            parts.append(tag("p", tag("b", f"{key}: "), short(value)))
            continue
        parts += [tag("h3", key), _entries(value)]
        for x in value:
            if isinstance(x.get("drive"), str | Mapping):
                said = short(x.get("claim") or x.get("formula") or f"drive {x.get('number', '')}")
                word = (verdict(x["verdict"]), " ") if x.get("verdict") else ()
                parts.append(folded((*word, tag("code", said)), *behind(x, result, context)))
    return joined(parts)


def _entries(entries: Sequence[Mapping[str, Any]]) -> Markup:
    names = dict.fromkeys(key for x in entries for key in x)
    columns = [key for key in names if any(x.get(key) not in _EMPTY for x in entries)]
    rows = [[_cell(key, x.get(key)) for key in columns] for x in entries[:MOST_ROWS]]
    left = len(entries) - MOST_ROWS
    return joined([filtered(table(columns, rows)), tag("p", f"and {left} more") if left > 0 else None])


def _cell(key: str, value: object) -> Content:
    if key == "verdict":
        return verdict(value)
    return value if isinstance(value, int | float) and not isinstance(value, bool) else short(value)


_SECTIONS: Mapping[str, tuple[str, Section]] = {
    "index": ("Claims", claims.claims),
    "verdicts": ("Claims", claims.claims),
    "witness": ("Drives that were looked for", claims.witnesses),
    "compare": ("Two formulas side by side", claims.comparison),
    "overlap": ("Which scenarios can hold together", matrices.overlap),
    "coverage": ("Which dangers are missed", matrices.coverage),
    "classify": ("Classes that exclude each other", shares.classes),
    "order": ("Which scenarios imply which", implied.order),
    "redundancy": ("Which parts could be left out", implied.redundancy),
    "explore": ("How far it can go", explored.explored),
    "monitor": ("Where it holds on one trace", traced.monitored),
    "catalogue": ("What a catalogue of tests covers", catalogues.catalogue),
    "preventable": ("From where a driver prevents a collision", plates.plates),
    "traffic-results": ("Recordings, evaluated", shares.traffic),
}
_TITLES = {"list": "What the library holds", "show": "A definition", "check": "Evidence that was checked"}
