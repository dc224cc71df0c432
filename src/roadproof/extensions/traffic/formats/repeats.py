"""Identification of pairs that several windows of a recording show, which count once.

A vehicle at a moment is known again by how it moves in the next half second (``Recording.moments``), a
pair by both at once, wherever the windows put time 0, the origin and the vehicles' ids.
"""

import hashlib
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from roadproof.extensions.traffic.formats.recording import Floats, Integers, Recording

STEPS = 5
"""So many steps in a row must be the same."""


def moments_of(motion: Floats, start: Integers) -> Integers:
    """A number for each sample that says how its vehicle moves from there on for STEPS samples.

    ``motion`` has a row a sample, of values that do not depend on where the window's origin is. 0 stands for
    a motion that many vehicles have: standing, steady, or at the end of what is seen.
    """
    made = np.zeros(len(motion), np.int64)
    for begin, end in pairwise(start.tolist()):
        for k in range(begin, end - STEPS + 1):
            seen = motion[k : k + STEPS]
            if len(np.unique(seen, axis=0)) > STEPS // 2:
                made[k] = _number(seen.tobytes())
    return made


def _number(content: bytes) -> int:
    return int.from_bytes(hashlib.blake2b(content, digest_size=8).digest(), "big") >> 1


@dataclass(frozen=True)
class FramePair:
    """A pair of a recording on its common frames from ``low`` on: ``keys`` are its moments, 0 for unknown."""

    first: int
    second: int
    low: int
    violating: bool
    keys: tuple[int, ...]


def frame_pair(recording: Recording, first: int, second: int, violating: bool) -> FramePair:
    """The pair of two vehicle indices."""
    low = int(max(recording.first_frame[first], recording.first_frame[second]))
    high = int(min(recording.last_frame[first], recording.last_frame[second]))
    one, other = (
        recording.moments[recording.start[v] + low - recording.first_frame[v] :][: high - low + 1]
        for v in (first, second)
    )
    keys = tuple(
        _number(b"%d %d" % (min(a, b), max(a, b))) if a and b else 0
        for a, b in zip(one.tolist(), other.tolist(), strict=True)
    )
    ids = sorted(int(recording.vehicle_id[v]) for v in (first, second))
    return FramePair(ids[0], ids[1], low, violating, keys)
