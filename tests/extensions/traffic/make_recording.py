"""Recordings made by hand or at random, without a file."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from roadproof.extensions.traffic.formats import pairs as moments
from roadproof.extensions.traffic.formats.highd_columns import lanes_of_markings
from roadproof.extensions.traffic.formats.pairs import Pairs, RssParameters
from roadproof.extensions.traffic.formats.recording import Recording, beside_by_order, occupy_bands, offsets

LANES = lanes_of_markings((8.5, 12.0, 15.5, 19.0), (23.5, 27.0, 30.5, 34.0))
"""Three lanes of 3.5 m each way: 2, 3, 4 (rightmost first) and 6, 7, 8 (rightmost last)."""


@dataclass(frozen=True)
class Track:
    """One vehicle: rows of (s, d, v_lon, v_lat, a_lon, a_lat) from ``first_frame`` on."""

    direction: int
    first_frame: int
    rows: Sequence[Sequence[float]]
    length: float = 4.5
    width: float = 1.8
    kind: str = "Car"


def make_recording(tracks: Sequence[Track], rate: int = 25, name: str = "01") -> Recording:
    counts = np.array([len(t.rows) for t in tracks])
    columns = np.concatenate([np.asarray(t.rows, float) for t in tracks]).T
    direction = np.array([t.direction for t in tracks])
    width = np.array([t.width for t in tracks], float)
    occupancy, lane = occupy_bands(LANES, np.repeat(direction, counts), columns[1], np.repeat(width, counts))
    return Recording(
        name=name,
        rate=rate,
        lanes=LANES,
        beside=beside_by_order(LANES),
        vehicle_id=np.arange(1, len(tracks) + 1),
        direction=direction,
        kind=np.array([t.kind for t in tracks]),
        length=np.array([t.length for t in tracks], float),
        width=width,
        first_frame=np.array([t.first_frame for t in tracks]),
        start=offsets(counts),
        s=columns[0],
        d=columns[1],
        v_lon=columns[2],
        v_lat=columns[3],
        a_lon=columns[4],
        a_lat=columns[5],
        occupancy=occupancy,
        lane=lane,
        zones=(occupancy != 0).astype(np.uint32),
    )


def cruise(s: float, v: float, frames: int, d: float = -28.0, rate: int = 25) -> list[tuple[float, ...]]:
    """Constant speed; the default d is in the middle lane (7) of direction 2."""
    return [(s + v * k / rate, d, v, 0.0, 0.0, 0.0) for k in range(frames)]


def near_pairs(recording: Recording, pairs: Pairs, reach: RssParameters) -> Pairs:
    """The pairs that are near enough for an RSS violation at some moment."""
    found = [x.pair for x in moments.near_moments(recording, pairs, reach)]
    return pairs.choose(np.unique(np.concatenate(found))) if found else pairs
