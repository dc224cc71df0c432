"""How vehicles move in a manoeuvre when SV is driven by a model: exactly, in pieces.

It is worked out from times, apart from the formulas of ``driver.spec``; the judge compares the two.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from roadproof.drivers.braking import AssistedBraking, Ramp
from roadproof.drivers.manoeuvres import FIRST, OTHER, SECOND, Manoeuvre, Values, lane_width
from roadproof.drivers.models import MODELS
from roadproof.drivers.stepped import course_of
from roadproof.library.scenarios import SUBJECT
from roadproof.world.drive import Drive
from roadproof.world.pieces import Across, Along, motion_of
from roadproof.world.road import Lanelet, Road, pairs

_STILL = Fraction(0)
_STEERING = Fraction(1, 2)  # s in which a vehicle that has changed lanes ends to move across
OWN_LANE = "right"
"""The lane of SV."""
_BOTH_LANES = (OWN_LANE, "left")


@dataclass(frozen=True)
class DriverSettings:
    """Values of parameters (SI) and options, as the specification at hand has them."""

    values: Mapping[str, Fraction]
    options: Mapping[str, str]


def drive_of(manoeuvre: Manoeuvre, model: str, values: Values, reading: DriverSettings) -> Drive:
    """The drive from these initial values on. Raises ``InputError`` where an instant of it is irrational."""
    lane, width = lane_width(values), values["width"]
    middle, apart, speed = (lane + width) / 2, values["length"], values["Ve0"]
    motion = partial(motion_of, (apart, width))
    ego = motion((_STILL, middle), (speed, _STILL), _driven(manoeuvre, model, values, reading))
    match manoeuvre.name:
        case "cut-in":
            w = values["Vy"]
            across = _across(lane, -w, width / 4 if is_aided(model, reading) else _STILL)
            place = (values["dx0"] + apart, middle + lane)
            return Drive({SUBJECT: ego, OTHER: motion(place, (speed - values["dV0"], -w), (), across)})
        case "cut-out":
            first = values["headway"] * speed + apart
            second = (first + values["dx0_f"] + apart, middle)
            leaves = motion((first, middle), (speed, values["Vy"]), (), _across(lane, values["Vy"]))
            return Drive({SUBJECT: ego, FIRST: leaves, SECOND: motion(second, (values["Vf0"], _STILL), ())})
        case "deceleration":
            other, place = speed - values["dV0"], (values["dx0"] + apart, middle)
            return Drive({SUBJECT: ego, OTHER: motion(place, (other, _STILL), _braking(other, values))})


def _driven(manoeuvre: Manoeuvre, model: str, values: Values, reading: DriverSettings) -> list[Along]:
    """How SV moves."""
    if MODELS[model].is_stepped:
        return course_of(manoeuvre, values).along
    match manoeuvre.name:
        case "cut-in":
            return _cut_in(model, values, reading)
        case "cut-out":
            onset = reading.values["cc_wander"] / values["Vy"] + _reaction(reading)
            return _along(model, values["Ve0"], onset, reading)
        case "deceleration":
            return motion_in_deceleration(model, values, reading)


def rest_of(drive: Drive) -> Fraction:
    """When the last piece of all motions begins, in s."""
    pieces = (motion.pieces for motion in drive.vehicles.values())
    lasting = (sum((x.duration for x in those if x.duration is not None), _STILL) for those in pieces)
    return max(lasting, default=_STILL)


def road_of(values: Values) -> Road:
    """Two lanes without end, in the middle of which the vehicles begin."""
    lane = lane_width(values)
    lanelets = tuple(
        Lanelet(name, name, "main", "main", (None, None), (lane * k, lane * (k + 1)))
        for k, name in enumerate(_BOTH_LANES)
    )
    return Road("two-lanes", lanelets, pairs([_BOTH_LANES]))


def _across(lane: Fraction, w: Fraction, past: Fraction = _STILL) -> list[Across]:
    """To the middle of the lane beside, at ``w``; the last half second slower and slower.

    ``past``: it may go so far beyond, and is not slower before the middle, where one box is behind the other.
    """
    steering = min(_STEERING, (2 * past or lane) / abs(w))
    steady = lane / abs(w) - (_STILL if past else steering / 2)
    before: list[Across] = [(steady, _STILL)] if steady > 0 else []
    return [*before, (steering, -w / steering)]


def _reaction(reading: DriverSettings) -> Fraction:
    return reading.values["cc_evaluation"] + reading.values["cc_delay"]


def _onset(model: str, values: Values, reading: DriverSettings) -> Fraction | None:
    """When SV begins to brake, or to respond, in a cut-in; None is never."""
    w, known = values["Vy"], reading.values
    intrusion = (values["dy0"] / 2 + known["r157_past"]) / w
    match model:
        case "r157":
            return intrusion + known["r157_delay"]
        case "eu1426":
            return intrusion + known["eu1426_delay"] + known["eu1426_ramp"] / 2
        case "rss":
            return values["dy0"] / w
        case _:
            return _careful_onset(values, reading)


def _careful_onset(values: Values, reading: DriverSettings) -> Fraction | None:
    w, known, options = values["Vy"], reading.values, reading.options
    weighed = known["cc_evaluation"] if options["cc_perception"] == "time" else _STILL
    match options["cc_perception"]:
        case "distance":
            seen = (known["cc_wander"] + known["cc_drift"]) / w
        case "overlap":
            seen = values["dy0"] / w
        case _:
            seen = known["cc_wander"] / w
    if options["cc_gate"] == "none":
        return seen + weighed + known["cc_delay"]
    if values["dV0"] <= 0:
        return None
    opens = values["dx0"] / values["dV0"] - known["cc_ttc"]
    if options["cc_gate"] == "before_perception":
        return max(seen, opens) + weighed + known["cc_delay"]
    return max(seen + weighed, opens) + known["cc_delay"]


def is_aided(model: str, reading: DriverSettings) -> bool:
    """Whether there is AEB in a cut-in of the model."""
    return model == "careful" and reading.options["cc_aeb"] != "none"


def _cut_in(model: str, values: Values, reading: DriverSettings) -> list[Along]:
    if is_aided(model, reading):
        return _aided(values, reading).pieces(values["Ve0"])
    return _along(model, values["Ve0"], _onset(model, values, reading), reading)


def _aided(values: Values, reading: DriverSettings) -> AssistedBraking:
    """The braking of the careful driver, who may never brake, and of AEB from full wrap on."""
    known, wrap = reading.values, (values["dy0"] + values["width"]) / values["Vy"]
    onset, ramp = _careful_onset(values, reading), known["cc_ramp"]
    driver = Ramp(wrap, ramp, _STILL) if onset is None else Ramp(onset, ramp, known["cc_braking"])
    return AssistedBraking(driver, Ramp(wrap, ramp, known["aeb_braking"]), reading.options["cc_aeb"])


def speeds_of(values: Values, reading: DriverSettings) -> tuple[Fraction, ...]:
    """What ``follows_cutIn_careful`` takes of AEB (m/s): the speeds from which the ramps would have begun.

    Where a ramp has no part in the motion it is a speed from which the braking would be full by then.
    Raises ``InputError`` as ``drive_of``.
    """
    aided, speed = _aided(values, reading), values["Ve0"]
    driver, aeb = aided.driver, aided.aeb
    assert aeb is not None
    full = speed + aeb.full * aeb.duration

    def begun(time: Fraction, growing: Fraction) -> Fraction:
        at, braking = aided.state(speed, time)
        return at + braking**2 * aeb.duration / (2 * growing)

    match aided.joined:
        case "replace":
            return (begun(aeb.onset, aeb.full) if aeb.onset <= driver.end else full,)
        case "max":
            moves = aided.state(speed, aeb.onset)[0] > 0
            return (begun(aeb.end, aeb.full) if moves else full,)
        case _:
            both = driver.full + aeb.full
            first = max(driver.onset, min(aeb.onset, driver.end))
            second = max(driver.end, aeb.onset)
            by_then = [
                begun(time, growing) if aided.at(time) < aeb.full else full
                for time, growing in ((first, both), (second, aeb.full))
            ]
            return tuple(by_then)


def motion_in_deceleration(model: str, values: Values, reading: DriverSettings) -> list[Along]:
    """How SV moves until it stands; nothing where it never brakes. Raises ``InputError`` as ``drive_of``."""
    hard = reading.values["cc_hard"]
    if model == "rss":
        return _along(model, values["Ve0"], _STILL, reading)
    seen: Fraction | None = _STILL
    if reading.options["cc_threshold"] == "hard":
        rate = values.get("dGdt")
        seen = None if values["Gx"] < hard else hard / rate if rate else _STILL
        if seen and rate and values["Ve0"] - values["dV0"] <= rate * seen**2 / 2:
            seen = None  # POV stands before it brakes so hard
    return _along(model, values["Ve0"], None if seen is None else seen + _reaction(reading), reading)


def _braking(speed: Fraction, values: Values) -> list[Along]:
    """POV brakes, at once or harder and harder, until it stands."""
    braking, rate = values["Gx"], values.get("dGdt")
    if rate is None:
        return _brakes(speed, braking)
    return AssistedBraking(Ramp(_STILL, braking / rate, braking)).pieces(speed)


def _along(model: str, speed: Fraction, onset: Fraction | None, reading: DriverSettings) -> list[Along]:
    """SV goes on to its onset, and brakes until it stands."""
    known = reading.values
    if onset is None:
        return []
    before: list[Along] = [(onset, _STILL, _STILL)] if onset > 0 else []
    if model == "rss":
        rho, faster = known["rho"], speed + known["a_max"] * known["rho"]
        response: list[Along] = [(rho, known["a_max"], _STILL)] if rho > 0 else []
        return [*before, *response, *_brakes(faster, known["b_min"])]
    if model != "careful":
        braking = known["r157_braking"] if model == "r157" else known["eu1426_braking"]
        return [*before, *_brakes(speed, braking)]
    braking, ramp = known["cc_braking"], known["cc_ramp"]
    return AssistedBraking(Ramp(onset, ramp, braking)).pieces(speed)


def _brakes(speed: Fraction, braking: Fraction) -> list[Along]:
    return [(speed / braking, -braking, _STILL)] if speed > 0 else []
