"""Pairs, the pre-filter and triples against brute force over all vehicles and frames."""

from dataclasses import replace
from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from roadproof.recordings.formats import pairs as module
from roadproof.recordings.formats.pairs import (
    Pairs,
    Reach,
    all_moments,
    common_pairs,
    near_moments,
    near_pairs,
    triples_of,
)
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic
from traffic.make_recording import Track, cruise, make_recording

REACH = Reach(rho=0.6, a_max=5.0, b_min=6.0, b_max=8.0, a_max_lat=1.5, b_min_lat=1.5)


def frames_of(r: Recording, vehicle: int) -> range:
    return range(int(r.first_frame[vehicle]), int(r.last_frame[vehicle]) + 1)


def distance(rear: float, front: float, reach: Reach) -> float:
    """The paper's dRSS_lon."""
    way = rear * reach.rho + reach.a_max * reach.rho**2 / 2
    return max(
        0.0, way + (rear + reach.a_max * reach.rho) ** 2 / (2 * reach.b_min) - front**2 / (2 * reach.b_max)
    )


def sideways(v_1: float, v_2: float, reach: Reach, signed: bool = False) -> float:
    """The paper's dRSS_lat; ``signed`` leaves out what needs no braking."""
    one, other = v_1 + reach.rho * reach.a_max_lat, v_2 - reach.rho * reach.a_max_lat
    squares = (max(0, one) ** 2 + min(0, other) ** 2) if signed else (one**2 + other**2)
    return max(
        0.0, (v_1 - v_2) * reach.rho + reach.a_max_lat * reach.rho**2 + squares / (2 * reach.b_min_lat)
    )


def violates(r: Recording, one: int, other: int, frame: int, reach: Reach, reading: str = "rss") -> bool:
    """rssViolation as the paper writes it, in any of its lateral readings."""
    i, j = (int(r.start[v] + frame - r.first_frame[v]) for v in (one, other))
    sign = 1.0 if reading == "literal" else -1.0
    along = any(
        0 <= r.s[f] - r.s[k] <= r.length[front] + distance(r.v_lon[k], r.v_lon[f], reach)
        for k, f, front in ((i, j, other), (j, i, one))
    )
    return along and any(
        0
        <= r.d[left] - r.d[right]
        <= r.width[who] + sideways(sign * r.v_lat[left], sign * r.v_lat[right], reach, reading == "signed")
        for right, left, who in ((i, j, other), (j, i, one))
    )


def brute_common(r: Recording, eligible: np.ndarray) -> dict[tuple[int, int], list[int]]:
    found = {}
    for a, b in combinations(np.flatnonzero(eligible).tolist(), 2):
        frames = sorted(set(frames_of(r, a)) & set(frames_of(r, b)))
        if frames and r.direction[a] == r.direction[b]:
            found[a, b] = frames
    return found


def as_set(pairs: Pairs) -> set[tuple[int, int]]:
    return set(zip(pairs.first.tolist(), pairs.second.tolist(), strict=True))


@st.composite
def recordings(draw: st.DrawFn) -> Recording:
    """Few vehicles in wild motion: any direction, any speed and sign, sudden jumps, overlaps."""
    random = np.random.default_rng(draw(st.integers(0, 2**32)))
    tracks = []
    for _ in range(draw(st.integers(2, 9))):
        frames = int(random.integers(1, 12))
        rows = random.uniform(-1, 1, (frames, 6)) * [draw(st.sampled_from([30, 120])), 10, 40, 2, 5, 2]
        direction, first = int(random.integers(1, 3)), int(random.integers(0, 15))
        tracks.append(Track(direction, first, rows.tolist(), float(random.uniform(1, 20))))
    return make_recording(tracks)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(recordings(), st.integers(0, 2**20))
def test_pairs_and_filter_against_brute_force(r: Recording, seed: int) -> None:
    random = np.random.default_rng(seed)
    eligible = random.random(r.vehicles) < 0.8
    expected = brute_common(r, eligible)
    pairs = common_pairs(r, eligible)
    assert as_set(pairs) == set(expected)
    assert len(pairs) == len(expected)
    for a, b, low, high in zip(pairs.first, pairs.second, pairs.low, pairs.high, strict=True):
        assert (low, high) == (expected[a, b][0], expected[a, b][-1])
    reach = Reach(*random.uniform([0, 0, 0.5, 0.5, 0, 0.5], [2, 8, 9, 9, 3, 3]).tolist())
    near = as_set(near_pairs(r, pairs, reach))
    for reading in ("rss", "literal", "signed"):
        for p, frames in expected.items():
            if any(violates(r, *p, f, reach, reading) for f in frames):
                assert p in near


@settings(max_examples=60, deadline=None, derandomize=True)
@given(recordings(), st.integers(1, 30))
def test_moments_against_brute_force(r: Recording, rate: int) -> None:
    """Every violating frame of every pair is a near moment, once, in order, with the right rows."""
    r = replace(r, rate=rate)
    pairs = common_pairs(r, np.ones(r.vehicles, bool))
    for samples in (7, 10_000):
        found = list(near_moments(r, pairs, REACH, samples))
        pair, frame = (np.concatenate([[], *(getattr(x, y) for x in found)]) for y in ("pair", "frame"))
        moments = list(zip(pair.astype(int).tolist(), frame.astype(int).tolist(), strict=True))
        assert moments == sorted(set(moments))
        for part in found:
            for rows, vehicle in ((part.first, pairs.first), (part.second, pairs.second)):
                assert np.array_equal(r.row_vehicle[rows], vehicle[part.pair])
                assert np.array_equal(r.row_frame[rows], part.frame)
        for p, (one, other) in enumerate(zip(pairs.first.tolist(), pairs.second.tolist(), strict=True)):
            for f in range(int(pairs.low[p]), int(pairs.high[p]) + 1):
                if violates(r, one, other, f, REACH):
                    assert (p, f) in moments
        every = sum(len(x) for x in all_moments(r, pairs, samples))
        assert every == pairs.samples.sum()


