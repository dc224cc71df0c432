"""The search for a tableau, along the instances that a certificate lists. Not trusted: Coq checks it.

What gives one branch is done at once (``reading.py``), then what divides (``dividing.py``). Steps of which
nothing is used are left out.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from roadproof.evidence.times import ZERO, at, read_moment
from roadproof.extensions.kernel import branch as b
from roadproof.extensions.kernel.dividing import next_move
from roadproof.extensions.kernel.reading import read
from roadproof.extensions.kernel.tableau import Tableau
from roadproof.reasons import Why

MOST_STEPS = 20_000
_DEEPEST = 200_000


def find(goal: b.Goal, most_steps: int = MOST_STEPS) -> Tableau:
    """A closed tableau for ``goal``. Raises ``NotFoundError``, and ``InputError`` for what is not read."""
    search = _Search(goal, most_steps)
    with _deep():
        step, _ = search.run()
        return tuple(b.numbered(step, search.root, search.bounds, goal.parameters))


@contextmanager
def _deep() -> Iterator[None]:
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, _DEEPEST))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)


class _Search:
    def __init__(self, goal: b.Goal, most_steps: int) -> None:
        self.goal = goal
        self.left = most_steps
        self.means = b.Means(goal)
        self.bounds: list[int] = []
        self.root = 0

    def run(self) -> b.Proof:
        branch = b.Branch(times=set(self.goal.parameters), elements=set(self.goal.lanes))
        for name in self.goal.parameters:
            if name in self.goal.strict:
                self.bounds.append(self.means.number())
                self.means.linear.add(self.bounds[-1], self.goal.strict[name], at(name))
        self.root = self.means.number()
        branch.add(self.root, b.At(False, ZERO, self.goal.claim))
        for place, (_, moments) in enumerate(self.goal.lemmas):
            branch.universals.append(b.Universal("lemma", place, None, [read_moment(x) for x in moments]))
        return self._prove(branch)

    def _prove(self, branch: b.Branch) -> b.Proof:
        self.left -= 1
        if self.left < 0:
            raise b.NotFoundError(Why.TABLEAU_LIMIT())
        found: b.Proof | b.Move | None = None
        while branch.agenda and found is None:
            found = read(self.means, branch, branch.agenda.pop(0))
        if found is None:
            found = next_move(self.means, branch)
        return self._apply(branch, found) if isinstance(found, b.Move) else found

    def _apply(self, branch: b.Branch, move: b.Move) -> b.Proof:
        """A rule with its children; a child that uses nothing of what it is given stands in its place."""
        steps: list[b.Step] = []
        added: list[tuple[tuple[int, ...], tuple[int, ...]]] = []
        needed = frozenset(move.premises)
        last = len(move.sides) - 1
        for place, given in enumerate(move.sides):
            side = branch if place == last else branch.copy()
            if move.new and place == last:
                side.times.add(move.new)
            with self.means.linear.taken_back():
                numbers, conflict = self._extend(side, given)
                step, uses = conflict or self._prove(side)
            own = {*numbers[0], *numbers[1]}
            if not uses & own:
                return step, uses
            steps.append(step)
            added.append(numbers)
            needed |= uses - own
        return b.Step(move.rule, move.arguments, tuple(steps), tuple(added), move.new), needed

    def _extend(
        self, branch: b.Branch, given: b.Given
    ) -> tuple[tuple[tuple[int, ...], tuple[int, ...]], b.Proof | None]:
        facts, constraints = given
        conflict: b.Proof | None = None
        numbers: list[int] = []
        for strict, moment in constraints:
            numbers.append(self.means.number())
            witness = None if conflict else self.means.linear.add(numbers[-1], strict, moment)
            if witness is not None:
                conflict = b.Step("CloseLinear", (witness,)), b.used(witness)
        places = [self.means.number() for _ in facts]
        for place, fact in zip(places, facts, strict=True):
            branch.add(place, fact)
        return (tuple(places), tuple(numbers)), conflict
