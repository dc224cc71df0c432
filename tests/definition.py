"""STL by its definition (semantics §1) on samples of which the last stands for all later time."""

from collections.abc import Callable, Container, Mapping, Sequence
from fractions import Fraction
from math import prod

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of


class Definition:
    """The truth of formulas at each sample.

    ``atom`` is the truth of a comparison at a sample, and of each formula in ``given``.
    """

    def __init__(
        self,
        last: int,
        dt: Fraction,
        atom: Callable[[Formula, int], bool],
        given: Container[Formula] = (),
    ) -> None:
        self.last, self.dt, self.atom, self.given = last, dt, atom, given
        self.known: dict[tuple[Formula, int], bool] = {}

    def holds(self, formula: Formula, k: int = 0) -> bool:
        k = min(k, self._end(formula))
        if (formula, k) not in self.known:
            self.known[formula, k] = self._holds(formula, k)
        return self.known[formula, k]

    def _holds(self, formula: Formula, k: int) -> bool:
        match formula:
            case f.Truth(value):
                return value
            case f.Not(body):
                return not self.holds(body, k)
            case f.And(parts):
                return all(self.holds(part, k) for part in parts)
            case f.Or(parts):
                return any(self.holds(part, k) for part in parts)
            case f.Application(_, _, body) if formula not in self.given:
                return self.holds(body, k)
            case f.Eventually(interval, body):
                return any(self.holds(body, j) for j in self._window(formula, interval, k))
            case f.Always(interval, body):
                return all(self.holds(body, j) for j in self._window(formula, interval, k))
            case f.Until(left, interval, right):
                window = self._window(formula, interval, k)
                return any(
                    self.holds(right, j) and all(self.holds(left, i) for i in window[:n])
                    for n, j in enumerate(window)
                )
            case f.Since(left, interval, right):
                low, high = bounds_of(interval)
                past = range(
                    0 if high is None else max(0, k - int(high / self.dt)), k - int(low / self.dt) + 1
                )
                return any(
                    self.holds(right, j) and all(self.holds(left, i) for i in range(j + 1, past.stop))
                    for j in past
                )
        return self.atom(formula, min(k, self.last))

    def _end(self, formula: Formula) -> int:
        """A sample from which on nothing changes: the last, and all times by which parts look back."""
        back = [bounds_of(x.interval) for x in f.subformulas(formula) if isinstance(x, f.Since)]
        return self.last + sum(int((low if high is None else high) / self.dt) for low, high in back)

    def _window(self, formula: Formula, interval: f.Interval, k: int) -> range:
        """The samples in k + interval; those after the end look like it, so one of them is enough."""
        low, high = bounds_of(interval)
        first = k + int(low / self.dt)
        beyond = max(first, self._end(formula))
        return range(first, 1 + (beyond if high is None else min(k + int(high / self.dt), beyond)))


def of_values(samples: Sequence[Mapping[str, Fraction]], dt: Fraction = Fraction(1)) -> Definition:
    """The reading of signals and sizes by their names, such as ``s(SV)``, at each sample."""
    return Definition(len(samples) - 1, dt, lambda formula, k: compare(formula, samples[k]))


def compare(formula: Formula, values: Mapping[str, Fraction]) -> bool:
    assert isinstance(formula, f.Compare), formula
    x, y = value_of(formula.left, values), value_of(formula.right, values)
    return {"<": x < y, "<=": x <= y, ">": x > y, ">=": x >= y}[formula.op]


def value_of(term: t.Term, values: Mapping[str, Fraction]) -> Fraction | float:
    match term:
        case t.Number(value, _):
            return value
        case t.Parameter(name, _) | t.Variable(name, _):
            return values.get(name, Fraction(0))
        case t.Signal(name, vehicle):
            return values.get(f"{name}({vehicle})", Fraction(0))
        case t.Size(name, vehicle):
            return values.get(f"{name}({vehicle})", {"length": Fraction(9, 2), "width": Fraction(9, 5)}[name])
        case t.Inverse(inner):
            below = value_of(inner, values)
            return 1 / below if below else float("inf")
        case t.Power(inner, exponent):
            return value_of(inner, values) ** exponent
        case t.Quotient(upper, lower):
            return value_of(upper, values) / value_of(lower, values)
    parts = [value_of(child, values) for child in t.children(term)]
    match term:
        case t.Sum():
            return sum(parts, Fraction(0))
        case t.Product():
            return prod(parts, start=Fraction(1))
        case t.Maximum():
            return max(parts)
        case t.Minimum():
            return min(parts)
    raise AssertionError(term)
