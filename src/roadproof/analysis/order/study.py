"""Which scenarios imply which: every implication proved, every other one refuted by a drive."""

from collections.abc import Collection, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import permutations
from typing import ClassVar

from roadproof.analysis.basis import Basis
from roadproof.analysis.order.deciding import (
    Decisions,
    Edge,
    Kind,
    OrderDoubt,
    RefutationTask,
    decide_family,
    families_of,
    settle_doubts,
)
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared
from roadproof.errors import InputError
from roadproof.evidence.answers import order as kept
from roadproof.evidence.answers.order import SCHEMA
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.strict import JsonObject
from roadproof.library.elaborate import StatedQuery
from roadproof.library.scenarios import Scenario, applied
from roadproof.reasons import Reason


@dataclass(frozen=True)
class Family:
    """Kinds that differ in their road sectors only: the implications from them are to be decided."""

    kinds: tuple[Kind, ...]


@dataclass(frozen=True)
class Doubtful:
    """A family with doubts, on which the drives of all families are to be tried."""

    family: tuple[Kind, ...]
    decided: Decisions
    drives: tuple[JudgedDrive, ...]


@dataclass(frozen=True)
class Order:
    """All answers together.

    ``edges``: those of the ``proved`` implications that do not follow from others; ``missing``: the pairs
    without implication, with the places in ``drives`` of those that show it.
    """

    kinds: tuple[Kind, ...]
    proved: tuple[Edge, ...]
    edges: tuple[Edge, ...]
    missing: tuple[tuple[Scenario, Scenario, tuple[int, ...]], ...]
    drives: tuple[RefutationTask, ...]
    doubts: tuple[OrderDoubt, ...]


