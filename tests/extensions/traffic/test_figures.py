"""Every figure of answers.md and of the tables, computed again from matches.csv and pairs.csv alone."""

import csv
import json
import random
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, product
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from extensions.drivers.read import library, values
from extensions.traffic.tiny_commonroad import Car, document
from roadproof.extensions.surveys.classify.cells import whole_cell
from roadproof.extensions.surveys.classify.classes import Classes, plan_of, what_axis
from roadproof.extensions.surveys.classify.text import with_classes, write_classes
from roadproof.extensions.surveys.classify.traffic_shares import Shares, count_shares
from roadproof.extensions.traffic.evaluate.evaluate import DisturbanceTrace, Findings
from roadproof.extensions.traffic.evaluate.experiment import Experiment, run_experiment
from roadproof.extensions.traffic.evaluate.foretelling import LABELS
from roadproof.extensions.traffic.evaluate.matching import Match
from roadproof.extensions.traffic.evaluate.questions import EvaluationSettings, default_settings
from roadproof.extensions.traffic.evaluate.results import driver_cells, driver_label_rows
from roadproof.extensions.traffic.evaluate.totals import ResultsRow, Totals, add_findings, begin_totals
from roadproof.extensions.traffic.evaluate.totals import ShownMoments as RepeatCounts
from roadproof.extensions.traffic.formats.repeats import STEPS, moments_of
from roadproof.extensions.traffic.formats.sources import find_sources
from roadproof.extensions.traffic.scenario_parts import COMPARISON
from roadproof.library.bind import default_values
from roadproof.library.loading import bundled_library

ROAD = {"main road": range(1, 9), "merge zone": range(9, 17), "departure zone": range(17, 25)}
SETS = ("base", "extA", "ext")
DANGERS = ("0", "0.6")
DETECTORS = {
    "cut-in": ("cutIn_ttc", "cutIn_thw", "cutIn_free", "1"),
    "deceleration": ("decel_ttc", "decel_thw", "decel_free", "4"),
}
Rows = Sequence[Mapping[str, str]]


def rows_of(path: Path) -> Rows:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def pair_of(row: Mapping[str, str]) -> tuple[str, ...]:
    """The recording and the unordered pair that a row of matches.csv counts for."""
    return row["recording"], *sorted((row["sv"], row["pov2"] or row["pov"]), key=int)


def where(sector: str) -> str:
    return f"on the {sector}" if sector == "main road" else f"in the {sector}"


def percent(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f}%" if whole else "-"


def interval(low: int, high: int, whole: int) -> str:
    return f"{percent(low, whole).removesuffix('%')} to {percent(high, whole)}" if whole else "-"


