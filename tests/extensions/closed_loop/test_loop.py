"""The loop: floats and fractions agree, limits hold, and a drive is what the controller demanded."""

from fractions import Fraction

import numpy as np
import pytest

from extensions.closed_loop.loops import loop_of, problem
from roadproof.extensions.closed_loop.errors import ControllerError
from roadproof.extensions.closed_loop.protocol import OBSERVED
from roadproof.extensions.closed_loop.search.shape import FRICTION
from roadproof.extensions.closed_loop.simulation import exact_drive
from roadproof.semantics.exact.replay import first_breach
from roadproof.world.models import load_vehicle
from roadproof.world.motion import states_at
from roadproof.world.vehicle import with_limits

SCENARIOS = range(1, 9)


def values(number: int, count: int = 6) -> list[tuple[float, ...]]:
    """Return random values of the knobs of a scenario."""
    random = np.random.default_rng(number)
    knobs = problem(number).shape.knobs
    return [tuple(float(x.value(random.uniform(x.low, x.high))) for x in knobs) for _ in range(count)]


@pytest.mark.parametrize("name", ["Coasting", "Sudden", "LateBrake"])
@pytest.mark.parametrize("number", SCENARIOS)
def test_samples_are_those_of_the_exact_drive(name: str, number: int) -> None:
    """``world.motion`` reads the exact drive; the samples of the search come from other code."""
    asked, loop = problem(number), loop_of(name)
    for x in values(number, 3):
        [trial] = asked.run(loop, [x])
        drive = exact_drive(loop, asked.shape.situation(x))
        times = [k * asked.shape.clock.dt for k in range(asked.shape.clock.steps)]
        for vehicle, motion in drive.vehicles.items():
            exact = states_at(motion, times)
            for signal in OBSERVED:
                sampled = getattr(trial.tracks[vehicle], signal)[:-1]
                expected = [float(getattr(state, signal)) for state in exact]
                assert np.allclose(sampled, expected, atol=1e-6), (vehicle, signal)


@pytest.mark.parametrize("number", SCENARIOS)
def test_no_drive_leaves_its_limits(number: int) -> None:
    """The judge looks for a breach of the limits, in dense time."""
    asked, loop = problem(number), loop_of("Sudden")
    car = load_vehicle("car")
    free = with_limits(car, {"v_lon.min": Fraction(0), "a_lat.min": Fraction(-99), "a_lat.max": Fraction(99)})
    mine = with_limits(free, {"a_lon.min": -FRICTION})
    for x in values(number, 3):
        drive = exact_drive(loop, asked.shape.situation(x))
        limits = {name: mine if name == "SV" else free for name in drive.vehicles}
        assert first_breach(drive, limits, asked.shape.clock.horizon) is None


def test_a_vehicle_stands_and_does_not_reverse() -> None:
    asked, loop = problem(4), loop_of("Standing")
    drive = exact_drive(loop, asked.shape.situation(asked.shape.seed))
    last = states_at(drive.vehicles["SV"], [Fraction(10), Fraction(99)])
    assert [x.v_lon for x in last] == [0, 0]
    assert last[0].s == last[1].s


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("NotANumber", "acceleration of nan: demand a finite number (at 1 s)"),
        ("Wordy", "it demands 'brake': return an acceleration"),
        ("Lost", "it demands the lane 'main-9': the road has main-1, main-2"),
        ("Raising", "ZeroDivisionError: division by zero (at 0 s)"),
        ("Sleeping", "no answer within 0.2 s for a whole simulation"),
    ],
)
def test_an_error_says_what_the_controller_did_and_when(name: str, told: str) -> None:
    asked = problem(4)
    with pytest.raises(ControllerError) as error:
        asked.run(loop_of(name, 0.2 if name == "Sleeping" else 20.0), [asked.shape.seed])
    assert told in str(error.value)


def test_a_controller_that_is_not_deterministic_is_named() -> None:
    asked = problem(4)
    with pytest.raises(ControllerError, match="it is not deterministic: after a reset with the same state"):
        exact_drive(loop_of("Moody"), asked.shape.situation(asked.shape.seed))
