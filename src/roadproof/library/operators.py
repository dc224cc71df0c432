"""The formulas of temporal operators and of edges."""

from typing import assert_never

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.syntax import TemporalOperator
from roadproof.logic.terms import Term


def temporal(op: TemporalOperator, left: Formula, interval: f.Interval, right: Formula) -> Formula:
    """Return the formula of a temporal operator; ``left`` counts for those with two sides."""
    match op:
        case "U":
            return f.Until(left, interval, right)
        case "S":
            return f.Since(left, interval, right)
        case "W":
            return f.weak_until(left, interval, right)
        case "R":
            return f.release(left, interval, right)
        case "F":
            return f.Eventually(interval, right)
        case "G":
            return f.Always(interval, right)
        case "O":
            return f.once(interval, right)
        case "H":
            return f.historically(interval, right)
        case _:
            assert_never(op)


def edge(name: str, body: Formula, time: Term) -> Formula:
    """Return ``rise(body, time)``: it holds, and did not at some instant of the last ``time``.

    Any other ``name`` is ``fall``: the same of its negation.
    """
    now, before = (body, f.negation(body)) if name == "rise" else (f.negation(body), body)
    return f.conjunction(now, f.once(f.Interval(f.ZERO, time), before))
