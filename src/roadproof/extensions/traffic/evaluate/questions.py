"""The formulas for recorded traffic (semantics §7), compiled once for all recordings.

The vehicles of a pair are SV and POV in the order of the pair; a scenario is asked for both role
assignments, so half of the formulas have the names swapped. L is the lane of the pair's first
vehicle at the start of the trace, L1 that of the second.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.errors import InputError, UsageError
from roadproof.extensions.drivers.driving import require
from roadproof.extensions.drivers.models import check_drivers
from roadproof.extensions.traffic import scenario_parts
from roadproof.extensions.traffic.evaluate.courses import ManoeuvreTest, manoeuvre_tests
from roadproof.extensions.traffic.evaluate.horizon import horizon
from roadproof.extensions.traffic.evaluate.sectors import Sector, is_possible, sectors_of
from roadproof.extensions.traffic.evaluate.traces import OTHER_LANE, LaneAtom, lane_atoms
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.pairs import DetectionRange, RssParameters
from roadproof.extensions.traffic.formats.recording import ZONES
from roadproof.library import scenarios as scenario_library
from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition
from roadproof.library.elaboration import Elaborator
from roadproof.library.loading import bundled_library
from roadproof.library.specification import Library, Query, Specification, unknown_name
from roadproof.logic.formula import Formula, disjunction, hash_cons, is_state
from roadproof.logic.rewrite import all_with_values, with_values, without_names
from roadproof.semantics.sampled.answers import Convention, Key
from roadproof.semantics.sampled.batch import steps_of
from roadproof.semantics.sampled.compiled import Monitor, compile

Role: TypeAlias = Literal["first", "second"]
"""Which vehicle of a pair is SV."""

ROLES: Mapping[Role, tuple[str, ...]] = {
    "first": scenario_library.PAIR,
    "second": scenario_library.PAIR[::-1],
}
"""The vehicles of a pair in the order of a scenario's arguments."""


@dataclass(frozen=True)
class EvaluationSettings:
    """The settings of an evaluation. ``values`` gives every parameter but minDanger, in SI units.

    ``detectors`` are definitions of (SV, POV, L) that are asked for beside the scenarios, such as
    COMPARISON; they look at all common frames of a pair, and at every lane. ``drivers`` are models that the
    matches are put to (``foretelling``), which need the definitions of ``driver.spec``.
    """

    library: Library
    options: Mapping[str, str]
    values: Mapping[str, Fraction]
    sets: tuple[str, ...] = ("base", "extA", "ext")
    min_danger: tuple[Fraction, ...] = (Fraction(0), Fraction(3, 5))
    scenarios: tuple[int, ...] = (1, 2, 3, 4, 5, 6, 7, 8)
    classes: tuple[str, ...] = ("Car",)
    convention: Convention = "truncated"
    detectors: tuple[str, ...] = ()
    drivers: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("sets", "min_danger", "scenarios", "classes"):
            values = getattr(self, name)
            if not values or len(set(values)) != len(values):
                raise UsageError(f"evaluate: {name}={values} must name at least one, each once")
        known = scenario_library.numbers_of(self.library.select(self.sets[0], self.options))
        for number in sorted(set(self.scenarios) - set(known)):
            message = unknown_name("scenario", str(number), map(str, known))
            raise UsageError(f"evaluate: scenarios={self.scenarios}: {message}")
        if min(self.min_danger) < 0:
            raise UsageError("evaluate: minDanger must not be negative")
        if self.drivers:
            check_drivers(self.drivers, self.scenarios)
            require(self.library.select(self.sets[0], self.options), self.values)


def default_settings(library: Library | None = None) -> EvaluationSettings:
    """The paper's experiment: three sets, minSafe 0.6, minDanger 0 and 0.6, cars only."""
    chosen = library or bundled_library()
    return EvaluationSettings(chosen, {}, default_values(chosen))


Condition: TypeAlias = Literal["violation", "safe", "start"]
"""What traces are cut by: an rssViolation, initSafe, and what every scenario of three cars starts with."""


