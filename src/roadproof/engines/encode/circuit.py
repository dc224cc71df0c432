"""Time-free circuits: conjunctions and disjunctions over leaves, without negation.

Nodes are shared and compared by identity, so a consumer that remembers what it did by node does
each part once. ``All(())`` is true and ``AnyOf(())`` is false.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Generic, TypeAlias, TypeVar, assert_never

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
    kept: dict[int, Circuit[T]] = {}
    for part in parts:
        if isinstance(part, AnyOf) and not part.parts:
            return part
        inner = part.parts if isinstance(part, All) else (part,)
        kept |= {id(p): p for p in inner}
    return next(iter(kept.values())) if len(kept) == 1 else All(tuple(kept.values()))


def any_of(parts: Iterable[Circuit[T]]) -> Circuit[T]:
    """The disjunction of ``parts``, flattened; true as soon as one part is."""
    kept: dict[int, Circuit[T]] = {}
    for part in parts:
        if isinstance(part, All) and not part.parts:
            return part
        inner = part.parts if isinstance(part, AnyOf) else (part,)
        kept |= {id(p): p for p in inner}
    return next(iter(kept.values())) if len(kept) == 1 else AnyOf(tuple(kept.values()))


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
