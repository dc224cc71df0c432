"""A short text that answers the paper's research questions from the numbers of an evaluation.

Every sentence is made from counts of this run; where the data cannot answer, the text says so.
"""

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from roadproof.extensions.traffic.evaluate.results import decimal, scenario_words
from roadproof.extensions.traffic.evaluate.totals import ResultsRow, Totals
from roadproof.extensions.traffic.report.traffic import (
    COMPARISON,
    KINDS,
    MARK,
    METRICS,
    NONE_FAILED,
    RECALL_WITHOUT_FILTER,
    VIOLATING_PAIRS,
    Share,
    interval,
    missing,
    paper_row,
    percent,
    rss_row,
    traces_of,
)
from roadproof.extensions.traffic.scenario_parts import DETECTORS


def answer_questions(totals: Totals, failed: Mapping[str, str] = NONE_FAILED) -> str:
    """Markdown: RQ1 to RQ5 of the paper, the paper's figures in brackets, and the facts of semantics §6."""
    parts = [
        f"# What the numbers say\n\nFigures in brackets are {MARK}."
        + (f"\n\n{missing(failed)}" if failed else ""),
        "## RQ1: are the descriptions adequate for detecting disturbances?\n\n" + _detecting(totals),
        "## RQ2: are they adequate for classifying?\n\n" + _classifying(totals),
        "## RQ3: precision and recall\n\n" + _precision(totals),
        "## RQ4: does minDanger matter?\n\n" + _min_danger(totals),
        "## RQ5: beside earlier definitions\n\n" + _earlier(totals),
        *_other_sectors(totals),
        "## Facts checked on this run\n\n" + _listed(facts(totals)),
        *_notes(totals),
    ]
    return "\n\n".join(parts) + "\n"


def _listed(lines: Iterable[str]) -> str:
    return "\n".join(f"- {line}" for line in lines)


def _shown(row: ResultsRow) -> str:
    known = paper_row(row)
    theirs = f" [{known.recall}]" if known else ""
    return f"{row.set_name} {_share(row, theirs)}"


def _share(row: ResultsRow, theirs: str = "") -> str:
    """The recall of a row with its counts and bounds."""
    share = Share(row.matching, row.traces, traces_of(row))
    return f"{share.percent}{theirs} ({share.count}{_within(row.bounds, row.matching, row.traces)})"


def _within(bounds: tuple[int, int], matching: int, whole: int) -> str:
    """The least and the greatest share that match, as places are off; empty where that changes nothing."""
    return "" if bounds == (matching, matching) else f"; {interval(bounds, whole)} within errors of places"


def _without_match(row: ResultsRow) -> str:
    """Return how many traces of a row match no scenario of two vehicles."""
    share = Share(row.traces - row.matching, row.traces, traces_of(row))
    may = f", but {row.possible} of these may, as places are off" if row.possible else ""
    return f"{share.count} match no scenario of {row.set_name} with two vehicles{may}."


def _of_danger(totals: Totals) -> Iterator[tuple[str, list[ResultsRow]]]:
    for value in totals.settings.min_danger:
        yield decimal(value), [row for row in totals.rows if row.min_danger == value]


def _detecting(totals: Totals) -> str:
    if not any(row.traces for row in totals.rows):
        return "No trace has a danger that arises from safety, so these recordings cannot tell."
    lines = []
    for value, rows in _of_danger(totals):
        lines.append(f"minDanger {value}: recall " + ", ".join(map(_shown, rows)) + ".")
        lines.append(f"minDanger {value}: {_without_match(rows[-1])}")
    return _listed(lines)


def _together(row: ResultsRow) -> Iterator[tuple[tuple[int, int], int]]:
    """All combinations of two scenarios that some trace matches, the most frequent first."""
    yield from sorted(row.together.items(), key=lambda item: (-item[1], item[0]))


def _classifying(totals: Totals) -> str:
    lines = []
    for value, rows in _of_danger(totals):
        for row in rows:
            if not row.matching_with_three:
                continue
            several = ", ".join(f"{i}-{j} {n}" for (i, j), n in _together(row))
            matching = f"traces that match a scenario of the {row.sector}"
            share = f"{Share(row.several, row.matching_with_three, matching).count} match several"
            lines.append(
                f"minDanger {value}, {row.set_name}: {share}" + (f"; {several}." if several else ".")
            )
    if not lines:
        return "No trace matches, so these recordings cannot tell."
    named = (f"{number} {x.title}" for number, x in scenario_words(totals.settings).items() if x.title)
    return _listed(lines) + f"\n\nScenarios: {'; '.join(named)}."


