"""Comparisons of kinds of vehicles: ``kind(a) = truck``, ``kind(a) >= car``, ``kind(a) = kind(b)``."""

from collections.abc import Callable

from roadproof.errors import TextError
from roadproof.logic import custom_names, syntax
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.syntax import Expression
from roadproof.world.signals import KINDS


def compare(expression: syntax.Binary, vehicle_of: Callable[[Expression], str]) -> Formula:
    """Return the formula of a comparison with ``kind(a)`` on at least one side; < and >= use the order of
    kinds.

    ``vehicle_of`` returns the name of the vehicle in ``kind(a)``. Raises ``TextError`` if the other side is
    no kind, or the comparison is not defined for kinds.
    """
    left, right, op = expression.left, expression.right, expression.op
    if not syntax.is_kind(left):
        left, right = right, left
    vehicle = vehicle_of(left)
    if syntax.is_kind(right) and op in ("=", "!="):
        other = vehicle_of(right)
        same_kind = (f.And((custom_names.is_kind(vehicle, k), custom_names.is_kind(other, k))) for k in KINDS)
        same = f.disjunction(*same_kind)
        return same if op == "=" else f.negation(same)
    kind = next((k for k in KINDS if isinstance(right, syntax.Name) and right.name == k), None)
    if kind is None:
        shown = right.name if isinstance(right, syntax.Name | syntax.Call) else "this"
        raise TextError(
            f"kind({vehicle}) is compared with '{shown}', which is no kind of vehicle",
            right.at,
            f"Kinds are {', '.join(KINDS)}: write kind({vehicle}) = {KINDS[1]}.",
        )
    if op in ("<", ">=") and kind != KINDS[0] and left is expression.left:
        return custom_names.from_kind(vehicle, "<" if op == "<" else ">=", kind)
    if op not in ("=", "!="):
        raise TextError("kinds are compared with = and != only", expression.at)
    return custom_names.is_kind(vehicle, kind, op == "=")
