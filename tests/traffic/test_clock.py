"""The rate of times is found from their text: any constant rate, to the rounding of the decimals."""

import random
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from roadproof.errors import InputError
from roadproof.recordings.formats.clock import Clock, clock_of

RATES = (1, 3, 7, 10, 25, 30, 50, 60, 2.5, 12.5, 29.97, Fraction(30000, 1001), Fraction(1, 2))
OFFSETS = (0.0, 0.3, 17.123, 1.7e9)


def clock(times: np.ndarray) -> Clock:
    """The clock of one vehicle's times."""
    steps, counts = np.unique(np.diff(times), return_counts=True)
    return clock_of(Path("a.csv"), np.unique(times), steps, counts)


@pytest.mark.parametrize("rate", RATES, ids=str)
@pytest.mark.parametrize("offset", OFFSETS)
def test_a_constant_rate_is_found_from_rounded_times(rate: Fraction, offset: float) -> None:
    random.seed(f"{rate} {offset}")
    for places in (3, 4, 6):
        for count in (5, random.randrange(6, 90), random.randrange(90, 3000)):
            times = np.array([round(offset + k / float(rate), places) for k in range(count)])
            found = clock(times)
            assert (found.frames(times) == np.arange(count)).all()
            assert (found.misses(times) <= found.slack).all()
            drift = abs(float(found.rate) / float(rate) - 1) * (count - 1) / float(rate)
            assert drift <= 2.1 * 10.0**-places + 1e-5


def test_a_mistyped_time_does_not_set_the_step() -> None:
    times = np.arange(200) / 10
    times[77] = 7.73
    found = clock(times)
    assert found.rate == 10
    assert np.flatnonzero(found.misses(times) > found.slack).tolist() == [77]


def test_uneven_times_are_refused() -> None:
    times = np.random.default_rng(3).uniform(0, 9, 60).cumsum()
    with pytest.raises(InputError, match="use equal steps"):
        clock(times)
