"""Vehicles of an OpenSCENARIO file."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Box:
    """A vehicle's class, what the file calls it, and its box.

    ``centre`` is that of the box, ahead and left of the reference point (m).
    """

    kind: str
    label: str
    length: float
    width: float
    centre: tuple[float, float]
