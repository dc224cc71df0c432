"""Pairs, the pre-filter and triples against brute force over all vehicles and frames."""

from dataclasses import replace
from itertools import combinations, permutations
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import roadproof as rp
from examples import some
from extensions.traffic.make_recording import Track, cruise, make_recording, near_pairs
from roadproof.errors import InputError
from roadproof.extensions.maps import topology
from roadproof.extensions.traffic.formats import large
from roadproof.extensions.traffic.formats import pairs as module
from roadproof.extensions.traffic.formats.believable import _check_lanelets
from roadproof.extensions.traffic.formats.content import plain_text
from roadproof.extensions.traffic.formats.median import Median
from roadproof.extensions.traffic.formats.pairs import (
    DetectionRange,
    Pairs,
    RssParameters,
    all_moments,
    common_pairs,
    near_moments,
    pairs_in_sight,
    triples_of,
)
from roadproof.extensions.traffic.formats.plausible import _worst
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.repeats import frame_pair
from roadproof.extensions.traffic.formats.samples import HEADER
from roadproof.extensions.traffic.formats.sources import find_sources
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.world.signals import KINDS

REACH = RssParameters(rho=0.6, a_max=5.0, b_min=6.0, b_max=8.0, a_max_lat=1.5, b_min_lat=1.5)


def frames_of(r: Recording, vehicle: int) -> range:
    return range(int(r.first_frame[vehicle]), int(r.last_frame[vehicle]) + 1)


def distance(rear: float, front: float, reach: RssParameters) -> float:
    """The paper's dRSS_lon."""
    way = rear * reach.rho + reach.a_max * reach.rho**2 / 2
    return max(
        0.0, way + (rear + reach.a_max * reach.rho) ** 2 / (2 * reach.b_min) - front**2 / (2 * reach.b_max)
    )


def sideways(v_1: float, v_2: float, reach: RssParameters, signed: bool = False) -> float:
    """The paper's dRSS_lat; ``signed`` leaves out what needs no braking."""
    one, other = v_1 + reach.rho * reach.a_max_lat, v_2 - reach.rho * reach.a_max_lat
    squares = (max(0, one) ** 2 + min(0, other) ** 2) if signed else (one**2 + other**2)
    return max(
        0.0, (v_1 - v_2) * reach.rho + reach.a_max_lat * reach.rho**2 + squares / (2 * reach.b_min_lat)
    )


def violates(
    r: Recording, one: int, other: int, frame: int, reach: RssParameters, reading: str = "rss"
) -> bool:
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


@settings(max_examples=some(150), deadline=None, derandomize=True)
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
    reach = RssParameters(*random.uniform([0, 0, 0.5, 0.5, 0, 0.5], [2, 8, 9, 9, 3, 3]).tolist())
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
    r = simulate(TrafficSettings(seconds=40), seed=11)
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
        lambda pieces, rear, front: true_bound(pieces, rear, front) - 0.2,
        lambda pieces, rear, front: true_bound(pieces, front, rear),
        lambda pieces, rear, front: true_bound(pieces, rear, front) * 0,
    ):
        monkeypatch.setattr(module, "_bound_along", fault)
        with pytest.raises(AssertionError):
            test_filter_is_sharp_at_constant_speeds(False)
    monkeypatch.setattr(module, "_bound_along", true_bound)
    across = module._bound_across
    monkeypatch.setattr(module, "_bound_across", lambda pieces, one, other: across(pieces, one, other) - 0.2)
    with pytest.raises(AssertionError):
        test_filter_is_sharp_across()


def test_parts_do_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    r = simulate(TrafficSettings(seconds=20), seed=2)
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
        near_pairs(r, common_pairs(r, np.ones(2, bool)), RssParameters(0.6, 5, 0, 8, 1, 1))


# --- The pre-filter of pairs at its bounds: sizes, signs and speeds that differ between the two vehicles

SHORT = RssParameters(rho=0.6, a_max=4.0, b_min=3.0, b_max=7.0, a_max_lat=1.5, b_min_lat=1.2)


def along(rear: float, front: float) -> float:
    """The greatest distance of a longitudinal violation at these speeds, whatever their signs."""
    v, m = abs(rear), abs(front)
    speeded = v + SHORT.a_max * SHORT.rho
    way = v * SHORT.rho + SHORT.a_max * SHORT.rho**2 / 2 + speeded**2 / (2 * SHORT.b_min)
    return max(0.0, way - m**2 / (2 * SHORT.b_max))


