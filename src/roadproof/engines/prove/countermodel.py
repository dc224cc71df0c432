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

from roadproof.engines.prove.roads import ZONES, Box, Layout, Place, lay_road
from roadproof.engines.prove.search import Model
from roadproof.engines.prove.states import TYPICAL_SIZE, StateChecker
from roadproof.errors import RoadproofError
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.countermodel import Countermodel, Held, Instant, Loop
from roadproof.evidence.refutation import fault_of, when_true
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import HALF, code_of, kind_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import leaves_of, parameters_of, vehicles_of, without_names
from roadproof.semantics.exact import TruthSet
from roadproof.world.road import Zone
from roadproof.world.signals import FIXED

GAP = Fraction(10)
Values = dict[str, Fraction]


def place(
    formula: Formula, atoms: Atoms, model: Model, fixed: Mapping[str, Fraction]
) -> list[dict[str, Fraction]]:
    """The values of all signals, sizes and variables of ``formula`` at each instant, by name.

    Vehicles stand in different places where nothing compares them, and those of different instants
    far from each other unless a comparison would change by that. ``fixed`` gives a value to each
    parameter, variable and size.
    """
    vehicles = sorted({x.vehicle for x in f.subformulas(formula) if isinstance(x, f.Occupies)})
    states = [_standing(formula, vehicles, found, fixed) for found in model.signals.values()]
    if len(states) == 1 or not vehicles:
        return states
    comparisons = _comparisons(atoms, model)
    for along in (True, False):
        moved = _apart(states, vehicles, along)
        compared = [x for x in comparisons if _speaks_of("s" if along else "d", x)]
        if _truths(compared, model, moved, fixed) == _truths(compared, model, states, fixed):
            return moved
    return states


def _speaks_of(signal: t.SignalName, comparison: Formula) -> bool:
    return any(isinstance(leaf, t.Signal) and leaf.name == signal for leaf in leaves_of(comparison))


def _standing(
    formula: Formula,
    vehicles: Sequence[str],
    found: Mapping[str, Fraction | bool],
    fixed: Mapping[str, Fraction],
) -> Values:
    """The values of one instant: those that are known, vehicles in places of their own, and 0."""
    known = {name.strip("|"): Fraction(x) for name, x in found.items() if not isinstance(x, bool)}
    values: Values = {}
    for leaf in leaves_of(formula):
        match leaf:
            case t.Variable(name, _):
                values[name] = fixed[name]
            case t.Size(size, vehicle):
                values[f"{size}({vehicle})"] = fixed[state.symbol(leaf)]
            case t.Signal(name, vehicle):
                values[f"{name}({vehicle})"] = known.get(f"{name}({vehicle})", Fraction(0))
            case t.Own():
                values[leaf.told] = _own_value(leaf, known.get(state.symbol(leaf).strip("|")))
            case _:
                pass
    reach = max((known[f"s({v})"] for v in vehicles if f"s({v})" in known), default=-GAP)
    top = max((known[f"d({v})"] for v in vehicles if f"d({v})" in known), default=Fraction(0))
    for vehicle in sorted(vehicles, key=lambda v: (_pattern(found, v), v)):
        s, d = f"s({vehicle})", f"d({vehicle})"
        length, width = (fixed[state.symbol(t.Size(size, vehicle))] for size in t.SIZE_DIMENSIONS)
        values |= {f"length({vehicle})": length, f"width({vehicle})": width}
        values[s], values[d] = known.get(s, Fraction(0)), known.get(d, width)
        if s not in known:
            reach += GAP + length
            values[s] = reach
        elif d not in known:
            top += GAP / 2 + width
            values[d] = top
    return values


def _own_value(own: t.Own, known: Fraction | None) -> Fraction:
    """The value of an own signal in a model, or else one that its declaration allows."""
    if own.truth:
        return Fraction(known is not None and known > HALF)
    if known is not None:
        return known
    if own.low is not None and own.low > 0:
        return own.low
    return own.high if own.high is not None and own.high < 0 else Fraction(0)


def _pattern(found: Mapping[str, Fraction | bool], vehicle: str) -> str:
    """What is said of a vehicle's lanes; vehicles of which the same is said are to stand together."""
    said = sorted(
        (name.replace(f"({vehicle},", "(,"), x) for name, x in found.items() if f"({vehicle}," in name
    )
    return str([(name, x) for name, x in said if isinstance(x, bool)])


