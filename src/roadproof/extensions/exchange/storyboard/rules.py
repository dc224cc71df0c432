"""Rules by which OpenSCENARIO compares values."""

import math
from collections.abc import Callable, Mapping

RULES: Mapping[str, Callable[[float, float], bool]] = {
    "greaterThan": lambda x, y: x > y,
    "lessThan": lambda x, y: x < y,
    "equalTo": lambda x, y: math.isclose(x, y, abs_tol=1e-6),
    "notEqualTo": lambda x, y: not math.isclose(x, y, abs_tol=1e-6),
    "greaterOrEqual": lambda x, y: x >= y,
    "lessOrEqual": lambda x, y: x <= y,
}


def texts_compare(rule: str, one: str, other: str) -> bool:
    """Compare two texts, as numbers where both are. Raises ``ValueError`` that says why they cannot be."""
    if rule not in RULES:
        raise ValueError(f"rule={rule}: one of {', '.join(RULES)} is needed")
    try:
        return RULES[rule](float(one), float(other))
    except ValueError:
        pass
    if rule not in ("equalTo", "notEqualTo"):
        raise ValueError(f"rule={rule}: {one} or {other} is no number")
    return (one == other) == (rule == "equalTo")
