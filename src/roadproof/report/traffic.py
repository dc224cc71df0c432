"""The tables of a traffic evaluation, the paper's figures beside ours (semantics §7)."""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from types import MappingProxyType

from roadproof.report.paper import COMPARISON, MARK, RESULTS
from roadproof.report.tables import Table
from roadproof.traffic.results import Row, Totals

NONE_FAILED: Mapping[str, str] = MappingProxyType({})
OURS = "here"
PAPER = "paper*"
METRICS = {"TTC": "ttc", "THW": "thw", "none": "free"}
"""Danger metrics of earlier works, and how the library's detectors end."""
KINDS = {"cut-in": ("cutIn", 1), "deceleration": ("decel", 4)}
"""What is compared: how the detectors begin, and the scenario that stands beside them (paper, RQ5)."""


def results_table(totals: Totals, failed: Mapping[str, str] = NONE_FAILED) -> Table:
    """The paper's results table: for each minDanger and set a row of ours and one of the paper's."""
    scenarios = totals.settings.scenarios
    columns = ("minDanger", "set", "data", "traces", "matching", "recall", *(f"s{i}" for i in scenarios))
    return Table(
        "Disturbance traces that match a scenario",
        columns,
        tuple(_result_rows(totals)),
        (
            f"{OURS}: {_data(totals)}",
            f"{PAPER}: {MARK}; a comparison of methods, not of the same traffic.",
            "A trace is an unordered pair of vehicles, matched when one of its two role assignments is; "
            "matching and recall are by scenarios of two cars, as in the paper. s2 counts pairs (SV, POV2).",
            _convention(totals),
            *_warnings(failed),
            *_repeats(totals),
            *_notes(totals),
        ),
    )


def _result_rows(totals: Totals) -> Iterator[tuple[str, ...]]:
    scenarios = totals.settings.scenarios
    for row in totals.rows:
        head = (decimal(row.min_danger), row.set_name)
        counts = (str(row.scenarios[i]) for i in scenarios)
        yield (*head, OURS, str(row.traces), str(row.matching), percent(row.matching, row.traces), *counts)
        known = RESULTS.get((row.min_danger, row.set_name))
        if known is not None:
            theirs = (str(known.scenarios.get(i, "-")) for i in scenarios)
            yield (*head, PAPER, str(known.traces), str(known.matching), known.recall, *theirs)


def comparison_table(totals: Totals, failed: Mapping[str, str] = NONE_FAILED) -> Table | None:
    """The paper's comparison table; None where the detectors or the set ext were not asked for."""
    ours = rss_row(totals)
    wanted = {f"{name}_{end}" for name, _ in KINDS.values() for end in METRICS.values()}
    scenarios = {number for _, number in KINDS.values()}
    if ours is None or not (
        wanted <= set(totals.settings.detectors) and scenarios <= set(totals.settings.scenarios)
    ):
        return None
    rows: list[tuple[str, ...]] = []
    for kind, (name, number) in KINDS.items():
        found = (str(totals.detected[f"{name}_{end}"]) for end in METRICS.values())
        rows.append((kind, OURS, *found, str(ours.scenarios[number])))
        rows.append((kind, PAPER, *(str(COMPARISON[kind][x]) for x in (*METRICS, "RSS"))))
    limits = ", ".join(f"{name} = {decimal(totals.settings.values[name])}" for name in _thresholds(totals))
    return Table(
        "Cut-ins and decelerations by earlier definitions and by ISO 34502",
        ("kind", "data", *METRICS, f"RSS ({ours.set_name}, minDanger {decimal(ours.min_danger)})"),
        tuple(rows),
        (
            f"{OURS}: {_data(totals)} Unordered pairs; the first three columns look at whole recordings, the "
            "last one is s1 and s4 of the results table.",
            f"{PAPER}: {MARK}; TTC and THW of one earlier work, none of another.",
            f"Thresholds (SI units; those that the paper does not state are ours): {limits}.",
            *_warnings(failed),
        ),
    )


def missing(failed: Mapping[str, str]) -> str:
    """The warning about recordings that were left out."""
    return f"WARNING: {len(failed)} recordings could not be used and are left out: {', '.join(failed)}."


def _warnings(failed: Mapping[str, str]) -> tuple[str, ...]:
    return (missing(failed),) if failed else ()


def _repeats(totals: Totals) -> tuple[str, ...]:
    if not totals.repeated:
        return ()
    of = totals.repeated + sum(row.traces for row in totals.rows if row.set_name == totals.settings.sets[0])
    return (
        f"{totals.repeated} of {of} traces are shown by an earlier recording too, so they are left out; "
        "vehicles and samples count as often as they are shown.",
    )


def _notes(totals: Totals) -> tuple[str, ...]:
    count = sum(map(len, totals.notes.values()))
    if not count:
        return ()
    said = "is 1 note" if count == 1 else f"are {count} notes"
    return (f"There {said} on {len(totals.notes)} recordings: what is odd there is in results.json.",)


def _thresholds(totals: Totals) -> tuple[str, ...]:
    names = ("ttcLimit", "thwLimit", "farthest", "hardBraking", "leastDrift", "cutInTime", "brakeTime")
    return tuple(name for name in names if name in totals.settings.values)


def rss_row(totals: Totals) -> Row | None:
    """The row of ext with the smallest minDanger, which the paper compares with earlier works."""
    rows = [row for row in totals.rows if row.set_name == "ext"]
    return min(rows, key=lambda row: row.min_danger) if rows else None


def _data(totals: Totals) -> str:
    kinds = ", ".join(totals.settings.classes)
    return (
        f"{totals.recordings} recordings, {totals.vehicles} vehicles ({kinds} evaluated), "
        f"{totals.samples} samples."
    )


def _convention(totals: Totals) -> str:
    says = {
        "truncated": "End of a trace: truncated (true only if true for every continuation)",
        "clip": "End of a trace: clip (windows are cut at the last sample)",
    }[totals.settings.convention]
    return (
        f"{says}; {totals.undecided} of {totals.asked} answers undecided, {totals.differing} would be "
        "another match under the other convention."
    )


def percent(part: int, whole: int) -> str:
    """With one decimal, ``-`` of nothing.

    >>> percent(1, 3), percent(1, 0)
    ('33.3%', '-')
    """
    return f"{100 * part / whole:.1f}%" if whole else "-"


def decimal(value: Fraction) -> str:
    """0.6 for 3/5; a fraction that is no short decimal stays one."""
    text = f"{float(value):g}"
    return text if Fraction(text) == value else str(value)
