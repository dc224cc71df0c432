"""The nearest scenario to a test that shows none: its first false part, and spec sets in which one holds."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import RoadproofError
from roadproof.extensions.catalogue.catalogue_data import NearestScenario
from roadproof.extensions.catalogue.false_parts import FalsePart, false_part_text, first_false_part
from roadproof.extensions.catalogue.role_choices import Choice
from roadproof.extensions.catalogue.target_formulas import ScenarioKey, TargetFormulas
from roadproof.library.scenarios import name_of
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.judging import DriveJudge, LazyJudge
from roadproof.semantics.exact.signals import AbstractSignals, Signals
from roadproof.semantics.sampled.batch import Batch
from roadproof.world.road import Road
from roadproof.world.signals import SIGNALS


@dataclass(frozen=True)
class VehicleMotions:
    """The motion of vehicles on a road up to ``horizon`` (s), with the choices of roles and lanes to try."""

    signals: Signals
    road: Road
    horizon: Fraction
    roles: tuple[Choice, ...]
    lanes: tuple[str, ...]


def nearest_scenario(motions: VehicleMotions, formulas: TargetFormulas) -> NearestScenario | None:
    """Return the scenario most parts of which hold from time 0 on, with its first false part.

    None where a scenario holds, or where no comparison is to blame.
    """
    judge = DriveJudge.on(motions.signals)
    if any(judge.judgement(formula).holds for *_, formula in _applied(motions, formulas)):
        return None
    candidates = [
        (part, name_of(key.number), vehicles, lane)
        for key, vehicles, lane, formula in _applied(motions, formulas)
        if (part := first_false_part(formula, judge, motions.horizon)) is not None
    ]
    if not candidates:
        return None
    part, nearest, vehicles, lane = max(candidates, key=lambda x: x[0].score)
    lazy = LazyJudge(judge.courses, judge.truths)
    sets = {
        set_name: names
        for set_name, other in formulas.in_other_sets.items()
        if (names := _true_scenarios(motions, other, lazy if formulas.is_always_judged else judge))
    }
    return NearestScenario(
        nearest,
        vehicles,
        lane,
        float(part.at),
        _lacks(part),
        false_part_text(part, formulas.specification.definitions),
        sets,
    )


def _lacks(part: FalsePart) -> str:
    """Return the application of the definition that fails; empty where none surrounds the comparison."""
    return (
        "" if part.part is None else f"{part.part.name.partition('@')[0]}({', '.join(part.part.arguments)})"
    )


def _applied(
    motions: VehicleMotions, formulas: TargetFormulas
) -> Iterator[tuple[ScenarioKey, tuple[str, ...], str, Formula]]:
    """Yield each scenario with vehicles, lane and bound formula, for each choice of roles and each lane."""
    for roles, vehicles in motions.roles:
        for lane in motions.lanes:
            for key, formula in formulas.on(motions.road, roles, vehicles, lane).items():
                if isinstance(key, ScenarioKey):
                    yield key, vehicles, lane, formula


def _true_scenarios(
    motions: VehicleMotions, formulas: TargetFormulas, judge: DriveJudge | LazyJudge
) -> tuple[str, ...]:
    """Return the scenarios of another spec set that hold; none of a set that cannot be judged."""
    try:
        names = {
            name_of(key.number) for key, *_, formula in _applied(motions, formulas) if judge.holds(formula)
        }
    except RoadproofError:
        return ()
    return tuple(x for x in map(name_of, formulas.numbers) if x in names)


def signals_of(batch: Batch) -> AbstractSignals:
    """Return the signals of a trace of samples; each value holds until the next one, the last for ever."""
    count = int(batch.lengths[0])
    vehicles = dict.fromkeys(vehicle for _, vehicle in batch.signals)
    signals: dict[t.Signal | t.CustomSignal, tuple[tuple[Fraction, Fraction], ...]] = {}
    for signal in (t.Signal(name, vehicle) for name in SIGNALS for vehicle in vehicles):
        values = batch.signals.get((signal.name, signal.vehicle))
        if values is not None:
            signals[signal] = tuple((k * batch.dt, Fraction(float(values[k, 0]))) for k in range(count))
    sizes = {t.Size(name, vehicle): Fraction(float(x[0])) for (name, vehicle), x in batch.sizes.items()}
    return AbstractSignals(signals, sizes)
