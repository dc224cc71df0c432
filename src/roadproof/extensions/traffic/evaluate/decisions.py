"""The result of a test under a driver model: SV drives as the model does, all else is the test's motion.

The verdict is that of the drive, or of the samples, in which the model drives SV (``drivers.replay``).
"""

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Self

from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.subject import TestedSide
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import require, rest_of
from roadproof.extensions.drivers.initial_state import InitialState
from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.extensions.drivers.models import MODELS, course_in, foreseen, specifications
from roadproof.extensions.drivers.outcome import Outcome, faster_text, shown_by_drive
from roadproof.extensions.drivers.replay import Replayed, first_cut, replay
from roadproof.extensions.drivers.sampled_replay import replay_samples
from roadproof.extensions.traffic.evaluate.courses import BEGINS
from roadproof.extensions.traffic.evaluate.driven import scene_of
from roadproof.extensions.traffic.evaluate.foretelling import RESULTS
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.library.bind import values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import load_library
from roadproof.library.scenarios import number_in
from roadproof.library.specification import Specification, read_specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import with_values
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.canonical import digest
from roadproof.semantics.exact.algebraic import as_float
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.truth import Cut
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at
from roadproof.world.signals import SIGNALS

_JUST_AFTER = Fraction(1, 1000)  # s after an instant that is not one of the manoeuvre itself
_PLACES = 6  # decimals of a state


@dataclass(frozen=True)
class DrivenTest:
    """A drive in which a model drives SV, what it shows, and from when on (s) all its vehicles rest."""

    drive: Drive
    formula: str
    rests: Fraction


@dataclass(frozen=True)
class Decision:
    """The result of a scenario in which a driver model drives SV.

    ``at``: when the manoeuvre begins (s), None where it never does. ``gap``: the least gap that is left (m).
    ``instant``, ``speed``: when SV touches POV (s), and how much faster it then is (m/s). ``start``: the
    state when the manoeuvre begins, as the sheets of UN R157 name it (SI). ``driven``: the drive of a
    test that is one, with the model in place of SV.
    """

    scenario: str
    vehicles: tuple[str, ...]
    driver: str
    side: TestedSide
    at: float | None = None
    gap: float | None = None
    instant: float | None = None
    speed: float | None = None
    start: Mapping[str, float] = field(default_factory=dict)
    reason: Reason = NO_REASON
    driven: DrivenTest | None = field(default=None, repr=False, compare=False)


@dataclass(frozen=True)
class Drivers:
    """The driver ``models`` that are asked, in definitions that have them; ``values``: parameters (SI)."""

    specification: Specification
    values: Mapping[str, Fraction]
    models: tuple[str, ...]
    _read: dict[str, Formula] = field(default_factory=dict, repr=False, compare=False)
    _decided: dict[str, tuple[Decision, ...]] = field(default_factory=dict, repr=False, compare=False)

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        """Leave out what was worked out, so that no process sends it to another one."""
        return type(self), (self.specification, self.values, self.models)

    @cached_property
    def settings(self) -> DriverSettings:
        """Parameters and options of the models."""
        return DriverSettings(self.values, self.specification.options)

    def of(self, manoeuvre: ManoeuvreName) -> tuple[str, ...]:
        """The models that speak of a manoeuvre."""
        return tuple(x for x in self.models if manoeuvre in MODELS[x].manoeuvres)

    def decided(self, key: str, decide: Callable[[], tuple[Decision, ...]]) -> tuple[Decision, ...]:
        """Return the decisions under a key that says all of a drive, by ``decide`` where they are new."""
        if key not in self._decided:
            self._decided[key] = decide()
        return self._decided[key]

    def begins(self, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...]) -> Formula:
        """Return the formula that the manoeuvre begins in a state, at the values of parameters."""
        text = foreseen(manoeuvre, vehicles)
        if text not in self._read:
            self._read[text] = with_values(read_claim(self.specification, text).formula, self.values)
        return self._read[text]


