"""The tables of a traffic evaluation, the paper's figures beside ours (semantics §7).

Never compute with the paper's figures, which it reports on the real highD: Reimann et al., SAC 2024,
section *Experimental Evaluation*, Table *Quantitative results of our experiments* and Table *Absolute number
of the cut-in and deceleration scenarios*.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType

from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.traffic.evaluate.foretelling import LABELS
from roadproof.extensions.traffic.evaluate.results import decimal, driver_label_rows, scenario_words
from roadproof.extensions.traffic.evaluate.sectors import ANYWHERE
from roadproof.extensions.traffic.evaluate.totals import ResultsRow, Totals
from roadproof.extensions.traffic.report.tables import ReportTable
from roadproof.extensions.traffic.scenario_parts import DETECTORS, Metric
from roadproof.library.words import ScenarioWords
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class PaperRow:
    """A row of the paper's results table; ``scenarios`` counts traces by scenario, without scenario 2."""

    traces: int
    matching: int
    recall: str
    scenarios: Mapping[int, int]


def _row(traces: int, matching: int, recall: str, *counts: int) -> PaperRow:
    return PaperRow(traces, matching, recall, dict(zip((1, 3, 4, 5, 6, 7, 8), counts, strict=True)))


RESULTS: Mapping[tuple[Fraction, str], PaperRow] = {
    (Fraction(0), "base"): _row(32398, 24038, "74.2%", 4091, 21941, 21941, 291, 218, 3188, 924),
    (Fraction(0), "extA"): _row(32398, 30288, "93.5%", 4091, 27652, 26008, 291, 218, 4362, 969),
    (Fraction(0), "ext"): _row(32398, 31139, "96.1%", 9364, 27652, 26008, 378, 218, 4362, 969),
    (Fraction(3, 5), "base"): _row(28881, 21564, "74.7%", 4076, 19595, 19595, 283, 215, 3171, 801),
    (Fraction(3, 5), "extA"): _row(28881, 27177, "94.1%", 4076, 24843, 23328, 283, 215, 4347, 838),
    (Fraction(3, 5), "ext"): _row(28881, 27963, "96.8%", 9312, 24843, 23328, 361, 215, 4347, 838),
}

VIOLATING_PAIRS = 99656
"""Pairs with danger at some point, before the filter dangerArises."""

RECALL_WITHOUT_FILTER = "around 25%"
"""The paper's words on recall without the filter (RQ3)."""

COMPARISON: Mapping[str, Mapping[str, int]] = {
    "cut-in": {"TTC": 144, "THW": 7219, "none": 1017, "RSS": 9364},
    "deceleration": {"TTC": 22, "THW": 112, "none": 26846, "RSS": 26008},
}
"""Detections by kind and danger metric: TTC and THW of one earlier work, none of another, RSS the paper's."""

MARK = "the paper's, on the real highD"


NONE_FAILED: Mapping[str, str] = MappingProxyType({})
WITHIN = "within errors"
"""The column of the least and the greatest recall, where places are off."""
OURS = "here"
PAPER = "paper*"
NAMES = 3
"""So many scenarios are named on a line."""
METRICS: tuple[Metric, ...] = ("TTC", "THW", "none")
"""Danger metrics of earlier works."""
KINDS = {"cut-in": 1, "deceleration": 4}
"""What detectors detect, and the scenario that stands beside them (paper, RQ5)."""


def results_tables(totals: Totals, failed: Mapping[str, str] = NONE_FAILED) -> dict[str, ReportTable]:
    """The paper's results table, one for each road sector that the recordings have, by names for files.

    For each minDanger and set there is a row of ours and, where the paper has one, a row of the paper's.
    """
    shown = totals.shown
    several = len(shown) > 1
    return {
        f"results{ending_of(totals, x)}": _results_table(totals, x if several else "", rows, failed)
        for x, rows in shown.items()
    }


def ending_of(totals: Totals, sector: str) -> str:
    """Return the ending of the names of a sector's files; empty for the first sector.

    Words of a specification become part of a file's name, so other signs than letters and digits go.
    """
    first = next(iter(totals.tables))
    return "" if sector == first else "-" + re.sub(r"[^a-z0-9]+", "-", sector.lower()).strip("-")


