"""What users name: own signals that are true or false, and kinds of vehicles, as comparisons of numbers.

An own signal that is true or false is a number compared with 1/2, and a kind is a number that never changes,
compared with 3/2, 5/2, …: so every number that a reader may take for one, a measured 0 or 1 or any real of a
solver, stands for exactly one truth, and every number above zero for exactly one kind.
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


def own_signal(declared: SignalDeclaration, vehicle: str) -> t.Own:
    """An own signal as it is declared, of a vehicle or of none ('')."""
    if declared.sort == "bool":
        return t.Own(declared.name, vehicle, truth=True)
    factor, dimension = UNITS[declared.sort]
    low, high = (None if end is None else end * factor for end in (declared.low, declared.high))
    return t.Own(declared.name, vehicle, dimension, low, high)


def own_truth(signal: t.Own) -> Formula:
    """That an own signal is true."""
    return Compare(signal, ">", t.number(HALF))


def code_of(kind: Kind) -> int:
    """The number that stands for a kind: 1, 2, …"""
    return KINDS.index(kind) + 1


def kind_of(number: Fraction) -> Kind:
    """The kind that a number above zero stands for; inverse to ``code_of``, and the same for all near it.

    >>> kind_of(Fraction(7, 4)), kind_of(Fraction(9))
    ('truck', 'other')
    """
    return KINDS[max(0, min(len(KINDS), int(number + HALF)) - 1)]


def is_kind(vehicle: str, kind: Kind, positive: bool = True) -> Formula:
    """That a vehicle is of a kind, or, where not ``positive``, that it is of another."""
    low = from_kind(vehicle, ">=" if positive else "<", kind)
    high = Compare(t.Size("kind", vehicle), "<" if positive else ">=", t.number(code_of(kind) + HALF))
    if kind in (KINDS[0], KINDS[-1]):
        return high if kind == KINDS[0] else low
    return f.And((low, high)) if positive else f.Or((low, high))


def from_kind(vehicle: str, op: Comparison, kind: Kind) -> Formula:
    """That a vehicle is of this kind or a later one (``>=``), or of an earlier one (``<``)."""
    return Compare(t.Size("kind", vehicle), op, t.number(code_of(kind) - HALF))


def own_of(formulas: Iterable[Formula]) -> tuple[t.Own, ...]:
    """The own signals that occur, each of each vehicle, by name and vehicle."""
    found = {leaf for leaf in leaves_of(*formulas) if isinstance(leaf, t.Own)}
    return tuple(sorted(found, key=lambda x: (x.name, x.vehicle)))


def vehicles_with_kind(formula: Formula) -> tuple[str, ...]:
    """The vehicles whose kind matters, by name."""
    sizes = (x for x in leaves_of(formula) if isinstance(x, t.Size))
    return tuple(sorted({x.vehicle for x in sizes if x.name == "kind"}))


def freedom(formula: Formula) -> dict[str, str]:
    """What an answer supposes of the own signals of a formula, by their names."""
    return {signal.name: freedom_of(signal) for signal in own_of([formula])}


def told_freedom(formula: Formula) -> tuple[str, ...]:
    """As ``freedom``, a line for each signal: ``jerk is unconstrained: any function of time``."""
    return tuple(f"{name} is {said}" for name, said in freedom(formula).items())


def freedom_of(signal: t.Own) -> str:
    """What is supposed of an own signal."""
    if signal.truth or (signal.low is None and signal.high is None):
        return UNCONSTRAINED
    return f"any function of time within {told_range(signal.low, signal.high, signal.dimension)}"


def refuse_value(signal: t.Own, value: Fraction | float, where: str, source: str = "") -> None:
    """Raise ``InputError`` for a value that the declaration of a signal excludes; ``source`` begins it."""
    if signal.truth and value not in (0, 1):
        raise InputError(
            f"{source}{signal.told}={float(value):g} {where}: it is declared bool, so it is false or true, "
            "0 or 1"
        )
    low, high = signal.low, signal.high
    if (low is not None and value < low) or (high is not None and value > high):
        raise InputError(
            f"{source}{signal.told}={float(value):g} {where}: signal {signal.name} is declared within "
            f"{told_range(low, high, signal.dimension)}"
        )


def told_range(low: Fraction | None, high: Fraction | None, dimension: t.Dimension) -> str:
    """A range in words: ``[-10, inf] m/s^3``."""
    unit = "" if dimension == (0, 0) else f" {SI.get(dimension, '')}"
    return f"[{'-inf' if low is None else low}, {'inf' if high is None else high}]{unit}"
