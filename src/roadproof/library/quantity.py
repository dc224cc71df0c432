"""Terms with their dimensions, and the size of a formula, counted without writing it out.

Calls are replaced by the bodies of definitions, which share sub-trees. Forty definitions that each use the
one before twice are therefore a small object, and a formula of 2^40 parts. To walk through it would never
end, so it is refused as soon as it is made.
"""

from collections.abc import Iterable
from dataclasses import field
from typing import TypeAlias, cast, get_args

from roadproof.errors import Position, TextError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.terms import Term
from roadproof.runtime.records import dataclass
from roadproof.world.units import SI, UNITS, Dimension

SECONDS: Dimension = (0, 1)
DURATION = "duration"
"""The sort of times that are never negative; only definitions have such arguments."""


def dimension_of(sort: str) -> Dimension:
    """Return the dimension of a number that is declared with a unit, or as a duration."""
    return UNITS["s" if sort == DURATION else sort][1]


@dataclass(frozen=True)
class Quantity:
    """A term with its dimension; None fits every dimension (the literal 0)."""

    term: t.Term
    dimension: Dimension | None


def same_dimension(left: Quantity, right: Quantity, what: str, at: Position) -> Dimension | None:
    """Return the common dimension of two quantities. Raises ``TextError`` if they differ.

    ``what``: the participle of the operation in the message, such as "added".
    """
    if left.dimension is None or right.dimension is None or left.dimension == right.dimension:
        return right.dimension if left.dimension is None else left.dimension
    plain = t.constant_value(right.term) is not None or t.constant_value(left.term) is not None
    missing = plain and (0, 0) in (left.dimension, right.dimension)
    unit = unit_name(left.dimension if right.dimension == (0, 0) else right.dimension)
    hint = f"The number has no unit: write it with {unit}." if missing else ""
    if plain and right.dimension == (-left.dimension[0], -left.dimension[1]):
        unit = unit_name(left.dimension if t.constant_value(left.term) is None else right.dimension)
        hint = f"3/4 {unit} is 3 divided by 4 {unit}: write a decimal, such as 0.75 {unit}."
    raise TextError(
        f"{unit_name(left.dimension)} and {unit_name(right.dimension)} cannot be {what}", at, hint
    )


def unit_name(dimension: Dimension | None) -> str:
    """Return a dimension as a unit: (1, -2) is m/s^2."""
    if dimension is None or dimension == (0, 0):
        return "no unit"
    return SI.get(dimension) or f"m^{dimension[0]}*s^{dimension[1]}"


def product_dimension(left: Quantity, right: Quantity, sign: int) -> Dimension | None:
    """Return the dimension of a product (``sign`` 1) or a quotient (-1); None if one of them has none."""
    if left.dimension is None or right.dimension is None:
        return None
    return (left.dimension[0] + sign * right.dimension[0], left.dimension[1] + sign * right.dimension[1])


LARGEST_FORMULA = 400_000  # parts; roadproof's own largest formula has 150,000
MOST_READ = 100_000  # expressions for one claim; roadproof's own claims need 4,000

Tree: TypeAlias = "Formula | Term"


@dataclass
class Sizes:
    """A counter of formula parts for one elaboration; it keeps counted trees, so that no id is reused."""

    known: dict[int, tuple[int, Tree]] = field(default_factory=dict)
    read: int = 0

    def count_reading(self, at: Position) -> None:
        """Count one more expression. Raises ``TextError`` beyond ``MOST_READ``."""
        self.read += 1
        if self.read > MOST_READ:
            raise TextError(
                f"definitions and formula together have more than {MOST_READ} expressions when they are read",
                at,
                "Look for quantifiers over vehicles inside each other.",
            )

    def check(self, tree: Tree, at: Position) -> None:
        """Raise ``TextError`` if ``tree`` has more than ``LARGEST_FORMULA`` parts."""
        if self.size(tree) > LARGEST_FORMULA:
            raise TextError(
                f"the formula has more than {LARGEST_FORMULA} parts once its definitions are written out",
                at,
                "Look for definitions that use others several times each, or for powers of powers.",
            )

    def size(self, tree: Tree) -> int:
        """Return the number of parts of ``tree``; a power counts as a product."""
        counted = self.known.get(id(tree))
        if counted is None:
            counted = self.known[id(tree)] = (self._count(tree), tree)
        return counted[0]

    def _count(self, tree: Tree) -> int:
        if isinstance(tree, t.Power):
            return 1 + self.size(tree.base) * max(1, tree.exponent)
        if isinstance(tree, f.Compare):
            return 1 + self.size(tree.left) + self.size(tree.right)
        inside: Iterable[Tree] = _children(tree)
        count = 1
        for child in inside:
            count += self.size(child)
        return count


_FORMULAS: tuple[type, ...] = get_args(Formula)


def _children(tree: Tree) -> Iterable[Tree]:
    # isinstance is faster with a tuple of classes than with a union, and this runs for every part.
    return f.children(cast(Formula, tree)) if isinstance(tree, _FORMULAS) else t.children(cast(Term, tree))
