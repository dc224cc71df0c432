"""A question to a problem: formula, road, vehicles and grid become columns, rows and a circuit."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import TypeAlias, assert_never

from roadproof.engines.encode.inequalities import Quantity, inequalities_of, sizes_of
from roadproof.engines.encode.motion import Layout, encode_motions
from roadproof.engines.encode.place import be_in_lane, move_one_way, span, stay_apart, stay_on_road
from roadproof.engines.encode.problem import (
    Circuit,
    Column,
    ColumnInequality,
    Inequality,
    Leaf,
    Problem,
    Row,
    all_of,
    replace_leaves,
    row_of,
)
from roadproof.engines.encode.unroll import At, unroll
from roadproof.logic.formula import Compare, Formula
from roadproof.runtime.records import dataclass
from roadproof.world.polynomial import Polynomial, affine, variable
from roadproof.world.road import Road
from roadproof.world.signals import OwnName
from roadproof.world.vehicle import Range, Vehicle

# Stands for the time since the last sample while inequalities are made to last; columns count from 0.
_LATER = -1


# What is kept from an inequality that is not strict, and from one that is.
Margin: TypeAlias = tuple[Fraction, Fraction]
NONE: Margin = (Fraction(0), Fraction(0))
NARROW: Margin = (Fraction(0), Fraction(1, 100))


@dataclass(frozen=True)
class Assumptions:
    """What is asked of a drive beside the formula; all of it is printed with a NONE-WITHIN.

    ``natural``: start and end in a lane, straight on, at cruising
    speed; move across the road in one direction only, within the vehicles' jumps of acceleration.
    ``between``: whether to look after the time between samples too.
    ``apart``: how far boxes stay from each other, along or across.
    ``reach``: how far apart any two vehicles may start, in m.
    ``starts``: where fronts may be at time 0; None puts the first vehicle's at s = 0 (``encode.along``).
    ``collisions``: whether boxes may overlap. ``straight``: vehicles that do not move across the road.
    ``margin`` and ``inside``: what a search in floating
    point keeps from the inequalities of the formula and from the limits of the accelerations.
    ``lasting``: what is asked of the last sample is asked for ever after, of formula and road alike.
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
    lasting: bool = True

    def plain(self) -> "Assumptions":
        """Whatever the limits of the vehicles allow."""
        close = Fraction(1, 20)
        return replace(self, natural=False, straight=frozenset(), margin=NARROW, apart=(close, close))

    def loosest(self) -> "Assumptions":
        """No more than every drive keeps that a NONE-WITHIN speaks of: what it rests on is printed."""
        return replace(
            self.plain(),
            margin=NONE,
            inside=Fraction(0),
            apart=(Fraction(0), Fraction(0)),
            between=False,
            lasting=False,
        )


def frame(
    wanted: Circuit[ColumnInequality],
    road: Road,
    vehicles: Mapping[str, Vehicle],
    layout: Layout,
    assumptions: Assumptions,
) -> Problem:
    """An encoded formula put among motions, road and assumptions."""
    columns, rows = _motions(road, vehicles, layout, assumptions)
    around = surroundings(road, vehicles, layout, assumptions)
    return Problem(columns, (*rows, *_starts_within(layout, assumptions)), all_of([wanted, *around]))


def _motions(
    road: Road, vehicles: Mapping[str, Vehicle], layout: Layout, assumptions: Assumptions
) -> tuple[tuple[Column, ...], tuple[Row, ...]]:
    right, left = span(road)
    starts: dict[str, Range] = dict.fromkeys(
        vehicles, assumptions.starts or (-assumptions.reach, assumptions.reach)
    )
    if assumptions.starts is None:
        starts[next(iter(vehicles))] = Fraction(0), Fraction(0)
    across: dict[str, Range] = {name: (right + v.width, left) for name, v in vehicles.items()}
    natural, straight = assumptions.natural, assumptions.straight
    return encode_motions(vehicles, layout, starts, across, natural, assumptions.inside, straight)


def encode_formula(
    formula: Formula, vehicles: Mapping[str, Vehicle], layout: Layout, assumptions: Assumptions
) -> Circuit[ColumnInequality]:
    """The formula as a circuit over the columns of ``layout``.

    Raises ``UsageError`` for interval bounds that are no multiples of dt.
    """
    return ground(unroll(formula, layout.grid), vehicles, layout, assumptions.margin, assumptions.lasting)


def _starts_within(layout: Layout, assumptions: Assumptions) -> Iterator[Row]:
    """No two vehicles start farther apart than the reach, where the bounds of columns do not say so."""
    held = layout.vehicles[1:] if assumptions.starts is None else layout.vehicles
    for a, b in combinations(held, 2):
        ends = [(layout.column(a, "s", 0), Fraction(1)), (layout.column(b, "s", 0), Fraction(-1))]
        yield row_of(affine(ends), -assumptions.reach, assumptions.reach)


def surroundings(
    road: Road, vehicles: Mapping[str, Vehicle], layout: Layout, assumptions: Assumptions
) -> list[Circuit[ColumnInequality]]:
    """Conditions on where vehicles are that do not come from the formula."""
    parts = [
        stay_on_road(layout, road, name, vehicle, assumptions.between, assumptions.lasting)
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


def ground(
    circuit: Circuit[At],
    vehicles: Mapping[str, Vehicle],
    layout: Layout,
    margin: Margin,
    lasting: bool = True,
) -> Circuit[ColumnInequality]:
    """A circuit of comparisons at samples as one of inequalities about columns.

    Where ``lasting``, one at the last sample is asked for from there on for ever.
    """
    sizes = sizes_of(vehicles)
    known: dict[Compare, Circuit[Inequality[Quantity]]] = {}

    def at(leaf: At) -> Circuit[ColumnInequality]:
        if leaf.atom not in known:
            known[leaf.atom] = replace_leaves(
                inequalities_of(leaf.atom, sizes),
                lambda inequality: Leaf(replace(inequality, margin=margin[inequality.strict])),
            )
        if leaf.step < layout.grid.steps or not lasting:
            return replace_leaves(
                known[leaf.atom], lambda inequality: Leaf(inequality_at(inequality, layout, leaf.step))
            )
        return replace_leaves(known[leaf.atom], lambda inequality: inequality_for_ever(inequality, layout))

    return replace_leaves(circuit, at)


def inequality_at(inequality: Inequality[Quantity], layout: Layout, step: int) -> ColumnInequality:
    """An inequality about signals as one about the columns of a sample."""
    return Inequality(
        inequality.polynomial.substitute(lambda q: layout.state(q[0], q[1], step)),
        inequality.strict,
        inequality.margin,
    )


def inequality_for_ever(inequality: Inequality[Quantity], layout: Layout) -> Circuit[ColumnInequality]:
    """Sufficient for an inequality to hold at the last sample and ever after, when nobody accelerates.

    Positions are then affine in the time since, so the polynomial is one in that time; it stays
    where it should if it is there at once and no coefficient of a positive power is negative.
    """
    step = layout.grid.steps

    def state(quantity: Quantity) -> Polynomial[int]:
        vehicle, signal = quantity
        now = layout.state(vehicle, signal, step)
        if isinstance(signal, OwnName):
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
            Inequality(Polynomial(terms), inequality.strict, inequality.margin)
            if power == 0
            else Inequality(Polynomial(terms), False)
        )
        for power, terms in sorted(powers.items())
    )
