"""The rate of times is found from their text: any constant rate, to the rounding of the decimals."""

import random
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from random import Random

import numpy as np
import pytest

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.clock import Clock, clock_of
from roadproof.extensions.traffic.formats.sources import find_source

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


@pytest.mark.parametrize("seed", range(40))
def test_one_mistyped_time_costs_its_vehicle_alone(seed: int, tmp_path: Path) -> None:
    """Of 3 to 12 vehicles at a random rate, one time has another digit, or lies a fraction of a step off."""
    dice = Random(seed)
    rate = dice.choice((5, 10, 25, 30))
    count, samples = dice.randrange(3, 13), dice.randrange(20, 60)
    bad = dice.randrange(1, count + 1)
    rows = [
        [f"{k / rate:.4f}", str(n), f"{40 * n + 20 * k / rate:.4f}"]
        for n in range(1, count + 1)
        for k in range(samples)
    ]
    wrong = rows[(bad - 1) * samples + dice.randrange(1, samples - 1)]
    shift = dice.choice((0.11, 0.37, 0.45, -0.23, 7.43)) / rate
    wrong[0] = f"{float(wrong[0]) + shift:.4f}"
    path = tmp_path / "a.csv"
    lane = 'id = "a"\nlane = "a"\nzone = "main"\nattribute = "main"\ns = [-inf, inf]\nd = [0, 4]\n'
    path.with_name("a_road.toml").write_text(f"[[lanelet]]\n{lane}")
    lines = [",".join((*row, "3", "20", "0", "0", "0", "4", "1.8")) for row in rows]
    path.write_text("\n".join(["time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width", *lines, ""]))
    read = find_source(path).read()
    assert read.rate == rate
    assert read.vehicle_id.tolist() == [n for n in range(1, count + 1) if n != bad]
    for n, (begin, end) in zip(read.vehicle_id.tolist(), pairwise(read.start.tolist()), strict=True):
        assert np.allclose(read.s[begin:end], [float(row[2]) for row in rows if row[1] == str(n)])
    assert any(x.startswith(f"left out 1 of {count} vehicles ({bad}): ") for x in read.notes)
