"""Where danger begins and safety comes back, looked up pair by pair and frame by frame."""

import numpy as np

from roadproof.recordings.evaluate.disturbances import NEVER, Disturbances, _last, _Lookup, _next
from roadproof.recordings.formats.pairs import Pairs


def column(*values: int) -> np.ndarray:
    return np.array(values)[:, None]


def test_the_next_and_the_last_true_sample_of_each_frame() -> None:
    """Frame 0 is a frame like others, and where there is none it is not told."""
    frames = column(0, 1, 2, 3)
    truth = column(0, 1, 0, 0).astype(bool)
    assert _next(truth, frames).ravel().tolist() == [1, 1, NEVER, NEVER]
    assert _last(truth, frames).ravel().tolist() == [-1, 1, 1, 1]
    assert _last(column(1, 0, 0, 0).astype(bool), frames).ravel().tolist() == [0, 0, 0, 0]


def found() -> Disturbances:
    """Vehicles 0 and 1 in frames 5 to 7, in danger from 6 on; 0 and 2 in frames 2 and 3, always in danger."""
    pairs = Pairs(*(np.array(x) for x in ([0, 0], [1, 2], [5, 2], [7, 3])))
    safe = np.array([5, NEVER, NEVER, NEVER, NEVER])
    last = np.array([-1, 6, 7, 2, 3])
    start, end = np.array([5, NEVER]), (np.array([7, -1]),)
    return Disturbances(pairs, pairs, start, end, np.array([0, 3, 5]), safe, (last,))


def test_a_frame_of_a_pair_is_looked_up() -> None:
    ones, others = np.array([1, 0, 1, 2, 2, 1]), np.array([0, 1, 0, 0, 1, 2])
    look = _Lookup(found(), ones, others)
    frames = np.array([7, 5, 4, 3, 3, 6])
    # 0 and 1 before their first frame; 1 and 2 are no such pair
    assert look.last_danger(0, frames).tolist() == [7, -1, -1, 3, -1, -1]


def test_a_pair_that_never_violates_is_always_safe() -> None:
    look = _Lookup(found(), np.array([0, 0, 1]), np.array([1, 1, 2]))
    index, latest = np.arange(3), np.array([7, 7, 7])
    assert look.next_safe(index, np.array([5, 6, 6]), latest).tolist() == [5, NEVER, 6]
    assert look.next_safe(index, np.array([5, 5, 8]), np.array([4, 7, 7])).tolist() == [NEVER, 5, NEVER]
