"""Every figure of answers.md and of the tables, computed again from matches.csv and pairs.csv alone."""

import csv
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from pathlib import Path

import pytest

import roadproof as rp
from traffic.test_repeats import STEPS_SEEN, window

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

    def recall(self, danger: str, kind: str, sector: str) -> str:
        traces, two = self.traces(danger, sector), self.of_two(danger, kind, sector)
        return f"{percent(len(two), len(traces))} ({len(two)} of {len(traces)} traces {where(sector)})"

    def missed(self, danger: str, sector: str | None) -> str:
        traces, two = self.traces(danger, sector), self.of_two(danger, "ext", sector)
        assert two <= {*traces}
        place = "in all road sectors" if sector is None else where(sector)
        told = f"{len(traces) - len(two)} of {len(traces)} traces {place}"
        return f"{told} match no scenario of ext with two vehicles."


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
                listed = ", ".join(f"{i}-{j} {n}" for (i, j), n in together.most_common(5))
                several = sum(len(x) > 1 for x in found)
                told = f"{several} of {len(found)} traces that match a scenario of the {first} match several"
                yield f"minDanger {danger}, {kind}: {told}{'; ' + listed if listed else ''}."
    violating = counts.marked("violating")
    for danger in DANGERS:
        for kind in SETS:
            if counts.traces(danger, first):
                part = len(counts.of_two(danger, kind) & violating)
                told = f"{percent(part, len(violating))} ({part} of {len(violating)} violating pairs"
                yield (
                    f"Without the filter dangerArises, minDanger {danger}, {kind}: {told} in all road "
                    "sectors) match a scenario with two vehicles."
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
            for label in ("preventable", "unpreventable", "not foreseen"):
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