class Counts:
    """The two files of an evaluation, and questions to them."""

    def __init__(self, folder: Path) -> None:
        self.matches, self.pairs = rows_of(folder / "matches.csv"), rows_of(folder / "pairs.csv")

    def traces(self, danger: str, sector: str | None = None) -> list[tuple[str, ...]]:
        return [
            (x["recording"], x["first"], x["second"])
            for x in self.pairs
            if x["min_danger"] == danger and (sector is None or sector in x["sectors"].split("; "))
        ]

    def matched(self, danger: str, kind: str, sector: str | None = None) -> dict[tuple[str, ...], set[int]]:
        """The scenarios of each pair that matches some; those of three vehicles are below 0."""
        found: dict[tuple[str, ...], set[int]] = {}
        for x in self.matches:
            number = int(x["scenario"])
            if (x["min_danger"], x["set"]) == (danger, kind) and (sector is None or number in ROAD[sector]):
                found.setdefault(pair_of(x), set()).add(-number if x["pov2"] else number)
        return found

    def of_two(self, danger: str, kind: str, sector: str | None = None) -> set[tuple[str, ...]]:
        return {pair for pair, found in self.matched(danger, kind, sector).items() if max(found) > 0}

    def marked(self, column: str) -> set[tuple[str, ...]]:
        return {(x["recording"], x["first"], x["second"]) for x in self.pairs if x[column] == "1"}

    def bounds(self, danger: str, kind: str, sector: str | None = None) -> tuple[set[tuple[str, ...]], ...]:
        """Pairs with a sure match of two vehicles; and all that match, or may."""
        rows = [
            x
            for x in self.matches
            if (x["min_danger"], x["set"], x["pov2"]) == (danger, kind, "")
            and (sector is None or int(x["scenario"]) in ROAD[sector])
        ]
        others = {
            (x["recording"], x["first"], x["second"])
            for x in self.pairs
            if (x["min_danger"], x[kind], x[f"{kind}_uncertain"]) == (danger, "0", "1")
            and (sector is None or sector in x["sectors"].split("; "))
        }
        sure = {pair_of(x) for x in rows if x["uncertain"] == "0"}
        return sure, {pair_of(x) for x in rows} | others

    def within(self, danger: str, kind: str, sector: str) -> str:
        """The least and the greatest recall."""
        low, high = (len(x) for x in self.bounds(danger, kind, sector))
        return interval(low, high, len(self.traces(danger, sector)))

    def recall(self, danger: str, kind: str, sector: str) -> str:
        traces, two = self.traces(danger, sector), self.of_two(danger, kind, sector)
        bounds = self.bounds(danger, kind, sector)
        within = (
            "" if bounds == (two, two) else f"; {self.within(danger, kind, sector)} within errors of places"
        )
        return (
            f"{percent(len(two), len(traces))} ({len(two)} of {len(traces)} traces {where(sector)}{within})"
        )

    def missed(self, danger: str, sector: str | None) -> str:
        traces, two = self.traces(danger, sector), self.of_two(danger, "ext", sector)
        assert two <= {*traces}
        place = "in all road sectors" if sector is None else where(sector)
        told = f"{len(traces) - len(two)} of {len(traces)} traces {place} match no scenario of ext"
        more = 0 if sector is None else len(self.bounds(danger, "ext", sector)[1] - two)
        return f"{told} with two vehicles{f', but {more} of these may, as places are off' if more else ''}."


def answers(counts: Counts, sectors: Sequence[str]) -> Iterator[str]:
    """The lines of RQ1 to RQ5 and of the other sectors, without the paper's figures."""
    first, *others = sectors
    for danger in DANGERS:
        recall = ", ".join(f"{kind} {counts.recall(danger, kind, first)}" for kind in SETS)
        yield f"minDanger {danger}: recall {recall}."
        yield f"minDanger {danger}: {counts.missed(danger, first)}"
    for danger in DANGERS:
        for kind in SETS:
            found = [{abs(i) for i in x} for x in counts.matched(danger, kind, first).values()]
            if found:
                together = Counter(p for x in found for p in combinations(sorted(x), 2))
                listed = ", ".join(
                    f"{i}-{j} {n}" for (i, j), n in sorted(together.items(), key=lambda x: (-x[1], x[0]))
                )
                several = sum(len(x) > 1 for x in found)
                told = f"{several} of {len(found)} traces that match a scenario of the {first} match several"
                yield f"minDanger {danger}, {kind}: {told}{'; ' + listed if listed else ''}."
    violating = counts.marked("violating")
    for danger in DANGERS:
        for kind in SETS:
            if counts.traces(danger, first):
                part = len(counts.of_two(danger, kind) & violating)
                told = f"{percent(part, len(violating))} ({part} of {len(violating)} violating pairs"
                low, high = (len(x & violating) for x in counts.bounds(danger, kind))
                within = f"; {interval(low, high, len(violating))} within errors of places"
                yield (
                    f"Without the filter dangerArises, minDanger {danger}, {kind}: {told} in all road "
                    f"sectors{within if low < high else ''}) match a scenario with two vehicles."
                )
    for kind in SETS:
        shares = {x: counts.recall(x, kind, first) for x in DANGERS if counts.traces(x, first)}
        if len(shares) > 1:
            values = [100 * len(counts.of_two(x, kind, first)) / len(counts.traces(x, first)) for x in shares]
            listed = ", ".join(f"{danger}: {told}" for danger, told in shares.items())
            yield f"{kind}: {listed}; {max(values) - min(values):.1f} points between them."
    for name, (*detectors, number) in DETECTORS.items() if first == "main road" else ():
        found = [len(counts.marked(x)) for x in detectors]
        ours = sum(int(number) in x for x in counts.matched("0", "ext", first).values())
        yield f"{name}: TTC {found[0]}, THW {found[1]}, none {found[2]}; scenario {number} of ext {ours}."
    for danger in DANGERS if others else ():
        for sector in others:
            recall = ", ".join(f"{kind} {counts.recall(danger, kind, sector)}" for kind in SETS)
            yield f"{sector}, minDanger {danger}: recall {recall}."
            yield f"{sector}, minDanger {danger}: {counts.missed(danger, sector)}"
        yield f"all road sectors, minDanger {danger}: {counts.missed(danger, None)}"


