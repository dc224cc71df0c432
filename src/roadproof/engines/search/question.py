"""What is asked for, on which grid, with which vehicles, how to look for it, and what was found."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import field
from fractions import Fraction
from functools import cache, cached_property
from itertools import product
from math import ceil, prod

from roadproof.engines.encode.along import starting_range
from roadproof.engines.encode.build import Assumptions
from roadproof.engines.encode.motion import own_columns
from roadproof.engines.encode.unroll import Grid, common_step
from roadproof.engines.search.initial_conditions import Start
from roadproof.engines.search.limits import Limits
from roadproof.errors import UsageError
from roadproof.evidence.claim import Engine, Exists, Objective
from roadproof.library.bind import bind, values_with
from roadproof.library.specification import Library, Query
from roadproof.logic import formula as f
from roadproof.logic import rewrite
from roadproof.logic import terms as t
from roadproof.logic.custom_names import code_of, told_range, vehicles_with_kind
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.initial_conditions import conjuncts
from roadproof.runtime.budget import Effort
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.signals import AbstractSignals
from roadproof.world.bends import on_bends
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, load_vehicle, names_of
from roadproof.world.road import Road
from roadproof.world.signals import KINDS, Kind
from roadproof.world.vehicle import Range, Vehicle, with_limits

MOST_ASSIGNMENTS = 1024  # of lanes of a road to the lanes of a formula


def usual_model(formula: Formula, vehicle: str) -> Vehicle:
    """The shipped model of the first kind that is not excluded by a part of the conjunction ``formula``."""
    asked = [part for part in conjuncts(formula) if _is_about_kind(part, vehicle)]
    kinds = (kind for kind in KINDS if kind in names_of("vehicles"))
    return load_vehicle(next((k for k in kinds if all(_holds(x, vehicle, k) for x in asked)), KINDS[0]))


def refuse_unknown(formula: Formula, vehicle: str, model: Vehicle) -> None:
    """Raise ``UsageError`` where a formula speaks of a kind that the model does not tell."""
    if model.kind is None and vehicle in vehicles_with_kind(formula):
        raise UsageError(
            f"vehicle {vehicle}={model.name}: the formula mentions its kind, and the model does not say it: "
            f'write kind = "{KINDS[1]}" in its file (or {", ".join(x for x in KINDS if x != KINDS[1])})'
        )


def _is_about_kind(part: Formula, vehicle: str) -> bool:
    """Whether ``part`` says something of the kind of ``vehicle``, and of nothing else."""
    about = (f.Truth, f.Compare, f.Not, f.And, f.Or, f.Application)
    if not all(isinstance(x, about) for x in f.subformulas(part)):
        return False
    leaves = [x for x in rewrite.leaves_of(part) if not isinstance(x, t.Number)]
    return bool(leaves) and all(x == t.Size("kind", vehicle) for x in leaves)


def _holds(part: Formula, vehicle: str, kind: Kind) -> bool:
    return judge(part, AbstractSignals({}, {t.Size("kind", vehicle): Fraction(code_of(kind))})).holds


COARSEST = Fraction(3, 5)
MOST_STEPS = 400


def make_grid(horizon: Fraction, dt: Fraction) -> Grid:
    """Raises ``UsageError`` unless the horizon is a sensible multiple of dt."""
    if dt <= 0 or horizon <= 0:
        raise UsageError(f"horizon={horizon} s and dt={dt} s must be greater than 0")
    steps = horizon / dt
    if steps.denominator != 1:
        raise UsageError(
            f"horizon={horizon} s is no multiple of dt={dt} s: choose a horizon "
            f"such as {dt * (int(steps) + 1)} s, or another dt"
        )
    if steps > MOST_STEPS:
        raise UsageError(
            f"horizon={horizon} s with dt={dt} s is {steps} steps; at most {MOST_STEPS} are allowed"
        )
    return Grid(dt, int(steps))


def fitting_grid(horizon: Fraction, formula: Formula, values: Mapping[str, Fraction]) -> Grid:
    """The coarsest grid, of at most 3/5 s, of whose step all durations and the horizon are multiples.

    Where only the horizon is in the way, it grows to a multiple. Raises ``UsageError`` where the grid
    would have too many steps.
    """
    step = Fraction(0)
    found = durations(formula, values)
    for duration in found:
        step = common_step(step, duration)
    dt = coarsest(step)
    with_horizon = coarsest(common_step(step, horizon))
    if with_horizon < dt / 4:
        horizon, with_horizon = ceil(horizon / dt) * dt, dt
    if horizon / with_horizon > MOST_STEPS:
        raise UsageError(
            f"horizon={horizon} s has {horizon / with_horizon} steps of dt={with_horizon} s, and at most "
            f"{MOST_STEPS} are allowed. The formula's durations must be multiples of dt ({_some(found)}): "
            "choose a shorter horizon, or durations that are multiples of a longer time"
        )
    return make_grid(horizon, with_horizon)


def _some(found: Collection[Fraction]) -> str:
    """Some durations in seconds, the shortest first."""
    shown = [f"{x} s" for x in sorted(x for x in found if x)]
    return ", ".join(shown[:6]) + (", …" if len(shown) > 6 else "")


def coarsest(step: Fraction, most: Fraction = COARSEST) -> Fraction:
    """The greatest part of ``step``, one over a whole number, that is at most ``most``; of 0 it is that."""
    return step / ceil(step / most) if step else most


def durations(formula: Formula, values: Mapping[str, Fraction]) -> set[Fraction]:
    """The finite bounds of all intervals, in s, with parameters at ``values``."""
    bounds = (
        rewrite.bounds_of(interval) for interval in rewrite.intervals_of(rewrite.with_values(formula, values))
    )
    return {bound for pair in bounds for bound in pair if bound is not None}


@dataclass(frozen=True)
class Setting:
    """Where, with whom and for how long drives are looked for; a formula makes a ``SearchProblem`` of it.

    ``road`` None is the usual road of the formula; ``lanes`` are free lanes that stand for one lane.
    ``vehicles`` by name, "" for all others (where nothing is said a car, or of what kind the formula asks
    for), and ``limits`` other limits than theirs, such as ``{"POV": {"a_lon.min": -2}}``
    (``world.vehicle.with_limits``). ``values``: parameters with another value than the declared one (SI).
    ``horizon``, ``dt``: seconds; ``dt`` None is the coarsest
    that fits (``grid.fitting_grid``). ``reach``: how far apart
    vehicles may start (m). ``collisions``: boxes may overlap. ``natural``: whether natural drives are tried
    first.
    """

    road: Road | None = None
    lanes: Mapping[str, str] = field(default_factory=dict)
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)
    limits: Mapping[str, Mapping[str, Fraction]] = field(default_factory=dict)
    values: Mapping[str, Fraction] = field(default_factory=dict)
    horizon: Fraction = Fraction(6)
    dt: Fraction | None = None
    reach: Fraction = Fraction(80)
    collisions: bool = False
    natural: bool = True


@dataclass(frozen=True)
class SearchProblem:
    """For which drive does ``query`` hold on ``road``?

    ``lanes`` are the assignments of lanes to be tried, in order. With a ``start`` a search is for drives that
    begin so only, and finds nothing out about others.
    """

    query: Query
    road: Road
    vehicles: Mapping[str, Vehicle]
    values: Mapping[str, Fraction]
    lanes: tuple[Mapping[str, str], ...]
    grid: Grid
    assumptions: Assumptions = field(default_factory=Assumptions)
    start: Start | None = None

    def asked(self, lanes: Mapping[str, str]) -> Formula:
        """What is asked of an engine: without the parts in place of which the start is."""
        formula = self.bound(lanes)
        return formula if self.start is None else self.start.without(formula)

    def bound(self, lanes: Mapping[str, str]) -> Formula:
        """The formula under one assignment of lanes."""
        return bind(self.query.formula, self.road, lanes, self.values)

    @cached_property
    def starts(self) -> Range | None:
        """Where fronts may be at time 0; None where every place along the road is as good as another."""
        formulas = [self.bound(lanes) for lanes in self.lanes]
        return starting_range(formulas, self.road, self.vehicles, self.grid, self.assumptions.reach)

    def limits(self, shown: Iterable[str] = ()) -> Limits:
        """Within what a NONE-WITHIN says that there is none; ``shown``: how that was shown."""
        options = {name: {lanes[name] for lanes in self.lanes} for name in self.query.lanes}
        spoken = rewrite.parameters_of(self.query.formula)
        return Limits(
            self.road.name,
            self.grid,
            {name: vehicle.name for name, vehicle in self.vehicles.items()},
            {n: next(iter(found)) for n, found in options.items() if len(found) < len(self.road.lanes)},
            {name: value for name, value in self.values.items() if name in spoken},
            self.assumptions.reach,
            self.starts,
            self.assumptions.collisions,
            tuple(sorted(set(shown))),
            self._own_ranges(),
            "j_lon" in rewrite.signals_of([self.query.formula]),
        )

    def _own_ranges(self) -> dict[str, str]:
        """Between which values own signals are looked for, whatever lanes are chosen."""
        found: dict[t.Own, list[Range]] = {}
        for lanes in self.lanes:
            for own in own_columns(self.bound(lanes)):
                found.setdefault(own.signal, []).append(own.range)
        return {
            signal.told: "false or true"
            if signal.truth
            else told_range(max(x for x, _ in ranges), min(x for _, x in ranges), signal.dimension)
            for signal, ranges in found.items()
        }


@dataclass(frozen=True)
class SearchOptions:
    """How to search: engine, solver, objective, work for one drive, finer grids to try.

    ``explain``: whether to show that there is none where none was found.
    """

    objective: Objective = "smooth"
    engine: Engine = "milp"
    solver: str = "highs"
    effort: Effort = field(default_factory=Effort)
    refinements: int = 2
    explain: bool = True


def exists(setting: Setting, options: SearchOptions) -> Exists:
    """Return how drives are asked for: every field of both but the values of parameters and the effort.

    A field that ``Exists`` lacks is an error, so none can be left out of the digest of a claim.
    """
    given = {**vars(setting), **vars(options)}
    return Exists(**{name: value for name, value in given.items() if name not in ("values", "effort")})


@dataclass(frozen=True)
class FoundDrive:
    """A judged drive, with the lanes it was judged under and the assumptions it keeps."""

    drive: Drive
    lanes: Mapping[str, str]
    formula: Formula
    grid: Grid
    assumptions: Assumptions


def pose(library: Library, query: Query, setting: Setting) -> SearchProblem:
    """The question with road, vehicles and grid in place. Raises ``UsageError``, ``InputError``."""
    road = setting.road or usual_road(query.formula)
    for name in (*setting.vehicles, *setting.limits):
        if name and name not in query.vehicles:
            known = ", ".join(query.vehicles)
            raise UsageError(f"vehicle {name}: the formula mentions {known or 'no vehicle'}")
    if not query.vehicles:
        raise UsageError("the formula mentions no vehicle, so drives cannot decide it")
    models = {
        name: setting.vehicles.get(name) or setting.vehicles.get("") or usual_model(query.formula, name)
        for name in query.vehicles
    }
    for name, model in models.items():
        refuse_unknown(query.formula, name, model)
    limited = {name: with_limits(model, setting.limits.get(name, {})) for name, model in models.items()}
    vehicles = {name: on_bends(model, road.line) for name, model in limited.items()}
    values = values_with(library, setting.values)
    lanes = assignments(query, road, setting.lanes)
    assumptions = Assumptions(reach=setting.reach, collisions=setting.collisions)
    assumptions = assumptions if setting.natural else assumptions.plain()
    if setting.dt is None:
        grid = fitting_grid(setting.horizon, query.formula, values)
    else:
        grid = make_grid(setting.horizon, setting.dt)
    return SearchProblem(query, road, vehicles, values, lanes, grid, assumptions)


def assignments(query: Query, road: Road, chosen: Mapping[str, str]) -> tuple[dict[str, str], ...]:
    """Every way to give the free lanes of ``query`` lanes of ``road`` that agrees with ``chosen``.

    Raises ``UsageError`` for a lane that the road does not have or the query does not speak of, and for more
    ways than a search can try.
    """
    for name, lane in chosen.items():
        if lane not in road.lanes:
            raise UsageError(f"lane {name}={lane}: road '{road.name}' has the lanes {', '.join(road.lanes)}")
        if name not in query.lanes:
            known = ", ".join(query.lanes) or "no lane"
            raise UsageError(f"lane {name}={lane}: the formula mentions {known}")
    options = [[chosen[name]] if name in chosen else list(road.lanes) for name in query.lanes]
    ways = prod(map(len, options))
    if ways > MOST_ASSIGNMENTS:
        raise UsageError(
            f"the formula mentions {len(options)} lanes, which can be those of road '{road.name}' in "
            f"{ways:,} ways (limit {MOST_ASSIGNMENTS:,}): fix some, such as lane "
            f"{query.lanes[0]}={road.lanes[0]}"
        )
    return tuple(dict(zip(query.lanes, lanes, strict=True)) for lanes in product(*options))


def usual_road(formula: Formula) -> Road:
    """The reference road that has the zones which ``formula`` speaks of: merge, depart, else main-2."""
    zones = zones_of(formula)
    return _reference("merge" if "merge" in zones else "depart" if "depart" in zones else "main-2")


_reference = cache(load_road)


def zones_of(formula: Formula) -> frozenset[str]:
    """The zones that a formula speaks of."""
    quantified = (x for x in subformulas(formula) if isinstance(x, f.Some | f.Every))
    return frozenset(x.domain.of for x in quantified if x.domain.kind == "zone")