@dataclass(frozen=True)
class DangerKey:
    """Danger under the ``min_danger``-th minDanger."""

    min_danger: int

    def __str__(self) -> str:
        return f"danger {self.min_danger}"


@dataclass(frozen=True)
class MonitorKey:
    """Scenario ``number`` of a set, of the lane called ``lane``; in a pair, ``sv`` says who is SV."""

    set_name: str
    number: int
    sv: Role
    lane: str

    def __str__(self) -> str:
        return f"{self.set_name}/{self.number}/{self.sv}"


@dataclass(frozen=True)
class DetectorKey:
    """A detector asked of a pair of which ``sv`` is SV."""

    detector: str
    sv: Role

    def __str__(self) -> str:
        return f"{self.detector}/{self.sv}"


VIOLATION: Condition = "violation"
SAFE: Condition = "safe"
START: Condition = "start"


@dataclass(frozen=True)
class EvaluationQuestions:
    """Monitors for each stage of the evaluation, and the lane predicates that the data must give.

    ``violation`` is asked of moments where it is a matter of one (``violation_is_state``), and ``danger`` of
    what comes out. ``sectors`` are those that can be met, with what is asked in each, and ``where`` says
    whether a pair is in one. ``safe_steps`` and ``danger_steps`` are how far initSafe and each danger look
    ahead. ``pairs`` and ``triples`` hold one monitor a minDanger. ``reach`` is None where the specification's
    rssViolation is not the library's, so that no pair may be left out; ``sight`` is its like for
    ``detectors``. ``courses``: what driver models are asked about matches.
    """

    settings: EvaluationSettings
    rate: Rate
    violation: Monitor[Condition]
    violation_is_state: bool
    danger: Monitor[Condition | DangerKey]
    safe_steps: int
    danger_steps: tuple[int, ...]
    sectors: tuple[Sector, ...]
    where: Monitor[Sector]
    pairs: tuple[Monitor[MonitorKey], ...]
    triple_start: Monitor[Condition] | None
    triples: tuple[Monitor[MonitorKey], ...]
    lane_atoms: Mapping[Formula, LaneAtom]
    reach: RssParameters | None
    detectors: Monitor[DetectorKey] | None
    sight: DetectionRange | None
    courses: tuple[ManoeuvreTest, ...] = ()


def compile_questions(
    settings: EvaluationSettings, rate: Rate, zones: Iterable[str] = ZONES
) -> EvaluationQuestions:
    """Compile the questions for recordings of ``rate`` samples a second, on roads of no other ``zones``.

    Scenarios that cannot begin on such a road are not asked. Raises ``InputError`` where a set or option does
    not exist, a duration is no multiple of the time step, or a scenario is none of two or three cars.
    """
    dt = 1 / Fraction(rate)
    sets = {name: settings.library.select(name, settings.options) for name in settings.sets}
    first = sets[settings.sets[0]]
    near, starts_safe, endangers = (
        meaning(first, *scenario_library.PAIR)
        for meaning in (scenario_parts.violation, scenario_parts.safe, scenario_library.danger)
    )
    for name in settings.sets[1:]:
        _check_same_danger(settings, (starts_safe, endangers), first, sets[name])
    safely = _with_values(settings, starts_safe.formula)
    dangers: dict[Condition | DangerKey, Formula] = {
        DangerKey(k): _with_values(settings, endangers.formula, m) for k, m in enumerate(settings.min_danger)
    }
    there = {*zones}
    sectors = tuple(x for x in sectors_of(first, settings.scenarios) if is_possible(x, there))
    two, three = _by_vehicles(first, (number for each in sectors for number in each.scenarios))
    detectors = _of_detectors(settings, first)
    violated = _with_values(settings, near.formula)
    shared: dict[Formula, Formula] = {}
    atoms = dict(lane_atoms(first))
    return EvaluationQuestions(
        settings=settings,
        rate=rate,
        violation=compile({VIOLATION: violated}, shared),
        violation_is_state=is_state(violated),
        danger=compile({VIOLATION: violated, SAFE: safely, **dangers}, shared),
        safe_steps=_steps(safely, dt, starts_safe),
        danger_steps=tuple(_steps(formula, dt, endangers) for formula in dangers.values()),
        sectors=sectors,
        where=compile(_all_with_values(settings, {x: x.where for x in sectors if x.where is not None})),
        pairs=_monitors(settings, _of_pairs(sets.values(), two), shared),
        triple_start=_start_of_triples(settings, sets.values(), three) if three else None,
        triples=_monitors(settings, _of_triples(sets.values(), three), shared),
        lane_atoms=dict(zip(hash_cons(atoms, without_names, shared), atoms.values(), strict=True)),
        reach=_reach(settings, near),
        detectors=compile(_all_with_values(settings, detectors)) if detectors else None,
        sight=_sight(settings, detectors),
        courses=tuple(
            manoeuvre_tests(tuple(sets.values()), settings.values, settings.drivers, (*two, *three))
        ),
    )


