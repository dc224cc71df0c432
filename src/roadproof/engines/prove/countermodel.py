"""Turns a model over finitely many instants into a trace over all of time, on a road, and judges it.

At each instant the model gives a state of all vehicles. Between instants the trace keeps the state of
the instant before (or, as a second try, takes that of the instant after). It is a trace in the paper's
sense, signals as functions of time; it may jump. Lane facts of the model only guide the road: whether the
claim is false there is judged from the numbers.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias, assert_never

from roadproof.engines.prove.roads import ZONES, Box, Place, RoadLayout, build_road
from roadproof.engines.prove.search import Model
from roadproof.engines.prove.states import TYPICAL_SIZE, StateChecker
from roadproof.errors import RoadproofError
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.countermodel import Countermodel, Instant, Interpolation, Loop
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


def place_vehicles(
    formula: Formula, atoms: Atoms, model: Model, fixed: Mapping[str, Fraction]
) -> list[dict[str, Fraction]]:
    """Return the values of all signals, sizes and variables of ``formula`` at each instant, by name.

    Vehicles stand in different places where nothing compares them, and those of different instants far from
    each other unless a comparison would change by that. ``fixed`` gives a value to each parameter, variable
    and size.
    """
    vehicles = sorted({x.vehicle for x in f.subformulas(formula) if isinstance(x, f.Occupies)})
    states = [_instant_values(formula, vehicles, signals, fixed) for signals in model.signals.values()]
    if len(states) == 1 or not vehicles:
        return states
    comparisons = _comparisons(atoms, model)
    for along in (True, False):
        moved = _moved_apart(states, vehicles, along)
        compared = [x for x in comparisons if _speaks_of("s" if along else "d", x)]
        if _truths(compared, model, moved, fixed) == _truths(compared, model, states, fixed):
            return moved
    return states


def _speaks_of(signal: t.SignalName, comparison: Formula) -> bool:
    return any(isinstance(leaf, t.Signal) and leaf.name == signal for leaf in leaves_of(comparison))


def _instant_values(
    formula: Formula,
    vehicles: Sequence[str],
    signals: Mapping[str, Fraction | bool],
    fixed: Mapping[str, Fraction],
) -> Values:
    """Return the values of one instant: known ones, separate places for vehicles, and 0."""
    known = {name.strip("|"): Fraction(x) for name, x in signals.items() if not isinstance(x, bool)}
    values: Values = {}
    for leaf in leaves_of(formula):
        match leaf:
            case t.Variable(name, _):
                values[name] = fixed[name]
            case t.Size(size, vehicle):
                values[f"{size}({vehicle})"] = fixed[state.symbol(leaf)]
            case t.Signal(name, vehicle):
                values[f"{name}({vehicle})"] = known.get(f"{name}({vehicle})", Fraction(0))
            case t.CustomSignal():
                values[leaf.text] = _custom_value(leaf, known.get(state.symbol(leaf).strip("|")))
            case t.Number() | t.Parameter():
                pass
            case _:
                assert_never(leaf)
    reach = max((known[f"s({v})"] for v in vehicles if f"s({v})" in known), default=-GAP)
    top = max((known[f"d({v})"] for v in vehicles if f"d({v})" in known), default=Fraction(0))
    for vehicle in sorted(vehicles, key=lambda v: (_lane_pattern(signals, v), v)):
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


def _custom_value(signal: t.CustomSignal, known: Fraction | None) -> Fraction:
    """Return the value of a custom signal in a model, or else one that its declaration allows."""
    if signal.truth:
        return Fraction(known is not None and known > HALF)
    if known is not None:
        return known
    if signal.low is not None and signal.low > 0:
        return signal.low
    return signal.high if signal.high is not None and signal.high < 0 else Fraction(0)


def _lane_pattern(signals: Mapping[str, Fraction | bool], vehicle: str) -> str:
    """Return a sort key of a vehicle's lane predicates; vehicles with equal keys stand together."""
    literals = sorted(
        (name.replace(f"({vehicle},", "(,"), x) for name, x in signals.items() if f"({vehicle}," in name
    )
    return str([(name, x) for name, x in literals if isinstance(x, bool)])


