"""Plates: a driver model over a plane of initial values; and the file that says where a formula holds."""

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Annotated, TypeAlias

from roadproof.evidence.codec import Doc, Rule
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES, ManoeuvreName, Plane, plane_of
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.extensions.drivers import lines as drawn

Range: TypeAlias = tuple[Fraction, Fraction]


@dataclass(frozen=True, kw_only=True)
class Plate:
    """One model over the plane of two initial values, in SI units."""

    manoeuvre: ManoeuvreName
    model: Annotated[str, Rule(least=1), Doc("The driver model.")]
    fixed: Annotated[Mapping[str, Fraction], Doc("Initial values that all places share, by name.")]
    along: Annotated[Range, Doc("The range of the initial value that each line runs along.")]
    across: Annotated[Range, Doc("The range of the initial value that differs from line to line.")]
    lines: Annotated[int, Rule(minimum=2), Doc("How many lines there are.")]

    @property
    def plane(self) -> Plane:
        """The plane of the plate. Raises ``UsageError``."""
        return plane_of(MANOEUVRES[self.manoeuvre], self.fixed, self.along, self.across, self.lines)


@dataclass(frozen=True, kw_only=True)
class SpanEndData:
    """An end of a span."""

    near: Annotated[float, Doc("Rounded to a millionth.")]
    exact: Annotated[
        str, Rule(least=1), Doc("The number, or the polynomial of which it is the root that is near.")
    ]


@dataclass(frozen=True, kw_only=True)
class PlateLineData:
    """A line of a plate with the spans in which a collision is unpreventable."""

    at: Annotated[Fraction, Doc("The initial value that differs from line to line, in SI units.")]
    unpreventable: Annotated[
        tuple[tuple[SpanEndData, SpanEndData], ...],
        Doc(
            "Spans of the line in which the formula is true, from and to; on a stepped plate, first and last "
            "of neighbouring places at which it is."
        ),
    ]

    @staticmethod
    def of(line: "drawn.PlateLine") -> "PlateLineData":
        """Return a line as files have it."""
        spans = tuple(
            (SpanEndData(near=a.near, exact=a.exact), SpanEndData(near=b.near, exact=b.exact))
            for a, b in line.spans
        )
        return PlateLineData(at=line.at, unpreventable=spans)

    @property
    def drawn(self) -> "drawn.PlateLine":
        """The inverse of ``of``."""
        from roadproof.extensions.drivers import lines as drawn

        spans = (
            (drawn.SpanEnd(float(a.near), a.exact), drawn.SpanEnd(float(b.near), b.exact))
            for a, b in self.unpreventable
        )
        return drawn.PlateLine(self.at, tuple(spans))
