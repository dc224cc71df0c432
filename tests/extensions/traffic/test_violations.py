"""Violating pairs over windows that overlap: each pair of vehicles counts once.

The oracle knows which vehicles every window shows and when; it shares no code with the counting, which knows
moments only.
"""

from dataclasses import replace
from fractions import Fraction
from random import Random

import numpy as np
import pytest

from extensions.traffic.drives import braking, cut_in
from roadproof.extensions.traffic.evaluate.evaluate import Findings, evaluate_recording
from roadproof.extensions.traffic.evaluate.questions import compile_questions, default_settings
from roadproof.extensions.traffic.evaluate.totals import (
    ShownMoments,
    add_findings,
    begin_totals,
    without_repeats,
)
from roadproof.extensions.traffic.evaluate.violations import ViolatingPairs
from roadproof.extensions.traffic.formats.recording import OF_SAMPLES, Recording, keep_vehicles, offsets
from roadproof.extensions.traffic.formats.repeats import FramePair, moments_of
from roadproof.extensions.traffic.simulate.planting import PlantingPlace, plant
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings

LABEL = (0, "ext", "", "match")
LENGTH, SPAN = 60, 20


def findings(name: str, seen: tuple[FramePair, ...], violating: tuple[tuple[int, int], ...]) -> Findings:
    none = dict.fromkeys(("traces", "matches", "detections", "notes", "sectors"), ())
    counts = dict.fromkeys(("vehicles", "samples", "triples", "asked", "undecided", "differing"), 0)
    return Findings(recording=name, violating=violating, seen=seen, **counts, **none)


def window(number: int, begin: int, pairs: list[tuple[int, range]]) -> tuple[Findings, list[int]]:
    """The pairs that a window from ``begin`` on shows, under ids of its own, and which they are."""
    rows, shown = [], []
    for pair, frames in pairs:
        common = [k for k in frames if begin <= k < begin + SPAN]
        if common:
            ids = (100 * number + 2 * len(rows) + 1, 100 * number + 2 * len(rows) + 2)
            keys = tuple(1 + pair * 1000 + k for k in common)
            rows.append(FramePair(*ids, 0, True, keys))
            shown.append(pair)
    return findings(f"w{number}", tuple(rows), tuple((x.first, x.second) for x in rows)), shown


def expected(windows: list[tuple[int, set[int]]], frames: dict[int, range], matching: set[tuple[int, int]]):
    """How many stretches of pairs the windows show, and how many of them match, by the time they cover.

    Windows that share no frame of a pair, directly or through others, show two stretches.
    """
    total = matched = 0
    for pair, seen in frames.items():
        spans = sorted(
            (max(begin, seen.start), min(begin + SPAN, seen.stop), n)
            for n, (begin, _) in enumerate(windows)
            if max(begin, seen.start) < min(begin + SPAN, seen.stop)
        )
        stretches: list[tuple[int, list[int]]] = []
        for low, high, n in spans:
            if stretches and low < stretches[-1][0]:
                end, members = stretches.pop()
                stretches.append((max(end, high), [*members, n]))
            else:
                stretches.append((high, [n]))
        total += len(stretches)
        matched += sum(any((n, pair) in matching for n in members) for _, members in stretches)
    return total, matched


@pytest.mark.parametrize("seed", range(200))
def test_counts_are_those_of_the_road_in_any_order(seed: int) -> None:
    dice = Random(seed)
    frames = {p: range(a := dice.randrange(LENGTH), a + dice.randrange(1, 30)) for p in range(6)}
    begins = [dice.randrange(LENGTH) for _ in range(dice.randrange(1, 8))]
    windows = [window(n, begin, list(frames.items())) for n, begin in enumerate(begins)]
    matching = {(n, p) for n, (_, shown) in enumerate(windows) for p in shown if dice.random() < 0.3}
    order = list(range(len(windows)))
    for _ in range(3):
        dice.shuffle(order)
        counted, of_label = ViolatingPairs(), 0
        for n in order:
            found, shown = windows[n]
            rows = counted.add(found)
            hits = [rows[ids] for ids, p in zip(found.violating, shown, strict=True) if (n, p) in matching]
            of_label = counted.match(LABEL, hits)
        whole = [(begin, set(shown)) for begin, (_, shown) in zip(begins, windows, strict=True)]
        assert (counted.count, of_label) == expected(whole, frames, matching)


