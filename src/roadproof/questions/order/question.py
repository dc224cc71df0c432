"""The question which scenarios imply which: every implication proved, every other one refuted by a drive.

Scenarios with one formula share all evidence. Families that differ in their road sectors only are decided by
themselves; then the drives of all families are tried on what is in doubt.
"""

from collections.abc import Mapping, Sequence, Set
from dataclasses import field
from functools import cached_property
from itertools import permutations
from typing import Annotated, ClassVar

from roadproof.evidence.answers import shared
from roadproof.evidence.claim import Claim
from roadproof.evidence.codec import Doc, read
from roadproof.library.compose import both, negation
from roadproof.library.scenarios import Scenario
from roadproof.questions.basis import Basis
from roadproof.questions.order.data import OrderData, order_data
from roadproof.questions.order.deciding import (
    Deciding,
    Edge,
    JudgedDrives,
    RefutingDrive,
    UndecidedImplication,
    drive_claim,
)
from roadproof.questions.order.kinds import Kind, families_of, kinds_of, name_of
from roadproof.questions.question import Answers, EvidencePlace, Steps
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class OrderView:
    """All answers together.

    ``edges``: those of the ``proved`` implications that do not follow from others; ``missing``: the pairs
    without implication, with the places in ``drives`` of those that show it.
    """

    kinds: tuple[Kind, ...]
    proved: tuple[Edge, ...]
    edges: tuple[Edge, ...]
    missing: tuple[tuple[Scenario, Scenario, tuple[int, ...]], ...]
    drives: tuple[RefutingDrive, ...]
    doubts: tuple[UndecidedImplication, ...]


@dataclass(frozen=True, kw_only=True)
class Compared:
    """The scenarios to compare."""

    among: Annotated[tuple[shared.Number, ...] | None, Doc("The scenarios; null for all.")] = None


@dataclass(frozen=True)
class OrderQuestion:
    """The question which scenarios imply which."""

    kind: ClassVar[str] = "order"
    basis: Basis
    settings: Compared = field(default_factory=Compared)

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof, recast=True, once=True, disprove=False)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "OrderQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        return cls(basis, read(Compared, settings, where))

    @cached_property
    def kinds(self) -> tuple[Kind, ...]:
        """The scenarios in groups with one formula."""
        return kinds_of(self.basis.specification, self.basis.set_names, self.settings.among)

    @cached_property
    def families(self) -> list[tuple[Kind, ...]]:
        """The kinds in groups that differ in their road sectors only."""
        return families_of(self.kinds)

    @cached_property
    def judged(self) -> JudgedDrives:
        """The claims that are false on known drives."""
        return JudgedDrives()

    def batches(self, known: Answers) -> list["FamilyBatch | UndecidedBatch"]:
        """A batch for each family; when these are settled, one for the undecided ones of each."""
        first: list[FamilyBatch | UndecidedBatch] = [FamilyBatch(self, family) for family in self.families]
        decided = []
        for family in self.families:
            decided.append(self._decided(family, known, whole=False))
            if not decided[-1].answered:
                return first
        drives = {x.name: x.answer.claim for each in decided for x in each.drives}
        return [
            *first,
            *(
                UndecidedBatch(self, name_of(x.family[0].node), drives, tuple(x.doubts))
                for x in decided
                if x.doubts and drives
            ),
        ]

    def _decided(self, family: Sequence[Kind], known: Answers, whole: bool = True) -> Deciding:
        """Return what the answers say of a family; what is not answered is in doubt."""
        deciding = Deciding(self.basis, self.kinds, family, self.judged)
        deciding.replay(known, whole)
        return deciding

    def label(self, name: str) -> str:
        """Return which scenarios the claim of a name is about."""
        word, *stem = name.split("-")
        ends = [f"{int(number)}@{of}" for of, number in zip(stem[::2], stem[1::2], strict=False)]
        match word:
            case "implies" | "against" | "again":
                return " -> ".join(ends)
            case _:  # open: names of claims
                return f"scenario {ends[0]}"

    def view(self, known: Answers) -> OrderView:
        """Return the edges of the Hasse diagram, and for the other pairs what refutes them."""
        decided = [self._retried(self._decided(family, known), known) for family in self.families]
        proved = [edge for x in decided for edge in x.edges]
        pairs = {edge.pair for edge in proved}
        reduced = transitive_reduction(pairs)
        unknowns = [x for each in decided for x in each.doubts]
        unknowns = [x for x in unknowns if str(x.below) not in reachable(str(x.above), pairs)]
        drives = tuple(drive for x in decided for drive in x.drives)
        return OrderView(
            self.kinds,
            tuple(proved),
            tuple(edge for edge in proved if edge.pair in reduced),
            self._missing(pairs, drives, {(x.above, x.below) for x in unknowns}),
            drives,
            tuple(unknowns),
        )

    def _retried(self, deciding: Deciding, known: Answers) -> Deciding:
        """Return what is known of a family when the drives of all were tried on what is in doubt."""
        left: list[UndecidedImplication] = []
        for implication in deciding.doubts:
            every = {name: known.get(name) for name in again(self.basis, implication)}
            shown = {name: x for name, x in every.items() if x is not None and x.drive is not None}
            if len(shown) < len(every):
                left.append(implication)
            else:
                deciding.drives += [
                    RefutingDrive(implication.above, (implication.below,), name, x)
                    for name, x in shown.items()
                ]
        deciding.doubts[:] = left
        return deciding

    def _missing(
        self,
        proved: set[tuple[str, str]],
        drives: Sequence[RefutingDrive],
        doubtful: set[tuple[Scenario, Scenario]],
    ) -> tuple[tuple[Scenario, Scenario, tuple[int, ...]], ...]:
        refuting: dict[tuple[Scenario, Scenario], list[int]] = {}
        for place, drive in enumerate(drives):
            for other in dict.fromkeys(drive.others):
                refuting.setdefault((drive.node, other), []).append(place)
        nodes = [kind.node for kind in self.kinds]
        implied = {(above, below) for above in map(str, nodes) for below in reachable(above, proved)}
        return tuple(
            (above, below, tuple(refuting[above, below]))
            for above, below in permutations(nodes, 2)
            if (str(above), str(below)) not in implied and (above, below) not in doubtful
        )

    def data(self, view: OrderView, place: EvidencePlace, seconds: float) -> OrderData:
        """Return the view as ``--json`` prints it."""
        return order_data(self.basis, view, place, seconds)


