"""The problems that solvers get: columns, rows and a circuit of polynomial inequalities, as plain data.

A circuit is a tree of conjunctions and disjunctions over leaves, without negation. Its nodes are shared
and compared by identity, so a consumer that caches by node does each part once. ``All(())`` is true and
``AnyOf(())`` is false.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from dataclasses import field
from enum import StrEnum, unique
from fractions import Fraction
from typing import Generic, Literal, TypeAlias, TypeVar, assert_never

from roadproof.runtime.records import dataclass
from roadproof.world.polynomial import Polynomial
from roadproof.world.signals import CustomSignalName, SignalName

V = TypeVar("V")


@unique
class LimitKind(StrEnum):
    """The kinds of conditions on a drive beside the formula."""

    MOTION = "motion"
    """Places follow from speeds by the trapezoid rule."""
    ACCELERATION = "acceleration"
    """Accelerations are within the limits of the vehicle."""
    LATERAL_SHARE = "lateral share"
    """The speed across the road is at most a share of the speed along it."""
    JUMP = "jump"
    """Accelerations change by at most the jumps of the vehicle."""
    REACH = "reach"
    """Vehicles start within a distance of each other."""
    ROAD = "road"
    """Boxes are on the road."""
    CLEARANCE = "clearance"
    """Boxes are apart."""
    LANE = "lane"
    """Boxes are in a lane at the first and last sample."""
    ONE_WAY = "one way"
    """Vehicles move across the road in one direction only."""
    STEADY = "steady"
    """Accelerations last two steps."""
    START = "start"
    """The drive begins in a given way."""
    OTHER_DRIVE = "other drive"
    """The drive differs clearly from one that is known."""


@dataclass(frozen=True)
class Origin:
    """The part of a question that a row or an inequality encodes, at a step.

    ``part``: the kind of a condition on ``vehicles``, or else a comparison of the formula, which solvers do
    not read.
    """

    part: Hashable
    step: int
    vehicles: tuple[str, ...] = ()


@dataclass(frozen=True)
class Inequality(Generic[V]):
    """A constraint ``polynomial > 0`` where strict, else ``polynomial >= 0``.

    ``margin``: safety margin of a floating-point search; it is no part of the inequality itself.
    ``origin``: what it encodes, where it is over columns; two inequalities are equal without it.
    """

    polynomial: Polynomial[V]
    strict: bool
    margin: Fraction = Fraction(0)
    origin: Origin | None = field(default=None, compare=False)


T = TypeVar("T")
S = TypeVar("S")


@dataclass(frozen=True, eq=False)
class Leaf(Generic[T]):
    content: T


@dataclass(frozen=True, eq=False)
class All(Generic[T]):
    parts: "tuple[Circuit[T], ...]"


@dataclass(frozen=True, eq=False)
class AnyOf(Generic[T]):
    parts: "tuple[Circuit[T], ...]"


Circuit: TypeAlias = Leaf[T] | All[T] | AnyOf[T]


def all_of(parts: Iterable[Circuit[T]]) -> Circuit[T]:
    """Return the conjunction of ``parts``, flattened; false as soon as one part is."""
    return _flattened(parts, All, AnyOf)


def any_of(parts: Iterable[Circuit[T]]) -> Circuit[T]:
    """Return the disjunction of ``parts``, flattened; true as soon as one part is."""
    return _flattened(parts, AnyOf, All)


def _flattened(
    parts: Iterable[Circuit[T]], kind: type[All[T] | AnyOf[T]], other: type[All[T] | AnyOf[T]]
) -> Circuit[T]:
    """Join ``parts`` into one node of a ``kind``; an empty part of the ``other`` kind decides the whole."""
    joined: dict[int, Circuit[T]] = {}
    for part in parts:
        if isinstance(part, other) and not part.parts:
            return part
        inner = part.parts if isinstance(part, kind) else (part,)
        joined |= {id(p): p for p in inner}
    return next(iter(joined.values())) if len(joined) == 1 else kind(tuple(joined.values()))


def nodes(circuit: Circuit[T]) -> Iterator[Circuit[T]]:
    """Yield every node once, parts before wholes, without recursion, so depth is no limit."""
    seen: set[int] = set()
    waiting: list[tuple[Circuit[T], bool]] = [(circuit, False)]
    while waiting:
        node, ready = waiting.pop()
        if ready:
            yield node
        elif id(node) not in seen:
            seen.add(id(node))
            waiting.append((node, True))
            if not isinstance(node, Leaf):
                waiting.extend((part, False) for part in reversed(node.parts))


def fold(
    circuit: Circuit[T], leaf: Callable[[T], S], both: Callable[[list[S]], S], either: Callable[[list[S]], S]
) -> S:
    """Return the value of ``circuit``, computed from its leaves up, each node once."""
    done: dict[int, S] = {}
    for node in nodes(circuit):
        match node:
            case Leaf(content):
                done[id(node)] = leaf(content)
            case All(parts):
                done[id(node)] = both([done[id(p)] for p in parts])
            case AnyOf(parts):
                done[id(node)] = either([done[id(p)] for p in parts])
            case _:
                assert_never(node)
    return done[id(circuit)]


def replace_leaves(circuit: Circuit[T], change: Callable[[T], Circuit[S]]) -> Circuit[S]:
    """Return ``circuit`` with each leaf replaced by a circuit."""

    def both(parts: list[Circuit[S]]) -> Circuit[S]:
        return all_of(parts)

    def either(parts: list[Circuit[S]]) -> Circuit[S]:
        return any_of(parts)

    return fold(circuit, change, both, either)


def evaluate(circuit: Circuit[T], truth: Callable[[T], bool]) -> bool:
    """Return the truth of ``circuit``, given that of each leaf."""
    return fold(circuit, truth, all, any)


def implicant(circuit: Circuit[T], margin: Callable[[T], float]) -> tuple[T, ...]:
    """Return leaves that together make ``circuit`` true, chosen so that their least margin is greatest.

    ``margin`` is positive where a leaf is true. If the circuit is false, leaves are returned all the same;
    ``AnyOf(())``, which nothing makes true, contributes no leaf.
    """
    value: dict[int, float] = {}
    for node in nodes(circuit):
        match node:
            case Leaf(content):
                value[id(node)] = margin(content)
            case All(parts):
                value[id(node)] = min((value[id(p)] for p in parts), default=float("inf"))
            case AnyOf(parts):
                value[id(node)] = max((value[id(p)] for p in parts), default=float("-inf"))
            case _:
                assert_never(node)
    chosen: dict[int, Leaf[T]] = {}
    seen: set[int] = set()
    waiting: list[Circuit[T]] = [circuit]
    while waiting:
        node = waiting.pop()
        if id(node) in seen:
            continue
        seen.add(id(node))
        match node:
            case Leaf():
                chosen[id(node)] = node
            case All(parts):
                waiting.extend(parts)
            case AnyOf(parts):
                if parts:
                    waiting.append(max(parts, key=lambda p: value[id(p)]))
            case _:
                assert_never(node)
    return tuple(leaf.content for leaf in chosen.values())


# An inequality over column numbers.
ColumnInequality: TypeAlias = Inequality[int]


@dataclass(frozen=True)
class Unknown:
    """The meaning of a column: a signal of a vehicle at a sample."""

    vehicle: str
    signal: SignalName | CustomSignalName
    step: int

    def __str__(self) -> str:
        return f"{self.vehicle}.{self.signal}@{self.step}"


@dataclass(frozen=True)
class RealColumn:
    """A column of a problem: a real unknown between two bounds."""

    of: Unknown
    low: Fraction
    high: Fraction


@dataclass(frozen=True)
class Row:
    """A linear constraint low <= Σ coefficient · column <= high; None is no bound."""

    terms: Mapping[int, Fraction]
    low: Fraction | None
    high: Fraction | None
    origin: Origin | None = None


Status: TypeAlias = Literal["found", "infeasible", "unknown"]


@dataclass(frozen=True)
class ColumnValues:
    """A solver's result: values of the columns where ``status`` is found, rational from an exact solver."""

    status: Status
    values: tuple[float, ...] | tuple[Fraction, ...] = ()


@dataclass(frozen=True)
class Problem:
    """The task to find column values within their bounds that satisfy every row and the circuit."""

    columns: tuple[RealColumn, ...]
    rows: tuple[Row, ...]
    circuit: Circuit[ColumnInequality]

    def also(self, circuit: Circuit[ColumnInequality]) -> "Problem":
        """Return the problem with one more condition."""
        return Problem(self.columns, self.rows, all_of([self.circuit, circuit]))

    def sizes(self) -> dict[str, int]:
        """Return the numbers of columns, rows, circuit nodes and inequalities."""
        every = list(nodes(self.circuit))
        return {
            "columns": len(self.columns),
            "rows": len(self.rows),
            "nodes": len(every),
            "inequalities": sum(isinstance(n, Leaf) for n in every),
        }


def row_of(polynomial: Polynomial[int], low: Fraction | None, high: Fraction | None, origin: Origin) -> Row:
    """Return the row that keeps an affine polynomial between two bounds."""
    shift = polynomial.constant
    return Row(
        {m[0]: c for m, c in polynomial.terms.items() if m},
        None if low is None else low - shift,
        None if high is None else high - shift,
        origin,
    )