def _results_table(
    totals: Totals, where: str, rows: Sequence[ResultsRow], failed: Mapping[str, str]
) -> ReportTable:
    scenarios = rows[0].sector.scenarios
    bounded = any(is_bounded(x) for x in rows)
    recall = ("recall", WITHIN) if bounded else ("recall",)
    columns = ("minDanger", "set", "data", "traces", "matching", *recall, *(f"s{i}" for i in scenarios))
    three = rows[0].sector.of_three
    return ReportTable(
        "Disturbance traces that match a scenario" + (f": {where}" if where else ""),
        columns,
        tuple(_result_rows(rows, bounded)),
        (
            *_names(scenarios, scenario_words(totals.settings)),
            f"{OURS}: {_data(totals)}",
            *_note_on_paper(rows),
            "A trace is an unordered pair of vehicles, matched when one of its two role assignments is; "
            "matching and recall are by scenarios of two cars, as in the paper."
            + "".join(f" s{i} counts pairs (SV, POV2)." for i in three),
            *_uncertain(rows),
            *_notes_on_sectors(totals, where),
            _convention(totals),
            *_warnings(failed),
            *_repeats(totals),
            *_notes(totals),
        ),
    )


def is_bounded(row: ResultsRow) -> bool:
    """Return whether errors of places decide whether some traces of a row match."""
    return bool(row.uncertain or row.possible)


def interval(bounds: tuple[int, int], whole: int) -> str:
    """The least share and the greatest.

    >>> interval((1, 2), 3)
    '33.3 to 66.7%'
    """
    low, high = bounds
    return f"{percent(low, whole).removesuffix('%')} to {percent(high, whole)}" if whole else "-"


def _uncertain(rows: Sequence[ResultsRow]) -> Iterator[str]:
    """Return how many traces match, or do not, by less than places may be off, where some do."""
    shares = [
        f"{decimal(x.min_danger)}, {x.set_name}: {x.uncertain} of {x.matching} that match and {x.possible} "
        f"of {x.traces - x.matching} others"
        for x in rows
        if is_bounded(x)
    ]
    if shares:
        yield f"{WITHIN}: recall by matches that are sure, and by all that are possible, as places are off."
        yield f"Traces for which these errors decide: {'; '.join(shares)}."


def _names(scenarios: Sequence[int], words: ScenarioWords) -> Iterator[str]:
    """Yield the titles of the scenario columns of a table, some to a line."""
    named = [f"s{i} {words[i].title}" for i in scenarios if words[i].title]
    yield from ("; ".join(named[k : k + NAMES]) for k in range(0, len(named), NAMES))


def _note_on_paper(rows: Sequence[ResultsRow]) -> Iterator[str]:
    if any(paper_row(row) is not None for row in rows):
        yield f"{PAPER}: {MARK}; a comparison of methods, not of the same traffic."


def drivers_table(totals: Totals) -> ReportTable | None:
    """Return the table of driver labels of the matches; None without driver models."""
    if not totals.settings.drivers:
        return None
    rows = [
        (
            *(decimal(Fraction(x.min_danger)), x.set, f"s{x.scenario}", x.driver),
            *map(str, (x.preventable, x.unpreventable, x.undecided, x.not_covered)),
        )
        for x in driver_label_rows(totals)
    ]
    models = [f"{name}: {MODELS[name].title} ({MODELS[name].source})" for name in totals.settings.drivers]
    return ReportTable(
        "Matches by whether a driver model prevents a collision in place of SV",
        ("minDanger", "set", "scenario", "model", *LABELS),
        tuple(rows),
        (
            "; ".join(models) + ".",
            "Rows of matches.csv, so a pair may count in both roles. All but SV moves as recorded, and after "
            "the last common frame straight on; undecided: SV passes POV. Floating point, no evidence.",
        ),
    )


def paper_row(row: ResultsRow) -> PaperRow | None:
    """Return the paper's row for this row; None where it is about other scenarios or parameters."""
    known = RESULTS.get((row.min_danger, row.set_name))
    return known if known is not None and {*known.scenarios} & {*row.sector.scenarios} else None


def _notes_on_sectors(totals: Totals, where: str) -> Iterator[str]:
    """Yield notes on traces and sectors that a table leaves out."""
    if where:
        yield f"Traces that begin in this road sector ({where}); those of the others are in their own tables."
    absent = [name for name in totals.tables if name not in totals.met]
    if absent and totals.recordings:
        numbers = [i for name in absent for i in totals.tables[name][0].sector.scenarios]
        yield f"No recording has a {' or a '.join(absent)}, so {_numbered(numbers)} were not asked."


def _numbered(numbers: Sequence[int]) -> str:
    return f"s{numbers[0]}" if len(numbers) == 1 else f"s{numbers[0]} to s{numbers[-1]}"


