"""A number to be made as small or as great as possible on drives: a term at the start, or at some moment."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.errors import UsageError
from roadproof.library.compose import both, comparison, eventually
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.specification import Query, Specification
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import declared
from roadproof.logic.syntax import Binding, Expression
from roadproof.logic.terms import Dimension, Inverse, Term, Varying, leaves

Sense: TypeAlias = Literal["least", "greatest"]


@dataclass(frozen=True)
class Measure:
    """The ``sense`` value of ``term``, at time 0 or at some ``moment`` at which that holds.

    ``text`` and ``when`` are how a user wrote term and moment; ``written`` is the term as a tree. They are
    read with the definitions of ``home`` and the names in ``given``.
    """

    sense: Sense
    text: str
    written: Expression
    term: Term
    dimension: Dimension
    home: Specification
    when: str = ""
    moment: Query | None = None
    given: tuple[Binding, ...] = ()

    @property
    def sign(self) -> int:
        """What turns a better value into a smaller one."""
        return 1 if self.sense == "least" else -1

    def bound(self, value: Fraction | None) -> list[Query]:
        """That the measure is ``value`` or better (None: that there is a moment for it), as parts."""
        op: Literal["<=", ">="] = "<=" if self.sense == "least" else ">="
        here = (
            []
            if value is None
            else [comparison(self.home, self.given, self.written, op, value, self.dimension)]
        )
        return here if self.moment is None else [eventually(both(self.moment, *here))]


def read_measure(
    specification: Specification, sense: Sense, text: str, when: str = "", given: tuple[Binding, ...] = ()
) -> Measure:
    """A measure from what the user wrote, in the names that a formula has in its ``given``.

    Raises ``TextError``, and ``UsageError`` for what no drive changes.
    """
    head = declared(given)
    term, dimension = read_term(specification, head + text, f"--{sense}")
    if isinstance(term, Inverse):
        raise UsageError(f"--{sense} '{text}': 1/x may be infinite; ask for the other extreme of x")
    if not any(isinstance(leaf, Varying) for leaf in leaves(term)):
        raise UsageError(f"--{sense} '{text}': no drive changes this; name a signal, such as v_lon(SV)")
    moment = read_claim(specification, head + when, "--when") if when else None
    written = parse_claim(head + text).body
    return Measure(sense, text, written, term, dimension, specification, when, moment, given)


def between(one: Fraction, other: Fraction, grains: tuple[Fraction, ...] = ()) -> Fraction:
    """A plain number strictly between two: a multiple of the first grain that has one, near the middle.

    Else the decimal with the fewest digits in the middle half.

    >>> str(between(Fraction(0), Fraction(3), (Fraction(3, 5),))), str(between(Fraction(1, 3), Fraction(1)))
    ('6/5', '7/10')
    """
    low, high = sorted((one, other))
    middle, quarter = (low + high) / 2, (high - low) / 4
    for grain in grains:
        multiple = round(middle / grain) * grain
        if low < multiple < high:
            return multiple
    for digits in range(-9, 12):
        unit = Fraction(10) ** -digits
        rounded = round(middle / unit) * unit
        if low + quarter <= rounded <= high - quarter:
            return rounded
    return middle
