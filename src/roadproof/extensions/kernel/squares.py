"""Contradictions of polynomial constraints: products times sums of squares that add up to 0 < 0.

Equations and directions without effect are removed first (``reduction.py``). Semidefinite programming finds
Gram matrices of the squares in floats (Putinar, Schmüdgen). Their rounded eigenvectors are the roots of
squares for the linear program of ``cone.py``, whose multipliers are exact. Not trusted: Coq adds them up
again.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement, islice, pairwise
from math import prod
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from roadproof.extensions.kernel.cone import (
    Constraint,
    Monomial,
    Parts,
    ProductColumn,
    coq,
    joined,
    monomials,
    number,
    solve_multipliers,
    whole_factor,
)
from roadproof.extensions.kernel.reduction import (
    PolynomialEquation,
    PolynomialInequality,
    Reduction,
    reduce_constraints,
)
from roadproof.world.polynomial import Polynomial, constant

if TYPE_CHECKING:
    from scipy.sparse import csr_array

MOST_ENTRIES = 4000  # of all Gram matrices together
MOST_BLOCKS = 800
MOST_FACTORS = 4
MOST_ITERATIONS = 80
DEGREES = (2, 3, 4, 5)
HIGHEST = 6  # of products alone
MOST_PRODUCTS = 4000
GRIDS = (16, 1000, 10**6)  # eigenvectors are rounded to fractions with these denominators
_SMALL = 1e-6  # a share of a Gram matrix that is left out
_Floats: TypeAlias = "np.ndarray[tuple[int, ...], np.dtype[np.float64]]"


@dataclass(frozen=True)
class _Block:
    """A product of inequalities times a sum of squares of polynomials over ``basis``.

    ``polynomial`` is ``scale`` times the product of the ``factors``.
    """

    polynomial: Polynomial[int]
    strict: bool
    factors: tuple[str, ...]
    scale: Fraction
    basis: tuple[Monomial, ...]

    @property
    def entries(self) -> list[tuple[int, int]]:
        """The upper triangle of its Gram matrix, by columns."""
        return [(i, j) for j in range(len(self.basis)) for i in range(j + 1)]


def contradiction(constraints: Sequence[Constraint]) -> str | None:
    """Return an absurd sum of products and squares as text for Coq; None if none is found."""
    try:
        reduction = reduce_constraints(constraints)
        text = next((x for d in DEGREES if (x := _of_degree(reduction, d)) is not None), None)
        return text or _of_products(reduction)
    except OverflowError:  # a number that no float has
        return None


def _of_degree(reduction: Reduction, degree: int) -> str | None:
    """Return an absurd sum with products of at most a degree; None if none is found."""
    blocks = list(islice(_blocks(reduction.inequalities, degree), MOST_BLOCKS + 1))
    if len(blocks) > MOST_BLOCKS:
        return None
    free = [*_multiples(reduction, degree)]
    plain = [_column(x, None, reduction) for x in blocks]
    plain += [_column(x, Polynomial({m: Fraction(1)}), reduction) for x in blocks for m in x.basis if m]
    parts = solve_multipliers([*free, *plain])
    grams = None if parts is not None else _semidefinite(blocks, free)
    for grid in GRIDS if grams is not None else ():
        squares = [_column(x, root, reduction) for x, root in _roots(blocks, grams or [], grid)]
        parts = solve_multipliers([*free, *plain, *squares])
        if parts is not None:
            break
    if parts is None:
        return None
    return _text_of(parts)


def _text_of(parts: Parts) -> str:
    whole = whole_factor(q for _, q in parts)
    return joined("sum_", [x.proof_text(q * whole, str) for x, q in parts])


def _of_products(reduction: Reduction) -> str | None:
    """Return an absurd sum of products alone, with a higher degree and more factors."""
    products = list(islice(_products(reduction.inequalities), MOST_PRODUCTS + 1))
    if len(products) > MOST_PRODUCTS:
        return None
    columns = [*_multiples(reduction, HIGHEST), *(_column(x, None, reduction) for x in products)]
    parts = solve_multipliers(columns)
    return None if parts is None else _text_of(parts)


def _products(inequalities: Sequence[PolynomialInequality]) -> Iterator[_Block]:
    """Yield products of inequalities: at most two nonlinear factors and two repetitions."""
    for count in range(MOST_FACTORS + 2):
        for chosen in combinations_with_replacement(inequalities, count):
            degrees = [x.polynomial.degree for x in chosen]
            if sum(degrees) > HIGHEST or sum(x > 1 for x in degrees) > 2:
                continue
            if len({id(x) for x in chosen}) >= count - 2:
                yield _product(chosen, ())


def _blocks(inequalities: Sequence[PolynomialInequality], degree: int) -> Iterator[_Block]:
    variables = sorted({v for x in inequalities for v in x.polynomial.variables})
    for count in range(MOST_FACTORS + 1):
        for chosen in combinations_with_replacement(inequalities, count):
            if sum(x.polynomial.degree for x in chosen) > degree:
                continue
            if any(a is b and not a.strict for a, b in pairwise(chosen)):
                continue
            basis = tuple(monomials(variables, (degree - sum(x.polynomial.degree for x in chosen)) // 2))
            repeated = len({id(x) for x in chosen}) < len(chosen)
            yield _product(chosen, basis[:1] if repeated else basis)


def _product(chosen: Sequence[PolynomialInequality], basis: tuple[Monomial, ...]) -> _Block:
    product: Polynomial[int] = constant(Fraction(1))
    for x in chosen:
        product = product * x.polynomial
    return _Block(
        product,
        all(x.strict for x in chosen),
        tuple(x.proof_text for x in chosen),
        prod((x.scale for x in chosen), start=Fraction(1)),
        basis,
    )


def _multiples(reduction: Reduction, degree: int) -> Iterator[ProductColumn]:
    variables = sorted({v for x in reduction.inequalities for v in x.polynomial.variables})
    for equation in reduction.equations:
        for monomial in monomials(variables, degree - equation.polynomial.degree):
            yield _multiple(equation, Polynomial({monomial: Fraction(1)}), reduction)


def _multiple(equation: PolynomialEquation, factor: Polynomial[int], reduction: Reduction) -> ProductColumn:
    def proof_text(q: Fraction, _: Callable[[int], str]) -> str:
        return equation.times(reduction.lift(factor).scaled(q))

    return ProductColumn(equation.polynomial * factor, False, True, (), proof_text)


def _column(block: _Block, root: Polynomial[int] | None, reduction: Reduction) -> ProductColumn:
    """Return a block times a square, or times 1."""

    def proof_text(q: Fraction, _: Callable[[int], str]) -> str:
        return joined("product_", [number(q * weight), *block.factors, *square])

    weight = block.scale
    square: list[str] = []
    if root is not None:  # in whole numbers, which Coq multiplies faster
        lifted = reduction.lift(root)
        whole = whole_factor(lifted.terms.values())
        square.append(f"(square_ {coq(lifted.scaled(whole))})")
        weight /= whole**2
    polynomial = block.polynomial if root is None else block.polynomial * root * root
    return ProductColumn(polynomial, block.strict and root is None, False, (), proof_text)


# --- Gram matrices -------------------------------------------------------------------------------


def _roots(
    blocks: Sequence[_Block], grams: Sequence[_Floats], grid: int
) -> Iterator[tuple[_Block, Polynomial[int]]]:
    """Yield likely roots of squares: eigenvectors, and sums and differences of two."""
    for block, gram in zip(blocks, grams, strict=True):
        if len(block.basis) == 1:
            continue
        values, vectors = np.linalg.eigh(gram)
        top = max(float(values[-1]), 1e-12)
        roots = [
            _rounded(block.basis, vectors[:, k] / np.abs(vectors[:, k]).max(), grid)
            for k in range(len(values))
            if values[k] > _SMALL * max(top, 1.0)
        ]
        yield from ((block, x) for x in roots)
        for place, one in enumerate(roots):
            for other in roots[:place]:
                yield block, one + other
                yield block, one - other


def _rounded(basis: Sequence[Monomial], vector: _Floats, grid: int) -> Polynomial[int]:
    terms = {m: Fraction(round(float(x) * grid), grid) for m, x in zip(basis, vector, strict=True)}
    return Polynomial({m: q for m, q in terms.items() if q})


def _semidefinite(blocks: Sequence[_Block], free: Sequence[ProductColumn]) -> list[_Floats] | None:
    """Return Gram matrices whose sum is 0, with strict parts adding up to 1; None if none exist."""
    import clarabel
    from scipy.sparse import csc_array, csc_matrix, vstack

    if sum(len(x.entries) for x in blocks) > MOST_ENTRIES:
        return None
    program = _program(blocks, free)
    height, count = program.matrix.shape
    grams = count - len(free)
    places = (np.arange(grams), np.arange(len(free), count))
    below = csc_array((-np.ones(grams), places), (grams, count))
    right = np.zeros(height + grams)
    right[0] = program.one
    cones = [clarabel.ZeroConeT(height), *(clarabel.PSDTriangleConeT(len(x.basis)) for x in blocks)]
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_iter = MOST_ITERATIONS
    rows = csc_matrix(vstack([program.matrix, below]))
    no_quadratic_cost, cost = (
        csc_matrix((count, count)),
        np.zeros(count),
    )  # what costs nothing is far from all edges
    solver = clarabel.DefaultSolver(no_quadratic_cost, cost, rows, right, cones, settings)
    solution = solver.solve()
    if "Solved" not in str(solution.status):
        return None
    values = np.array(solution.x)
    starts = np.cumsum([len(free), *(len(x.entries) for x in blocks)])
    return [_gram(x, values[start:]) for x, start in zip(blocks, starts, strict=False)]


@dataclass(frozen=True)
class _Program:
    """The constraints of the semidefinite program: row 0 for strict columns, then a row a monomial.

    Strict columns add up to ``one``.
    """

    matrix: "csr_array"
    one: float


def _program(blocks: Sequence[_Block], free: Sequence[ProductColumn]) -> _Program:
    """Return columns for multiples of equations, then for Gram entries, scaled by sqrt 2 off the diagonal."""
    from scipy.sparse import csr_array, diags_array

    columns: list[tuple[Polynomial[int], float, bool]] = [(x.polynomial, 1.0, False) for x in free]
    for block in blocks:
        for i, j in block.entries:
            monomial = tuple(sorted(block.basis[i] + block.basis[j]))
            product = block.polynomial * Polynomial({monomial: Fraction(1)})
            weight = 1.0 if i == j else float(np.sqrt(2))
            columns.append((product, weight, block.strict and not monomial))
    rows: dict[Monomial, int] = {}
    entries: list[tuple[int, int, float]] = []
    for place, (polynomial, weight, strict) in enumerate(columns):
        for monomial, q in polynomial.terms.items():
            entries.append((rows.setdefault(monomial, len(rows) + 1), place, float(q) * weight))
        if strict:
            entries.append((0, place, 1.0))
    shape = (len(rows) + 1, len(columns))
    matrix = csr_array(([e[2] for e in entries], ([e[0] for e in entries], [e[1] for e in entries])), shape)
    norms = np.sqrt(np.asarray(matrix.multiply(matrix).sum(axis=1)).ravel())
    return _Program(diags_array(1 / norms) @ matrix, 1 / float(norms[0]))


def _gram(block: _Block, values: _Floats) -> _Floats:
    gram = np.zeros((len(block.basis), len(block.basis)))
    for (i, j), value in zip(block.entries, values, strict=False):
        gram[i, j] = gram[j, i] = value if i == j else value / np.sqrt(2)
    return gram
