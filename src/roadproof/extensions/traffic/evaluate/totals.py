"""Totals over recordings: pairs in danger, matches, detections and shares, as they are counted.

What an earlier window of the same recording has shown counts once: it is left out, and said.
"""

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import product
from typing import NamedTuple

from roadproof.extensions.traffic.evaluate.evaluate import DisturbanceTrace, Findings
from roadproof.extensions.traffic.evaluate.matching import Match, PossibleMatch
from roadproof.extensions.traffic.evaluate.questions import EvaluationSettings
from roadproof.extensions.traffic.evaluate.sectors import Sector, sectors_of
from roadproof.extensions.traffic.evaluate.violations import Degree, VehiclePair, ViolatingPairs
from roadproof.extensions.traffic.formats.repeats import FramePair


@dataclass(frozen=True)
class Repeat:
    """``what`` of a pair that an earlier recording has too: a trace, a violation or a detector's name."""

    recording: str
    first: int
    second: int
    what: str
    min_danger: int | None
    shown_in: str


@dataclass
class ShownMoments:
    """The recording that first showed each counted thing, by kind and moment."""

    known: dict[tuple[str, int], str] = field(default_factory=dict)
    repeats: list[Repeat] = field(default_factory=list)

    def is_new(
        self, recording: str, pair: tuple[int, int], what: str, k: int | None, keys: Iterable[int]
    ) -> bool:
        """Return whether no earlier recording shows this at any of its moments; then this one does."""
        marks = [(f"{what} {k}", key) for key in keys if key]
        shown = next(
            (self.known[mark] for mark in marks if self.known.get(mark, recording) != recording), None
        )
        if shown is not None:
            # A third window may overlap this one only.
            self.known.update((mark, shown) for mark in marks if mark not in self.known)
            self.repeats.append(Repeat(recording, *pair, what, k, shown))
            return False
        self.known.update(dict.fromkeys(marks, recording))
        return True


def without_repeats(findings: Findings, shown_moments: ShownMoments) -> Findings:
    """The findings without what an earlier recording has too: traces with matches, violations, detections."""
    if not findings.seen:
        return findings

    def is_new(pair: FramePair, what: str, k: int | None, keys: tuple[int, ...]) -> bool:
        return shown_moments.is_new(findings.recording, (pair.first, pair.second), what, k, keys)

    seen = {(x.first, x.second): x for x in findings.seen}
    shown = {
        (x.first, x.second) for x in findings.seen if x.violating and not is_new(x, "violation", None, x.keys)
    }
    new_traces = []
    for trace in findings.traces:
        pair = seen[trace.first, trace.second]
        keys = pair.keys[trace.start_frame - pair.low : trace.end_frame - pair.low + 1]
        if is_new(pair, "trace", trace.min_danger, keys):
            new_traces.append(trace)
    traces = {(x.first, x.second, x.min_danger) for x in new_traces}
    detected = dict.fromkeys((x.detector, x.pair) for x in findings.detections)
    new = {(name, pair) for name, pair in detected if is_new(seen[pair], name, None, seen[pair].keys)}
    return replace(
        findings,
        violating=tuple(pair for pair in findings.violating if pair not in shown),
        traces=tuple(new_traces),
        matches=tuple(x for x in findings.matches if (*x.pair, x.min_danger) in traces),
        possible=tuple(x for x in findings.possible if (*x.pair, x.min_danger) in traces),
        detections=tuple(x for x in findings.detections if (x.detector, x.pair) in new),
    )


@dataclass
class ResultsRow:
    """One row of a results table (paper, Table of results): a spec set under one minDanger, in a sector.

    Counts are of unordered pairs whose trace begins in the sector. ``matching`` is by scenarios of two cars,
    as in the paper; ``matching_with_three`` counts those of three cars too, ``several`` those of these that
    match more than one scenario. ``together`` counts how many traces match two scenarios at once.
    ``matching_violating`` counts the pairs among all violating ones that match a scenario of two cars here.
    ``uncertain`` counts those of ``matching`` that do so only by matches within the errors of places, and
    ``possible`` those that do not match, but may; ``violating_bounds``: how many of the violating pairs
    match for sure, and at most.
    """

    sector: Sector
    min_danger: Fraction
    set_name: str
    traces: int = 0
    matching: int = 0
    matching_with_three: int = 0
    matching_violating: int = 0
    uncertain: int = 0
    possible: int = 0
    violating_bounds: tuple[int, int] = (0, 0)
    scenarios: Counter[int] = field(default_factory=Counter)
    several: int = 0
    together: Counter[tuple[int, int]] = field(default_factory=Counter)

    @property
    def recall(self) -> float | None:
        """Matching traces by traces; None where there are none."""
        return self.matching / self.traces if self.traces else None

    @property
    def bounds(self) -> tuple[int, int]:
        """Return how many traces match for sure, and how many may match at most, as places are off."""
        return self.matching - self.uncertain, self.matching + self.possible


