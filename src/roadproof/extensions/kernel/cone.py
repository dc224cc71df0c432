"""Contradictions of polynomial constraints: weighted products of them that add up to 0 < 0.

Products of a few constraints, squares, and equations times monomials are the columns of a linear program
(Handelman; Positivstellensatz of low degree). It is solved in floats to find the columns to use; their
multipliers are then computed exactly. Not trusted: Coq adds the products up again.
"""

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property, lru_cache, reduce
from itertools import combinations, combinations_with_replacement, islice
from math import comb, gcd, lcm, prod
from typing import Literal, TypeAlias

from roadproof.extensions.kernel.linear import add_to
from roadproof.runtime.records import dataclass
from roadproof.world.polynomial import Polynomial, constant

# Variables by number, in order and repeated for powers; the empty one is 1.
Monomial: TypeAlias = tuple[int, ...]
ConstraintKind: TypeAlias = Literal["above", "at least", "zero"]
MOST_COLUMNS = 4000
FEW_VARIABLES = 6  # with so many, squares of sums of products are tried too
_SMALL = 1e-7


def coq(polynomial: Polynomial[int]) -> str:
    """Return a polynomial as a term of Products.v."""
    terms = sorted(polynomial.terms.items(), key=lambda x: sorted(Counter(x[0]).items()))
    shown = [joined("mul_", _factors(m, q)) for m, q in terms]
    return joined("add_", shown or ["(c_ 0 1)"])


def joined(word: str, parts: Iterable[str]) -> str:
    """Return a binary operator of Products.v applied to several parts, from the left."""
    return reduce(lambda one, other: f"({word} {one} {other})", parts)


def _factors(monomial: Monomial, factor: Fraction) -> Iterator[str]:
    if factor != 1 or not monomial:
        top = str(factor.numerator) if factor >= 0 else f"({factor.numerator})"
        yield f"(c_ {top} {factor.denominator})"
    yield from (f"(x_ {variable})" for variable in monomial)


@dataclass(frozen=True)
class Constraint:
    """The condition that ``polynomial`` is above 0, at least 0, or 0."""

    kind: ConstraintKind
    polynomial: Polynomial[int]

    @cached_property
    def key(self) -> Hashable:
        """A value that equal constraints share."""
        return self.kind, frozenset(self.polynomial.terms.items())


@dataclass(frozen=True)
class ProductColumn:
    """A product; ``strict``: it is above 0; ``free``: it is 0, and may be subtracted.

    ``places``: its constraints. ``proof_text``: its text for Coq, given a multiplier and the text of
    constraints.
    """

    polynomial: Polynomial[int]
    strict: bool
    free: bool
    places: tuple[int, ...]
    proof_text: Callable[[Fraction, Callable[[int], str]], str]

    @cached_property
    def floats(self) -> tuple[tuple[Monomial, float], ...]:
        """The terms of the polynomial, rounded."""
        return tuple((monomial, float(factor)) for monomial, factor in self.polynomial.terms.items())


# Products of constraints that were made before, by places and identities; the constraints stay with them.
Products: TypeAlias = dict[tuple[tuple[int, int], ...], tuple[Constraint, ProductColumn]]
Parts: TypeAlias = tuple[tuple[ProductColumn, Fraction], ...]


@dataclass(frozen=True)
class AbsurdSum:
    """A sum of products that is absurd; ``scales`` make the coefficients of each constraint whole."""

    parts: Parts
    scales: tuple[Fraction, ...]

    def proof_text(self) -> str:
        """Return the text for Coq, in whole numbers, which Coq adds and multiplies much faster.

        The last constraint has number 0 there.
        """
        multipliers = [q / prod(self.scales[place] for place in x.places) for x, q in self.parts]
        whole = whole_factor(multipliers)
        printed = [
            x.proof_text(q * whole, self._given) for (x, _), q in zip(self.parts, multipliers, strict=True)
        ]
        total = printed[-1]
        for part in reversed(printed[:-1]):
            total = f"(sum_ {part} {total})"
        return total

    def _given(self, place: int) -> str:
        constraint = f"(given_ {len(self.scales) - 1 - place})"
        return (
            constraint if self.scales[place] == 1 else f"(product_ {number(self.scales[place])} {constraint})"
        )


