"""Moments: affine sums of named times and parameters, such as ``t3 + minDanger``.

Quantifiers over time are instantiated with moments, so a printed moment must parse to the same moment.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from fractions import Fraction
from functools import lru_cache

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.node import memoised, node
from roadproof.logic.rewrite import intervals_of
from roadproof.logic.terms import Term

# Reserved words of SMT-LIB and its theories that are legal names in claims.
_RESERVED = re.compile(
    "_|as|par|forall|exists|let|match|distinct|ite|xor|implies|abs|div|mod|to_int|to_real|is_int|select|store"
    "|BINARY|DECIMAL|HEXADECIMAL|NUMERAL|STRING"
)
_PART = re.compile(r"([+-]?)\s*(?:(\d+(?:/\d+)?)\s*(?:\*\s*)?)?([A-Za-z_]\w*)?", re.ASCII)


@node
class Moment:
    """The sum Σ coefficient · name + constant; ``parts`` is sorted by name and has no zero coefficient."""

    parts: tuple[tuple[str, Fraction], ...] = ()
    constant: Fraction = Fraction(0)

    def __add__(self, other: "Moment") -> "Moment":
        return _sum(self, other.parts, other.constant)

    def __sub__(self, other: "Moment") -> "Moment":
        return _sum(self, [(name, -factor) for name, factor in other.parts], -other.constant)

    @memoised
    def __str__(self) -> str:
        shown = ""
        for name, factor in self.parts:
            shown += " - " if factor < 0 else " + " if shown else ""
            shown += name if abs(factor) == 1 else f"{abs(factor)}*{name}"
        if self.constant or not shown:
            shown += " - " if self.constant < 0 else " + " if shown else ""
            shown += str(abs(self.constant))
        return shown.strip()

    def value(self, values: Mapping[str, Fraction]) -> Fraction:
        """Return the moment in seconds, given a value for each name."""
        total = self.constant
        for name, factor in self.parts:
            value = values[name] if factor == 1 else values[name] * factor
            total = total + value if total else value
        return total

    @memoised
    def smt(self) -> str:
        """Return the moment as an SMT-LIB term of sort Real."""
        names = ((constant(name), k) for name, k in self.parts)
        summands = [name if k == 1 else f"(* {smt_rational(k)} {name})" for name, k in names]
        if self.constant or not summands:
            summands.append(smt_rational(self.constant))
        return summands[0] if len(summands) == 1 else f"(+ {' '.join(summands)})"


ZERO = Moment()


def constant(name: str) -> str:
    """Return the SMT-LIB constant of a time, parameter or variable; reserved words get a dot appended."""
    return f"{name}." if _RESERVED.fullmatch(name) else name


@lru_cache(maxsize=4096)
def named_moment(name: str) -> Moment:
    """Return the moment with one name."""
    return Moment(((name, Fraction(1)),))


def _sum(moment: Moment, parts: Iterable[tuple[str, Fraction]], constant: Fraction) -> Moment:
    total = dict(moment.parts)
    for name, factor in parts:
        total[name] = total[name] + factor if name in total else factor
    nonzero = tuple(sorted(item for item in total.items() if item[1]))
    return Moment(nonzero, moment.constant + constant if constant else moment.constant)


def smt_rational(value: Fraction) -> str:
    """Return a rational as SMT-LIB text."""
    shown = f"{abs(value.numerator)}.0"
    if value.denominator != 1:
        shown = f"(/ {shown} {value.denominator}.0)"
    return f"(- {shown})" if value < 0 else shown


def moment_of(term: Term) -> Moment:
    """Return an interval bound as a moment. Raises ``InputError`` if it is not affine in parameters."""
    match term:
        case t.Number(value, _):
            return Moment((), value)
        case t.Parameter(name, _):
            return named_moment(name)
        case t.Sum(summands):
            total = ZERO
            for summand in summands:
                total += moment_of(summand)
            return total
        case t.Product(factors):
            scale, rest = Fraction(1), ZERO
            open_factors = 0
            for factor in factors:
                constant = t.constant_value(factor)
                if constant is None:
                    open_factors, rest = open_factors + 1, moment_of(factor)
                else:
                    scale *= constant
            if open_factors == 0:
                return Moment((), scale)
            if open_factors == 1:
                return Moment(tuple((n, k * scale) for n, k in rest.parts if scale), rest.constant * scale)
        case t.Quotient(numerator, denominator):
            divisor = t.constant_value(denominator)
            if divisor:
                return moment_of(t.Product((t.Number(1 / divisor), numerator)))
    constant = t.constant_value(term)
    if constant is not None:
        return Moment((), constant)
    raise InputError("an interval bound of a claim must be a sum of parameters and numbers")


def compared_times(
    formula: Formula, parameters: Collection[str]
) -> tuple[Moment, f.Comparison, Moment] | None:
    """Return both sides and the operator of a comparison of affine sums over ``parameters``; else None."""
    if not isinstance(formula, f.Compare):
        return None
    leaves = [leaf for side in (formula.left, formula.right) for leaf in t.leaves(side)]
    names = [leaf.name for leaf in leaves if isinstance(leaf, t.Parameter)]
    if not names or not set(names) <= set(parameters):
        return None
    try:
        return moment_of(formula.left), formula.op, moment_of(formula.right)
    except InputError:
        return None


def bound_parameters(formula: Formula) -> frozenset[str]:
    """Return the parameters in the interval bounds of a formula."""
    bounds = [
        bound
        for interval in intervals_of(formula)
        for bound in (interval.low, interval.high)
        if bound is not None
    ]
    return frozenset(
        leaf.name for bound in bounds for leaf in t.leaves(bound) if isinstance(leaf, t.Parameter)
    )


def read_moment(text: str) -> Moment:
    """Return the moment of a text, the inverse of ``str``. Raises ``InputError``."""
    total, position = ZERO, 0
    stripped = text.strip()
    if not stripped:
        raise InputError("an empty text is no moment: write 0")
    while position < len(stripped):
        match = _PART.match(stripped, position)
        if match is None or match.end() == position or (not match[2] and not match[3]):
            raise InputError(f"'{text[:60]}' is no moment: write sums such as t3 + minDanger")
        try:
            factor = Fraction(match[2] or 1) * (-1 if match[1] == "-" else 1)
        except (ValueError, ZeroDivisionError):
            raise InputError(f"'{text[:60]}' is no moment: '{match[2][:20]}' is no number") from None
        summand = Moment(((match[3], factor),)) if match[3] else Moment((), factor)
        total += summand
        position = match.end()
        while position < len(stripped) and stripped[position] == " ":
            position += 1
    return total
