"""Samples that are no motion of vehicles are faults, which cover nothing."""

import numpy as np
import pytest

from roadproof.extensions.traffic.evaluate.faults import faults_of
from roadproof.extensions.traffic.evaluate.one_trace import of_columns
from roadproof.world.models import load_road

TIMES = np.arange(21) / 10


def faults(pov: np.ndarray, v: float, d: float = 1.0, jump: float = 0.0) -> tuple[str, ...]:
    """The faults of SV at 20 m/s from 50 m on, and POV at ``pov``."""
    own = 50 + 20 * TIMES
    own[10:] += jump
    columns = {
        "time": np.tile(TIMES, 2),
        "vehicle": ["SV"] * 21 + ["POV"] * 21,
        "s": np.concatenate((own, pov)),
        "d": [1.0] * 21 + [d] * 21,
        "v_lon": [20.0] * 21 + [v] * 21,
        **{x: [0.0] * 42 for x in ("v_lat", "a_lon", "a_lat")},
        "length": [4.5] * 42,
        "width": [1.8] * 42,
    }
    return faults_of(of_columns(columns, load_road("main-2")))


def test_motion_has_no_faults() -> None:
    assert faults(90 + 10 * TIMES, 10) == ()
    assert faults(60 + 10 * TIMES, 10, d=-2.5) == ()


@pytest.mark.parametrize("jump", [75.0, 3.0, -3.0])
def test_a_jump_is_a_fault(jump: float) -> None:
    (told,) = faults(150 + 10 * TIMES, 10, jump=jump)
    assert told.startswith("vehicle SV: s changes by")
    assert told.endswith("no vehicle jumps")


def test_a_vehicle_that_drives_through_another_is_a_fault() -> None:
    (told,) = faults(60 + 10 * TIMES, 10)
    assert told == "vehicle SV drives through POV 0.9 s after the first sample"
