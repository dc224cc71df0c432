"""Vehicles and other objects of an OpenSCENARIO file."""

import math

from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class ObjectBox:
    """An object's class, what the file calls it, and its box.

    ``limits``: of its speed (m/s), acceleration and deceleration (m/s²), by its Performance.
    ``centre`` is that of the box, ahead and left of the reference point (m). ``recorded``: it is a motor
    vehicle; others move too, but are no part of the recording.
    """

    kind: str
    label: str
    length: float
    width: float
    centre: tuple[float, float]
    recorded: bool = True
    limits: tuple[float, float, float] = (math.inf, math.inf, math.inf)