def _apart(states: Sequence[Values], vehicles: Sequence[str], along: bool) -> list[Values]:
    """The states with all vehicles moved along or across, where none of an earlier instant stands."""
    signal, size = ("s", "length") if along else ("d", "width")
    moved: list[Values] = []
    begin = Fraction(0)
    for found in states:
        low = min(found[f"{signal}({v})"] - found[f"{size}({v})"] for v in vehicles)
        by = begin - low if moved else Fraction(0)
        names = {f"{signal}({v})" for v in vehicles}
        moved.append({name: value + by if name in names else value for name, value in found.items()})
        begin = max(moved[-1][name] for name in names) + 2 * GAP
    return moved


def _comparisons(atoms: Atoms, model: Model) -> list[Formula]:
    """The comparisons in what the model says of its instants."""
    spoken = dict.fromkeys(name for said in model.states.values() for name in said)
    parts = (part for name in spoken for part in f.subformulas(without_names(atoms.meaning(name))))
    return list(dict.fromkeys(part for part in parts if isinstance(part, f.Compare)))


def _truths(
    compared: Sequence[Formula], model: Model, states: Sequence[Values], fixed: Mapping[str, Fraction]
) -> list[TruthSet]:
    instants = tuple(Instant(time, found, {}) for time, found in zip(model.states, states, strict=True))
    trace = Countermodel(instants, fixed, "before")
    return [when_true(comparison, trace) for comparison in compared]


def layout_of(
    formula: Formula, atoms: Atoms, model: Model, states: Sequence[Mapping[str, Fraction]], strict: bool
) -> Layout | None:
    """The layout for a claim with states at its instants; None where the claim speaks of no road.

    ``strict``: a vehicle is in no place of which the model does not say that it is.
    """
    if not any(isinstance(x, f.Occupies | f.Some | f.Every) for x in f.subformulas(formula)):
        return None
    vehicles = sorted({x.vehicle for x in f.subformulas(formula) if isinstance(x, f.Occupies)})
    elements = _Elements(model)
    boxes = [
        Box(x[f"s({v})"] - x[f"length({v})"], x[f"s({v})"], x[f"d({v})"] - x[f"width({v})"], x[f"d({v})"])
        for x in states
        for v in vehicles
    ]
    inside: set[tuple[Place, int]] = set()
    outside: set[tuple[Place, int]] = set()
    named = set(elements.lanelets)
    for part, vehicle, where, positive in _plain(atoms):
        place = elements.place(where)
        if place is None:
            continue
        if place[0] == "lanelet":
            named.add(place[1])
        for number, found in enumerate(model.signals.values()):
            true = found.get(state.opaque(part))
            if true is not None or strict:
                fact = place, number * len(vehicles) + vehicles.index(vehicle)
                (inside if bool(true) == positive else outside).add(fact)
    return Layout(
        tuple(boxes),
        frozenset(inside),
        frozenset(outside - inside),
        tuple(dict.fromkeys([*elements.lanes, *(elements.lane_of(name) for name in elements.lanelets)])),
        {name: (elements.lane_of(name), elements.zones_of(name)) for name in sorted(named)},
        elements.adjacent(),
        _asks_for_each_lanelet(formula),
    )


def _plain(atoms: Atoms) -> Iterator[tuple[f.Occupies | f.Some | f.Every, str, f.Domain | str, bool]]:
    """Predicates ``a is on l`` and ``a is on a lanelet of D``, or on none of D, with their a and l or D."""
    for meaning in atoms.named.values():
        for part in f.subformulas(without_names(meaning)):
            match part:
                case f.Some(variable, domain, f.Occupies(vehicle, lanelet)) if variable == lanelet:
                    yield part, vehicle, domain, True
                case f.Every(variable, domain, f.Not(f.Occupies(vehicle, lanelet))) if variable == lanelet:
                    yield part, vehicle, domain, False
                case f.Occupies(vehicle, lanelet):
                    yield part, vehicle, lanelet, True
                case _:
                    pass


