"""Queries on formulas (terms, names, horizon, degree) and substitution of names and values."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import assert_never

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.node import memoised
from roadproof.world.signals import SIGNALS, SignalName


def map_terms(formula: f.Formula, change: Callable[[t.Term], t.Term]) -> f.Formula:
    """Return ``formula`` with ``change`` applied to both sides of every comparison and to every bound."""
    return f.transform(formula, _on_terms(change))


def _on_terms(change: Callable[[t.Term], t.Term]) -> Callable[[f.Formula], f.Formula]:
    def interval(old: f.Interval) -> f.Interval:
        return f.Interval(change(old.low), None if old.high is None else change(old.high))

    def visit(current: f.Formula) -> f.Formula:
        if isinstance(current, f.Compare):
            return f.Compare(change(current.left), current.op, change(current.right))
        return f.with_intervals(current, interval)

    return visit


def with_values(formula: f.Formula, values: Mapping[str, Fraction]) -> f.Formula:
    """Return ``formula`` with the named parameters replaced by numbers; others stay symbolic.

    Equal sub-formulas become one object, and so do equal terms.
    """
    return all_with_values([formula], values)[0] if values else formula


def all_with_values(formulas: Iterable[f.Formula], values: Mapping[str, Fraction]) -> list[f.Formula]:
    """Apply ``with_values`` to each; equal sub-formulas of different formulas become one object, too."""
    return f.hash_cons(formulas, _on_terms(_substitution(values)))


def term_with_values(term: t.Term, values: Mapping[str, Fraction]) -> t.Term:
    """Return ``term`` with the named parameters replaced by numbers."""
    return _substitution(values)(term)


def _substitution(values: Mapping[str, Fraction]) -> Callable[[t.Term], t.Term]:
    pool: dict[t.Term, t.Term] = {}
    done: dict[t.Term, t.Term] = {}

    def give(term: t.Term) -> t.Term:
        """Return a term with values; equal terms become one object."""
        result = done.get(term)
        if result is None:
            if isinstance(term, t.Parameter) and term.name in values:
                result = t.Number(values[term.name], term.dimension)
            else:
                result = t.with_children(term, tuple(map(give, t.children(term))))
            result = done[term] = pool.setdefault(result, result)
        return result

    return give


@memoised
def without_names(formula: f.Formula) -> f.Formula:
    """Return ``formula`` with every ``Application`` node replaced by its body."""
    if isinstance(formula, f.Application):
        return without_names(formula.body)
    return f.with_children(formula, tuple(map(without_names, f.children(formula))))


def terms_of(*formulas: f.Formula) -> Iterable[t.Term]:
    """Return both sides of every comparison and every interval bound."""
    return _terms_of(formulas[0]) if len(formulas) == 1 else _all_terms(formulas)


@memoised
def _terms_of(formula: f.Formula) -> tuple[t.Term, ...]:
    return tuple(_all_terms([formula]))


def _all_terms(formulas: Iterable[f.Formula]) -> Iterator[t.Term]:
    for current in f.subformulas(*formulas):
        if isinstance(current, f.Compare):
            yield current.left
            yield current.right
        for interval in f.intervals(current):
            yield interval.low
            if interval.high is not None:
                yield interval.high


def leaves_of(*formulas: f.Formula) -> Iterator[t.Leaf]:
    """Yield the leaves of every comparison and every interval bound; a leaf may come several times."""
    for term in terms_of(*formulas):
        yield from t.leaves(term)


@memoised
def parameters_of(formula: f.Formula) -> tuple[str, ...]:
    """Return the names of the parameters in ``formula``, sorted."""
    return tuple(sorted({leaf.name for leaf in leaves_of(formula) if isinstance(leaf, t.Parameter)}))


def vehicles_of(formula: f.Formula) -> tuple[str, ...]:
    """Return the names of the vehicles in ``formula``, sorted."""
    vehicles = {x.vehicle for x in f.subformulas(formula) if isinstance(x, f.Occupies)}
    vehicles |= {
        leaf.vehicle for leaf in leaves_of(formula) if isinstance(leaf, t.Signal | t.Size | t.CustomSignal)
    }
    vehicles -= {""}  # a custom signal without vehicle
    return tuple(sorted(vehicles))


def signals_of(formulas: Iterable[f.Formula]) -> tuple[SignalName, ...]:
    """Return the names of the signals in the formulas, in the order of ``SIGNALS``."""
    names = {leaf.name for leaf in leaves_of(*formulas) if isinstance(leaf, t.Signal)}
    return tuple(name for name in SIGNALS if name in names)


def rename(formula: f.Formula, old: str, new: str) -> f.Formula:
    """Return ``formula`` with the free lane or lanelet variable ``old`` renamed to ``new``.

    Variables that are bound to ``old`` stay. A variable that is bound to ``new`` is renamed first, so that it
    captures nothing.
    """

    @cache
    def visit(current: f.Formula) -> f.Formula:
        """Return a sub-formula with ``old`` renamed."""
        match current:
            case f.Occupies(vehicle, lanelet):
                return f.Occupies(vehicle, new if lanelet == old else lanelet)
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):
                inside = f.Domain(domain.kind, new if domain.of == old else domain.of)
                if variable == old:
                    return type(current)(variable, inside, body)
                if variable == new:
                    variable = _free_name(variable, road_names(body) | {old})
                    body = rename(body, new, variable)
                return type(current)(variable, inside, visit(body))
            case f.Application(name, arguments, body):
                return f.Application(name, tuple(new if a == old else a for a in arguments), visit(body))
            case f.Truth() | f.Compare() | f.Not() | f.And() | f.Or():
                return f.with_children(current, tuple(visit(child) for child in f.children(current)))
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                return f.with_children(current, tuple(visit(child) for child in f.children(current)))

    return visit(formula)


def _free_name(name: str, taken: Set[str]) -> str:
    while name in taken:
        name += "_"
    return name


@memoised
def road_names(formula: f.Formula) -> frozenset[str]:
    """Return the names of lanes and lanelets in ``formula``, free and bound."""
    inside = frozenset[str]().union(*map(road_names, f.children(formula)))
    match formula:
        case f.Occupies(_, lanelet):
            return inside | {lanelet}
        case f.Some(variable, domain, _) | f.Every(variable, domain, _):
            return inside | ({variable, domain.of} if domain.kind in ("lanelets", "adjacent") else {variable})
        case f.Truth() | f.Compare() | f.Not() | f.And() | f.Or() | f.Application():
            return inside
        case f.Until() | f.Since() | f.Eventually() | f.Always():
            return inside


def free_roads(formula: f.Formula) -> frozenset[str]:
    """Return the names of lanes and lanelets that are free in ``formula``."""
    return _free_names(formula, with_domains=True)


def free_lanelets(formula: f.Formula) -> tuple[str, ...]:
    """Return the names of lanelets that are free in ``formula``, sorted."""
    return tuple(sorted(_free_names(formula, with_domains=False)))


def _free_names(formula: f.Formula, with_domains: bool) -> frozenset[str]:
    @cache
    def visit(current: f.Formula) -> frozenset[str]:
        """Return the names that are free in a sub-formula."""
        inside = frozenset[str]().union(*map(visit, f.children(current)))
        match current:
            case f.Occupies(_, lanelet):
                return frozenset({lanelet})
            case f.Some(variable, domain, _) | f.Every(variable, domain, _):
                of = {domain.of} if with_domains and domain.kind in ("adjacent", "lanelets") else set()
                return (inside - {variable}) | of
            case f.Truth() | f.Compare() | f.Not() | f.And() | f.Or() | f.Application():
                return inside
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                return inside

    return visit(formula)


def rename_vehicles(formula: f.Formula, roles: Mapping[str, str]) -> f.Formula:
    """Return ``formula`` with the vehicles in ``roles`` renamed at once, also in arguments of names."""

    def leaf(old: t.Leaf) -> t.Term:
        """Return a leaf with its vehicle renamed."""
        if isinstance(old, t.Signal | t.Size):
            return type(old)(old.name, roles.get(old.vehicle, old.vehicle))  # type: ignore[arg-type]
        if isinstance(old, t.CustomSignal):
            return replace(old, vehicle=roles.get(old.vehicle, old.vehicle))
        return old

    def visit(current: f.Formula) -> f.Formula:
        """Return a node with vehicles renamed, apart from its terms and sub-formulas."""
        match current:
            case f.Occupies(vehicle, lanelet):
                return f.Occupies(roles.get(vehicle, vehicle), lanelet)
            case f.Application(name, arguments, body):
                return f.Application(name, tuple(roles.get(a, a) for a in arguments), body)
            case f.Truth() | f.Compare() | f.Some() | f.Every() | f.Not() | f.And() | f.Or():
                return current
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                return current

    return f.transform(map_terms(formula, lambda term: t.replace_leaves(term, leaf)), visit)


def bounds_of(interval: f.Interval) -> tuple[Fraction, Fraction | None]:
    """Return both ends of an interval as rationals; None is unbounded.

    Raises ``ValueError`` if a bound still has a parameter.
    """
    low = t.constant_value(interval.low)
    high = None if interval.high is None else t.constant_value(interval.high)
    if low is None or (interval.high is not None and high is None):
        raise ValueError("an interval bound still holds a parameter: substitute values first")
    return low, high


def intervals_of(formula: f.Formula) -> list[f.Interval]:
    """Return the intervals of all temporal operators in ``formula``."""
    return [interval for current in f.subformulas(formula) for interval in f.intervals(current)]


def signal_degree(term: t.Term) -> int | None:
    """Return an upper bound of the degree of ``term`` as a polynomial in the signals; None if it is none.

    Products are not multiplied out, so v - v has degree 1.
    """
    match term:
        case t.Number() | t.Parameter() | t.Variable() | t.Size():
            return 0
        case t.Signal() | t.CustomSignal():
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


def is_cubic_state(formula: f.Formula) -> bool:
    """Return whether ``formula`` is about one instant and compares polynomials of degree 3 or more.

    It then has signals, sizes and parameters only: no lanes, custom signals or variables.
    """
    lanes = (f.Occupies, f.Some, f.Every)
    if not f.is_state(formula) or any(isinstance(x, lanes) for x in f.subformulas(formula)):
        return False
    if any(isinstance(leaf, t.CustomSignal | t.Variable) for leaf in leaves_of(formula)):
        return False
    return any((signal_degree(side) or 0) > 2 for side in terms_of(formula))
