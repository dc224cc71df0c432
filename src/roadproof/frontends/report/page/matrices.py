"""Matrices with what is behind each cell: which scenarios hold together, and which dangers are missed."""

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from roadproof.evidence.answers import coverage as gaps
from roadproof.evidence.answers.overlap import Index, Pair
from roadproof.evidence.codec import read
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import cell, counts, evidence_of, folded, matrix, short, verdict
from roadproof.frontends.report.page.results import Result

End: TypeAlias = tuple[int, str]


def overlap(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """Every pair of scenarios: a cell each, and behind it the drive or the clash."""
    pairs = read(Index, result.data, result.name).verdicts
    several = len({x for pair in pairs for x in (pair.set_a, pair.set_b)}) > 1

    def ends(pair: Pair) -> tuple[End, End]:
        return (pair.a, pair.set_a if several else ""), (pair.b, pair.set_b if several else "")

    known = {ends(x): k for k, x in enumerate(pairs)}
    order = sorted({end for x in known for end in x}, key=lambda end: (end[1], end[0]))
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
            tag("p", counts(x.verdict for x in pairs), ". Each cell leads to its drive, or to what clashes."),
            matrix(columns, rows),
            folded(("What the scenarios are called",), table(("", ""), called)) if called else None,
            *(_pair(result, k, x, context, words) for k, x in enumerate(pairs)),
        ]
    )


def _heading(end: End, words: Mapping[int, str], scope: str) -> Markup:
    return tag("th", f"{end[0]} {end[1]}".strip(), scope=scope, title=words.get(end[0]))


def _cell(result: Result, place: int, pair: Pair) -> Markup:
    return cell(pair.verdict, f"{pair.a} and {pair.b}: {pair.verdict}", _id(result, "pair", place))


def _id(result: Result, what: str, place: object) -> str:
    return f"{what}-{result.id}-{place}"


def _pair(result: Result, place: int, pair: Pair, context: PageContext, words: Mapping[int, str]) -> Markup:
    one, two = (tag("b", f"{x} {words.get(x, '')}".strip()) for x in (pair.a, pair.b))
    inside: list[Content] = [tag("p", tag("code", pair.formula))]
    inside += [tag("p", pair.reason)] if pair.reason else []
    cores = [(x.formula, x.parts) for x in pair.cores]
    inside += evidence_of(result, context, pair.drive, pair.certificate, cores)
    return folded((verdict(pair.verdict), " ", one, " and ", two), *inside, id=_id(result, "pair", place))


def coverage(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """Which disturbances a set misses: classes of gaps by scenario, and behind each cell a drive."""
    index = read(gaps.Index, result.data, result.name)
    count = len(index.gaps)
    told = (
        f": {count} gap{'s' if count != 1 else ''}, each with a judged drive."
        if index.gaps
        else ": no gap was found."
    )
    parts: list[Content] = [tag("p", verdict(index.verdict), told)]
    for claim in index.claims:
        inside: list[Content] = [tag("p", claim.reason)] if claim.reason else []
        summary = (verdict(claim.verdict), " ", tag("code", claim.claim))
        parts.append(folded(summary, *inside, *evidence_of(result, context, certificate=claim.certificate)))
    parts += [_classes(result, index.classes, words)] if index.classes else []
    for gap in index.gaps:
        where = f" on {short(gap.road)}, caught by {short(gap.caught_by)}"
        inside = [tag("p", tag("code", gap.formula)), *evidence_of(result, context, gap.drive)]
        title = (tag("b", f"gap {gap.number}"), where)
        parts.append(folded(title, *inside, id=_id(result, "gap", gap.number)))
    notes = [(x.scenario, x.description, x.reason) for x in index.classes if x.reason and x.gaps]
    parts += [table(("scenario", "what", "note"), notes)] if notes else []
    parts += [_no_gap(result, k, x, context) for k, x in enumerate(index.classes) if not x.gaps]
    return joined(parts)


def _no_gap(result: Result, place: int, x: gaps.CountedClass, context: PageContext) -> Markup:
    """A class without a drive: what was proved of it, or why it is not known."""
    told = f" scenario {x.scenario}, {x.component}: " if x.scenario is not None else " "
    inside: list[Content] = [tag("p", tag("code", x.claim))] if x.claim else []
    inside += [tag("p", x.reason)] if x.reason else []
    summary = (verdict(x.verdict), told, x.condition or x.description)
    shown = evidence_of(result, context, certificate=x.certificate)
    return folded(summary, *inside, *shown, id=_id(result, "class", place))


def _classes(result: Result, classes: Sequence[gaps.CountedClass], words: Mapping[int, str]) -> Markup:
    scenarios = list(dict.fromkeys(x.scenario for x in classes))
    kinds = list(dict.fromkeys((x.component, x.condition) for x in classes))
    places = {(x.scenario, x.component, x.condition): k for k, x in enumerate(classes)}
    rows: list[list[Content]] = []
    for kind in kinds:
        cells: list[Content] = [tag("th", " ".join(x for x in kind if x), scope="row")]
        for scenario in scenarios:
            k = places.get((scenario, *kind))
            cells.append(tag("td") if k is None else _gap_cell(result, k, classes[k]))
        rows.append(cells)
    columns = [tag("th", x or "other", scope="col", title=words.get(x or -1)) for x in scenarios]
    told = "What of which scenario is false: ■ a danger that is missed so, · proved that there is none. "
    told += "Each cell leads to its drive, or to what was proved."
    return joined([tag("p", told), matrix(columns, rows)])


def _gap_cell(result: Result, place: int, x: gaps.CountedClass) -> Markup:
    target = _id(result, "gap", x.gaps[0]) if x.gaps else _id(result, "class", place)
    drives = f", gap {', '.join(map(str, x.gaps))}" if x.gaps else ""
    return cell(x.verdict, f"{x.description}: {x.verdict}{drives}", target)
