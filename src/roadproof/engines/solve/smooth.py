"""Solves the convex quadratic programs that remain when every choice is made, with Clarabel.

Inequalities become affine conditions on their inner side near a point at which they hold: tangents
there, and secants on a narrow window around it.
"""

from collections.abc import Iterable, Sequence
from importlib.util import find_spec

import numpy as np

from roadproof.engines.encode.problem import ColumnInequality, Row
from roadproof.engines.solve.bounds import Affine, Bound, Box, split_squares
from roadproof.engines.solve.sparse import Triplets
from roadproof.errors import MissingSolverError
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Square:
    """A cost ``weight · affine²``."""

    weight: float
    affine: Affine


def linearise_at(inequality: ColumnInequality, point: Sequence[float], box: Box) -> Bound:
    """Return an affine condition that implies ``inequality`` in ``box``; exact at ``point`` if convex."""
    total, squares = split_squares(inequality)
    for factor, form in squares:
        low, high = form.range(box)
        at = form.value(point)
        if factor > 0:
            bound = form.scaled(2 * at) + Affine((), -at * at)
        else:
            bound = form.scaled(low + high) + Affine((), -low * high)
        total = total + bound.scaled(factor)
    return Bound(total, float(inequality.margin))


def trust_box(box: Box, point: Sequence[float], widths: Sequence[float]) -> list[tuple[float, float]]:
    """Return the part of ``box`` within ``widths`` of ``point`` in each column."""
    return [
        (max(low, min(x, high) - w), min(high, max(x, low) + w))
        for (low, high), x, w in zip(box, point, widths, strict=True)
    ]


def minimise(
    rows: Iterable[Row],
    box: Box,
    bounds: Iterable[Bound],
    squares: Iterable[Square],
    cost: Affine | None = None,
) -> tuple[float, ...] | None:
    """Return the point that minimises Σ weight·affine² + cost within rows, box and bounds, or None.

    Raises ``MissingSolverError``.
    """
    if find_spec("clarabel") is None:
        raise MissingSolverError(
            "solver=clarabel is not installed: install clarabel, or ask for another objective"
        )
    import clarabel

    count = len(box)
    equal, below = Triplets(), Triplets()
    for row in rows:
        terms = [(c, float(k)) for c, k in row.terms.items()]
        if row.low is not None and row.low == row.high:
            equal.add(terms, float(row.low))
            continue
        if row.low is not None:
            below.add([(c, -k) for c, k in terms], -float(row.low))
        if row.high is not None:
            below.add(terms, float(row.high))
    for column, (low, high) in enumerate(box):
        if high - low < 1e-9:
            equal.add([(column, 1.0)], low)
        else:
            below.add([(column, 1.0)], high)
            below.add([(column, -1.0)], -low)
    for bound in bounds:
        below.add([(c, -k) for c, k in bound.affine.terms], bound.affine.constant - bound.margin)
    weighted = [s for s in squares if s.weight > 0]
    forms = Triplets()
    for square in weighted:
        forms.add(square.affine.terms, square.affine.constant)
    weights = np.array([s.weight for s in weighted])
    quadratic, linear = forms.squared(2 * weights, count), 2 * forms.weighted(weights, count)
    for column, factor in cost.terms if cost else ():
        linear[column] += factor
    both = equal.stacked(below, count)
    cones = [clarabel.ZeroConeT(len(equal.right)), clarabel.NonnegativeConeT(len(below.right))]
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    settings.direct_solve_method = "qdldl"
    right = np.array(equal.right + below.right)
    solver = clarabel.DefaultSolver(quadratic, linear, both, right, cones, settings)
    result = solver.solve()
    if str(result.status) not in ("Solved", "AlmostSolved"):
        return None
    return tuple(result.x)
