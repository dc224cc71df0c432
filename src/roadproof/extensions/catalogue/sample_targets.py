"""The targets that samples show on every continuation, and the answer about a test that is samples."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.catalogue.catalogue_data import NearestScenario, ShownTarget
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer, has_scenario, in_order
from roadproof.extensions.catalogue.entries import ConcreteTest, Freedom
from roadproof.extensions.catalogue.initial_values import STATE, relative_values
from roadproof.extensions.catalogue.nearest_scenario import VehicleMotions, nearest_scenario, signals_of
from roadproof.extensions.catalogue.role_choices import role_choices, samples_in_roles
from roadproof.extensions.catalogue.target_formulas import ENDANGERED, GAP, TargetFormulas
from roadproof.extensions.catalogue.traces import is_samples, traces_of
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, decide_trace
from roadproof.extensions.traffic.evaluate.faults import faults_of
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.library.scenarios import PAIR
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.length_error import bend_note


def answer_of_samples(
    entry: ConcreteTest, formulas: TargetFormulas, freedom: Freedom, drivers: Drivers | None
) -> ConcreteAnswer:
    """Return the answer about a test that is samples, with the decisions of ``drivers``.

    Raises ``InputError`` for a test that cannot be read, and for samples that are no motion.
    """
    decisions: dict[tuple[str, tuple[str, ...]], tuple[Decision, ...]] = {}
    shown: dict[tuple[str, tuple[str, ...], str], ShownTarget] = {}
    begins: dict[str, float] = {}
    endangered_in: dict[ShownTarget, OneTrace] = {}
    first: OneTrace | None = None
    notes: dict[str, None] = {}
    played = dict(entry.roles)
    for trace, names_in_file in traces_of(entry, formulas.role_names):
        faults = faults_of(trace)
        if faults:
            raise InputError(f"{entry.place}: the samples are no motion: {'; '.join(faults)}")
        first = first or trace
        if is_samples(entry):
            played = {role: name for role, name in names_in_file.items() if role in formulas.role_names}
        notes |= dict.fromkeys((*trace.notes, *filter(None, (bend_note(trace.road),))))
        for x, cast, names in _targets_shown(trace, names_in_file, formulas, freedom):
            shown.setdefault((x.what, x.vehicles, x.lane), x)
            if drivers is not None and (x.what, x.vehicles) not in decisions:
                made = decide_trace(cast, drivers, x.what, names, x.at, x.vehicles)
                decisions[x.what, x.vehicles] = tuple(made)
        dangers = [x for x in shown.values() if x.what == ENDANGERED]
        if dangers and {*trace.lanes} == {*PAIR}:
            endangered_in.setdefault(min(dangers, key=lambda x: x.at), trace)
        begins = begins or relative_values(_states(trace))
    gaps = [
        gap
        for danger, trace in endangered_in.items()
        if {x.what for x in shown.values()} == {ENDANGERED}
        for gap in _gap(trace, formulas, danger)
    ]
    why = None if first is None or has_scenario(shown.values()) else _nearest(first, formulas, freedom)
    targets = (*in_order(shown.values()), *gaps)
    every_decision = tuple(x for made in decisions.values() for x in made)
    return ConcreteAnswer(
        entry,
        entry.claims,
        targets,
        begins,
        notes=tuple(notes),
        why=why,
        decisions=every_decision,
        roles=played,
    )


def _targets_shown(
    trace: OneTrace, names_in_file: Mapping[str, str], formulas: TargetFormulas, freedom: Freedom
) -> Iterator[tuple[ShownTarget, OneTrace, tuple[str, ...]]]:
    """Yield each target with the trace in which the vehicles have their roles, and their names in it."""
    names = tuple(trace.lanes)
    choices = role_choices(formulas.roles, formulas.all_roles, names, freedom.roles, any_way=True)
    for roles, vehicles in choices:
        in_file = tuple(names_in_file.get(name, name) for name in vehicles)
        cast, cast_names = samples_in_roles(trace, roles, vehicles)
        for lane in trace.road.lanes:
            for what, at in _monitor(cast, formulas, roles, cast_names, lane):
                yield ShownTarget(what, in_file, lane, at), cast, cast_names


def _nearest(trace: OneTrace, formulas: TargetFormulas, freedom: Freedom) -> NearestScenario | None:
    """Return the nearest scenario from the first sample on; None on measured roads with unknown lanes."""
    if trace.batch.given:
        return None
    end = (int(trace.batch.lengths[0]) - 1) * trace.batch.dt
    names = tuple(trace.lanes)
    choices = role_choices(formulas.roles, formulas.all_roles, names, freedom.roles, any_way=True)
    in_roles = tuple(x for x in choices if formulas.role_names >= {*x[1]})
    motions = VehicleMotions(signals_of(trace.batch), trace.road, end, in_roles, trace.road.lanes)
    return nearest_scenario(motions, formulas)


def _monitor(
    trace: OneTrace, formulas: TargetFormulas, roles: tuple[str, ...], vehicles: tuple[str, ...], lane: str
) -> Iterator[tuple[str, float]]:
    """Yield the targets shown for every continuation of the trace, with the time of the first sample (s)."""
    monitor = compile(formulas.on(trace.road, roles, vehicles, lane))
    answers = monitor.evaluate(trace.batch, "truncated", at="all").answers
    truths = {key: answer.true[:, 0] for key, answer in answers.items()}
    table = np.stack(list(truths.values()))
    changes = np.flatnonzero(np.any(table[:, 1:] != table[:, :-1], axis=0)) + 1
    for sample in (0, *changes.tolist()):
        true = frozenset(key for key, truth in truths.items() if truth[sample])
        for what in formulas.names_of(roles, true):
            yield what, float(sample * trace.batch.dt)


def _gap(trace: OneTrace, formulas: TargetFormulas, danger: ShownTarget) -> Iterator[ShownTarget]:
    """Yield the danger of SV and POV as a gap, where no scenario covers it on any continuation."""
    sample = round(danger.at / float(trace.batch.dt))
    classes = () if formulas.gaps is None else formulas.gaps.of_trace(trace, sample)
    if classes:
        yield from (replace(danger, what=what) for what in (GAP, *classes))


def _states(trace: OneTrace) -> dict[str, tuple[float, ...]]:
    """Return the values of ``STATE`` of each vehicle at the first sample."""
    signals = trace.batch.signals
    return {n: tuple(float(signals[x, n][0, 0]) for x in STATE) for n in trace.lanes}