def driver_models(
    specification_in: Specification, parameters: Mapping[str, Fraction], names: tuple[str, ...]
) -> Drivers | None:
    """Return the driver models of some names, in definitions on top of which ``driver.spec`` is read.

    ``parameters``: values of parameters (SI). Raises ``InputError``, ``UsageError``.
    """
    if not names:
        return None
    library = specification_in.library
    read = {x.text for x in library.files}
    missing = [x for x in map(read_specification, map(Path, specifications())) if x.text not in read]
    if missing:
        library = load_library([*missing, *library.files])
    specification = library.select(specification_in.set_name, specification_in.options)
    values = values_with(library, parameters)
    require(specification, values)
    return Drivers(specification, values, tuple(MODELS[name].name for name in names))


def content_of(drivers: Drivers) -> str:
    """A digest that changes with the models, with every definition in force, and with parameters."""
    specification = drivers.specification
    return digest(
        drivers.models,
        specification.set_name,
        specification.options,
        drivers.values,
        specification.library.fingerprint,
    )


def manoeuvre_of(scenario: str) -> ManoeuvreName | None:
    """The manoeuvre of a scenario by name; None for classes, and for scenarios that no model speaks of."""
    number = number_in(scenario)
    return None if number is None else course_in(number)


# --- drives --------------------------------------------------------------------------------------


def decide_drive(
    file: DriveFile, drivers: Drivers, scenario: str, vehicles: tuple[str, ...], since: float
) -> Iterator[Decision]:
    """Yield a decision for each model that speaks of the scenario, which holds from ``since`` (s) on.

    They are worked out once for a drive: claims, their judges and views ask for them.
    """
    key = digest(file.drive, file.road, scenario, vehicles, since)
    decisions = drivers.decided(key, lambda: tuple(_decided(file, drivers, scenario, vehicles, since)))
    yield from decisions


def _decided(
    file: DriveFile, drivers: Drivers, scenario: str, vehicles: tuple[str, ...], since: float
) -> Iterator[Decision]:
    manoeuvre = manoeuvre_of(scenario)
    if manoeuvre is None or not drivers.of(manoeuvre):
        return
    begins, start = drivers.begins(manoeuvre, vehicles), Fraction(since)
    cut = first_cut(judge(begins, file.drive).truth(begins), start)
    if cut is None:
        yield from _not_covered(drivers, manoeuvre, scenario, vehicles)
        return
    at, state = as_float(cut.point), _state_at(file, cut).start(manoeuvre, vehicles)
    for model in drivers.of(manoeuvre):
        replayed = replay(
            file.drive, file.road, vehicles, manoeuvre, model, start, drivers.specification, drivers.settings
        )
        decision = _decision(scenario, vehicles, model, replayed.outcome, at, state)
        yield replace(decision, driven=_driven_test(replayed, vehicles, start))


def _driven_test(replayed: Replayed, vehicles: tuple[str, ...], since: Fraction) -> DrivenTest | None:
    shown = shown_by_drive(replayed.outcome, vehicles)
    if replayed.drive is None or not shown:
        return None
    begin = f"{since} s" if since.denominator == 1 else f"{since}*1 s"
    formula = f"F[{begin}, {begin}] ({shown})" if since else shown
    return DrivenTest(replayed.drive, formula, max(rest_of(replayed.drive), since))


def _state_at(file: DriveFile, cut: Cut) -> InitialState:
    """The state at a cut; near it where it is just after a point, or at an irrational one."""
    time = cut.point if isinstance(cut.point, Fraction) else Fraction(as_float(cut.point))
    time += _JUST_AFTER if cut.after else 0
    states = {name: state_at(motion, time) for name, motion in file.drive.vehicles.items()}
    return InitialState(
        {(x, name): _rounded(getattr(at, x)) for name, at in states.items() for x in SIGNALS},
        {(x, n): getattr(m, x) for n, m in file.drive.vehicles.items() for x in ("length", "width")},
    )


# --- samples -------------------------------------------------------------------------------------


