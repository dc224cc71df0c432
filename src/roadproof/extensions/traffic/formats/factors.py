"""Factors by which a signal of a recording is off everywhere: a turned sign, km/h, or another one."""

import numpy as np

from roadproof.extensions.traffic.formats.recording import Floats

_FACTORS = ((-1.0, "the sign is turned"), (0.0, "zero"), (3.6, "km/h?"), (2.237, "miles an hour?"))


def _known_factor(factor: float) -> float | None:
    """The factor of a known fault that this is, nearly; None where it is none."""
    near = (x for x, _ in _FACTORS if np.isfinite(factor) and abs(factor - x) < 0.05 * max(1, abs(x)))
    return next(near, None)


def common_factor(factors: Floats, median: float, places: int) -> float | None:
    """The factor of a known fault near the median, or the median where most places agree on it."""
    known = _known_factor(median)
    if known is not None or not np.isfinite(median):
        return known
    agree = int(np.count_nonzero(np.abs(factors - median) <= 0.05 * abs(median)))
    return median if 2 * agree > places else None


def hint_on(factor: float) -> str:
    """The factor between values and changes of others as text, with a known cause; empty where none is."""
    if not np.isfinite(factor):
        return ""
    known = _known_factor(factor)
    cause = "" if known is None else f": {dict(_FACTORS)[known]}"
    return f", by a factor of {factor:.3g}{cause}"
