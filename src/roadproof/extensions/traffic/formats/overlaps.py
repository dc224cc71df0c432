"""Overlaps of vehicles' boxes in a recording."""

from collections.abc import Iterator
from typing import TypeAlias

import numpy as np

from roadproof.extensions.traffic.formats.pairs import (
    DistanceBounds,
    Pairs,
    common_pairs,
    ever_within,
    row_of,
)
from roadproof.extensions.traffic.formats.recording import Recording

Overlap: TypeAlias = tuple[int, int, int, float]
"""Both ids, in how many frames, how deep at most (m)."""


def find_overlaps(recording: Recording, among: Pairs | None = None) -> Iterator[Overlap]:
    """Pairs whose boxes overlap with positive area: both ids, in how many frames, how deep at most (m).

    All pairs are looked at, or those ``among``.

    Depth is the smaller of the overlaps along and across, as large as it ever gets.
    """
    pairs = common_pairs(recording, np.ones(recording.vehicles, bool)) if among is None else among
    first, second = pairs.first, pairs.second
    touching = [
        DistanceBounds(position, size[first], size[second])
        for position, size in ((recording.s, recording.length), (recording.d, recording.width))
    ]
    pairs = pairs.choose(ever_within(recording, pairs, touching))
    for first, second, low, high in zip(pairs.first, pairs.second, pairs.low, pairs.high, strict=True):
        one, other = (
            slice(int(row_of(recording, v, low)), int(row_of(recording, v, high)) + 1)
            for v in (first, second)
        )
        depth = np.full(int(high - low + 1), np.inf)
        for position, size in ((recording.s, recording.length), (recording.d, recording.width)):
            front = np.minimum(position[one], position[other])
            rear = np.maximum(position[one] - size[first], position[other] - size[second])
            depth = np.minimum(depth, np.round(front - rear, 6))
        if (depth > 0).any():
            ids = recording.vehicle_id
            yield int(ids[first]), int(ids[second]), int(np.count_nonzero(depth > 0)), float(depth.max())


def overlap_text(overlap: Overlap) -> str:
    """An overlap as a line."""
    one, other, frames, depth = overlap
    return f"vehicles {one} and {other} overlap in {frames} frames, by up to {depth:.2f} m"


def describe_overlaps(recording: Recording) -> Iterator[str]:
    """One line for each pair that overlaps."""
    return map(overlap_text, find_overlaps(recording))
