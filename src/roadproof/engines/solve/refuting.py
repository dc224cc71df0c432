"""Searches for a refutation tree of an integer program: HiGHS proposes, integer arithmetic confirms.

Depth first. A linear relaxation of the known facts gives Farkas multipliers where it is infeasible, else a
point. Where a known disjunction is false at the point, or a product is wrong, the tree branches. If the
refutation of one part of a disjunction does not use that part, it refutes the whole.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from roadproof.engines.solve.relaxation import MARGIN, NotRefutedError, Relaxation
from roadproof.evidence.program import (
    CaseSplit,
    ColumnSplit,
    Conjunction,
    Disjunction,
    DisjunctiveProgram,
    Fact,
    KnownFacts,
    Linear,
    Tree,
    WeightedSum,
    is_contradiction,
    linear_of,
)
from roadproof.runtime.records import dataclass

DIGITS = (2, 3, 5, 7, 9, 12)  # of the greatest multiplier, in turn
NEAR = 1e-6  # how false a condition may be at a point
TANGENTS = 5
MIDDLE = 5  # an interval is cut at the point, or in its middle where the point is in the last fifth


@dataclass(frozen=True)
class TreeRefutation:
    """A refutation tree, and the program nodes that it uses."""

    tree: Tree
    nodes: frozenset[int]


def find_refutation_tree(program: DisjunctiveProgram, most: int) -> Tree:
    """Return a tree that refutes ``program``, by at most ``most`` linear programs.

    Raises ``NotRefutedError``.
    """
    return TreeSearch(program, most).run()


class TreeSearch:
    """One search for a tree; ``solved`` counts its linear programs."""

    def __init__(self, program: DisjunctiveProgram, most: int) -> None:
        self.program, self.most, self.solved = program, most, 0
        self.relaxation = Relaxation(program)
        self.columns = len(program.box)
        self.opposite = opposites(program)

    def run(self) -> Tree:
        """Return the tree. Raises ``NotRefutedError``."""
        for number, linear in enumerate(self.program.equal):
            self.relaxation.add(Fact("equal", number), linear)
        for number, linear in enumerate(self.program.above):
            self.relaxation.add(Fact("above", number), linear)
        known = KnownFacts(self.program, self.program.box).also(len(self.program.nodes) - 1)
        for product in range(len(self.program.products)):
            self._add_product(known, product)
        self._add_nodes(known.nodes)
        return self._refute(known).tree

    def _add_nodes(self, nodes: frozenset[int]) -> None:
        for number in sorted(nodes):
            node = self.program.nodes[number]
            if isinstance(node, Linear):
                self.relaxation.add(Fact("node", number), node)

    def _add_product(self, known: KnownFacts, product: int) -> None:
        one, other = self.program.products[product]
        facts = [Fact("corner", product, (i, j)) for i in (0, 1) for j in (0, 1)]
        if one == other:
            low, high = known.box[one]
            places = [low + (high - low) * k // (TANGENTS - 1) for k in range(TANGENTS)]
            facts = [facts[1], *(Fact("tangent", product, (place, 0)) for place in places)]
        for fact in facts:
            linear = linear_of(known, fact)
            if linear is not None:
                self.relaxation.add(fact, linear)

    def _refute(self, known: KnownFacts) -> TreeRefutation:
        weights = self._plain(known)
        if weights is not None:
            return _summed(weights)
        self.solved += 1
        if self.solved > self.most:
            raise NotRefutedError(f"more than {self.most} linear programs")
        point, ray = self.relaxation.solve()
        if ray is not None:
            return _summed(self._multipliers(known, ray))
        node = self._open(known, point)
        return self._cut(known, point) if node is None else self._cases(known, node)

    def _plain(self, known: KnownFacts) -> tuple[tuple[Fact, int], ...] | None:
        """Return weights of a known inequality that the box excludes, or of two that clash."""
        for number in sorted(known.nodes):
            if not isinstance(self.program.nodes[number], Linear):
                continue
            weights = ((Fact("node", number), 1),)
            if is_contradiction(known, weights):
                return weights
            for other in self.opposite.get(number, ()):
                if other in known.nodes:
                    return (*weights, (Fact("node", other), 1))
        return None

    def _multipliers(self, known: KnownFacts, ray: Any) -> tuple[tuple[Fact, int], ...]:
        """Round the multipliers of HiGHS, which come with either sign, until they refute exactly."""
        for signed in (ray, -ray):
            for weights in (
                *(self.relaxation.whole(signed, digits) for digits in DIGITS),
                self.relaxation.simple(signed),
            ):
                if weights and is_contradiction(known, weights):
                    return weights
        raise NotRefutedError("the multipliers of HiGHS are not exact enough")

    def _open(self, known: KnownFacts, point: Any) -> int | None:
        """Return, of the known disjunctions false at the point, the one with the fewest possible parts."""
        nodes = self.program.nodes
        disjunctions = [
            (number, node)
            for number in known.nodes
            if isinstance(node := nodes[number], Disjunction) and not known.nodes.intersection(node.parts)
        ]
        values = self._values([number for number, _ in disjunctions], point)
        false = [(number, node) for number, node in disjunctions if values[number] < -NEAR]
        possible = self._possible(known, [part for _, node in false for part in node.parts])
        ranked = ((sum(possible[p] for p in node.parts), values[number], number) for number, node in false)
        return min(ranked)[2] if false else None

    def _values(self, numbers: Iterable[int], point: Any) -> dict[int, float]:
        """Return how true nodes and their parts are at a point; negative means false."""
        done: dict[int, float] = {}
        for number in self._with_parts(numbers):
            node = self.program.nodes[number]
            if isinstance(node, Linear):
                size = max((abs(k) for _, k in node.terms), default=1)
                value = (sum(k * point[c] for c, k in node.terms) + node.constant) / size
                done[number] = float(value) - (MARGIN if node.strict else 0.0)
            else:
                parts = [done[p] for p in node.parts]
                end = float("inf") if isinstance(node, Conjunction) else float("-inf")
                done[number] = min([end, *parts]) if isinstance(node, Conjunction) else max([end, *parts])
        return done

    def _possible(self, known: KnownFacts, numbers: Iterable[int]) -> dict[int, bool]:
        """Return which nodes and parts neither the box nor a single known inequality excludes."""
        done: dict[int, bool] = {}
        for number in self._with_parts(numbers):
            node = self.program.nodes[number]
            if isinstance(node, Linear):
                alone = KnownFacts(self.program, known.box, frozenset({number}))
                denied = known.nodes.intersection(self.opposite.get(number, ()))
                done[number] = not denied and not is_contradiction(alone, ((Fact("node", number), 1),))
            else:
                parts = (done[part] for part in node.parts)
                done[number] = all(parts) if isinstance(node, Conjunction) else any(parts)
        return done

    def _with_parts(self, numbers: Iterable[int]) -> list[int]:
        """Return these nodes and all their parts, parts first, without recursion."""
        reached, waiting = set[int](), [*numbers]
        while waiting:
            number = waiting.pop()
            if number not in reached:
                reached.add(number)
                node = self.program.nodes[number]
                waiting += () if isinstance(node, Linear) else node.parts
        return sorted(reached)

    def _cases(self, known: KnownFacts, number: int) -> TreeRefutation:
        """Refute each part of a disjunction, impossible ones first: one may refute the whole."""
        node = self.program.nodes[number]
        assert isinstance(node, Disjunction)
        trees: dict[int, Tree] = {}
        used = {number}
        possible = self._possible(known, node.parts)
        for part in sorted(node.parts, key=lambda p: possible[p]):
            inner = known.also(part)
            new = inner.nodes - known.nodes
            with self._taken_back():
                self._add_nodes(new)
                refutation = self._refute(inner)
            if not refutation.nodes & new:
                return refutation
            used |= refutation.nodes - new
            trees[part] = refutation.tree
        return TreeRefutation(CaseSplit(number, tuple(trees[p] for p in node.parts)), frozenset(used))

    def _cut(self, known: KnownFacts, point: Any) -> TreeRefutation:
        """Cut the wider factor of the product that is most wrong at the point, and refute both halves."""
        wrong = [
            (abs(point[self.columns + k] - point[one] * point[other]), k)
            for k, (one, other) in enumerate(self.program.products)
        ]
        worst, product = max(wrong, default=(0.0, 0))
        if worst <= NEAR:
            raise NotRefutedError("the relaxation has a solution")
        column = max(self.program.products[product], key=lambda c: known.box[c][1] - known.box[c][0])
        low, high = known.box[column]
        at = round(point[column] * self.program.scale)
        if MIDDLE * min(at - low, high - at) < high - low:
            at = (low + high) // 2
        if not low < at < high:
            raise NotRefutedError("an interval is too short to be cut")
        halves = []
        for ends in ((low, at), (at, high)):
            with self._within(known, column, ends) as inner:
                halves.append(self._refute(inner))
        one, other = halves
        return TreeRefutation(ColumnSplit(column, at, one.tree, other.tree), one.nodes | other.nodes)

    @contextmanager
    def _within(self, known: KnownFacts, column: int, ends: tuple[int, int]) -> Iterator[KnownFacts]:
        """Narrow a column to ``ends``, with the facts of its products there, for the time of the context."""
        inner = known.within(column, ends)
        products = [k for k, pair in enumerate(self.program.products) if column in pair]
        with self._taken_back():
            suspended = self.relaxation.suspend(products)
            self.relaxation.bound(inner.box, column)
            for product in products:
                self._add_product(inner, product)
            yield inner
        self.relaxation.resume(suspended)
        self.relaxation.bound(known.box, column)

    @contextmanager
    def _taken_back(self) -> Iterator[None]:
        count = len(self.relaxation.facts)
        yield
        self.relaxation.take_back(count)


def _summed(weights: tuple[tuple[Fact, int], ...]) -> TreeRefutation:
    nodes = frozenset(fact.number for fact, _ in weights if fact.kind == "node")
    return TreeRefutation(WeightedSum(weights), nodes)


def opposites(program: DisjunctiveProgram) -> dict[int, list[int]]:
    """Return, for each linear node, the nodes that contradict it on the same terms."""
    by_terms: dict[tuple[tuple[int, int], ...], list[tuple[int, Linear]]] = {}
    linear = [(number, x) for number, x in enumerate(program.nodes) if isinstance(x, Linear)]
    for number, x in linear:
        by_terms.setdefault(tuple(sorted(x.terms)), []).append((number, x))
    contradicting: dict[int, list[int]] = {}
    for number, x in linear:
        for other, y in by_terms.get(tuple(sorted((c, -k) for c, k in x.terms)), ()):
            total = x.constant + y.constant
            if total < 0 or (total == 0 and (x.strict or y.strict)):
                contradicting.setdefault(number, []).append(other)
    return contradicting