def _moved_apart(states: Sequence[Values], vehicles: Sequence[str], along: bool) -> list[Values]:
    """Return the states with all vehicles moved along or across, clear of all earlier instants."""
    signal, size = ("s", "length") if along else ("d", "width")
    moved: list[Values] = []
    begin = Fraction(0)
    for placed in states:
        low = min(placed[f"{signal}({v})"] - placed[f"{size}({v})"] for v in vehicles)
        by = begin - low if moved else Fraction(0)
        names = {f"{signal}({v})" for v in vehicles}
        moved.append({name: value + by if name in names else value for name, value in placed.items()})
        begin = max(moved[-1][name] for name in names) + 2 * GAP
    return moved


def _comparisons(atoms: Atoms, model: Model) -> list[Formula]:
    """Return the comparisons in the atoms of a model."""
    spoken = dict.fromkeys(name for truths in model.states.values() for name in truths)
    parts = (part for name in spoken for part in f.subformulas(without_names(atoms.meaning(name))))
    return list(dict.fromkeys(part for part in parts if isinstance(part, f.Compare)))


def _truths(
    compared: Sequence[Formula], model: Model, states: Sequence[Values], fixed: Mapping[str, Fraction]
) -> list[TruthSet]:
    instants = tuple(Instant(time, values, {}) for time, values in zip(model.states, states, strict=True))
    trace = Countermodel(instants, fixed, "before")
    return [when_true(comparison, trace) for comparison in compared]


