"""How vehicles move in a manoeuvre when SV is driven by a model: exactly, in pieces.

It is worked out from times, apart from the formulas of ``driver.spec``; the judge compares the two.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.preventing.manoeuvres import FIRST, OTHER, SECOND, Manoeuvre, Values, lane_width
from roadproof.preventing.models import MODELS
from roadproof.preventing.stepped import course_of
from roadproof.spec.scenarios import SUBJECT
from roadproof.world.drive import Drive, Motion
from roadproof.world.pieces import Across, Along, motion_of
from roadproof.world.road import Lanelet, Road, pairs

_STILL = Fraction(0)
_STEERING = Fraction(1, 2)  # s in which a vehicle that has changed lanes ends to move across
OWN_LANE = "right"
"""The lane of SV."""
_BOTH_LANES = (OWN_LANE, "left")


@dataclass(frozen=True)
class Reading:
    """Values of parameters (SI) and options, as the specification at hand has them."""

    values: Mapping[str, Fraction]
    options: Mapping[str, str]


def drive_of(manoeuvre: Manoeuvre, model: str, values: Values, reading: Reading) -> Drive:
    """The drive from these initial values on. Raises ``InputError`` where an instant of it is irrational."""
    lane, width = lane_width(values), values["width"]
    middle = (lane + width) / 2
    box = (values["length"], width)
    speed, apart = values["Ve0"], values["length"]
    ego = (_STILL, middle), (speed, _STILL)
    stepped = course_of(manoeuvre, values).along if MODELS[model].is_stepped else None
    match manoeuvre.name:
        case "cut-in":
            other, w = speed - values["dV0"], values["Vy"]
            return Drive(
                {
                    SUBJECT: motion_of(
                        box, *ego, _cut_in(model, values, reading) if stepped is None else stepped
                    ),
                    OTHER: motion_of(
                        box,
                        (values["dx0"] + apart, middle + lane),
                        (other, -w),
                        (),
                        _across(lane, -w),
                    ),
                }
            )
        case "cut-out":
            first = values["headway"] * speed + apart
            onset = reading.values["cc_wander"] / values["Vy"] + _reaction(reading)
            obstacle = (first + values["dx0_f"] + apart, middle), (values["Vf0"], _STILL)
            return Drive(
                {
                    SUBJECT: motion_of(
                        box, *ego, _along(model, speed, onset, reading) if stepped is None else stepped
                    ),
                    FIRST: motion_of(
                        box, (first, middle), (speed, values["Vy"]), (), _across(lane, values["Vy"])
                    ),
                    SECOND: motion_of(box, *obstacle, ()),
                }
            )
        case _:
            other, braking = speed - values["dV0"], values["Gx"]
            pieces: list[Along] = [(other / braking, -braking, _STILL)] if other > 0 else []
            return Drive(
                {
                    SUBJECT: motion_of(
                        box, *ego, _deceleration(model, values, reading) if stepped is None else stepped
                    ),
                    OTHER: motion_of(box, (values["dx0"] + apart, middle), (other, _STILL), pieces),
                }
            )


def rest_of(drive: Drive) -> Fraction:
    """When the last piece of all motions begins, in s."""
    return max((_rest(motion) for motion in drive.vehicles.values()), default=_STILL)


def _rest(motion: Motion) -> Fraction:
    return sum((x.duration for x in motion.pieces if x.duration is not None), _STILL)


def road_of(values: Values) -> Road:
    """Two lanes without end, in the middle of which the vehicles begin."""
    lane = lane_width(values)
    lanelets = tuple(
        Lanelet(name, name, "main", "main", (None, None), (lane * k, lane * (k + 1)))
        for k, name in enumerate(_BOTH_LANES)
    )
    return Road("two-lanes", lanelets, pairs([_BOTH_LANES]))


def _across(lane: Fraction, w: Fraction) -> list[Across]:
    """To the middle of the lane beside, at ``w``; the last half second slower and slower."""
    steering = min(_STEERING, lane / abs(w))
    steady = lane / abs(w) - steering / 2
    before: list[Across] = [(steady, _STILL)] if steady > 0 else []
    return [*before, (steering, -w / steering)]


def _reaction(reading: Reading) -> Fraction:
    return reading.values["cc_evaluation"] + reading.values["cc_delay"]


def _onset(model: str, values: Values, reading: Reading) -> Fraction | None:
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


def _careful_onset(values: Values, reading: Reading) -> Fraction | None:
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


def _cut_in(model: str, values: Values, reading: Reading) -> list[Along]:
    return _along(model, values["Ve0"], _onset(model, values, reading), reading)


def _deceleration(model: str, values: Values, reading: Reading) -> list[Along]:
    known = reading.values
    if model == "rss":
        return _along(model, values["Ve0"], _STILL, reading)
    hard = reading.options["cc_threshold"] == "hard" and values["Gx"] < known["cc_hard"]
    return _along(model, values["Ve0"], None if hard else _reaction(reading), reading)


def _along(model: str, speed: Fraction, onset: Fraction | None, reading: Reading) -> list[Along]:
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
    full = speed - braking * ramp / 2
    if full < 0:
        raise InputError(
            f"Ve0={speed} m/s: SV stands before it brakes fully, at an instant that is no fraction, so no "
            f"drive can say it exactly; take a speed of at least {braking * ramp / 2} m/s"
        )
    return [*before, (ramp, _STILL, -braking / ramp), *_brakes(full, braking)]


def _brakes(speed: Fraction, braking: Fraction) -> list[Along]:
    return [(speed / braking, -braking, _STILL)] if speed > 0 else []
