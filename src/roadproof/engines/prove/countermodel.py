"""A model over finitely many instants becomes a trace over all of time, on a road, and is judged.

At each instant the model gives a state of all vehicles. Between instants the trace keeps the state
of the instant before (or, as a second try, takes that of the instant after). It is a trace in the
paper's sense, signals as functions of time; it may jump. What the model says of lanes and lanelets
only guides the making of a road: whether the claim is false there is judged from the numbers.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias

from roadproof.engines.prove.place import Values, place
from roadproof.engines.prove.road_layout import layout_of
from roadproof.engines.prove.roads import lay_road
from roadproof.engines.prove.search import Model
from roadproof.engines.prove.states import TYPICAL_SIZE
from roadproof.errors import RoadproofError
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.periodic import Loop
from roadproof.evidence.refutation import Countermodel, Held, Instant, fault_of, when_true
from roadproof.library.specification import Query
from roadproof.logic import terms as t
from roadproof.logic.custom_names import code_of, kind_of
from roadproof.logic.rewrite import terms_of, vehicles_of
from roadproof.world.signals import FIXED

HELD: tuple[Held, ...] = ("before", "after")
Trace: TypeAlias = tuple[tuple[Instant, ...], Held, Loop | None]


def held_either_way(times: Sequence[Fraction], states: Sequence[Values]) -> Iterator[Trace]:
    """Between two instants the state of the one before, or of the one after."""
    instants = tuple(Instant(time, found, {}) for time, found in zip(times, states, strict=True))
    return ((instants, held, None) for held in HELD)


def realise(
    query: Query,
    atoms: Atoms,
    model: Model,
    defaults: Mapping[str, Fraction],
    bounds: Mapping[str, str],
    traces: Callable[[Sequence[Fraction], Sequence[Values]], Iterable[Trace]] = held_either_way,
) -> Countermodel | None:
    """The model as a trace on which the claim is judged false, or None.

    ``traces``: what can be made of its states, given their times.

    None also where two instants need different values of one parameter or one vehicle's size, and
    where no road is found that has what the model says of lanes and lanelets.
    """
    fixed = _fixed_values(query, model, defaults)
    if fixed is None:
        return None
    states = place(query.formula, atoms, model, fixed)
    times = tuple(model.states)
    parameters = {name: fixed[name] for name in defaults}
    for strict in (True, False):
        layout = layout_of(query.formula, atoms, model, states, strict)
        road = None if layout is None else lay_road(layout)
        if layout is not None and road is None:
            continue
        for instants, held, loop in traces(times, states):
            found = Countermodel(instants, parameters, held, road, loop)
            if fault_of(found, query.formula, bounds) is None:
                return found
        if layout is None:
            break
    return None


def with_truths(found: Countermodel, atoms: Atoms) -> Countermodel:
    """The countermodel with the truth of every predicate that its road and values decide."""
    truths = {}
    for name, meaning in atoms.named.items():
        try:
            truths[name] = when_true(meaning, found)
        except RoadproofError:
            continue
    return replace(
        found,
        instants=tuple(
            replace(instant, atoms={name: truth.at(instant.time) for name, truth in truths.items()})
            for instant in found.instants
        ),
    )


def _fixed_values(query: Query, model: Model, defaults: Mapping[str, Fraction]) -> dict[str, Fraction] | None:
    """One value for every parameter and variable by its name, and for every size by its symbol.

    None where instants disagree.
    """
    fixed: dict[str, Fraction] = {}
    for found in [model.values, *model.signals.values()]:
        for name, value in found.items():
            if isinstance(value, bool) or (name.startswith("|") and not _is_size(name)):
                continue
            if fixed.setdefault(name.removesuffix("."), value) != value:
                return None
    rest: dict[str, Fraction] = dict(defaults)
    for leaf in (leaf for side in terms_of(query.formula) for leaf in t.leaves(side)):
        if isinstance(leaf, t.Variable):
            rest[leaf.name] = Fraction(0)
    for vehicle in vehicles_of(query.formula):
        rest |= {state.symbol(t.Size(name, vehicle)): value for name, value in TYPICAL_SIZE.items()}
    kinds = {name: Fraction(code_of(kind_of(x))) for name, x in fixed.items() if name.startswith("|kind(")}
    return {**rest, **fixed, **kinds}


def _is_size(symbol: str) -> bool:
    return symbol.strip("|").partition("(")[0] in FIXED
