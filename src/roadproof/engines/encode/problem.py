"""Everything that a solver needs, as plain data: columns, linear rows, and a circuit of inequalities."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

from roadproof.engines.encode.circuit import Circuit, Leaf, all_of, nodes
from roadproof.engines.encode.polynomial import Inequality, Polynomial
from roadproof.world.signals import OwnName, SignalName

# An inequality over column numbers.
ColumnInequality: TypeAlias = Inequality[int]


@dataclass(frozen=True)
class Unknown:
    """What a column stands for: a signal of a vehicle at a sample."""

    vehicle: str
    signal: SignalName | OwnName
    step: int

    def __str__(self) -> str:
        return f"{self.vehicle}.{self.signal}.{self.step}"


@dataclass(frozen=True)
class Column:
    """A real unknown between two bounds."""

    of: Unknown
    low: Fraction
    high: Fraction


@dataclass(frozen=True)
class Row:
    """low <= Σ coefficient · column <= high; None is without bound."""

    terms: Mapping[int, Fraction]
    low: Fraction | None
    high: Fraction | None


@dataclass(frozen=True)
class Problem:
    """Find values of the columns within their bounds that satisfy every row and the circuit."""

    columns: tuple[Column, ...]
    rows: tuple[Row, ...]
    circuit: Circuit[ColumnInequality]

    def also(self, circuit: Circuit[ColumnInequality]) -> "Problem":
        """The same problem with one more condition."""
        return Problem(self.columns, self.rows, all_of([self.circuit, circuit]))

    def sizes(self) -> dict[str, int]:
        """Numbers of columns, rows, circuit nodes and distinct inequalities."""
        every = list(nodes(self.circuit))
        return {
            "columns": len(self.columns),
            "rows": len(self.rows),
            "nodes": len(every),
            "inequalities": sum(isinstance(n, Leaf) for n in every),
        }


def row_of(polynomial: Polynomial[int], low: Fraction | None, high: Fraction | None) -> Row:
    """A row from an affine polynomial between two bounds."""
    shift = polynomial.constant
    return Row(
        {m[0]: c for m, c in polynomial.terms.items() if m},
        None if low is None else low - shift,
        None if high is None else high - shift,
    )