def across(one: float, other: float) -> float:
    u = max(abs(one), abs(other))
    moved = u + SHORT.rho * SHORT.a_max_lat
    return 2 * u * SHORT.rho + SHORT.a_max_lat * SHORT.rho**2 + moved**2 / SHORT.b_min_lat


def is_near(tracks: list[Track]) -> bool:
    r = make_recording(tracks)
    return len(near_pairs(r, common_pairs(r, np.ones(2, bool)), SHORT)) == 1


@pytest.mark.parametrize("seed", range(40))
def test_a_pair_is_near_up_to_its_bound_and_no_further(seed: int) -> None:
    """One frame, so that extremes are values: along and across, either vehicle ahead and to the left."""
    rng = np.random.default_rng(seed)
    lengths, widths = rng.uniform(2, 18, 2), rng.uniform(1, 2.6, 2)
    speeds, drifts = rng.uniform(-40, 40, 2), rng.uniform(-2, 2, 2)
    front, left = int(rng.integers(2)), int(rng.integers(2))
    far = lengths[front] + along(speeds[1 - front], speeds[front])
    wide = widths[left] + across(*drifts)
    for beyond_s, beyond_d in ((-0.05, -0.05), (0.05, -0.05), (-0.05, 0.05)):
        s, d = [0.0, 0.0], [-25.0, -25.0]
        s[front] += far + beyond_s
        d[left] += wide + beyond_d
        tracks = [
            Track(2, 1, [(s[k], d[k], speeds[k], drifts[k], 0.0, 0.0)], float(lengths[k]), float(widths[k]))
            for k in range(2)
        ]
        assert is_near(tracks) == (beyond_s < 0 and beyond_d < 0), (beyond_s, beyond_d)


def in_sight(r: Recording, sight: DetectionRange) -> dict[tuple[int, int], int]:
    """By pair the lanes in which both are in a frame, one ahead of the other by no more than the bound."""
    rows = [range(r.start[k], r.start[k + 1]) for k in range(r.vehicles)]
    found: dict[tuple[int, int], int] = {}
    for a in range(r.vehicles):
        for b in range(a + 1, r.vehicles):
            if r.direction[a] != r.direction[b]:
                continue
            bounds = {}
            for rear, front in ((a, b), (b, a)):
                most, least = r.v_lon[rows[rear]].max(), r.v_lon[rows[front]].min()
                gap = max(sight.farthest, sight.thw * most, sight.ttc * (most - least))
                bounds[rear] = gap + r.length[front] + 0.001
            for i in rows[a]:
                for j in rows[b]:
                    apart = r.s[j] - r.s[i]
                    near = -bounds[b] <= apart <= bounds[a]
                    if r.row_frame[i] == r.row_frame[j] and near:
                        lanes = int(r.occupancy[i] & r.occupancy[j])
                        if lanes:
                            found[a, b] = found.get((a, b), 0) | lanes
    return found


@pytest.mark.parametrize("seed", range(30))
def test_pairs_in_sight_are_those_of_a_brute_force(seed: int) -> None:
    rng = np.random.default_rng(seed)
    tracks = []
    for _ in range(7):
        frames = int(rng.integers(1, 8))
        s, v = rng.uniform(0, 250), rng.uniform(5, 40)
        rows = [
            (s + v * k / 25, rng.uniform(-34, -22), v + rng.uniform(-3, 3), 0.0, 0.0, 0.0)
            for k in range(frames)
        ]
        tracks.append(Track(2, int(rng.integers(0, 6)), rows, float(rng.uniform(3, 16))))
    r = make_recording(tracks)
    sight = DetectionRange(*rng.uniform([0.1, 0.1, 1], [4, 2, 60]).tolist())
    if seed % 2:  # the time to collision decides alone
        sight = DetectionRange(sight.ttc * 5, 0.01, 0.5)
    pairs, lanes = pairs_in_sight(r, common_pairs(r, np.ones(r.vehicles, bool)), sight)
    found = zip(pairs.first.tolist(), pairs.second.tolist(), lanes.tolist(), strict=True)
    assert {(a, b): mask for a, b, mask in found} == in_sight(r, sight)


# --- Parts of readers that recordings in tests pass by: medians that are put into files, lanes that are told


