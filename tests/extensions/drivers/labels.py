"""Labels of many initial values at once, in floating point: for tables and statistics, not for evidence."""

from collections.abc import Mapping
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from roadproof.extensions.drivers.manoeuvres import BESIDE, Manoeuvre, signals_of
from roadproof.logic.formula import Formula
from roadproof.logic.terms import SizeName
from roadproof.semantics.sampled import Batch, compile

Floats = NDArray[np.float64]


def labels(
    manoeuvre: Manoeuvre, formulas: Mapping[str, Formula], values: Mapping[str, Floats]
) -> dict[str, NDArray[np.bool_]]:
    """Where each bound formula about one instant is true, for initial values of shape (cases,), SI units."""
    cases = len(values["Ve0"])
    every = {
        name: np.broadcast_to(np.asarray(values.get(name, float(x.value)), dtype=np.float64), (cases,))
        for name, x in manoeuvre.quantities.items()
    }
    every.setdefault("dy0", np.full(cases, float(BESIDE)))
    state = signals_of(manoeuvre, every)
    boxes: tuple[SizeName, SizeName] = ("length", "width")
    sizes = {(size, vehicle): every[size] for vehicle in manoeuvre.vehicles for size in boxes}
    signals = {key: np.asarray(value, dtype=np.float64)[None, :] for key, value in state.items()}
    batch = Batch(Fraction(1), np.ones(cases, dtype=np.int64), signals, sizes)
    found = compile(formulas).evaluate(batch)
    return {name: found.answers[name].true for name in formulas}
