"""What solvers are asked: columns, rows, and a circuit of polynomial inequalities, as plain data.

A circuit is a tree of conjunctions and disjunctions over leaves, without negation. Its nodes are shared and
compared by identity, so a consumer that remembers what it did by node does each part once. ``All(())`` is
true and ``AnyOf(())`` is false.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Generic, Literal, TypeAlias, TypeVar, assert_never

from roadproof.runtime.records import dataclass
from roadproof.world.polynomial import Polynomial
from roadproof.world.signals import OwnName, SignalName

V = TypeVar("V")


@dataclass(frozen=True)
class Inequality(Generic[V]):
    """``polynomial > 0`` where strict, else ``polynomial >= 0``.

    ``margin`` is what a search in floating point keeps in addition; the inequality itself is without.
    """

    polynomial: Polynomial[V]
    strict: bool
    margin: Fraction = Fraction(0)


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
    """The conjunction of ``parts``, flattened; false as soon as one part is."""
    return _flattened(parts, All, AnyOf)


def any_of(parts: Iterable[Circuit[T]]) -> Circuit[T]:
    """The disjunction of ``parts``, flattened; true as soon as one part is."""
    return _flattened(parts, AnyOf, All)


def _flattened(
    parts: Iterable[Circuit[T]], kind: type[All[T] | AnyOf[T]], other: type[All[T] | AnyOf[T]]
) -> Circuit[T]:
    """``parts`` joined to one of a ``kind``; a part of the ``other`` kind without parts decides."""
    kept: dict[int, Circuit[T]] = {}
    for part in parts:
        if isinstance(part, other) and not part.parts:
            return part
        inner = part.parts if isinstance(part, kind) else (part,)
        kept |= {id(p): p for p in inner}
    return next(iter(kept.values())) if len(kept) == 1 else kind(tuple(kept.values()))


def nodes(circuit: Circuit[T]) -> Iterator[Circuit[T]]:
    """Every node once, parts before what they are part of; not recursive, so depth does not matter."""
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
    """The value of ``circuit`` computed from its leaves up, each node once."""
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
    """``circuit`` with each leaf replaced by a circuit."""

    def both(parts: list[Circuit[S]]) -> Circuit[S]:
        return all_of(parts)

    def either(parts: list[Circuit[S]]) -> Circuit[S]:
        return any_of(parts)

    return fold(circuit, change, both, either)


def evaluate(circuit: Circuit[T], truth: Callable[[T], bool]) -> bool:
    """The truth of ``circuit`` where ``truth`` gives that of each leaf."""
    return fold(circuit, truth, all, any)


def implicant(circuit: Circuit[T], margin: Callable[[T], float]) -> tuple[T, ...]:
    """Leaves that together make ``circuit`` true, chosen so that the least margin is greatest.

    ``margin`` is positive where a leaf is true. Where the circuit is true by ``margin`` all leaves
    returned are; all of them being true makes the circuit true whatever the others are.
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
    """What a column stands for: a signal of a vehicle at a sample."""

    vehicle: str
    signal: SignalName | OwnName
    step: int

    def __str__(self) -> str:
        return f"{self.vehicle}.{self.signal}.{self.step}"


@dataclass(frozen=True)
class Column:
    """A real unknown between two bounds."""

    of: Unknown
    low: Fraction
    high: Fraction


@dataclass(frozen=True)
class Row:
    """low <= Σ coefficient · column <= high; None is without bound."""

    terms: Mapping[int, Fraction]
    low: Fraction | None
    high: Fraction | None


Status: TypeAlias = Literal["found", "infeasible", "unknown"]


@dataclass(frozen=True)
class Solution:
    """Values of a problem's columns where ``status`` is found, rational where the search was exact."""

    status: Status
    values: tuple[float, ...] | tuple[Fraction, ...] = ()


@dataclass(frozen=True)
class Problem:
    """Find values of the columns within their bounds that satisfy every row and the circuit."""

    columns: tuple[Column, ...]
    rows: tuple[Row, ...]
    circuit: Circuit[ColumnInequality]

    def also(self, circuit: Circuit[ColumnInequality]) -> "Problem":
        """The same problem with one more condition."""
        return Problem(self.columns, self.rows, all_of([self.circuit, circuit]))

    def sizes(self) -> dict[str, int]:
        """Numbers of columns, rows, circuit nodes and distinct inequalities."""
        every = list(nodes(self.circuit))
        return {
            "columns": len(self.columns),
            "rows": len(self.rows),
            "nodes": len(every),
            "inequalities": sum(isinstance(n, Leaf) for n in every),
        }


def row_of(polynomial: Polynomial[int], low: Fraction | None, high: Fraction | None) -> Row:
    """A row from an affine polynomial between two bounds."""
    shift = polynomial.constant
    return Row(
        {m[0]: c for m, c in polynomial.terms.items() if m},
        None if low is None else low - shift,
        None if high is None else high - shift,
    )
