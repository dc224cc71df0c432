"""The encoder: formula, road, vehicles and grid become columns, rows and a circuit of inequalities."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import TypeAlias, assert_never

from roadproof.engines.encode.inequalities import Quantity, inequalities_of, sizes_of
from roadproof.engines.encode.motion import ColumnLayout, encode_motions
from roadproof.engines.encode.place import be_in_lane, move_one_way, road_edges, stay_apart, stay_on_road
from roadproof.engines.encode.problem import (
    Circuit,
    ColumnInequality,
    Inequality,
    Leaf,
    LimitKind,
    Origin,
    Problem,
    RealColumn,
    Row,
    all_of,
    replace_leaves,
    row_of,
)
from roadproof.engines.encode.unroll import TimedAtom, unroll
from roadproof.logic.formula import Compare, Formula
from roadproof.runtime.records import dataclass
from roadproof.world.polynomial import Polynomial, affine, variable
from roadproof.world.road import Road
from roadproof.world.signals import CustomSignalName
from roadproof.world.vehicle import Range, Vehicle

# Stands for the time since the last sample while inequalities are made to last; columns count from 0.
_LATER = -1


# What is kept from an inequality that is not strict, and from one that is.
Margin: TypeAlias = tuple[Fraction, Fraction]
NO_MARGIN: Margin = (Fraction(0), Fraction(0))
SMALL_MARGIN: Margin = (Fraction(0), Fraction(1, 100))


@dataclass(frozen=True)
class Assumptions:
    """Restrictions of a search beside the formula; a NONE-WITHIN verdict prints all that apply.

    ``natural``: drives start and end in a lane, straight on and at cruising speed, move across the road in
    one direction only, and keep the vehicles' limits on jumps of acceleration.
    ``reach``: largest distance between two starts (m).
    ``collisions``: whether boxes may overlap. ``straight``: vehicles that do not move across the road.
    ``margin`` and ``inside``: safety margins of a floating-point search on the inequalities of the formula
    and on the limits of the accelerations.
    ``between``: whether road and clearance also hold between samples. ``apart``: clearance of boxes along
    and across (m). ``starts``: range of the fronts at time 0; None puts the first vehicle's front at s = 0
    (``encode.shift_invariance``).
    ``last_sample_persists``: whether conditions at the last sample hold for all later time as well.
    """

    natural: bool = True
    reach: Fraction = Fraction(80)
    collisions: bool = False
    straight: frozenset[str] = frozenset()
    margin: Margin = (Fraction(1, 10), Fraction(1, 10))
    inside: Fraction = Fraction(1, 100)
    off_centre: Fraction = Fraction(3, 10)
    between: bool = True
    apart: tuple[Fraction, Fraction] = (Fraction(8), Fraction(7, 10))
    starts: Range | None = None
    last_sample_persists: bool = True

    def without_comfort(self) -> "Assumptions":
        """Return assumptions without the restrictions to natural driving; vehicle limits remain."""
        close = Fraction(1, 20)
        return replace(self, natural=False, straight=frozenset(), margin=SMALL_MARGIN, apart=(close, close))

    def relaxed(self) -> "Assumptions":
        """Return the weakest assumptions: every drive that a NONE-WITHIN excludes satisfies them."""
        return replace(
            self.without_comfort(),
            margin=NO_MARGIN,
            inside=Fraction(0),
            apart=(Fraction(0), Fraction(0)),
            between=False,
            last_sample_persists=False,
        )


def assemble_problem(
    formula_circuit: Circuit[ColumnInequality],
    road: Road,
    vehicles: Mapping[str, Vehicle],
    layout: ColumnLayout,
    assumptions: Assumptions,
) -> Problem:
    """Combine an encoded formula with the constraints from motion, road and assumptions."""
    columns, rows = _motions(road, vehicles, layout, assumptions)
    around = road_constraints(road, vehicles, layout, assumptions)
    return Problem(columns, (*rows, *_reach_rows(layout, assumptions)), all_of([formula_circuit, *around]))


def _motions(
    road: Road, vehicles: Mapping[str, Vehicle], layout: ColumnLayout, assumptions: Assumptions
) -> tuple[tuple[RealColumn, ...], tuple[Row, ...]]:
    right, left = road_edges(road)
    starts: dict[str, Range] = dict.fromkeys(
        vehicles, assumptions.starts or (-assumptions.reach, assumptions.reach)
    )
    if assumptions.starts is None:
        starts[next(iter(vehicles))] = Fraction(0), Fraction(0)
    across: dict[str, Range] = {name: (right + v.width, left) for name, v in vehicles.items()}
    natural, straight = assumptions.natural, assumptions.straight
    return encode_motions(vehicles, layout, starts, across, natural, assumptions.inside, straight)


def encode_formula(
    formula: Formula, vehicles: Mapping[str, Vehicle], layout: ColumnLayout, assumptions: Assumptions
) -> Circuit[ColumnInequality]:
    """Return the formula as a circuit over the columns of ``layout``.

    Raises ``UsageError`` for interval bounds that are no multiples of dt.
    """
    return ground_atoms(
        unroll(formula, layout.grid), vehicles, layout, assumptions.margin, assumptions.last_sample_persists
    )


def _reach_rows(layout: ColumnLayout, assumptions: Assumptions) -> Iterator[Row]:
    """Yield rows that bound the distance of any two starts by the reach, where column bounds do not."""
    free_vehicles = layout.vehicles[1:] if assumptions.starts is None else layout.vehicles
    for a, b in combinations(free_vehicles, 2):
        ends = [(layout.column(a, "s", 0), Fraction(1)), (layout.column(b, "s", 0), Fraction(-1))]
        yield row_of(affine(ends), -assumptions.reach, assumptions.reach, Origin(LimitKind.REACH, 0, (a, b)))


def road_constraints(
    road: Road, vehicles: Mapping[str, Vehicle], layout: ColumnLayout, assumptions: Assumptions
) -> list[Circuit[ColumnInequality]]:
    """Return the constraints on places that do not come from the formula: road, clearance, lanes."""
    parts = [
        stay_on_road(layout, road, name, vehicle, assumptions.between, assumptions.last_sample_persists)
        for name, vehicle in vehicles.items()
    ]
    if not assumptions.collisions:
        parts += [
            stay_apart(layout, a, b, assumptions.apart, assumptions.between)
            for a, b in combinations(vehicles.items(), 2)
        ]
    if assumptions.natural:
        parts += [
            be_in_lane(layout, road, name, vehicle, step, assumptions.off_centre)
            for name, vehicle in vehicles.items()
            for step in ((0,) if name in assumptions.straight else (0, layout.grid.steps))
        ]
        parts += [move_one_way(layout, name) for name in vehicles if name not in assumptions.straight]
    return parts


def ground_atoms(
    circuit: Circuit[TimedAtom],
    vehicles: Mapping[str, Vehicle],
    layout: ColumnLayout,
    margin: Margin,
    last_sample_persists: bool = True,
) -> Circuit[ColumnInequality]:
    """Replace comparisons at samples by inequalities over columns.

    Args:
        circuit: comparisons at samples, from ``unroll``.
        margin: safety margins for non-strict and for strict inequalities.
        last_sample_persists: whether a comparison at the last sample must hold for all later time, too.
    """
    sizes = sizes_of(vehicles)
    known: dict[Compare, Circuit[Inequality[Quantity]]] = {}

    def at(leaf: TimedAtom) -> Circuit[ColumnInequality]:
        """Return the inequalities of one comparison; equal comparisons are expanded once."""
        origin = Origin(leaf.atom, leaf.step)
        if leaf.atom not in known:
            known[leaf.atom] = replace_leaves(
                inequalities_of(leaf.atom, sizes),
                lambda inequality: Leaf(replace(inequality, margin=margin[inequality.strict])),
            )
        if leaf.step < layout.grid.steps or not last_sample_persists:
            return replace_leaves(
                known[leaf.atom], lambda inequality: Leaf(inequality_at(inequality, layout, origin))
            )
        return replace_leaves(
            known[leaf.atom], lambda inequality: inequality_from_last_sample(inequality, layout, origin)
        )

    return replace_leaves(circuit, at)


def inequality_at(inequality: Inequality[Quantity], layout: ColumnLayout, origin: Origin) -> ColumnInequality:
    """Return an inequality over signals as an inequality over the columns of the step of ``origin``."""
    return Inequality(
        inequality.polynomial.substitute(lambda q: layout.state(q[0], q[1], origin.step)),
        inequality.strict,
        inequality.margin,
        origin,
    )


def inequality_from_last_sample(
    inequality: Inequality[Quantity], layout: ColumnLayout, origin: Origin
) -> Circuit[ColumnInequality]:
    """Return a sufficient condition for an inequality to hold from the last sample on, without acceleration.

    Positions are then affine in the time since that sample, so the polynomial is one in that time. It keeps
    its sign if it has it at the sample and no coefficient of a positive power is negative.
    """
    step = layout.grid.steps

    def state(quantity: Quantity) -> Polynomial[int]:
        """Return a quantity as a polynomial in the columns of the last sample and the time since then."""
        vehicle, signal = quantity
        now = layout.state(vehicle, signal, step)
        if isinstance(signal, CustomSignalName):
            return now
        match signal:
            case "s":
                return now + layout.state(vehicle, "v_lon", step) * variable(_LATER)
            case "d":
                return now + layout.state(vehicle, "v_lat", step) * variable(_LATER)
            case "v_lon" | "v_lat" | "a_lon" | "a_lat" | "j_lon":
                return now
            case _:
                assert_never(signal)

    powers: dict[int, dict[tuple[int, ...], Fraction]] = {0: {}}
    for monomial, factor in inequality.polynomial.substitute(state).terms.items():
        power = monomial.count(_LATER)
        rest = tuple(v for v in monomial if v != _LATER)
        powers.setdefault(power, {})[rest] = factor
    return all_of(
        Leaf(
            Inequality(Polynomial(terms), inequality.strict, inequality.margin, origin)
            if power == 0
            else Inequality(Polynomial(terms), False, origin=origin)
        )
        for power, terms in sorted(powers.items())
    )