def _with_values(
    settings: EvaluationSettings, formula: Formula, min_danger: Fraction = Fraction(0)
) -> Formula:
    return with_values(formula, {**settings.values, scenario_library.MIN_DANGER: min_danger})


def _all_with_values(
    settings: EvaluationSettings, queries: Mapping[Key, Query], min_danger: Fraction = Fraction(0)
) -> dict[Key, Formula]:
    values = {**settings.values, scenario_library.MIN_DANGER: min_danger}
    return dict(zip(queries, all_with_values((x.formula for x in queries.values()), values), strict=True))


def _monitors(
    settings: EvaluationSettings, queries: Mapping[MonitorKey, Query], shared: dict[Formula, Formula]
) -> tuple[Monitor[MonitorKey], ...]:
    """One for each minDanger; none where nothing is asked. ``shared``: see ``compile``."""
    each = (_all_with_values(settings, queries, m) for m in settings.min_danger if queries)
    return tuple(compile(formulas, shared) for formulas in each)


def askable(spec: Specification) -> tuple[int, ...]:
    """The scenarios that can be asked of recordings: of two cars, or of three with L the lane of SV."""
    return tuple(
        n
        for n in scenario_library.numbers_of(spec)
        if _reason_not(spec, scenario_library.Scenario(n, spec.set_name)) is None
    )


def _reason_not(spec: Specification, scenario: scenario_library.Scenario) -> str | None:
    """Return why a scenario cannot be asked of recordings."""
    vehicles, name = scenario_library.vehicles_of(spec, scenario), scenario_library.name_of(scenario.number)
    if len(vehicles) not in (len(scenario_library.PAIR), len(scenario_library.TRIPLE)):
        return (
            f"{name} is about {len(vehicles)} vehicles, but those of recordings are looked at in pairs and "
            "triples"
        )
    owner = scenario_parts.lane_owner(spec, scenario)
    if len(vehicles) == len(scenario_library.TRIPLE) and owner != scenario_library.SUBJECT:
        lane = f"in {name} {scenario_library.LANE} is the lane of {owner}"
        return f"{lane}, but of three vehicles that of {scenario_library.SUBJECT} is looked at"
    return None


def _by_vehicles(spec: Specification, numbers: Iterable[int]) -> tuple[list[int], list[int]]:
    """The scenarios of two cars and those of three. Raises ``InputError`` for others."""
    of: dict[int, list[int]] = {len(scenario_library.PAIR): [], len(scenario_library.TRIPLE): []}
    for number in numbers:
        scenario = scenario_library.Scenario(number, spec.set_name)
        reason = _reason_not(spec, scenario)
        if reason is not None:
            raise InputError(f"evaluate: {reason}: leave it out")
        of[len(scenario_library.vehicles_of(spec, scenario))].append(number)
    return of[len(scenario_library.PAIR)], of[len(scenario_library.TRIPLE)]