def decide_trace(
    trace: OneTrace,
    drivers: Drivers,
    scenario: str,
    vehicles: tuple[str, ...],
    since: float,
    names: tuple[str, ...],
) -> Iterator[Decision]:
    """Yield a decision for each model on a sampled trace (see ``decide_drive``).

    ``names``: the vehicles as the test calls them.
    """
    manoeuvre = manoeuvre_of(scenario)
    if manoeuvre is None or not drivers.of(manoeuvre):
        return
    batch = trace.batch
    answer = compile({BEGINS: drivers.begins(manoeuvre, vehicles)}).evaluate(batch, "truncated", at="all")
    true = answer.answers[BEGINS].true[:, 0]
    first = round(since / float(batch.dt))
    begin = next((k for k in range(first, int(batch.lengths[0])) if true[k]), None)
    if begin is None:
        yield from _not_covered(drivers, manoeuvre, scenario, names)
        return
    state = InitialState(
        {
            (x, name): _rounded(batch.signals[x, name][begin, 0])
            for name in vehicles
            for x in SIGNALS
            if (x, name) in batch.signals
        },
        {(x, n): _rounded(batch.sizes[x, n][0]) for n in vehicles for x in ("length", "width")},
    )
    scene = scene_of(batch, trace.road, vehicles, first * batch.dt)
    for model in drivers.of(manoeuvre):
        outcome = replay_samples(scene, manoeuvre, model, drivers.settings)
        at = float(begin * batch.dt)
        yield _decision(scenario, names, model, outcome, at, state.start(manoeuvre, vehicles))


# --- tests with a formula -------------------------------------------------------------------------


def decide_formula(
    decisions: Sequence[Decision], searched_in_vain: Collection[tuple[str, str]] = ()
) -> Iterator[Decision]:
    """Yield the decision on a test with a formula, from decisions on some of its drives.

    Drives on both sides show that it is partly preventable; one side alone decides nothing of other drives.
    ``searched_in_vain``: scenarios and models for which a search for a drive on a further side found none.
    """
    groups: dict[tuple[str, str], list[Decision]] = {}
    for x in decisions:
        groups.setdefault((x.scenario, x.driver), []).append(x)
    for key, group in groups.items():
        undecided_test = replace(group[0], at=None, gap=None, instant=None, speed=None, start={}, driven=None)
        counts = Counter(x.side for x in group)
        if {"preventable", "unpreventable"} <= counts.keys():
            yield replace(undecided_test, side="partly", reason=ReasonKind.BOTH_SIDES())
        else:
            counts_text = ", ".join(f"{count} {side}" for side, count in counts.items())
            why = ReasonKind.ONE_SIDE_SOUGHT if key in searched_in_vain else ReasonKind.ONE_SIDE
            yield replace(undecided_test, side="undecided", reason=why(counts_text))


# --- both ----------------------------------------------------------------------------------------


def _not_covered(
    drivers: Drivers, manoeuvre: ManoeuvreName, scenario: str, vehicles: tuple[str, ...]
) -> Iterator[Decision]:
    reason = ReasonKind.NOT_BEGUN(manoeuvre)
    for model in drivers.of(manoeuvre):
        yield Decision(scenario, vehicles, model, "not covered", reason=reason)


def _decision(
    scenario: str,
    vehicles: tuple[str, ...],
    model: str,
    outcome: Outcome,
    at: float,
    start: Mapping[str, float],
) -> Decision:
    return Decision(
        scenario,
        vehicles,
        model,
        RESULTS[outcome.result],
        round(at, _PLACES),
        outcome.gap,
        outcome.instant,
        outcome.speed,
        start,
        outcome.reason,
    )


def _rounded(value: float | Fraction) -> Fraction:
    return Fraction(round(Fraction(value) * 10**_PLACES), 10**_PLACES)


def decision_text(decision: Decision) -> str:
    """The side with its figures: ``preventable (3.2 m left)``, ``unpreventable (at 4.1 s, 9 m/s faster)``."""
    if decision.gap is not None:
        return f"{decision.side} ({decision.gap:g} m left)"
    if decision.instant is not None and decision.speed is not None:
        return f"{decision.side} (touches at {decision.instant:g} s, {faster_text(decision.speed)})"
    return decision.side
