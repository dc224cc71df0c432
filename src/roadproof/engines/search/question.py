"""Settings of a search and the problem that a formula makes of them: road, grid, vehicles, lanes."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import field
from fractions import Fraction
from functools import cached_property
from itertools import product
from math import ceil, prod

from roadproof.engines.encode.build import Assumptions
from roadproof.engines.encode.motion import custom_signal_ranges
from roadproof.engines.encode.shift_invariance import starting_range
from roadproof.engines.encode.unroll import Grid, common_step
from roadproof.engines.search.initial_conditions import Start
from roadproof.engines.search.limits import SearchLimits
from roadproof.engines.search.usual_road import usual_road
from roadproof.engines.setting import Setting
from roadproof.errors import UsageError
from roadproof.library.bind import bind, values_with
from roadproof.library.specification import Library, Query
from roadproof.logic import formula as f
from roadproof.logic import rewrite
from roadproof.logic import terms as t
from roadproof.logic.custom_names import code_of, range_text, vehicles_with_kind
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import top_level_conjuncts
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.signals import AbstractSignals
from roadproof.world.bends import on_bends
from roadproof.world.drive import Drive
from roadproof.world.models import load_vehicle, names_of
from roadproof.world.road import Road
from roadproof.world.signals import KINDS, Kind
from roadproof.world.vehicle import Range, Vehicle, with_limits

MOST_ASSIGNMENTS = 1024  # of lanes of a road to the lanes of a formula


def usual_model(formula: Formula, vehicle: str) -> Vehicle:
    """Return the shipped model of the first kind that no conjunct of ``formula`` excludes."""
    conditions = [part for part in top_level_conjuncts(formula) if _is_kind_condition(part, vehicle)]
    kinds = (kind for kind in KINDS if kind in names_of("vehicles"))
    return load_vehicle(next((k for k in kinds if all(_holds(x, vehicle, k) for x in conditions)), KINDS[0]))


def refuse_unknown(formula: Formula, vehicle: str, model: Vehicle) -> None:
    """Raise ``UsageError`` where a formula speaks of a kind that the model does not tell."""
    if model.kind is None and vehicle in vehicles_with_kind(formula):
        raise UsageError(
            f"vehicle {vehicle}={model.name}: the formula mentions its kind, and the model does not say it: "
            f'write kind = "{KINDS[1]}" in its file (or {", ".join(x for x in KINDS if x != KINDS[1])})'
        )


def _is_kind_condition(part: Formula, vehicle: str) -> bool:
    """Return whether ``part`` says something of the kind of ``vehicle``, and of nothing else."""
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
    """Return the grid. Raises ``UsageError`` unless the horizon is a sensible multiple of dt."""
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
    """Return the coarsest grid, of at most 3/5 s, whose step divides all durations and the horizon.

    If only the horizon is in the way, it grows to a multiple. Raises ``UsageError`` where the grid would have
    too many steps.
    """
    step = Fraction(0)
    lengths = durations(formula, values)
    for duration in lengths:
        step = common_step(step, duration)
    dt = coarsest(step)
    with_horizon = coarsest(common_step(step, horizon))
    if with_horizon < dt / 4:
        horizon, with_horizon = ceil(horizon / dt) * dt, dt
    if horizon / with_horizon > MOST_STEPS:
        raise UsageError(
            f"horizon={horizon} s has {horizon / with_horizon} steps of dt={with_horizon} s, and at most "
            f"{MOST_STEPS} are allowed. The formula's durations must be multiples of dt "
            f"({_listed(lengths)}): choose a shorter horizon, or durations that are multiples of a "
            "longer time"
        )
    return make_grid(horizon, with_horizon)


def _listed(lengths: Collection[Fraction]) -> str:
    """Return a list of durations in seconds, the shortest first, cut after six."""
    shown = [f"{x} s" for x in sorted(x for x in lengths if x)]
    return ", ".join(shown[:6]) + (", …" if len(shown) > 6 else "")


def coarsest(step: Fraction, most: Fraction = COARSEST) -> Fraction:
    """Return the greatest ``step / n``, n whole, that is at most ``most``; ``most`` where step is 0."""
    return step / ceil(step / most) if step else most


def durations(formula: Formula, values: Mapping[str, Fraction]) -> set[Fraction]:
    """Return the finite bounds of all intervals, in s, with parameters at ``values``."""
    bounds = (
        rewrite.bounds_of(interval) for interval in rewrite.intervals_of(rewrite.with_values(formula, values))
    )
    return {bound for pair in bounds for bound in pair if bound is not None}


@dataclass(frozen=True)
class SearchProblem:
    """The question for which drives ``query`` holds on ``road``.

    ``lanes``: assignments of lanes to try, in order. With a ``start`` the search covers only drives that
    begin so, and shows nothing about others.
    """

    query: Query
    road: Road
    vehicles: Mapping[str, Vehicle]
    values: Mapping[str, Fraction]
    lanes: tuple[Mapping[str, str], ...]
    grid: Grid
    assumptions: Assumptions = field(default_factory=Assumptions)
    start: Start | None = None

    def formula_for_engine(self, lanes: Mapping[str, str]) -> Formula:
        """Return the formula for an engine, without the parts that the start replaces."""
        formula = self.bound(lanes)
        return formula if self.start is None else self.start.without(formula)

    def bound(self, lanes: Mapping[str, str]) -> Formula:
        """Return the formula under one assignment of lanes."""
        return bind(self.query.formula, self.road, lanes, self.values)

    @cached_property
    def starts(self) -> Range | None:
        """The range of fronts at time 0; None where s = 0 stands for every place along the road."""
        formulas = [self.bound(lanes) for lanes in self.lanes]
        return starting_range(formulas, self.road, self.vehicles, self.grid, self.assumptions.reach)

    def limits(self, shown: Iterable[str] = ()) -> SearchLimits:
        """Return the limits of a NONE-WITHIN; ``shown``: how it was shown."""
        options = {name: {lanes[name] for lanes in self.lanes} for name in self.query.lanes}
        spoken = rewrite.parameters_of(self.query.formula)
        return SearchLimits(
            self.road.name,
            self.grid,
            {name: vehicle.name for name, vehicle in self.vehicles.items()},
            {n: next(iter(chosen)) for n, chosen in options.items() if len(chosen) < len(self.road.lanes)},
            {name: value for name, value in self.values.items() if name in spoken},
            self.assumptions.reach,
            self.starts,
            self.assumptions.collisions,
            tuple(sorted(set(shown))),
            self._own_ranges(),
            "j_lon" in rewrite.signals_of([self.query.formula]),
        )

    def _own_ranges(self) -> dict[str, str]:
        """Return the search ranges of custom signals over all assignments of lanes, as text."""
        ranges_of: dict[t.CustomSignal, list[Range]] = {}
        for lanes in self.lanes:
            for own in custom_signal_ranges(self.bound(lanes)):
                ranges_of.setdefault(own.signal, []).append(own.range)
        return {
            signal.text: "false or true"
            if signal.truth
            else range_text(max(x for x, _ in ranges), min(x for _, x in ranges), signal.dimension)
            for signal, ranges in ranges_of.items()
        }


@dataclass(frozen=True)
class FoundDrive:
    """A judged drive, with the lanes it was judged under and the assumptions it keeps."""

    drive: Drive
    lanes: Mapping[str, str]
    formula: Formula
    grid: Grid
    assumptions: Assumptions


def pose(library: Library, query: Query, setting: Setting) -> SearchProblem:
    """Return the problem with road, vehicles and grid. Raises ``UsageError``, ``InputError``."""
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
    assumptions = assumptions if setting.natural else assumptions.without_comfort()
    if setting.dt is None:
        grid = fitting_grid(setting.horizon, query.formula, values)
    else:
        grid = make_grid(setting.horizon, setting.dt)
    return SearchProblem(query, road, vehicles, values, lanes, grid, assumptions)


def assignments(query: Query, road: Road, chosen: Mapping[str, str]) -> tuple[dict[str, str], ...]:
    """Return all assignments of lanes of ``road`` to free lanes of ``query`` that agree with ``chosen``.

    Raises ``UsageError`` for a lane that the road lacks or the query does not mention, and for more
    assignments than a search can try.
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
