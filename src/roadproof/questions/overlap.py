"""Which scenarios can hold together: for every pair a drive, a proof that there is none, or a doubt.

Pairs that differ only in their road sectors (eq. disturbFormat: rows 9 to 24 repeat rows 1 to 8) are settled
one after the other: a drive of one is put on roads of the others, and parts that clash are looked for there.
"""

from collections.abc import Mapping, Sequence
from dataclasses import field
from functools import cached_property
from itertools import combinations, permutations
from typing import Annotated, Any, ClassVar, Final, Literal, TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.answer import Answer
from roadproof.evidence.answers import shared
from roadproof.evidence.claim import Claim
from roadproof.evidence.codec import Doc, Rule, read
from roadproof.evidence.json_schema import Shared
from roadproof.evidence.judged import JudgedDrive
from roadproof.library import scenarios as s
from roadproof.library.alike import likes_of
from roadproof.library.compose import both, either, eventually, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import Not
from roadproof.logic.parts import parts_of, texts_of
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Place, Steps, heading_of
from roadproof.reasons import NO_REASON, Reason, Why, joined
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict, Verdict

SCHEMA: Final = "roadproof/overlap/2"
OTHER_LANE = "L2"
Choice: TypeAlias = Annotated[
    Literal["same", "any"], Doc("Whether both have the same, or each its own."), Shared("choice")
]
Pair: TypeAlias = tuple[s.Scenario, s.Scenario]


@dataclass(frozen=True, kw_only=True)
class Meeting:
    """How two scenarios may meet, and which ones."""

    among: Annotated[tuple[shared.Number, ...] | None, Doc("The scenarios; null for all.")] = None
    lanes: Choice = "same"
    roles: Choice = "same"
    start: Choice = "same"


