"""How far values of parameters and measures can go: each value leads to its drive or to what clashes."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from roadproof.evidence.answers.explore import Exploration, Extreme, Finding, Index, Variation
from roadproof.evidence.codec import read
from roadproof.frontends.report.explore import show
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import cell, counts, evidence_of, folded, matrix, verdict
from roadproof.frontends.report.page.results import Result


def explored(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """Every exploration: its values, where they change, and the extremes of measures."""
    every = read(Index, result.data, result.name).explored
    return joined([_exploration(f"{result.id}-{k}", x, result, context, words) for k, x in enumerate(every)])


def _exploration(
    place: str, x: Exploration, result: Result, context: PageContext, words: Mapping[int, str]
) -> Markup:
    called = "" if x.scenario is None else f"scenario {x.scenario} {words.get(x.scenario, '')}".rstrip()
    parts: list[Content] = [tag("h3", called, " ", tag("code", x.formula))]
    if x.vary and x.values:
        counted = counts(one.verdict for one in x.values)
        parts += [tag("p", counted), _values(place, x.vary, x.values), *_told_boundaries(x)]
    parts += [_extremes(place, x.extremes, x.vary)] if x.extremes else []
    for k, one in enumerate(x.values):
        parts.append(_behind(f"value-{place}-{k}", _at(one, x.vary), one, result, context))
    for k, boundary in enumerate(x.boundaries):
        sides = {"held": boundary.held, "missed": boundary.missed, "surely": boundary.surely}
        for name, found in sides.items():
            if found and found not in x.values:
                parts.append(_behind(f"{name}-{place}-{k}", _at(found, x.vary), found, result, context))
    for k, extreme in enumerate(x.extremes):
        for name, found in extreme.sides.items():
            if found:
                where = "".join(f", {y}" for y in _values_at(extreme.point, x.vary))
                said = f"{extreme.sense} {extreme.measure} = {_measured(found, extreme)}{where}"
                parts.append(_behind(f"{name}-{place}-x{k}", said, found, result, context))
    return joined(parts)


def _values(place: str, vary: Sequence[Variation], values: Sequence[Finding]) -> Markup:
    """A row for one parameter, a matrix for two; each value leads to what is behind it."""
    first = list(dict.fromkeys(x.at[0] for x in values))
    second = list(dict.fromkeys(x.at[1] if len(vary) > 1 else "" for x in values))
    known = {(x.at[0], x.at[1] if len(vary) > 1 else ""): k for k, x in enumerate(values)}
    rows = []
    for other in second:
        title = f"{vary[1].name} = {_number(other, vary[1].unit)}" if len(vary) > 1 else "drive"
        cells: list[Content] = [tag("th", title, scope="row")]
        for value in first:
            k = known.get((value, other))
            told = "" if k is None else f"{_at(values[k], vary)}: {values[k].verdict}"
            cells.append(tag("td") if k is None else cell(values[k].verdict, told, f"value-{place}-{k}"))
        rows.append(cells)
    head = [tag("th", _number(x), scope="col") for x in first]
    below = tag("p", f"Columns: {vary[0].name}, in {vary[0].unit or 'no unit'}.", class_="faint")
    return joined([matrix(head, rows), below])


def _told_boundaries(x: Exploration) -> Iterator[Markup]:
    for one in x.boundaries:
        sure = f"; surely none at {_at(one.surely, x.vary)}" if one.surely else ""
        held, missed = _at(one.held, x.vary), _at(one.missed, x.vary)
        yield tag("p", f"There is a drive at {held}, none was found at {missed}{sure}.")


def _extremes(place: str, extremes: Sequence[Extreme], vary: Sequence[Variation]) -> Markup:
    rows = []
    for k, x in enumerate(extremes):
        at = ", ".join(_values_at(x.point, vary))
        sides = [_side(f"{name}-{place}-x{k}", found, x) for name, found in x.sides.items()]
        note = "a drive passes every value that is asked for" if x.endless else ""
        rows.append((f"{x.sense} {x.measure}", x.when or "at time 0", at, *sides, note))
    head = ("what", "when", "where", "a drive reaches", "none found at", "surely none at", "")
    return table(head, rows)


def _side(target: str, found: Finding | None, extreme: Extreme) -> Content:
    return "–" if found is None else tag("a", _measured(found, extreme), href=f"#{target}")


def _measured(found: Finding, extreme: Extreme) -> str:
    return _number(found.at[0], extreme.unit) if found.at else "no value"


def _behind(target: str, said: str, found: Finding, result: Result, context: PageContext) -> Markup:
    inside: list[Content] = [tag("p", tag("code", found.formula))]
    inside += [tag("p", found.reason)] if found.reason else []
    shown = evidence_of(result, context, found.drive, found.certificate)
    return folded((verdict(found.verdict), f" {said}"), *inside, *shown, id=target)


def _at(found: Finding, vary: Sequence[Variation]) -> str:
    return ", ".join(_values_at(found.at, vary))


def _values_at(at: Sequence[str], vary: Sequence[Variation]) -> Iterator[str]:
    for value, x in zip(at, vary, strict=True):
        yield f"{x.name} = {_number(value, x.unit)}"


def _number(value: str, unit: str = "") -> str:
    return f"{show(Fraction(value))} {unit if unit != 'unitless' else ''}".rstrip()