def told(folder: Path) -> list[str]:
    """The lines with figures of answers.md, without the paper's figures and the names of scenarios."""
    text = (folder / "answers.md").read_text()
    kept = text.partition("## Facts checked")[0]
    lines = [re.sub(r" \[[^]]*\]", "", line[2:]) for line in kept.splitlines() if line.startswith("- ")]
    lines = [re.sub(r"(scenario \d+ of ext) \([^)]*\)", r"\1", line) for line in lines]
    return [x for x in lines if "by construction" not in x and not x.startswith("Detectors count")]


def check_table(counts: Counts, path: Path, sector: str) -> None:
    ours = [x for x in rows_of(path) if x["data"] == "here"]
    assert [(x["minDanger"], x["set"]) for x in ours] == [(d, s) for d in DANGERS for s in SETS]
    for row in ours:
        danger, kind = row["minDanger"], row["set"]
        traces, two = counts.traces(danger, sector), counts.of_two(danger, kind, sector)
        head = [str(len(traces)), str(len(two)), percent(len(two), len(traces))]
        assert [row["traces"], row["matching"], row["recall"]] == head
        assert row.get("within errors", "") in (counts.within(danger, kind, sector), "")
        matched = counts.matched(danger, kind, sector).values()
        for i in ROAD[sector]:
            assert row[f"s{i}"] == str(sum(i in x or -i in x for x in matched))


def check(
    folder: Path,
    recordings: Path,
    *sectors: str,
    drivers: Sequence[str] = (),
    classes: Sequence[str] = ("Car",),
) -> Counts:
    """Evaluate, and compare all that is written with what the two files say."""
    among = [i for sector in sectors for i in ROAD[sector]]
    rp.evaluate(recordings, out=folder, among=among, drivers=drivers, classes=classes, pictures=False, jobs=1)
    counts = Counts(folder)
    assert told(folder) == list(answers(counts, sectors))
    for k, sector in enumerate(sectors):
        ending = "" if k == 0 else "-" + sector.replace(" ", "-")
        check_table(counts, folder / f"results{ending}.csv", sector)
    for row in rows_of(folder / "comparison.csv") if sectors[0] == "main road" else ():
        if row["data"] == "here":
            *detectors, number = DETECTORS[row["kind"]]
            found = [len(counts.marked(x)) for x in detectors]
            found.append(sum(int(number) in x for x in counts.matched("0", "ext", sectors[0]).values()))
            assert list(row.values())[2:] == [str(x) for x in found]
    if drivers:
        for row in rows_of(folder / "results-drivers.csv"):
            ours = [
                x[row["model"]]
                for x in counts.matches
                if (x["min_danger"], x["set"], f"s{x['scenario']}")
                == (row["minDanger"], row["set"], row["scenario"])
            ]
            for label in ("preventable", "unpreventable", "not covered"):
                assert row[label] == str(ours.count(label))
    return counts


