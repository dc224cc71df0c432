"""A model over finitely many instants becomes a trace over all of time, and is judged.

At each instant the model gives a state of all vehicles. Between instants the trace keeps the state
of the instant before (or, as a second try, takes that of the instant after). It is a trace in the
paper's sense, signals as functions of time; it may jump, and which lanes a vehicle is in is free,
as far as some road allows it.
"""

from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms, is_atom, membership
from roadproof.judge import TruthSet, judge
from roadproof.judge.signals import AbstractSignals
from roadproof.judge.truth import from_switches
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of, map_terms, rename, terms_of, without_names
from roadproof.prove.roads import boxes_of, contains, is_on_some_road, is_same_where_it_stands, whose
from roadproof.prove.search import Model
from roadproof.prove.states import TYPICAL_SIZE

# Further than the boxes of a model lie from each other; only to keep its instants apart, in m.
STRIDE = Fraction(1000)


@dataclass(frozen=True)
class Instant:
    """A state: values of signals, sizes, parameters and variables, and the truth of named atoms."""

    time: Fraction
    values: Mapping[str, Fraction]
    atoms: Mapping[str, bool]


@dataclass(frozen=True)
class Countermodel:
    """A judged trace on which a claim is false at time 0; ``held`` says which state fills the gaps."""

    instants: tuple[Instant, ...]
    parameters: Mapping[str, Fraction]
    held: Literal["before", "after"]


def realise(
    claim: Formula, atoms: Atoms, model: Model, defaults: Mapping[str, Fraction]
) -> Countermodel | None:
    """The model as a trace on which the atomised ``claim`` is judged false, or None.

    None also where two instants need different values of one parameter or one vehicle's size, and
    where it is not seen that a road has what the model says of lanes and lanelets.
    """
    fixed = _fixed_values(model, defaults)
    if fixed is None:
        return None

    def put_in(formula: Formula) -> Formula:
        return _without_empty_windows(map_terms(without_names(formula), lambda term: _put_in(term, fixed)))

    bare = put_in(_on_road(claim, atoms, model))
    named = {name: put_in(meaning) for name, meaning in atoms.named.items()}
    parts = dict.fromkeys(part for x in (bare, *named.values()) for part in _parts(x))
    states = [_completed(parts, found, fixed) for found in model.signals.values()]
    truths = [{part: _holds(part, found) for part in parts} for found in states]
    moved = [_moved_on(parts, found, STRIDE * number) for number, found in enumerate(states)]
    if truths == [{part: _holds(part, found) for part in parts} for found in moved]:
        states = moved
    if not all(is_on_some_road(truth, _all_lanes(claim, model)) for truth in truths):
        return None
    if not is_same_where_it_stands(truths, [boxes_of(parts, found, fixed) for found in states]):
        return None
    times = list(model.states)
    helds: tuple[Literal["before", "after"], ...] = ("before", "after")
    for held in helds:
        given = {part: _spread(times, [at[part] for at in truths], held) for part in parts}
        if judge(bare, None, given).holds:
            continue
        shown = {name: judge(meaning, None, given).truth(meaning) for name, meaning in named.items()}
        instants = tuple(
            Instant(time, _numbers(found), {n: truth.at(time) for n, truth in shown.items()})
            for time, found in zip(times, states, strict=True)
        )
        return Countermodel(instants, {n: v for n, v in fixed.items() if n in defaults}, held)
    return None


def _on_road(claim: Formula, atoms: Atoms, model: Model) -> Formula:
    """``claim`` with quantifiers over the road written out over the elements of the model."""

    def visit(current: Formula) -> Formula:
        if not isinstance(current, f.Some | f.Every) or is_atom(current):
            if isinstance(current, f.Named):
                return current
            return f.with_children(current, tuple(visit(child) for child in f.children(current)))
        elements = [element for element in model.elements if _belongs(element, current.domain, model.facts)]
        bodies = [visit(atoms.atomise(rename(current.body, current.variable, e))) for e in elements]
        return f.disjunction(*bodies) if isinstance(current, f.Some) else f.conjunction(*bodies)

    return visit(claim)


def _belongs(element: str, domain: f.Domain, facts: Set[str]) -> bool:
    """Whether a road on which ``facts`` hold has ``element`` in ``domain``; lanes are mutual neighbours."""
    if domain.kind == "adjacent":
        converse = membership(f.Domain("adjacent", element), domain.of)
        return element != domain.of and (membership(domain, element) in facts or converse in facts)
    return domain.kind == "lanes" or membership(domain, element) in facts


def _all_lanes(claim: Formula, model: Model) -> tuple[str, ...] | None:
    """The lanes of the road where the claim speaks of all; None where there may be others."""
    domains = (x.domain for x in f.subformulas(claim) if isinstance(x, f.Some | f.Every))
    return model.elements if any(domain.kind == "lanes" for domain in domains) else None


