"""How a drive begins: conditions at time 0, in place of parts of a formula that they imply."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from roadproof.engines.encode.circuit import Circuit, Leaf, all_of
from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.polynomial import Inequality, Polynomial, constant
from roadproof.engines.encode.problem import ColumnInequality
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import conjuncts, narrowed
from roadproof.logic.terms import Signal


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
