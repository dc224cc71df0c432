"""What formulas speak of and how hard they are, and formulas with names replaced by names or values."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import TypeAlias, assert_never

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.node import once
from roadproof.world.signals import SIGNALS, SignalName


def map_terms(formula: f.Formula, change: Callable[[t.Term], t.Term]) -> f.Formula:
    """``formula`` with ``change`` applied to both sides of every comparison and to every bound."""
    return f.transform(formula, _changing_terms(change))


def _changing_terms(change: Callable[[t.Term], t.Term]) -> Callable[[f.Formula], f.Formula]:
    def interval(old: f.Interval) -> f.Interval:
        return f.Interval(change(old.low), None if old.high is None else change(old.high))

    def visit(current: f.Formula) -> f.Formula:
        if isinstance(current, f.Compare):
            return f.Compare(change(current.left), current.op, change(current.right))
        return f.with_intervals(current, interval)

    return visit


def with_values(formula: f.Formula, values: Mapping[str, Fraction]) -> f.Formula:
    """``formula`` with the named parameters replaced by numbers; others stay symbolic.

    One object stands for all sub-formulas that are equal, and for all such terms.
    """
    return all_with_values([formula], values)[0] if values else formula


def all_with_values(formulas: Iterable[f.Formula], values: Mapping[str, Fraction]) -> list[f.Formula]:
    """As ``with_values`` of each, with one object for what is equal in several, too."""
    return f.share(formulas, _changing_terms(_giving(values)))


def term_with_values(term: t.Term, values: Mapping[str, Fraction]) -> t.Term:
    """``term`` with the named parameters replaced by numbers."""
    return _giving(values)(term)


def _giving(values: Mapping[str, Fraction]) -> Callable[[t.Term], t.Term]:
    pool: dict[t.Term, t.Term] = {}
    done: dict[t.Term, t.Term] = {}

    def give(term: t.Term) -> t.Term:
        made = done.get(term)
        if made is None:
            if isinstance(term, t.Parameter) and term.name in values:
                made = t.Number(values[term.name], term.dimension)
            else:
                made = t.with_children(term, tuple(map(give, t.children(term))))
            made = done[term] = pool.setdefault(made, made)
        return made

    return give


@once
def without_names(formula: f.Formula) -> f.Formula:
    """``formula`` with every ``Application`` node replaced by its body."""
    if isinstance(formula, f.Application):
        return without_names(formula.body)
    return f.with_children(formula, tuple(map(without_names, f.children(formula))))


def terms_of(*formulas: f.Formula) -> Iterable[t.Term]:
    """Both sides of every comparison and every interval bound."""
    return _terms_of(formulas[0]) if len(formulas) == 1 else _all_terms(formulas)


@once
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
    """The leaves of every comparison and every interval bound, those of several once for each."""
    for term in terms_of(*formulas):
        yield from t.leaves(term)


@once
def parameters_of(formula: f.Formula) -> tuple[str, ...]:
    """Names of the parameters that occur, sorted."""
    return tuple(sorted({leaf.name for leaf in leaves_of(formula) if isinstance(leaf, t.Parameter)}))


def vehicles_of(formula: f.Formula) -> tuple[str, ...]:
    """Names of the vehicles that occur, sorted."""
    found = {x.vehicle for x in f.subformulas(formula) if isinstance(x, f.Occupies)}
    found |= {leaf.vehicle for leaf in leaves_of(formula) if isinstance(leaf, t.Signal | t.Size | t.Own)}
    found -= {""}  # an own signal of no vehicle
    return tuple(sorted(found))


def signals_of(formulas: Iterable[f.Formula]) -> tuple[SignalName, ...]:
    """Names of the signals that occur, in the order of the list of signals."""
    found = {leaf.name for leaf in leaves_of(*formulas) if isinstance(leaf, t.Signal)}
    return tuple(name for name in SIGNALS if name in found)


def rename(formula: f.Formula, old: str, new: str) -> f.Formula:
    """``formula`` with the free lane or lanelet variable ``old`` called ``new``.

    What a quantifier inside calls ``old`` stays as it is; one that calls something ``new`` has its
    variable renamed first, so that it captures nothing.
    """

    @cache
    def visit(current: f.Formula) -> f.Formula:
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
            case _:
                return f.with_children(current, tuple(visit(child) for child in f.children(current)))

    return visit(formula)


def _free_name(name: str, taken: Set[str]) -> str:
    while name in taken:
        name += "_"
    return name


@once
def road_names(formula: f.Formula) -> frozenset[str]:
    """Names of lanes and lanelets that ``formula`` speaks of or calls a variable by."""
    inside = frozenset[str]().union(*map(road_names, f.children(formula)))
    match formula:
        case f.Occupies(_, lanelet):
            return inside | {lanelet}
        case f.Some(variable, domain, _) | f.Every(variable, domain, _):
            return inside | ({variable, domain.of} if domain.kind in ("lanelets", "adjacent") else {variable})
        case _:
            return inside


def free_roads(formula: f.Formula) -> frozenset[str]:
    """Names of lanes and lanelets that ``formula`` speaks of and no quantifier in it binds."""
    return _free_names(formula, with_domains=True)


def free_lanelets(formula: f.Formula) -> tuple[str, ...]:
    """Names of lanelets that ``formula`` speaks of and no quantifier in it binds, sorted."""
    return tuple(sorted(_free_names(formula, with_domains=False)))


def _free_names(formula: f.Formula, with_domains: bool) -> frozenset[str]:
    @cache
    def visit(current: f.Formula) -> frozenset[str]:
        inside = frozenset[str]().union(*map(visit, f.children(current)))
        match current:
            case f.Occupies(_, lanelet):
                return frozenset({lanelet})
            case f.Some(variable, domain, _) | f.Every(variable, domain, _):
                of = {domain.of} if with_domains and domain.kind in ("adjacent", "lanelets") else set()
                return (inside - {variable}) | of
            case _:
                return inside

    return visit(formula)


def rename_vehicles(formula: f.Formula, roles: Mapping[str, str]) -> f.Formula:
    """``formula`` with the vehicles in ``roles`` replaced, all at once; also in the arguments of names."""

    def leaf(old: t.Leaf) -> t.Term:
        if isinstance(old, t.Signal | t.Size):
            return type(old)(old.name, roles.get(old.vehicle, old.vehicle))  # type: ignore[arg-type]
        if isinstance(old, t.Own):
            return replace(old, vehicle=roles.get(old.vehicle, old.vehicle))
        return old

    def visit(current: f.Formula) -> f.Formula:
        match current:
            case f.Occupies(vehicle, lanelet):
                return f.Occupies(roles.get(vehicle, vehicle), lanelet)
            case f.Application(name, arguments, body):
                return f.Application(name, tuple(roles.get(a, a) for a in arguments), body)
            case _:
                return current

    return f.transform(map_terms(formula, lambda term: t.replace_leaves(term, leaf)), visit)


def bounds_of(interval: f.Interval) -> tuple[Fraction, Fraction | None]:
    """Both ends of an interval as rationals; None is unbounded.

    Raises ``ValueError`` where a bound still holds a parameter.
    """
    low = t.constant_value(interval.low)
    high = None if interval.high is None else t.constant_value(interval.high)
    if low is None or (interval.high is not None and high is None):
        raise ValueError("an interval bound still holds a parameter: substitute values first")
    return low, high


Seconds: TypeAlias = Fraction


def horizon(formula: f.Formula) -> Seconds | None:
    """How many seconds after an instant the truth of ``formula`` there may depend on; None: for ever.

    Raises ``ValueError`` where an interval bound still holds a parameter.
    """

    @cache
    def visit(current: f.Formula) -> Seconds | None:
        return _reach(current, [visit(child) for child in f.children(current)])

    return visit(formula)


def _reach(formula: f.Formula, below: list[Seconds | None]) -> Seconds | None:
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


def intervals_of(formula: f.Formula) -> list[f.Interval]:
    """The intervals of its temporal operators."""
    return [interval for current in f.subformulas(formula) for interval in f.intervals(current)]


def signal_degree(term: t.Term) -> int | None:
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


def is_cubic_state(formula: f.Formula) -> bool:
    """Whether it is about one instant and compares signals, sizes and parameters only, by cubes or more."""
    lanes = (f.Occupies, f.Some, f.Every)
    if not f.is_state(formula) or any(isinstance(x, lanes) for x in f.subformulas(formula)):
        return False
    if any(isinstance(leaf, t.Own | t.Variable) for leaf in leaves_of(formula)):
        return False
    return any((signal_degree(side) or 0) > 2 for side in terms_of(formula))
