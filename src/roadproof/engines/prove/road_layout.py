"""What a model says of lanes, zones and lanelets, as the layout of a road to be made."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from roadproof.engines.prove.roads import ZONES, Box, Layout, Place
from roadproof.engines.prove.search import Model
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.world.road import Zone


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
