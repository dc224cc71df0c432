"""A formula as a value that can be asked about, combined and written down."""

from dataclasses import dataclass

from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.show import text


@dataclass(frozen=True)
class Query:
    """A formula in the definitions of one specification, with the names that are free in it.

    ``claim`` is what is said, as a tree, and ``formula`` what it means; ``written`` is how a user wrote
    it, empty where it was put together. ``vehicles``: those that are declared, then others by name;
    ``lanes``: free lanes by name.
    """

    claim: syntax.Claim
    formula: Formula
    vehicles: tuple[str, ...]
    lanes: tuple[str, ...]
    written: str = ""

    @property
    def text(self) -> str:
        """The query as text, which reads as the same query."""
        return self.written or text(self.claim)
