"""Which scenarios imply which, and which parts they could do without, each with its evidence."""

from collections.abc import Mapping

from roadproof.evidence.answers import order as implications
from roadproof.evidence.answers import redundancy as parts_of_scenarios
from roadproof.evidence.codec import read
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import (
    cell,
    counts,
    evidence_of,
    filtered,
    folded,
    matrix,
    verdict,
)
from roadproof.frontends.report.page.results import Result


def order(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """A matrix of who implies whom: behind each cell the proof, or a drive on which that is false."""
    index = read(implications.Index, result.data, result.name)
    edges = {(x.above, x.below) for x in index.edges}
    targets: dict[tuple[str, str], tuple[str, str]] = {}
    for missing in index.missing:
        targets[missing.above, missing.below] = ("REFUTED", f"against-{result.id}-{missing.drives[0]}")
    for k, proof in enumerate(index.proved):
        targets[proof.above, proof.below] = ("PROVED", f"implied-{result.id}-{k}")
    doubts = {(x.above, x.below): x.reason for x in index.doubts}
    names = [kind[0] for kind in index.kinds]
    rows = [
        [_scenario(one, words, "row"), *(_implies(one, x, targets, doubts) for x in names)] for one in names
    ]
    parts: list[Content] = [
        tag(
            "p",
            f"{len(names)} formulas: {len(index.proved)} implications are proved, {len(index.missing)} "
            f"refuted by {len(index.drives)} drives, {len(doubts)} in doubt. In a row: ✓ the scenario "
            "implies that of the column, ✗ a drive has the one without the other. Each cell leads to the "
            "proof or the drive.",
        ),
        matrix([_scenario(x, words, "col") for x in names], rows),
    ]
    same = [", ".join(kind) for kind in index.kinds if len(kind) > 1]
    parts += [tag("p", tag("b", "One formula: "), "; ".join(same))] if same else []
    called = [(name, words[number]) for name in names if (number := _number(name)) in words]
    parts += [folded(("What the scenarios are called",), table(("", ""), called))] if called else []
    for k, proof in enumerate(index.proved):
        told = "" if (proof.above, proof.below) in edges else " (it follows from others)"
        summary = (verdict("PROVED"), " ", tag("b", f"{proof.above} implies {proof.below}"), told)
        shown = evidence_of(result, context, certificate=proof.certificate)
        parts.append(
            folded(summary, tag("p", tag("code", proof.claim)), *shown, id=f"implied-{result.id}-{k}")
        )
    for drive in index.drives:
        title = (tag("b", f"{drive.holds} without {', '.join(drive.fails)}"),)
        shown = evidence_of(result, context, drive.drive)
        parts.append(folded(title, *shown, id=f"against-{result.id}-{drive.number}"))
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


def redundancy(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """The parts of scenarios: which could be left out, by proof, and drives that need the others."""
    every = read(parts_of_scenarios.Index, result.data, result.name).verdicts
    entries = sorted(every, key=lambda x: x.redundant is False)
    kept = sum(x.redundant is False for x in entries)
    spare = sum(x.redundant is True for x in entries)
    doubt = len(entries) - kept - spare
    told = f"{len(entries)} changes: {spare} proved to change nothing, {kept} needed, {doubt} in doubt."
    rows, shown = [], []
    for k, x in enumerate(entries):
        target = f"change-{result.id}-{k}"
        put = f"as {'true' if x.value else 'false'}"
        link = tag("a", _REDUNDANT[x.redundant], href=f"#{target}")
        name = f"{x.scenario} {words.get(x.scenario, '')}".rstrip()
        rows.append((link, name, " › ".join(x.where), tag("code", x.part), put, x.assuming))
        summary = (verdict(x.verdict), f" scenario {x.scenario}: ", tag("code", x.part), f" {put}")
        inside: list[Content] = [tag("p", "That it stays what it is: ", tag("code", x.claim))]
        inside += [tag("p", x.reason)] if x.reason else []
        if x.trace and not x.drive:
            inside.append(
                tag("p", "Refuted by a trace over points in time, which may jump; it is in the result.")
            )
        shown.append(
            folded(summary, *inside, *evidence_of(result, context, x.drive, x.certificate), id=target)
        )
    head = ("", "scenario", "where", "part", "put in its place", "where it is assumed that")
    counted = counts(x.verdict for x in entries)
    return joined([tag("p", told, " ", counted), filtered(table(head, rows)), *shown])


_REDUNDANT: Mapping[object, str] = {
    True: "✗\u00a0could\u00a0go",
    False: "✓\u00a0needed",
    None: "?\u00a0in\u00a0doubt",
}
