"""Three tests of a driver model that were made from outside, with what a simulation of them says."""

from fractions import Fraction as F
from pathlib import Path

import pytest

from extensions.drivers.read import specification, values
from roadproof.extensions.traffic.evaluate.decisions import Drivers, decide_trace
from roadproof.extensions.traffic.evaluate.one_trace import read_samples

FOLDER = Path(__file__).parents[4] / "shared" / "data" / "drivers"


def decided(name: str, scenario: str, vehicles: tuple[str, ...]):
    path = FOLDER / f"{name}.csv"
    if not path.exists():
        pytest.skip(f"{path} is not there: tests of driver models that were made from outside")
    drivers = Drivers(specification(), {**values(), "minDanger": F(0)}, ("careful",))
    [found] = decide_trace(read_samples(path), drivers, scenario, vehicles, 0.0, vehicles)
    return found


def test_a_smooth_cut_in_is_a_collision() -> None:
    found = decided("C01", "scenario_1", ("SV", "POV"))
    assert found.side == "unpreventable"
    assert found.speed is not None
    assert 8 < found.speed < 10


def test_a_steady_cut_in_is_a_collision() -> None:
    assert decided("C08", "scenario_1", ("SV", "POV")).side == "unpreventable"


def test_a_cut_out_is_seen_late_and_leaves_room() -> None:
    found = decided("A06", "scenario_2", ("SV", "POV1", "POV2"))
    assert found.side == "preventable"
    assert found.gap == pytest.approx(27.96, abs=0.05)
