"""How vehicles move in a manoeuvre when SV is driven by a model: exactly, in pieces.

It is worked out from times, apart from the formulas of ``driver.spec``; the judge compares the two.
"""

from collections.abc import Mapping
from dataclasses import fields
from fractions import Fraction
from functools import cached_property, partial
from typing import Literal, assert_never

from roadproof.errors import UsageError
from roadproof.extensions.drivers import manoeuvres as m
from roadproof.extensions.drivers.braking import AssistedBraking, Joined, Ramp
from roadproof.extensions.drivers.models import MODELS, ModelName
from roadproof.extensions.drivers.stepped import course_of
from roadproof.library.scenarios import SUBJECT
from roadproof.library.specification import Specification
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Across, Along, Drive, motion_of
from roadproof.world.road import Lanelet, Road, pairs

_STILL = Fraction(0)
_STEERING = Fraction(1, 2)  # s in which a vehicle that has changed lanes ends to move across
OWN_LANE = "right"
"""The lane of SV."""
_BOTH_LANES = (OWN_LANE, "left")


@dataclass(frozen=True)
class _Parameters:
    """Parameters of driver models that have a formula, as ``driver.spec`` declares them (SI)."""

    cc_wander: Fraction
    cc_evaluation: Fraction
    cc_drift: Fraction
    cc_delay: Fraction
    cc_ramp: Fraction
    cc_braking: Fraction
    aeb_braking: Fraction
    cc_ttc: Fraction
    cc_hard: Fraction
    r157_delay: Fraction
    r157_braking: Fraction
    r157_past: Fraction
    eu1426_ramp: Fraction
    eu1426_delay: Fraction
    eu1426_braking: Fraction
    rho: Fraction
    a_max: Fraction
    b_min: Fraction

    @property
    def reaction(self) -> Fraction:
        """How long the careful driver takes from perception to braking."""
        return self.cc_evaluation + self.cc_delay


@dataclass(frozen=True)
class _Options:
    """Options of the careful driver, as ``driver.spec`` declares them."""

    cc_perception: Literal["time", "distance", "overlap"]
    cc_gate: Literal["none", "before_perception", "before_delay"]
    cc_threshold: Literal["any", "hard"]
    cc_aeb: Joined


PARAMETERS: tuple[str, ...] = tuple(x.name for x in fields(_Parameters))
"""The parameters with which models move."""
OPTIONS: tuple[str, ...] = tuple(x.name for x in fields(_Options))
"""The options of driver models."""


@dataclass(frozen=True)
class DriverSettings:
    """Values of parameters (SI) and options, as the specification at hand has them."""

    values: Mapping[str, Fraction]
    options: Mapping[str, str]

    @cached_property
    def parameters(self) -> _Parameters:
        """Those of driver models."""
        return _Parameters(**{x: self.values[x] for x in PARAMETERS})

    @cached_property
    def choices(self) -> _Options:
        """The options of driver models."""
        return _Options(**{x: self.options[x] for x in OPTIONS})  # type: ignore[arg-type]

    def has_aeb(self, model: ModelName) -> bool:
        """Whether there is AEB in a cut-in of the model."""
        return model == "careful" and self.choices.cc_aeb != "none"


def require(specification: Specification, values: Mapping[str, Fraction]) -> None:
    """Raises ``UsageError`` where definitions of drivers are not read, or do not go with ``values`` (SI)."""
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


def drive_of(manoeuvre: m.Manoeuvre, model: ModelName, values: m.Values, reading: DriverSettings) -> Drive:
    """The drive from these initial values on. Raises ``InputError`` where an instant of it is irrational."""
    start = m.start_of(manoeuvre, values)
    middle, speed = start.middle, start.Ve0
    motion = partial(motion_of, (start.length, start.width))
    stepped = course_of(manoeuvre, values).along if MODELS[model].is_stepped else None
    match start:
        case m.CutIn(dV0=slower, Vy=w):
            driven = _cut_in(model, start, reading) if stepped is None else stepped
            across = _across(start.lane, -w, start.width / 4 if reading.has_aeb(model) else _STILL)
            place = (start.dx0 + start.length, middle + start.lane)
            others = {m.OTHER: motion(place, (speed - slower, -w), (), across)}
        case m.CutOut(Vy=w):
            onset = reading.parameters.cc_wander / w + reading.parameters.reaction
            driven = _along(model, speed, onset, reading) if stepped is None else stepped
            leaves = motion((start.first, middle), (speed, w), (), _across(start.lane, w))
            others = {m.FIRST: leaves, m.SECOND: motion((start.second, middle), (start.Vf0, _STILL), ())}
        case m.Deceleration():
            driven = motion_in_deceleration(model, start, reading) if stepped is None else stepped
            place, slow = (start.dx0 + start.length, middle), speed - start.dV0
            others = {m.OTHER: motion(place, (slow, _STILL), _braking(slow, start))}
    return Drive({SUBJECT: motion((_STILL, middle), (speed, _STILL), driven), **others})


def rest_of(drive: Drive) -> Fraction:
    """When the last piece of all motions begins, in s."""
    pieces = (motion.pieces for motion in drive.vehicles.values())
    lasting = (sum((x.duration for x in those if x.duration is not None), _STILL) for those in pieces)
    return max(lasting, default=_STILL)


