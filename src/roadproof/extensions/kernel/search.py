"""The search for a tableau, guided by the instances in a certificate. Not trusted: Coq checks the tableau.

Steps with one branch come first (``reading.py``), then splits (``dividing.py``). Unused steps are dropped.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from roadproof.evidence.times import ZERO, named_moment, read_moment
from roadproof.extensions.kernel.branch import (
    Branch,
    ChildFacts,
    Goal,
    Move,
    NotFoundError,
    PendingUniversal,
    Proof,
    SharedState,
    TableauStep,
    TruthAt,
    constraints_in,
    number_nodes,
)
from roadproof.extensions.kernel.dividing import next_move
from roadproof.extensions.kernel.reading import read
from roadproof.extensions.kernel.tableau import Tableau
from roadproof.reasons import ReasonKind

MOST_STEPS = 20_000
_DEEPEST = 200_000


def search_tableau(goal: Goal, most_steps: int = MOST_STEPS) -> Tableau:
    """Return a closed tableau. Raises ``NotFoundError``, and ``InputError`` for an unreadable moment."""
    search = _TableauSearch(goal, most_steps)
    with _deep():
        step, _ = search.run()
        return tuple(number_nodes(step, search.root, search.bounds, goal.parameters))


@contextmanager
def _deep() -> Iterator[None]:
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, _DEEPEST))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)


class _TableauSearch:
    """A search with a budget of steps."""

    def __init__(self, goal: Goal, most_steps: int) -> None:
        self.goal = goal
        self.left = most_steps
        self.shared = SharedState(goal)
        self.bounds: list[int] = []
        self.root = 0

    def run(self) -> Proof:
        """Return the proof of the goal."""
        branch = Branch(times=set(self.goal.parameters), elements=set(self.goal.lanes))
        for name in self.goal.parameters:
            if name in self.goal.strict:
                self.bounds.append(self.shared.number())
                self.shared.linear.add(self.bounds[-1], self.goal.strict[name], named_moment(name))
        self.root = self.shared.number()
        branch.add(self.root, TruthAt(False, ZERO, self.goal.claim))
        for place, (_, moments) in enumerate(self.goal.lemmas):
            branch.universals.append(
                PendingUniversal("lemma", place, None, [read_moment(x) for x in moments])
            )
        return self._prove(branch)

    def _prove(self, branch: Branch) -> Proof:
        self.left -= 1
        if self.left < 0:
            raise NotFoundError(ReasonKind.TABLEAU_LIMIT())
        result: Proof | Move | None = None
        while branch.agenda and result is None:
            result = read(self.shared, branch, branch.agenda.pop(0))
        if result is None:
            result = next_move(self.shared, branch)
        return self._apply(branch, result) if isinstance(result, Move) else result

    def _apply(self, branch: Branch, move: Move) -> Proof:
        """Return a rule with proofs of its children; a child that uses no new fact replaces the rule."""
        steps: list[TableauStep] = []
        added: list[tuple[tuple[int, ...], tuple[int, ...]]] = []
        needed = frozenset(move.premises)
        last = len(move.sides) - 1
        for place, facts_of_child in enumerate(move.sides):
            side = branch if place == last else branch.copy()
            if move.new and place == last:
                side.times.add(move.new)
            with self.shared.linear.taken_back():
                numbers, conflict = self._extend(side, facts_of_child)
                step, used = conflict or self._prove(side)
            own_numbers = {*numbers[0], *numbers[1]}
            if not used & own_numbers:
                return step, used
            steps.append(step)
            added.append(numbers)
            needed |= used - own_numbers
        return TableauStep(move.rule, move.arguments, tuple(steps), tuple(added), move.new), needed

    def _extend(
        self, branch: Branch, given: ChildFacts
    ) -> tuple[tuple[tuple[int, ...], tuple[int, ...]], Proof | None]:
        facts, constraints = given
        conflict: Proof | None = None
        numbers: list[int] = []
        for strict, moment in constraints:
            numbers.append(self.shared.number())
            witness = None if conflict else self.shared.linear.add(numbers[-1], strict, moment)
            if witness is not None:
                conflict = TableauStep("CloseLinear", (witness,)), constraints_in(witness)
        places = [self.shared.number() for _ in facts]
        for place, fact in zip(places, facts, strict=True):
            branch.add(place, fact)
        return (tuple(places), tuple(numbers)), conflict
