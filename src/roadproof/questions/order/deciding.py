"""Claims about one family of scenarios, until every implication from it is proved, refuted or in doubt.

``a -> b`` is about all traces, roads, lanes L and parameter values, with the same roles. It is proved where
one reading of it is, and refuted where a drive refutes each. A drive refutes all that it can at once: that
one scenario holds on it and others do not is one claim.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from roadproof.engines.search.known_drive import recast
from roadproof.engines.search.usual_road import usual_road
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.assuming import valid_under
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind
from roadproof.library.compose import both, implication, negation
from roadproof.library.scenarios import Scenario, vehicles_of
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import And, Formula
from roadproof.questions.basis import Basis
from roadproof.questions.order.kinds import Cast, Kind, Reading, casts_of, name_of, own_cast
from roadproof.questions.question import Answers, Steps
from roadproof.reasons import NO_REASON, Reason, ReasonKind, joined
from roadproof.semantics.exact.judging import LazyJudge
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class Edge:
    """A proved implication; ``name``: that of its claim."""

    above: Scenario
    below: Scenario
    name: str
    answer: ClaimAnswer

    @property
    def claim(self) -> Query:
        """The reading that is proved."""
        return self.answer.claim.query

    @property
    def pair(self) -> tuple[str, str]:
        """The two names."""
        return str(self.above), str(self.below)


@dataclass(frozen=True)
class RefutingDrive:
    """A judged drive on which ``node`` holds and some reading of each of ``others`` does not."""

    node: Scenario
    others: tuple[Scenario, ...]
    name: str
    answer: ClaimAnswer

    @property
    def drive(self) -> JudgedDrive:
        """The drive."""
        assert self.answer.drive is not None
        return self.answer.drive


@dataclass(frozen=True)
class UndecidedImplication:
    """An implication of which no reading was proved, and those in ``open`` were not refuted either.

    ``late``: why a search was cut off, where one was; ``claims``: the claims for drives that were asked, by
    name.
    """

    above: Scenario
    below: Scenario
    open: tuple[tuple[Query, Query], ...]
    claims: Mapping[str, Claim]
    late: Reason = NO_REASON

    @property
    def reason(self) -> Reason:
        """Return why it is in doubt."""
        readings = ", ".join(f"{a.text} -> {b.text}" for a, b in self.open) or f"{self.above} -> {self.below}"
        return joined((ReasonKind.OPEN_READINGS(readings), self.late))


def drive_claim(basis: Basis, own: Query, query: Query) -> Claim:
    """Return that there is a drive, on the usual road of ``own``: what is negated beside chooses none."""
    mode = Exists(
        road=usual_road(own.formula),
        vehicles={name: x for name, x in basis.vehicles.items() if not name or name in query.vehicles},
        horizon=basis.horizon,
        objective=basis.objective,
    )
    return claim_of(basis.specification, query, mode, basis.values)


class JudgedDrives:
    """A cache of the claims that are false on drives, each judged once; it stays in this process."""

    def __init__(self) -> None:
        self.known: dict[object, tuple[JudgedDrive, tuple[bool, ...]]] = {}

    def __reduce__(self) -> "tuple[type[JudgedDrives], tuple[()]]":
        return JudgedDrives, ()

    def truths(
        self, basis: Basis, drive: JudgedDrive, own: Cast, mine: Cast, others: Sequence[Cast]
    ) -> tuple[bool, ...]:
        """Return which of ``others`` hold on a drive of ``own``, whose vehicles play as in ``mine``."""
        key = id(drive), mine, tuple(others)
        if key not in self.known:
            file = recast(
                drive.file,
                dict(zip(mine.vehicles, own.vehicles, strict=True)),
                [v for x in (mine, *others) for v in x.vehicles],
            )
            judge, values = LazyJudge.on(file.drive), basis.all_values()
            formulas = tuple(x.query(basis.specification).formula for x in others)
            bound = _all_bound(formulas, file, values)
            self.known[key] = drive, tuple(judge.holds(x) for x in bound)
        return self.known[key][1]


def _all_bound(
    formulas: tuple[Formula, ...], file: DriveFile, values: Mapping[str, Fraction]
) -> Sequence[Formula]:
    """Return formulas on the road of a drive: bound together where they stay apart, which is quicker."""
    together = bind(And(formulas), file.road, file.lanes, values)
    if isinstance(together, And) and len(together.parts) == len(formulas) > 1:
        return together.parts
    return [bind(x, file.road, file.lanes, values) for x in formulas]


@dataclass
class Deciding:
    """The implications from ``family`` to all ``kinds`` that are decided so far; ``run`` decides more.

    ``open``: by kind and kind, the readings of the second that no drive has refuted yet. ``answered``:
    whether all claims have an answer.
    """

    basis: Basis
    kinds: Sequence[Kind]
    family: Sequence[Kind]
    judged: JudgedDrives
    edges: list[Edge] = field(default_factory=list)
    drives: list[RefutingDrive] = field(default_factory=list)
    doubts: list[UndecidedImplication] = field(default_factory=list)
    open: dict[tuple[Scenario, Scenario], list[Reading]] = field(default_factory=dict)
    answered: bool = True

    def replay(self, known: Answers, whole: bool = True) -> None:
        """Answer all claims with what is known; those without an answer are in doubt.

        Unless ``whole``, it ends at the first of these.
        """
        steps = self.run()
        try:
            name, claim = next(steps)
            while True:
                self.answered = self.answered and name in known
                if not self.answered and not whole:
                    return
                name, claim = steps.send(known.get(name) or undecided(claim, NO_REASON))
        except StopIteration:
            return

    def run(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        for kind in self.family:
            for mine, others in casts_of(self.home, self.kinds, kind):
                for other in others:
                    self.open.setdefault((kind.node, other.scenario), []).append(Reading(mine, other))
        first = self.family[0]
        answer = yield f"scenario-{name_of(first.node)}", self._drive(first, self._own(first))
        for kind in self.family if answer.drive is not None else ():
            yield from self._refute_by_one(kind, answer)
        for kind in self.family:
            for target in self.kinds:
                if self.open.get((kind.node, target.node)):
                    yield from self._decide(kind, target)

    @property
    def home(self) -> Specification:
        """The definitions that all is read with."""
        return self.basis.specification

    def _own(self, kind: Kind) -> Query:
        return own_cast(self.home, kind).query(self.home)

    def _drive(self, kind: Kind, query: Query) -> Claim:
        return drive_claim(self.basis, self._own(kind), query)

    # --- drives ----------------------------------------------------------------------------------

    def _refute_by_one(self, kind: Kind, first: ClaimAnswer) -> Steps:
        """Refute with a drive of a kind, on which none of those holds that differ in the sector only."""
        rest = [negation(self._own(x)) for x in self.family if x != kind]
        alone = first
        if rest:
            claim = self._drive(kind, both(self._own(kind), *rest))
            alone = yield f"alone-{name_of(kind.node)}", claim
        if alone.drive is not None:
            yield from self._refute(kind, alone.drive)

    def _refute(self, kind: Kind, drive: JudgedDrive, shown: tuple[str, ClaimAnswer] | None = None) -> Steps:
        """Refute with a drive of a kind all that it refutes of what is still open.

        ``shown``: the answer that the drive is of, and its name; what it shows is not asked again.
        """
        own = own_cast(self.home, kind)
        for mine, others in casts_of(self.home, self.kinds, kind):
            truths = self.judged.truths(self.basis, drive, own, mine, others)
            false = [
                x
                for x, holds in zip(others, truths, strict=True)
                if not holds and Reading(mine, x) in self.open[kind.node, x.scenario]
            ]
            if false:
                queries = [mine.query(self.home), *(negation(x.query(self.home)) for x in false)]
                claim = self._drive(kind, both(*queries))
                if shown is not None and shown[1].claim == claim:
                    name, answer = shown
                else:
                    number = 1 + sum(x.node == kind.node for x in self.drives)
                    name = f"drive-{name_of(kind.node)}-{number}"
                    answer = yield name, claim
                self._add(kind.node, [Reading(mine, x) for x in false], name, answer)

    def _add(self, node: Scenario, readings: Sequence[Reading], name: str, answer: ClaimAnswer) -> None:
        """Note which readings a drive refutes."""
        if answer.drive is not None:
            others = tuple(x.below.scenario for x in readings)
            self.drives.append(RefutingDrive(node, others, name, answer))
            for x in readings:
                self.open[node, x.below.scenario].remove(x)

    # --- one implication -------------------------------------------------------------------------

    def _decide(self, kind: Kind, target: Kind) -> Steps:
        """Ask for a proof of one of the readings, or for drives against all that are left."""
        for name, reading in self._still_open(kind, target):
            above, below = self._queries(reading)
            name = f"implies-{name}"
            answer = yield name, valid_under(self.home, implication(above, below))
            if answer.verdict is Verdict.PROVED:
                self.edges.append(Edge(kind.node, target.node, name, answer))
                return
            yield from self._use(kind, reading, name, answer)
        claims: dict[str, Claim] = {}
        late: list[Reason] = []
        for name, reading in self._still_open(kind, target):
            if reading in self.open[kind.node, target.node]:
                above, below = self._queries(reading)
                claim = self._drive(kind, both(above, negation(below)))
                answer = yield f"against-{name}", claim
                claims[f"against-{name}"] = claim
                late += [answer.reason] if answer.reason.is_late else []
                yield from self._use(kind, reading, f"against-{name}", answer)
                if answer.drive is None:
                    break
        if left := tuple(self._queries(x) for _, x in self._still_open(kind, target)):
            self.doubts.append(
                UndecidedImplication(kind.node, target.node, left, claims, joined(dict.fromkeys(late)))
            )

    def _still_open(self, kind: Kind, target: Kind) -> list[tuple[str, Reading]]:
        """Return the readings that are left, each with its name: by their vehicles, in a fixed order."""
        stem = f"{name_of(kind.node)}-{name_of(target.node)}"
        left = self.open[kind.node, target.node]
        every = [
            Reading(mine, x)
            for mine, others in casts_of(self.home, self.kinds, kind)
            for x in others
            if x.scenario == target.node
        ]
        ordered = sorted(every, key=lambda x: (x.above.vehicles, x.below.vehicles))
        names = [stem] if len(ordered) == 1 else [f"{stem}-{k}" for k in range(1, len(ordered) + 1)]
        return [(name, x) for name, x in zip(names, ordered, strict=True) if x in left]

    def _queries(self, reading: Reading) -> tuple[Query, Query]:
        return reading.above.query(self.home), reading.below.query(self.home)

    def _use(self, kind: Kind, reading: Reading, name: str, answer: ClaimAnswer) -> Steps:
        """Refute what a drive against one reading refutes: others with it, where its vehicles can play."""
        drive = answer.drive
        if drive is None:
            return
        above, below = reading.above.vehicles, reading.below.vehicles
        if {*below} <= {*above} and above == vehicles_of(self.home, kind.node):
            yield from self._refute(kind, drive, (name, answer))
        if reading in self.open[kind.node, reading.below.scenario]:
            self._add(kind.node, [reading], name, answer)
