"""Starts for searches: conditions at time 0 that an engine can read, in place of parts that it cannot.

A part about one instant that has a comparison of degree above 2 is sampled. What it speaks of is set to the
values of a state in which it holds, but for one place along the road, which is left free as far as the judge
says that the part holds. So a start implies the parts; what is found from it is judged on all of the formula.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from roadproof.engines.encode.along import Place, names_places
from roadproof.engines.encode.build import inequality_at
from roadproof.engines.encode.inequalities import inequalities_of, sizes_of
from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.place import span
from roadproof.engines.encode.problem import Leaf, nodes
from roadproof.engines.search.initial_conditions import Condition, Start
from roadproof.engines.search.question import SearchProblem
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import own_of
from roadproof.logic.formula import Formula, boxes_overlap, is_state
from roadproof.logic.initial_conditions import compared, conjuncts, demands
from roadproof.logic.rewrite import signal_degree
from roadproof.logic.terms import Own, Signal, Size
from roadproof.semantics.exact.algebraic import bounds
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.polynomial import Polynomial, polynomial
from roadproof.semantics.exact.signals import LineSignals, unknown_at_instant
from roadproof.semantics.exact.truth import Span
from roadproof.world.signals import FIXED
from roadproof.world.vehicle import Range

if TYPE_CHECKING:
    from roadproof.engines.search.sampling import Space, State

READABLE = 2  # the highest degree that the engine milp bounds
_PLACES: tuple[Place, Place] = ("s", "d")
GRAIN = Fraction(1, 100)  # m; how finely places are rounded (``rounding``)


def unread(question: SearchProblem, lanes: Mapping[str, str]) -> tuple[Formula, ...]:
    """Parts of the conjunction about time 0 that the engine milp cannot read; without own signals."""
    reads = _reader(question)
    found = []
    for part in conjuncts(question.bound(lanes)):
        if not is_state(part) or own_of([part]):
            continue
        if not all(reads(x) for x in f.subformulas(part) if isinstance(x, f.Compare)):
            found.append(part)
    return tuple(dict.fromkeys(found))


def closed(question: SearchProblem, lanes: Mapping[str, str]) -> frozenset[f.Compare]:
    """What it cannot read of time 0 in other parts, which say it beside what they say of later times."""
    reads = _reader(question)
    others = (part for part in conjuncts(question.bound(lanes)) if not is_state(part))
    found = {x for part in others for x in compared(part) if not own_of([x])}
    return frozenset(x for x in found if not reads(x))


def _reader(question: SearchProblem) -> Callable[[f.Compare], bool]:
    """Whether the engine milp reads a comparison about time 0."""
    layout = Layout(tuple(question.vehicles), question.grid)
    sizes = sizes_of(question.vehicles)

    def reads(part: f.Compare) -> bool:
        degrees = signal_degree(part.left), signal_degree(part.right)
        if all(degree is not None and degree <= READABLE for degree in degrees):
            return True
        leaves = (x.content for x in nodes(inequalities_of(part, sizes)) if isinstance(x, Leaf))
        return all(inequality_at(x, layout, 0).polynomial.degree <= READABLE for x in leaves)

    return reads


def is_read(question: SearchProblem) -> bool:
    """Whether the engine milp can read all that is said of time 0."""
    return not any(unread(question, lanes) or closed(question, lanes) for lanes in question.lanes)


def starts(
    question: SearchProblem, lanes: Mapping[str, str], parts: tuple[Formula, ...], most: int
) -> Iterator[Start]:
    """At most ``most`` starts in place of ``parts`` (``unread``), unlike each other; ``closed`` is let go.

    None where no state is found; where there are no parts, one without conditions.
    """
    let_go = closed(question, lanes)
    if not parts:
        yield Start(lanes, (), frozenset(), let_go)
        return
    from roadproof.engines.search.sampling import signals_in, states  # here: few questions need numpy for it

    together = f.conjunction(*parts)
    formula = f.conjunction(demands(question.bound(lanes)), *_surroundings(question))
    space = space_of(question)
    spoken = [x for x in space.ranges if x in set(signals_in(together))]
    beside = _beside(together, spoken, question)
    for state in states(formula, space, most):
        found = conditions(together, state, spoken, beside, space)
        yield Start(lanes, found, frozenset(parts), let_go)


def space_of(question: SearchProblem) -> "Space":
    """Where vehicles can be at time 0, and how fast, within their limits."""
    from roadproof.engines.search.sampling import Space

    right, left = span(question.road)
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


def _surroundings(question: SearchProblem) -> Iterator[Formula]:
    """What every drive of a search keeps at its start, beside ranges."""
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


def conditions(
    parts: Formula, state: "State", spoken: Sequence[Signal], beside: Mapping[Signal, Signal], space: "Space"
) -> tuple[Condition, ...]:
    """What implies ``parts``, which hold in ``state``: values of what is spoken of, a place in a range.

    ``beside``: places that are said relative to that of another vehicle.
    """
    others = set(beside.values())
    ranges = {x: (state[x], state[x]) for x in spoken if x.name != "j_lon" and x not in others}
    free = [(_free(parts, x, state, space), x) for x in ranges if x.name == "s"]
    if free:
        widest, signal = max(free, key=lambda x: x[0][1] - x[0][0])
        ranges[signal] = widest
    found = []
    for signal, (low, high) in ranges.items():
        shift = state[beside[signal]] if signal in beside else Fraction(0)
        found.append(Condition(signal, beside.get(signal), low - shift, high - shift))
    return tuple(found)


def _beside(parts: Formula, spoken: Sequence[Signal], question: SearchProblem) -> dict[Signal, Signal]:
    """Places relative to that of the first vehicle, where ``parts`` do not change when all are moved."""
    beside: dict[Signal, Signal] = {}
    for name in _PLACES:
        same = [x for x in spoken if x.name == name]
        if len(same) > 1 and not names_places(parts, question.vehicles, name):
            beside |= dict.fromkeys(same[1:], same[0])
    return beside


def _free(parts: Formula, signal: Signal, state: "State", space: "Space") -> Range:
    """Around its value in ``state``, where the signal may be with the others as they are: ends on a grid."""
    low, high = space.ranges[signal]
    value = state[signal]
    courses: dict[Signal | Own, Polynomial] = {x: polynomial(known) for x, known in state.items()}
    courses[signal] = polynomial(low, Fraction(1))
    truth = judge(parts, LineSignals(courses, space.sizes, unknown_at_instant)).truth(parts)
    span = next((x for x in truth.spans() if _has(x, value - low)), None)
    if span is None:
        return value, value
    begin = low + bounds(span.begin.point, GRAIN / 10)[1]
    end = high if span.end is None else min(high, low + bounds(span.end.point, GRAIN / 10)[0])
    inner = (begin // GRAIN + 2) * GRAIN, (end // GRAIN - 1) * GRAIN
    return inner if inner[0] <= value <= inner[1] else (value, value)


def _has(span: Span, place: Fraction) -> bool:
    begin, end = span
    after = begin.point < place or (begin.point == place and not begin.after)
    return after and (end is None or place < end.point or (place == end.point and end.after))
