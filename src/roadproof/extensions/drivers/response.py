"""When a driver model responds to what happens in a test, and how SV brakes from then on.

A test is a drive or samples, and each answers the questions of a ``Scene`` from its own motion. No value of
one instant is extrapolated: what a model waits for is looked for over the whole test.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Literal, Protocol, assert_never

from roadproof.extensions.drivers.braking import AssistedBraking, Ramp
from roadproof.extensions.drivers.driving import DriverSettings
from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.extensions.drivers.models import ModelName
from roadproof.runtime.records import dataclass

Phase = tuple[Fraction | None, Fraction, Fraction]
"""A part of a motion along the road: its duration (s, None for ever), acceleration (m/s²) and jerk (m/s³)."""
_NONE = Fraction(0)


class Scene(Protocol):
    """A test from the instant on at which its scenario holds; times are in s from the start of the test.

    Every method returns the first such instant, or None where there is none.
    """

    @property
    def start(self) -> Fraction:
        """The instant at which the scenario holds."""

    def offset(self, metres: Fraction) -> Fraction | None:
        """When the centre of the first POV is so far from the centre of its lane, towards SV in a cut-in."""

    def beside(self) -> Fraction | None:
        """When the boxes of SV and POV begin to overlap across the road."""

    def past_marking(self, metres: Fraction) -> Fraction | None:
        """When the side of POV is so far past the marking of SV's lane."""

    def wrapped(self) -> Fraction | None:
        """When across the road one of the boxes of SV and POV is within the other."""

    def closing(self, seconds: Fraction, since: Fraction) -> Fraction | None:
        """When the time to collision is so short, from ``since`` on."""

    def braking(self, least: Fraction) -> Fraction | None:
        """When POV, ahead of SV and in its way, brakes: by at least so much (m/s²), at all where it is 0."""


@dataclass(frozen=True)
class Response:
    """SV moves as in the test until ``onset`` (s), and as ``phases`` say from then on, until it stands."""

    onset: Fraction
    phases: tuple[Phase, ...]


def response(
    model: ModelName, manoeuvre: ManoeuvreName, scene: Scene, settings: DriverSettings
) -> Response | None:
    """Return how a model with a formula responds; None where it never does.

    Raises ``ValueError`` for ``fsm``, which is a controller.
    """
    match model:
        case "careful":
            onset = _careful_onset(manoeuvre, scene, settings)
            if manoeuvre == "cut-in" and settings.has_aeb(model):
                return _aided(onset, scene.wrapped(), settings)
        case "r157":
            onset = _later(scene.past_marking(settings.parameters.r157_past), settings.parameters.r157_delay)
        case "eu1426":
            delay = settings.parameters.eu1426_delay + settings.parameters.eu1426_ramp / 2
            onset = _later(scene.past_marking(settings.parameters.r157_past), delay)
        case "rss":
            onset = scene.braking(_NONE) if manoeuvre == "deceleration" else scene.beside()
        case "fsm":
            raise ValueError("fsm is a controller: it looks again and again")
        case _:
            assert_never(model)
    return None if onset is None else Response(onset, tuple(_phases(model, settings)))


def _aided(onset: Fraction | None, wrapped: Fraction | None, settings: DriverSettings) -> Response | None:
    """The careful driver, who may never brake, with AEB from full wrap on."""
    known, ramp = settings.parameters, settings.parameters.cc_ramp
    begin = min((x for x in (onset, wrapped) if x is not None), default=None)
    if begin is None:
        return None
    driver = Ramp(_NONE, ramp, _NONE) if onset is None else Ramp(onset - begin, ramp, known.cc_braking)
    aeb = None if wrapped is None else Ramp(wrapped - begin, ramp, known.aeb_braking)
    joined = "none" if aeb is None else settings.choices.cc_aeb
    return Response(begin, tuple(AssistedBraking(driver, aeb, joined).phases))


def _careful_onset(manoeuvre: ManoeuvreName, scene: Scene, settings: DriverSettings) -> Fraction | None:
    known, options = settings.parameters, settings.choices
    match manoeuvre:
        case "cut-in":
            return _careful_in_cut_in(scene, settings)
        case "cut-out":
            return _later(scene.offset(known.cc_wander), known.reaction)
        case "deceleration":
            hard = known.cc_hard if options.cc_threshold == "hard" else _NONE
            return _later(scene.braking(hard), known.reaction)
        case _:
            assert_never(manoeuvre)


def _careful_in_cut_in(scene: Scene, settings: DriverSettings) -> Fraction | None:
    known, options = settings.parameters, settings.choices
    weighed = _NONE
    match options.cc_perception:
        case "time":
            seen, weighed = scene.offset(known.cc_wander), known.cc_evaluation
        case "distance":
            seen = scene.offset(known.cc_wander + known.cc_drift)
        case "overlap":
            seen = scene.beside()
        case _:
            assert_never(options.cc_perception)
    if seen is None:
        return None
    match options.cc_gate:
        case "none":
            return seen + weighed + known.cc_delay
        case "before_perception":
            return _later(scene.closing(known.cc_ttc, seen), weighed + known.cc_delay)
        case "before_delay":
            return _later(scene.closing(known.cc_ttc, seen + weighed), known.cc_delay)
        case _:
            assert_never(options.cc_gate)


def _later(instant: Fraction | None, delay: Fraction) -> Fraction | None:
    return None if instant is None else instant + delay


def _phases(model: Literal["careful", "r157", "eu1426", "rss"], settings: DriverSettings) -> Sequence[Phase]:
    """The braking of a model from its onset on, as if the vehicle never stood."""
    known = settings.parameters
    match model:
        case "careful":
            ramp = Ramp(_NONE, known.cc_ramp, known.cc_braking)
            growing: list[Phase] = [(ramp.duration, _NONE, -ramp.full / ramp.duration)]
            return [*growing, (None, -known.cc_braking, _NONE)]
        case "rss":
            before: list[Phase] = [(known.rho, known.a_max, _NONE)] if known.rho > 0 else []
            return [*before, (None, -known.b_min, _NONE)]
        case "r157":
            return [(None, -known.r157_braking, _NONE)]
        case "eu1426":
            return [(None, -known.eu1426_braking, _NONE)]
        case _:
            assert_never(model)
