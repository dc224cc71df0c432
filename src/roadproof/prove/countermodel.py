"""A model over finitely many instants becomes a trace over all of time, and is judged.

At each instant the model gives a state of all vehicles. Between instants the trace keeps the state
of the instant before (or, as a second try, takes that of the instant after). It is a trace in the
paper's sense, signals as functions of time; it may jump, and which lanes a vehicle is in is free,
as far as some road allows it.
"""

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms, is_atom, membership, rename
from roadproof.judge import TruthSet, judge
from roadproof.judge.signals import AbstractSignals
from roadproof.judge.truth import from_switches
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of, map_terms, terms_of, without_names
from roadproof.prove.search import Model
from roadproof.prove.states import TYPICAL_SIZE

ZONES = tuple(f.Domain("zone", name) for name in ("main", "merge", "depart"))


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
    truths = [{part: _holds(part, model.signals[instant]) for part in parts} for instant in model.states]
    if not all(is_on_some_road(truth, _all_lanes(claim, model)) for truth in truths):
        return None
    times = list(model.states)
    helds: tuple[Literal["before", "after"], ...] = ("before", "after")
    for held in helds:
        given = {part: _spread(times, [at[part] for at in truths], held) for part in parts}
        if judge(bare, None, given).holds:
            continue
        shown = {name: judge(meaning, None, given).truth(meaning) for name, meaning in named.items()}
        instants = tuple(
            Instant(time, _numbers(model.signals[time]), {n: truth.at(time) for n, truth in shown.items()})
            for time in times
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


def is_on_some_road(truths: Mapping[Formula, bool], lanes: Sequence[str] | None) -> bool:
    """Whether it is seen that a road allows these truth values of road predicates at one instant.

    ``a is on a lanelet of D`` can be had for each vehicle and each D alone, but for this: each
    lanelet is of one of three zones, and of a lane. Of anything more involved it is not seen.
    """
    road = [part for part in truths if isinstance(part, f.Occupies | f.Some | f.Every)]
    if all(isinstance(part, f.Occupies) for part in road):
        return True
    on: dict[tuple[str, f.Domain], bool] = {}
    for part in road:
        match part:
            case f.Some(variable, domain, f.Occupies(vehicle, lanelet)) if variable == lanelet:
                if on.setdefault((vehicle, domain), truths[part]) != truths[part]:
                    return False
            case _:
                return False
    for vehicle in {vehicle for vehicle, _ in on}:
        zones = [on[vehicle, zone] for zone in ZONES if (vehicle, zone) in on]
        in_lane = any(
            true for (who, domain), true in on.items() if who == vehicle and domain.kind == "lanelets"
        )
        if in_lane and len(zones) == len(ZONES) and not any(zones):
            return False
        lanelets = [] if lanes is None else [(vehicle, f.Domain("lanelets", lane)) for lane in lanes]
        in_no_lane = lanes is not None and not any(on.get(where, True) for where in lanelets)
        if any(zones) and in_no_lane:
            return False
    return True


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