def whole_factor(numbers: Iterable[Fraction]) -> Fraction:
    """Return the factor that makes numbers whole and coprime; 1 if all are 0."""
    nonzero = [q for q in numbers if q]
    return Fraction(lcm(*(q.denominator for q in nonzero)), gcd(*(q.numerator for q in nonzero)) or 1)


def number(value: Fraction) -> str:
    return f"(number_ {value.numerator} {value.denominator})"


def contradiction(
    constraints: Sequence[Constraint], level: int, products: Products | None = None
) -> tuple[AbsurdSum | None, int]:
    """Return an absurd sum of products of at most ``level`` constraints, or None, and the number of columns.

    That number measures the work. ``products``: products that cases of one question share; new ones are
    added.
    """
    signed = sum(x.kind != "zero" for x in constraints)
    if sum(comb(signed + count - 1, count) for count in range(1, level + 1)) >= MOST_COLUMNS:
        return None, MOST_COLUMNS + 1
    columns = list(
        islice(_columns(constraints, level, {} if products is None else products), MOST_COLUMNS + 1)
    )
    if len(columns) > MOST_COLUMNS:
        return None, len(columns)
    try:
        parts = solve_multipliers(columns)
    except OverflowError:  # a number that no float has
        return None, len(columns)
    scales = tuple(whole_factor(x.polynomial.terms.values()) for x in constraints)
    return AbsurdSum(parts, scales) if parts is not None else None, len(columns)


def _columns(constraints: Sequence[Constraint], level: int, products: Products) -> Iterator[ProductColumn]:
    one = ProductColumn(constant(Fraction(1)), True, False, (), lambda q, _: number(q))
    yield one
    signed = [(place, x) for place, x in enumerate(constraints) if x.kind != "zero"]
    keys = {place: (place, id(x)) for place, x in signed}
    made = [one]
    for _ in range(level):
        longer: list[ProductColumn] = []
        for column in made:
            before = tuple(keys[place] for place in column.places)
            for place, constraint in signed:
                if column.places and place < column.places[-1]:
                    continue
                key = (*before, keys[place])
                if key not in products:
                    products[key] = constraint, _product(column, place, constraint)
                longer.append(products[key][1])
        yield from longer
        made = longer
    variables = sorted({v for x in constraints for v in x.polynomial.variables})
    for place, constraint in enumerate(constraints):
        if constraint.kind == "zero":
            for monomial in monomials(variables, level if level > 1 else 0):
                yield _equation(place, constraint.polynomial * Polynomial({monomial: Fraction(1)}), monomial)
    if level > 1:
        degree = 2 if level > 2 and len(variables) <= FEW_VARIABLES else 1
        yield from _squares(tuple(variables), degree)


@lru_cache(maxsize=32)
def _squares(variables: tuple[int, ...], degree: int) -> tuple[ProductColumn, ...]:
    """Return the squares of monomials of at most that degree, of their differences and of their sums."""
    roots = [Polynomial({m: Fraction(1)}) for m in monomials(variables, degree)]
    of_two = ((one - other, one + other) for one, other in combinations(roots, 2))
    return tuple(map(_square, (*roots, *(x for both in of_two for x in both))))


def _product(column: ProductColumn, place: int, times: Constraint) -> ProductColumn:
    places, strict = (*column.places, place), column.strict and times.kind == "above"

    def proof_text(q: Fraction, given: Callable[[int], str]) -> str:
        return f"(product_ {number(q)} {joined('product_', map(given, places))})"

    return ProductColumn(column.polynomial * times.polynomial, strict, False, places, proof_text)