def _precision(totals: Totals) -> str:
    rows = [row for row in totals.rows if row.traces]
    outside = sum("is no disturbance" in line for line in totals.broken)
    lines = [
        f"{outside} matches lie outside the disturbance traces; precision is 100% by construction and was "
        "checked on every match."
        if not outside
        else f"{outside} matches lie outside the disturbance traces, which must not be."
    ]
    for row in rows:
        known = paper_row(row) if len(totals.shown) == 1 else None
        theirs = f" [{percent(known.matching, VIOLATING_PAIRS)}; {RECALL_WITHOUT_FILTER}]" if known else ""
        danger = totals.settings.min_danger.index(row.min_danger)
        matching = totals.matching_violating[danger, row.set_name]
        share = Share(matching, totals.violating, "violating pairs in all road sectors")
        bounds = totals.violating_bounds.get((danger, row.set_name), (matching, matching))
        within = _within(bounds, matching, totals.violating)
        lines.append(
            f"Without the filter dangerArises, minDanger {decimal(row.min_danger)}, {row.set_name}: "
            f"{share.percent}{theirs} ({share.count}{within}) match a scenario with two vehicles."
        )
    return _listed(lines)


def _min_danger(totals: Totals) -> str:
    if len(totals.settings.min_danger) < 2:
        return "One minDanger was asked for, so this run cannot tell."
    lines = []
    for name in totals.settings.sets:
        rows = [row for row in totals.rows if row.set_name == name and row.traces]
        shares = [100 * row.matching / row.traces for row in rows]
        if len(shares) > 1:
            values = ", ".join(f"{decimal(r.min_danger)}: {_share(r)}" for r in rows)
            lines.append(f"{name}: {values}; {max(shares) - min(shares):.1f} points between them.")
    return _listed(lines) or "Too few traces to tell."


def _earlier(totals: Totals) -> str:
    row = rss_row(totals)
    if row is None or not totals.settings.detectors:
        return "The detectors of earlier works or the set ext were not asked for."
    lines = [f"Detectors count pairs of whole recordings, scenarios count {traces_of(row)}."]
    for kind, number in KINDS.items():
        detected = ", ".join(
            f"{metric} {totals.detected[DETECTORS[kind][metric]]} [{COMPARISON[kind][metric]}]"
            for metric in METRICS
        )
        ours = f"{row.scenarios[number]} [{COMPARISON[kind]['RSS']}]"
        title = scenario_words(totals.settings)[number].title
        lines.append(f"{kind}: {detected}; scenario {number} of ext{title and f' ({title})'} {ours}.")
    return _listed(lines)


def _other_sectors(totals: Totals) -> Iterator[str]:
    """Recall in the other road sectors, and how many traces match nothing in all of them together."""
    first, *others = totals.shown.items()
    if not others:
        return
    lines: list[str] = []
    for k, value in enumerate(totals.settings.min_danger):
        for name, rows in others:
            here = [row for row in rows if row.min_danger == value]
            lines.append(f"{name}, minDanger {decimal(value)}: recall {', '.join(map(_shown, here))}.")
            lines.append(f"{name}, minDanger {decimal(value)}: {_without_match(here[-1])}")
        last, traces = totals.settings.sets[-1], totals.traces[k]
        unmatched = Share(traces - totals.matching[k, last], traces, "traces in all road sectors")
        lines.append(
            f"all road sectors, minDanger {decimal(value)}: {unmatched.count} match no scenario of {last} "
            "with two vehicles."
        )
    about = f"RQ1, RQ2, RQ4 and RQ5 are about the {first[0]}."
    yield f"## Other road sectors\n\n{about}\n\n{_listed(lines)}"


def _notes(totals: Totals) -> Iterator[str]:
    if totals.notes:
        each = (f"recording {name}: {note}" for name, notes in totals.notes.items() for note in notes)
        yield "## What is odd in the recordings\n\n" + _listed(each)


def facts(totals: Totals) -> list[str]:
    """The relations that were checked on a run (docs/explanation/semantics.md, section 6), a line each."""
    sets = " ⊆ ".join(name for name in ("base", "extA", "ext") if name in totals.settings.sets)
    verdict = f"{len(totals.broken)} violations: CROSSCHECK-FAILED" if totals.broken else "no violation"
    return [
        f"{sets} for each pair and scenario, s3 = s4 in base, every match a disturbance: {verdict}.",
        *totals.broken,
        f"{len({entry[:3] for entry in totals.unequal_3_4})} pairs match only one of scenarios 3 and 4 in "
        "base because the two vehicles start in different lanes, so that L differs between the roles"
        + (":" if totals.unequal_3_4 else "."),
        *(
            f"recording {recording}, vehicles {one} and {other}, minDanger {decimal(Fraction(danger))}"
            for recording, one, other, danger in totals.unequal_3_4
        ),
    ]
