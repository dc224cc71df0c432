"""Conditions on a drive beside the formula: its start, and its difference from earlier drives."""

from collections.abc import Mapping
from fractions import Fraction

from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.problem import (
    Circuit,
    ColumnInequality,
    Inequality,
    Leaf,
    LimitKind,
    Origin,
    all_of,
    any_of,
)
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import top_level_conjuncts, without_comparisons
from roadproof.logic.terms import Signal
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at
from roadproof.world.polynomial import Polynomial, constant
from roadproof.world.signals import SignalName


@dataclass(frozen=True)
class Condition:
    """A range (SI) for a signal of a vehicle at time 0, absolute or relative to another vehicle's signal."""

    signal: Signal
    beside: Signal | None
    low: Fraction
    high: Fraction


@dataclass(frozen=True)
class Start:
    """Conditions at time 0 that imply ``replaced``, parts of a bound formula, for an assignment of ``lanes``.

    ``closed``: comparisons of other parts that are set to false (to true under a negation).
    """

    lanes: Mapping[str, str]
    conditions: tuple[Condition, ...]
    replaced: frozenset[Formula]
    closed: frozenset[f.Compare] = frozenset()

    @property
    def exact(self) -> dict[Signal, Condition]:
        """The conditions that leave one value, by signal."""
        return {x.signal: x for x in self.conditions if x.low == x.high}

    def without(self, formula: Formula) -> Formula:
        """Return the parts of ``formula`` that remain; together with the conditions they imply it."""
        left = (part for part in top_level_conjuncts(formula) if part not in self.replaced)
        return f.conjunction(
            *(without_comparisons(part, self.closed) if self.closed else part for part in left)
        )


def encode_start(start: Start, layout: ColumnLayout) -> Circuit[ColumnInequality]:
    """Return the conditions as constraints on the first sample."""

    def now(signal: Signal) -> Polynomial[int]:
        return layout.state(signal.vehicle, signal.name, 0)

    inequalities = []
    for x in start.conditions:
        value = now(x.signal)
        if x.beside is not None:
            value = value + now(x.beside).scaled(Fraction(-1))
        origin = Origin(LimitKind.START, 0, (x.signal.vehicle,))
        for bounded in (value + constant(-x.low), value.scaled(Fraction(-1)) + constant(x.high)):
            inequalities.append(Leaf(Inequality(bounded, False, origin=origin)))
    return all_of(inequalities)


# How far a signal at the start or the end has to be from that of another drive, in m and m/s.
CLEARLY: Mapping[SignalName, Fraction] = {"s": Fraction(15), "d": Fraction(5, 2), "v_lon": Fraction(4)}


def differs_from(layout: ColumnLayout, other: Drive) -> Circuit[ColumnInequality]:
    """Return the constraint that a vehicle starts or ends clearly apart from ``other``, in place or speed."""
    choices: list[Circuit[ColumnInequality]] = []
    for name in layout.vehicles:
        for step in (0, layout.grid.steps):
            state = state_at(other.vehicles[name], step * layout.grid.dt)
            for signal, distance in CLEARLY.items():
                value: Fraction = getattr(state, signal)
                now = layout.state(name, signal, step)
                origin = Origin(LimitKind.OTHER_DRIVE, step, (name,))
                above, below = now + constant(-value), now.scaled(Fraction(-1)) + constant(value)
                for side in (above, below):
                    choices.append(Leaf(Inequality(side + constant(-distance), False, origin=origin)))
    return any_of(choices)
