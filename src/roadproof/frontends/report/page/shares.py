"""Classes with their shares, and recordings: tables and bars."""

from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction

from roadproof.evidence.answers.classify import Index
from roadproof.evidence.answers.traffic import Answer, Prediction, Row
from roadproof.evidence.codec import read
from roadproof.frontends.report.explore import show
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import bar, evidence_of, folded, short, verdict
from roadproof.frontends.report.page.results import Result


def classes(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """Classes that exclude each other: the share of each, a drive for each, and what is proved of them."""
    index = read(Index, result.data, result.name)
    totals: Counter[int] = Counter()  # situations by how many vehicles they have
    for x in index.classes:
        totals[len(x.vehicles)] += x.situations or 0
    counted_at_all = totals.total() > 0
    rows = []
    for x in index.classes:
        count, total = x.situations, totals[len(x.vehicles)]
        share = (
            "" if count is None or not total else bar(count / total, f"{count}, {100 * count / total:.1f} %")
        )
        shares = (x.traces, share) if counted_at_all else ()
        rows.append((verdict(x.verdict), tag("b", x.name), x.description, *shares))
    counted = Counter((claim.kind, claim.verdict) for claim in index.claims)
    told = joined([joined([f"{kind}: {n} ", verdict(word)]) for (kind, word), n in counted.items()], "; ")
    file = folded(("The classes as a specification file",), tag("pre", index.text)) if index.text else None
    drives = []
    for x in index.classes:
        inside = (tag("p", tag("code", x.formula)), *evidence_of(result, context, x.drive))
        drives.append(folded((verdict(x.verdict), " ", tag("b", x.name)), *inside))
    head = ("verdict", "class", "what happens", *_SHARES[: 2 * counted_at_all])
    return joined([tag("p", told), table(head, rows), file, *drives])


_SHARES = ("traces", "share of situations with as many vehicles")


def traffic(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """The results table of recordings, with recall as bars, and what detectors of earlier works report."""
    answer = read(Answer, result.data, result.name)
    facts = {
        "recordings": answer.recordings,
        "vehicles": answer.vehicles,
        "samples": answer.samples,
        "pairs that violate the RSS distance": answer.violating,
        "undecided": answer.undecided,
    }
    told = "; ".join(f"{name}: {count}" for name, count in facts.items())
    numbers = list(dict.fromkeys(n for x in answer.table for n in x.scenarios))
    named = [tag("span", n, title=words.get(int(n))) for n in numbers]
    head = ("road sector", "minDanger", "set", "traces", "matching", "recall", *named)
    parts: list[Content] = [tag("p", told), table(head, [_row(x, numbers) for x in answer.table])]
    if answer.detectors:
        most = max([*answer.detectors.values(), 1])
        rows = [(name, bar(n / most, str(n))) for name, n in answer.detectors.items()]
        parts.append(tag("h3", "Pairs that detectors of earlier works report"))
        parts.append(table(("detector", "pairs"), rows))
    parts += _drivers(answer.drivers or ())
    called = [(n, words[int(n)]) for n in numbers if words.get(int(n))]
    parts += [folded(("What the scenarios are called",), table(("", ""), called))] if called else []
    if answer.checks.broken:
        told = f"Facts that do not hold, which is our fault: {short(answer.checks.broken)}"
        parts.append(tag("p", told, class_="wrong"))
    return joined(parts)


def _drivers(entries: Sequence[Prediction]) -> list[Content]:
    """What driver models say of matches, where some were asked for."""
    if not entries:
        return []
    rows: list[list[Content]] = []
    for x in entries:
        counts = (x.preventable, x.unpreventable, x.not_foreseen)
        told = f"{100 * counts[1] / sum(counts):.1f} %" if sum(counts) else "–"
        share = bar(counts[1] / sum(counts), told) if sum(counts) else told
        rows.append([_seconds(x.min_danger), x.set, x.scenario, x.driver, *counts, share])
    labels = ("preventable", "unpreventable", "not foreseen")
    head = ("minDanger", "set", "scenario", "model", *labels, "share unpreventable")
    below = (
        "From the state in which the manoeuvre begins: would a driver of SV who does what the model says "
        "prevent a collision? Matches count, so a pair may count in both roles; floating point, no evidence."
    )
    title = "What driver models say of matches"
    return [tag("h3", title), table(head, rows), tag("p", below, class_="faint")]


def _row(x: Row, numbers: Sequence[str]) -> list[Content]:
    share = "–" if x.recall is None else bar(x.recall, f"{100 * x.recall:.1f} %")
    found = [x.scenarios.get(n) for n in numbers]
    return [x.sector, _seconds(x.min_danger), x.set, x.traces, x.matching, share, *found]


def _seconds(value: str) -> str:
    return f"{show(Fraction(value))} s"