@pytest.mark.parametrize("seed", range(20))
def test_a_median_of_numbers_in_a_file_is_that_of_all(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scale = min(seed, 1)  # once all are equal
    parts = [scale * rng.normal(size=n).round(1) for n in (1, *rng.integers(0, 40, rng.integers(2, 12)))]
    for most in (1, 5, 30, 10_000):
        median = Median(most)
        for part in parts:
            median.add(part)
        assert median.value() == np.median(np.concatenate(parts))


def test_a_box_is_on_the_lane_that_is_told_for_it(tmp_path: Path) -> None:
    """The first lane is checked as every other one."""
    folder = rp.simulate(tmp_path, seconds=20, seed=3, ramp="merge", jobs=1).folder
    [source] = find_sources(folder / "01_tracks.csv")
    recording = source.read()
    head = tmp_path / "head.json"
    _check_lanelets(head, recording)
    for lane in range(len(recording.lanes)):
        row = int(np.flatnonzero((recording.lane >= 0) & (recording.lane != lane))[0])
        wrong = recording.lane.copy()
        wrong[row] = lane
        if recording.occupancy[row] >> lane & 1:
            continue
        with pytest.raises(InputError, match="the box is not on that lane"):
            _check_lanelets(head, replace(recording, lane=wrong))


def test_text_that_is_no_table_stays_as_it_is() -> None:
    for content in (b'<a b="1,2"/>\n', b'{"a": "1,2"}\n', b'["1,2"]\n'):
        assert plain_text(Path("x"), content) == content
    assert plain_text(Path("x"), b'"a","b"\r\n1,"2"\r\n') == b"a,b\n1,2\n"
    with pytest.raises(InputError, match="row 1: a comma or a quote within a quoted cell"):
        plain_text(Path("x"), b'"a,b"\n')


@pytest.mark.parametrize("place", range(1, 6))
def test_the_sample_before_which_two_courses_differ_most(place: int) -> None:
    signal = np.arange(8.0)
    signal[place:] += 3
    assert _worst(signal, np.arange(8.0), 0, 6) == place
    assert _worst(np.concatenate((np.zeros(2), signal)), np.arange(-2, 8.0), 2, 8) == place + 2


def test_the_kind_of_a_vehicle_is_that_of_its_label(tmp_path: Path) -> None:
    folder = rp.simulate(tmp_path, seconds=5, seed=1, jobs=1).folder
    [source] = find_sources(folder / "01_tracks.csv")
    recording = source.read()
    plain = replace(recording, kind=np.full(recording.vehicles, "Car"))
    assert {*plain.kind_code.tolist()} == {KINDS.index("car") + 1}
    labelled = replace(plain, label=np.full(recording.vehicles, "bus"))
    assert {*labelled.kind_code.tolist()} == {KINDS.index("bus") + 1}


def test_pairs_are_known_by_the_moments_of_both(tmp_path: Path) -> None:
    """The order of the two does not matter, and no other pair has the same keys."""
    folder = rp.simulate(tmp_path, seconds=20, seed=1, jobs=1).folder
    [source] = find_sources(folder / "01_tracks.csv")
    recording = source.read()
    recording = replace(recording, moments=np.arange(1, len(recording.s) + 1))
    seen: dict[int, set[int]] = {}
    for first in range(4):
        for second in range(first + 1, 5):
            one = frame_pair(recording, first, second, False)
            assert one.keys == frame_pair(recording, second, first, False).keys
            for key in one.keys:
                seen.setdefault(key, set()).add(10 * first + second)
    assert seen
    assert all(len(pairs) == 1 for pairs in seen.values())


def test_the_middle_is_that_of_the_lanelets_beside_the_main_road(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(topology, "length_of", lambda lanelets, chain: len(chain))
    links: Any = SimpleNamespace(lanelets={})
    with_main = [False, True, True, True, False, False]
    assert topology._middle(links, tuple("abcdef"), with_main) == 2
    assert topology._middle(links, tuple("abcdef"), with_main[::-1]) == 3
    assert topology._middle(links, tuple("abcd"), [False] * 4) == 2


def test_rows_of_vehicles_that_were_not_counted_are_told(tmp_path: Path) -> None:
    path = tmp_path / "x.csv"
    path.write_text(f"{','.join(HEADER)}\n" + "".join(f"{k / 25},1,0,0,1,0,0,0,4,2\n" for k in range(5)))
    survey: Any = SimpleNamespace(counts=np.array([5]), index={"2": 0})
    with pytest.raises(InputError, match="the file changed while it was read"):
        large._divide_rows(path, survey, tmp_path)