def _of_pairs(sets: Iterable[Specification], numbers: Iterable[int]) -> dict[MonitorKey, Query]:
    """Scenarios of two cars in both roles."""
    queries: dict[MonitorKey, Query] = {}
    lanes = dict(zip(scenario_library.PAIR, (scenario_library.LANE, OTHER_LANE), strict=True))
    for spec in sets:
        walk = Elaborator(spec)
        for number in numbers:
            scenario = scenario_library.Scenario(number, spec.set_name)
            place = 0 if scenario_parts.lane_owner(spec, scenario) == scenario_library.SUBJECT else 1
            for role, vehicles in ROLES.items():
                lane = lanes[vehicles[place]]
                key = MonitorKey(spec.set_name, number, role, lane)
                queries[key] = scenario_library.apply_scenario(spec, scenario, vehicles, lane, walk)
    return queries


def _of_triples(sets: Iterable[Specification], numbers: Iterable[int]) -> dict[MonitorKey, Query]:
    return {
        of_three(spec.set_name, number): scenario_library.apply_scenario(
            spec, scenario_library.Scenario(number, spec.set_name), scenario_library.TRIPLE
        )
        for spec in sets
        for number in numbers
    }


def of_three(set_name: str, number: int) -> MonitorKey:
    """The question for a scenario of three cars."""
    return MonitorKey(set_name, number, "first", scenario_library.LANE)


def _start_of_triples(
    settings: EvaluationSettings, sets: Iterable[Specification], numbers: Iterable[int]
) -> Monitor[Condition]:
    """initialCondition is a conjunct of the template (paper, eq. disturbFormat), so no match is without."""
    starts = [
        scenario_parts.initial_condition(spec, number, scenario_library.TRIPLE).formula
        for spec in sets
        for number in numbers
    ]
    return compile({START: disjunction(*(_with_values(settings, start) for start in starts))})


def _steps(formula: Formula, dt: Fraction, query: Query) -> int:
    seconds = horizon(formula)
    if seconds is None:
        raise UsageError(
            f"evaluate: {query.text} must look ahead for a bounded time, or no trace could be cut after it"
        )
    return steps_of(seconds, dt)


def _check_same_danger(
    settings: EvaluationSettings, known: tuple[Query, Query], one: Specification, other: Specification
) -> None:
    meanings: tuple[Callable[[Specification, str, str], Query], ...] = (
        scenario_parts.safe,
        scenario_library.danger,
    )
    for query, meaning in zip(known, meanings, strict=True):
        theirs = meaning(other, *scenario_library.PAIR)
        if not _same(_with_values(settings, query.formula), _with_values(settings, theirs.formula)):
            raise UsageError(
                f"evaluate: {query.text} differs between the sets {one.set_name} and {other.set_name}; "
                "traces are cut once for all sets, so evaluate these sets one at a time"
            )


def _same(one: Formula, other: Formula) -> bool:
    return without_names(one) == without_names(other)


def _of_detectors(settings: EvaluationSettings, spec: Specification) -> dict[DetectorKey, Query]:
    return {
        DetectorKey(name, role): apply_definition(spec, name, (*vehicles, scenario_library.LANE))
        for name in settings.detectors
        for role, vehicles in ROLES.items()
    }


def _sight(settings: EvaluationSettings, queries: Mapping[DetectorKey, Query]) -> DetectionRange | None:
    """The constants of the detectors' pre-filter, where all are the bundled ones."""
    if not set(settings.detectors) <= set(scenario_parts.COMPARISON):
        return None
    bundled = _bundled(settings)
    for detector in settings.detectors:
        theirs = apply_definition(bundled, detector, (*scenario_library.PAIR, scenario_library.LANE))
        if not _same(queries[DetectorKey(detector, "first")].formula, theirs.formula):
            return None
    return DetectionRange(*(float(settings.values[x]) for x in ("ttcLimit", "thwLimit", "farthest")))


def _bundled(settings: EvaluationSettings) -> Specification:
    """The bundled library under the same options."""
    options = {k: v for k, v in settings.options.items() if k in bundled_library().options}
    return bundled_library().select(options=options)


def _reach(settings: EvaluationSettings, near: Query) -> RssParameters | None:
    """The pre-filter's constants, where rssViolation is the bundled one, whose bound is proved."""
    if not _same(near.formula, scenario_parts.violation(_bundled(settings), *scenario_library.PAIR).formula):
        return None
    return RssParameters(**{name: float(settings.values[name]) for name in scenario_parts.RSS_PARAMETERS})