def test_a_third_window_joins_two_that_share_nothing() -> None:
    """The match of the last window is one of the pair, though the first window has shown the violation."""
    one, other, both = ((5, 6), (8, 9), (6, 7, 8))
    counted = ViolatingPairs()
    for name, keys in (("a", one), ("b", other)):
        counted.add(findings(name, (FramePair(1, 2, 0, True, keys),), ((1, 2),)))
    assert counted.count == 2
    rows = counted.add(findings("c", (FramePair(7, 9, 0, True, both),), ((7, 9),)))
    assert counted.match(LABEL, rows.values()) == 1
    assert counted.count == 1


def test_recordings_without_moments_share_nothing() -> None:
    """0 is no moment, and recordings such as highD's have none."""
    counted = ViolatingPairs()
    for name in "ab":
        counted.add(findings(name, (), ((1, 2), (1, 3))))
        counted.add(findings(name, (FramePair(1, 2, 0, True, (0, 0)),), ((1, 2),)))
    assert counted.count == 6


def test_pairs_that_are_only_detected_do_not_violate() -> None:
    counted = ViolatingPairs()
    assert counted.add(findings("a", (FramePair(1, 2, 0, False, (5,)),), ())) == {}
    assert counted.count == 0


# --- whole evaluations of windows that overlap -------------------------------------------------------


def cut(
    whole: Recording, number: int, begin: int, end: int, dice: Random
) -> tuple[Recording, dict[int, int]]:
    """The frames from ``begin`` to ``end`` as a recording with ids of its own, and whose these are."""
    frames = whole.row_frame
    rows = (frames >= begin) & (frames < end)
    counts = np.add.reduceat(rows.astype(int), whole.start[:-1])
    there = counts > 0
    part = keep_vehicles(whole, there)
    kept = rows[np.repeat(there, np.diff(whole.start))]
    per_sample = {name: getattr(part, name)[kept] for name in OF_SAMPLES}
    start = offsets(counts[there])
    ids = np.array(sorted(dice.sample(range(1, 1000), int(there.sum()))))
    motion = np.column_stack([per_sample[x] for x in ("v_lon", "v_lat", "a_lon", "a_lat")])
    window = replace(
        part,
        **per_sample,
        name=f"w{number}",
        vehicle_id=ids,
        first_frame=np.maximum(part.first_frame - begin, 0),
        start=start,
        moments=moments_of(motion, start),
    )
    return window, dict(zip(ids.tolist(), part.vehicle_id.tolist(), strict=True))


@pytest.mark.parametrize("seed", range(4))
def test_a_pair_and_its_match_count_once_in_windows_that_overlap(seed: int) -> None:
    """Windows of 8 s, each 4 s after the one before, in any order, against the vehicles behind their ids.

    Accelerations have noise, so that each vehicle is known again by its motion.
    """
    dice, random = Random(seed), np.random.default_rng(seed)
    whole = simulate(TrafficSettings(seconds=16, lane_width=3.5, section=300), seed=seed)
    for drive, frame in ((cut_in(), 60), (braking(), 200)):
        whole, _ = plant(whole, drive, PlantingPlace(2, frame, 6, 10.0, -34.0))
    whole = replace(whole, a_lon=whole.a_lon + random.normal(0, 0.01, len(whole.a_lon)))
    settings = replace(default_settings(), sets=("ext",), scenarios=(1, 3, 4), min_danger=(Fraction(0),))
    questions = compile_questions(settings, whole.rate)
    windows = [cut(whole, k, 100 * k, 100 * k + 200, dice) for k in range(4)]
    dice.shuffle(windows)
    totals, counted = begin_totals(settings), ShownMoments()
    violating, matching = set(), set()
    single = 0
    for window, names in windows:
        found = evaluate_recording(window, questions)
        violating |= {frozenset(names[x] for x in pair) for pair in found.violating}
        matching |= {frozenset(names[x] for x in m.pair) for m in found.matches}
        single += len(found.violating)
        add_findings(totals, without_repeats(found, counted))
    assert totals.violating == len(violating) < single
    assert totals.matching_violating[0, "ext"] == len(matching & violating) > 0
