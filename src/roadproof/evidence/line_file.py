"""The reference line of a road in drive files."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from roadproof.errors import InputError
from roadproof.evidence.answers import drive as kept
from roadproof.world.curves import Coefficients, Cubic, Curve, Line, Polyline, Spiral
from roadproof.world.reference_line import Part, ReferenceLine


def line_said(line: ReferenceLine | None) -> tuple[kept.Curve, ...]:
    """A line as files hold it; nothing where there is none."""
    return () if line is None else tuple(map(_part_said, line.parts))


def _part_said(part: Part) -> kept.Curve:
    curve = part.curve
    cubic, spiral = isinstance(curve, Cubic), isinstance(curve, Spiral)
    return kept.Curve(
        kind="cubic" if cubic else "spiral" if spiral else "line" if isinstance(curve, Line) else "polyline",
        **{name: getattr(part, name) for name in ("s", "length", "x", "y", "heading", "backward", "offset")},
        curvature=(curve.begin, curve.end) if isinstance(curve, Spiral) else None,
        u=curve.u if isinstance(curve, Cubic) else (),
        v=curve.v if isinstance(curve, Cubic) else (),
        last=curve.last if isinstance(curve, Cubic) else None,
        points=curve.points if isinstance(curve, Polyline) else (),
    )


def line_of(said: Sequence[kept.Curve], where: str) -> ReferenceLine | None:
    """The inverse of ``line_said``. Raises ``InputError``."""
    if not said:
        return None
    parts = tuple(_part(x, f"{where}, line {k}") for k, x in enumerate(said, 1))
    for k, (before, after) in enumerate(pairwise(parts), 2):
        if after.s < before.s:
            raise InputError(f"{where}, line {k}: s={after.s}: parts follow each other in s")
    return ReferenceLine(parts)


def _part(said: kept.Curve, where: str) -> Part:
    if said.length <= 0:
        raise InputError(f"{where}: length={said.length}: a part is longer than 0 m")
    try:
        part = Part(
            *(said.s, said.length, said.x, said.y, said.heading),
            _curve(said, where),
            said.backward,
            said.offset,
        )
        list(part.bends())
        part.pose(float(part.s))
    except (ValueError, ZeroDivisionError, OverflowError) as error:
        raise InputError(f"{where}: {error}") from None
    return part


def _curve(said: kept.Curve, where: str) -> Curve:
    match said.kind:
        case "line":
            return Line()
        case "spiral":
            if said.curvature is None:
                raise InputError(f"{where}: curvature is missing; a spiral has it")
            return Spiral(*said.curvature)
        case "cubic":
            return Cubic(_four(said.u, f"{where}, u"), _four(said.v, f"{where}, v"), said.last)
        case "polyline":
            if len(said.points) < 2 or any(said.points[0]):
                raise InputError(f"{where}: points: two or more are needed, the first [0, 0]")
            return Polyline(said.points)


def _four(numbers: tuple[Fraction, ...], where: str) -> Coefficients:
    if len(numbers) != 4:
        raise InputError(f"{where}: {len(numbers)} coefficients; a cubic has 4")
    a, b, c, d = numbers
    return a, b, c, d
