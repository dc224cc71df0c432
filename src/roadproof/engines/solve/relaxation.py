"""A linear program in HiGHS to which facts are added and from which the last are removed again."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import numpy as np

from roadproof.evidence.program import DisjunctiveProgram, Fact, Linear

MARGIN = 1e-5  # by which a strict inequality is asked for, relative to its greatest coefficient
LEAST = 1e-9  # of multipliers, relative to the greatest
SIMPLE = 10_000  # the greatest denominator of a simple fraction


class NotRefutedError(Exception):
    """An error that says why no refutation tree was found."""


@dataclass
class Relaxation:
    """The known linear facts of a program; columns of products are columns like others."""

    program: DisjunctiveProgram
    facts: list[tuple[Fact, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        import highspy

        made: Any = highspy.Highs
        self.solver = made()
        self.infinity = highspy.kHighsInf
        self.infeasible = highspy.HighsModelStatus.kInfeasible
        self.optimal = highspy.HighsModelStatus.kOptimal
        for option, value in (("output_flag", False), ("presolve", "off"), ("threads", 1)):
            self.solver.setOptionValue(option, value)
        scale = self.program.scale
        box = [(low / scale, high / scale) for low, high in self.program.box]
        box += [product_range(box[x], box[y]) for x, y in self.program.products]
        lows, highs = np.array(box).T
        self.solver.addVars(len(box), np.ascontiguousarray(lows), np.ascontiguousarray(highs))

    def add(self, fact: Fact, linear: Linear) -> None:
        """Add a fact, divided by its greatest coefficient."""
        terms: dict[int, int] = {}
        for column, factor in linear.terms:
            terms[column] = terms.get(column, 0) + factor
        size = float(max((abs(k) for k in terms.values()), default=0)) or 1.0
        columns = np.array([*terms], dtype=np.int32)
        factors = np.array([k / size for k in terms.values()])
        least = -linear.constant / size + (MARGIN if linear.strict else 0.0)
        most = least if fact.kind == "equal" else self.infinity
        self.solver.addRow(least, most, len(columns), columns, factors)
        self.facts.append((fact, size))

    def take_back(self, count: int) -> None:
        """Remove all but the first ``count`` facts."""
        gone = np.arange(count, len(self.facts), dtype=np.int32)
        if len(gone):
            self.solver.deleteRows(len(gone), gone)
            del self.facts[count:]

    def bound(self, box: Sequence[tuple[int, int]], column: int) -> None:
        """Set the bounds of a column and of the products with it; ``box`` has the bounds of all columns."""
        ends = [(low / self.program.scale, high / self.program.scale) for low, high in box]
        self.solver.changeColBounds(column, *ends[column])
        for k, (x, y) in enumerate(self.program.products):
            if column in (x, y):
                self.solver.changeColBounds(len(box) + k, *product_range(ends[x], ends[y]))

    def suspend(self, products: Sequence[int]) -> list[tuple[int, float, float]]:
        """Suspend the corner facts of these products; returns the rows for ``resume``."""
        suspended = []
        for row, (fact, _) in enumerate(self.facts):
            if fact.kind == "corner" and fact.number in products:
                _, low, high, *_ = self.solver.getRow(row)
                suspended.append((row, low, high))
                self.solver.changeRowBounds(row, -self.infinity, self.infinity)
        return suspended

    def resume(self, rows: Sequence[tuple[int, float, float]]) -> None:
        """Restore suspended rows."""
        for row, low, high in rows:
            self.solver.changeRowBounds(row, low, high)

    def solve(self) -> tuple[Any, Any]:
        """Return a point or multipliers of the facts, and None for the other. Raises ``NotRefutedError``."""
        self.solver.run()
        status = self.solver.getModelStatus()
        if status == self.optimal:
            return np.array(self.solver.getSolution().col_value), None
        if status == self.infeasible:
            _, there, ray = self.solver.getDualRay()
            if there:
                return None, np.array(ray)
        raise NotRefutedError(f"HiGHS gives neither a point nor multipliers ({status})")

    def whole(self, ray: Any, digits: int) -> tuple[tuple[Fact, int], ...]:
        """Return multipliers as integers, the greatest with ``digits`` digits."""
        return _usable_multipliers((fact, round(y * 10**digits)) for fact, y in self._relative(ray))

    def simple(self, ray: Any) -> tuple[tuple[Fact, int], ...]:
        """Return multipliers as integers with simple ratios: some sums must be exactly 0."""
        ratios = [(fact, Fraction(y).limit_denominator(SIMPLE)) for fact, y in self._relative(ray)]
        whole = math.lcm(*(y.denominator for _, y in ratios))
        return _usable_multipliers((fact, int(y * whole)) for fact, y in ratios)

    def _relative(self, ray: Any) -> list[tuple[Fact, float]]:
        """Multipliers of the facts as they are in the program, relative to the greatest."""
        each = [(fact, float(y) / size) for (fact, size), y in zip(self.facts, ray, strict=True)]
        most = max((abs(y) for _, y in each), default=0.0) or 1.0
        return [(fact, y / most) for fact, y in each if abs(y) > LEAST * most]


def _usable_multipliers(weights: Any) -> tuple[tuple[Fact, int], ...]:
    return tuple((fact, y) for fact, y in weights if y > 0 or (y < 0 and fact.kind == "equal"))


def product_range(one: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    """Return the range of the product of two ranges."""
    corners = [x * y for x in one for y in other]
    return min(corners), max(corners)
