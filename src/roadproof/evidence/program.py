"""Programs with disjunctions, and trees that show that a program has no solution.

A program is an exact encoding of a question: columns between bounds, products of two columns, equations,
inequalities, and a circuit of conjunctions and disjunctions over inequalities. All numbers are integers.
``refutes`` adds up a tree in exact arithmetic: at each leaf, multiples of what is known there give a sum
that no value of the columns within their bounds satisfies. ``proofs/kernel/Programs.v`` has the same
checker, proved right.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from typing import Literal, TypeAlias, assert_never

from roadproof.runtime.records import dataclass

Kind: TypeAlias = Literal["equal", "above", "node", "corner", "tangent"]


@dataclass(frozen=True)
class Linear:
    """Σ coefficient · column + constant; as a condition it is above 0 where ``strict``, else at least 0."""

    terms: tuple[tuple[int, int], ...]
    constant: int
    strict: bool = False


@dataclass(frozen=True)
class Every:
    """A node that is true where all of these nodes are."""

    parts: tuple[int, ...]


@dataclass(frozen=True)
class Either:
    """A node that is true where one of these nodes is."""

    parts: tuple[int, ...]


Node: TypeAlias = Linear | Every | Either


@dataclass(frozen=True)
class Program:
    """``box``: integer bounds of each column times ``scale``. Columns after these are ``products`` of two.

    ``equal`` are 0 and ``above`` at least 0. Nodes follow their parts; the last one is the condition.
    """

    scale: int
    box: tuple[tuple[int, int], ...]
    products: tuple[tuple[int, int], ...]
    equal: tuple[Linear, ...]
    above: tuple[Linear, ...]
    nodes: tuple[Node, ...]


@dataclass(frozen=True)
class Fact:
    """An equation, an inequality or a known linear node of the program by its number, or of a product:

    the ``corner`` (end of the first factor) (end of the second), 0 for low and 1 for high, or of a square
    the ``tangent`` at a value, times the scale.
    """

    kind: Kind
    number: int
    ends: tuple[int, int] = (0, 0)


@dataclass(frozen=True)
class Sum:
    """Multiples of facts whose sum contradicts the box; those of equations may be negative."""

    weights: tuple[tuple[Fact, int], ...]


@dataclass(frozen=True)
class Cases:
    """A tree for each part of a known disjunction."""

    node: int
    trees: "tuple[Tree, ...]"


@dataclass(frozen=True)
class Cut:
    """A tree for values of a column up to ``at`` (times the scale), and one for those from there on."""

    column: int
    at: int
    low: "Tree"
    high: "Tree"


Tree: TypeAlias = Sum | Cases | Cut
Box: TypeAlias = Sequence[tuple[int, int]]


@dataclass(frozen=True)
class KnownFacts:
    """What is known at a place of a tree: the box, and which nodes are true."""

    program: Program
    box: Box
    nodes: frozenset[int] = field(default_factory=frozenset)

    def also(self, node: int) -> "KnownFacts":
        """With one more node that is true, and the parts of conjunctions."""
        found, waiting = set(self.nodes), [node]
        while waiting:
            number = waiting.pop()
            if number in found:
                continue
            found.add(number)
            content = self.program.nodes[number]
            if isinstance(content, Every):
                waiting.extend(content.parts)
        return KnownFacts(self.program, self.box, frozenset(found))

    def within(self, column: int, ends: tuple[int, int]) -> "KnownFacts":
        """With other bounds of a column."""
        box = list(self.box)
        box[column] = ends
        return KnownFacts(self.program, box, self.nodes)


def refutes(program: Program, tree: Tree) -> bool:
    """Whether ``tree`` shows that ``program`` has no solution."""
    known = KnownFacts(program, program.box).also(len(program.nodes) - 1)
    waiting: list[tuple[KnownFacts, Tree]] = [(known, tree)]
    while waiting:
        here, found = waiting.pop()
        match found:
            case Sum(weights):
                if not is_absurd(here, weights):
                    return False
            case Cases(number, trees):
                node = program.nodes[number] if 0 <= number < len(program.nodes) else None
                if not isinstance(node, Either) or number not in here.nodes:
                    return False
                if len(trees) != len(node.parts):
                    return False
                waiting += [(here.also(part), one) for part, one in zip(node.parts, trees, strict=True)]
            case Cut(column, at, low, high):
                if not 0 <= column < len(here.box):
                    return False
                begin, end = here.box[column]
                waiting += [(here.within(column, (begin, at)), low), (here.within(column, (at, end)), high)]
            case _:
                assert_never(found)
    return True


def is_absurd(known: KnownFacts, weights: Iterable[tuple[Fact, int]]) -> bool:
    """Whether the sum of these multiples of facts holds nowhere in the box."""
    factors: dict[int, int] = {}
    constant, strict = 0, False
    for fact, weight in weights:
        linear = linear_of(known, fact)
        if linear is None or (weight < 0 and fact.kind != "equal"):
            return False
        constant += weight * linear.constant
        strict |= linear.strict and weight > 0
        for column, factor in linear.terms:
            factors[column] = factors.get(column, 0) + weight * factor
    greatest = constant * known.program.scale**2 + _greatest(known, factors)
    return greatest < 0 or (strict and greatest == 0)


def _greatest(known: KnownFacts, factors: Mapping[int, int]) -> int:
    """The greatest value of Σ factor · column in the box, times the square of the scale."""
    program, total = known.program, 0
    for column, factor in factors.items():
        if column < len(known.box):
            total += program.scale * max(factor * end for end in known.box[column])
        else:
            one, other = program.products[column - len(known.box)]
            total += max(factor * x * y for x in known.box[one] for y in known.box[other])
    return total


def linear_of(known: KnownFacts, fact: Fact) -> Linear | None:
    """What a fact says to be at least 0, None where it is none."""
    program, number = known.program, fact.number
    if number < 0:
        return None
    match fact.kind:
        case "equal" | "above":
            rows = program.equal if fact.kind == "equal" else program.above
            return rows[number] if number < len(rows) else None
        case "node":
            node = program.nodes[number] if number in known.nodes else None
            return node if isinstance(node, Linear) else None
        case "corner" | "tangent":
            return _of_product(known, fact) if number < len(program.products) else None
        case _:
            assert_never(fact.kind)


def _of_product(known: KnownFacts, fact: Fact) -> Linear | None:
    """(x - a)·(y - b), with the sign that makes it at least 0, times the square of the scale."""
    one, other = known.program.products[fact.number]
    scale, column = known.program.scale, len(known.box) + fact.number
    if fact.kind == "tangent":
        if one != other:
            return None
        at = fact.ends[0]
        return Linear(((column, scale**2), (one, -2 * scale * at)), at * at)
    first, second = fact.ends
    if not {first, second} <= {0, 1}:
        return None
    a, b = known.box[one][first], known.box[other][second]
    sign = 1 if first == second else -1
    terms = ((column, sign * scale**2), (one, -sign * scale * b), (other, -sign * scale * a))
    return Linear(terms, sign * a * b)
