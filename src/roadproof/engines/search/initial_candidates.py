"""Starts for searches: encodable conditions at time 0 in place of parts that an engine cannot encode.

A part about one instant with a comparison of degree above 2 is sampled. Its signals are set to a state in
which it holds, except one place along the road, which stays free as far as the judge confirms the part.
So a start implies the parts; what is found from it is judged on all of the formula.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from roadproof.engines.encode.build import inequality_at
from roadproof.engines.encode.inequalities import inequalities_of, sizes_of
from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.place import road_edges
from roadproof.engines.encode.problem import Leaf, Origin, nodes
from roadproof.engines.encode.shift_invariance import Place, depends_on_place
from roadproof.engines.search.initial_conditions import Condition, Start
from roadproof.engines.search.question import SearchProblem
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import custom_signals_of
from roadproof.logic.formula import Formula, boxes_overlap, is_state
from roadproof.logic.initial_conditions import comparisons_at_start, necessary_at_start, top_level_conjuncts
from roadproof.logic.rewrite import signal_degree
from roadproof.logic.terms import CustomSignal, Signal, Size
from roadproof.semantics.exact.algebraic import bounds
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.polynomial import TimePolynomial, polynomial
from roadproof.semantics.exact.signals import LineSignals, unknown_at_instant
from roadproof.semantics.exact.truth import Span
from roadproof.world.signals import FIXED
from roadproof.world.vehicle import Range

if TYPE_CHECKING:
    from roadproof.engines.search.sampling import Space, State

READABLE = 2  # the highest degree that the engine milp bounds
_PLACES: tuple[Place, Place] = ("s", "d")
GRAIN = Fraction(1, 100)  # m; how finely places are rounded (``rounding``)


def not_encodable(question: SearchProblem, lanes: Mapping[str, str]) -> tuple[Formula, ...]:
    """Return parts about time 0 that the engine milp cannot encode, except those with custom signals."""
    reads = _encodability_test(question)
    unreadable = []
    for part in top_level_conjuncts(question.bound(lanes)):
        if not is_state(part) or custom_signals_of([part]):
            continue
        if not all(reads(x) for x in f.subformulas(part) if isinstance(x, f.Compare)):
            unreadable.append(part)
    return tuple(dict.fromkeys(unreadable))


def not_encodable_comparisons(question: SearchProblem, lanes: Mapping[str, str]) -> frozenset[f.Compare]:
    """Return comparisons at time 0 that milp cannot encode, in parts that also speak of later times."""
    reads = _encodability_test(question)
    others = (part for part in top_level_conjuncts(question.bound(lanes)) if not is_state(part))
    comparisons = {x for part in others for x in comparisons_at_start(part) if not custom_signals_of([x])}
    return frozenset(x for x in comparisons if not reads(x))


def _encodability_test(question: SearchProblem) -> Callable[[f.Compare], bool]:
    """Return a test whether the engine milp can encode a comparison at time 0."""
    layout = ColumnLayout(tuple(question.vehicles), question.grid)
    sizes = sizes_of(question.vehicles)

    def reads(part: f.Compare) -> bool:
        """Return whether both sides, or all their polynomials, have degree 2 at most."""
        degrees = signal_degree(part.left), signal_degree(part.right)
        if all(degree is not None and degree <= READABLE for degree in degrees):
            return True
        leaves = (x.content for x in nodes(inequalities_of(part, sizes)) if isinstance(x, Leaf))
        return all(inequality_at(x, layout, Origin(part, 0)).polynomial.degree <= READABLE for x in leaves)

    return reads


def is_encodable(question: SearchProblem) -> bool:
    """Return whether the engine milp can encode all conditions at time 0."""
    return not any(
        not_encodable(question, lanes) or not_encodable_comparisons(question, lanes)
        for lanes in question.lanes
    )


def sampled_starts(
    question: SearchProblem, lanes: Mapping[str, str], parts: tuple[Formula, ...], most: int
) -> Iterator[Start]:
    """Yield at most ``most`` starts, unlike each other, that imply ``parts`` (from ``not_encodable``).

    Nothing where no state is found; without parts, one start without conditions.
    """
    let_go = not_encodable_comparisons(question, lanes)
    if not parts:
        yield Start(lanes, (), frozenset(), let_go)
        return
    from roadproof.engines.search.sampling import signals_in, states  # here: few questions need numpy for it

    together = f.conjunction(*parts)
    formula = f.conjunction(necessary_at_start(question.bound(lanes)), *_start_limits(question))
    space = space_of(question)
    spoken = [x for x in space.ranges if x in set(signals_in(together))]
    beside = _relative_places(together, spoken, question)
    for state in states(formula, space, most):
        chosen = start_conditions(together, state, spoken, beside, space)
        yield Start(lanes, chosen, frozenset(parts), let_go)


def space_of(question: SearchProblem) -> "Space":
    """Return the ranges of places and speeds of vehicles at time 0, within their limits."""
    from roadproof.engines.search.sampling import Space

    right, left = road_edges(question.road)
    inside = question.assumptions.inside
    reach = question.assumptions.reach
    ranges: dict[Signal, Range] = {}
    along: Range = -reach, reach
    if question.starts is not None:
        ends = [end for x in question.road.lanelets for end in x.s if end is not None] or [Fraction(0)]
        along = max(question.starts[0], min(ends) - reach), min(question.starts[1], max(ends) + reach)
    for name, vehicle in question.vehicles.items():
        ranges |= {
            Signal("s", name): along,
            Signal("d", name): (right + vehicle.width, left),
            Signal("v_lon", name): vehicle.v_lon,
            Signal("v_lat", name): vehicle.v_lat,
            Signal("a_lon", name): (vehicle.a_lon[0] + inside, vehicle.a_lon[1] - inside),
            Signal("a_lat", name): (vehicle.a_lat[0] + inside, vehicle.a_lat[1] - inside),
            Signal("j_lon", name): (Fraction(0), Fraction(0)),
        }
    if question.starts is None:
        ranges[Signal("s", next(iter(question.vehicles)))] = Fraction(0), Fraction(0)
    return Space(ranges, sizes_in(question))


def sizes_in(question: SearchProblem) -> dict[Size, Fraction]:
    """The sizes and kinds of all vehicles."""
    known = sizes_of(question.vehicles)
    return {Size(name, v): known[v, name] for v in question.vehicles for name in FIXED if (v, name) in known}


def _start_limits(question: SearchProblem) -> Iterator[Formula]:
    """Yield the relations between signals that every drive of a search satisfies at its start."""
    inside = t.number(question.assumptions.inside, (1, -1))
    for name, vehicle in question.vehicles.items():
        fastest = t.subtract(t.Product((t.number(vehicle.lateral_share), Signal("v_lon", name))), inside)
        lateral = Signal("v_lat", name)
        yield f.Compare(lateral, "<=", fastest)
        yield f.Compare(t.negate(lateral), "<=", fastest)
    reach = t.number(question.assumptions.reach, (1, 0))
    for a, b in combinations(question.vehicles, 2):
        yield f.Compare(t.subtract(Signal("s", a), Signal("s", b)), "<=", reach)
        yield f.Compare(t.subtract(Signal("s", b), Signal("s", a)), "<=", reach)
        if not question.assumptions.collisions:
            yield f.negation(boxes_overlap(a, b))


# --- a state becomes conditions ----------------------------------------------------------------


def start_conditions(
    parts: Formula, state: "State", spoken: Sequence[Signal], beside: Mapping[Signal, Signal], space: "Space"
) -> tuple[Condition, ...]:
    """Return conditions that imply ``parts``, which hold in ``state``: signal values, one place as a range.

    ``beside``: signals given relative to that of another vehicle.
    """
    others = set(beside.values())
    ranges = {x: (state[x], state[x]) for x in spoken if x.name != "j_lon" and x not in others}
    free = [(_free_range(parts, x, state, space), x) for x in ranges if x.name == "s"]
    if free:
        widest, signal = max(free, key=lambda x: x[0][1] - x[0][0])
        ranges[signal] = widest
    made = []
    for signal, (low, high) in ranges.items():
        shift = state[beside[signal]] if signal in beside else Fraction(0)
        made.append(Condition(signal, beside.get(signal), low - shift, high - shift))
    return tuple(made)


def _relative_places(
    parts: Formula, spoken: Sequence[Signal], question: SearchProblem
) -> dict[Signal, Signal]:
    """Return places given relative to the first vehicle, where moving all leaves ``parts`` unchanged."""
    beside: dict[Signal, Signal] = {}
    for name in _PLACES:
        same = [x for x in spoken if x.name == name]
        if len(same) > 1 and not depends_on_place(parts, question.vehicles, name):
            beside |= dict.fromkeys(same[1:], same[0])
    return beside


def _free_range(parts: Formula, signal: Signal, state: "State", space: "Space") -> Range:
    """Return the range around its value in ``state`` that a signal may have; ends lie on a grid."""
    low, high = space.ranges[signal]
    value = state[signal]
    courses: dict[Signal | CustomSignal, TimePolynomial] = {
        x: polynomial(known) for x, known in state.items()
    }
    courses[signal] = polynomial(low, Fraction(1))
    truth = judge(parts, LineSignals(courses, space.sizes, unknown_at_instant)).truth(parts)
    road_edges = next((x for x in truth.spans() if _has(x, value - low)), None)
    if road_edges is None:
        return value, value
    begin = low + bounds(road_edges.begin.point, GRAIN / 10)[1]
    end = high if road_edges.end is None else min(high, low + bounds(road_edges.end.point, GRAIN / 10)[0])
    inner = (begin // GRAIN + 2) * GRAIN, (end // GRAIN - 1) * GRAIN
    return inner if inner[0] <= value <= inner[1] else (value, value)


def _has(road_edges: Span, place: Fraction) -> bool:
    begin, end = road_edges
    after = begin.point < place or (begin.point == place and not begin.after)
    return after and (end is None or place < end.point or (place == end.point and end.after))