@dataclass(frozen=True)
class FamilyBatch:
    """The claims about kinds that differ in their road sectors only."""

    question: OrderQuestion
    family: tuple[Kind, ...]

    @property
    def name(self) -> str:
        """The first scenario."""
        return name_of(self.family[0].node)

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        question = self.question
        return Deciding(question.basis, question.kinds, self.family, question.judged).run()


@dataclass(frozen=True)
class UndecidedBatch:
    """Claims that are in doubt, after the claims of all ``drives``, which may refute them."""

    question: OrderQuestion
    family: str
    drives: Mapping[str, Claim]
    doubts: tuple[UndecidedImplication, ...]

    @property
    def name(self) -> str:
        """The first scenario of the family."""
        return f"again-{self.family}"

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        claims = dict(self.drives)
        for implication in self.doubts:
            claims |= {**implication.claims, **again(self.question.basis, implication)}
        for name, claim in claims.items():  # noqa: UP028 - what is sent is not for the iterator
            yield name, claim


def again(basis: Basis, implication: UndecidedImplication) -> dict[str, Claim]:
    """Return the claims that ask for other drives against an implication in doubt, by name."""
    stem = f"again-{name_of(implication.above)}-{name_of(implication.below)}"
    return {
        f"{stem}-{k}": drive_claim(basis, above, both(above, negation(below)))
        for k, (above, below) in enumerate(implication.open, 1)
    }


# --- relations -------------------------------------------------------------------------------------


def transitive_reduction(pairs: Set[tuple[str, str]]) -> set[tuple[str, str]]:
    """Return the pairs of a relation that do not follow from others by a chain."""
    reduced = set(pairs)
    for above, below in sorted(pairs):
        rest = reduced - {(above, below)}
        if below in reachable(above, rest):
            reduced = rest
    return reduced


def reachable(name: str, pairs: Set[tuple[str, str]]) -> set[str]:
    """Return all that a chain of pairs leads to from ``name``, and ``name``."""
    seen, waiting = {name}, [name]
    while waiting:
        current = waiting.pop()
        new = {below for above, below in pairs if above == current} - seen
        seen |= new
        waiting += new
    return seen
