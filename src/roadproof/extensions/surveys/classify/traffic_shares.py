"""Counts of each class in recordings, and a check that the classes are a partition there, too.

A situation is a disturbance trace (semantics §7), its vehicles in their roles, and a lane. The lane is that
of either vehicle of a pair at the start of the trace, for three vehicles that of SV. Traces are read to their
end and no further (``clip``).
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TypeAlias, TypeVar

from roadproof.engines.search.impossible import at_start
from roadproof.extensions.surveys.classify.classes import Class, Classes
from roadproof.extensions.surveys.classify.data import SharesData, Situations
from roadproof.extensions.traffic.evaluate.evaluate import Findings, evaluate_recording
from roadproof.extensions.traffic.evaluate.questions import (
    ROLES,
    START,
    EvaluationQuestions,
    EvaluationSettings,
    MonitorKey,
    compile_questions,
    of_three,
)
from roadproof.extensions.traffic.evaluate.totals import ShownMoments, without_repeats
from roadproof.extensions.traffic.evaluate.traces import OTHER_LANE
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.reliable import left_out_notes
from roadproof.extensions.traffic.scenario_parts import disturbance
from roadproof.library.elaborate import apply_definition, walk_of
from roadproof.library.scenarios import LANE, MIN_DANGER, PAIR, TRIPLE, name_of, number_in
from roadproof.library.specification import Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import all_with_values
from roadproof.semantics.sampled.compiled import Monitor, compile

K = TypeVar("K")
Situation: TypeAlias = tuple[str, int, int, int | None, str]
"""Recording, SV, POV, POV2 or None, lane."""


@dataclass
class Shares:
    """Counts over recordings. By class ``situations`` and ``traces``; ``classified`` by number of vehicles.

    ``all_traces``: traces in which danger arises; ``covered``: those with a class; ``broken``: situations in
    which classes are not what they are proved to be; ``repeated``: traces that an earlier recording shows
    too, which are left out. ``source`` says in words what was counted; ``left_out`` are notes on vehicles
    that recordings were read without.
    """

    recordings: list[str] = field(default_factory=list)
    all_traces: int = 0
    covered: int = 0
    situations: Counter[str] = field(default_factory=Counter)
    traces: Counter[str] = field(default_factory=Counter)
    classified: Counter[int] = field(default_factory=Counter)
    broken: list[str] = field(default_factory=list)
    repeated: int = 0
    source: str = ""
    left_out: list[str] = field(default_factory=list)

    @property
    def data(self) -> SharesData:
        """The shares as data of an answer."""
        return SharesData(
            source=self.source,
            recordings=tuple(self.recordings),
            traces=self.all_traces,
            covered=self.covered,
            repeated=self.repeated,
            situations=Situations(pairs=self.classified[2], triples=self.classified[3]),
            broken=tuple(self.broken),
        )


def count_shares(
    classes: Classes,
    specification: Specification,
    values: Mapping[str, Fraction],
    recordings: Iterable[Recording],
    source: str = "",
) -> Shares:
    """Count the classes in ``recordings``; ``specification`` is the set of the classes.

    ``values``: parameters in SI units. Only cars count, and traces of an earlier recording are left out.
    Raises ``InputError``.
    """
    shares, counted = Shares(source=source), ShownMoments()
    settings = EvaluationSettings(
        specification.library,
        specification.options,
        values,
        sets=(specification.set_name,),
        min_danger=(values[MIN_DANGER],),
        scenarios=(4,),
        classes=("Car",),
        convention="clip",
    )
    known: dict[Rate, EvaluationQuestions] = {}
    for recording in recordings:
        if recording.rate not in known:
            known[recording.rate] = questions_of(classes, specification, settings, recording.rate)
        findings = without_repeats(evaluate_recording(recording, known[recording.rate]), counted)
        add_shares(shares, classes, findings)
        shares.left_out += left_out_notes(recording)
    shares.repeated = sum(repeat.what == "trace" for repeat in counted.repeats)
    return shares


def questions_of(
    classes: Classes, specification: Specification, settings: EvaluationSettings, rate: Rate
) -> EvaluationQuestions:
    """Return monitors of every scenario and class, in both roles and for the lanes of both vehicles."""
    pairs: dict[MonitorKey, Formula] = {}
    triples: dict[MonitorKey, Formula] = {}
    starts: list[Formula] = []

    def applied(name: str, vehicles: tuple[str, ...], lane: str = LANE) -> Formula:
        return apply_definition(specification, name, (*vehicles, lane), walk_of(specification)).formula

    for group in classes.plan.groups:
        names = [*map(name_of, group.rows), *(one.name for one in classes.of(group))]
        if group.vehicles == PAIR:
            for name in names:
                for role, vehicles in ROLES.items():
                    for lane in (LANE, OTHER_LANE):
                        pairs[MonitorKey(name, 0, role, lane)] = applied(name, vehicles, lane)
        elif group.vehicles == TRIPLE:
            for number in group.disturbances:
                starts.append(disturbance(specification, number, group.vehicles).formula)
            for name in names:
                triples[of_three(name, 0)] = applied(name, group.vehicles)
    start = {START: f.disjunction(*map(at_start, starts))}
    return replace(
        compile_questions(settings, rate),
        pairs=(_compiled(pairs, settings),) if pairs else (),
        triple_start=_compiled(start, settings) if triples else None,
        triples=(_compiled(triples, settings),) if triples else (),
    )


def _compiled(formulas: Mapping[K, Formula], settings: EvaluationSettings) -> Monitor[K]:
    valued = all_with_values(formulas.values(), settings.values)
    return compile(dict(zip(formulas, valued, strict=True)))


def add_shares(shares: Shares, classes: Classes, findings: Findings) -> None:
    """Count one recording, and compare its classes with its scenarios."""
    scenarios: dict[Situation, set[int]] = defaultdict(set)
    names_of: dict[Situation, set[str]] = defaultdict(set)
    where: dict[Situation, tuple[int, int]] = {}
    for match in findings.matches:
        situation = (findings.recording, match.sv, match.pov, match.pov2, match.lane)
        where[situation] = match.pair
        number = number_in(match.set_name)
        if number is None:
            names_of[situation].add(match.set_name)
        else:
            scenarios[situation].add(number)
    by_name = {one.name: one for one in classes.all()}
    shares.recordings.append(findings.recording)
    shares.all_traces += len(findings.traces)
    shares.covered += len(set(where.values()))
    shown = dict.fromkeys((name, where[s]) for s, names in names_of.items() for name in sorted(names))
    shares.traces.update(name for name, _ in shown)
    for situation in sorted(where, key=str):
        names = names_of.get(situation, set())
        shares.situations.update(names)
        shares.classified[3 if situation[3] is not None else 2] += 1
        difference = _difference(names, scenarios.get(situation, set()), by_name)
        if difference:
            shares.broken.append(f"{_say(situation)}: {difference}")


def _difference(names: set[str], scenarios: set[int], classes: Mapping[str, Class]) -> str:
    """Return how the classes and scenarios of a situation contradict the proofs; empty if they do not."""
    if len(names) != 1:
        return f"scenarios {sorted(scenarios)} and {len(names)} classes {', '.join(sorted(names))}"
    (name,) = names
    if set(classes[name].scenarios) != scenarios:
        return f"scenarios {sorted(scenarios)} in {name}"
    return ""


def _say(situation: Situation) -> str:
    recording, sv, pov, pov2, lane = situation
    third = "" if pov2 is None else f", POV2 {pov2}"
    return f"recording {recording}, SV {sv}, POV {pov}{third}, lane {lane or 'none'}"
