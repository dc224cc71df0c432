"""Cubics through places at given knots, with the slopes that three places in a row have."""

import numpy as np

from roadproof.extensions.traffic.formats.recording import Floats


def curve(knots: Floats, places: Floats, at: Floats) -> tuple[Floats, Floats, Floats]:
    """Return place and its first two derivatives ``at`` values between knots, on the cubics through
    ``places``.
    """
    slopes = _slopes(knots, places)
    k = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(knots) - 2)
    step = knots[k + 1] - knots[k]
    x = (at - knots[k]) / step
    rise = places[k + 1] - places[k]
    low, high = slopes[k] * step, slopes[k + 1] * step
    square, cube = 3 * rise - 2 * low - high, low + high - 2 * rise
    place = places[k] + x * (low + x * (square + x * cube))
    return place, (low + x * (2 * square + 3 * x * cube)) / step, (2 * square + 6 * x * cube) / step**2


def _slopes(knots: Floats, places: Floats) -> Floats:
    """Return at each knot the slope of the parabola through it and its neighbours."""
    means = np.diff(places) / np.diff(knots)
    if len(means) == 1:
        return np.repeat(means, 2)
    before, after = np.diff(knots)[:-1], np.diff(knots)[1:]
    inside = (after * means[:-1] + before * means[1:]) / (before + after)
    return np.concatenate(([2 * means[0] - inside[0]], inside, [2 * means[-1] - inside[-1]]))
