"""How far values of parameters and measures can go: each value leads to its drive or to what clashes."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any

from roadproof.report.explore import show
from roadproof.report.page.book import Book
from roadproof.report.page.markup import Content, Markup, joined, table, tag
from roadproof.report.page.pieces import behind, cell, counts, folded, matrix, verdict, words_in
from roadproof.report.page.results import Result

Finding = Mapping[str, Any]


def explored(result: Result, book: Book, words: Mapping[int, str]) -> Markup:
    """Every exploration: its values, where they change, and the extremes of measures."""
    return joined(
        [
            _exploration(f"{result.id}-{k}", x, result, book, words)
            for k, x in enumerate(result.data.get("explored", ()))
        ]
    )


def _exploration(place: str, x: Finding, result: Result, book: Book, words: Mapping[int, str]) -> Markup:
    number = x.get("scenario")
    called = f"scenario {number} {words.get(number, '')}".rstrip() if isinstance(number, int) else ""
    parts: list[Content] = [tag("h3", called, " ", tag("code", x.get("formula")))]
    vary: Sequence[Finding] = x.get("vary", ())
    values: Sequence[Finding] = x.get("values", ())
    if vary and values:
        parts += [
            tag("p", counts(words_in(values))),
            _values(place, vary, values),
            *_told_boundaries(x, vary),
        ]
    parts += [_extremes(place, x["extremes"], vary)] if x.get("extremes") else []
    for k, one in enumerate(values):
        parts.append(_behind(f"value-{place}-{k}", _at(one, vary), one, result, book))
    for k, one in enumerate(x.get("boundaries", ())):
        for name in ("held", "missed", "surely"):
            found = one.get(name)
            if found and found not in values:
                parts.append(_behind(f"{name}-{place}-{k}", _at(found, vary), found, result, book))
    for k, one in enumerate(x.get("extremes", ())):
        for name in ("best", "missed", "surely"):
            found = one.get(name)
            if found:
                where = "".join(f", {y}" for y in _values_at(one.get("point") or (), vary))
                said = f"{one['sense']} {one['measure']} = {_measured(found, one)}{where}"
                parts.append(_behind(f"{name}-{place}-x{k}", said, found, result, book))
    return joined(parts)


def _values(place: str, vary: Sequence[Finding], values: Sequence[Finding]) -> Markup:
    """A row for one parameter, a matrix for two; each value leads to what is behind it."""
    first = list(dict.fromkeys(x["at"][0] for x in values))
    second = list(dict.fromkeys(x["at"][1] if len(vary) > 1 else "" for x in values))
    known = {(x["at"][0], x["at"][1] if len(vary) > 1 else ""): k for k, x in enumerate(values)}
    rows = []
    for other in second:
        title = f"{vary[1]['name']} = {_number(other, vary[1]['unit'])}" if len(vary) > 1 else "drive"
        cells: list[Content] = [tag("th", title, scope="row")]
        for value in first:
            k = known.get((value, other))
            told = "" if k is None else f"{_at(values[k], vary)}: {values[k]['verdict']}"
            cells.append(tag("td") if k is None else cell(values[k]["verdict"], told, f"value-{place}-{k}"))
        rows.append(cells)
    head = [tag("th", _number(x), scope="col") for x in first]
    below = tag("p", f"Columns: {vary[0]['name']}, in {vary[0]['unit'] or 'no unit'}.", class_="faint")
    return joined([matrix(head, rows), below])


def _told_boundaries(x: Finding, vary: Sequence[Finding]) -> Iterator[Markup]:
    for one in x.get("boundaries", ()):
        surely = one.get("surely")
        sure = f"; surely none at {_at(surely, vary)}" if surely else ""
        held, missed = _at(one["held"], vary), _at(one["missed"], vary)
        yield tag("p", f"There is a drive at {held}, none was found at {missed}{sure}.")


def _extremes(place: str, extremes: Sequence[Finding], vary: Sequence[Finding]) -> Markup:
    rows = []
    for k, x in enumerate(extremes):
        at = ", ".join(_values_at(x.get("point") or (), vary))
        when = x.get("when") or "at time 0"
        sides = [_side(f"{name}-{place}-x{k}", x.get(name), x) for name in ("best", "missed", "surely")]
        note = "a drive passes every value that is asked for" if x.get("endless") else ""
        rows.append((f"{x['sense']} {x['measure']}", when, at, *sides, note))
    head = ("what", "when", "where", "a drive reaches", "none found at", "surely none at", "")
    return table(head, rows)


def _side(target: str, found: Finding | None, extreme: Finding) -> Content:
    return "–" if found is None else tag("a", _measured(found, extreme), href=f"#{target}")


def _measured(found: Finding, extreme: Finding) -> str:
    return _number(found["at"][0], extreme.get("unit", ""))


def _behind(target: str, said: str, found: Finding, result: Result, book: Book) -> Markup:
    inside: list[Content] = [tag("p", tag("code", found.get("formula")))]
    inside += [tag("p", found["reason"])] if found.get("reason") else []
    summary = (verdict(found.get("verdict")), f" {said}")
    return folded(summary, *inside, *behind(found, result, book), id=target)


def _at(found: Finding, vary: Sequence[Finding]) -> str:
    return ", ".join(_values_at(found["at"], vary))


def _values_at(at: Sequence[str], vary: Sequence[Finding]) -> Iterator[str]:
    for value, x in zip(at, vary, strict=True):
        yield f"{x['name']} = {_number(value, x['unit'])}"


def _number(value: str, unit: str = "") -> str:
    return f"{show(Fraction(value))} {unit if unit != 'unitless' else ''}".rstrip()
