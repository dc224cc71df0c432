"""Which scenarios imply which: every implication proved, every other one refuted by a drive.

``a -> b`` is about all traces, roads, lanes L and parameter values, with the same roles. Where one of
the two has more vehicles, the other may have any of its POVs: there is an edge if one such reading is
proved, and none if a drive refutes each. Nodes with one formula share all evidence, and a drive found for
one road sector is put on roads of the others. Families of nodes that differ in their sectors only share
nothing with other families, so that each can be decided by itself.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import permutations
from typing import Any

from roadproof.analysis.order.kinds import Kind, text_of
from roadproof.analysis.placing import Shown, as_data, show_elsewhere
from roadproof.analysis.requests import Asked, Request, applied, ask
from roadproof.effort import Late
from roadproof.evidence.certificate import to_json
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.judged import judge_file
from roadproof.judge.exact import judge
from roadproof.prove.prover import prove
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Library, Specification
from roadproof.spec.query import Query
from roadproof.spec.scenarios import Scenario, vehicles_of
from roadproof.verdict import Verdict
from roadproof.witness.question import Means, usual_road
from roadproof.world.drive import Drive

FAR = Fraction(2000)


@dataclass(frozen=True)
class Edge:
    """A proved implication that does not follow from others; ``certificate`` is a file's text."""

    above: Scenario
    below: Scenario
    claim: str
    certificate: str


@dataclass(frozen=True)
class Refuting:
    """A judged drive on which ``node`` holds and some reading of each of ``others`` does not."""

    node: Scenario
    others: tuple[Scenario, ...]
    data: Mapping[str, Any]


@dataclass(frozen=True)
class Doubt:
    """An implication of which no reading was proved, and those in ``open`` were not refuted either.

    A reading is the two scenarios applied to vehicles and a lane, as text. ``late``: why the clock cut the
    search off, where it did.
    """

    above: Scenario
    below: Scenario
    open: tuple[tuple[str, str], ...]
    late: str = ""

    @property
    def reason(self) -> str:
        readings = "neither a proof nor a drive against " + ", ".join(f"{a} -> {b}" for a, b in self.open)
        return f"{readings}; {self.late}" if self.late else readings


@dataclass(frozen=True)
class Decided:
    """All that was found about implications: together it settles each of them, or doubts it."""

    edges: tuple[Edge, ...] = ()
    drives: tuple[Refuting, ...] = ()
    doubts: tuple[Doubt, ...] = ()


def decide_family(asked: Asked, kinds: Sequence[Kind], family: Sequence[Kind]) -> Decided:
    """Decide the implications from the kinds of ``family`` to all other ``kinds``."""
    return _Deciding(asked, tuple(kinds), tuple(family)).run()


def settle_doubts(asked: Asked, decided: Decided, drives: Sequence[Mapping[str, Any]]) -> Decided:
    """``decided`` with the doubts settled that drives found for other scenarios settle.

    The vehicles may be exchanged: what is ahead for one scenario is behind for its mirror image.
    """
    library, specification = asked.load()
    distinct = {repr(data["vehicles"]): data for data in drives}.values()
    refuting = list(decided.drives)
    doubts: list[Doubt] = []
    for doubt in decided.doubts:
        shown = [_refuted_by(distinct, *reading, library, specification) for reading in doubt.open]
        if None in shown:
            doubts.append(doubt)
        else:
            refuting += [Refuting(doubt.above, (doubt.below,), x.data) for x in shown if x is not None]
    return replace(decided, drives=tuple(refuting), doubts=tuple(doubts))


def _refuted_by(
    drives: Iterable[Mapping[str, Any]],
    text: str,
    below: str,
    library: Library,
    specification: Specification,
) -> Shown | None:
    formula = f"{text} and not {below}"
    wanted = set(read_claim(specification, formula).vehicles)
    for data in drives:
        names = tuple(data["vehicles"])
        for roles in permutations(names) if wanted <= set(names) else ():
            vehicles = {role: data["vehicles"][name] for name, role in zip(names, roles, strict=True)}
            shown = show_elsewhere(Shown(formula, {**data, "vehicles": vehicles}), formula, library)
            if shown is not None:
                return shown
    return None