def test_simulated_traffic_loses_none() -> None:
    r = simulate(Traffic(seconds=40), seed=11)
    pairs = common_pairs(r, np.ones(r.vehicles, bool))
    near = as_set(near_pairs(r, pairs, REACH))
    violating = set()
    for p, frames in brute_common(r, np.ones(r.vehicles, bool)).items():
        if any(violates(r, *p, f, REACH) for f in frames):
            violating.add(p)
    assert violating <= near
    assert len(near) < 2.5 * len(violating) < len(pairs)  # it is a filter, and a sharp one


@pytest.mark.parametrize("swap", [False, True])
def test_filter_is_sharp_at_constant_speeds(swap: bool) -> None:
    gap = 4.5 + distance(30.0, 24.0, REACH)
    assert gap == pytest.approx(4.5 + 73.65)  # semantics §3
    for extra, kept in ((0.0, True), (-0.1, True), (0.1, False)):
        tracks = [Track(2, 1, cruise(0.0, 30.0, 1)), Track(2, 1, cruise(gap + extra, 24.0, 1))]
        r = make_recording(tracks[::-1] if swap else tracks)
        pairs = common_pairs(r, np.ones(2, bool))
        assert len(near_pairs(r, pairs, REACH)) == kept


def test_filter_is_sharp_across() -> None:
    """Side by side at the same lateral speeds 0: semantics §3 has dRSS_lat(0, 0) = 1.08."""
    assert sideways(0, 0, REACH) == pytest.approx(1.08)
    for extra, kept in ((0.0, True), (0.1, False)):
        apart = 1.8 + 1.08 + extra
        r = make_recording([Track(2, 1, cruise(0, 30, 1)), Track(2, 1, cruise(3, 30, 1, d=-28.0 + apart))])
        assert len(near_pairs(r, common_pairs(r, np.ones(2, bool)), REACH)) == kept


def test_both_bounds_must_hold_in_one_frame() -> None:
    """Near along in one frame and near across in another is no violation, and is dropped."""
    rows = [(0.0, -28.0, 30.0, 0.0, 0.0, 0.0)] * 2
    other = [(20.0, -20.0, 30.0, 0.0, 0.0, 0.0), (300.0, -28.0, 30.0, 0.0, 0.0, 0.0)]
    r = make_recording([Track(2, 1, rows), Track(2, 1, other)])
    assert len(near_pairs(r, common_pairs(r, np.ones(2, bool)), REACH)) == 0


def test_a_filter_that_forgets_a_case_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Planted faults: the test above must see each of them."""
    true_bound = module._bound_along
    for fault in (
        lambda reach, rear, front: true_bound(reach, rear, front) - 0.2,
        lambda reach, rear, front: true_bound(reach, front, rear),
        lambda reach, rear, front: true_bound(reach, rear, front) * 0,
    ):
        monkeypatch.setattr(module, "_bound_along", fault)
        with pytest.raises(AssertionError):
            test_filter_is_sharp_at_constant_speeds(False)
    monkeypatch.setattr(module, "_bound_along", true_bound)
    across = module._bound_across
    monkeypatch.setattr(module, "_bound_across", lambda reach, speed: across(reach, speed) - 0.2)
    with pytest.raises(AssertionError):
        test_filter_is_sharp_across()


def test_parts_do_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    r = simulate(Traffic(seconds=20), seed=2)
    pairs = common_pairs(r, r.kind == "Car")
    whole = near_pairs(r, pairs, REACH)
    parts = module._parts
    monkeypatch.setattr(module, "_parts", lambda pairs, samples: parts(pairs, 500))
    again = near_pairs(r, pairs, REACH)
    assert as_set(again) == as_set(whole)
    assert sum(p.stop - p.start for p in parts(pairs, 500)) == len(pairs)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(recordings(), st.integers(0, 2**20))
def test_triples_against_brute_force(r: Recording, seed: int) -> None:
    eligible = np.ones(r.vehicles, bool)
    pairs = common_pairs(r, eligible)
    chosen = pairs.choose(np.random.default_rng(seed).random(len(pairs)) < 0.5)
    triples = triples_of(r, chosen, pairs)
    found = list(
        zip(
            *(x.tolist() for x in (triples.sv, triples.pov1, triples.pov2, triples.low, triples.high)),
            strict=True,
        )
    )
    expected = []
    for sv, pov1, pov2 in permutations(range(r.vehicles), 3):
        frames = set(frames_of(r, sv)) & set(frames_of(r, pov1)) & set(frames_of(r, pov2))
        one_way = len({int(r.direction[v]) for v in (sv, pov1, pov2)}) == 1
        if frames and one_way and (min(sv, pov2), max(sv, pov2)) in as_set(chosen):
            expected.append((sv, pov1, pov2, min(frames), max(frames)))
    assert sorted(found) == sorted(expected)


def test_reach_must_make_sense() -> None:
    r = make_recording([Track(2, 1, cruise(0, 30, 2)), Track(2, 1, cruise(40, 30, 2))])
    with pytest.raises(ValueError, match="b_min"):
        near_pairs(r, common_pairs(r, np.ones(2, bool)), Reach(0.6, 5, 0, 8, 1, 1))
