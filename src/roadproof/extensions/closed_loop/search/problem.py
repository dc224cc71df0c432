"""The problem of a search: a target, the formulas that measure a simulation, and the judgement of a drive."""

from collections.abc import Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from functools import cached_property

import numpy as np

from roadproof.evidence.claim import Claim
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, RejectedError
from roadproof.extensions.closed_loop.driver_drives import decisions_on, models_of
from roadproof.extensions.closed_loop.protocol import OBSERVED
from roadproof.extensions.closed_loop.search.margins import Ruler, stacked
from roadproof.extensions.closed_loop.search.shape import SituationShape
from roadproof.extensions.closed_loop.simulation import (
    ControlLoop,
    VehicleSamples,
    driven_file,
    exact_drive,
    follow,
)
from roadproof.extensions.closed_loop.situation import TrafficSituation
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.outcome import Outcome, Result
from roadproof.extensions.drivers.sampled_replay import SampledScene, Track, replay_samples
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, manoeuvre_of
from roadproof.library.scenarios import SUBJECT
from roadproof.runtime.records import dataclass

SHOWS, BREAKS = "shows", "breaks"


@dataclass(frozen=True)
class Trial:
    """A simulation: the values of the knobs, and by how much it shows the target and breaks a requirement.

    ``tracks``: the samples of all vehicles, of shape (steps + 1,).
    """

    values: tuple[float, ...]
    shows: float
    breaks: float
    tracks: Mapping[str, VehicleSamples] = field(repr=False, compare=False)


@dataclass(frozen=True)
class TargetProblem:
    """A target with its shape.

    ``shown``: the claim that the target occurs; ``fails``: the claim that it occurs and a requirement is
    broken, None for a class. ``drivers``: None where no model is asked.
    """

    name: str
    shape: SituationShape
    shown: Claim
    fails: Claim | None
    breach: Claim | None
    drivers: Drivers | None
    values: Mapping[str, Fraction]

    @cached_property
    def ruler(self) -> Ruler:
        """The ruler of both formulas."""
        formulas = {SHOWS: self.shown.formula}
        if self.breach is not None:
            formulas[BREAKS] = self.breach.formula
        pattern = self.shape.pattern
        return Ruler.of(formulas, pattern.road, pattern.lanes, self.values, self.shape.clock)

    @property
    def models(self) -> tuple[str, ...]:
        """The driver models that speak of the scenario."""
        return models_of(self.drivers, self.name)

    @property
    def guide(self) -> str | None:
        """The first model with a formula, which guides the search; None where there is none."""
        return next((x for x in self.models if not MODELS[x].is_stepped), None)

    def run(self, loop: ControlLoop, every: Sequence[tuple[float, ...]]) -> list[Trial]:
        """Simulate some values of the knobs. Raises ``ControllerError`` with the values in its message."""
        situations = [self.shape.situation(values) for values in every]
        first = situations[0]
        tracks = {name: follow([x.courses[name] for x in situations], first, name) for name in first.others}
        rows = {
            name: np.stack([getattr(track, signal) for signal in OBSERVED], axis=-1).swapaxes(0, 1).tolist()
            for name, track in tracks.items()
        }
        mine = [
            loop.run(situation, {name: x[k] for name, x in rows.items()})
            for k, situation in enumerate(situations)
        ]
        tracks[SUBJECT] = stacked(mine)
        margins = self.ruler.measure(tracks, first.courses)
        breaks = margins.get(BREAKS, np.full(len(every), -np.inf))
        return [
            Trial(
                tuple(values),
                float(margins[SHOWS][k]),
                float(breaks[k]),
                {name: _column(track, k) for name, track in tracks.items()},
            )
            for k, values in enumerate(every)
        ]

    def foretold(self, trial: Trial) -> Outcome | None:
        """Return the outcome of a simulation with the guide in place of SV, on samples.

        None where no model speaks of the scenario. It guides the search; ``decisions`` are exact.
        """
        manoeuvre = manoeuvre_of(self.name)
        if manoeuvre is None or self.drivers is None or self.guide is None:
            return None
        situation = self.shape.situation(trial.values)
        tracks = {
            name: Track(x.s, x.d, x.v_lon, x.v_lat, x.a_lon, *_box(situation, name))
            for name, x in trial.tracks.items()
        }
        road, dt = self.shape.pattern.road, self.shape.clock.dt
        scene = SampledScene(tracks, road, self.shape.vehicles, dt, 0)
        return replay_samples(scene, manoeuvre, self.guide, self.drivers.settings)

    def file(
        self, situation: TrafficSituation, loop: ControlLoop, claim: Claim, may_overlap: bool
    ) -> DriveFile:
        """Return the exact drive of a situation as a file with the formula of a claim."""
        pattern = self.shape.pattern
        scenario = pattern.scenario if claim.text == pattern.formula else None
        return driven_file(situation, claim, exact_drive(loop, situation), may_overlap, scenario)

    def judged(
        self, situation: TrafficSituation, loop: ControlLoop, claim: Claim, may_overlap: bool
    ) -> JudgedDrive | None:
        """Return the exact drive of a situation if the judge accepts it. Raises ``ControllerError``."""
        try:
            return JudgedDrive(self.file(situation, loop, claim, may_overlap), claim.home.library)
        except RejectedError:
            return None

    def decisions(self, drive: JudgedDrive) -> tuple[Decision, ...]:
        """Return the exact decisions of the driver models on a drive."""
        return decisions_on(drive, self.drivers, self.name, self.shape.vehicles, self.breach, self.values)


def prevents(decisions: Sequence[Decision]) -> bool:
    """Return whether a driver model prevents the collision."""
    return any(x.side == "preventable" for x in decisions)


def severity(outcome: Outcome | None) -> float:
    """Return how far a model is from preventing a collision: its speed (m/s), negative if prevented."""
    if outcome is None:
        return 0.0
    match outcome.result:
        case Result.PREVENTED:
            return -1.0
        case Result.COLLIDES:
            return max(0.0, outcome.speed or 0.0)
        case Result.UNDECIDED:
            return 50.0


def _column(track: VehicleSamples, k: int) -> VehicleSamples:
    return VehicleSamples(*(np.ascontiguousarray(getattr(track, name)[:, k]) for name in OBSERVED))


def _box(situation: TrafficSituation, name: str) -> tuple[float, float]:
    course = situation.courses[name]
    return float(course.length), float(course.width)