def test_figures_of_a_main_road_with_trucks_and_three_vehicles(tmp_path: Path) -> None:
    rp.simulate(tmp_path / "made", recordings=2, seconds=60, seed=7, flow=2400, truck_share=0.3, jobs=1)
    counts = check(tmp_path / "out", tmp_path / "made", "main road", drivers=("careful", "rss"))
    assert any(x["pov2"] for x in counts.matches)
    assert counts.marked("violating") > {
        (x["recording"], x["first"], x["second"]) for x in counts.pairs if x["min_danger"]
    }


def test_figures_of_pairs_of_cars_and_trucks(tmp_path: Path) -> None:
    rp.simulate(tmp_path / "made", seconds=60, seed=8, flow=2400, truck_share=0.4, jobs=1)
    cars = check(tmp_path / "cars", tmp_path / "made", "main road")
    both = check(tmp_path / "both", tmp_path / "made", "main road", classes=("Car", "Truck"))
    assert both.marked("violating") > cars.marked("violating")
    assert {*both.traces("0")} > {*cars.traces("0")}


@pytest.mark.parametrize(("ramp", "zone"), [("merge", "merge zone"), ("depart", "departure zone")])
def test_figures_with_ramps(ramp: str, zone: str, tmp_path: Path) -> None:
    rp.simulate(tmp_path / "made", seconds=90, seed=3, ramp=ramp, jobs=1)
    counts = check(tmp_path / "out", tmp_path / "made", "main road", zone)
    assert counts.traces("0", zone)
    assert counts.traces("0", "main road")
    assert len(counts.traces("0")) > len(counts.traces("0", "main road"))


def test_figures_of_repeats(tmp_path: Path) -> None:
    (tmp_path / "made").mkdir()
    window(tmp_path / "made" / "a.xml", 0, STEPS_SEEN)
    window(tmp_path / "made" / "b.xml", 3, STEPS_SEEN, (7, 8))
    counts = check(tmp_path / "out", tmp_path / "made", "merge zone")
    assert {x["recording"] for x in counts.pairs} == {"a"}
    text = (tmp_path / "out" / "results.txt").read_text()
    left_out = 2  # the one trace of the second file, for each minDanger
    assert f"{left_out} of {left_out + len(counts.traces('0')) + len(counts.traces('0.6'))} traces" in text


# --- Totals of mixed findings: random matches of both orders of a pair, several scenarios, sets and labels

SPEAKS = {"r157": {1}, "careful": {1, 2, 4}, "rss": {1, 4}}
"""Scenarios of which a model speaks, of those that are asked for."""
SCENARIOS = (1, 2, 4, 7)
TWO_SETS = ("base", "ext")
DANGER_TIMES = (Fraction(0), Fraction(3, 5))
SETTINGS = EvaluationSettings(
    library(), {}, values(), TWO_SETS, DANGER_TIMES, SCENARIOS, drivers=tuple(SPEAKS)
)


def random_findings(rng: random.Random, name: str) -> Findings:
    """Each trace has matches of none, one or several scenarios, in one or both orders of its vehicles."""
    traces, matches = [], []
    pairs = [(a, b) for a in range(1, 7) for b in range(a + 1, 7)]
    for k, (one, other) in product(range(len(DANGER_TIMES)), rng.sample(pairs, 9)):
        sectors = rng.choice([("main",), ("main",), ()])
        traces.append(DisturbanceTrace(one, other, k, 0, 50, "2", "3", sectors))
        for set_name, scenario in product(TWO_SETS, SCENARIOS):
            for sv, pov in ((one, other), (other, one)):
                if rng.random() > 0.25:
                    continue
                third = rng.choice([None, 9]) if scenario == 2 else None
                named = (pov, None) if third is None else (third, pov)
                labels = tuple(rng.choice(LABELS) if scenario in spoken else "" for spoken in SPEAKS.values())
                begun = rng.randrange(50) if any(x in LABELS[:2] for x in labels) else None
                told = labels if any(labels) else ()
                matches.append(Match(sv, *named, "2", 0, 50, k, set_name, scenario, begun=begun, labels=told))
    return Findings(
        name, 9, 900, ((1, 2), (1, 3), (2, 3)), 1, 100, 2, 1, tuple(traces), tuple(matches), (), (), ("main",)
    )


