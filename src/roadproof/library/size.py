"""How large a formula is when it is written out, counted without writing it out.

Definitions are put in place of their calls, and calls share what they have in common; so forty definitions
that each use the one before twice are a small object and a formula of 2^40 parts. Whoever walks through it
would never end, so it is refused as soon as it is made.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TypeAlias, cast, get_args

from roadproof.errors import Position, TextError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.terms import Term

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
