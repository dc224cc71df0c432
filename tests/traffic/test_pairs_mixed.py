"""The pre-filter of pairs at its bounds: sizes, signs and speeds that differ between the two vehicles."""

import numpy as np
import pytest

from roadproof.recordings.formats.pairs import DetectionRange, Reach, common_pairs, near_pairs, pairs_in_sight
from roadproof.recordings.formats.recording import Recording
from traffic.make_recording import Track, make_recording

REACH = Reach(rho=0.6, a_max=4.0, b_min=3.0, b_max=7.0, a_max_lat=1.5, b_min_lat=1.2)


def along(rear: float, front: float) -> float:
    """The greatest distance of a longitudinal violation at these speeds, whatever their signs."""
    v, m = abs(rear), abs(front)
    speeded = v + REACH.a_max * REACH.rho
    way = v * REACH.rho + REACH.a_max * REACH.rho**2 / 2 + speeded**2 / (2 * REACH.b_min)
    return max(0.0, way - m**2 / (2 * REACH.b_max))


def across(one: float, other: float) -> float:
    u = max(abs(one), abs(other))
    moved = u + REACH.rho * REACH.a_max_lat
    return 2 * u * REACH.rho + REACH.a_max_lat * REACH.rho**2 + moved**2 / REACH.b_min_lat


def is_near(tracks: list[Track]) -> bool:
    r = make_recording(tracks)
    return len(near_pairs(r, common_pairs(r, np.ones(2, bool)), REACH)) == 1


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
