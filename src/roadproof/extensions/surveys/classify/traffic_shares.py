"""How often each class occurs in recordings, and whether the classes are a partition there too.

A situation is a disturbance trace (semantics §7), vehicles of it in their roles, and a lane: that of either
vehicle of the pair at the start of the trace, for three vehicles that of SV. Traces are read to their end
and no further (``clip``): what does not happen on them does not happen.
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
    MonitorKey,
    Questions,
    Settings,
    ask,
    of_three,
)
from roadproof.extensions.traffic.evaluate.totals import Counts, without_repeats
from roadproof.extensions.traffic.evaluate.traces import OTHER_LANE
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.reliable import losses_of
from roadproof.library.elaborate import apply_definition, walk_of
from roadproof.library.scenarios import LANE, MIN_DANGER, PAIR, TRIPLE, disturbance, name_of, number_in
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
    def told(self) -> SharesData:
        """What answers say of them."""
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

    ``values``: parameters in SI units. Cars are looked at; what an earlier recording has shown is left out.
    Raises ``InputError``.
    """
    shares, counted = Shares(source=source), Counts()
    settings = Settings(
        specification.library,
        specification.options,
        values,
        sets=(specification.set_name,),
        min_danger=(values[MIN_DANGER],),
        scenarios=(4,),
        classes=("Car",),
        convention="clip",
    )
    known: dict[Rate, Questions] = {}
    for recording in recordings:
        if recording.rate not in known:
            known[recording.rate] = questions_of(classes, specification, settings, recording.rate)
        found = without_repeats(evaluate_recording(recording, known[recording.rate]), counted)
        add_shares(shares, classes, found)
        shares.left_out += losses_of(recording)
    shares.repeated = sum(repeat.what == "trace" for repeat in counted.repeats)
    return shares


def questions_of(classes: Classes, specification: Specification, settings: Settings, rate: Rate) -> Questions:
    """Every scenario and class, asked in both roles and for the lanes of both vehicles."""
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
    begun = {START: f.disjunction(*map(at_start, starts))}
    return replace(
        ask(settings, rate),
        pairs=(_compiled(pairs, settings),) if pairs else (),
        triple_start=_compiled(begun, settings) if triples else None,
        triples=(_compiled(triples, settings),) if triples else (),
    )


def _compiled(formulas: Mapping[K, Formula], settings: Settings) -> Monitor[K]:
    valued = all_with_values(formulas.values(), settings.values)
    return compile(dict(zip(formulas, valued, strict=True)))


def add_shares(shares: Shares, classes: Classes, findings: Findings) -> None:
    """Count one recording, and compare its classes with its scenarios."""
    scenarios: dict[Situation, set[int]] = defaultdict(set)
    found: dict[Situation, set[str]] = defaultdict(set)
    where: dict[Situation, tuple[int, int]] = {}
    for match in findings.matches:
        situation = (findings.recording, match.sv, match.pov, match.pov2, match.lane)
        where[situation] = match.pair
        number = number_in(match.set_name)
        if number is None:
            found[situation].add(match.set_name)
        else:
            scenarios[situation].add(number)
    by_name = {one.name: one for one in classes.all()}
    shares.recordings.append(findings.recording)
    shares.all_traces += len(findings.traces)
    shares.covered += len(set(where.values()))
    shares.traces.update(name for name, _ in {(n, where[s]) for s, names in found.items() for n in names})
    for situation in sorted(where, key=str):
        names = found.get(situation, set())
        shares.situations.update(names)
        shares.classified[3 if situation[3] is not None else 2] += 1
        told = _difference(names, scenarios.get(situation, set()), by_name)
        if told:
            shares.broken.append(f"{_say(situation)}: {told}")


def _difference(names: set[str], scenarios: set[int], classes: Mapping[str, Class]) -> str:
    """How classes and scenarios of one situation differ from what is proved; empty where they do not."""
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