@pytest.mark.parametrize("seed", range(6))
def test_counts_are_those_of_the_matches_one_by_one(seed: int) -> None:
    rng = random.Random(seed)
    found = [random_findings(rng, f"{k:02d}") for k in range(3)]
    totals = begin_totals(SETTINGS)
    for each in found:
        add_findings(totals, each)
    matches = [(each.recording, x) for each in found for x in each.matches]
    expected = Counter(
        (DANGER_TIMES[x.min_danger], x.set_name, x.scenario, driver, label)
        for _, x in matches
        for driver, label in zip(SPEAKS, x.labels, strict=False)
        if label
    )
    rows = [*driver_label_rows(totals)]
    assert len(rows) == len(DANGER_TIMES) * len(TWO_SETS) * sum(map(len, SPEAKS.values()))
    counted = {
        (Fraction(x.min_danger), x.set, x.scenario, x.driver, label): n
        for x in rows
        for label, n in ((name, getattr(x, name.replace(" ", "_"))) for name in LABELS)
    }
    assert counted == {key: expected[key] for key in counted}
    assert sum(counted.values()) == sum(expected.values()) > 50
    for row in totals.rows:
        here = [
            (name, x)
            for name, x in matches
            if (DANGER_TIMES[x.min_danger], x.set_name) == (row.min_danger, row.set_name)
            and x.scenario in row.sector.scenarios
        ]
        by_pair: dict[tuple[str, frozenset[int]], set[int]] = {}
        for name, x in here:
            pair = frozenset({x.sv, x.pov if x.pov2 is None else x.pov2})
            by_pair.setdefault((name, pair), set()).add(x.scenario)
        two = {(name, frozenset({x.sv, x.pov})) for name, x in here if x.pov2 is None}
        traces = [t for each in found for t in each.traces if DANGER_TIMES[t.min_danger] == row.min_danger]
        assert row.traces == sum(row.sector.name in t.sectors for t in traces)
        assert (row.matching, row.matching_with_three) == (len(two), len(by_pair))
        assert row.several == sum(len(x) > 1 for x in by_pair.values())
        assert row.scenarios == Counter(i for numbers in by_pair.values() for i in numbers)
        assert row.together == Counter(
            (i, j) for numbers in by_pair.values() for i in numbers for j in numbers if i < j
        )
        assert not row.traces or row.recall == row.matching / row.traces


def test_cells_are_empty_where_a_model_says_nothing() -> None:
    kept = {"sv": 1, "pov": 2, "pov2": None, "lane": "2", "start_frame": 0, "end_frame": 9, "min_danger": 0}
    made = Match(**kept, set_name="base", scenario=4, begun=5, labels=("", "preventable", "unpreventable"))
    assert driver_cells(SETTINGS, made) == [None, None, "preventable", 5, "unpreventable", 5]
    made = Match(**kept, set_name="base", scenario=4, labels=("", "not covered", "not covered"))
    assert driver_cells(SETTINGS, made) == [None, None, "not covered", None, "not covered", None]
    assert driver_cells(SETTINGS, Match(**kept, set_name="base", scenario=7)) == [None] * 6


# --- Windows of one recording that overlap: what both show counts once, and what only one shows counts

SPEEDS = {"rear": (20.0, 0.02), "front": (12.0, 0.03)}
STEPS_SEEN = 40


