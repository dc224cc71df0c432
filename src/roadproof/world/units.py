"""The table of units of specifications, claims, models and answers."""

from collections.abc import Mapping
from fractions import Fraction
from typing import TypeAlias

# Exponents of metre and second: (1, -2) is an acceleration.
Dimension: TypeAlias = tuple[int, int]

# By name: the factor to the SI unit of the same dimension, and the dimension.
UNITS: Mapping[str, tuple[Fraction, Dimension]] = {
    "s": (Fraction(1), (0, 1)),
    "ms": (Fraction(1, 1000), (0, 1)),
    "m": (Fraction(1), (1, 0)),
    "m/s": (Fraction(1), (1, -1)),
    "km/h": (Fraction(5, 18), (1, -1)),
    "m/s^2": (Fraction(1), (1, -2)),
    "m/s^3": (Fraction(1), (1, -3)),
    "1/s": (Fraction(1), (0, -1)),
    "unitless": (Fraction(1), (0, 0)),
}
SI: Mapping[Dimension, str] = {dimension: unit for unit, (factor, dimension) in UNITS.items() if factor == 1}


def unit_text(dimension: Dimension) -> str:
    """Return the unit in which values of ``dimension`` are printed; empty for no dimension."""
    if dimension == (0, 0):
        return ""
    metres, seconds = dimension
    return SI.get(dimension) or f"m^{metres} s^{seconds}"