def _completed(
    parts: Iterable[Formula], found: Mapping[str, Fraction | bool], fixed: Mapping[str, Fraction]
) -> Mapping[str, Fraction | bool]:
    """The state with what it leaves open: vehicles stand apart, and a box is where one inside it is."""
    apart = {front: STRIDE / 20 * number for number, front in enumerate(_fronts(parts), 1)}
    found = {**apart, **found}
    boxes = boxes_of(parts, found, fixed)
    where = {(domain, vehicle): part for part in parts for domain, vehicle in whose(part) if vehicle in boxes}
    inside = [(domain, boxes[who]) for (domain, who), part in where.items() if _holds(part, found)]
    around = {
        state.opaque(part): True
        for (domain, who), part in where.items()
        if isinstance(part, f.Some | f.Occupies)
        and any(domain == other and contains(boxes[who], inner) for other, inner in inside)
    }
    return {**around, **found}


def _moved_on(
    parts: Iterable[Formula], found: Mapping[str, Fraction | bool], by: Fraction
) -> Mapping[str, Fraction | bool]:
    """The state with all vehicles moved along the road, where no box of another instant stands."""
    return {**found, **{front: found.get(front, Fraction(0)) + by for front in _fronts(parts)}}


def _fronts(parts: Iterable[Formula]) -> list[str]:
    """The symbols of the positions along the road that are compared."""
    compared = {leaf for part in parts for side in terms_of(part) for leaf in t.leaves(side)}
    return sorted(state.symbol(x) for x in compared if isinstance(x, t.Signal) and x.name == "s")


def _without_empty_windows(formula: Formula) -> Formula:
    """``formula`` with operators whose window ends before it begins replaced by what they then are."""

    def visit(current: Formula) -> Formula:
        if isinstance(current, f.Until | f.Eventually | f.Always):
            low, high = bounds_of(current.interval)
            if high is not None and high < low:
                return f.Truth(isinstance(current, f.Always))
        return current

    return f.transform(formula, visit)


def _numbers(found: Mapping[str, Fraction | bool]) -> dict[str, Fraction]:
    return {name.strip("|"): value for name, value in found.items() if not isinstance(value, bool)}


def _fixed_values(model: Model, defaults: Mapping[str, Fraction]) -> dict[str, Fraction] | None:
    """One value for every parameter, variable and size; None where instants disagree."""
    fixed: dict[str, Fraction] = {}
    for found in [model.values, *model.signals.values()]:
        for name, value in found.items():
            if isinstance(value, bool) or (name.startswith("|") and not _is_size(name)):
                continue
            if fixed.setdefault(name, value) != value:
                return None
    return {**defaults, **fixed}


def _is_size(symbol: str) -> bool:
    return symbol.startswith(("|length(", "|width("))


def _put_in(term: t.Term, values: Mapping[str, Fraction]) -> t.Term:
    """``term`` with parameters, variables and sizes as numbers."""

    def leaf(old: t.Leaf) -> t.Term:
        match old:
            case t.Parameter(name, dimension) | t.Variable(name, dimension):
                return t.Number(values.get(name, Fraction(0)), dimension)
            case t.Size(name, _):
                return t.Number(values.get(state.symbol(old), TYPICAL_SIZE[name]), (1, 0))
            case _:
                return old

    return t.replace_leaves(term, leaf)


def _parts(formula: Formula) -> Iterator[Formula]:
    """The comparisons and road predicates that ``formula`` is made of, each once."""
    seen: set[Formula] = set()
    waiting = [formula]
    while waiting:
        current = waiting.pop()
        if current in seen:
            continue
        seen.add(current)
        if isinstance(current, f.Compare | f.Occupies | f.Some | f.Every):
            yield current
        else:
            waiting.extend(f.children(current))


def _holds(part: Formula, found: Mapping[str, Fraction | bool]) -> bool:
    """Whether a comparison or road predicate holds in a state, evaluated exactly."""
    if isinstance(part, f.Occupies | f.Some | f.Every):
        return bool(found.get(state.opaque(part), False))
    signals = {
        leaf: ((Fraction(0), Fraction(found.get(state.symbol(leaf), 0))),)
        for side in terms_of(part)
        for leaf in t.leaves(side)
        if isinstance(leaf, t.Signal)
    }
    return judge(part, AbstractSignals(signals, {})).holds


def _spread(times: list[Fraction], values: list[bool], held: Literal["before", "after"]) -> TruthSet:
    """Truth at instants, carried over to what lies between them."""
    after = values if held == "before" else [*values[1:], values[-1]]
    return from_switches(zip(times, values, after, strict=True))
