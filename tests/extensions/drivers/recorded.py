"""Judged drives of driver models as recordings: some time straight on, then the manoeuvre."""

from collections.abc import Mapping
from fractions import Fraction

from extensions.traffic.make_recording import Track, make_recording
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import drive_of
from roadproof.extensions.drivers.manoeuvres import Manoeuvre
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.world.motion import State, state_at

RATE = 25
BEFORE = 2 * RATE  # samples before the manoeuvre begins
FAR = 200.0  # m
_FARTHER = (("deceleration", "POV"), ("cut-out", "POV2"))
_RIGHT = -30.5  # m, the right edge of the middle lane


def recorded(
    manoeuvre: Manoeuvre,
    model: str,
    values: Mapping[str, Fraction],
    reading: DriverSettings,
    seconds: int = 6,
) -> Recording:
    """Vehicles 1, 2 (and 3) are SV, POV (or POV1, POV2); the manoeuvre begins in frame BEFORE.

    Before that, POV that brakes and POV2 are FAR farther ahead, or danger would begin earlier.
    """
    drive = drive_of(manoeuvre, model, values, reading)
    tracks = []
    for name in manoeuvre.vehicles:
        motion = drive.vehicles[name]
        states = [state_at(motion, Fraction(k, RATE)) for k in range(seconds * RATE + 1)]
        far = FAR if (manoeuvre.name, name) in _FARTHER else 0.0
        before = [_earlier(states[0], Fraction(k, RATE), far) for k in range(BEFORE, 0, -1)]
        rows = [*before, *map(_row, states)]
        tracks.append(Track(2, 0, rows, float(motion.length), float(motion.width)))
    return make_recording(tracks, RATE)


def _row(state: State) -> tuple[float, ...]:
    names = ("s", "d", "v_lon", "v_lat", "a_lon", "a_lat")
    s, d, *others = (float(getattr(state, name)) for name in names)
    return s, d + _RIGHT, *others


def _earlier(state: State, ago: Fraction, far: float) -> tuple[float, ...]:
    """Where a vehicle was that drove straight on as fast as it does now."""
    s, d, v, *_ = _row(state)
    return s - v * float(ago) + far, d, v, 0.0, 0.0, 0.0
