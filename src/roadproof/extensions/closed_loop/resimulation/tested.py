"""Drive files as situations: SV begins as in the drive, and all others move as in it."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.extensions.catalogue.drive_targets import targets_shown
from roadproof.extensions.catalogue.entries import Freedom
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.closed_loop.protocol import OBSERVED
from roadproof.extensions.closed_loop.resimulation.occurrence import (
    OccurrenceLimits,
    OccurrencePlace,
    RecordedSituation,
    recorded_situation,
)
from roadproof.extensions.closed_loop.simulation import VehicleSamples
from roadproof.extensions.closed_loop.situation import Phase, StepClock, VehicleCourse
from roadproof.library.scenarios import LANE, SUBJECT, number_in, roles
from roadproof.world.drive import Motion
from roadproof.world.motion import State, states_at


def situations_of(
    files: Sequence[Path], formulas: TargetFormulas, limits: OccurrenceLimits, numbers: Sequence[int]
) -> Iterator[RecordedSituation]:
    """Yield the situations of drive files; ``numbers``: only drives that show one of them, all where empty.

    Raises ``InputError`` where a drive has no SV and POV, or is shorter than a step.
    """
    for path in files:
        file = load_drive(path)
        names = tuple(file.drive.vehicles)
        cast = next((x for x in (roles(2), roles(3)) if {*x} <= {*names}), None)
        if cast is None:
            raise InputError(
                f"{path}: its vehicles are {', '.join(names)}; name them {' and '.join(roles(2))}, or "
                f"{', '.join(roles(3))}"
            )
        shown = shown_numbers(file, cast, formulas)
        if numbers and not {*shown} & {*numbers}:
            continue
        yield _situation(path, file, cast, shown, limits)


def shown_numbers(file: DriveFile, cast: Sequence[str], formulas: TargetFormulas) -> tuple[int, ...]:
    """Return the scenarios that a drive shows in these roles, in any lane."""
    drive = file.drive.cast({name: name for name in cast})
    shown = targets_shown(replace(file, drive=drive), formulas, Freedom(lanes=True))
    return tuple(sorted({n for x in shown if (n := number_in(x.what)) is not None}))


def _situation(
    path: Path, file: DriveFile, cast: Sequence[str], shown: tuple[int, ...], limits: OccurrenceLimits
) -> RecordedSituation:
    steps = int(min(file.horizon, limits.seconds) / limits.dt)
    if steps < 1:
        raise InputError(f"{path}: horizon={file.horizon} s is less than a step of {limits.dt} s")
    clock = StepClock(limits.dt, steps)
    order = (SUBJECT, *(x for x in file.drive.vehicles if x != SUBJECT))
    states = {name: states_at(file.drive.vehicles[name], _times(clock)) for name in order}
    courses = {name: _course(file.drive.vehicles[name], states[name], clock.dt) for name in order}
    samples = {name: samples_of(states[name]) for name in order}
    place = OccurrencePlace(path.stem, shown, {name: name for name in cast}, file.lanes.get(LANE, ""))
    return recorded_situation(place, courses, samples, file.road, clock, limits.subject)


def _times(clock: StepClock) -> tuple[Fraction, ...]:
    return tuple(k * clock.dt for k in range(clock.steps + 1))


def _course(motion: Motion, states: Sequence[State], dt: Fraction) -> VehicleCourse:
    """Return a course with the speeds of the motion at all steps.

    It is the motion itself where accelerations change at steps only.
    """
    pairs = [*pairwise(states)]
    along = tuple(Phase(k, 1, (y.v_lon - x.v_lon) / dt) for k, (x, y) in enumerate(pairs))
    across = tuple(Phase(k, 1, (y.v_lat - x.v_lat) / dt) for k, (x, y) in enumerate(pairs))
    first = states[0]
    return VehicleCourse(
        motion.length,
        motion.width,
        motion.kind,
        first.s,
        first.d,
        first.v_lon,
        first.v_lat,
        along,
        across,
    )


def samples_of(states: Sequence[State]) -> VehicleSamples:
    """Return states at the steps of a clock as samples."""
    return VehicleSamples(*(np.array([float(getattr(x, signal)) for x in states]) for signal in OBSERVED))
