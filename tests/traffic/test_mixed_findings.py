"""Totals of mixed findings: random matches of both orders of a pair, several scenarios, sets and labels."""

import random
from collections import Counter
from fractions import Fraction
from itertools import product

import pytest

from preventing.read import library, values
from roadproof.recordings.evaluate.evaluate import Findings, Trace
from roadproof.recordings.evaluate.foretelling import LABELS
from roadproof.recordings.evaluate.matching import Match
from roadproof.recordings.evaluate.questions import Settings
from roadproof.recordings.evaluate.results import driver_cells, foretold_rows
from roadproof.recordings.evaluate.totals import add_findings, begin_totals

SPEAKS = {"r157": {1}, "careful": {1, 2, 4}, "rss": {1, 4}}
"""Scenarios of which a model speaks, of those that are asked for."""
SCENARIOS = (1, 2, 4, 7)
SETS = ("base", "ext")
DANGERS = (Fraction(0), Fraction(3, 5))
SETTINGS = Settings(library(), {}, values(), SETS, DANGERS, SCENARIOS, drivers=tuple(SPEAKS))


def random_findings(rng: random.Random, name: str) -> Findings:
    """Each trace has matches of none, one or several scenarios, in one or both orders of its vehicles."""
    traces, matches = [], []
    pairs = [(a, b) for a in range(1, 7) for b in range(a + 1, 7)]
    for k, (one, other) in product(range(len(DANGERS)), rng.sample(pairs, 9)):
        sectors = rng.choice([("main",), ("main",), ()])
        traces.append(Trace(one, other, k, 0, 50, "2", "3", sectors))
        for set_name, scenario in product(SETS, SCENARIOS):
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
        (DANGERS[x.min_danger], x.set_name, x.scenario, driver, label)
        for _, x in matches
        for driver, label in zip(SPEAKS, x.labels, strict=False)
        if label
    )
    rows = [*foretold_rows(totals)]
    assert len(rows) == len(DANGERS) * len(SETS) * sum(map(len, SPEAKS.values()))
    counted = {(*row[:4], label): n for row in rows for label, n in zip(LABELS, row[4], strict=True)}
    assert counted == {key: expected[key] for key in counted}
    assert sum(counted.values()) == sum(expected.values()) > 50
    for row in totals.rows:
        here = [
            (name, x)
            for name, x in matches
            if (DANGERS[x.min_danger], x.set_name) == (row.min_danger, row.set_name)
            and x.scenario in row.sector.scenarios
        ]
        by_pair: dict[tuple[str, frozenset[int]], set[int]] = {}
        for name, x in here:
            pair = frozenset({x.sv, x.pov if x.pov2 is None else x.pov2})
            by_pair.setdefault((name, pair), set()).add(x.scenario)
        two = {(name, frozenset({x.sv, x.pov})) for name, x in here if x.pov2 is None}
        traces = [t for each in found for t in each.traces if DANGERS[t.min_danger] == row.min_danger]
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
    made = Match(**kept, set_name="base", scenario=4, labels=("", "not foreseen", "not foreseen"))
    assert driver_cells(SETTINGS, made) == [None, None, "not foreseen", None, "not foreseen", None]
    assert driver_cells(SETTINGS, Match(**kept, set_name="base", scenario=7)) == [None] * 6
