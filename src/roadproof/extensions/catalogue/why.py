"""Why a test shows no scenario: the nearest one and what it lacks, and the spec sets in which one holds."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import RoadproofError
from roadproof.extensions.catalogue.asked import Questions, ScenarioQuestion
from roadproof.extensions.catalogue.kept import Why
from roadproof.extensions.catalogue.nearest import FalsePart, first_false_part, told
from roadproof.library.scenarios import name_of
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.exact import DriveJudge, LazyJudge
from roadproof.semantics.exact.signals import AbstractSignals, Signals
from roadproof.semantics.sampled.batch import Batch
from roadproof.world.road import Road
from roadproof.world.signals import SIGNALS

_Roles = tuple[tuple[str, ...], tuple[str, ...]]


@dataclass(frozen=True)
class Course:
    """How vehicles move on a road, up to ``horizon`` (s), and the roles and lanes to look at."""

    signals: Signals
    road: Road
    horizon: Fraction
    roles: tuple[_Roles, ...]
    lanes: tuple[str, ...]


def why_none(course: Course, asked: Questions) -> Why | None:
    """Why no scenario holds from time 0 on; None where one does, or where no comparison is to blame."""
    judge = DriveJudge.on(course.signals)
    if any(judge.judgement(formula).holds for *_, formula in _applied(course, asked)):
        return None
    found = [
        (part, name_of(key.number), vehicles, lane)
        for key, vehicles, lane, formula in _applied(course, asked)
        if (part := first_false_part(formula, judge, course.horizon)) is not None
    ]
    if not found:
        return None
    part, nearest, vehicles, lane = max(found, key=lambda x: x[0].score)
    others = asked.in_other_sets.items()
    lazy = LazyJudge(judge.courses, judge.truths)
    sets = {
        name: held
        for name, other in others
        if (held := _held_in(course, other, lazy if asked.is_always_judged else judge))
    }
    return Why(
        nearest,
        vehicles,
        lane,
        float(part.at),
        _lacks(part),
        told(part, asked.specification.definitions),
        sets,
    )


def _lacks(part: FalsePart) -> str:
    return (
        "" if part.part is None else f"{part.part.name.partition('@')[0]}({', '.join(part.part.arguments)})"
    )


def _applied(
    course: Course, asked: Questions
) -> Iterator[tuple[ScenarioQuestion, tuple[str, ...], str, Formula]]:
    for roles, vehicles in course.roles:
        for lane in course.lanes:
            for key, formula in asked.on(course.road, roles, vehicles, lane).items():
                if isinstance(key, ScenarioQuestion):
                    yield key, vehicles, lane, formula


def _held_in(course: Course, asked: Questions, judge: DriveJudge | LazyJudge) -> tuple[str, ...]:
    """The scenarios of another spec set that hold; none of a set that cannot be asked about."""
    try:
        names = {name_of(key.number) for key, *_, formula in _applied(course, asked) if judge.holds(formula)}
    except RoadproofError:
        return ()
    return tuple(x for x in map(name_of, asked.numbers) if x in names)


def signals_of(batch: Batch) -> AbstractSignals:
    """The signals of a trace of samples, each held until the next one and the last for ever."""
    count = int(batch.lengths[0])
    vehicles = dict.fromkeys(vehicle for _, vehicle in batch.signals)
    signals: dict[t.Signal | t.Own, tuple[tuple[Fraction, Fraction], ...]] = {}
    for signal in (t.Signal(name, vehicle) for name in SIGNALS for vehicle in vehicles):
        values = batch.signals.get((signal.name, signal.vehicle))
        if values is not None:
            signals[signal] = tuple((k * batch.dt, Fraction(float(values[k, 0]))) for k in range(count))
    sizes = {t.Size(name, vehicle): Fraction(float(x[0])) for (name, vehicle), x in batch.sizes.items()}
    return AbstractSignals(signals, sizes)