class DriverLabelKey(NamedTuple):
    """The key of a count of driver labels; ``min_danger`` is an index into the settings'."""

    min_danger: int
    set_name: str
    scenario: int
    driver: str
    label: str


@dataclass
class Totals:
    """The sums over recordings from which all tables are made.

    ``tables``: the rows of each road sector by its name, the first being the paper's main road unless it is
    not asked for; ``met``: the sectors that a road of the recordings has. ``foretold`` counts the labels that
    driver models give to matches.

    The following count in all road sectors together: ``violating`` the pairs of vehicles with an rssViolation
    in some frame, once over all windows (``violations``); ``traces`` the disturbance
    traces by minDanger (an index); by minDanger and set, ``matching`` the
    traces and ``matching_violating`` the violating pairs that match a scenario of two cars, and
    ``violating_bounds`` how many of these do for sure, and at most.
    """

    settings: EvaluationSettings
    tables: Mapping[str, list[ResultsRow]]
    met: set[str] = field(default_factory=set)
    recordings: int = 0
    vehicles: int = 0
    samples: int = 0
    violating: int = 0
    violations: ViolatingPairs = field(default_factory=ViolatingPairs)
    traces: Counter[int] = field(default_factory=Counter)
    matching: Counter[tuple[int, str]] = field(default_factory=Counter)
    matching_violating: Counter[tuple[int, str]] = field(default_factory=Counter)
    violating_bounds: dict[tuple[int, str], tuple[int, int]] = field(default_factory=dict)
    asked: int = 0
    undecided: int = 0
    differing: int = 0
    detected: Counter[str] = field(default_factory=Counter)
    unequal_3_4: list[tuple[str, int, int, str]] = field(default_factory=list)
    broken: list[str] = field(default_factory=list)
    notes: dict[str, tuple[str, ...]] = field(default_factory=dict)
    repeats: list[Repeat] = field(default_factory=list)
    foretold: Counter[DriverLabelKey] = field(default_factory=Counter)

    @property
    def rows(self) -> list[ResultsRow]:
        """The rows of the first sector."""
        return next(iter(self.tables.values()))

    @property
    def shown(self) -> dict[str, list[ResultsRow]]:
        """The tables of the first sector, and of the others that a road of the recordings has."""
        return {name: rows for k, (name, rows) in enumerate(self.tables.items()) if not k or name in self.met}

    @property
    def repeated(self) -> int:
        """Return how many traces are left out because an earlier recording has them too."""
        return sum(x.what == "trace" for x in self.repeats)


def begin_totals(settings: EvaluationSettings) -> Totals:
    """Return the totals of no recordings."""
    sectors = sectors_of(settings.library.select(settings.sets[0], settings.options), settings.scenarios)
    each = [(m, s) for m in settings.min_danger for s in settings.sets]
    return Totals(settings, {sector.name: [ResultsRow(sector, *x) for x in each] for sector in sectors})


