"""The driver models that come with roadproof, one row each, and how each responds."""

from collections.abc import Iterator
from fractions import Fraction
from typing import assert_never

from roadproof.extensions.drivers.braking import AssistedBraking, Ramp
from roadproof.extensions.drivers.driver_model import DriverModel, Law
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.lemmas import Stated, lemmas_of_aeb, lemmas_of_braking, lemmas_of_rss
from roadproof.extensions.drivers.manoeuvres import CutIn, ManoeuvreName
from roadproof.extensions.drivers.response import Phase, Response, Scene
from roadproof.extensions.drivers.start_scene import StartScene

_NONE = Fraction(0)


def _later(instant: Fraction | None, delay: Fraction) -> Fraction | None:
    return None if instant is None else instant + delay


def _brakes(onset: Fraction | None, braking: Fraction) -> Response | None:
    """Return full braking at once from an onset on."""
    return None if onset is None else Response(onset, ((None, -braking, _NONE),))


# --- the competent and careful driver ---------------------------------------------------------------


def _careful(manoeuvre: ManoeuvreName, scene: Scene, settings: DriverSettings) -> Response | None:
    known = settings.parameters
    onset = _careful_onset(manoeuvre, scene, settings)
    if manoeuvre == "cut-in" and settings.choices.cc_aeb != "none":
        return _aided(onset, scene.wrapped(), settings)
    if onset is None:
        return None
    ramp = Ramp(_NONE, known.cc_ramp, known.cc_braking)
    growing: Phase = (ramp.duration, _NONE, -ramp.full / ramp.duration)
    return Response(onset, (growing, (None, -known.cc_braking, _NONE)))


def _careful_onset(manoeuvre: ManoeuvreName, scene: Scene, settings: DriverSettings) -> Fraction | None:
    """Return when the driver begins to brake (s)."""
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
    evaluates = _NONE
    match options.cc_perception:
        case "time":
            seen, evaluates = scene.offset(known.cc_wander), known.cc_evaluation
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
            return seen + evaluates + known.cc_delay
        case "before_perception":
            return _later(scene.closing(known.cc_ttc, seen), evaluates + known.cc_delay)
        case "before_delay":
            return _later(scene.closing(known.cc_ttc, seen + evaluates), known.cc_delay)
        case _:
            assert_never(options.cc_gate)


def _aided(onset: Fraction | None, wrapped: Fraction | None, settings: DriverSettings) -> Response | None:
    """Return the braking of the careful driver, who may never brake, and of AEB from full wrap on."""
    begin = min((x for x in (onset, wrapped) if x is not None), default=None)
    if begin is None:
        return None
    return Response(begin, tuple(_assisted(onset, wrapped, begin, settings).phases))


def _assisted(
    onset: Fraction | None, wrapped: Fraction | None, since: Fraction, settings: DriverSettings
) -> AssistedBraking:
    """Return the braking of driver and AEB as a function of the time from ``since`` on."""
    known, ramp = settings.parameters, settings.parameters.cc_ramp
    begin = onset if onset is not None else wrapped
    assert begin is not None
    driver = Ramp(begin - since, ramp, _NONE if onset is None else known.cc_braking)
    if wrapped is None:
        return AssistedBraking(driver)
    return AssistedBraking(driver, Ramp(wrapped - since, ramp, known.aeb_braking), settings.choices.cc_aeb)


def _careful_speeds(start: CutIn, settings: DriverSettings) -> tuple[Fraction, ...]:
    """Return the speeds (m/s) from which the ramps of driver and AEB would have begun.

    Where a ramp has no part in the motion it is a speed from which the braking would be full by then.
    Raises ``InputError`` where an instant of the motion is irrational.
    """
    if settings.choices.cc_aeb == "none":
        return ()
    scene, speed = StartScene(start), start.Ve0
    assisted = _assisted(_careful_onset("cut-in", scene, settings), scene.wrapped(), _NONE, settings)
    driver, aeb = assisted.driver, assisted.aeb
    assert aeb is not None
    full = speed + aeb.full * aeb.duration

    def began(time: Fraction, growing: Fraction) -> Fraction:
        at, braking = assisted.state(speed, time)
        return at + braking**2 * aeb.duration / (2 * growing)

    match assisted.joined:
        case "replace":
            return (began(aeb.onset, aeb.full) if aeb.onset <= driver.end else full,)
        case "max":
            moves = assisted.state(speed, aeb.onset)[0] > 0
            return (began(aeb.end, aeb.full) if moves else full,)
        case "add" | "none":
            first = max(driver.onset, min(aeb.onset, driver.end)), driver.full + aeb.full
            second = max(driver.end, aeb.onset), aeb.full
            return tuple(began(*x) if assisted.at(x[0]) < aeb.full else full for x in (first, second))


