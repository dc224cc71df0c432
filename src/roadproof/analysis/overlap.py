"""Which scenarios can hold together: for every pair a drive, a proof that there is none, or a doubt.

Pairs that differ only in their road sectors (eq. disturbFormat: rows 9 to 24 repeat rows 1 to 8) form a
group. One pair is solved for each group; its drive is put on roads of the other sectors and judged
there, and its core is looked up in the others, each of which gets a certificate of its own.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import combinations, permutations
from typing import ClassVar, Literal

from roadproof.analysis.basis import Basis
from roadproof.analysis.placing import placed
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.engines.prove.prover import Result
from roadproof.engines.search.ask import ask
from roadproof.engines.search.impossible import explain, parts, told_parts
from roadproof.evidence.answers import overlap as kept_answers
from roadproof.evidence.answers.overlap import SCHEMA
from roadproof.evidence.settled import Settled
from roadproof.library import scenarios as s
from roadproof.library.alike import likes_of
from roadproof.library.compose import both, either, eventually, negation
from roadproof.library.elaborate import StatedQuery, read_claim
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.reasons import Reason, Why, joined
from roadproof.runtime.budget import BudgetExceeded
from roadproof.runtime.records import dataclass
from roadproof.runtime.timing import now, since
from roadproof.verdict import DriveVerdict, Verdict

OTHER_LANE = "L2"


@dataclass(frozen=True)
class Meeting:
    """How two scenarios may meet.

    ``lanes``: both speak of one lane, or each of its own. ``roles``: the vehicles play the same parts
    in both, or any. ``start``: both start at time 0, or one at 0 and the other then or later.
    """

    lanes: Literal["same", "any"] = "same"
    roles: Literal["same", "any"] = "same"
    start: Literal["same", "any"] = "same"


def conjunctions(
    specification: Specification, one: s.Scenario, other: s.Scenario, meeting: Meeting
) -> tuple[Query, ...]:
    """The formulas of which one has to hold for ``one`` and ``other`` to hold together.

    Names are to be read with ``specification``. The vehicles are those of the scenario that has more of them;
    a two-vehicle scenario meets scenario 2 with SV and either of its POVs.
    """
    mine, theirs = s.vehicles_of(specification, one), s.vehicles_of(specification, other)
    swapped = len(theirs) > len(mine)
    most, fewer = (theirs, mine) if swapped else (mine, theirs)
    lane = OTHER_LANE if meeting.lanes == "any" else s.LANE
    found: list[Query] = []
    for roles in _assignments(most, len(fewer), meeting.roles):
        mine_now, theirs_now = (roles, most) if swapped else (most, roles)
        first = s.applied(specification, one, mine_now)
        second = s.applied(specification, other, theirs_now, lane)
        if meeting.start == "same":
            found.append(both(first, second))
        else:
            found += [both(first, eventually(second)), both(second, eventually(first))]
    return tuple(found)


def _assignments(vehicles: Sequence[str], count: int, roles: Literal["same", "any"]) -> list[tuple[str, ...]]:
    """Who may play the ``count`` parts of the smaller scenario."""
    if roles == "any":
        return list(permutations(vehicles, count))
    return [(vehicles[0], *others) for others in combinations(vehicles[1:], count - 1)]


@dataclass(frozen=True)
class Core:
    """Parts of a conjunction that already clash."""

    whole: Query
    parts: tuple[Formula, ...]

    @property
    def told(self) -> tuple[str, ...]:
        """The parts as texts; the whole where no part of it is known to clash."""
        return told_parts(self.parts) or (self.whole.text,)


@dataclass(frozen=True)
class PairVerdict(Settled[DriveVerdict]):
    """The answer for one pair: WITNESSED with a drive, IMPOSSIBLE with certificate and cores, or a reason.

    ``query`` is what the drive satisfies, or the claim that was proved, or what is in doubt.
    """

    a: s.Scenario
    b: s.Scenario
    query: Query | None = None
    cores: tuple[Core, ...] = ()

    @property
    def told(self) -> tuple[str, ...]:
        """The parts of all cores as texts, each once."""
        return tuple(dict.fromkeys(part for core in self.cores for part in core.told))


Pair = tuple[s.Scenario, s.Scenario]


@dataclass(frozen=True)
class Group:
    """Pairs that differ in road sectors only, with the one that is solved for all."""

    seed: Pair
    pairs: tuple[Pair, ...]


def pairs_of(basis: Basis, numbers: Sequence[int] | None = None) -> tuple[Pair, ...]:
    """The pairs of different scenarios of one set, or all pairs across two; ``numbers``: only these."""
    scenarios = [
        [
            s.Scenario(number, name)
            for number in s.numbers_of(basis.specification.in_set(name))
            if numbers is None or number in numbers
        ]
        for name in basis.set_names
    ]
    if len(scenarios) == 1:
        return tuple(combinations(scenarios[0], 2))
    return tuple((a, b) for a in scenarios[0] for b in scenarios[1])


@dataclass(frozen=True)
class Overlap:
    """The question which of ``pairs`` hold together, as a ``study.frame.Study``."""

    record_type: ClassVar[type[kept_answers.Record]] = kept_answers.Record
    basis: Basis
    pairs: tuple[Pair, ...]
    meeting: Meeting = field(default_factory=Meeting)

    @property
    def question(self) -> Question:
        meeting = {"lanes": self.meeting.lanes, "roles": self.meeting.roles, "start": self.meeting.start}
        said = {"set": ",".join(self.basis.set_names), **meeting, **self.basis.said()}
        return Question(SCHEMA, said, self.basis.limits, self.basis.library)

    def pieces(self, known: Mapping[str, PairVerdict]) -> Sequence[Group]:
        """Groups of the pairs that are left. Within one set a pair may be turned around."""
        groups: dict[Pair, list[Pair]] = {}
        for a, b in self.pairs:
            if name_of(a, b) in known:
                continue
            seed = self._seed(a, b)
            turned = a.set_name == b.set_name and seed[1].number < seed[0].number
            groups.setdefault(seed[::-1] if turned else seed, []).append((b, a) if turned else (a, b))
        return [Group(seed, tuple(pairs)) for seed, pairs in groups.items()]

    def _seed(self, a: s.Scenario, b: s.Scenario) -> Pair:
        """The first pair that differs from this one in road sectors only."""
        first, second = self._likes[a.set_name][a.number], self._likes[b.set_name][b.number]
        return s.Scenario(first, a.set_name), s.Scenario(second, b.set_name)

    @cached_property
    def _likes(self) -> dict[str, dict[int, int]]:
        return {name: likes_of(self.basis.specification.in_set(name)) for name in self.basis.set_names}

    def settle(self, piece: Group) -> dict[str, PairVerdict]:
        """The seed is solved, and the others are answered with its help."""
        deciding = _DecisionJobs(self.basis, self.meeting)
        begun = now()
        first = deciding.answer(piece.seed)
        found: dict[str, PairVerdict] = {}
        for pair in piece.pairs:
            verdict = first if pair == piece.seed else deciding.answer(pair, piece.seed, first)
            a, b = self._ordered(pair)
            found[name_of(a, b)] = replace(verdict, a=a, b=b, seconds=since(begun))
            begun = now()
        return found

    def doubt(self, piece: Group, reason: Reason) -> dict[str, PairVerdict]:
        ordered = [self._ordered(pair) for pair in piece.pairs]
        return {name_of(a, b): PairVerdict(a, b, verdict=Verdict.UNKNOWN, reason=reason) for a, b in ordered}

    def _ordered(self, pair: Pair) -> Pair:
        a, b = sorted(pair, key=lambda x: (self.basis.set_names.index(x.set_name), x.number))
        return a, b

    def is_sure(self, answer: PairVerdict) -> bool:
        return answer.verdict in (Verdict.WITNESSED, Verdict.IMPOSSIBLE)

    def wanted(self, known: Mapping[str, PairVerdict]) -> Collection[str]:
        return self._named

    @cached_property
    def _named(self) -> dict[str, Pair]:
        return {name_of(a, b): (a, b) for a, b in self.pairs}

    def key(self, name: str) -> str:
        """Besides the pair, that which is solved for all that differ in road sectors only counts."""
        pair = self._named[name]
        home, meeting = self.basis.specification, self.meeting
        return self.basis.key(
            [x for both in (pair, self._seed(*pair)) for x in conjunctions(home, *both, meeting)],
            pair,
            meeting,
        )

    def prepare(self) -> None:
        from roadproof.engines.solve.milp import prepare

        prepare()

    def record(self, name: str, answer: PairVerdict, shelf: EvidenceStore) -> kept_answers.Record:
        kept = kept_answers.Pair(
            a=answer.a.number,
            b=answer.b.number,
            set_a=answer.a.set_name,
            set_b=answer.b.set_name,
            verdict=answer.verdict,
            formula="" if answer.query is None else answer.query.text,
            core=answer.told,
            cores=tuple(kept_answers.Clash(formula=x.whole.text, parts=x.told) for x in answer.cores),
            certificate=shelf.certificate(f"impossible-{name}.json", answer.certificate),
            drive=shelf.drive(f"drive-{name}.json", answer.drive),
            reason=answer.reason,
            seconds=answer.seconds,
        )
        return kept_answers.Record(verdict=kept)

    def recall(self, record: kept_answers.Record, shelf: EvidenceStore) -> tuple[str, PairVerdict]:
        kept = record.verdict
        a, b = kept.scenarios
        home = self.basis.specification
        cores = tuple(Core(StatedQuery(home, x.formula), self._parts(x.parts)) for x in kept.cores)
        return name_of(a, b), PairVerdict(
            a,
            b,
            StatedQuery(home, kept.formula) if kept.formula else None,
            cores,
            verdict=kept.verdict,
            reason=kept.reason,
            certificate=shelf.read_certificate(kept.certificate),
            drive=shelf.read_drive(kept.drive),
            seconds=kept.seconds,
        )

    def _parts(self, texts: Sequence[str]) -> tuple[Formula, ...]:
        home = self.basis.specification
        for text in texts:
            if text not in self._read:
                self._read[text] = read_claim(home, text).formula
        return tuple(self._read[text] for text in texts)

    @cached_property
    def _read(self) -> dict[str, Formula]:
        """The parts of cores, each read once."""
        return {}

    def verdicts(self, answers: Mapping[str, PairVerdict]) -> list[PairVerdict]:
        """The answers in the order of ``pairs``."""
        return [answers[name_of(a, b)] for a, b in self.pairs]

    def index(self, records: Mapping[str, kept_answers.Record], seconds: float) -> kept_answers.Index:
        """The index, made of the answers as they are recorded."""
        verdicts = tuple(records[name_of(a, b)].verdict for a, b in self.pairs)
        return kept_answers.Index(**self.question.heading, seconds=round(seconds, 2), verdicts=verdicts)


def name_of(a: s.Scenario, b: s.Scenario) -> str:
    """Under which name the answer for a pair is kept."""
    return f"{a.set_name}-{a.number:02}-{b.set_name}-{b.number:02}"


@dataclass(frozen=True)
class _DecisionJobs:
    basis: Basis
    meeting: Meeting

    def queries(self, pair: Pair) -> tuple[Query, ...]:
        return conjunctions(self.basis.specification, *pair, self.meeting)

    def answer(self, pair: Pair, seed: Pair | None = None, first: PairVerdict | None = None) -> PairVerdict:
        """The answer for a pair, with the help of that for its group's seed; a doubt where it is late."""
        try:
            followed = None if seed is None or first is None else self.follow(pair, seed, first)
            return followed or self.decide(pair)
        except BudgetExceeded as late:
            return _doubt(pair, self.queries(pair), late.reason)

    def decide(self, pair: Pair) -> PairVerdict:
        """Proofs first, which are quick where they exist; then drives for what is left."""
        queries = self.queries(pair)
        proofs = [self.basis.proof_of(negation(x)) for x in queries]
        left = [x for x, proof in zip(queries, proofs, strict=True) if not proof.holds]
        if not left:
            cores = tuple(self._core(x, proof) for x, proof in zip(queries, proofs, strict=True))
            known = proofs[0] if len(proofs) == 1 else None
            shown = self._impossible(pair, queries, cores, known)
            return shown or _doubt(pair, queries, Why.PROOF_LOST())
        for query in left:
            outcome = ask(self.basis.search(query))
            if outcome.drives:
                return PairVerdict(*pair, query, verdict=Verdict.WITNESSED, drive=outcome.drives[0])
        return self._explain(pair, queries, left)

    def follow(self, pair: Pair, seed: Pair, first: PairVerdict) -> PairVerdict | None:
        """An answer with the help of that for the seed of the group, or None."""
        queries = self.queries(pair)
        if first.verdict is Verdict.IMPOSSIBLE:
            cores = [self._core_like(x, core) for x, core in zip(queries, first.cores, strict=True)]
            return self._impossible(pair, queries, tuple(cores))
        if first.drive is None or first.query is None:
            return None
        chosen = queries[self.queries(seed).index(first.query)]
        shown = placed(first.drive.file, chosen, self.basis.library)
        return None if shown is None else PairVerdict(*pair, chosen, verdict=Verdict.WITNESSED, drive=shown)

    def _impossible(
        self, pair: Pair, queries: Sequence[Query], cores: tuple[Core, ...], known: Result | None = None
    ) -> PairVerdict | None:
        """``known``: a proof of all that is claimed, where there is one."""
        claim = both(*(negation(x) for x in queries))
        result = known or self.basis.proof_of(claim, 10 * self.basis.proof)
        if not result.holds or result.certificate is None:
            return None
        certificate = replace(result.certificate, property=f"overlap-{pair[0]}-{pair[1]}")
        return PairVerdict(*pair, claim, cores, verdict=Verdict.IMPOSSIBLE, certificate=certificate)

    def _explain(self, pair: Pair, queries: Sequence[Query], left: Sequence[Query]) -> PairVerdict:
        """No drive was found: say within which limits there is none, or prove it after all."""
        verdicts: list[Verdict] = []
        reasons: list[Reason] = []
        for query in left:
            outcome = ask(self.basis.search(query, explain=True))
            if outcome.drives:
                return PairVerdict(*pair, query, verdict=Verdict.WITNESSED, drive=outcome.drives[0])
            verdicts.append(outcome.verdict)
            reasons.append(outcome.told(("--horizon",)) or Why.IMPOSSIBLE(query.text))
        if all(verdict is Verdict.IMPOSSIBLE for verdict in verdicts):
            found = self._impossible(pair, queries, tuple(self._core(x) for x in queries))
            if found is not None:
                return found
        sure = all(verdict in (Verdict.IMPOSSIBLE, Verdict.NONE_WITHIN) for verdict in verdicts)
        verdict: DriveVerdict = Verdict.NONE_WITHIN if sure else Verdict.UNKNOWN
        return PairVerdict(*pair, either(*left), verdict=verdict, reason=joined(dict.fromkeys(reasons)))

    def _core(self, query: Query, proof: Result | None = None) -> Core:
        """``proof``: that ``query`` never holds, where it is known."""
        effort = self.basis.effort.of(10 * self.basis.proof)
        proof = proof or self.basis.proof_of(negation(query), 10 * self.basis.proof)
        shown = explain(self.basis.specification, query, proof, effort)
        return Core(query, () if shown is None else shown.core)

    def _core_like(self, query: Query, core: Core) -> Core:
        """``core`` for ``query``, where all its parts are parts of that too; its own core otherwise."""
        wanted = {without_names(part) for part in core.parts}
        mine = {without_names(part) for part in parts(query.formula)}
        return Core(query, core.parts) if wanted and wanted <= mine else self._core(query)


def _doubt(pair: Pair, queries: Sequence[Query], reason: Reason) -> PairVerdict:
    return PairVerdict(*pair, either(*queries), verdict=Verdict.UNKNOWN, reason=reason)
