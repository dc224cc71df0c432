"""The formula tree: signal temporal logic (STL) over comparisons of terms.

There are no nodes for implications and ``!=``: their constructors rewrite them. ``Application`` records which
definition a sub-formula comes from, and has the meaning of its body. Quantifiers over lanes and lanelets stay
in the tree until a road is chosen (``library.bind``).

Semantics (semantics §1; paper, Table *Boolean semantics of STL*): time is dense and starts at 0. ``Until(φ,
J, ψ)`` at T: some t in J has ψ at T+t and φ at T+t' for every t' < t in J. ``Since(φ, J, ψ)`` at T is its
mirror image: some t <= T in J has ψ at T-t and φ at T-t' for every t' < t in J. "Once" and "historically" are
written with it (``once``, ``historically``).
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from operator import is_
from typing import Literal, TypeAlias, assert_never

from roadproof.logic.node import memoised, node
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
class Since:
    """The only operator that looks back; nothing is before time 0."""

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
    """An application of a definition, for printing and for opaque atoms; it has the meaning of ``body``."""

    name: str
    arguments: tuple[str, ...]
    body: "Formula"


State: TypeAlias = Truth | Compare | Occupies
Temporal: TypeAlias = Until | Since | Eventually | Always
Formula: TypeAlias = State | Some | Every | Not | And | Or | Temporal | Application

TRUE = Truth(True)
FALSE = Truth(False)
ZERO: Number = number(0, (0, 1))
FOREVER = Interval(ZERO, None)
NO_PAST = "proofs have no rules for operators that look back: O, H and S"


def negation(body: Formula) -> Formula:
    """Return ``not body``, without double negations."""
    match body:
        case Truth(value):
            return Truth(not value)
        case Not(inner):
            return inner
        case Compare() | Occupies() | Some() | Every() | And() | Or() | Application():
            return Not(body)
        case Until() | Since() | Eventually() | Always():
            return Not(body)
        case _:
            assert_never(body)


def conjunction(*parts: Formula) -> Formula:
    """Return the conjunction of ``parts`` without true parts; true if none is left."""
    remaining = tuple(p for p in parts if p != TRUE)
    if FALSE in remaining:
        return FALSE
    return TRUE if not remaining else remaining[0] if len(remaining) == 1 else And(remaining)


def disjunction(*parts: Formula) -> Formula:
    """Return the disjunction of ``parts`` without false parts; false if none is left."""
    remaining = tuple(p for p in parts if p != FALSE)
    if TRUE in remaining:
        return TRUE
    return FALSE if not remaining else remaining[0] if len(remaining) == 1 else Or(remaining)


def implication(premise: Formula, conclusion: Formula) -> Formula:
    """Return ``premise -> conclusion``."""
    return disjunction(negation(premise), conclusion)


def equivalence(left: Formula, right: Formula) -> Formula:
    """Return ``left <-> right``."""
    return conjunction(implication(left, right), implication(right, left))


def once(interval: Interval, body: Formula) -> Formula:
    """Return O: ``body`` holds at some time in the past ``interval``, counted back from now."""
    return Since(TRUE, interval, body)


def historically(interval: Interval, body: Formula) -> Formula:
    """Return H: ``body`` holds at all times in the past ``interval`` that are not before time 0."""
    return negation(Since(TRUE, interval, negation(body)))


def weak_until(left: Formula, interval: Interval, right: Formula) -> Formula:
    """Return W: ``left`` until ``right``, or ``left`` at all times of the interval."""
    return disjunction(Until(left, interval, right), Always(interval, left))


def release(left: Formula, interval: Interval, right: Formula) -> Formula:
    """Return R: ``right`` at each time of the interval, unless ``left`` held at an earlier one of it."""
    return negation(Until(negation(left), interval, negation(right)))


def children(formula: Formula) -> tuple[Formula, ...]:
    """Return the direct sub-formulas of ``formula``."""
    match formula:
        case Truth() | Compare() | Occupies():
            return ()
        case And(parts) | Or(parts):
            return parts
        case Until(left, _, right) | Since(left, _, right):
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
    """Return ``formula`` with its direct sub-formulas replaced, in the order of ``children``.

    If these are the same objects, ``formula`` itself is returned, and cached facts about it stay.
    """
    match formula:
        case Truth() | Compare() | Occupies():
            return formula
        case And(parts) | Or(parts):
            return formula if all(map(is_, new, parts)) else type(formula)(new)
        case Not(body):
            return formula if new[0] is body else Not(new[0])
        case Until(left, interval, right) | Since(left, interval, right):
            is_same = new[0] is left and new[1] is right
            return formula if is_same else type(formula)(new[0], interval, new[1])
        case Eventually(interval, body) | Always(interval, body):
            return formula if new[0] is body else type(formula)(interval, new[0])
        case Some(variable, domain, body) | Every(variable, domain, body):
            return formula if new[0] is body else type(formula)(variable, domain, new[0])
        case Application(name, arguments, body):
            return formula if new[0] is body else Application(name, arguments, new[0])
        case _:
            assert_never(formula)


def intervals(formula: Formula) -> tuple[Interval, ...]:
    """Return the intervals of ``formula`` without those of its sub-formulas; empty for a state formula."""
    match formula:
        case Until(_, interval, _) | Since(_, interval, _) | Eventually(interval, _) | Always(interval, _):
            return (interval,)
        case Truth() | Compare() | Occupies() | Some() | Every() | Not() | And() | Or() | Application():
            return ()
        case _:
            assert_never(formula)


def with_intervals(formula: Formula, change: Callable[[Interval], Interval]) -> Formula:
    """Return ``formula`` with ``change`` applied to each of its ``intervals``."""
    match formula:
        case Until(left, interval, right) | Since(left, interval, right):
            return type(formula)(left, change(interval), right)
        case Eventually(interval, body) | Always(interval, body):
            return type(formula)(change(interval), body)
        case Truth() | Compare() | Occupies() | Some() | Every() | Not() | And() | Or() | Application():
            return formula
        case _:
            assert_never(formula)


def subformulas(*formulas: Formula) -> Iterator[Formula]:
    """Yield every distinct sub-formula once, parents before children, formula by formula."""
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
    """Return every application of a definition with its depth: how many other applications it is inside.

    The order is that of ``subformulas``.
    """
    depths: dict[Application, int] = {}
    seen: set[Formula] = set()
    waiting = [(formula, 0)]
    while waiting:
        current, depth = waiting.pop()
        if current in seen:
            continue
        seen.add(current)
        if isinstance(current, Application):
            depths[current] = depth
            depth += 1
        waiting.extend((child, depth) for child in reversed(children(current)))
    return depths


@memoised
def is_state(formula: Formula) -> bool:
    """Return whether ``formula`` is about one instant only: it has no temporal operator."""
    return not isinstance(formula, Temporal) and all(map(is_state, children(formula)))


@memoised
def looks_back(formula: Formula) -> bool:
    """Return whether ``formula`` has an operator that looks back."""
    return isinstance(formula, Since) or any(map(looks_back, children(formula)))


def hash_cons(
    formulas: Iterable[Formula],
    change: Callable[[Formula], Formula],
    known: dict[Formula, Formula] | None = None,
) -> list[Formula]:
    """Apply ``transform`` to each formula, and make equal sub-formulas one object.

    Comparisons of the results then need not look inside. ``known``: the objects of earlier calls; those of
    this call are added to it.
    """
    pool: dict[Formula, Formula] = {} if known is None else known
    done: dict[int, tuple[Formula, Formula]] = {}  # no id is reused while the object is stored

    def visit(current: Formula) -> Formula:
        """Rebuild a node, once per object."""
        if id(current) not in done:
            parts = tuple(visit(child) for child in children(current))
            rebuilt = change(with_children(current, parts))
            done[id(current)] = current, pool.setdefault(rebuilt, rebuilt)
        return done[id(current)][1]

    return [visit(formula) for formula in formulas]


def transform(formula: Formula, change: Callable[[Formula], Formula]) -> Formula:
    """Return ``formula`` rebuilt bottom-up, with ``change`` applied once to every rebuilt node."""

    done: dict[Formula, Formula] = {}

    def visit(current: Formula) -> Formula:
        """Rebuild a node, once per structure."""
        rebuilt = done.get(current)
        if rebuilt is None:
            rebuilt = done[current] = change(with_children(current, tuple(map(visit, children(current)))))
        return rebuilt

    return visit(formula)


def boxes_overlap(a: str, b: str) -> Formula:
    """Return "the boxes [s-length, s] × [d-width, d] of ``a`` and ``b`` overlap with positive area"."""
    parts: list[Formula] = []
    for one, other in ((a, b), (b, a)):
        parts.append(Compare(subtract(Signal("s", one), Size("length", one)), "<", Signal("s", other)))
        parts.append(Compare(subtract(Signal("d", one), Size("width", one)), "<", Signal("d", other)))
    return conjunction(*parts)
