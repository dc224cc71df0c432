"""Where a formula about one instant is true along a line of initial values: exactly.

The judge reads signals as polynomials in time. Here what runs is an initial value, so its set of instants is
the set of values at which the formula is true, with algebraic ends.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.drivers.manoeuvres import Manoeuvre, Values, along_line, is_possible, spread
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.truth import NEVER, TruthSet
from roadproof.semantics.exact.within import truth_within


@dataclass(frozen=True)
class Plane:
    """Initial values of a manoeuvre: ``fixed``, and two that vary in ranges (SI), in so many lines.

    The lines run along ``manoeuvre.line``, one for each value of ``manoeuvre.across``.
    """

    manoeuvre: Manoeuvre
    fixed: Values
    along: tuple[Fraction, Fraction]
    across: tuple[Fraction, Fraction]
    lines: int = 100

    @property
    def rows(self) -> Sequence[Fraction]:
        """The values of the other side."""
        return spread(*self.across, self.lines)

    def values(self, row: Fraction, place: Fraction | None = None) -> dict[str, Fraction]:
        """All initial values at a row, and at a place on its line (its beginning where None)."""
        here = {self.manoeuvre.across: row, self.manoeuvre.line: self.along[0] if place is None else place}
        return self.manoeuvre.values({**self.fixed, **here})


def plane_of(
    manoeuvre: Manoeuvre,
    fixed: Values,
    along: tuple[Fraction, Fraction],
    across: tuple[Fraction, Fraction],
    lines: int,
) -> Plane:
    """The plane of a plate: up to where POV would go backwards. Raises ``UsageError``."""
    low, high = across
    if manoeuvre.across == "dV0":
        high = min(high, manoeuvre.values(fixed)["Ve0"])
    return Plane(manoeuvre, fixed, along, (low, high), lines)


def line(plane: Plane, formula: Formula, row: Fraction) -> TruthSet:
    """At which places of a row's line a bound formula is true; nowhere where a vehicle would go backwards."""
    values = plane.values(row)
    if not is_possible(values):
        return NEVER
    signals = along_line(plane.manoeuvre, values)
    return truth_within(formula, signals, *plane.along)
