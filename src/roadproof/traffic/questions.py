"""What is asked of recorded traffic (semantics §7): formulas compiled once, for all recordings.

The vehicles of a pair are SV and POV in the order of the pair; a scenario is asked for both role
assignments, so half of the formulas have the names swapped. L is the lane of the pair's first
vehicle at the start of the trace, L1 that of the second.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.errors import UsageError
from roadproof.logic.formula import Formula, disjunction
from roadproof.logic.fragment import horizon
from roadproof.logic.rewrite import with_values, without_names
from roadproof.monitor.answers import Convention
from roadproof.monitor.batch import steps_of
from roadproof.monitor.compiled import Monitor, compile
from roadproof.spec.bind import default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Library, Specification, bundled_library
from roadproof.traffic.pairs import Reach, Sight
from roadproof.traffic.recording import ZONES

Role: TypeAlias = Literal["first", "second"]
"""Which vehicle of a pair is SV."""

PAIR = ("SV", "POV")
TRIPLE = ("SV", "POV1", "POV2")
COMPARISON = ("cutIn_ttc", "cutIn_thw", "cutIn_free", "decel_ttc", "decel_thw", "decel_free")
"""Detectors of earlier works, which the paper's comparison table counts."""
THREE_CARS = (2, 10, 18)
POV_LANE = (7, 15, 23)


@dataclass(frozen=True)
class Settings:
    """How traffic is evaluated. ``values`` gives every parameter but minDanger, in SI units.

    ``detectors`` are definitions of (SV, POV, L) that are asked for beside the scenarios, such as
    COMPARISON; they look at all common frames of a pair, and at every lane.
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

    def __post_init__(self) -> None:
        for name in ("sets", "min_danger", "scenarios", "classes"):
            values = getattr(self, name)
            if not values or len(set(values)) != len(values):
                raise UsageError(f"evaluate: {name}={values} must name at least one, each once")
        if not set(self.scenarios) <= set(range(1, 25)):
            raise UsageError(f"evaluate: scenarios={self.scenarios} must lie between 1 and 24")
        if min(self.min_danger) < 0:
            raise UsageError("evaluate: minDanger must not be negative")


def default_settings(library: Library | None = None) -> Settings:
    """The paper's experiment: three sets, minSafe 0.6, minDanger 0 and 0.6, cars only."""
    chosen = library or bundled_library()
    return Settings(chosen, {}, default_values(chosen))


@dataclass(frozen=True)
class Condition:
    """What danger is cut by: an rssViolation, initSafe, or danger under the ``min_danger``-th minDanger.

    ``start``: what every scenario of three cars needs at its start.
    """

    what: Literal["violation", "safe", "danger", "start"]
    min_danger: int | None = None

    def __str__(self) -> str:
        return self.what if self.min_danger is None else f"{self.what} {self.min_danger}"


@dataclass(frozen=True)
class Asked:
    """Scenario ``number`` of a set, of the lane called ``lane``; in a pair, ``sv`` says who is SV."""

    set_name: str
    number: int
    sv: Role
    lane: str

    def __str__(self) -> str:
        return f"{self.set_name}/{self.number}/{self.sv}"


@dataclass(frozen=True)
class Sought:
    """A detector asked of a pair of which ``sv`` is SV."""

    detector: str
    sv: Role

    def __str__(self) -> str:
        return f"{self.detector}/{self.sv}"


VIOLATION, SAFE, START = Condition("violation"), Condition("safe"), Condition("start")


@dataclass(frozen=True)
class Questions:
    """Monitors for each stage of the evaluation, and the lane predicates that the data must give.

    ``safe_steps`` and ``danger_steps`` are how far initSafe and each danger look ahead. ``pairs`` and
    ``triples`` hold one monitor a minDanger. ``reach`` is None where the specification's rssViolation is
    not the library's, so that no pair may be left out; ``sight`` is its like for ``detectors``.
    """

    settings: Settings
    rate: int
    danger: Monitor[Condition]
    safe_steps: int
    danger_steps: tuple[int, ...]
    pairs: tuple[Monitor[Asked], ...]
    triple_start: Monitor[Condition] | None
    triples: tuple[Monitor[Asked], ...]
    lane_atoms: Mapping[Formula, "LaneAtom"]
    reach: Reach | None
    detectors: Monitor[Sought] | None
    sight: Sight | None


@dataclass(frozen=True)
class LaneAtom:
    """A state formula that the data layer decides: a vehicle in a lane, beside it, or in a zone."""

    kind: Literal["at", "beside", "zone"]
    vehicle: str
    of: str


def ask(settings: Settings, rate: int) -> Questions:
    """Compile the questions for recordings of ``rate`` samples a second.

    Raises ``InputError`` where a set or option does not exist or a duration is no multiple of the
    time step.
    """
    dt = Fraction(1, rate)
    first = settings.library.select(settings.sets[0], settings.options)
    safe = _state(settings, first, "initSafe(SV, POV)")
    dangers = {k: _state(settings, first, "danger(SV, POV)", m) for k, m in enumerate(settings.min_danger)}
    for name in settings.sets[1:]:
        _check_same_danger(settings, first, first.in_set(name))
    danger = compile(
        {VIOLATION: _state(settings, first, "rssViolation(SV, POV)"), SAFE: safe}
        | {Condition("danger", k): formula for k, formula in dangers.items()}
    )
    two = [i for i in settings.scenarios if i not in THREE_CARS]
    three = [i for i in settings.scenarios if i in THREE_CARS]
    return Questions(
        settings=settings,
        rate=rate,
        danger=danger,
        safe_steps=_steps(safe, dt, "initSafe"),
        danger_steps=tuple(_steps(formula, dt, "danger") for formula in dangers.values()),
        pairs=tuple(compile(_of_pairs(settings, two, m)) for m in settings.min_danger) if two else (),
        triple_start=_start_of_triples(settings, three) if three else None,
        triples=tuple(compile(_of_triples(settings, three, m)) for m in settings.min_danger) if three else (),
        lane_atoms=dict(lane_atoms(first)),
        reach=_reach(settings, first),
        detectors=compile(_of_detectors(settings, first)) if settings.detectors else None,
        sight=_sight(settings, first),
    )


