"""The lines of a plate: on each, between which values a collision is unpreventable, with its exact ends."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from roadproof.judge.algebraic import Point, Root, approximate
from roadproof.judge.truth import TruthSet
from roadproof.logic.formula import Formula
from roadproof.preventing.boundary import Plane, line
from roadproof.preventing.models import unpreventable
from roadproof.spec.bind import bind
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Specification
from roadproof.world.road import Road

_PLACES = 6
_NO_ROAD = Road("none", (), frozenset())


@dataclass(frozen=True)
class End:
    """An end of a span: a number near it, and what it is exactly: a fraction, or a root of a polynomial."""

    near: float
    exact: str


@dataclass(frozen=True)
class Line:
    """At a value of the other side (SI), where along the line a collision is unpreventable.

    Of a controller that is stepped, spans are from the first to the last of neighbouring places looked at.
    """

    at: Fraction
    spans: tuple[tuple[End, End], ...]


def boundary_formula(
    specification: Specification, plane: Plane, model: str, values: Mapping[str, Fraction]
) -> Formula:
    """The boundary of a model with a formula, bound to ``values`` of all parameters (SI)."""
    text = unpreventable(plane.manoeuvre.name, model, plane.manoeuvre.vehicles)
    return bind(read_claim(specification, text).formula, _NO_ROAD, {}, values)


def told_line(row: Fraction, true: TruthSet) -> Line:
    """Where a formula is true on a row's line, told."""
    spans = tuple((end_of(x.begin.point), end_of(x.end.point)) for x in true.spans() if x.end is not None)
    return Line(row, spans)


def lines_of(plane: Plane, formula: Formula) -> Iterator[Line]:
    """The lines of a plane, in order, where a bound formula is true on them."""
    return (told_line(row, line(plane, formula, row)) for row in plane.rows)


def end_of(point: Point) -> End:
    """A point of a line, told."""
    if isinstance(point, Root):
        return End(round(approximate(point), _PLACES), f"root of {list(point.polynomial)}, constant first")
    return End(round(float(point), _PLACES), str(point))


def line_data(told: Line) -> dict[str, Any]:
    """A line as plain data."""
    spans = [[{"near": end.near, "exact": end.exact} for end in span] for span in told.spans]
    return {"at": str(told.at), "unpreventable": spans}


def read_line(said: Mapping[str, Any]) -> Line:
    """A line from plain data."""
    spans = tuple((End(a["near"], a["exact"]), End(b["near"], b["exact"])) for a, b in said["unpreventable"])
    return Line(Fraction(said["at"]), spans)
