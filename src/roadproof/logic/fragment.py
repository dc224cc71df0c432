"""In which part of the language a formula lies: how far it looks ahead, and how hard its atoms are."""

from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias, assert_never

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula, Interval
from roadproof.logic.rewrite import bounds_of, terms_of
from roadproof.logic.terms import Term

Seconds: TypeAlias = Fraction


def horizon(formula: Formula) -> Seconds | None:
    """How many seconds after an instant the truth of ``formula`` there may depend on; None: for ever.

    Raises ``ValueError`` where an interval bound still holds a parameter.
    """
    done: dict[Formula, Seconds | None] = {}

    def visit(current: Formula) -> Seconds | None:
        if current not in done:
            done[current] = _reach(current, [visit(child) for child in f.children(current)])
        return done[current]

    return visit(formula)


def _reach(formula: Formula, below: list[Seconds | None]) -> Seconds | None:
    farthest = _latest(below)
    match formula:
        case f.Until(_, interval, _) | f.Eventually(interval, _) | f.Always(interval, _):
            high = bounds_of(interval)[1]
            return None if high is None or farthest is None else high + farthest
        case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.Not() | f.And() | f.Or():
            return farthest
        case f.Application():
            return farthest
        case _:
            assert_never(formula)


def _latest(times: list[Seconds | None]) -> Seconds | None:
    latest = Fraction(0)
    for time in times:
        if time is None:
            return None
        latest = max(latest, time)
    return latest


def intervals_of(formula: Formula) -> list[Interval]:
    """The intervals of its temporal operators."""
    return [interval for current in f.subformulas(formula) for interval in f.intervals(current)]


def signal_degree(term: Term) -> int | None:
    """The degree of ``term`` as a polynomial in the signals, at most; None where it is no polynomial.

    Products are not multiplied out, so v - v has degree 1 here.
    """
    match term:
        case t.Number() | t.Parameter() | t.Variable() | t.Size():
            return 0
        case t.Signal() | t.Own():
            return 1
        case t.Power(inner, exponent):
            degree = signal_degree(inner)
            return None if degree is None else degree * exponent
        case t.Quotient(numerator, _):
            return signal_degree(numerator)
        case t.Sum() | t.Product() | t.Maximum() | t.Minimum() | t.Inverse():
            degrees = [signal_degree(child) for child in t.children(term)]
        case _:
            assert_never(term)
    known = [degree for degree in degrees if degree is not None]
    if len(known) < len(degrees):
        return None
    if isinstance(term, t.Product):
        return sum(known)
    highest = max(known, default=0)
    return highest if isinstance(term, t.Sum) or highest == 0 else None


def is_cubic_state(formula: Formula) -> bool:
    """Whether it is about one instant and compares signals, sizes and parameters only, by cubes or more."""
    lanes = (f.Occupies, f.Some, f.Every)
    if not f.is_state(formula) or any(isinstance(x, lanes) for x in f.subformulas(formula)):
        return False
    sides = list(terms_of(formula))
    if any(isinstance(leaf, t.Own | t.Variable) for side in sides for leaf in t.leaves(side)):
        return False
    return any((signal_degree(side) or 0) > 2 for side in sides)


@dataclass(frozen=True)
class Sizes:
    """How large a formula is: distinct sub-formulas, atoms and temporal operators, and its depth."""

    subformulas: int
    atoms: int
    temporal: int
    depth: int


def sizes(formula: Formula) -> Sizes:
    """Counts over distinct sub-formulas; names of definitions count for nothing."""
    atoms = temporal = count = 0
    for current in f.subformulas(formula):
        match current:
            case f.Application():
                continue
            case f.Compare() | f.Occupies():
                atoms += 1
            case f.Until() | f.Eventually() | f.Always():
                temporal += 1
            case f.Truth() | f.Some() | f.Every() | f.Not() | f.And() | f.Or():
                pass
            case _:
                assert_never(current)
        count += 1
    return Sizes(count, atoms, temporal, _depth(formula))


def _depth(formula: Formula) -> int:
    done: dict[Formula, int] = {}

    def visit(current: Formula) -> int:
        if current not in done:
            below = max((visit(child) for child in f.children(current)), default=0)
            done[current] = below if isinstance(current, f.Application) else below + 1
        return done[current]

    return visit(formula)
