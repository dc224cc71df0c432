"""Where the vehicles of a model stand at each instant: as it says, and apart where it says nothing."""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from roadproof.engines.prove.search import Model
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.refutation import Countermodel, Instant, when_true
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import HALF
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import terms_of, without_names
from roadproof.semantics.exact import TruthSet

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
    compared = _comparisons(atoms, model)
    before = _truths(compared, model, states, fixed)
    for along in (True, False):
        moved = _apart(states, vehicles, along)
        if _truths(compared, model, moved, fixed) == before:
            return moved
    return states


def _standing(
    formula: Formula,
    vehicles: Sequence[str],
    found: Mapping[str, Fraction | bool],
    fixed: Mapping[str, Fraction],
) -> Values:
    """The values of one instant: those that are known, vehicles in places of their own, and 0."""
    known = {name.strip("|"): Fraction(x) for name, x in found.items() if not isinstance(x, bool)}
    values: Values = {}
    for leaf in (leaf for side in terms_of(formula) for leaf in t.leaves(side)):
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
