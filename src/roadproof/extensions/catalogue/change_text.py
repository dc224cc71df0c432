"""The change of one vehicle that would make a comparison true, in words that a person would use."""

from collections.abc import Mapping
from fractions import Fraction
from math import ceil, log10
from typing import TypeAlias

from roadproof.library.scenario_names import SUBJECT
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.terms import Term
from roadproof.world.signals import SIGNALS, SignalName
from roadproof.world.units import SI, UNITS

Values: TypeAlias = Mapping[t.Signal | t.Size, Fraction]
_ALONG: Mapping[str, tuple[str, str]] = {
    "m": ("further ahead", "further back"),
    "m/s": ("faster", "slower"),
    "m/s^2": ("more acceleration", "less acceleration"),
}
_ACROSS: Mapping[str, tuple[str, str]] = {
    "m": ("further left", "further right"),
    "m/s": ("faster to the left", "faster to the right"),
    "m/s^2": ("more acceleration to the left", "more acceleration to the right"),
}
"""What a greater and a smaller value of a signal is called, by its unit."""


def change_text(comparison: f.Compare, op: f.Comparison, values: Values) -> str:
    """Return which vehicle would have to be where, or how fast, for ``left op right`` to hold.

    ``values`` (SI): those of the signals and sizes of the comparison, which is false. One signal is changed,
    of a vehicle other than SV where there is one; "" where no signal moves a side by as much as itself.
    """
    leaves = (*t.leaves(comparison.left), *t.leaves(comparison.right))
    if not all(isinstance(x, t.Number | t.Signal | t.Size) for x in leaves):
        return ""
    lack = _difference(comparison, values)
    for signal in sorted(_signals(values), key=lambda x: (x.vehicle == SUBJECT, x.vehicle, x.name)):
        slope = _difference(comparison, {**values, signal: values[signal] + 1}) - lack
        words = (_ACROSS if _is_across(signal.name) else _ALONG).get(SIGNALS[signal.name].unit)
        if abs(slope) != 1 or words is None:
            continue
        needed = -lack / slope
        if _difference(comparison, {**values, signal: values[signal] + needed}) != 0:
            continue  # the slope changes on the way
        rises = needed > 0 if needed else (op in (">", ">=")) == (slope > 0)
        unit = SI[UNITS[SIGNALS[signal.name].unit][1]]
        amount = f"at least {_rounded(abs(needed))} {unit}" if needed else "a little"
        more, less = words
        verb = "need" if more.startswith("more") else "have to be"
        return f"{signal.vehicle} would {verb} {amount} {more if rises else less} then"
    return ""


def _is_across(name: SignalName) -> bool:
    return name == "d" or name.endswith("lat")


def _signals(values: Values) -> list[t.Signal]:
    return [x for x in values if isinstance(x, t.Signal)]


def _difference(comparison: f.Compare, values: Values) -> Fraction:
    """Return by how much the left side is above the right one."""

    def put_in(leaf: t.Leaf) -> Term:
        return t.number(values[leaf]) if isinstance(leaf, t.Signal | t.Size) else leaf

    value = t.constant_value(t.replace_leaves(t.subtract(comparison.left, comparison.right), put_in))
    assert value is not None  # the leaves are numbers, and no inverse is ever to blame
    return value


def _rounded(amount: Fraction) -> str:
    """Return an amount rounded up to three digits."""
    digits = 2 - (ceil(log10(float(amount))) - 1)
    step = Fraction(10) ** -digits
    return f"{float(ceil(amount / step) * step):.6g}"