def road_of(manoeuvre: m.Manoeuvre, values: m.Values) -> Road:
    """Two lanes without end, in the middle of which the vehicles begin."""
    lane = m.start_of(manoeuvre, values).lane
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


def _onset(model: ModelName, start: m.CutIn, reading: DriverSettings) -> Fraction | None:
    """When SV begins to brake, or to respond, in a cut-in; None is never."""
    known = reading.parameters
    intrusion = (start.dy0 / 2 + known.r157_past) / start.Vy
    match model:
        case "r157":
            return intrusion + known.r157_delay
        case "eu1426":
            return intrusion + known.eu1426_delay + known.eu1426_ramp / 2
        case "rss":
            return start.dy0 / start.Vy
        case "careful":
            return _careful_onset(start, reading)
        case "fsm":
            raise ValueError("fsm is a controller: it has no onset")
        case _:
            assert_never(model)


def _careful_onset(start: m.CutIn, reading: DriverSettings) -> Fraction | None:
    known, options = reading.parameters, reading.choices
    weighed = known.cc_evaluation if options.cc_perception == "time" else _STILL
    match options.cc_perception:
        case "distance":
            seen = (known.cc_wander + known.cc_drift) / start.Vy
        case "overlap":
            seen = start.dy0 / start.Vy
        case "time":
            seen = known.cc_wander / start.Vy
    if options.cc_gate == "none":
        return seen + weighed + known.cc_delay
    if start.dV0 <= 0:
        return None
    opens = start.dx0 / start.dV0 - known.cc_ttc
    if options.cc_gate == "before_perception":
        return max(seen, opens) + weighed + known.cc_delay
    return max(seen + weighed, opens) + known.cc_delay


def _cut_in(model: ModelName, start: m.CutIn, reading: DriverSettings) -> list[Along]:
    if reading.has_aeb(model):
        return _aided(start, reading).pieces(start.Ve0)
    return _along(model, start.Ve0, _onset(model, start, reading), reading)


def _aided(start: m.CutIn, reading: DriverSettings) -> AssistedBraking:
    """The braking of the careful driver, who may never brake, and of AEB from full wrap on."""
    known, wrap = reading.parameters, (start.dy0 + start.width) / start.Vy
    onset, ramp = _careful_onset(start, reading), known.cc_ramp
    driver = Ramp(wrap, ramp, _STILL) if onset is None else Ramp(onset, ramp, known.cc_braking)
    return AssistedBraking(driver, Ramp(wrap, ramp, known.aeb_braking), reading.choices.cc_aeb)


def speeds_of(start: m.CutIn, reading: DriverSettings) -> tuple[Fraction, ...]:
    """What ``follows_cutIn_careful`` takes of AEB (m/s): the speeds from which the ramps would have begun.

    Where a ramp has no part in the motion it is a speed from which the braking would be full by then.
    Raises ``InputError`` as ``drive_of``.
    """
    aided, speed = _aided(start, reading), start.Ve0
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
        case "add" | "none":
            first = max(driver.onset, min(aeb.onset, driver.end)), driver.full + aeb.full
            second = max(driver.end, aeb.onset), aeb.full
            return tuple(begun(*x) if aided.at(x[0]) < aeb.full else full for x in (first, second))


def motion_in_deceleration(model: ModelName, start: m.Deceleration, reading: DriverSettings) -> list[Along]:
    """How SV moves until it stands; nothing where it never brakes. Raises ``InputError`` as ``drive_of``."""
    known, rate = reading.parameters, start.dGdt
    if model == "rss":
        return _along(model, start.Ve0, _STILL, reading)
    seen: Fraction | None = _STILL
    if reading.choices.cc_threshold == "hard":
        seen = None if start.Gx < known.cc_hard else known.cc_hard / rate if rate else _STILL
        if seen and rate and start.Ve0 - start.dV0 <= rate * seen**2 / 2:
            seen = None  # POV stands before it brakes so hard
    return _along(model, start.Ve0, None if seen is None else seen + known.reaction, reading)


def _braking(speed: Fraction, start: m.Deceleration) -> list[Along]:
    """POV brakes, at once or harder and harder, until it stands."""
    if start.dGdt is None:
        return _brakes(speed, start.Gx)
    return AssistedBraking(Ramp(_STILL, start.Gx / start.dGdt, start.Gx)).pieces(speed)


def _along(model: ModelName, speed: Fraction, onset: Fraction | None, reading: DriverSettings) -> list[Along]:
    """SV goes on to its onset, and brakes until it stands."""
    known = reading.parameters
    if onset is None:
        return []
    before: list[Along] = [(onset, _STILL, _STILL)] if onset > 0 else []
    if model == "careful":
        return AssistedBraking(Ramp(onset, known.cc_ramp, known.cc_braking)).pieces(speed)
    if model == "rss":
        response: list[Along] = [(known.rho, known.a_max, _STILL)] if known.rho > 0 else []
        return [*before, *response, *_brakes(speed + known.a_max * known.rho, known.b_min)]
    return [*before, *_brakes(speed, known.r157_braking if model == "r157" else known.eu1426_braking)]


def _brakes(speed: Fraction, braking: Fraction) -> list[Along]:
    return [(speed / braking, -braking, _STILL)] if speed > 0 else []
