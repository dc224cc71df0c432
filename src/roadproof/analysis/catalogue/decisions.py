"""Whether a driver who does what a model says would have prevented what a test shows, and by how much.

As in evaluations of recordings, models are asked about the state in which the manoeuvre of a scenario begins,
at danger at the latest, and POV is supposed to go on as it moves there.
"""

from bisect import bisect_right
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from roadproof.drivers import margins
from roadproof.drivers.manoeuvres import ManoeuvreName
from roadproof.drivers.models import MODELS, course_in, foreseen, unpreventable
from roadproof.errors import InputError
from roadproof.evidence.answers.catalogue_index import TestedSide
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import danger, endangered, number_in
from roadproof.library.specification import Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import with_values
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.recordings.evaluate.courses import BEGINS
from roadproof.recordings.evaluate.one_trace import OneTrace
from roadproof.runtime.canonical import digest
from roadproof.semantics.exact.algebraic import approximate
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.truth import Cut, TruthSet
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.motion import state_at
from roadproof.world.signals import SIGNALS

DANGER = "in danger"
_JUST_AFTER = Fraction(1, 1000)  # s after an instant that is not one of the manoeuvre itself
_PLACES = 6  # decimals of a state
_LEAST = {"Vy": (0.1, Why.SLIGHT_CROSSING), "Gx": (0.5, Why.SLIGHT_BRAKING)}
"""Below these values a manoeuvre has hardly begun."""


@dataclass(frozen=True)
class Decision:
    """What becomes of a scenario under a model.

    ``at``: when the manoeuvre begins (s), None where it never does before danger. ``metres``, ``seconds``:
    how far the gap, and the time that the model takes to respond, are from the nearest value with the other
    answer; None where there is none within 200 m and 10 s (controllers: 64 m, and no time). ``start``: the
    state, as the sheets of UN R157 name it (SI).
    """

    scenario: str
    vehicles: tuple[str, ...]
    driver: str
    side: TestedSide
    at: float | None = None
    metres: float | None = None
    seconds: float | None = None
    start: Mapping[str, float] = field(default_factory=dict)
    reason: Reason = NO_REASON


@dataclass(frozen=True)
class Drivers:
    """The driver ``models`` that are asked, in definitions that have them; ``values``: parameters (SI)."""

    specification: Specification
    values: Mapping[str, Fraction]
    models: tuple[str, ...]
    _read: dict[str, Formula] = field(default_factory=dict, repr=False, compare=False)
    _bound: dict[str, Formula] = field(default_factory=dict, repr=False, compare=False)
    _boundaries: dict[str, margins.Boundary] = field(default_factory=dict, repr=False, compare=False)

    def of(self, manoeuvre: ManoeuvreName) -> tuple[str, ...]:
        """The models that speak of a manoeuvre."""
        return tuple(x for x in self.models if manoeuvre in MODELS[x].manoeuvres)

    def formula(self, text: str) -> Formula:
        """A formula as text, with parameters left as they are."""
        if text not in self._read:
            self._read[text] = read_claim(self.specification, text).formula
        return self._read[text]

    def begins(self, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...]) -> dict[str, Formula]:
        """What is asked of a drive: that the manoeuvre begins, and that danger is there."""
        first, last = endangered(vehicles)
        return {
            BEGINS: self._at_values(foreseen(manoeuvre, vehicles)),
            DANGER: self._at_values(danger(self.specification, first, last).text),
        }

    def collides(self, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...]) -> dict[str, Formula]:
        """What is asked of a state: that a collision is unpreventable, for each model with a formula."""
        return {
            x: self._at_values(unpreventable(manoeuvre, x, vehicles))
            for x in self.of(manoeuvre)
            if not MODELS[x].is_stepped
        }

    def boundary(self, manoeuvre: ManoeuvreName, model: str, vehicles: tuple[str, ...]) -> margins.Boundary:
        """Where a collision is unpreventable for a model, to be varied."""
        text = unpreventable(manoeuvre, model, vehicles)
        if text not in self._boundaries:
            self._boundaries[text] = margins.boundary_of(self.formula(text), model, self.values)
        return self._boundaries[text]

    def _at_values(self, text: str) -> Formula:
        if text not in self._bound:
            self._bound[text] = with_values(self.formula(text), self.values)
        return self._bound[text]


