"""The motion of vehicles in a manoeuvre in which a model drives SV: exact, in pieces.

It is worked out from times, apart from the formulas of ``driver.spec``; the judge compares the two.
"""

from collections.abc import Mapping
from fractions import Fraction
from functools import partial

from roadproof.errors import UsageError
from roadproof.extensions.drivers import manoeuvres
from roadproof.extensions.drivers.braking import AssistedBraking, Ramp, pieces_of
from roadproof.extensions.drivers.driver_model import Law
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.models import driver_model
from roadproof.extensions.drivers.start_scene import StartScene
from roadproof.extensions.drivers.stepped import course_of
from roadproof.library.scenarios import SUBJECT
from roadproof.library.specification import Specification
from roadproof.world.drive import Across, Along, Drive, motion_of
from roadproof.world.road import Lanelet, Road, adjacency

_STILL = Fraction(0)
_STEERING = Fraction(1, 2)  # s in which a vehicle that has changed lanes ends to move across
OWN_LANE = "right"
"""The lane of SV."""
_BOTH_LANES = (OWN_LANE, "left")


def require(specification: Specification, values: Mapping[str, Fraction]) -> None:
    """Check that definitions of drivers are read and go with ``values`` (SI). Raises ``UsageError``."""
    name = "unpreventable_cutIn_careful"
    if name not in specification.definitions:
        raise UsageError(f"there is no definition '{name}': driver models need the specification 'driver'")
    settings = DriverSettings(values, specification.options)
    choices = settings.choices
    if choices.cc_aeb == "none":
        return
    driver, aeb = settings.parameters.cc_braking, settings.parameters.aeb_braking
    if aeb < driver:
        raise UsageError(
            f"aeb_braking={float(aeb):g} m/s^2: AEB brakes at least as hard as the driver, by "
            f"cc_braking={float(driver):g} m/s^2; raise aeb_braking, or choose cc_aeb=none"
        )
    if choices.cc_aeb == "add" and choices.cc_gate != "none":
        raise UsageError(
            f"cc_aeb=add, cc_gate={choices.cc_gate}: this combination is not supported, as a gate may "
            "open while AEB brakes; choose cc_gate=none, cc_aeb=replace or cc_aeb=max"
        )


def drive_of(
    manoeuvre: manoeuvres.Manoeuvre, model: str, values: manoeuvres.Values, reading: DriverSettings
) -> Drive:
    """Return the drive from these initial values on.

    Raises ``InputError`` where an instant of it is irrational.
    """
    start, law = manoeuvres.start_of(manoeuvre, values), driver_model(model).law
    middle, speed = start.middle, start.Ve0
    motion = partial(motion_of, (start.length, start.width))
    if law is None:
        driven = course_of(manoeuvre, values).along
    else:
        driven = motion_under(law, manoeuvre.name, start, reading)
    match start:
        case manoeuvres.CutIn(dV0=slower, Vy=w):
            is_aided = law is not None and any(True for _ in law.speeds(start, reading))
            across = _across(start.lane, -w, start.width / 4 if is_aided else _STILL)
            place = (start.dx0 + start.length, middle + start.lane)
            others = {manoeuvres.OTHER: motion(place, (speed - slower, -w), (), across)}
        case manoeuvres.CutOut(Vy=w):
            leaves = motion((start.first, middle), (speed, w), (), _across(start.lane, w))
            others = {
                manoeuvres.FIRST: leaves,
                manoeuvres.SECOND: motion((start.second, middle), (start.Vf0, _STILL), ()),
            }
        case manoeuvres.Deceleration():
            place, slow = (start.dx0 + start.length, middle), speed - start.dV0
            others = {manoeuvres.OTHER: motion(place, (slow, _STILL), _braking(slow, start))}
    return Drive({SUBJECT: motion((_STILL, middle), (speed, _STILL), driven), **others})


def motion_under(
    law: Law, manoeuvre: manoeuvres.ManoeuvreName, start: manoeuvres.Start, settings: DriverSettings
) -> list[Along]:
    """Return how SV moves along the road until it stands; nothing where it never responds.

    Raises ``InputError`` where it stands at an irrational instant.
    """
    response = law.respond(manoeuvre, StartScene(start), settings)
    if response is None:
        return []
    return pieces_of(start.Ve0, [(response.onset, _STILL, _STILL), *response.phases])


def rest_of(drive: Drive) -> Fraction:
    """Return when the last piece of all motions begins (s)."""
    pieces = (motion.pieces for motion in drive.vehicles.values())
    lasting = (sum((x.duration for x in those if x.duration is not None), _STILL) for those in pieces)
    return max(lasting, default=_STILL)


def road_of(manoeuvre: manoeuvres.Manoeuvre, values: manoeuvres.Values) -> Road:
    """Return a road of two endless lanes; the vehicles begin in their middles."""
    lane = manoeuvres.start_of(manoeuvre, values).lane
    lanelets = tuple(
        Lanelet(name, name, "main", "main", (None, None), (lane * k, lane * (k + 1)))
        for k, name in enumerate(_BOTH_LANES)
    )
    return Road("two-lanes", lanelets, adjacency([_BOTH_LANES]))


def _across(lane: Fraction, w: Fraction, past: Fraction = _STILL) -> list[Across]:
    """Return a motion to the middle of the adjacent lane at ``w`` (m/s), slower in the last half second.

    ``past``: it may go so far beyond, and is not slower before the middle, where one box is behind the other.
    """
    steering = min(_STEERING, (2 * past or lane) / abs(w))
    steady = lane / abs(w) - (_STILL if past else steering / 2)
    before: list[Across] = [(steady, _STILL)] if steady > 0 else []
    return [*before, (steering, -w / steering)]


def _braking(speed: Fraction, start: manoeuvres.Deceleration) -> list[Along]:
    """Return how POV brakes, at once or harder and harder, until it stands."""
    if start.dGdt is None:
        return _brakes(speed, start.Gx)
    return AssistedBraking(Ramp(_STILL, start.Gx / start.dGdt, start.Gx)).pieces(speed)


def _brakes(speed: Fraction, braking: Fraction) -> list[Along]:
    return [(speed / braking, -braking, _STILL)] if speed > 0 else []
