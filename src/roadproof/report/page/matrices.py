"""Matrices with what is behind each cell: which scenarios hold together, and which dangers are missed."""

from collections.abc import Mapping
from typing import Any

from roadproof.report.page.book import Book
from roadproof.report.page.markup import Content, Markup, joined, table, tag
from roadproof.report.page.pieces import behind, cell, counts, folded, matrix, short, verdict
from roadproof.report.page.results import Result


def overlap(result: Result, book: Book, words: Mapping[int, str]) -> Markup:
    """Every pair of scenarios: a cell each, and behind it the drive or the clash."""
    pairs = result.data.get("verdicts", ())
    several = len({str(x.get(key)) for x in pairs for key in ("set_a", "set_b")}) > 1
    ends = {(x[side], x.get(f"set_{side}") if several else "") for x in pairs for side in ("a", "b")}
    order = sorted(ends, key=lambda end: (str(end[1]), end[0]))
    known = {_key(x, several): k for k, x in enumerate(pairs)}
    rows: list[list[Content]] = []
    for row in order:
        cells: list[Content] = [_heading(row, words, "row")]
        for column in order:
            place = known.get((row, column), known.get((column, row)))
            cells.append(tag("td") if place is None else _cell(result, place, pairs[place]))
        rows.append(cells)
    columns = [_heading(end, words, "col") for end in order]
    called = [(f"{n} {of}".strip(), words[n]) for n, of in order if words.get(n)]
    return joined(
        [
            tag("p", counts(pairs), ". Each cell leads to its drive, or to what clashes."),
            matrix(columns, rows),
            folded(("What the scenarios are called",), table(("", ""), called)) if called else None,
            *(_pair(result, k, x, book, words) for k, x in enumerate(pairs)),
        ]
    )


def _key(x: Mapping[str, Any], several: bool) -> tuple[tuple[int, Any], tuple[int, Any]]:
    return (x["a"], x.get("set_a") if several else ""), (x["b"], x.get("set_b") if several else "")


def _heading(end: tuple[int, Any], words: Mapping[int, str], scope: str) -> Markup:
    return tag("th", f"{end[0]} {end[1]}".strip(), scope=scope, title=words.get(end[0]))


def _cell(result: Result, place: int, x: Mapping[str, Any]) -> Markup:
    return cell(x.get("verdict"), f"{x['a']} and {x['b']}: {x.get('verdict')}", _id(result, "pair", place))


def _id(result: Result, what: str, place: object) -> str:
    return f"{what}-{result.id}-{place}"


def _pair(result: Result, place: int, x: Mapping[str, Any], book: Book, words: Mapping[int, str]) -> Markup:
    one, two = (tag("b", f"{x[side]} {words.get(x[side], '')}".strip()) for side in ("a", "b"))
    inside: list[Content] = [tag("p", tag("code", x.get("formula")))]
    inside += [tag("p", x["reason"])] if x.get("reason") else []
    inside += behind(x, result, book)
    return folded((verdict(x.get("verdict")), " ", one, " and ", two), *inside, id=_id(result, "pair", place))


def coverage(result: Result, book: Book, words: Mapping[int, str]) -> Markup:
    """Which disturbances a set misses: classes of gaps by scenario, and behind each cell a drive."""
    data = result.data
    classes, gaps, claims = (data.get(x) or () for x in ("classes", "gaps", "claims"))
    told = (
        f": {len(gaps)} gap{'s' if len(gaps) != 1 else ''}, each with a judged drive."
        if gaps
        else ": no gap was found."
    )
    parts: list[Content] = [tag("p", verdict(data.get("verdict")), told)]
    for x in claims:
        inside: list[Content] = [tag("p", x["reason"])] if x.get("reason") else []
        summary = (verdict(x.get("verdict")), " ", tag("code", x.get("claim")))
        parts.append(folded(summary, *inside, *behind(x, result, book)))
    parts += [_classes(result, classes, words)] if classes else []
    for x in gaps:
        where = f" on {short(x.get('road'))}, caught by {short(x.get('caught_by'))}"
        inside = [tag("p", tag("code", x.get("formula"))), *behind(x, result, book)]
        parts.append(
            folded((tag("b", f"gap {x['number']}"), where), *inside, id=_id(result, "gap", x["number"]))
        )
    noted = [x for x in classes if x.get("reason") and x.get("gaps")]
    notes = [(x.get("scenario"), x.get("description"), x["reason"]) for x in noted]
    parts += [table(("scenario", "what", "note"), notes)] if notes else []
    parts += [_no_gap(result, k, x, book) for k, x in enumerate(classes) if not x.get("gaps")]
    return joined(parts)


def _no_gap(result: Result, place: int, x: Mapping[str, Any], book: Book) -> Markup:
    """A class without a drive: what was proved of it, or why it is not known."""
    scenario = x.get("scenario")
    told = f" scenario {scenario}, {x.get('component')}: " if scenario is not None else " "
    inside: list[Content] = [tag("p", tag("code", x.get("claim")))] if x.get("claim") else []
    inside += [tag("p", x["reason"])] if x.get("reason") else []
    summary = (verdict(x.get("verdict")), told, x.get("condition") or x.get("description"))
    return folded(summary, *inside, *behind(x, result, book), id=_id(result, "class", place))


def _classes(result: Result, classes: Any, words: Mapping[int, str]) -> Markup:
    scenarios = list(dict.fromkeys(x.get("scenario") for x in classes))
    kinds = list(dict.fromkeys((x.get("component"), x.get("condition")) for x in classes))
    places = {(x.get("scenario"), x.get("component"), x.get("condition")): k for k, x in enumerate(classes)}
    rows: list[list[Content]] = []
    for kind in kinds:
        cells: list[Content] = [tag("th", " ".join(str(x) for x in kind if x), scope="row")]
        for scenario in scenarios:
            k = places.get((scenario, *kind))
            cells.append(tag("td") if k is None else _gap_cell(result, k, classes[k]))
        rows.append(cells)
    columns = [tag("th", x or "other", scope="col", title=words.get(x or -1)) for x in scenarios]
    told = "What of which scenario is false: ■ a danger that is missed so, · proved that there is none. "
    told += "Each cell leads to its drive, or to what was proved."
    return joined([tag("p", told), matrix(columns, rows)])


def _gap_cell(result: Result, place: int, x: Mapping[str, Any]) -> Markup:
    numbers = x.get("gaps") or ()
    target = _id(result, "gap", numbers[0]) if numbers else _id(result, "class", place)
    drives = f", gap {', '.join(map(str, numbers))}" if numbers else ""
    return cell(x.get("verdict"), f"{x.get('description')}: {x.get('verdict')}{drives}", target)
