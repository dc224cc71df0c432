"""Comparisons of numbers that stand for Boolean custom signals and for kinds of vehicles.

A Boolean custom signal is a number compared with 1/2. A kind is a number that never changes, compared with
3/2, 5/2, … So every number, be it a measured 0 or 1 or any real of a solver, stands for exactly one truth
value, and every number above zero for exactly one kind.
"""

from collections.abc import Iterable
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare, Comparison, Formula
from roadproof.logic.rewrite import leaves_of
from roadproof.logic.syntax import SignalDeclaration
from roadproof.world.signals import KINDS, Kind
from roadproof.world.units import SI, UNITS

HALF = Fraction(1, 2)
UNCONSTRAINED = "unconstrained: any function of time"


def custom_signal(declared: SignalDeclaration, vehicle: str) -> t.CustomSignal:
    """Return the term of a declared custom signal, of a vehicle or of none ('')."""
    if declared.sort == "bool":
        return t.CustomSignal(declared.name, vehicle, truth=True)
    factor, dimension = UNITS[declared.sort]
    low, high = (None if end is None else end * factor for end in (declared.low, declared.high))
    return t.CustomSignal(declared.name, vehicle, dimension, low, high)


def signal_is_true(signal: t.CustomSignal) -> Formula:
    """Return the formula "this Boolean custom signal is true"."""
    return Compare(signal, ">", t.number(HALF))


def code_of(kind: Kind) -> int:
    """Return the number that stands for a kind: 1, 2, …"""
    return KINDS.index(kind) + 1


def kind_of(number: Fraction) -> Kind:
    """Return the kind that a number above zero stands for: that of the nearest code.

    >>> kind_of(Fraction(7, 4)), kind_of(Fraction(9))
    ('truck', 'other')
    """
    return KINDS[max(0, min(len(KINDS), int(number + HALF)) - 1)]


def is_kind(vehicle: str, kind: Kind, positive: bool = True) -> Formula:
    """Return the formula "this vehicle is of this kind" ("of another kind" if not ``positive``)."""
    low = from_kind(vehicle, ">=" if positive else "<", kind)
    high = Compare(t.Size("kind", vehicle), "<" if positive else ">=", t.number(code_of(kind) + HALF))
    if kind in (KINDS[0], KINDS[-1]):
        return high if kind == KINDS[0] else low
    return f.And((low, high)) if positive else f.Or((low, high))


def from_kind(vehicle: str, op: Comparison, kind: Kind) -> Formula:
    """Return the formula "this vehicle is of this kind or a later one" (``>=``) or "of an earlier one"
    (``<``).
    """
    return Compare(t.Size("kind", vehicle), op, t.number(code_of(kind) - HALF))


def custom_signals_of(formulas: Iterable[Formula]) -> tuple[t.CustomSignal, ...]:
    """Return the custom signals in the formulas, each with each of its vehicles, by name and vehicle."""
    signals = {leaf for leaf in leaves_of(*formulas) if isinstance(leaf, t.CustomSignal)}
    return tuple(sorted(signals, key=lambda x: (x.name, x.vehicle)))


def vehicles_with_kind(formula: Formula) -> tuple[str, ...]:
    """Return the vehicles whose kind the formula compares, by name."""
    sizes = (x for x in leaves_of(formula) if isinstance(x, t.Size))
    return tuple(sorted({x.vehicle for x in sizes if x.name == "kind"}))


def assumptions_on_signals(formula: Formula) -> dict[str, str]:
    """Return what an answer assumes about each custom signal of a formula, by name of the signal."""
    return {signal.name: assumption_on_signal(signal) for signal in custom_signals_of([formula])}


def freedom_lines(formula: Formula) -> tuple[str, ...]:
    """Return the assumptions on custom signals as lines: ``jerk is unconstrained: any function of time``."""
    return tuple(f"{name} is {assumption}" for name, assumption in assumptions_on_signals(formula).items())


def assumption_on_signal(signal: t.CustomSignal) -> str:
    """Return what an answer assumes about a custom signal: no constraint, or a range."""
    if signal.truth or (signal.low is None and signal.high is None):
        return UNCONSTRAINED
    return f"any function of time within {range_text(signal.low, signal.high, signal.dimension)}"


def refuse_value(signal: t.CustomSignal, value: Fraction | float, where: str, source: str = "") -> None:
    """Raise ``InputError`` for a value outside the declaration of a signal; ``source`` starts the message."""
    if signal.truth and value not in (0, 1):
        raise InputError(
            f"{source}{signal.text}={float(value):g} {where}: it is declared bool, so it is false or true, "
            "0 or 1"
        )
    low, high = signal.low, signal.high
    if (low is not None and value < low) or (high is not None and value > high):
        raise InputError(
            f"{source}{signal.text}={float(value):g} {where}: signal {signal.name} is declared within "
            f"{range_text(low, high, signal.dimension)}"
        )


def range_text(low: Fraction | None, high: Fraction | None, dimension: t.Dimension) -> str:
    """Return a range as text: ``[-10, inf] m/s^3``."""
    unit = "" if dimension == (0, 0) else f" {SI.get(dimension, '')}"
    return f"[{'-inf' if low is None else low}, {'inf' if high is None else high}]{unit}"