def road_layout(
    formula: Formula, atoms: Atoms, model: Model, states: Sequence[Mapping[str, Fraction]], strict: bool
) -> RoadLayout | None:
    """Return the road layout for a claim with states at its instants; None for a claim without road.

    ``strict``: a vehicle is in no place unless the model says so.
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
    for part, vehicle, where, positive in _lane_predicates(atoms):
        place = elements.place(where)
        if place is None:
            continue
        if place[0] == "lanelet":
            named.add(place[1])
        for number, signals in enumerate(model.signals.values()):
            true = signals.get(state.opaque(part))
            if true is not None or strict:
                fact = place, number * len(vehicles) + vehicles.index(vehicle)
                (inside if bool(true) == positive else outside).add(fact)
    return RoadLayout(
        tuple(boxes),
        frozenset(inside),
        frozenset(outside - inside),
        tuple(dict.fromkeys([*elements.lanes, *(elements.lane_of(name) for name in elements.lanelets)])),
        {name: (elements.lane_of(name), elements.zones_of(name)) for name in sorted(named)},
        elements.adjacent(),
        _asks_for_each_lanelet(formula),
    )


def _lane_predicates(
    atoms: Atoms,
) -> Iterator[tuple[f.Occupies | f.Some | f.Every, str, f.Domain | str, bool]]:
    """Yield predicates ``a is on l`` and ``a is on a lanelet of D`` (or none), with a, l or D, and sign."""
    for meaning in atoms.named.values():
        for part in f.subformulas(without_names(meaning)):
            match part:
                case f.Some(variable, domain, f.Occupies(vehicle, lanelet)) if variable == lanelet:
                    yield part, vehicle, domain, True
                case f.Every(variable, domain, f.Not(f.Occupies(vehicle, lanelet))) if variable == lanelet:
                    yield part, vehicle, domain, False
                case f.Occupies(vehicle, lanelet):
                    yield part, vehicle, lanelet, True
                case _:  # open: formulas of another shape are no predicates of a lane
                    pass


def _asks_for_each_lanelet(formula: Formula) -> bool:
    """Return whether the formula states more about lanelets than that a vehicle is on one of several."""
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
        """Return a lane that contains the lanelet in the model, or one of its own."""
        if name in self.lanes:
            return name
        candidates = [self.domains[name].of] if self.domains[name].kind == "lanelets" else []
        candidates += [lane for lane in self.lanes if self.facts.get((f.Domain("lanelets", lane), name))]
        return next((lane for lane in candidates if lane in self.lanes), name)

    def zones_of(self, name: str) -> tuple[Zone, ...]:
        """Return the possible zones of the lanelet."""
        truths = {zone: self.facts.get((f.Domain("zone", zone), name)) for zone in ZONES}
        certain = tuple(zone for zone, true in truths.items() if true)
        return certain or tuple(zone for zone, true in truths.items() if true is None)

    def place(self, where: f.Domain | str) -> Place | None:
        """Return the lane, zone or lanelet that a domain or name denotes; None if the model has none."""
        known = {*self.lanes, *self.lanelets}
        match where:
            case str():
                return ("lanelet", where) if where in known else None
            case f.Domain("lanelets", lane):
                return ("lane", self.lane_of(lane)) if lane in known else None
            case f.Domain("zone", zone):
                return "zone", zone
            case f.Domain():
                return None

    def adjacent(self) -> frozenset[frozenset[str]]:
        """Return the pairs of lanes that are adjacent in the model."""
        pairs = (
            frozenset((self.lane_of(domain.of), self.lane_of(name)))
            for (domain, name), true in self.facts.items()
            if true and domain.kind == "adjacent"
        )
        return frozenset(pair for pair in pairs if len(pair) == 2)


HOLDS: tuple[Interpolation, ...] = ("before", "after")
Trace: TypeAlias = tuple[tuple[Instant, ...], Interpolation, Loop | None]


def step_traces(times: Sequence[Fraction], states: Sequence[Values]) -> Iterator[Trace]:
    """Yield traces that hold, between two instants, the state of the one before or of the one after."""
    instants = tuple(Instant(time, values, {}) for time, values in zip(times, states, strict=True))
    return ((instants, hold, None) for hold in HOLDS)


def realise(
    query: Query,
    checker: StateChecker,
    model: Model,
    traces: Callable[[Sequence[Fraction], Sequence[Values]], Iterable[Trace]] = step_traces,
) -> Countermodel | None:
    """Return the model as a trace on which the claim is judged false, or None.

    ``traces``: function from times and states to candidate traces. None also where two instants need
    different values of one parameter or one vehicle's size, and where no road fits the lane facts.
    """
    atoms, defaults = checker.atoms, checker.defaults
    fixed = _fixed_values(query, model, defaults)
    if fixed is None:
        return None
    states = place_vehicles(query.formula, atoms, model, fixed)
    times = tuple(model.states)
    parameters = {name: fixed[name] for name in parameters_of(query.formula)}
    for strict in (True, False):
        layout = road_layout(query.formula, atoms, model, states, strict)
        road = None if layout is None else build_road(layout)
        if layout is not None and road is None:
            continue
        for instants, hold, loop in traces(times, states):
            countermodel = Countermodel(instants, parameters, hold, road, loop)
            if fault_of(countermodel, query.formula, checker.bounds) is None:
                return countermodel
        if layout is None:
            break
    return None


def with_truths(countermodel: Countermodel, atoms: Atoms) -> Countermodel:
    """Return the countermodel with the truth of every predicate that its road and values decide."""
    truths = {}
    for name, meaning in atoms.named.items():
        try:
            truths[name] = when_true(meaning, countermodel)
        except RoadproofError:
            continue
    return replace(
        countermodel,
        instants=tuple(
            replace(instant, atoms={name: truth.at(instant.time) for name, truth in truths.items()})
            for instant in countermodel.instants
        ),
    )


def _fixed_values(query: Query, model: Model, defaults: Mapping[str, Fraction]) -> dict[str, Fraction] | None:
    """Return one value for every parameter and variable by name, and for every size by symbol.

    None where instants disagree.
    """
    fixed: dict[str, Fraction] = {}
    for assignment in [model.values, *model.signals.values()]:
        for name, value in assignment.items():
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