def _careful_lemmas(name: str, law: tuple[str, str], manoeuvre: ManoeuvreName, aeb: str) -> Iterator[Stated]:
    yield from lemmas_of_aeb(manoeuvre, aeb)
    yield from lemmas_of_braking(name, law, manoeuvre, aeb)


CAREFUL = DriverModel(
    name="careful",
    title="competent and careful driver",
    source="UN R157 (01 series), Annex 3",
    manoeuvres=("cut-in", "cut-out", "deceleration"),
    phrase="{a}, driven as the careful driver,",
    colour=("#1f5fa8", "var(--one)"),
    law=Law(
        respond=_careful,
        ramp="cc_ramp",
        braking="cc_braking",
        lemmas=_careful_lemmas,
        speeds=_careful_speeds,
        never_brakes=lambda start, settings: _careful_onset("cut-in", StartScene(start), settings) is None,
        restriction="prevention",
    ),
)


# --- the conditions of regulations -----------------------------------------------------------------


def _r157(manoeuvre: ManoeuvreName, scene: Scene, settings: DriverSettings) -> Response | None:
    known = settings.parameters
    return _brakes(_later(scene.past_marking(known.r157_past), known.r157_delay), known.r157_braking)


R157 = DriverModel(
    name="r157",
    title="UN R157 5.2.5.2",
    source="UN R157 (01 series), 5.2.5.2",
    manoeuvres=("cut-in",),
    phrase="{a}, which does what UN R157 supposes,",
    colour=("#c44e1b", "var(--two)"),
    law=Law(respond=_r157, braking="r157_braking", restriction="prevention"),
)


def _eu1426(manoeuvre: ManoeuvreName, scene: Scene, settings: DriverSettings) -> Response | None:
    known = settings.parameters
    delay = known.eu1426_delay + known.eu1426_ramp / 2
    return _brakes(_later(scene.past_marking(known.r157_past), delay), known.eu1426_braking)


EU1426 = DriverModel(
    name="eu1426",
    title="EU 2022/1426",
    source="EU 2022/1426, Annex III Part 1, 1.4.2",
    manoeuvres=("cut-in",),
    phrase="{a}, which does what EU 2022/1426 supposes,",
    colour=("#2c8a4b", "var(--three)"),
    law=Law(respond=_eu1426, braking="eu1426_braking", restriction="prevention"),
)


# --- the proper response of RSS, at its worst --------------------------------------------------------


def _rss(manoeuvre: ManoeuvreName, scene: Scene, settings: DriverSettings) -> Response | None:
    known = settings.parameters
    onset = scene.braking(_NONE) if manoeuvre == "deceleration" else scene.beside()
    if onset is None:
        return None
    response: tuple[Phase, ...] = ((known.rho, known.a_max, _NONE),) if known.rho > 0 else ()
    return Response(onset, (*response, (None, -known.b_min, _NONE)))


def _rss_lemmas(name: str, law: tuple[str, str], manoeuvre: ManoeuvreName, aeb: str) -> Iterator[Stated]:
    yield from lemmas_of_braking(name, law, manoeuvre, aeb)
    yield from lemmas_of_rss(manoeuvre)


RSS = DriverModel(
    name="rss",
    title="RSS proper response",
    source="Shalev-Shwartz et al. 2017; values of the paper",
    manoeuvres=("cut-in", "deceleration"),
    phrase="{a}, which responds as RSS asks,",
    colour=("#7d3c98", "var(--four)"),
    law=Law(respond=_rss, braking="b_min", lemmas=_rss_lemmas, restriction="prevention"),
)

FSM = DriverModel(
    name="fsm",
    title="fuzzy safety model",
    source="UN R157 (01 series), Annex 3; JRC-FSM",
    manoeuvres=("cut-in", "cut-out", "deceleration"),
    phrase="{a}, driven by the fuzzy safety model,",
    colour=("#8a6d1b", "var(--open)"),
    law=None,
)