def motion(speed: float, pull: float, k: int) -> tuple[float, float]:
    """Speed and acceleration at step ``k``, of a driver whose acceleration grows."""
    return speed + pull * (0.1 * k) ** 2 / 2, pull * 0.1 * k


def car(number: int, begin: float, who: str, first: int, last: int) -> Car:
    speed, pull = SPEEDS[who]
    way = np.cumsum([0.0] + [0.1 * motion(speed, pull, k)[0] for k in range(last)])
    centres = tuple((begin + float(way[k]), 1.75) for k in range(first, last))
    return Car(number, 0, centres, motion=tuple(motion(speed, pull, k) for k in range(first, last)))


def window(path: Path, first: int, last: int, ids: tuple[int, int] = (1, 2)) -> None:
    """Steps ``first`` to ``last`` of a drive in which a car closes in on another until it is too near."""
    path.write_text(
        document((car(ids[0], 10.0, "rear", first, last), car(ids[1], 75.0, "front", first, last)))
    )


def evaluate(folder: Path, out: Path) -> Totals:
    settings = replace(default_settings(), scenarios=(4, 12))  # the road begins as a merge zone
    return run_experiment(Experiment(folder, out, settings)).totals


def traces(totals: Totals) -> list[int]:
    return [row.traces for row in merging(totals) if row.set_name == "base"]


def merging(totals: Totals) -> list[ResultsRow]:
    """Those of the merge zone: the main lanes of the tiny road lie in it too."""
    return totals.tables["merge zone"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "windows").mkdir()
    window(tmp_path / "windows" / "a.xml", 0, STEPS_SEEN)
    return tmp_path / "windows"


def test_drives_that_were_made_are_no_windows(folder: Path, tmp_path: Path) -> None:
    """Files of tests may show the same drive on purpose: each counts, as ZAM in their names says."""
    window(folder / "b.xml", 0, STEPS_SEEN)
    for path in folder.glob("*.xml"):
        named = f'benchmarkID="ZAM_Made-{ord(path.stem)}_1_T-1" commonRoadVersion'
        path.write_text(path.read_text().replace("commonRoadVersion", named, 1))
    totals = evaluate(folder, tmp_path / "out")
    assert (traces(totals), totals.violating, totals.repeats) == ([2, 2], 2, [])


def test_a_window_alone_counts(folder: Path, tmp_path: Path) -> None:
    totals = evaluate(folder, tmp_path / "out")
    assert (traces(totals), totals.violating, totals.repeats) == ([1, 1], 1, [])
    assert all(row.matching == 1 for row in merging(totals))


@pytest.mark.parametrize(("first", "ids"), [(0, (7, 8)), (3, (1, 2)), (6, (9, 4))])
def test_what_an_earlier_window_shows_is_left_out(
    first: int, ids: tuple[int, int], folder: Path, tmp_path: Path
) -> None:
    """Other ids, another time 0: the trace, the violation and the matches count once, and that is said."""
    window(folder / "b.xml", first, STEPS_SEEN, ids)
    totals = evaluate(folder, tmp_path / "out")
    assert (traces(totals), totals.violating, totals.repeated) == ([1, 1], 1, 2)
    assert all(row.matching == 1 for row in merging(totals))
    told = json.loads((tmp_path / "out" / "results.json").read_text())
    assert {
        "recording": "b",
        "pair": sorted(ids),
        "what": "trace",
        "min_danger": "0",
        "shown_in": "a",
    } in told["repeats"]
    rows = (tmp_path / "out" / "pairs.csv").read_text().splitlines()
    assert len(rows) == 3
    assert all(row.startswith("a,") for row in rows[1:])


def test_windows_that_follow_each_other_both_count(folder: Path, tmp_path: Path) -> None:
    """Another car, elsewhere in time: nothing is the same."""
    (folder / "b.xml").write_text(
        document(
            (
                car(1, 12.0, "front", 0, STEPS_SEEN),
                Car(2, 0, ((64.0, 1.75),) * STEPS_SEEN, motion=((0.0, 0.0),) * STEPS_SEEN),
            )
        )
    )
    totals = evaluate(folder, tmp_path / "out")
    assert totals.repeats == []
    assert traces(totals)[0] == 2


