"""The question which scenarios can hold together: for each pair a drive, a proof of none, or UNKNOWN.

Pairs that differ only in their road sectors (eq. disturbFormat: rows 9 to 24 repeat rows 1 to 8) are settled
one after the other: a drive of one is put on roads of the others, and parts that clash are looked for there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import combinations, permutations
from typing import TYPE_CHECKING, Annotated, ClassVar, TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.answers import shared
from roadproof.evidence.codec import Doc, read
from roadproof.library import scenarios as scenario_library
from roadproof.library.compose import both, either, eventually, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.sector_twins import sector_twins
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import Formula, Not
from roadproof.logic.parts import parts_of, texts_of
from roadproof.logic.rewrite import without_names
from roadproof.questions.basis import Basis
from roadproof.questions.question import heading_of
from roadproof.reasons import NO_REASON, Reason, ReasonKind, joined
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict, Verdict

if TYPE_CHECKING:
    from roadproof.evidence.claim import Claim
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.questions.overlap_data import OverlapData
    from roadproof.questions.question import Answers, EvidencePlace, Steps

OTHER_LANE = "L2"
Pair: TypeAlias = tuple[scenario_library.Scenario, scenario_library.Scenario]


@dataclass(frozen=True, kw_only=True)
class Meeting:
    """The settings of an overlap: the scenarios, and how two of them may hold together."""

    among: Annotated[tuple[shared.Number, ...] | None, Doc("The scenarios; null for all.")] = None
    lanes: shared.Choice = "same"
    roles: shared.Choice = "same"
    start: shared.Choice = "same"


def conjunctions(
    specification: Specification,
    one: scenario_library.Scenario,
    other: scenario_library.Scenario,
    meeting: Meeting,
) -> tuple[Query, ...]:
    """Return the formulas of which one has to hold for two scenarios to hold together.

    The vehicles are those of the scenario that has more of them; a scenario of two vehicles meets one of
    three with SV and either of its POVs.
    """
    mine, theirs = (
        scenario_library.vehicles_of(specification, one),
        scenario_library.vehicles_of(specification, other),
    )
    swapped = len(theirs) > len(mine)
    most, fewer = (theirs, mine) if swapped else (mine, theirs)
    lane = OTHER_LANE if meeting.lanes == "any" else scenario_library.LANE
    queries: list[Query] = []
    for roles in _assignments(most, len(fewer), meeting.roles):
        mine_now, theirs_now = (roles, most) if swapped else (most, roles)
        first = scenario_library.apply_scenario(specification, one, mine_now)
        second = scenario_library.apply_scenario(specification, other, theirs_now, lane)
        if meeting.start == "same":
            queries.append(both(first, second))
        else:
            queries += [both(first, eventually(second)), both(second, eventually(first))]
    return tuple(queries)


def _assignments(vehicles: Sequence[str], count: int, roles: str) -> list[tuple[str, ...]]:
    """Return who may play the ``count`` parts of the smaller scenario."""
    if roles == "any":
        return list(permutations(vehicles, count))
    return [(vehicles[0], *others) for others in combinations(vehicles[1:], count - 1)]


def pairs_of(basis: Basis, numbers: Sequence[int] | None = None) -> tuple[Pair, ...]:
    """Return the pairs of different scenarios of one set, or all across two; ``numbers``: only these."""
    scenarios = [
        [
            scenario_library.Scenario(number, name)
            for number in scenario_library.numbers_of(basis.specification.in_set(name))
            if numbers is None or number in numbers
        ]
        for name in basis.set_names
    ]
    if len(scenarios) == 1:
        return tuple(combinations(scenarios[0], 2))
    return tuple((a, b) for a in scenarios[0] for b in scenarios[1])


@dataclass(frozen=True)
class Core:
    """Parts of a conjunction that clash; ``bodies``: these parts with all definitions written out."""

    whole: Query
    parts: tuple[str, ...]
    bodies: frozenset[Formula]


@dataclass(frozen=True)
class PairVerdict:
    """The verdict on a pair; ``answers`` by the names of their claims, None where undecided.

    ``first``: the first pair that differs from this one in road sectors only, if it is another one.
    """

    a: scenario_library.Scenario
    b: scenario_library.Scenario
    claims: Mapping[str, Claim]
    answers: Mapping[str, ClaimAnswer | None]
    first: PairVerdict | None = None

    @property
    def verdict(self) -> DriveVerdict:
        """WITNESSED where one conjunction holds on a drive, IMPOSSIBLE where each is proved to hold never."""
        verdicts = {Verdict.UNKNOWN if x is None else x.verdict for x in self.answers.values()}
        if Verdict.WITNESSED in verdicts:
            return Verdict.WITNESSED
        if verdicts == {Verdict.IMPOSSIBLE}:
            return Verdict.IMPOSSIBLE
        return (
            Verdict.NONE_WITHIN if verdicts <= {Verdict.IMPOSSIBLE, Verdict.NONE_WITHIN} else Verdict.UNKNOWN
        )

    @property
    def query(self) -> Query:
        """The formula that the drive satisfies, that is proved, or that is undecided."""
        match self.verdict:
            case Verdict.WITNESSED:
                return self._shown.claim.query
            case Verdict.IMPOSSIBLE:
                return both(*(negation(claim.query) for claim in self.claims.values()))
            case Verdict.NONE_WITHIN | Verdict.UNKNOWN:
                return either(*(self.claims[name].query for name in self._left))

    @property
    def _shown(self) -> ClaimAnswer:
        return next(x for x in self.answers.values() if x is not None and x.verdict is Verdict.WITNESSED)

    @property
    def _left(self) -> list[str]:
        """The names of claims that are neither shown nor proved to be impossible; all where none is left."""
        left = [n for n, x in self.answers.items() if x is None or x.verdict is not Verdict.IMPOSSIBLE]
        return left or [*self.answers]

    @property
    def drive(self) -> JudgedDrive | None:
        """The drive of a pair that is WITNESSED."""
        return self._shown.drive if self.verdict is Verdict.WITNESSED else None

    @property
    def evidence(self) -> Mapping[str, ClaimAnswer]:
        """The answers that show the verdict, by name."""
        named = {name: x for name, x in self.answers.items() if x is not None and x.is_final}
        showing = {name: x for name, x in named.items() if x.verdict is self.verdict}
        return dict([*showing.items()][:1]) if self.verdict is Verdict.WITNESSED else showing

    @property
    def reason(self) -> Reason:
        """Return why a pair is in doubt."""
        if self.verdict in (Verdict.WITNESSED, Verdict.IMPOSSIBLE):
            return NO_REASON
        reasons = (self._reason(name) for name in self._left)
        return joined(dict.fromkeys(x for x in reasons if x))

    def _reason(self, name: str) -> Reason:
        answer = self.answers[name]
        return (
            NO_REASON if answer is None else answer.reason or ReasonKind.IMPOSSIBLE(answer.claim.query.text)
        )

    @cached_property
    def cores(self) -> tuple[Core, ...]:
        """The clashing parts of each conjunction, in the words of the first pair if they mean the same."""
        if self.verdict is not Verdict.IMPOSSIBLE:
            return ()
        words = {} if self.first is None else {core.bodies: core.parts for core in self.first.cores}
        cores = map(_core, self.evidence.values())
        return tuple(replace(core, parts=words.get(core.bodies, core.parts)) for core in cores)

    @property
    def core_texts(self) -> tuple[str, ...]:
        """The parts of all cores, each once."""
        return tuple(dict.fromkeys(part for core in self.cores for part in core.parts))


def _core(answer: ClaimAnswer) -> Core:
    """Return the parts that the certificate of an answer shows to clash."""
    proof = answer.certificate
    assert proof is not None
    denied = read_claim(answer.claim.home, proof.claim).formula
    assert isinstance(denied, Not)
    parts = [*dict.fromkeys(parts_of(denied.body))]
    return Core(answer.claim.query, texts_of(parts), frozenset(map(without_names, parts)))


@dataclass(frozen=True)
class OverlapView:
    """The verdicts on all pairs, in their order."""

    meeting: Meeting
    pairs: tuple[PairVerdict, ...]


@dataclass(frozen=True)
class OverlapQuestion:
    """The question which pairs of scenarios can hold together."""

    kind: ClassVar[str] = "overlap"
    basis: Basis
    settings: Meeting = field(default_factory=Meeting)

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof, explain=True)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> OverlapQuestion:
        """Return the question that plain data ask. Raises ``InputError``."""
        if len(basis.set_names) > 2:
            raise InputError(f"{where}: pairs are of one spec set, or of two")
        return cls(basis, read(Meeting, settings, where))

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """The pairs that are asked about."""
        return pairs_of(self.basis, self.settings.among)

    def batches(self, known: Answers) -> list[PairBatch]:
        """A batch for pairs that differ in road sectors only."""
        groups: dict[Pair, list[Pair]] = {}
        for pair in self.pairs:
            groups.setdefault(self._seed(*pair), []).append(pair)
        return [
            PairBatch(name_of(*seed), tuple(self.claims[pair] for pair in pairs))
            for seed, pairs in groups.items()
        ]

    @cached_property
    def claims(self) -> dict[Pair, dict[str, Claim]]:
        """The claims of each pair, by name."""
        return {pair: self._claims_of(pair) for pair in self.pairs}

    def _claims_of(self, pair: Pair) -> dict[str, Claim]:
        queries = conjunctions(self.basis.specification, *pair, self.settings)
        stem = name_of(*pair)
        names = [stem] if len(queries) == 1 else [f"{stem}-{k}" for k in range(1, len(queries) + 1)]
        return {name: self.basis.claim(query) for name, query in zip(names, queries, strict=True)}

    def _seed(self, a: scenario_library.Scenario, b: scenario_library.Scenario) -> Pair:
        """Return the first pair that differs from this one in road sectors only."""
        seed = tuple(scenario_library.Scenario(self._twins[x.set_name][x.number], x.set_name) for x in (a, b))
        first, second = seed if a.set_name != b.set_name else sorted(seed, key=lambda x: x.number)
        return first, second

    @cached_property
    def _twins(self) -> dict[str, dict[int, int]]:
        return {name: sector_twins(self.basis.specification.in_set(name)) for name in self.basis.set_names}

    def data(self, view: OverlapView, place: EvidencePlace, seconds: float) -> OverlapData:
        """Return the view as ``--json`` prints it."""
        from roadproof.questions.overlap_data import SCHEMA, OverlapData, pair_data  # here: for --json alone

        return OverlapData(
            **heading_of(SCHEMA, self.basis),
            set=",".join(self.basis.set_names),
            **self.basis.common_data(),
            lanes=self.settings.lanes,
            roles=self.settings.roles,
            start=self.settings.start,
            seconds=seconds,
            verdicts=tuple(pair_data(x, place) for x in view.pairs),
        )

    def label(self, name: str) -> str:
        """Return which two scenarios the claim of a name is about."""
        a, b = next(pair for pair, claims in self.claims.items() if name in claims)
        return f"scenarios {a} and {b}"

    def view(self, known: Answers) -> OverlapView:
        """Return the verdict on each pair."""
        first: dict[Pair, PairVerdict] = {}
        pairs: list[PairVerdict] = []
        for pair, claims in self.claims.items():
            seed = self._seed(*pair)
            answers = {name: known.get(name) for name in claims}
            pairs.append(PairVerdict(*pair, claims, answers, first.get(seed)))
            first.setdefault(seed, pairs[-1])
        return OverlapView(self.settings, tuple(pairs))


@dataclass(frozen=True)
class PairBatch:
    """The claims of pairs that are alike, by name; of each pair they are asked until one holds."""

    name: str
    pairs: tuple[Mapping[str, Claim], ...]

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        for claims in self.pairs:
            for name, claim in claims.items():
                answer = yield name, claim
                if answer.verdict is Verdict.WITNESSED:
                    break


def name_of(a: scenario_library.Scenario, b: scenario_library.Scenario) -> str:
    """Return under which name the answer for a pair is kept."""
    return f"{a.set_name}-{a.number:02}-{b.set_name}-{b.number:02}"
