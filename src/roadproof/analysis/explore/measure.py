"""What is measured on a drive: a term, at the start or at a moment, and which way is better."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.analysis.explore.text import compared, eventually, expression
from roadproof.errors import UsageError
from roadproof.logic.syntax import Expression
from roadproof.logic.terms import Dimension, Inverse, Signal, Term, leaves
from roadproof.spec.elaborate import read_claim, read_term
from roadproof.spec.library import Specification

Sense: TypeAlias = Literal["least", "greatest"]


@dataclass(frozen=True)
class Measure:
    """The ``sense`` value of ``text``, at time 0 or at some moment at which ``when`` holds."""

    sense: Sense
    text: str
    term: Term
    dimension: Dimension
    when: str = ""

    @property
    def sign(self) -> int:
        """What turns a better value into a smaller one."""
        return 1 if self.sense == "least" else -1

    def bound(self, value: Fraction | None) -> list[Expression]:
        """That the measure is ``value`` or better (None: that there is a moment for it), as parts."""
        op: Literal["<=", ">="] = "<=" if self.sense == "least" else ">="
        here = [] if value is None else [compared(expression(self.text), op, value, self.dimension)]
        if not self.when:
            return here
        return [eventually([expression(self.when), *here])]


def read_measure(
    specification: Specification, sense: Sense, text: str, when: str = "", given: str = ""
) -> Measure:
    """A measure from what the user wrote; ``given`` declares names in front of it.

    Raises ``TextError``, and ``UsageError`` for what no drive changes.
    """
    term, dimension = read_term(specification, given + text, f"--{sense}")
    if isinstance(term, Inverse):
        raise UsageError(f"--{sense} '{text}': 1/x may be infinite; ask for the other extreme of x")
    if not any(isinstance(leaf, Signal) for leaf in leaves(term)):
        raise UsageError(f"--{sense} '{text}': no drive changes this; name a signal, such as v_lon(SV)")
    if when:
        read_claim(specification, given + when, "--when")
    return Measure(sense, text, term, dimension, when)
