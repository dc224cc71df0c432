"""What is asked for, how to look for it, and what was found: plain data."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import Literal, TypeAlias

from roadproof.effort import Effort
from roadproof.encode.along import starting_range
from roadproof.encode.build import Manners
from roadproof.encode.unroll import Grid
from roadproof.errors import UsageError
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.rewrite import parameters_of
from roadproof.spec.bind import bind
from roadproof.spec.query import Query
from roadproof.witness.limits import Limits
from roadproof.world.drive import Drive
from roadproof.world.road import Road
from roadproof.world.vehicle import Range, Vehicle

Objective: TypeAlias = Literal["any", "smooth", "margin", "mild", "severe", "short"]
Engine: TypeAlias = Literal["milp", "smt"]
OBJECTIVES: tuple[Objective, ...] = ("any", "smooth", "margin", "mild", "severe", "short")
ENGINES: tuple[Engine, ...] = ("milp", "smt")


@dataclass(frozen=True)
class Question:
    """For which drive does ``query`` hold on ``road``?

    ``lanes`` are the assignments of lanes to be tried, in order.
    """

    query: Query
    road: Road
    vehicles: Mapping[str, Vehicle]
    values: Mapping[str, Fraction]
    lanes: tuple[Mapping[str, str], ...]
    grid: Grid
    manners: Manners = field(default_factory=Manners)

    def bound(self, lanes: Mapping[str, str]) -> Formula:
        """The formula under one assignment of lanes."""
        return bind(self.query.formula, self.road, lanes, self.values)

    @cached_property
    def starts(self) -> Range | None:
        """Where fronts may be at time 0; None where every place along the road is as good as another."""
        formulas = [self.bound(lanes) for lanes in self.lanes]
        return starting_range(formulas, self.road, self.vehicles, self.grid, self.manners.reach)

    def limits(self, shown: Iterable[str] = ()) -> Limits:
        """Within what a NONE-WITHIN says that there is none; ``shown``: how that was shown."""
        options = {name: {lanes[name] for lanes in self.lanes} for name in self.query.lanes}
        spoken = parameters_of(self.query.formula)
        return Limits(
            self.road.name,
            self.grid,
            {name: vehicle.name for name, vehicle in self.vehicles.items()},
            {n: next(iter(found)) for n, found in options.items() if len(found) < len(self.road.lanes)},
            {name: value for name, value in self.values.items() if name in spoken},
            self.manners.reach,
            self.starts,
            self.manners.collisions,
            tuple(sorted(set(shown))),
        )


@dataclass(frozen=True)
class Means:
    """How to search: engine, solver, objective, work for one drive, finer grids to try.

    ``explain``: whether to show that there is none where none was found.
    """

    objective: Objective = "smooth"
    engine: Engine = "milp"
    solver: str = "highs"
    effort: Effort = field(default_factory=Effort)
    refinements: int = 2
    explain: bool = True


@dataclass(frozen=True)
class Found:
    """A judged drive, with the lanes it was judged under and the manners it keeps."""

    drive: Drive
    lanes: Mapping[str, str]
    formula: Formula
    grid: Grid
    manners: Manners


def assignments(query: Query, road: Road, chosen: Mapping[str, str]) -> tuple[dict[str, str], ...]:
    """Every way to give the free lanes of ``query`` lanes of ``road`` that agrees with ``chosen``.

    Raises ``UsageError`` for a lane that the road does not have or the query does not speak of.
    """
    for name, lane in chosen.items():
        if lane not in road.lanes:
            raise UsageError(f"lane {name}={lane}: road '{road.name}' has the lanes {', '.join(road.lanes)}")
        if name not in query.lanes:
            known = ", ".join(query.lanes) or "no lane"
            raise UsageError(f"lane {name}={lane}: the formula speaks of {known}")
    options = [[chosen[name]] if name in chosen else list(road.lanes) for name in query.lanes]
    return tuple(dict(zip(query.lanes, lanes, strict=True)) for lanes in product(*options))


def usual_road(formula: Formula) -> str:
    """The reference road that has the zones which ``formula`` speaks of: merge, depart, else main-2."""
    zones = {
        x.domain.of
        for x in subformulas(formula)
        if isinstance(x, f.Some | f.Every) and x.domain.kind == "zone"
    }
    return "merge" if "merge" in zones else "depart" if "depart" in zones else "main-2"
