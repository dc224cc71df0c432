"""One family of scenarios: every implication from it proved, or refuted by a drive.

``a -> b`` is about all traces, roads, lanes L and parameter values, with the same roles. Where one of
the two has more vehicles, the other may have any of its POVs: there is an edge if one such reading is
proved, and none if a drive refutes each. Nodes with one formula share all evidence, and a drive found for
one road sector is put on roads of the others. Families of nodes that differ in their sectors only share
nothing with other families, so that each can be decided by itself.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import permutations

from roadproof.analysis.basis import Basis
from roadproof.engines.search.ask import ask
from roadproof.engines.search.placing import judged_as, placed
from roadproof.engines.search.question import usual_road
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind
from roadproof.library.compose import both, implication, negation
from roadproof.library.scenarios import Scenario, applied, numbers_of, vehicles_of, without_sectors
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.reasons import NO_REASON, Reason, Why, joined
from roadproof.runtime.budget import BudgetExceeded
from roadproof.semantics.exact.exact import judge
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive


@dataclass(frozen=True)
class Kind:
    """Scenarios with one formula, the first of which stands for all; ``like``: equal but for the sector."""

    nodes: tuple[Scenario, ...]
    like: int

    @property
    def node(self) -> Scenario:
        return self.nodes[0]


def kinds_of(
    specification: Specification, sets: Sequence[str], numbers: Sequence[int] | None = None
) -> tuple[Kind, ...]:
    """The scenarios of all ``sets`` in groups with one formula; ``numbers``: only these."""
    found: dict[Formula, list[Scenario]] = {}
    likes: dict[Formula, int] = {}
    like_of: dict[Scenario, int] = {}
    for set_name in sets:
        for number in numbers_of(specification.in_set(set_name)):
            if numbers is not None and number not in numbers:
                continue
            node = Scenario(number, set_name)
            formula = applied(specification, node).formula
            found.setdefault(without_names(formula), []).append(node)
            like_of[node] = likes.setdefault(without_sectors(formula), len(likes))
    return tuple(Kind(tuple(nodes), like_of[nodes[0]]) for nodes in found.values())


def families_of(kinds: Sequence[Kind]) -> list[tuple[Kind, ...]]:
    """The kinds in groups that differ in their road sectors only."""
    families: dict[int, list[Kind]] = {}
    for kind in kinds:
        families.setdefault(kind.like, []).append(kind)
    return [tuple(family) for family in families.values()]


FAR = Fraction(2000)


@dataclass(frozen=True)
class Edge:
    """A proved implication that does not follow from others."""

    above: Scenario
    below: Scenario
    claim: Query
    certificate: Certificate


@dataclass(frozen=True)
class RefutationTask:
    """A judged drive on which ``node`` holds and some reading of each of ``others`` does not."""

    node: Scenario
    others: tuple[Scenario, ...]
    drive: JudgedDrive


@dataclass(frozen=True)
class OrderDoubt:
    """An implication of which no reading was proved, and those in ``open`` were not refuted either.

    A reading is the two scenarios applied to vehicles and a lane. ``late``: why the search was cut off,
    where it was; ``known``: the reason of a doubt that was kept.
    """

    above: Scenario
    below: Scenario
    open: tuple[tuple[Query, Query], ...]
    late: Reason = NO_REASON
    known: Reason = NO_REASON

    @property
    def reason(self) -> Reason:
        if self.known:
            return self.known
        told = ", ".join(f"{a.text} -> {b.text}" for a, b in self.open) or f"{self.above} -> {self.below}"
        return joined((Why.OPEN_READINGS(told), self.late))


@dataclass(frozen=True)
class Decisions:
    """All that was found about implications: together it settles each of them, or doubts it.

    ``again``: whether the drives of all other families were tried on the doubts.
    """

    edges: tuple[Edge, ...] = ()
    drives: tuple[RefutationTask, ...] = ()
    doubts: tuple[OrderDoubt, ...] = ()
    again: bool = False


def decide_family(basis: Basis, kinds: Sequence[Kind], family: Sequence[Kind]) -> Decisions:
    """Decide the implications from the kinds of ``family`` to all other ``kinds``."""
    return _DecisionJobs(basis, tuple(kinds), tuple(family)).run()


def settle_doubts(basis: Basis, decided: Decisions, drives: Sequence[JudgedDrive]) -> Decisions:
    """``decided`` with the doubts settled that drives found for other scenarios settle.

    The vehicles may be exchanged: what is ahead for one scenario is behind for its mirror image.
    """
    distinct = {repr(x.file.drive): x.file for x in drives}.values()
    refuting = list(decided.drives)
    doubts: list[OrderDoubt] = []
    for doubt in decided.doubts:
        shown = [_refuted_by(basis, distinct, *reading) for reading in doubt.open]
        if None in shown or not shown:
            doubts.append(doubt)
        else:
            refuting += [RefutationTask(doubt.above, (doubt.below,), x) for x in shown if x is not None]
    return Decisions(decided.edges, tuple(refuting), tuple(doubts), again=True)


def _refuted_by(basis: Basis, files: Iterable[DriveFile], above: Query, below: Query) -> JudgedDrive | None:
    against = both(above, negation(below))
    wanted = set(against.vehicles)
    for file in files:
        names = tuple(file.drive.vehicles)
        for roles in permutations(names) if wanted <= set(names) else ():
            cast = file.drive.cast(dict(zip(roles, names, strict=True)))
            shown = placed(replace(file, drive=cast), against, basis.library)
            if shown is not None:
                return shown
    return None


@dataclass(frozen=True)
class Cast:
    """A scenario, and the vehicles that play in it."""

    scenario: Scenario
    vehicles: tuple[str, ...]


Reading = tuple[Cast, Cast]


class _DecisionJobs:
    def __init__(self, basis: Basis, kinds: tuple[Kind, ...], family: tuple[Kind, ...]) -> None:
        self.basis = basis
        self.specification = basis.specification
        self.values = basis.all_values()
        self.kinds = kinds
        self.family = family
        self.pool: list[JudgedDrive] = []
        self.queries: dict[Cast, Query] = {}
        self.edges: list[Edge] = []
        self.drives: list[RefutationTask] = []
        self.doubts: list[OrderDoubt] = []
        self.vain: set[int] = set()  # what kinds are like that no drive was found against
        # By kind and kind: the readings of the second that no drive has refuted yet.
        self.open: dict[tuple[Scenario, Scenario], set[Reading]] = {}

    def run(self) -> Decisions:
        for kind in self.family:
            for mine, others in self._casts(kind):
                for other in others:
                    self.open.setdefault((kind.node, other.scenario), set()).add((mine, other))
        for kind in self.family:
            self._refute_with_pool(kind)
        for kind in self.family:
            for target in self.kinds:
                if self.open.get((kind.node, target.node)):
                    try:
                        self._decide(kind, target)
                    except BudgetExceeded as late:
                        self._doubt(kind, target, late.reason)
        return Decisions(tuple(self.edges), tuple(self.drives), tuple(self.doubts))

    def _doubt(self, kind: Kind, target: Kind, late: Reason = NO_REASON) -> None:
        still = [(self._query(a), self._query(b)) for a, b in self._still_open(kind, target)]
        self.doubts.append(OrderDoubt(kind.node, target.node, tuple(still), late))

    def _still_open(self, kind: Kind, target: Kind) -> list[Reading]:
        return sorted(self.open[kind.node, target.node], key=lambda x: (x[0].vehicles, x[1].vehicles))

    # --- who plays whom --------------------------------------------------------------------------

    def _casts(self, kind: Kind) -> Iterator[tuple[Cast, tuple[Cast, ...]]]:
        """The ways to give vehicles to a kind, each with what else may hold then."""
        mine = vehicles_of(self.specification, kind.node)
        by_roles: dict[tuple[str, ...], list[Cast]] = {}
        for other in self.kinds:
            if other == kind:
                continue
            theirs = vehicles_of(self.specification, other.node)
            if len(theirs) == len(mine):
                by_roles.setdefault(mine, []).append(Cast(other.node, mine))
            elif len(theirs) < len(mine):
                for rest in permutations(mine[1:], len(theirs) - 1):
                    by_roles.setdefault(mine, []).append(Cast(other.node, (mine[0], *rest)))
            else:
                for rest in permutations(theirs[1:], len(mine) - 1):
                    by_roles.setdefault((theirs[0], *rest), []).append(Cast(other.node, theirs))
        for vehicles, others in by_roles.items():
            yield Cast(kind.node, vehicles), tuple(others)

    def _query(self, cast: Cast) -> Query:
        if cast not in self.queries:
            self.queries[cast] = applied(self.specification, cast.scenario, cast.vehicles)
        return self.queries[cast]

    def _own(self, kind: Kind) -> Query:
        return self._query(Cast(kind.node, vehicles_of(self.specification, kind.node)))

    def _alone(self, kind: Kind) -> Query:
        """A kind, and none of those that differ from it in the sector only."""
        return both(self._own(kind), *(negation(self._own(x)) for x in self.family if x != kind))

    # --- drives ----------------------------------------------------------------------------------

    def _refute_with_pool(self, kind: Kind) -> None:
        if not self.pool:
            try:
                self.pool += self._ask(self._own(kind), kind)
            except BudgetExceeded:  # each implication that is still open then is asked by itself
                return
        for judged in tuple(self.pool):
            here = placed(judged.file, self._alone(kind), self.basis.library)
            if here is not None:
                self._use(kind, here)

    def _use(self, kind: Kind, judged: JudgedDrive) -> None:
        """Refute with a drive all that it refutes of what is still open."""
        for mine, others in self._casts(kind):
            file = self._recast(judged.file, kind, mine, others)
            still = [x for x in others if (mine, x) in self.open[kind.node, x.scenario]]
            false = [x for x in still if not self._holds(file, self._query(x))]
            if not false:
                continue
            refuted = both(self._query(mine), *(negation(self._query(x)) for x in false))
            shown = judged_as(file, refuted, self.basis.library)
            if shown is None:
                continue
            self.drives.append(RefutationTask(kind.node, tuple(x.scenario for x in false), shown))
            for x in false:
                self.open[kind.node, x.scenario].discard((mine, x))

    def _recast(self, file: DriveFile, kind: Kind, mine: Cast, others: Sequence[Cast]) -> DriveFile:
        """The drive with the vehicles of a cast; those that it does not have are far behind all others."""
        own = vehicles_of(self.specification, kind.node)
        roles = dict(zip(mine.vehicles, own, strict=True))
        motions = dict(file.drive.cast(roles).vehicles)
        wanted = {v for x in (mine, *others) for v in x.vehicles}
        for name in sorted(wanted - set(motions)):
            slowest = min(motions, key=lambda known: motions[known].s)
            motions[name] = replace(motions[slowest], s=motions[slowest].s - FAR)
            roles[name] = roles[slowest]
        return replace(file, drive=Drive(motions, file.drive.cast(roles).own))

    def _holds(self, file: DriveFile, query: Query) -> bool:
        formula = bind(query.formula, file.road, file.lanes, {**self.values, **file.values})
        return judge(formula, file.drive).holds

    def _ask(self, query: Query, kind: Kind) -> tuple[JudgedDrive, ...]:
        """A drive for a formula, on the usual road of a kind: what is negated chooses no road."""
        return ask(self.basis.search(query, usual_road(self._own(kind).formula))).drives

    # --- proofs ----------------------------------------------------------------------------------

    def _decide(self, kind: Kind, target: Kind) -> None:
        """A proof of one of the readings, or drives against all that are left.

        What was looked for in vain is not looked for again on another road.
        """
        one, other = kind.node, target.node
        for mine, theirs in self._still_open(kind, target):
            claim = implication(self._query(mine), self._query(theirs))
            result = self.basis.proof_of(claim)
            if result.verdict is Verdict.PROVED and result.certificate is not None:
                self.edges.append(Edge(one, other, claim, result.certificate))
                return
        for reading in self._still_open(kind, target):
            if reading not in self.open[one, other]:
                continue
            above, below = (self._query(cast) for cast in reading)
            found = () if target.like in self.vain else self._ask(both(above, negation(below)), kind)
            if not found:
                self.vain.add(target.like)
                self._doubt(kind, target)
                return
            if {*below.vehicles} <= {*above.vehicles} and above.vehicles == self._own(kind).vehicles:
                self.pool.append(found[0])
                self._use(kind, found[0])
                self._share(kind, found[0])
            else:
                self.drives.append(RefutationTask(one, (other,), found[0]))
                self.open[one, other].discard(reading)

    def _share(self, kind: Kind, found: JudgedDrive) -> None:
        """Use a new drive for the kinds that differ from its own in the sector only."""
        for twin in self.family:
            if twin != kind:
                here = placed(found.file, self._alone(twin), self.basis.library)
                if here is not None:
                    self._use(twin, here)
