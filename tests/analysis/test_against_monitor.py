"""What is proved to be impossible never occurs in simulated traffic, as the monitor sees it."""

import csv
from collections import defaultdict
from itertools import combinations
from pathlib import Path

import pytest

from roadproof.analysis.meeting import Meeting, Node, conjunctions
from roadproof.cli.main import main
from roadproof.prove.prover import prove
from roadproof.spec.library import bundled_library
from roadproof.verdict import Verdict

pytest.importorskip("polars")

Occurrences = dict[str, set[tuple[int, int]]]


@pytest.fixture(scope="module")
def together(tmp_path_factory: pytest.TempPathFactory) -> Occurrences:
    """By set, the pairs of scenarios that match at one start, with one lane and the same roles."""
    folder = tmp_path_factory.mktemp("traffic")
    recordings, out = folder / "recordings", folder / "out"
    line = ["simulate", "--out", str(recordings), "--seconds", "40", "--lanes", "2", "--seed", "1"]
    assert main([*line, "--plant", "1,3-8", "--jobs", "1"]) == 0
    command = ["evaluate", str(recordings), "--out", str(out), "--no-pictures", "--no-detectors"]
    assert main([*command, "--jobs", "1"]) == 0
    return occurrences(out / "matches.csv")


def occurrences(path: Path) -> Occurrences:
    """The pairs in a table of matches; scenario 7 is left out, as its lane is chosen by another rule."""
    traces: dict[tuple[str, ...], set[int]] = defaultdict(set)
    with path.open() as file:
        for row in csv.DictReader(file):
            if not row["pov2"] and row["scenario"] != "7":
                key = tuple(
                    row[x] for x in ("set", "recording", "sv", "pov", "lane", "start_frame", "min_danger")
                )
                traces[key].add(int(row["scenario"]))
    found: Occurrences = defaultdict(set)
    for key, numbers in traces.items():
        found[key[0]] |= set(combinations(sorted(numbers), 2))
    return found


def is_impossible(a: int, b: int, set_name: str) -> bool:
    specification = bundled_library().select(set_name)
    (formula,) = conjunctions(specification, Node(a, set_name), Node(b, set_name), Meeting())
    return prove(specification, f"not ({formula})", 3.0).verdict in (Verdict.PROVED, Verdict.VACUOUS)


@pytest.mark.parametrize("set_name", ["base", "ext"])
def test_no_pair_that_occurs_is_proved_impossible(together: Occurrences, set_name: str) -> None:
    assert together[set_name]
    assert [pair for pair in sorted(together[set_name]) if is_impossible(*pair, set_name)] == []


def test_pairs_of_base_that_occur_are_among_the_five(together: Occurrences) -> None:
    assert together["base"] <= {(1, 5), (3, 6), (4, 6), (4, 8), (6, 8)}
