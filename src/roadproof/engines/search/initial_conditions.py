"""Conditions on a drive beside the formula: how it begins, and how it differs from drives found before."""

from collections.abc import Mapping
from fractions import Fraction

from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.problem import Circuit, ColumnInequality, Inequality, Leaf, all_of, any_of
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import conjuncts, narrowed
from roadproof.logic.terms import Signal
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at
from roadproof.world.polynomial import Polynomial, constant
from roadproof.world.signals import SignalName


@dataclass(frozen=True)
class Condition:
    """At time 0 a signal of ``vehicle`` is in a range (SI), which is relative to that of ``beside``."""

    signal: Signal
    beside: Signal | None
    low: Fraction
    high: Fraction


@dataclass(frozen=True)
class Start:
    """``conditions`` that imply ``replaced``, parts of a bound formula, under an assignment of ``lanes``.

    ``closed``: comparisons of other parts that are left to be false, or true under a negation.
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
        """The parts of ``formula`` that are left to be asked for; with the conditions they imply it."""
        left = (part for part in conjuncts(formula) if part not in self.replaced)
        return f.conjunction(*(narrowed(part, self.closed) if self.closed else part for part in left))


def encode_start(start: Start, layout: Layout) -> Circuit[ColumnInequality]:
    """The conditions about the first sample of a grid."""

    def now(signal: Signal) -> Polynomial[int]:
        return layout.state(signal.vehicle, signal.name, 0)

    found = []
    for x in start.conditions:
        value = now(x.signal)
        if x.beside is not None:
            value = value + now(x.beside).scaled(Fraction(-1))
        found.append(Leaf(Inequality(value + constant(-x.low), False)))
        found.append(Leaf(Inequality(value.scaled(Fraction(-1)) + constant(x.high), False)))
    return all_of(found)


# How far a signal at the start or the end has to be from that of another drive, in m and m/s.
CLEARLY: Mapping[SignalName, Fraction] = {"s": Fraction(15), "d": Fraction(5, 2), "v_lon": Fraction(4)}


def differ(layout: Layout, other: Drive) -> Circuit[ColumnInequality]:
    """At the start or the end, a vehicle is in another lane, elsewhere along it, or at another speed."""
    choices: list[Circuit[ColumnInequality]] = []
    for name in layout.vehicles:
        for step in (0, layout.grid.steps):
            state = state_at(other.vehicles[name], step * layout.grid.dt)
            for signal, distance in CLEARLY.items():
                value: Fraction = getattr(state, signal)
                now = layout.state(name, signal, step)
                choices.append(Leaf(Inequality(now + constant(-value - distance), False)))
                choices.append(Leaf(Inequality(now.scaled(Fraction(-1)) + constant(value - distance), False)))
    return any_of(choices)
