"""Writes problems as mixed-integer programs with one-sided big-M.

Each part of a disjunction gets a binary column, and a chosen part must hold. Nothing follows from a part
that is not chosen, so no condition is needed in the other direction. Each big-M is the bound of its own
condition on the box.
"""

from collections.abc import Mapping, Sequence
from typing import TypeAlias, assert_never

import numpy as np

from roadproof.engines.encode.problem import (
    All,
    AnyOf,
    Circuit,
    Leaf,
    Origin,
    Problem,
    nodes,
    replace_leaves,
)
from roadproof.engines.solve.bounds import Affine, Bound, Box, Side, affine_bounds, loosened
from roadproof.engines.solve.highs import MixedIntegerProgram
from roadproof.engines.solve.sparse import Triplets
from roadproof.runtime.records import dataclass

# What a row encodes: a comparison or another condition, or that a part of a disjunction is chosen.
RowSource: TypeAlias = Origin | AnyOf[Bound] | None


@dataclass(frozen=True)
class EncodedProgram:
    """A mixed-integer program with what its rows and binary columns encode.

    ``sources``: of each row. ``choices``: for each binary column, the part that holds where it is 1.
    """

    program: MixedIntegerProgram
    sources: Sequence[RowSource]
    choices: Mapping[int, Circuit[Bound]]


def encode_mixed(problem: Problem, box: Box, side: Side = "inner", pieces: int = 1) -> EncodedProgram:
    """Return a problem as a mixed-integer program in ``box`` (a bound pair per column).

    On the inner side each solution solves the exact problem up to floating point. On the outer side each
    solution of the exact problem is one, and all but equations is loosened by more than the tolerances of
    solvers. ``pieces``: tangents or secants for a square. Raises ``TooNonlinearError`` above degree 2.
    """
    box = loosened(box) if side == "outer" else box
    circuit = replace_leaves(problem.circuit, lambda inequality: affine_bounds(inequality, box, side, pieces))
    builder = _MilpBuilder(list(box))
    for row in problem.rows:
        affine = Affine(tuple((c, float(k)) for c, k in row.terms.items()), 0.0)
        slack = affine.looseness(box) if side == "outer" and row.low != row.high else 0.0
        low = -np.inf if row.low is None else float(row.low) - slack
        high = np.inf if row.high is None else float(row.high) + slack
        builder.add(affine.terms, low, high, row.origin)
    builder.require(circuit)
    return builder.program()


class _MilpBuilder:
    """A builder of rows, as triplets, and of binary columns for disjunctions."""

    def __init__(self, box: list[tuple[float, float]]) -> None:
        self.box = box
        self.binaries: list[int] = []
        self.entries = Triplets()
        self.high: list[float] = []
        self.sources: list[RowSource] = []
        self.choices: dict[int, Circuit[Bound]] = {}

    def add(self, terms: Sequence[tuple[int, float]], low: float, high: float, source: RowSource) -> None:
        self.entries.add(terms, low)
        self.high.append(high)
        self.sources.append(source)

    def binary(self, part: Circuit[Bound]) -> int:
        """Return a new column for the choice of a part of a disjunction."""
        self.box.append((0.0, 1.0))
        self.binaries.append(len(self.box) - 1)
        self.choices[self.binaries[-1]] = part
        return self.binaries[-1]

    def require(self, circuit: Circuit[Bound]) -> None:
        """Add rows that make ``circuit`` true; each part of a disjunction gets a binary column."""
        chosen: dict[int, int] = {}
        top: list[Circuit[Bound]] = list(circuit.parts) if isinstance(circuit, All) else [circuit]
        for node in nodes(circuit):
            if isinstance(node, AnyOf):
                for part in node.parts:
                    if id(part) not in chosen:
                        chosen[id(part)] = self.binary(part)
        waiting: list[tuple[Circuit[Bound], int | None]] = [(part, None) for part in top]
        waiting += [(n, chosen[id(n)]) for n in nodes(circuit) if id(n) in chosen]
        for node, guard in waiting:
            self._hold(node, guard, chosen)

    def _hold(self, node: Circuit[Bound], guard: int | None, chosen: Mapping[int, int]) -> None:
        """Add rows that make ``node`` true, if the guard (where there is one) is 1."""
        match node:
            case Leaf(bound):
                self._bound(bound, guard)
            case All(parts):
                for part in parts:
                    self._hold(part, guard, chosen)
            case AnyOf(parts):
                picks = [(chosen[id(p)], 1.0) for p in parts]
                if guard is None:
                    self.add(picks, 1.0, np.inf, node)
                else:
                    self.add([*picks, (guard, -1.0)], 0.0, np.inf, node)
            case _:
                assert_never(node)

    def _bound(self, bound: Bound, guard: int | None) -> None:
        """Add affine >= margin, relaxed by its own least value where the guard is 0."""
        least = bound.margin - bound.affine.constant
        if guard is None:
            self.add(bound.affine.terms, least, np.inf, bound.origin)
            return
        slack = max(0.0, bound.margin - bound.affine.range(self.box)[0])
        self.add([*bound.affine.terms, (guard, -slack)], least - slack, np.inf, bound.origin)

    def program(self) -> EncodedProgram:
        """Return what was built."""
        low, high, box = np.array(self.entries.right), np.array(self.high), np.array(self.box)
        program = MixedIntegerProgram(*self.entries.arrays(), low, high, box, self.binaries)
        return EncodedProgram(program, self.sources, self.choices)