def _result_rows(rows: Sequence[ResultsRow], bounded: bool) -> Iterator[tuple[str, ...]]:
    for row in rows:
        scenarios = row.sector.scenarios
        head = (decimal(row.min_danger), row.set_name)
        counts = (str(row.scenarios[i]) for i in scenarios)
        recall = Share(row.matching, row.traces, traces_of(row)).percent
        within = (interval(row.bounds, row.traces),) * bounded
        yield (*head, OURS, str(row.traces), str(row.matching), recall, *within, *counts)
        known = paper_row(row)
        if known is not None:
            theirs = (str(known.scenarios.get(i, "-")) for i in scenarios)
            figures = (str(known.traces), str(known.matching), known.recall, *("-",) * bounded)
            yield (*head, PAPER, *figures, *theirs)


def comparison_table(totals: Totals, failed: Mapping[str, str] = NONE_FAILED) -> ReportTable | None:
    """The paper's comparison table; None where the detectors or the set ext were not asked for."""
    ours = rss_row(totals)
    detectors_needed = {name for detectors in DETECTORS.values() for name in detectors.values()}
    scenarios = set(KINDS.values())
    if ours is None or not (
        detectors_needed <= set(totals.settings.detectors) and scenarios <= set(totals.settings.scenarios)
    ):
        return None
    rows: list[tuple[str, ...]] = []
    for kind, number in KINDS.items():
        detected = (str(totals.detected[DETECTORS[kind][metric]]) for metric in METRICS)
        rows.append((kind, OURS, *detected, str(ours.scenarios[number])))
        rows.append((kind, PAPER, *(str(COMPARISON[kind][x]) for x in (*METRICS, "RSS"))))
    limits = ", ".join(f"{name} = {decimal(totals.settings.values[name])}" for name in _thresholds(totals))
    return ReportTable(
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
    shown = Share(totals.repeated, totals.repeated + totals.traces.total(), "traces in all road sectors")
    return (
        f"{shown.count} are shown by an earlier recording too, so they are left out; "
        "vehicles and samples count as often as they are shown.",
    )


def _notes(totals: Totals) -> tuple[str, ...]:
    count = sum(map(len, totals.notes.values()))
    if not count:
        return ()
    counted = "is 1 note" if count == 1 else f"are {count} notes"
    return (f"There {counted} on {len(totals.notes)} recordings: what is odd there is in results.json.",)


def _thresholds(totals: Totals) -> tuple[str, ...]:
    names = ("ttcLimit", "thwLimit", "farthest", "hardBraking", "leastDrift", "cutInTime", "brakeTime")
    return tuple(name for name in names if name in totals.settings.values)


def rss_row(totals: Totals) -> ResultsRow | None:
    """The row of ext with the smallest minDanger, which the paper compares with earlier works."""
    beside = {*KINDS.values()}
    rows = [x for each in totals.tables.values() for x in each if beside <= {*x.sector.scenarios}]
    rows = [row for row in rows if row.set_name == "ext"]
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


@dataclass(frozen=True)
class Share:
    """``part`` of the ``whole`` of a population, which is named.

    >>> str(Share(1, 3, "traces"))
    '33.3% (1 of 3 traces)'
    """

    part: int
    whole: int
    population: str

    def __post_init__(self) -> None:
        if not self.population.strip():
            raise ValueError("a share needs the name of its population")
        if not 0 <= self.part <= self.whole:
            raise ValueError(f"{self.part} is no part of {self.whole} {self.population}")

    @property
    def percent(self) -> str:
        """The share in per cent with one decimal; ``-`` where the whole is 0."""
        return percent(self.part, self.whole)

    @property
    def count(self) -> str:
        """The two numbers and what they count."""
        return f"{self.part} of {self.whole} {self.population}"

    def __str__(self) -> str:
        return f"{self.percent} ({self.count})"


def traces_of(row: ResultsRow) -> str:
    """The population of a row: traces that begin in its road sector."""
    return f"traces{_place(row.sector.name)}"


def _place(sector: str) -> str:
    return (
        "" if sector == ANYWHERE else f" on the {sector}" if sector.endswith("road") else f" in the {sector}"
    )


def percent(part: int, whole: int) -> str:
    """Return the share in per cent with one decimal; ``-`` where ``whole`` is 0.

    >>> percent(1, 3), percent(1, 0)
    ('33.3%', '-')
    """
    return f"{100 * part / whole:.1f}%" if whole else "-"
