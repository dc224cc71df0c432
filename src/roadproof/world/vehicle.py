"""What a vehicle can do: its box and the limits of its motion (SPEC §2)."""

from dataclasses import dataclass
from fractions import Fraction

Range = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Vehicle:
    """A point mass with a box. Lengths in m, speeds in m/s, accelerations in m/s².

    ``lateral_share``: |v_lat| is at most this share of v_lon, which keeps the heading below
    arctan(share); ``cruise`` is the range of speeds that a natural drive starts with, and
    ``jump_lon`` and ``jump_lat`` bound how far the acceleration of a natural drive
    changes from one piece to the next.
    """

    name: str
    length: Fraction
    width: Fraction
    v_lon: Range
    v_lat: Range
    a_lon: Range
    a_lat: Range
    lateral_share: Fraction
    cruise: Range
    jump_lon: Fraction
    jump_lat: Fraction
