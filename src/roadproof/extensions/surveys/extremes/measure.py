"""Measures of drives, whose least or greatest value is searched: a term at the start, or at a moment."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.errors import UsageError
from roadproof.extensions.surveys.composition import comparison
from roadproof.library.compose import both, eventually
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.specification import Query, Specification
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import declarations_text
from roadproof.logic.syntax import Binding, Expression
from roadproof.logic.terms import Dimension, Inverse, Term, Varying, leaves

Sense: TypeAlias = Literal["least", "greatest"]


@dataclass(frozen=True)
class DriveMeasure:
    """The least or greatest value (``sense``) of ``term``, at time 0 or when the formula ``moment`` holds.

    ``text`` and ``when``: term and moment as the user wrote them; ``written``: the term as a tree. They are
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
        """The factor that turns a better value into a smaller one."""
        return 1 if self.sense == "least" else -1

    def bound(self, value: Fraction | None) -> list[Query]:
        """Return the conditions that the measure is ``value`` or better (None: that its moment occurs)."""
        op: Literal["<=", ">="] = "<=" if self.sense == "least" else ">="
        here = (
            []
            if value is None
            else [comparison(self.home, self.given, self.written, op, value, self.dimension)]
        )
        return here if self.moment is None else [eventually(both(self.moment, *here))]


def read_measure(
    specification: Specification, sense: Sense, text: str, when: str = "", given: tuple[Binding, ...] = ()
) -> DriveMeasure:
    """Return a measure from the text of a user, in the names ``given`` of a formula.

    Raises ``TextError``, and ``UsageError`` for a term that is the same on all drives.
    """
    head = declarations_text(given)
    term, dimension = read_term(specification, head + text, f"--{sense}")
    if isinstance(term, Inverse):
        raise UsageError(f"--{sense} '{text}': 1/x may be infinite; ask for the other extreme of x")
    if not any(isinstance(leaf, Varying) for leaf in leaves(term)):
        raise UsageError(f"--{sense} '{text}': no drive changes this; name a signal, such as v_lon(SV)")
    moment = read_claim(specification, head + when, "--when") if when else None
    written = parse_claim(head + text).body
    return DriveMeasure(sense, text, written, term, dimension, specification, when, moment, given)


def between(one: Fraction, other: Fraction, grains: tuple[Fraction, ...] = ()) -> Fraction:
    """Return a short number strictly between two, near the middle.

    It is a multiple of the first of ``grains`` that has one, or else the shortest decimal in the middle half.

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
