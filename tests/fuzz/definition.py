"""STL by its definition on samples that are held: each until the next, the last for ever. Exact, and slow.

Signals that are constant between multiples of DT, and windows that are multiples of it, make dense time
and samples the same: a window that begins at a sample sees just the samples in it. So every reader of a
formula can be asked about one trace.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from proving.claims import value_of
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of

DT = Fraction(1, 2)


@dataclass(frozen=True)
class Held:
    """``signals``: values at the samples 0, DT, …; ``sizes``: of the vehicles. Keys such as ``s(SV)``."""

    signals: Mapping[str, tuple[Fraction, ...]]
    sizes: Mapping[str, Fraction]

    @property
    def samples(self) -> int:
        return len(next(iter(self.signals.values())))

    def values(self, sample: int) -> dict[str, Fraction]:
        return {name: values[sample] for name, values in self.signals.items()} | dict(self.sizes)


class Definition:
    """The truth of formulas at each sample of a trace."""

    def __init__(self, trace: Held) -> None:
        self.trace, self.last = trace, trace.samples - 1
        self.values = [trace.values(k) for k in range(trace.samples)]
        self.known: dict[tuple[Formula, int], bool] = {}

    def holds(self, formula: Formula, k: int) -> bool:
        k = min(k, self.last)
        if (formula, k) not in self.known:
            self.known[formula, k] = self._holds(formula, k)
        return self.known[formula, k]

    def _holds(self, formula: Formula, k: int) -> bool:
        match formula:
            case f.Truth(value):
                return value
            case f.Compare(left, op, right):
                x, y = value_of(left, self.values[k]), value_of(right, self.values[k])
                return {"<": x < y, "<=": x <= y, ">": x > y, ">=": x >= y}[op]
            case f.Not(body):
                return not self.holds(body, k)
            case f.And(parts):
                return all(self.holds(part, k) for part in parts)
            case f.Or(parts):
                return any(self.holds(part, k) for part in parts)
            case f.Application(_, _, body):
                return self.holds(body, k)
            case f.Eventually(interval, body):
                return any(self.holds(body, j) for j in self.window(interval, k))
            case f.Always(interval, body):
                return all(self.holds(body, j) for j in self.window(interval, k))
            case f.Until(left, interval, right):
                for j in self.window(interval, k):
                    if self.holds(right, j):
                        return True
                    if not self.holds(left, j):
                        return False
                return False
        raise AssertionError(formula)

    def window(self, interval: f.Interval, k: int) -> range:
        """The samples in k + interval; those after the last look like it, so one of them is enough."""
        low, high = bounds_of(interval)
        first = k + int(low / DT)
        beyond = max(first, self.last)
        return range(first, 1 + (beyond if high is None else min(k + int(high / DT), beyond)))