@dataclass(frozen=True)
class _Cast:
    """One way to give the vehicles of a drive to a kind, and what else may hold of it then."""

    text: str
    others: tuple[tuple[Scenario, str], ...]


class _Deciding:
    def __init__(self, asked: Asked, kinds: tuple[Kind, ...], family: tuple[Kind, ...]) -> None:
        self.asked = asked
        self.library, self.specification = asked.load()
        self.values = {**default_values(self.library), **asked.values}
        self.kinds = kinds
        self.family = family
        self.pool: list[Shown] = []
        self.queries: dict[str, Query] = {}
        self.edges: list[Edge] = []
        self.drives: list[Refuting] = []
        self.doubts: list[Doubt] = []
        self.vain: set[int] = set()  # what kinds are like that no drive was found against
        # By kind and kind: the readings of the second that no drive has refuted yet.
        self.open: dict[tuple[Scenario, Scenario], set[tuple[str, str]]] = {}

    def run(self) -> Decided:
        for kind in self.family:
            for cast in self._casts(kind):
                for node, text in cast.others:
                    self.open.setdefault((kind.node, node), set()).add((cast.text, text))
        for kind in self.family:
            self._refute_with_pool(kind)
        for kind in self.family:
            for other in self.kinds:
                if self.open.get((kind.node, other.node)):
                    try:
                        self._decide(kind, other)
                    except Late as late:
                        still = tuple(sorted(self.open[kind.node, other.node]))
                        self.doubts.append(Doubt(kind.node, other.node, still, str(late)))
        return Decided(tuple(self.edges), tuple(self.drives), tuple(self.doubts))

    # --- drives ----------------------------------------------------------------------------------

    def _casts(self, kind: Kind) -> Iterator[_Cast]:
        mine = vehicles_of(self.specification, kind.node)
        by_size: dict[tuple[str, ...], list[tuple[Scenario, str]]] = {}
        for other in self.kinds:
            if other == kind:
                continue
            theirs = vehicles_of(self.specification, other.node)
            if len(theirs) <= len(mine):
                readings = [(mine[0], *rest) for rest in permutations(mine[1:], len(theirs) - 1)]
                if len(theirs) == len(mine):
                    readings = [mine]
                for reading in readings:
                    text = applied(other.node, self.specification, reading)
                    by_size.setdefault(mine, []).append((other.node, text))
            else:
                for reading in ((theirs[0], *rest) for rest in permutations(theirs[1:], len(mine) - 1)):
                    text = applied(other.node, self.specification, theirs)
                    by_size.setdefault(reading, []).append((other.node, text))
        for vehicles, others in by_size.items():
            yield _Cast(applied(kind.node, self.specification, vehicles), tuple(others))

    def _refute_with_pool(self, kind: Kind) -> None:
        text = text_of(self.asked, kind.node)
        alone = " and ".join([text, *(f"not {x}" for x in self._same_elsewhere(kind))])
        if not self.pool:
            try:
                found = self._ask(text, text)
            except Late:  # each implication that is still open then is asked by itself
                found = None
            if found is None:
                return
            self.pool.append(found)
        for shown in tuple(self.pool):
            placed = show_elsewhere(shown, alone, self.library)
            if placed is not None:
                self._use(kind, placed)

    def _same_elsewhere(self, kind: Kind) -> list[str]:
        """The kinds that differ from this one in the sector only."""
        return [text_of(self.asked, x.node) for x in self.family if x != kind]

    def _use(self, kind: Kind, shown: Shown) -> None:
        """Refute with a drive all that it refutes of what is still open."""
        for cast in self._casts(kind):
            file = self._recast(read_drive(dict(shown.data), "drive"), kind, cast)
            still = [(n, x) for n, x in cast.others if (cast.text, x) in self.open[kind.node, n]]
            false = [(node, text) for node, text in still if not self._holds(file, text)]
            if not false:
                continue
            formula = " and ".join([cast.text, *(f"not {text}" for _, text in false)])
            file = replace(file, formula=formula, scenario=None)
            ruling = judge_file(file, self.library)
            if not ruling.accepted:
                continue
            self.drives.append(Refuting(kind.node, tuple(node for node, _ in false), as_data(file, ruling)))
            for node, text in false:
                self.open[kind.node, node].discard((cast.text, text))

    def _recast(self, file: DriveFile, kind: Kind, cast: _Cast) -> DriveFile:
        """The drive with the vehicles of a cast; those that it does not have are far behind all others."""
        mine = vehicles_of(self.specification, kind.node)
        query = self._query(cast.text)
        playing = cast.text[cast.text.index("(") + 1 : -1].split(",")[:-1]
        motions = {new: file.drive.vehicles[old] for new, old in zip(playing, mine, strict=True)}
        wanted = {v for _, text in cast.others for v in self._query(text).vehicles} | set(query.vehicles)
        for name in sorted(wanted - set(motions)):
            slowest = min(motions.values(), key=lambda motion: motion.s)
            motions[name] = replace(slowest, s=slowest.s - FAR)
        return replace(file, drive=Drive(motions))

    def _holds(self, file: DriveFile, text: str) -> bool:
        formula = bind(self._query(text).formula, file.road, file.lanes, {**self.values, **file.values})
        return judge(formula, file.drive).holds

    def _query(self, text: str) -> Query:
        if text not in self.queries:
            self.queries[text] = read_claim(self.specification, text)
        return self.queries[text]

    def _ask(self, text: str, on: str) -> Shown | None:
        """A drive for a formula, on the usual road of another: what is negated chooses no road."""
        request = Request(
            text,
            self.asked.sets[0],
            self.asked.options,
            self.asked.specs,
            self.values,
            usual_road(self._query(on).formula).name,
            horizon=self.asked.horizon,
            means=Means("smooth", effort=self.asked.effort, explain=False),
        )
        drives = ask(request).drives
        return Shown(text, drives[0].as_data()) if drives else None

    # --- proofs ----------------------------------------------------------------------------------

    def _decide(self, kind: Kind, target: Kind) -> None:
        """A proof of one of the readings, or drives against all that are left.

        What was looked for in vain is not looked for again on another road.
        """
        one, other = kind.node, target.node
        for text, below in sorted(self.open[one, other]):
            claim = f"{text} -> {below}"
            result = prove(
                self.specification,
                read_claim(self.specification, claim),
                self.asked.effort.of(self.asked.proof),
            )
            if result.verdict is Verdict.PROVED and result.certificate is not None:
                self.edges.append(Edge(one, other, claim, to_json(result.certificate)))
                return
        for text, below in sorted(self.open[one, other]):
            if (text, below) not in self.open[one, other]:
                continue
            found = None if target.like in self.vain else self._ask(f"{text} and not {below}", text)
            if found is None:
                self.vain.add(target.like)
                self.doubts.append(Doubt(one, other, tuple(sorted(self.open[one, other]))))
                return
            if len(vehicles_of(self.specification, one)) == len(self._query(f"{text} and {below}").vehicles):
                self.pool.append(found)
                self._use(kind, found)
                self._share(kind, found)
            else:
                self.drives.append(Refuting(one, (other,), found.data))
                self.open[one, other].discard((text, below))

    def _share(self, kind: Kind, found: Shown) -> None:
        """Use a new drive for the kinds that differ from its own in the sector only."""
        for twin in self.family:
            if twin != kind:
                others = [f"not {x}" for x in self._same_elsewhere(twin)]
                alone = " and ".join([text_of(self.asked, twin.node), *others])
                placed = show_elsewhere(found, alone, self.library)
                if placed is not None:
                    self._use(twin, placed)
