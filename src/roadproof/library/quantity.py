"""Terms with their dimensions, and how large a formula is, counted without writing it out.

Definitions are put in place of their calls, and calls share what they have in common; so forty definitions
that each use the one before twice are a small object and a formula of 2^40 parts. Whoever walks through it
would never end, so it is refused as soon as it is made.
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
from roadproof.world.units import SI, Dimension

SECONDS: Dimension = (0, 1)


@dataclass(frozen=True)
class Quantity:
    """A term with its dimension; ``dimension`` None fits every dimension (the literal 0)."""

    term: t.Term
    dimension: Dimension | None


def same_dimension(left: Quantity, right: Quantity, what: str, at: Position) -> Dimension | None:
    """The dimension that both have; ``what`` is done with them. Raises ``TextError`` where they differ."""
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
    """A dimension as a unit: (1, -2) is m/s^2."""
    if dimension is None or dimension == (0, 0):
        return "no unit"
    return SI.get(dimension) or f"m^{dimension[0]}*s^{dimension[1]}"


def product_dimension(left: Quantity, right: Quantity, sign: int) -> Dimension | None:
    """The dimension of a product (``sign`` 1) or a quotient (-1); None where one has none."""
    if left.dimension is None or right.dimension is None:
        return None
    return (left.dimension[0] + sign * right.dimension[0], left.dimension[1] + sign * right.dimension[1])


LARGEST_FORMULA = 400_000  # parts; the largest that roadproof writes itself has 150,000
MOST_READ = 100_000  # expressions that are read for one claim; there, 4,000

Tree: TypeAlias = "Formula | Term"


@dataclass
class Sizes:
    """Counts what is made while one claim is read; what was counted is kept, so that no id is used twice."""

    known: dict[int, tuple[int, Tree]] = field(default_factory=dict)
    read: int = 0

    def count_reading(self, at: Position) -> None:
        """One more expression is read. Raises ``TextError`` beyond ``MOST_READ``."""
        self.read += 1
        if self.read > MOST_READ:
            raise TextError(
                f"definitions and formula together have more than {MOST_READ} expressions when they are read",
                at,
                "Look for quantifiers over vehicles inside each other.",
            )

    def check(self, tree: Tree, at: Position) -> None:
        """Raises ``TextError`` where ``tree`` has more than ``LARGEST_FORMULA`` parts."""
        if self.size(tree) > LARGEST_FORMULA:
            raise TextError(
                f"the formula has more than {LARGEST_FORMULA} parts once its definitions are written out",
                at,
                "Look for definitions that use others several times each, or for powers of powers.",
            )

    def size(self, tree: Tree) -> int:
        """The number of parts of ``tree``; a power counts as the product that it is."""
        found = self.known.get(id(tree))
        if found is None:
            found = self.known[id(tree)] = (self._count(tree), tree)
        return found[0]

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
    # A tuple of classes is looked up faster than a union of them, and this is asked of every part.
    return f.children(cast(Formula, tree)) if isinstance(tree, _FORMULAS) else t.children(cast(Term, tree))