def content_of(drivers: Drivers) -> str:
    """A digest that changes with the models, with every definition in force, and with parameters."""
    home = drivers.specification
    return digest(drivers.models, home.set_name, home.options, drivers.values, home.library.fingerprint)


def course_of(scenario: str) -> ManoeuvreName | None:
    """The manoeuvre of a scenario by name; None for classes, and for scenarios that no model speaks of."""
    number = number_in(scenario)
    return None if number is None else course_in(number)


# --- drives --------------------------------------------------------------------------------------


def decide_drive(
    file: DriveFile, drivers: Drivers, scenario: str, vehicles: tuple[str, ...], since: float
) -> Iterator[Decision]:
    """A decision for each model that speaks of the scenario, which holds from ``since`` (s) on."""
    manoeuvre = course_of(scenario)
    if manoeuvre is None or not drivers.of(manoeuvre):
        return
    asked = drivers.begins(manoeuvre, vehicles)
    judgement = judge(f.And(tuple(asked.values())), file.drive)
    truths = {key: judgement.truth(x) for key, x in asked.items()}
    start = Cut(Fraction(since), False)
    begins, threat = (_first(truths[key], start) for key in (BEGINS, DANGER))
    if begins is None or (threat is not None and threat < begins):
        yield from _not_foreseen(drivers, manoeuvre, scenario, vehicles)
        return
    state = _state_at(file, begins)
    hit = _hit(file, begins, state, drivers.collides(manoeuvre, vehicles))
    yield from _decided(drivers, manoeuvre, scenario, vehicles, approximate(begins.point), state, hit)


def _state_at(file: DriveFile, cut: Cut) -> margins.State:
    """The state at a cut; near it where it is just after a point, or at an irrational one."""
    time = cut.point if isinstance(cut.point, Fraction) else Fraction(approximate(cut.point))
    time += _JUST_AFTER if cut.after else 0
    states = {name: state_at(motion, time) for name, motion in file.drive.vehicles.items()}
    return margins.State(
        {(x, name): Fraction(getattr(at, x)) for name, at in states.items() for x in SIGNALS},
        {(x, n): getattr(m, x) for n, m in file.drive.vehicles.items() for x in ("length", "width")},
    )


def _hit(file: DriveFile, cut: Cut, state: margins.State, collides: Mapping[str, Formula]) -> dict[str, bool]:
    """Whether each formula about a state holds at a cut of a drive, exactly."""
    if isinstance(cut.point, Fraction) and not cut.after:
        return {name: margins.holds_in(x, state) for name, x in collides.items()}
    judgement = judge(f.And(tuple(collides.values())), file.drive)
    return {name: bisect_right(judgement.truth(x).cuts, cut) % 2 == 1 for name, x in collides.items()}


def _first(truth: TruthSet, start: Cut) -> Cut | None:
    """The first cut from ``start`` on from which something is true."""
    place = bisect_right(truth.cuts, start)
    if place % 2:
        return start
    return truth.cuts[place] if place < len(truth.cuts) else None


# --- samples -------------------------------------------------------------------------------------


def decide_trace(
    trace: OneTrace,
    drivers: Drivers,
    scenario: str,
    vehicles: tuple[str, ...],
    since: float,
    called: tuple[str, ...],
) -> Iterator[Decision]:
    """As ``decide_drive``, of samples; ``called``: what the test calls the vehicles."""
    manoeuvre = course_of(scenario)
    if manoeuvre is None or not drivers.of(manoeuvre):
        return
    batch = trace.batch
    asked = {**drivers.begins(manoeuvre, vehicles), **drivers.collides(manoeuvre, vehicles)}
    answers = compile(asked).evaluate(batch, "truncated", at="all").answers
    true = {key: answer.true[:, 0] for key, answer in answers.items()}
    first = round(since / float(batch.dt))
    for k in range(first, int(batch.lengths[0])):
        if true[BEGINS][k]:
            state = margins.State(
                {
                    (x, name): _rounded(batch.signals[x, name][k, 0])
                    for name in vehicles
                    for x in SIGNALS
                    if (x, name) in batch.signals
                },
                {(x, n): _rounded(batch.sizes[x, n][0]) for n in vehicles for x in ("length", "width")},
            )
            hit = {x: bool(true[x][k]) for x in true if x in MODELS}
            at = float(k * batch.dt)
            yield from _decided(drivers, manoeuvre, scenario, vehicles, at, state, hit, called)
            return
        if true[DANGER][k]:
            break
    yield from _not_foreseen(drivers, manoeuvre, scenario, called)


