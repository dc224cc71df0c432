"""Cubics by s, added up, and their extremes."""

import math
from collections.abc import Iterable
from fractions import Fraction

from roadproof.extensions.maps.opendrive import CubicPiece
from roadproof.world.curves import Coefficients

_ZERO = Fraction(0)


def sum_of_cubics(pieces: Iterable[tuple[int, CubicPiece]], begin: Fraction) -> Coefficients:
    """Signed cubics added up, by the distance from ``begin``."""
    sums = [_ZERO] * 4
    for sign, piece in pieces:
        a, b, c, d = piece.coefficients
        x = begin - piece.s
        moved = (a + x * (b + x * (c + x * d)), b + x * (2 * c + 3 * x * d), c + 3 * x * d, d)
        sums = [y + sign * z for y, z in zip(sums, moved, strict=True)]
    return sums[0], sums[1], sums[2], sums[3]


def extremes(cubic: Coefficients, length: Fraction) -> tuple[Fraction, Fraction]:
    """The least and the greatest value from 0 to ``length``."""
    a, b, c, d = cubic
    places = [
        _ZERO,
        length,
        *(x for x in map(Fraction, _stationary_points(*map(float, (b, c, d)))) if 0 < x < length),
    ]
    values = [a + x * (b + x * (c + x * d)) for x in places]
    return min(values), max(values)


def _stationary_points(b: float, c: float, d: float) -> list[float]:
    """Return where b + 2·c·x + 3·d·x² is 0."""
    if d == 0:
        return [] if c == 0 else [-b / (2 * c)]
    square = c * c - 3 * b * d
    if square < 0:
        return []
    return [(-c + sign * math.sqrt(square)) / (3 * d) for sign in (1, -1)]
