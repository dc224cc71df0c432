"""Places on the WGS84 ellipsoid in the plane: transverse Mercator around a point, and UTM."""

import math
from typing import TypeAlias

import numpy as np

from roadproof.extensions.maps.topology import Floats

UtmPoint: TypeAlias = tuple[float, float]
"""Easting and northing in m."""
_AXIS, _FLATTENING = 6_378_137.0, 1 / 298.257223563
_SQUARE = _FLATTENING * (2 - _FLATTENING)
_SCALE, _EASTING = 0.9996, 500_000.0


def transverse_mercator(
    latitude: float, longitude: float, origin: tuple[float, float]
) -> tuple[float, float]:
    """Return x (east) and y (north) of ``origin`` (m), from degrees. The scale at the origin is 1."""
    phi = math.radians(latitude)
    second = _SQUARE / (1 - _SQUARE)
    n = _AXIS / math.sqrt(1 - _SQUARE * math.sin(phi) ** 2)
    t, c = math.tan(phi) ** 2, second * math.cos(phi) ** 2
    a = math.radians(longitude - origin[1]) * math.cos(phi)
    x = n * (a + (1 - t + c) * a**3 / 6 + (5 - 18 * t + t**2 + 72 * c - 58 * second) * a**5 / 120)
    rise = n * math.tan(phi) * (a**2 / 2 + (5 - t + 9 * c + 4 * c**2) * a**4 / 24)
    return x, _meridian(phi) - _meridian(math.radians(origin[0])) + rise


def _meridian(phi: float) -> float:
    """Metres from the equator along a meridian (Snyder, equation 3-21)."""
    e2, e4, e6 = _SQUARE, _SQUARE**2, _SQUARE**3
    return _AXIS * (
        (1 - e2 / 4 - 3 * e4 / 64 - 5 * e6 / 256) * phi
        - (3 * e2 / 8 + 3 * e4 / 32 + 45 * e6 / 1024) * math.sin(2 * phi)
        + (15 * e4 / 256 + 45 * e6 / 1024) * math.sin(4 * phi)
        - 35 * e6 / 3072 * math.sin(6 * phi)
    )


def utm_of(lat: Floats, lon: Floats) -> Floats:
    """Easting and northing (n, 2) in metres of points in degrees, in the zone of the first.

    >>> [round(float(x), 2) for x in utm_of(np.array([50.0]), np.array([9.0]))[0]]
    [500000.0, 5538630.7]
    """
    middle = math.radians(6 * math.floor((float(lon[0]) + 180) / 6) - 177)
    n = _FLATTENING / (2 - _FLATTENING)
    radius = _AXIS / (1 + n) * (1 + n**2 / 4 + n**4 / 64)
    series = (
        n / 2 - 2 * n**2 / 3 + 5 * n**3 / 16 + 41 * n**4 / 180,
        13 * n**2 / 48 - 3 * n**3 / 5 + 557 * n**4 / 1440,
        61 * n**3 / 240 - 103 * n**4 / 140,
        49561 * n**4 / 161280,
    )
    eccentric = 2 * math.sqrt(n) / (1 + n)
    sine, turn = np.sin(np.radians(lat)), np.radians(lon) - middle
    t = np.sinh(np.arctanh(sine) - eccentric * np.arctanh(eccentric * sine))
    xi, eta = np.arctan2(t, np.cos(turn)), np.arctanh(np.sin(turn) / np.hypot(1, t))
    east, north = eta.copy(), xi.copy()
    for k, factor in enumerate(series, start=1):
        east += factor * np.cos(2 * k * xi) * np.sinh(2 * k * eta)
        north += factor * np.sin(2 * k * xi) * np.cosh(2 * k * eta)
    scale = _SCALE * radius
    return np.stack((_EASTING + scale * east, scale * north + np.where(lat < 0, 1e7, 0.0)), axis=1)
