"""Inductions over steps of time, as formulas that are true on every trace.

Both take numbers above zero as times, so that finitely many steps reach every later instant.
"""

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.terms import Term


def steps(inside: Formula, low: Term, high: Term) -> Formula:
    """What holds, and holds again ``low`` to ``high`` after each instant at which it does, never ends.

    With p at T there are instants T = t0 < t1 < … with p and t(n) + low <= t(n+1) <= t(n) + high. They pass
    every bound, since low > 0, so that every later instant has one of them at most ``high`` after it. Raises
    ``ValueError``.
    """
    _check(low)
    _check(high)
    again = f.Always(f.FOREVER, f.implication(inside, f.Eventually(f.Interval(low, high), inside)))
    always = f.Always(f.FOREVER, f.Eventually(f.Interval(f.ZERO, high), inside))
    return f.Always(f.FOREVER, f.implication(f.conjunction(inside, again), always))


def lasts(inside: Formula, time: Term) -> Formula:
    """What holds, and lasts for a ``time`` after each instant at which it holds, holds for ever.

    With p at T it holds from T + n·d to T + (n + 1)·d for every n. Raises ``ValueError``.
    """
    _check(time)
    kept = f.Always(f.FOREVER, f.implication(inside, f.Always(f.Interval(f.ZERO, time), inside)))
    return f.Always(f.FOREVER, f.implication(f.conjunction(inside, kept), f.Always(f.FOREVER, inside)))


def _check(time: Term) -> None:
    value = t.constant_value(time)
    if value is None or value <= 0:
        raise ValueError("a step of time must be a number above 0")