def conjunctions(
    specification: Specification, one: s.Scenario, other: s.Scenario, meeting: Meeting
) -> tuple[Query, ...]:
    """Return the formulas of which one has to hold for two scenarios to hold together.

    The vehicles are those of the scenario that has more of them; a scenario of two vehicles meets one of
    three with SV and either of its POVs.
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


def _assignments(vehicles: Sequence[str], count: int, roles: str) -> list[tuple[str, ...]]:
    """Return who may play the ``count`` parts of the smaller scenario."""
    if roles == "any":
        return list(permutations(vehicles, count))
    return [(vehicles[0], *others) for others in combinations(vehicles[1:], count - 1)]


def pairs_of(basis: Basis, numbers: Sequence[int] | None = None) -> tuple[Pair, ...]:
    """Return the pairs of different scenarios of one set, or all across two; ``numbers``: only these."""
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
class Core:
    """Parts of a conjunction that clash."""

    whole: Query
    parts: tuple[str, ...]


@dataclass(frozen=True)
class PairVerdict:
    """What is known of a pair; ``answers`` by the names of their claims, None for what is not settled."""

    a: s.Scenario
    b: s.Scenario
    claims: Mapping[str, Claim]
    answers: Mapping[str, Answer | None]

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
        """What the drive satisfies, or what is proved, or what is in doubt."""
        match self.verdict:
            case Verdict.WITNESSED:
                return self._shown.claim.query
            case Verdict.IMPOSSIBLE:
                return both(*(negation(claim.query) for claim in self.claims.values()))
            case _:
                return either(*(self.claims[name].query for name in self._left))

    @property
    def _shown(self) -> Answer:
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
    def evidence(self) -> Mapping[str, Answer]:
        """The answers that show the verdict, by name."""
        named = {name: x for name, x in self.answers.items() if x is not None and x.is_final}
        wanted = {name: x for name, x in named.items() if x.verdict is self.verdict}
        return dict([*wanted.items()][:1]) if self.verdict is Verdict.WITNESSED else wanted

    @property
    def reason(self) -> Reason:
        """Why a pair is in doubt."""
        if self.verdict in (Verdict.WITNESSED, Verdict.IMPOSSIBLE):
            return NO_REASON
        reasons = (self._reason(name) for name in self._left)
        return joined(dict.fromkeys(x for x in reasons if x))

    def _reason(self, name: str) -> Reason:
        answer = self.answers[name]
        return NO_REASON if answer is None else answer.reason or Why.IMPOSSIBLE(answer.claim.query.text)

    @cached_property
    def cores(self) -> tuple[Core, ...]:
        """The parts that clash, of each conjunction, as the certificates say them."""
        if self.verdict is not Verdict.IMPOSSIBLE:
            return ()
        return tuple(Core(x.claim.query, _core(x)) for x in self.evidence.values())

    @property
    def told(self) -> tuple[str, ...]:
        """The parts of all cores, each once."""
        return tuple(dict.fromkeys(part for core in self.cores for part in core.parts))


def _core(answer: Answer) -> tuple[str, ...]:
    proof = answer.certificate
    assert proof is not None
    denied = read_claim(answer.claim.home, proof.claim).formula
    assert isinstance(denied, Not)
    return texts_of([*dict.fromkeys(parts_of(denied.body))])


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
    asked: Meeting = field(default_factory=Meeting)

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof, explain=True)

    @classmethod
    def of(cls, basis: Basis, asked: object, where: str) -> "OverlapQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        if len(basis.set_names) > 2:
            raise InputError(f"{where}: pairs are of one spec set, or of two")
        return cls(basis, read(Meeting, asked, where))

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """The pairs that are asked about."""
        return pairs_of(self.basis, self.asked.among)

    def batches(self, known: Answers) -> list["PairBatch"]:
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
        queries = conjunctions(self.basis.specification, *pair, self.asked)
        stem = name_of(*pair)
        names = [stem] if len(queries) == 1 else [f"{stem}-{k}" for k in range(1, len(queries) + 1)]
        return {name: self.basis.claim(query) for name, query in zip(names, queries, strict=True)}

    def _seed(self, a: s.Scenario, b: s.Scenario) -> Pair:
        """Return the first pair that differs from this one in road sectors only."""
        seed = tuple(s.Scenario(self._likes[x.set_name][x.number], x.set_name) for x in (a, b))
        first, second = seed if a.set_name != b.set_name else sorted(seed, key=lambda x: x.number)
        return first, second

    @cached_property
    def _likes(self) -> dict[str, dict[int, int]]:
        return {name: likes_of(self.basis.specification.in_set(name)) for name in self.basis.set_names}

    def data(self, view: OverlapView, place: Place, seconds: float) -> "OverlapData":
        """Return the view as ``--json`` prints it."""
        said: dict[str, Any] = {"set": ",".join(self.basis.set_names), **self.basis.said()}
        return OverlapData(
            **heading_of(SCHEMA, self.basis),
            **said,
            lanes=self.asked.lanes,
            roles=self.asked.roles,
            start=self.asked.start,
            seconds=seconds,
            verdicts=tuple(_pair_data(x, place) for x in view.pairs),
        )

    def label(self, name: str) -> str:
        """Return which two scenarios the claim of a name is about."""
        a, b = next(pair for pair, claims in self.claims.items() if name in claims)
        return f"scenarios {a} and {b}"

    def view(self, known: Answers) -> OverlapView:
        """Return the verdict on each pair."""
        pairs = (
            PairVerdict(*pair, claims, {name: known.get(name) for name in claims})
            for pair, claims in self.claims.items()
        )
        return OverlapView(self.asked, tuple(pairs))


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


def name_of(a: s.Scenario, b: s.Scenario) -> str:
    """Return under which name the answer for a pair is kept."""
    return f"{a.set_name}-{a.number:02}-{b.set_name}-{b.number:02}"


def _pair_data(pair: PairVerdict, place: Place) -> "PairData":
    return PairData(
        a=pair.a.number,
        b=pair.b.number,
        set_a=pair.a.set_name,
        set_b=pair.b.set_name,
        verdict=pair.verdict,
        formula=pair.query.text,
        core=pair.told,
        cores=tuple(Clash(formula=x.whole.text, parts=x.parts) for x in pair.cores),
        evidence=tuple(place(name, x) for name, x in pair.evidence.items()),
        reason=pair.reason,
    )


@dataclass(frozen=True, kw_only=True)
class Clash:
    """Parts of a conjunction that contradict each other."""

    formula: shared.Formula
    parts: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class PairData:
    """Whether two scenarios can hold together."""

    a: shared.Number
    b: shared.Number
    set_a: shared.SetName
    set_b: shared.SetName
    verdict: DriveVerdict
    formula: Annotated[
        str,
        Doc(
            "Of a WITNESSED what holds on the drive; of an IMPOSSIBLE what is proved; else what is in doubt."
        ),
    ]
    core: Annotated[tuple[str, ...], Doc("Parts that clash, of all cores.")]
    cores: Annotated[tuple[Clash, ...], Doc("For each way in which the two can meet, parts that clash.")]
    evidence: Annotated[
        tuple[shared.KeptEvidence, ...],
        Doc("A drive; or for each way in which the two can meet, a certificate that its core clashes."),
    ]
    reason: shared.Reason = NO_REASON


@dataclass(frozen=True, kw_only=True)
class OverlapData(shared.Heading):
    """Which pairs of scenarios can hold together."""

    schema: Literal["roadproof/overlap/2"] = SCHEMA
    set: Annotated[str, Rule(least=1), Doc("The spec set, or two with a comma between.")]
    lanes: Annotated[Choice, Doc("Whether both speak of one lane, or each of its own.")]
    roles: Annotated[Choice, Doc("Whether vehicles play the same parts in both.")]
    start: Annotated[Choice, Doc("Whether both start at 0, or one then or later.")]
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    verdicts: tuple[PairData, ...]
