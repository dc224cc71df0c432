"""Which scenarios imply which, and which parts they could do without, each with its evidence."""

from collections.abc import Mapping, Sequence
from typing import Any

from roadproof.report.page.book import Book
from roadproof.report.page.markup import Content, Markup, joined, table, tag
from roadproof.report.page.pieces import behind, cell, counts, filtered, folded, matrix, verdict, words_in
from roadproof.report.page.results import Result


def order(result: Result, book: Book, words: Mapping[int, str]) -> Markup:
    """A matrix of who implies whom: behind each cell the proof, or a drive on which that is false."""
    data = result.data
    kinds = data.get("kinds", ())
    proved, drives = data.get("proved", ()), data.get("drives", ())
    edges = {(x["from"], x["to"]): x for x in data.get("edges", ())}
    targets: dict[tuple[str, str], tuple[str, str]] = {}
    for x in data.get("missing", ()):
        targets[x["from"], x["to"]] = ("REFUTED", f"against-{result.id}-{x['drives'][0]}")
    for k, x in enumerate(proved):
        targets[x["from"], x["to"]] = ("PROVED", f"implied-{result.id}-{k}")
    doubts = {(x["from"], x["to"]): x["reason"] for x in data.get("doubts", ())}
    names = [kind[0] for kind in kinds]
    rows = [
        [_scenario(one, words, "row"), *(_implies(one, x, targets, doubts) for x in names)] for one in names
    ]
    parts: list[Content] = [
        tag(
            "p",
            f"{len(names)} formulas: {len(proved)} implications are proved, {len(data.get('missing', ()))} "
            f"refuted by {len(drives)} drives, {len(doubts)} in doubt. In a row: ✓ the scenario implies that "
            "of the column, ✗ a drive has the one without the other. Each cell leads to the proof or the "
            "drive.",
        ),
        matrix([_scenario(x, words, "col") for x in names], rows),
    ]
    same = [", ".join(kind) for kind in kinds if len(kind) > 1]
    parts += [tag("p", tag("b", "One formula: "), "; ".join(same))] if same else []
    called = [(name, words[number]) for name in names if (number := _number(name)) in words]
    parts += [folded(("What the scenarios are called",), table(("", ""), called))] if called else []
    for k, x in enumerate(proved):
        told = "" if (x["from"], x["to"]) in edges else " (it follows from others)"
        summary = (verdict("PROVED"), " ", tag("b", f"{x['from']} implies {x['to']}"), told)
        inside = (tag("p", tag("code", x.get("claim"))), *behind(x, result, book))
        parts.append(folded(summary, *inside, id=f"implied-{result.id}-{k}"))
    for x in drives:
        shown = (tag("b", f"{x['holds']} without {', '.join(x['fails'])}"),)
        parts.append(folded(shown, *behind(x, result, book), id=f"against-{result.id}-{x['number']}"))
    parts += [
        tag("p", verdict("UNKNOWN"), f" {one} implies {two}: {why}") for (one, two), why in doubts.items()
    ]
    return joined(parts)


def _implies(
    one: str,
    two: str,
    targets: Mapping[tuple[str, str], tuple[str, str]],
    doubts: Mapping[tuple[str, str], str],
) -> Markup:
    if one == two:
        return tag("td", "=", class_="none", title="itself")
    word, target = targets.get((one, two), ("UNKNOWN", None))
    said = {"PROVED": "implies", "REFUTED": "does not always imply"}.get(word, "may imply")
    reason = doubts.get((one, two))
    return cell(word, f"{one} {said} {two}{f': {reason}' if reason else ''}", target)


def _number(name: str) -> int:
    return int(name.partition("@")[0])


def _scenario(name: str, words: Mapping[int, str], scope: str) -> Markup:
    return tag("th", name, scope=scope, title=words.get(_number(name)))


def redundancy(result: Result, book: Book, words: Mapping[int, str]) -> Markup:
    """The parts of scenarios: which could be left out, by proof, and drives that need the others."""
    found: Sequence[Mapping[str, Any]] = result.data.get("verdicts", ())
    entries = sorted(found, key=lambda x: x.get("redundant") is False)
    kept = sum(x.get("redundant") is False for x in entries)
    spare = sum(x.get("redundant") is True for x in entries)
    doubt = len(entries) - kept - spare
    told = f"{len(entries)} changes: {spare} proved to change nothing, {kept} needed, {doubt} in doubt."
    rows, shown = [], []
    for k, x in enumerate(entries):
        target = f"change-{result.id}-{k}"
        put = f"as {'true' if x.get('as') else 'false'}"
        link = tag("a", _REDUNDANT[x.get("redundant")], href=f"#{target}")
        where = " › ".join(x.get("where") or ())
        name = joined([x.get("scenario"), f" {words.get(x.get('scenario') or -1, '')}".rstrip()])
        rows.append((link, name, where, tag("code", x.get("part")), put, x.get("assuming") or ""))
        summary = (
            verdict(x.get("verdict")),
            f" scenario {x.get('scenario')}: ",
            tag("code", x.get("part")),
            f" {put}",
        )
        inside: list[Content] = [tag("p", "That it stays what it is: ", tag("code", x.get("claim")))]
        inside += [tag("p", x["reason"])] if x.get("reason") else []
        if x.get("trace") and not x.get("drive"):
            inside.append(
                tag("p", "Refuted by a trace over points in time, which may jump; it is in the result.")
            )
        shown.append(folded(summary, *inside, *behind(x, result, book), id=target))
    head = ("", "scenario", "where", "part", "put in its place", "where it is assumed that")
    return joined([tag("p", told, " ", counts(words_in(entries))), filtered(table(head, rows)), *shown])


_REDUNDANT: Mapping[object, str] = {
    True: "✗\u00a0could\u00a0go",
    False: "✓\u00a0needed",
    None: "?\u00a0in\u00a0doubt",
}
