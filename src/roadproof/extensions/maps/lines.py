"""Lines of measured points in the plane: even ones, the reference line of a road, and where two cross."""

import math
from fractions import Fraction

import numpy as np

from roadproof.extensions.maps.topology import Floats
from roadproof.world.curves import Polyline, length_of
from roadproof.world.reference_line import Part, ReferenceLine

_MILLI = 1000
_SMOOTHING, _NEAR = (4.0, 2.0, 1.0, 0.5), 0.3
"""Standard deviations in points, and how far (m) a smooth line is at most from a measured one."""
_APART = 1e-3
"""Metres: points that are nearer to each other are one."""


def even_line(line: Floats, step: float = 5.0) -> Floats:
    """The polyline (m, 2) with vertices about ``step`` metres apart, so that its kinks are those of the road.

    Lanelets have vertices centimetres apart, whose rounded coordinates turn the line by a degree and back.
    """
    way = way_along(line)
    return resampled(line, 1 + max(1, round(float(way[-1]) / step)))


def resampled(line: Floats, count: int) -> Floats:
    """``count`` points of a line, equally far from each other along it."""
    way = way_along(line)
    at = np.linspace(0, way[-1], count)
    return np.stack((np.interp(at, way, line[:, 0]), np.interp(at, way, line[:, 1])), axis=1)


def thinned(line: Floats, least: float) -> Floats:
    """The points of a line, its ends included, without those that are nearer than ``least`` m to the last."""
    indices = [0]
    for k in range(1, len(line) - 1):
        if float(np.hypot(*(line[k] - line[indices[-1]]))) >= least:
            indices.append(k)
    return line[[*indices, len(line) - 1]]


def joined(lines: list[Floats]) -> Floats:
    """Lines that follow each other as one."""
    points = np.concatenate(lines)
    apart = np.concatenate(([True], np.hypot(*np.diff(points, axis=0).T) > _APART))
    return points[apart]


def reference_line(line: Floats) -> ReferenceLine:
    """A smooth line within 0.3 m of a measured one, from s = 0 on; points are 5 m apart, rounded to mm.

    Edges of lanelets are measured from it, so no lane has that error. Noise of points would be bends.
    """
    points = [(to_millimetre(x), to_millimetre(y)) for x, y in _smooth(even_line(line)).tolist()]
    (x0, y0), *_ = points
    curve = Polyline(tuple((x - x0, y - y0) for x, y in points))
    return ReferenceLine((Part(Fraction(0), to_millimetre(length_of(curve)), x0, y0, Fraction(0), curve),))


def crossing(one: Floats, other: Floats, ends: float) -> tuple[float, float] | None:
    """A point (m) where two polylines cross, more than ``ends`` m from the ends of both; None without one."""
    low, high = np.maximum(one.min(axis=0), other.min(axis=0)), np.minimum(one.max(axis=0), other.max(axis=0))
    if (low > high).any():
        return None
    p, r = one[:-1, None, :], np.diff(one, axis=0)[:, None, :]
    q, t = other[None, :-1, :], np.diff(other, axis=0)[None, :, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        across = _cross_product(r, t)
        along, beside = _cross_product(q - p, t) / across, _cross_product(q - p, r) / across
        met = np.argwhere((along >= 0) & (along < 1) & (beside >= 0) & (beside < 1))
    for i, k in met.tolist():
        point = one[i] + along[i, k] * (one[i + 1] - one[i])
        borders = np.stack((one[0], one[-1], other[0], other[-1]))
        if float(np.hypot(*(borders - point).T).min()) > ends:
            return float(point[0]), float(point[1])
    return None


def _smooth(line: Floats) -> Floats:
    """Means of points around each, weighted by a normal distribution: the widest that stays near the line."""
    for wide in _SMOOTHING:
        reach = min(math.ceil(3 * wide), len(line) - 1)
        weights = np.exp(-((np.arange(-reach, reach + 1) / wide) ** 2) / 2)
        before = 2 * line[0] - line[reach:0:-1]
        after = 2 * line[-1] - line[-2 : -reach - 2 : -1]
        longer = np.concatenate((before, line, after))
        columns = [np.convolve(x, weights / weights.sum(), "valid") for x in longer.T]
        smooth: Floats = np.stack(columns, axis=1)
        if float(np.hypot(*(smooth - line).T).max()) <= _NEAR:
            return smooth
    return line


def _cross_product(one: Floats, other: Floats) -> Floats:
    product: Floats = one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]
    return product


def way_along(line: Floats) -> Floats:
    """Return how far along the line its points are (m)."""
    return np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))


def to_millimetre(metres: float) -> Fraction:
    """A length rounded to a millimetre."""
    return Fraction(round(metres * _MILLI), _MILLI)
