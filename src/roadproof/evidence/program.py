"""Disjunctive programs, and refutation trees that show that a program has no solution.

A program encodes a question exactly: columns between bounds, products of two columns, equations,
inequalities, and a circuit of conjunctions and disjunctions over inequalities. All numbers are integers.
``refutes`` checks a tree in exact arithmetic: at each leaf, a weighted sum of known facts holds for no values
of the columns within their bounds. ``proofs/kernel/Programs.v`` has the same checker, proved correct.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from typing import Literal, TypeAlias, assert_never

from roadproof.runtime.records import dataclass

FactKind: TypeAlias = Literal["equal", "above", "node", "corner", "tangent"]


@dataclass(frozen=True)
class Linear:
    """The sum Σ coefficient · column + constant; a condition that it is > 0 if ``strict``, else >= 0."""

    terms: tuple[tuple[int, int], ...]
    constant: int
    strict: bool = False


@dataclass(frozen=True)
class Conjunction:
    """A node that is true if all of its parts are; ``parts`` are numbers of nodes."""

    parts: tuple[int, ...]


@dataclass(frozen=True)
class Disjunction:
    """A node that is true if one of its parts is; ``parts`` are numbers of nodes."""

    parts: tuple[int, ...]


Node: TypeAlias = Linear | Conjunction | Disjunction


@dataclass(frozen=True)
class DisjunctiveProgram:
    """A program; ``box``: integer bounds of each column times ``scale``.

    The columns after these are ``products`` of two. Terms in ``equal`` are 0, those in ``above`` at least 0.
    ``nodes`` follow their parts; the last one is the condition.
    """

    scale: int
    box: tuple[tuple[int, int], ...]
    products: tuple[tuple[int, int], ...]
    equal: tuple[Linear, ...]
    above: tuple[Linear, ...]
    nodes: tuple[Node, ...]


@dataclass(frozen=True)
class Fact:
    """A fact that a leaf may use, with its number: an equation, an inequality, a known linear node, or a
    product.

    For a product, ``corner`` has an end of each factor, 0 for low and 1 for high. For a square, ``tangent``
    has the value (times the scale) at which the tangent touches.
    """

    kind: FactKind
    number: int
    ends: tuple[int, int] = (0, 0)


@dataclass(frozen=True)
class WeightedSum:
    """A leaf: multiples of facts whose sum contradicts the box; only equations may have negative weights."""

    weights: tuple[tuple[Fact, int], ...]


@dataclass(frozen=True)
class CaseSplit:
    """An inner node with a tree for each part of a known disjunction."""

    node: int
    trees: "tuple[Tree, ...]"


@dataclass(frozen=True)
class ColumnSplit:
    """An inner node with a tree for values of a column up to ``at`` (times the scale), and one from it on."""

    column: int
    at: int
    low: "Tree"
    high: "Tree"


Tree: TypeAlias = WeightedSum | CaseSplit | ColumnSplit
Box: TypeAlias = Sequence[tuple[int, int]]


@dataclass(frozen=True)
class KnownFacts:
    """The knowledge at a node of a tree: the box, and which nodes of the program are true."""

    program: DisjunctiveProgram
    box: Box
    nodes: frozenset[int] = field(default_factory=frozenset)

    def also(self, node: int) -> "KnownFacts":
        """Return the facts with one more true node, and with the parts of conjunctions."""
        true_nodes, waiting = set(self.nodes), [node]
        while waiting:
            number = waiting.pop()
            if number in true_nodes:
                continue
            true_nodes.add(number)
            content = self.program.nodes[number]
            if isinstance(content, Conjunction):
                waiting.extend(content.parts)
        return KnownFacts(self.program, self.box, frozenset(true_nodes))

    def within(self, column: int, ends: tuple[int, int]) -> "KnownFacts":
        """Return the facts with other bounds of a column."""
        box = list(self.box)
        box[column] = ends
        return KnownFacts(self.program, box, self.nodes)


def refutes(program: DisjunctiveProgram, tree: Tree) -> bool:
    """Return whether a tree shows that a program has no solution."""
    known = KnownFacts(program, program.box).also(len(program.nodes) - 1)
    waiting: list[tuple[KnownFacts, Tree]] = [(known, tree)]
    while waiting:
        here, branch = waiting.pop()
        match branch:
            case WeightedSum(weights):
                if not is_contradiction(here, weights):
                    return False
            case CaseSplit(number, trees):
                node = program.nodes[number] if 0 <= number < len(program.nodes) else None
                if not isinstance(node, Disjunction) or number not in here.nodes:
                    return False
                if len(trees) != len(node.parts):
                    return False
                waiting += [(here.also(part), one) for part, one in zip(node.parts, trees, strict=True)]
            case ColumnSplit(column, at, low, high):
                if not 0 <= column < len(here.box):
                    return False
                begin, end = here.box[column]
                waiting += [(here.within(column, (begin, at)), low), (here.within(column, (at, end)), high)]
            case _:
                assert_never(branch)
    return True


def is_contradiction(known: KnownFacts, weights: Iterable[tuple[Fact, int]]) -> bool:
    """Return whether the sum of these multiples of facts holds nowhere in the box."""
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
    """Return the greatest value of Σ factor · column in the box, times the square of the scale."""
    program, total = known.program, 0
    for column, factor in factors.items():
        if column < len(known.box):
            total += program.scale * max(factor * end for end in known.box[column])
        else:
            one, other = program.products[column - len(known.box)]
            total += max(factor * x * y for x in known.box[one] for y in known.box[other])
    return total


def linear_of(known: KnownFacts, fact: Fact) -> Linear | None:
    """Return the linear term that a fact states to be at least 0; None if it is no fact here."""
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
            return _product_fact(known, fact) if number < len(program.products) else None
        case _:
            assert_never(fact.kind)


def _product_fact(known: KnownFacts, fact: Fact) -> Linear | None:
    """Return (x - a)·(y - b), times the square of the scale, with the sign that makes it at least 0."""
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
