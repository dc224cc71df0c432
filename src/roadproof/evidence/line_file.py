"""The JSON form of a road's reference line in drive files."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from roadproof.errors import InputError
from roadproof.evidence.answers import drive as json_types
from roadproof.world.curves import Coefficients, Cubic, Curve, Line, Polyline, Spiral
from roadproof.world.reference_line import Part, ReferenceLine


def line_data(line: ReferenceLine) -> tuple[json_types.CurveData, ...]:
    """Return the JSON form of a reference line."""
    return tuple(map(_part_data, line.parts))


def _part_data(part: Part) -> json_types.CurveData:
    curve = part.curve
    cubic, spiral = isinstance(curve, Cubic), isinstance(curve, Spiral)
    return json_types.CurveData(
        kind="cubic" if cubic else "spiral" if spiral else "line" if isinstance(curve, Line) else "polyline",
        **{name: getattr(part, name) for name in ("s", "length", "x", "y", "heading", "backward", "offset")},
        curvature=(curve.begin, curve.end) if isinstance(curve, Spiral) else None,
        u=curve.u if isinstance(curve, Cubic) else (),
        v=curve.v if isinstance(curve, Cubic) else (),
        last=curve.last if isinstance(curve, Cubic) else None,
        points=curve.points if isinstance(curve, Polyline) else (),
    )


def line_of(stored: Sequence[json_types.CurveData], where: str) -> ReferenceLine:
    """Return the reference line of its JSON form, the inverse of ``line_data``. Raises ``InputError``."""
    parts = tuple(_part(x, f"{where}, line {k}") for k, x in enumerate(stored, 1))
    for k, (before, after) in enumerate(pairwise(parts), 2):
        if after.s < before.s:
            raise InputError(f"{where}, line {k}: s={after.s}: parts follow each other in s")
    return ReferenceLine(parts)


def _part(stored: json_types.CurveData, where: str) -> Part:
    if stored.length <= 0:
        raise InputError(f"{where}: length={stored.length}: a part is longer than 0 m")
    try:
        part = Part(
            *(stored.s, stored.length, stored.x, stored.y, stored.heading),
            _curve(stored, where),
            stored.backward,
            stored.offset,
        )
        list(part.bends())
        part.pose(float(part.s))
    except (ValueError, ZeroDivisionError, OverflowError) as error:
        raise InputError(f"{where}: {error}") from None
    return part


def _curve(stored: json_types.CurveData, where: str) -> Curve:
    match stored.kind:
        case "line":
            return Line()
        case "spiral":
            if stored.curvature is None:
                raise InputError(f"{where}: curvature is missing; a spiral has it")
            return Spiral(*stored.curvature)
        case "cubic":
            return Cubic(_four(stored.u, f"{where}, u"), _four(stored.v, f"{where}, v"), stored.last)
        case "polyline":
            if len(stored.points) < 2 or any(stored.points[0]):
                raise InputError(f"{where}: points: two or more are needed, the first [0, 0]")
            return Polyline(stored.points)


def _four(numbers: tuple[Fraction, ...], where: str) -> Coefficients:
    if len(numbers) != 4:
        raise InputError(f"{where}: {len(numbers)} coefficients; a cubic has 4")
    a, b, c, d = numbers
    return a, b, c, d