def _state(settings: Settings, spec: Specification, text: str, min_danger: Fraction = Fraction(0)) -> Formula:
    return with_values(read_claim(spec, text).formula, {**settings.values, "minDanger": min_danger})


def _of_pairs(settings: Settings, numbers: Iterable[int], min_danger: Fraction) -> dict[Asked, Formula]:
    """Scenarios of two cars in both roles."""
    formulas = {}
    roles: tuple[tuple[Role, str, str, str, str], ...] = (
        ("first", "SV", "POV", "L", "L1"),
        ("second", "POV", "SV", "L1", "L"),
    )
    for set_name in settings.sets:
        spec = settings.library.select(set_name, settings.options)
        for number in numbers:
            for role, sv, pov, own, other in roles:
                lane = other if number in POV_LANE else own
                asked = Asked(set_name, number, role, lane)
                formulas[asked] = _state(
                    settings, spec, f"scenario_{number}({sv}, {pov}, {lane})", min_danger
                )
    return formulas


def _of_triples(settings: Settings, numbers: Iterable[int], min_danger: Fraction) -> dict[Asked, Formula]:
    formulas = {}
    for set_name in settings.sets:
        spec = settings.library.select(set_name, settings.options)
        for number in numbers:
            text = f"scenario_{number}({', '.join(TRIPLE)}, L)"
            formulas[of_three(set_name, number)] = _state(settings, spec, text, min_danger)
    return formulas


def of_three(set_name: str, number: int) -> Asked:
    """The question for a scenario of three cars."""
    return Asked(set_name, number, "first", "L")


def _start_of_triples(settings: Settings, numbers: Iterable[int]) -> Monitor[Condition]:
    """initialCondition is a conjunct of the template (paper, eq. disturbFormat), so no match is without."""
    conditions = []
    for set_name in settings.sets:
        spec = settings.library.select(set_name, settings.options)
        for number in numbers:
            text = f"initialCondition_{number}({', '.join(TRIPLE)}, L)"
            conditions.append(_state(settings, spec, text))
    return compile({START: disjunction(*conditions)})


def _steps(formula: Formula, dt: Fraction, name: str) -> int:
    seconds = horizon(formula)
    if seconds is None:
        raise UsageError(
            f"evaluate: {name} must look ahead for a bounded time, or no trace could be cut after it"
        )
    return steps_of(seconds, dt)


def _check_same_danger(settings: Settings, one: Specification, other: Specification) -> None:
    for text in ("initSafe(SV, POV)", "danger(SV, POV)"):
        if without_names(_state(settings, one, text)) != without_names(_state(settings, other, text)):
            raise UsageError(
                f"evaluate: {text} differs between the sets {one.set_name} and {other.set_name}; traces are "
                "cut once for all sets, so evaluate these sets one at a time"
            )


def lane_atoms(spec: Specification) -> Iterable[tuple[Formula, LaneAtom]]:
    """The lane predicates of a specification, for the vehicles of pairs and triples and the lanes L, L1."""
    predicates = dict(zip(ZONES, ("onMainRoad", "inMergeZone", "inDepartZone"), strict=True))
    for vehicle in ("SV", "POV", "POV1", "POV2"):
        for lane in ("L", "L1"):
            at = read_claim(spec, f"atLane({vehicle}, {lane})").formula
            beside = read_claim(spec, f"some M in adjacentLanes({lane}): atLane({vehicle}, M)").formula
            yield without_names(at), LaneAtom("at", vehicle, lane)
            yield without_names(beside), LaneAtom("beside", vehicle, lane)
        for zone, predicate in predicates.items():
            yield (
                without_names(read_claim(spec, f"{predicate}({vehicle})").formula),
                LaneAtom("zone", vehicle, zone),
            )


def _of_detectors(settings: Settings, spec: Specification) -> dict[Sought, Formula]:
    roles: dict[Role, str] = {"first": "SV, POV", "second": "POV, SV"}
    return {
        Sought(name, role): _state(settings, spec, f"{name}({vehicles}, L)")
        for name in settings.detectors
        for role, vehicles in roles.items()
    }


def _sight(settings: Settings, spec: Specification) -> Sight | None:
    """The constants of the detectors' pre-filter, where all are the bundled ones."""
    if not set(settings.detectors) <= set(COMPARISON):
        return None
    if not all(_is_bundled(settings, spec, f"{name}(SV, POV, L)") for name in settings.detectors):
        return None
    return Sight(*(float(settings.values[x]) for x in ("ttcLimit", "thwLimit", "farthest")))


def _is_bundled(settings: Settings, spec: Specification, text: str) -> bool:
    """Whether ``text`` means what it does in the bundled library under the same options."""
    options = {k: v for k, v in settings.options.items() if k in bundled_library().options}
    bundled = bundled_library().select("base", options)
    return without_names(read_claim(bundled, text).formula) == without_names(read_claim(spec, text).formula)


def _reach(settings: Settings, spec: Specification) -> Reach | None:
    """The pre-filter's constants, where rssViolation is the bundled one, whose bound is proved."""
    if not _is_bundled(settings, spec, "rssViolation(SV, POV)"):
        return None
    names = ("rho", "a_max", "b_min", "b_max", "a_max_lat", "b_min_lat")
    return Reach(**{name: float(settings.values[name]) for name in names})
