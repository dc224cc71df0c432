"""Places on examples/maps/motorway.xodr, whose curvature is integrated twice; no code of roads is asked."""

from functools import cache

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
_FINE = np.linspace(0, 1600, 1_600_001)
"""Every millimetre."""


def curvature_at(s: Floats) -> Floats:
    """1/m at places of the reference line: two lines, two clothoids and an arc of 400 m between them."""
    return np.interp(s, [0, 300, 420, 1020, 1140, 1600], [0, 0, 1 / 400, 1 / 400, 0, 0])


@cache
def _line() -> tuple[Floats, Floats, Floats]:
    """x, y and direction of the reference line, every millimetre."""
    curvature = curvature_at(_FINE)
    step = _FINE[1] - _FINE[0]
    heading = 0.7 + np.concatenate(([0], np.cumsum((curvature[1:] + curvature[:-1]) / 2 * step)))
    middle = (heading[1:] + heading[:-1]) / 2
    x = 300 + np.concatenate(([0], np.cumsum(np.cos(middle) * step)))
    y = -150 + np.concatenate(([0], np.cumsum(np.sin(middle) * step)))
    return x, y, heading


def integrated(s: Floats, d: Floats) -> Floats:
    """Rows of x, y (m) and the direction of the road (rad) at places of the road."""
    x, y, turned = (np.interp(s, _FINE, values) for values in _line())
    return np.stack((x - d * np.sin(turned), y + d * np.cos(turned), turned))