def _asks_for_each_lanelet(formula: Formula) -> bool:
    """Whether more is said of lanelets than that a vehicle is on one of several."""
    return any(
        isinstance(x, f.Some | f.Every)
        and x.domain.kind in ("lanelets", "zone")
        and not isinstance(x.body, f.Occupies)
        for x in f.subformulas(formula)
    )


class _Elements:
    """The lanes and lanelets of a model; a lane's name may stand for one of its lanelets, too."""

    def __init__(self, model: Model) -> None:
        self.facts = model.facts
        self.domains = model.elements
        kinds = {name: domain.kind for name, domain in model.elements.items()}
        self.lanes = [name for name, kind in kinds.items() if kind in ("lanes", "adjacent")]
        self.lanelets = [name for name, kind in kinds.items() if kind in ("lanelets", "zone")]

    def lane_of(self, name: str) -> str:
        """A lane that the lanelet is said to be in, or one of its own."""
        if name in self.lanes:
            return name
        said = [self.domains[name].of] if self.domains[name].kind == "lanelets" else []
        said += [lane for lane in self.lanes if self.facts.get((f.Domain("lanelets", lane), name))]
        return next((lane for lane in said if lane in self.lanes), name)

    def zones_of(self, name: str) -> tuple[Zone, ...]:
        """The zones in which the lanelet can be."""
        said = {zone: self.facts.get((f.Domain("zone", zone), name)) for zone in ZONES}
        certain = tuple(zone for zone, true in said.items() if true)
        return certain or tuple(zone for zone, true in said.items() if true is None)

    def place(self, where: f.Domain | str) -> Place | None:
        known = {*self.lanes, *self.lanelets}
        match where:
            case str():
                return ("lanelet", where) if where in known else None
            case f.Domain("lanelets", lane):
                return ("lane", self.lane_of(lane)) if lane in known else None
            case f.Domain("zone", zone):
                return "zone", zone
            case _:
                return None

    def adjacent(self) -> frozenset[frozenset[str]]:
        pairs = (
            frozenset((self.lane_of(domain.of), self.lane_of(name)))
            for (domain, name), true in self.facts.items()
            if true and domain.kind == "adjacent"
        )
        return frozenset(pair for pair in pairs if len(pair) == 2)


HELD: tuple[Held, ...] = ("before", "after")
Trace: TypeAlias = tuple[tuple[Instant, ...], Held, Loop | None]


def held_either_way(times: Sequence[Fraction], states: Sequence[Values]) -> Iterator[Trace]:
    """Between two instants the state of the one before, or of the one after."""
    instants = tuple(Instant(time, found, {}) for time, found in zip(times, states, strict=True))
    return ((instants, held, None) for held in HELD)


def realise(
    query: Query,
    checker: StateChecker,
    model: Model,
    traces: Callable[[Sequence[Fraction], Sequence[Values]], Iterable[Trace]] = held_either_way,
) -> Countermodel | None:
    """The model as a trace on which the claim is judged false, or None.

    ``traces``: what can be made of its states, given their times.

    None also where two instants need different values of one parameter or one vehicle's size, and
    where no road is found that has what the model says of lanes and lanelets.
    """
    atoms, defaults = checker.atoms, checker.defaults
    fixed = _fixed_values(query, model, defaults)
    if fixed is None:
        return None
    states = place(query.formula, atoms, model, fixed)
    times = tuple(model.states)
    parameters = {name: fixed[name] for name in parameters_of(query.formula)}
    for strict in (True, False):
        layout = layout_of(query.formula, atoms, model, states, strict)
        road = None if layout is None else lay_road(layout)
        if layout is not None and road is None:
            continue
        for instants, held, loop in traces(times, states):
            found = Countermodel(instants, parameters, held, road, loop)
            if fault_of(found, query.formula, checker.bounds) is None:
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
    for leaf in leaves_of(query.formula):
        if isinstance(leaf, t.Variable):
            rest[leaf.name] = Fraction(0)
    for vehicle in vehicles_of(query.formula):
        rest |= {state.symbol(t.Size(name, vehicle)): value for name, value in TYPICAL_SIZE.items()}
    kinds = {name: Fraction(code_of(kind_of(x))) for name, x in fixed.items() if name.startswith("|kind(")}
    return {**rest, **fixed, **kinds}


def _is_size(symbol: str) -> bool:
    return symbol.strip("|").partition("(")[0] in FIXED