def add_findings(totals: Totals, findings: Findings) -> None:
    """Count one recording, and check the facts of semantics §6 on it."""
    totals.recordings += 1
    for name in ("vehicles", "samples", "asked", "undecided", "differing"):
        setattr(totals, name, getattr(totals, name) + getattr(findings, name))
    violating = totals.violations.add(findings)
    totals.violating = totals.violations.count
    totals.traces.update(x.min_danger for x in findings.traces)
    totals.detected.update(name for name, _ in {(x.detector, x.pair) for x in findings.detections})
    totals.met.update(findings.sectors)
    for match in findings.matches:
        for driver, label in zip(totals.settings.drivers, match.labels, strict=bool(match.labels)):
            if label:
                of = (match.min_danger, match.set_name, match.scenario)
                totals.foretold[DriverLabelKey(*of, driver, label)] += 1
    for place, (k, set_name) in enumerate(
        product(range(len(totals.settings.min_danger)), totals.settings.sets)
    ):
        traces = {(t.first, t.second): t for t in findings.traces if t.min_danger == k}
        matches = [x for x in findings.matches if x.min_danger == k and x.set_name == set_name]
        possible = [x for x in findings.possible if x.min_danger == k and x.set_name == set_name]

        def violate(sector: str, degree: Degree, pairs: Iterable[VehiclePair]) -> int:
            rows = [violating[x] for x in pairs if x in violating]
            return totals.violations.match((k, set_name, sector, degree), rows)  # noqa: B023

        for rows in totals.tables.values():
            row, sector = rows[place], rows[place].sector
            matching_pairs = _pairs(matches, possible, sector.scenarios)
            _count(row, traces.values(), matches, matching_pairs)
            row.matching_violating = violate(sector.name, "match", matching_pairs.matching)
            certain = violate(sector.name, "surely", matching_pairs.surely)
            row.violating_bounds = certain, violate(sector.name, "perhaps", matching_pairs.perhaps)
        matching_pairs = _pairs(matches, possible, totals.settings.scenarios)
        totals.matching[k, set_name] += len(matching_pairs.matching & traces.keys())
        totals.matching_violating[k, set_name] = violate("", "match", matching_pairs.matching)
        certain = violate("", "surely", matching_pairs.surely)
        totals.violating_bounds[k, set_name] = certain, violate("", "perhaps", matching_pairs.perhaps)
        _check(totals, findings, traces, _scenarios_by_pair(matches), k, set_name)


def _scenarios_by_pair(matches: Iterable[Match]) -> dict[tuple[int, int], set[int]]:
    """The scenarios of each pair that matches some."""
    matched: dict[tuple[int, int], set[int]] = {}
    for match in matches:
        matched.setdefault(match.pair, set()).add(match.scenario)
    return matched


class _MatchingPairs(NamedTuple):
    """Pairs that match with two cars, those that do for sure, and all that may."""

    matching: Set[VehiclePair]
    surely: Set[VehiclePair]
    perhaps: Set[VehiclePair]


def _pairs(
    matches: Sequence[Match], possible: Iterable[PossibleMatch], scenarios: Collection[int]
) -> _MatchingPairs:
    of_two = [x for x in matches if x.pov2 is None and x.scenario in scenarios]
    matching = {x.pair for x in of_two}
    certain = {x.pair for x in of_two if not x.uncertain}
    return _MatchingPairs(matching, certain, matching | {x.pair for x in possible if x.scenario in scenarios})


def _count(
    row: ResultsRow, traces: Iterable[DisturbanceTrace], matches: Iterable[Match], pairs: _MatchingPairs
) -> None:
    """Add the traces and matches of the sector of a row; ``pairs``: the pairs of the latter."""
    matched = _scenarios_by_pair(x for x in matches if x.scenario in row.sector.scenarios)
    row.traces += sum(row.sector.name in x.sectors for x in traces)
    row.matching_with_three += len(matched)
    row.matching += len(pairs.matching)
    row.uncertain += len(pairs.matching - pairs.surely)
    row.possible += len(pairs.perhaps - pairs.matching)
    for numbers in matched.values():
        row.scenarios.update(numbers)
        row.several += len(numbers) > 1
        row.together.update((i, j) for i in numbers for j in numbers if i < j)


def _check(
    totals: Totals,
    findings: Findings,
    traces: Mapping[tuple[int, int], DisturbanceTrace],
    matched: Mapping[tuple[int, int], set[int]],
    k: int,
    set_name: str,
) -> None:
    """semantics §6: matches are disturbances; a set matches all that the one before it does; s3 = s4."""
    where = f"recording {findings.recording}, minDanger {totals.settings.min_danger[k]}, {set_name}"
    totals.broken += [
        f"{where}: {pair} matches but is no disturbance" for pair in matched if pair not in traces
    ]
    wider = {"base": "extA", "extA": "ext"}.get(set_name)
    if wider in totals.settings.sets:
        theirs = (x for x in findings.matches if x.min_danger == k and x.set_name == wider)
        other = _scenarios_by_pair(theirs)
        lost = [p for p, numbers in matched.items() if not numbers <= other.get(p, set())]
        totals.broken += [f"{where}: {pair} does not match as much in {wider}" for pair in lost]
    if set_name == "base" and {3, 4} <= set(totals.settings.scenarios):
        for pair, numbers in matched.items():
            if (3 in numbers) != (4 in numbers):
                straddles = traces[pair].first_lane != traces[pair].second_lane
                totals.unequal_3_4.append((findings.recording, *pair, str(totals.settings.min_danger[k])))
                totals.broken += (
                    [] if straddles else [f"{where}: {pair} matches only one of scenarios 3 and 4"]
                )