def _equation(place: int, product: Polynomial[int], factor: Monomial) -> ProductColumn:
    def proof_text(q: Fraction, given: Callable[[int], str]) -> str:
        return f"(times_ {coq(Polynomial({factor: q}))} {given(place)})"

    return ProductColumn(product, False, True, (place,), proof_text)


def _square(root: Polynomial[int]) -> ProductColumn:
    def proof_text(q: Fraction, given: Callable[[int], str]) -> str:
        return f"(product_ {number(q)} (square_ {coq(root)}))"

    return ProductColumn(root * root, False, False, (), proof_text)


def monomials(variables: Sequence[int], degree: int) -> Iterator[Monomial]:
    """Yield the monomials of at most that degree."""
    for size in range(degree + 1):
        yield from combinations_with_replacement(variables, size)


# --- multipliers ---------------------------------------------------------------------------------


def solve_multipliers(columns: Sequence[ProductColumn]) -> Parts | None:
    """Return multipliers of columns that add up to 0, with strict ones adding up to 1; None if none."""
    from scipy.optimize import linprog
    from scipy.sparse import csr_array

    rows: dict[Monomial, int] = {}
    entries: list[tuple[int, int, float]] = []
    for place, column in enumerate(columns):
        for monomial, factor in column.floats:
            entries.append((rows.setdefault(monomial, len(rows) + 1), place, factor))
        if column.strict:
            entries.append((0, place, 1.0))
    shape = (len(rows) + 1, len(columns))
    matrix = csr_array(([e[2] for e in entries], ([e[0] for e in entries], [e[1] for e in entries])), shape)
    solution = linprog(
        [0.0 if x.free else 1.0 for x in columns],
        A_eq=matrix,
        b_eq=[1.0] + [0.0] * len(rows),
        bounds=[(None, None) if x.free else (0, None) for x in columns],
        method="highs-ds",
    )
    if solution.status != 0:
        return None
    columns_used = [columns[place] for place, x in enumerate(solution.x) if abs(x) > _SMALL]
    return _exact_multipliers(columns_used)


def _exact_multipliers(used: Sequence[ProductColumn]) -> Parts | None:
    """Return the rational multipliers of these columns; None if the floats were misleading."""
    rows: dict[Monomial | None, dict[int, Fraction]] = {None: {}}
    for place, column in enumerate(used):
        for monomial, factor in column.polynomial.terms.items():
            rows.setdefault(monomial, {})[place] = factor
        if column.strict:
            rows[None][place] = Fraction(1)
    rows[None][len(used)] = Fraction(1)  # the right hand side
    solution = solve_linear(list(rows.values()), len(used))
    if solution is None:
        return None
    parts = [(x, solution.get(place, Fraction(0))) for place, x in enumerate(used)]
    if any(q < 0 and not x.free for x, q in parts):
        return None
    return tuple((x, q) for x, q in parts if q)


def solve_linear(rows: list[dict[int, Fraction]], last: int) -> Mapping[int, Fraction] | None:
    """Return a solution of linear equations, or None; ``last`` is the right hand side."""
    pivots = echelon(rows, last)
    if pivots is None:
        return None
    return {place: row.get(last, Fraction(0)) for place, row in pivots.items()}


def echelon(rows: Iterable[Mapping[int, Fraction]], last: int) -> dict[int, dict[int, Fraction]] | None:
    """Return linear equations in reduced form, each row by its pivot variable; None if contradictory."""
    pivots: dict[int, dict[int, Fraction]] = {}
    for row in rows:
        current = dict(row)
        for place in sorted(pivots):
            if place in current:
                add_to(current, pivots[place], -current[place])
        places = [x for x in current if x != last]
        if not places:
            if current.get(last):
                return None
            continue
        pivot = min(places)
        scale = current[pivot]
        current = {x: q / scale for x, q in current.items()}
        for other in pivots.values():
            if pivot in other:
                add_to(other, current, -other[pivot])
        pivots[pivot] = current
    return pivots