# --- tests with a formula -------------------------------------------------------------------------


def decide_formula(found: Sequence[Decision], missed: Collection[tuple[str, str]] = ()) -> Iterator[Decision]:
    """What becomes of a test with a formula, of some drives of which there are decisions.

    Drives on both sides show that it is partly preventable; one side alone decides nothing of other drives.
    ``missed``: scenarios and models for which a search for a drive on a further side found none.
    """
    groups: dict[tuple[str, str], list[Decision]] = {}
    for x in found:
        groups.setdefault((x.scenario, x.driver), []).append(x)
    for key, those in groups.items():
        made = replace(those[0], at=None, metres=None, seconds=None, start={})
        counts = Counter(x.side for x in those)
        if {"preventable", "unpreventable"} <= counts.keys():
            yield replace(made, side="partly", reason=Why.BOTH_SIDES())
        else:
            told = ", ".join(f"{count} {side}" for side, count in counts.items())
            why = Why.ONE_SIDE_SOUGHT if key in missed else Why.ONE_SIDE
            yield replace(made, side="undecided", reason=why(told))


# --- both ----------------------------------------------------------------------------------------


def _not_foreseen(
    drivers: Drivers, manoeuvre: ManoeuvreName, scenario: str, vehicles: tuple[str, ...]
) -> Iterator[Decision]:
    reason = Why.NOT_BEFORE_DANGER(manoeuvre)
    for model in drivers.of(manoeuvre):
        yield Decision(scenario, vehicles, model, "not foreseen", reason=reason)


def _decided(
    drivers: Drivers,
    manoeuvre: ManoeuvreName,
    scenario: str,
    vehicles: tuple[str, ...],
    at: float,
    state: margins.State,
    hit: Mapping[str, bool],
    called: tuple[str, ...] | None = None,
) -> Iterator[Decision]:
    """``hit``: whether each model with a formula collides; the state is rounded for margins only."""
    near = margins.State({k: _rounded(x) for k, x in state.signals.items()}, state.sizes)
    begun = near.start(manoeuvre, vehicles)
    when = round(at, _PLACES)
    made = Decision(scenario, called or vehicles, "", "undecided", when, start=begun, reason=_slight(begun))
    for model in drivers.of(manoeuvre):
        if MODELS[model].is_stepped:
            yield _of_controller(replace(made, driver=model), near, manoeuvre, vehicles)
            continue
        found = margins.margin(near, drivers.boundary(manoeuvre, model, vehicles), vehicles)
        side: TestedSide = "unpreventable" if hit[model] else "preventable"
        yield replace(made, driver=model, side=side, metres=found.metres, seconds=found.seconds)


def _slight(start: Mapping[str, float]) -> Reason:
    """What is to be known where a manoeuvre has hardly begun: models suppose that POV goes on so."""
    for name, (least, why) in _LEAST.items():
        if start.get(name, least) < least:
            return why(start[name])
    return NO_REASON


def _of_controller(
    made: Decision, state: margins.State, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...]
) -> Decision:
    try:
        hit = margins.controller_hits(state, manoeuvre, vehicles)
        metres = None if made.reason else margins.controller_margin(state, manoeuvre, vehicles, hit)
    except InputError as error:
        return replace(made, reason=Why.TOLD(error))
    return replace(made, side="unpreventable" if hit else "preventable", metres=metres)


def _rounded(value: float | Fraction) -> Fraction:
    return Fraction(round(Fraction(value) * 10**_PLACES), 10**_PLACES)
