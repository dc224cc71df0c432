"""The formula tree: signal temporal logic over comparisons of terms.

Sugar dies at construction: there is no implication node, and ``!=`` is a negated equality.
``Application`` remembers which definition a sub-formula came from; it means what its body means.
Quantifiers over lanes and lanelets stay in the tree until a road is chosen (``library.bind``).

Semantics (semantics §1; paper, Table *Boolean semantics of STL*): time is dense and starts at 0.
``Until(φ, J, ψ)`` at T: some t in J has ψ at T+t and φ at T+t' for every t' < t in J.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from operator import is_
from typing import Literal, TypeAlias, assert_never

from roadproof.logic.node import node, once
from roadproof.logic.terms import Number, Signal, Size, Term, number, subtract

Comparison: TypeAlias = Literal["<", "<=", ">", ">="]
DomainKind: TypeAlias = Literal["lanes", "adjacent", "lanelets", "zone"]
NEGATED: Mapping[Comparison, Comparison] = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
MIRRORED: Mapping[Comparison, Comparison] = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}


@node
class Truth:
    value: bool


@node
class Compare:
    """``left op right``; strictness is exactly as written."""

    left: Term
    op: Comparison
    right: Term


@node
class Occupies:
    """occ(vehicle, lanelet): box and lanelet overlap with positive area (semantics §4)."""

    vehicle: str
    lanelet: str


@node
class Domain:
    """A finite set of road elements.

    ``lanes``: all lanes; ``adjacent``: adjLanes(of); ``lanelets``: those of lane ``of``;
    ``zone``: lanelets whose zone is ``of`` (main, merge or depart).
    """

    kind: DomainKind
    of: str = ""


@node
class Some:
    """Disjunction over a domain; false on an empty one."""

    variable: str
    domain: Domain
    body: "Formula"


@node
class Every:
    """Conjunction over a domain; true on an empty one."""

    variable: str
    domain: Domain
    body: "Formula"


@node
class Not:
    body: "Formula"


@node
class And:
    parts: tuple["Formula", ...]


@node
class Or:
    parts: tuple["Formula", ...]


@node
class Interval:
    """Closed interval [low, high] of seconds; ``high`` None is unbounded.

    Bounds have no signals: they are rationals, or symbolic in parameters for the prover.
    """

    low: Term
    high: Term | None


@node
class Until:
    left: "Formula"
    interval: Interval
    right: "Formula"


@node
class Eventually:
    interval: Interval
    body: "Formula"


@node
class Always:
    interval: Interval
    body: "Formula"


@node
class Application:
    """An application of a definition, kept for reading and for opaque atoms; means ``body``."""

    name: str
    arguments: tuple[str, ...]
    body: "Formula"


State: TypeAlias = Truth | Compare | Occupies
Temporal: TypeAlias = Until | Eventually | Always
Formula: TypeAlias = State | Some | Every | Not | And | Or | Temporal | Application

TRUE = Truth(True)
FALSE = Truth(False)
ZERO: Number = number(0, (0, 1))
FOREVER = Interval(ZERO, None)


def negation(body: Formula) -> Formula:
    """``not body``, without double negations."""
    match body:
        case Truth(value):
            return Truth(not value)
        case Not(inner):
            return inner
        case _:
            return Not(body)


def conjunction(*parts: Formula) -> Formula:
    """All of ``parts``; of none it is true, of one that one."""
    kept = tuple(p for p in parts if p != TRUE)
    if FALSE in kept:
        return FALSE
    return TRUE if not kept else kept[0] if len(kept) == 1 else And(kept)


def disjunction(*parts: Formula) -> Formula:
    """Some of ``parts``; of none it is false, of one that one."""
    kept = tuple(p for p in parts if p != FALSE)
    if TRUE in kept:
        return TRUE
    return FALSE if not kept else kept[0] if len(kept) == 1 else Or(kept)


def implication(premise: Formula, conclusion: Formula) -> Formula:
    """``premise -> conclusion``."""
    return disjunction(negation(premise), conclusion)


def equivalence(left: Formula, right: Formula) -> Formula:
    """``left <-> right``."""
    return conjunction(implication(left, right), implication(right, left))


def children(formula: Formula) -> tuple[Formula, ...]:
    """The direct sub-formulas of ``formula``."""
    match formula:
        case Truth() | Compare() | Occupies():
            return ()
        case And(parts) | Or(parts):
            return parts
        case Until(left, _, right):
            return (left, right)
        case (
            Not(body)
            | Eventually(_, body)
            | Always(_, body)
            | Some(_, _, body)
            | Every(_, _, body)
            | Application(_, _, body)
        ):
            return (body,)
        case _:
            assert_never(formula)


def with_children(formula: Formula, new: tuple[Formula, ...]) -> Formula:
    """``formula`` with its direct sub-formulas replaced, in the order of ``children``.

    It is ``formula`` itself where these are the same objects, and what is known of it stays known.
    """
    match formula:
        case Truth() | Compare() | Occupies():
            return formula
        case And(parts) | Or(parts):
            return formula if all(map(is_, new, parts)) else type(formula)(new)
        case Not(body):
            return formula if new[0] is body else Not(new[0])
        case Until(left, interval, right):
            return formula if new[0] is left and new[1] is right else Until(new[0], interval, new[1])
        case Eventually(interval, body) | Always(interval, body):
            return formula if new[0] is body else type(formula)(interval, new[0])
        case Some(variable, domain, body) | Every(variable, domain, body):
            return formula if new[0] is body else type(formula)(variable, domain, new[0])
        case Application(name, arguments, body):
            return formula if new[0] is body else Application(name, arguments, new[0])
        case _:
            assert_never(formula)


def intervals(formula: Formula) -> tuple[Interval, ...]:
    """The intervals of ``formula`` itself, not of what is inside it; of a state formula none."""
    match formula:
        case Until(_, interval, _) | Eventually(interval, _) | Always(interval, _):
            return (interval,)
        case Truth() | Compare() | Occupies() | Some() | Every() | Not() | And() | Or() | Application():
            return ()
        case _:
            assert_never(formula)


def with_intervals(formula: Formula, change: Callable[[Interval], Interval]) -> Formula:
    """``formula`` with ``change`` applied to each of its ``intervals``."""
    match formula:
        case Until(left, interval, right):
            return Until(left, change(interval), right)
        case Eventually(interval, body) | Always(interval, body):
            return type(formula)(change(interval), body)
        case Truth() | Compare() | Occupies() | Some() | Every() | Not() | And() | Or() | Application():
            return formula
        case _:
            assert_never(formula)


def subformulas(*formulas: Formula) -> Iterator[Formula]:
    """Every distinct sub-formula once, parents before children, of one formula after the other."""
    seen: set[Formula] = set()
    for whole in formulas:
        waiting = [whole]
        while waiting:
            current = waiting.pop()
            if current in seen:
                continue
            seen.add(current)
            yield current
            waiting.extend(reversed(children(current)))


def nesting(formula: Formula) -> dict[Application, int]:
    """Every application of a definition, as ``subformulas`` orders them, and in how many others it is."""
    found: dict[Application, int] = {}
    seen: set[Formula] = set()
    waiting = [(formula, 0)]
    while waiting:
        current, depth = waiting.pop()
        if current in seen:
            continue
        seen.add(current)
        if isinstance(current, Application):
            found[current] = depth
            depth += 1
        waiting.extend((child, depth) for child in reversed(children(current)))
    return found


@once
def is_state(formula: Formula) -> bool:
    """Whether ``formula`` speaks about one instant only: no temporal operator inside."""
    return not isinstance(formula, Temporal) and all(map(is_state, children(formula)))


def share(
    formulas: Iterable[Formula],
    change: Callable[[Formula], Formula],
    known: dict[Formula, Formula] | None = None,
) -> list[Formula]:
    """As ``transform`` of each, with one object for all sub-formulas that are equal.

    Whatever compares them has then no need to look inside. ``known``: the objects of earlier calls, which
    takes those of this one.
    """
    pool: dict[Formula, Formula] = {} if known is None else known
    done: dict[int, tuple[Formula, Formula]] = {}  # an object keeps its id while it is held

    def visit(current: Formula) -> Formula:
        if id(current) not in done:
            parts = tuple(visit(child) for child in children(current))
            made = change(with_children(current, parts))
            done[id(current)] = current, pool.setdefault(made, made)
        return done[id(current)][1]

    return [visit(formula) for formula in formulas]


def transform(formula: Formula, change: Callable[[Formula], Formula]) -> Formula:
    """``formula`` rebuilt from its leaves up, ``change`` applied to every rebuilt node once."""

    done: dict[Formula, Formula] = {}

    def visit(current: Formula) -> Formula:
        made = done.get(current)
        if made is None:
            made = done[current] = change(with_children(current, tuple(map(visit, children(current)))))
        return made

    return visit(formula)


def boxes_overlap(a: str, b: str) -> Formula:
    """The boxes [s-length, s] × [d-width, d] of ``a`` and ``b`` overlap with positive area."""
    parts: list[Formula] = []
    for one, other in ((a, b), (b, a)):
        parts.append(Compare(subtract(Signal("s", one), Size("length", one)), "<", Signal("s", other)))
        parts.append(Compare(subtract(Signal("d", one), Size("width", one)), "<", Signal("d", other)))
    return conjunction(*parts)
