"""Linear constraints on moments that can be added and retracted, with multipliers of each contradiction.

The simplex method for satisfiability (Dutertre and de Moura 2006) in exact rationals. Each linear form has a
variable, constraints bound these variables, and strict bounds have an infinitesimal part. A conflict is an
absurd sum of constraints (Farkas), which Coq adds up again. Integers are ``int`` inside, since most numbers
are integers and ``Fraction`` is slow.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias, TypeVar

from roadproof.evidence.times import Moment

# Multipliers by constraint, all above zero; GOAL is the negation of what was asked.
Witness: TypeAlias = tuple[tuple[int, Fraction], ...]
GOAL = -1

_Number: TypeAlias = int | Fraction
N = TypeVar("N", Fraction, int | Fraction)
_Form: TypeAlias = tuple[tuple[str, _Number], ...]
_Value: TypeAlias = tuple[_Number, _Number]  # a rational and a multiple of the infinitesimal

_NOTHING: _Value = (0, 0)


@dataclass(frozen=True)
class _Bound:
    value: _Value
    constraint: int
    scale: _Number  # the constraint is scale times what the bound says, scale > 0


@dataclass
class LinearConstraints:
    """Constraints ``0 <= m`` and ``0 < m`` for moments m, each with a number."""

    rows: dict[int, dict[int, _Number]] = field(default_factory=dict)  # basic variable: over the others
    forms: dict[_Form, int] = field(default_factory=dict)
    lower: dict[int, _Bound] = field(default_factory=dict)
    upper: dict[int, _Bound] = field(default_factory=dict)
    values: dict[int, _Value] = field(default_factory=dict)
    trail: list[tuple[bool, int, _Bound | None]] = field(default_factory=list)
    count: int = 0

    @contextmanager
    def taken_back(self) -> Iterator[None]:
        """Retract at the end all constraints that are added inside."""
        mark = len(self.trail)
        try:
            yield
        finally:
            while len(self.trail) > mark:
                is_upper, variable, before = self.trail.pop()
                bounds = self.upper if is_upper else self.lower
                if before is None:
                    del bounds[variable]
                else:
                    bounds[variable] = before

    def add(self, constraint: int, strict: bool, moment: Moment) -> Witness | None:
        """Add ``0 <= moment`` (``0 < moment`` if strict); return multipliers of a contradiction, or None."""
        if not moment.parts:
            absurd = moment.constant < 0 or (strict and moment.constant == 0)
            return ((constraint, Fraction(1)),) if absurd else None
        first = moment.parts[0][1]
        variable = self._variable(tuple((name, _quotient(factor, first)) for name, factor in moment.parts))
        edge, scale = _quotient(-moment.constant, first), _quotient(abs(first), 1)
        infinitesimal = int(strict) if first > 0 else -int(strict)
        return self._bound(first < 0, variable, _Bound((edge, infinitesimal), constraint, scale))

    def entails(self, moment: Moment, strict: bool = False) -> Witness | None:
        """Return multipliers that prove ``0 <= moment`` (``0 < moment``); None if it does not follow.

        The constraints so far must be consistent.
        """
        if not moment.parts or not self._refuted(moment, strict):
            count_before = len(self.values)
            with self.taken_back():
                witness = self.add(GOAL, not strict, Moment() - moment)
            if len(self.values) > count_before:
                self._forget(count_before)
            return witness
        return None

    def _refuted(self, moment: Moment, strict: bool) -> bool:
        """Return whether the current values, which satisfy all constraints, violate the inequality."""
        self._repair()
        total, small = _quotient(moment.constant, 1), _quotient(0, 1)
        for name, share in moment.parts:
            place = self.forms.get(((name, 1),))
            if place is None:
                return True  # nothing is known of it
            value, factor = self.values[place], _quotient(share, 1)
            total += factor * value[0]
            small += factor * value[1]
        return (total, small) <= _NOTHING if strict else (total, small) < _NOTHING

    # --- forms -------------------------------------------------------------------------------------

    def _variable(self, form: _Form) -> int:
        """Return the variable of a form, with a row if the form is a sum of others."""
        if form in self.forms:
            return self.forms[form]
        row: dict[int, _Number] = {}
        if len(form) > 1 or form[0][1] != 1:
            for name, factor in form:
                part = self._variable(((name, 1),))
                add_to(row, self.rows.get(part, {part: 1}), factor)
        variable = self.count
        self.count += 1
        self.forms[form] = variable
        self.values[variable] = self._value_of(row)
        if row:
            self.rows[variable] = row
        return variable

    def _value_of(self, row: Mapping[int, _Number]) -> _Value:
        return (
            sum(q * self.values[x][0] for x, q in row.items()),
            sum(q * self.values[x][1] for x, q in row.items()),
        )

    def _forget(self, count_before: int) -> None:
        """Delete the sums that no constraint uses any more."""
        self._repair()  # who becomes free to choose has to be within its bounds
        for form in list(self.forms)[::-1][: len(self.values) - count_before]:
            variable = self.forms[form]
            if len(form) == 1:
                continue
            if variable not in self.rows:
                self._pivot(next(basic for basic, row in self.rows.items() if variable in row), variable)
            del self.rows[variable], self.forms[form], self.values[variable]

    # --- bounds ------------------------------------------------------------------------------------

    def _bound(self, is_upper: bool, variable: int, bound: _Bound) -> Witness | None:
        bounds, others = (self.upper, self.lower) if is_upper else (self.lower, self.upper)
        before, other = bounds.get(variable), others.get(variable)
        if before is not None and (bound.value >= before.value if is_upper else bound.value <= before.value):
            return None
        self.trail.append((is_upper, variable, before))
        bounds[variable] = bound
        if other is not None and (other.value > bound.value if is_upper else other.value < bound.value):
            return tuple((x.constraint, 1 / Fraction(x.scale)) for x in (bound, other))
        if variable not in self.rows:
            value = self.values[variable]
            if value > bound.value if is_upper else value < bound.value:
                self._move(variable, bound.value)
        return self._repair()

    def _move(self, variable: int, value: _Value) -> None:
        """Set the value of a nonbasic variable, and update the basic ones."""
        before = self.values[variable]
        self.values[variable] = value
        for basic, row in self.rows.items():
            factor = row.get(variable)
            if factor is not None:
                now = self.values[basic]
                self.values[basic] = (
                    now[0] + factor * (value[0] - before[0]),
                    now[1] + factor * (value[1] - before[1]),
                )

    def _repair(self) -> Witness | None:
        """Restore values within all bounds by Bland's rule; return a contradiction, or None."""
        while True:
            broken = self._broken()
            if broken is None:
                return None
            basic, bound, grow = broken
            row = self.rows[basic]
            for place in sorted(row):
                if self._may_move(place, (row[place] > 0) == grow):
                    self._pivot(basic, place)
                    self._move(basic, bound.value)
                    break
            else:
                return self._conflict(row, bound, grow)

    def _broken(self) -> tuple[int, _Bound, bool] | None:
        for basic in sorted(self.rows):
            value = self.values[basic]
            low, high = self.lower.get(basic), self.upper.get(basic)
            if low is not None and value < low.value:
                return basic, low, True
            if high is not None and value > high.value:
                return basic, high, False
        return None

    def _may_move(self, variable: int, up: bool) -> bool:
        bound = (self.upper if up else self.lower).get(variable)
        value = self.values[variable]
        return bound is None or (value < bound.value if up else value > bound.value)

    def _conflict(self, row: Mapping[int, _Number], bound: _Bound, grow: bool) -> Witness:
        shares = [(bound.constraint, 1 / Fraction(bound.scale))]
        for place, factor in row.items():
            blocking = self.upper[place] if (factor > 0) == grow else self.lower[place]
            shares.append((blocking.constraint, Fraction(factor if factor > 0 else -factor, blocking.scale)))
        total: dict[int, Fraction] = {}
        for constraint, share in shares:
            total[constraint] = total.get(constraint, Fraction(0)) + share
        return tuple(total.items())

    def _pivot(self, basic: int, place: int) -> None:
        """Exchange a basic variable and a nonbasic one."""
        row = self.rows.pop(basic)
        factor = row.pop(place)
        new = {x: _quotient(-q, factor) for x, q in row.items()}
        new[basic] = _quotient(1, factor)
        for other in self.rows.values():
            share = other.pop(place, None)
            if share is not None:
                add_to(other, new, share)
        self.rows[place] = new


def _quotient(dividend: _Number, divisor: _Number) -> _Number:
    """Return the quotient, as ``int`` if it is whole."""
    exact = Fraction(dividend, divisor) if divisor != 1 else dividend
    return exact.numerator if exact.denominator == 1 else exact


def add_to(row: dict[int, N], other: Mapping[int, N], factor: N) -> None:
    """Add a multiple of another row to a row, and drop zeros."""
    for place, share in other.items():
        total = row.get(place, 0) + factor * share
        if total:
            row[place] = total
        else:
            row.pop(place, None)