@dataclass(frozen=True)
class Ordering(Unprepared):
    """The question which of ``kinds`` imply which, as a ``study.frame.Study``."""

    record_type: ClassVar[type[kept.Record]] = kept.Record
    basis: Basis
    kinds: tuple[Kind, ...]

    @property
    def question(self) -> Question:
        said: JsonObject = {"sets": list(self.basis.set_names), **self.basis.said()}
        more = {"order": " ".join(str(kind.node) for kind in self.kinds), **self.basis.limits}
        return Question(SCHEMA, said, more, self.basis.library)

    @property
    def families(self) -> dict[str, tuple[Kind, ...]]:
        """The families by the names under which their answers are kept."""
        return {name_of(family): family for family in families_of(self.kinds)}

    def pieces(self, known: Mapping[str, Decisions]) -> Sequence[Family | Doubtful]:
        """Doubts are left to the end, when the drives of all families are there to settle them."""
        left = [Family(family) for name, family in self.families.items() if name not in known]
        if left:
            return left
        drives = tuple(x.drive for name in self.families for x in known[name].drives)
        return [
            Doubtful(family, known[name], drives)
            for name, family in self.families.items()
            if known[name].doubts and not known[name].again
        ]

    def settle(self, piece: Family | Doubtful) -> dict[str, Decisions]:
        match piece:
            case Family(kinds):
                return {name_of(kinds): decide_family(self.basis, self.kinds, kinds)}
            case Doubtful(family, decided, drives):
                return {name_of(family): settle_doubts(self.basis, decided, drives)}

    def doubt(self, piece: Family | Doubtful, reason: Reason) -> dict[str, Decisions]:
        match piece:
            case Family(kinds):
                pairs = [(a.node, b.node) for a in kinds for b in self.kinds if a != b]
                doubts = tuple(OrderDoubt(above, below, (), reason) for above, below in pairs)
                return {name_of(kinds): Decisions(doubts=doubts, again=True)}
            case Doubtful(family, decided, _):
                return {name_of(family): Decisions(decided.edges, decided.drives, decided.doubts, again=True)}

    def is_sure(self, answer: Decisions) -> bool:
        return not answer.doubts

    def wanted(self, known: Mapping[str, Decisions]) -> Collection[str]:
        return self.families

    def key(self, name: str) -> str:
        """Drives of all families may settle a doubt about one."""
        home = self.basis.specification
        return self.basis.key(
            (applied(home, node) for kind in self.kinds for node in kind.nodes),
            self.kinds,
            self.families[name],
        )

    def record(self, name: str, answer: Decisions, shelf: EvidenceStore) -> kept.Record:
        proved = tuple(
            kept.Edge(
                above=str(edge.above),
                below=str(edge.below),
                claim=edge.claim.text,
                certificate=shelf.certificate(
                    f"edge-{_file(edge.above)}-{_file(edge.below)}.json", edge.certificate
                ),
            )
            for edge in answer.edges
        )
        drives = tuple(
            kept.Refutation(
                holds=str(x.node),
                fails=tuple(sorted({str(node) for node in x.others})),
                drive=shelf.drive(f"drive-{_file(x.node)}-{number}.json", x.drive),
            )
            for number, x in enumerate(answer.drives, 1)
        )
        doubts = tuple(
            kept.Doubt(above=str(x.above), below=str(x.below), reason=x.reason) for x in answer.doubts
        )
        return kept.Record(family=name, proved=proved, drives=drives, doubts=doubts)

    def recall(self, record: kept.Record, shelf: EvidenceStore) -> tuple[str, Decisions]:
        edges: list[Edge] = []
        for edge in record.proved:
            certificate = shelf.read_certificate(edge.certificate)
            assert certificate is not None
            claim = StatedQuery(self.basis.specification, edge.claim)
            edges.append(Edge(_scenario(edge.above), _scenario(edge.below), claim, certificate))
        drives: list[RefutationTask] = []
        for x in record.drives:
            drive = shelf.read_drive(x.drive)
            assert drive is not None
            drives.append(RefutationTask(_scenario(x.holds), tuple(map(_scenario, x.fails)), drive))
        name = record.family
        doubts = tuple(
            OrderDoubt(_scenario(x.above), _scenario(x.below), (), known=x.reason) for x in record.doubts
        )
        settled = {(x.above, x.below) for x in edges} | {(x.above, x.below) for x in doubts}
        settled |= {(x.node, y) for x in drives for y in x.others}
        for kind in self.families.get(name, ()):
            for other in self.kinds:
                if other != kind and (kind.node, other.node) not in settled:
                    raise InputError(f"nothing is kept of {kind.node} -> {other.node}")
        return name, Decisions(tuple(edges), tuple(drives), doubts, again=True)

    def order(self, answers: Mapping[str, Decisions]) -> Order:
        """The edges of the Hasse diagram, and for the other pairs what refutes them."""
        decided = [answers[name] for name in self.families]
        proved = [edge for x in decided for edge in x.edges]
        pairs = {(str(edge.above), str(edge.below)) for edge in proved}
        reduced = transitive_reduction(pairs)
        doubts = [x for each in decided for x in each.doubts]
        doubts = [x for x in doubts if str(x.below) not in reachable(str(x.above), pairs)]
        drives = tuple(drive for x in decided for drive in x.drives)
        return Order(
            self.kinds,
            tuple(proved),
            tuple(edge for edge in proved if (str(edge.above), str(edge.below)) in reduced),
            self._missing(pairs, drives, {(x.above, x.below) for x in doubts}),
            drives,
            tuple(doubts),
        )

    def _missing(
        self,
        proved: set[tuple[str, str]],
        drives: Sequence[RefutationTask],
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

    def index(self, order: Order, records: Mapping[str, kept.Record], seconds: float) -> kept.Index:
        """The index, made of the answers as they are recorded."""
        every = [records[name] for name in self.families]
        proved = tuple(edge for record in every for edge in record.proved)
        reduced = {(str(edge.above), str(edge.below)) for edge in order.edges}
        doubts = {(str(x.above), str(x.below)) for x in order.doubts}
        drives = (x for record in every for x in record.drives)
        return kept.Index(
            **self.question.heading,
            kinds=tuple(tuple(map(str, kind.nodes)) for kind in order.kinds),
            proved=proved,
            edges=tuple(edge for edge in proved if edge.pair in reduced),
            missing=tuple(
                kept.MissingImplication(
                    above=str(above), below=str(below), drives=tuple(place + 1 for place in places)
                )
                for above, below, places in order.missing
            ),
            drives=tuple(
                kept.ListedRefutation(number=k, holds=x.holds, fails=x.fails, drive=x.drive)
                for k, x in enumerate(drives, 1)
            ),
            doubts=tuple(x for record in every for x in record.doubts if x.pair in doubts),
            seconds=round(seconds, 1),
        )


def name_of(family: Sequence[Kind]) -> str:
    """Under which name the answer for a family is kept."""
    return _file(family[0].node)


def _file(node: Scenario) -> str:
    return f"{node.set_name}-{node.number:02}"


def _scenario(name: str) -> Scenario:
    number, _, set_name = name.partition("@")
    return Scenario(int(number), set_name)


# --- relations -------------------------------------------------------------------------------------


def transitive_reduction(pairs: Set[tuple[str, str]]) -> set[tuple[str, str]]:
    """The pairs of a relation that do not follow from others by a chain."""
    kept = set(pairs)
    for above, below in sorted(pairs):
        rest = kept - {(above, below)}
        if below in reachable(above, rest):
            kept = rest
    return kept


def reachable(name: str, pairs: Set[tuple[str, str]]) -> set[str]:
    """All that a chain of pairs leads to from ``name``, and ``name``."""
    seen, waiting = {name}, [name]
    while waiting:
        current = waiting.pop()
        new = {below for above, below in pairs if above == current} - seen
        seen |= new
        waiting += new
    return seen