def test_detections_count_once(folder: Path, tmp_path: Path) -> None:
    window(folder / "b.xml", 2, STEPS_SEEN)
    settings = replace(default_settings(), detectors=COMPARISON)
    one = run_experiment(Experiment(folder / "a.xml", tmp_path / "one", settings)).totals
    both = run_experiment(Experiment(folder, tmp_path / "both", settings)).totals
    assert both.detected == one.detected
    assert (both.recordings, one.recordings) == (2, 1)


def test_moments_are_those_of_motion_not_of_place() -> None:
    """Five changing samples make a moment; standing, steady motion and the last four make none."""
    changing = np.array([[10.0 + 0.1 * k, 0.1] for k in range(12)])
    steady = np.array([[12.192, 0.0]] * 12)
    made = moments_of(np.concatenate((changing, steady, changing[3:])), np.array([0, 12, 24, 33]))
    assert (made[:12] != 0).tolist() == [True] * (12 - STEPS + 1) + [False] * (STEPS - 1)
    assert not made[12:24].any()
    assert made[24:].tolist() == made[3:12].tolist()


def test_the_same_recording_repeats_nothing() -> None:
    counted = RepeatCounts()
    assert counted.is_new("a", (1, 2), "trace", 0, (5, 6, 0))
    assert counted.is_new("a", (1, 2), "trace", 0, (6, 7))
    assert counted.is_new("b", (1, 2), "trace", 0, (0, 8))  # 0 is no moment
    assert counted.is_new("b", (1, 2), "trace", 1, (5,))  # another minDanger
    assert not counted.is_new("b", (3, 4), "trace", 0, (9, 7))
    assert [(r.recording, r.first, r.shown_in) for r in counted.repeats] == [("b", 3, "a")]


def test_classes_count_what_two_windows_show_once(folder: Path) -> None:
    """Of a class that holds wherever scenario 12 does: the road begins as a merge zone."""
    library = bundled_library()
    (group,) = (plan := plan_of(library.select(), (12,))).groups
    cells = ((whole_cell(what_axis(plan, group, library.select()), (12,), ()),),)
    classes = Classes(plan, cells, ())
    specification = with_classes(write_classes(classes, library.select()), library.select())

    def shares() -> Shares:
        recordings = [source.read() for source in find_sources(folder)]
        return count_shares(classes, specification, default_values(library), recordings)

    alone = shares()
    assert (alone.all_traces, alone.traces["class_12"], alone.repeated, alone.broken) == (1, 1, 0, [])
    window(folder / "b.xml", 5, STEPS_SEEN, ids=(7, 8))
    both = shares()
    assert (both.all_traces, both.traces["class_12"], both.repeated, both.broken) == (1, 1, 1, [])
    assert both.situations == alone.situations


def test_a_match_of_a_later_window_counts_for_the_violation_of_an_earlier_one(
    folder: Path, tmp_path: Path
) -> None:
    """The first window begins in danger and has no trace; the second, with a trace, shows the same pair."""
    window(folder / "a.xml", 12, STEPS_SEEN, (5, 6))
    window(folder / "b.xml", 0, STEPS_SEEN)
    alone, both = tmp_path / "alone", tmp_path / "both"
    first = run_experiment(
        Experiment(folder / "a.xml", alone, replace(default_settings(), scenarios=(4, 12)))
    )
    totals = evaluate(folder, both)
    rows = merging(totals)
    assert totals.violating == first.totals.violating == 1
    assert all(row.matching_violating == row.matching for row in rows)
    table = list(csv.DictReader((both / "pairs.csv").read_text().splitlines()))
    assert {row["violating"] for row in table if row["min_danger"]} == {"1"}
