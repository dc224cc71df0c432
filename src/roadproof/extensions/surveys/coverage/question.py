"""The question which disturbances a set misses, as plain data, with its claims and its view.

Claims of coverage come first. Where they are proved, only the definitions are left that the set may not need;
else the simple drives are looked through, and gaps among them are what the classes begin with.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Annotated, ClassVar

from roadproof.errors import InputError
from roadproof.evidence.answer import Answer, Judged
from roadproof.evidence.answers.drive import KeptRoad
from roadproof.evidence.claim import HELP, Claim, On
from roadproof.evidence.codec import Doc, read
from roadproof.evidence.drive_file import road_of, road_said
from roadproof.evidence.finding import Finding
from roadproof.extensions.surveys.coverage.answers import Answers as ClassAnswers
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, Need, Survey, is_covered
from roadproof.extensions.surveys.coverage.asking import PROOF, GapRoads, GroupAsking, ask_need, work_of
from roadproof.extensions.surveys.coverage.claims import GapClaims
from roadproof.extensions.surveys.coverage.classes import sets_between
from roadproof.extensions.surveys.coverage.data import CoverageData, coverage_data
from roadproof.extensions.surveys.coverage.found import FoundGap, replaced_by
from roadproof.extensions.surveys.coverage.looks import SimpleGaps, SimpleJudge
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis, ProofResult
from roadproof.questions.question import Answers, Batch, Place, Steps, seen
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import ProofVerdict, Verdict
from roadproof.world.road import Road

CHUNKS = 7
"""The simple drives of a road are looked through in so many pieces."""


@dataclass(frozen=True, kw_only=True)
class Gaps:
    """Which gaps of a set are asked about."""

    wider: Annotated[tuple[str, ...], Doc("Wider sets, from the next to the widest.")] = ()
    roads: Annotated[tuple[KeptRoad, ...], Doc("Where drives are looked for, in this order.")]
    elsewhere: Annotated[tuple[KeptRoad, ...], Doc("Where the drives are tried that were found.")] = ()
    needed: Annotated[bool, Doc("Whether it is asked which definitions the set needs.")] = False


@dataclass(frozen=True)
class CoverageView:
    """All that is known of a set; ``proofs``: the names of the claims that there is no gap."""

    survey: Survey
    proofs: tuple[str, ...]
    known: Answers


@dataclass(frozen=True)
class CoverageQuestion:
    """The question which disturbances between two vehicles a set misses.

    ``only``: the groups of classes that are asked about, and ``numbers``: the scenarios that count; all where
    None.
    """

    kind: ClassVar[str] = "coverage"
    basis: Basis
    asked: Gaps
    only: frozenset[str] | None = None
    numbers: tuple[int, ...] | None = None
    claims: GapClaims = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "claims", GapClaims(self.basis, self.asked.wider, self.numbers))

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim of coverage."""
        return Work(self.basis.effort, PROOF, alone=True)

    @classmethod
    def of(cls, basis: Basis, asked: object, where: str) -> "CoverageQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        made = cls(basis, read(Gaps, asked, where))
        wider = made.asked.wider
        if wider and sets_between(basis.library, basis.specification.set_name, wider[-1]) != wider:
            raise InputError(f"{where}: wider={', '.join(wider)[:80]} do not extend one another")
        _ = made.where
        return made

    @cached_property
    def where(self) -> GapRoads:
        """Where gaps are looked for. Raises ``InputError``."""
        asked = self.asked
        roads, elsewhere = (tuple(road_of(x, "road") for x in y) for y in (asked.roads, asked.elsewhere))
        return GapRoads(roads, elsewhere)

    @property
    def groups(self) -> list[str]:
        """The groups of classes that are asked about."""
        return [x for x in self.claims.groups if self.only is None or x in self.only]

    @property
    def definitions(self) -> tuple[str, ...]:
        """The definitions of which it is asked whether the set needs them."""
        return replaced_by(self.basis.specification) if self.asked.needed else ()

    # --- batches ---------------------------------------------------------------------------------

    def batches(self, known: Answers) -> Sequence[Batch]:
        """Claims of coverage; then what is needed, or the simple drives, and then the classes of gaps."""
        covered = self.claims.covered
        found: list[Batch] = [NamedBatch(self.claims, name, claim) for name, claim in covered.items()]
        if not all(name in known for name in covered):
            return found
        if self.is_covered(known):
            return [*found, *(NeedBatch(self.claims, x) for x in self.definitions)]
        if not self.groups:
            return found
        found += [NamedBatch(self.claims, name, claim) for name, claim in self.simple.items()]
        if all(name in known for name in self.simple):
            found += [GroupBatch(self._asking(name, known)) for name in self.groups]
        return found

    @cached_property
    def simple(self) -> dict[str, Claim]:
        """The claims which simple drives are gaps, by name."""
        judges = {f"{HELP}simple-{r}-{k}": x for r, k, x in self._judges()}
        about = {name: ("simple", x.road, x.start, x.step) for name, x in judges.items()}
        return {name: self.claims.judged(x, about[name]) for name, x in judges.items()}

    def _judges(self) -> Iterator[tuple[int, int, SimpleJudge]]:
        for r, road in enumerate(self.where.roads, 1):
            for k in range(CHUNKS):
                yield r, k + 1, SimpleJudge(self.claims, road, k, CHUNKS)

    def _asking(self, group: str, known: Answers) -> GroupAsking:
        """The claims about a group, with the gaps among simple drives that are in a class of it."""
        found, lost = list[FoundGap](), list[Reason]()
        for r, k, judge in self._judges():
            answer = known.get(f"{HELP}simple-{r}-{k}")
            if answer is None:
                continue
            if isinstance(answer.evidence, Judged) and isinstance(answer.evidence.shows, SimpleGaps):
                found += judge.found(answer.evidence.shows)
            else:
                lost.append(Why.NOT_LOOKED_THROUGH(answer.reason))
        classes = self.claims.groups[group]
        keys = {part.key for part in classes.parts if part is not None}
        mine = tuple(x for x in found if not keys or keys & {*x.classes})
        return GroupAsking(self.claims, self.where, classes, mine, tuple(lost))

    def is_covered(self, known: Answers) -> bool:
        """Return whether it is proved that there is no gap."""
        covered = self.claims.covered
        return all(name in known and known[name].verdict is Verdict.PROVED for name in covered)

    def label(self, name: str) -> str:
        """Return which class, claim or definition the claim of a name is about."""
        home = self.basis.specification
        definition = next((x for x in replaced_by(home) if name.endswith(f"-{x}")), "")
        if f"needed-{definition}" in name or f"spare-{definition}" in name:
            return f"{definition} of {home.set_name}"
        stem = next((x for x in self.claims.groups if f"-{x}-" in name), "")
        if not stem:
            return home.set_name
        parts, rest = self.claims.groups[stem].parts, name.partition(f"-{stem}-")[2].partition("-")[0]
        part = parts[int(rest)] if rest.isdecimal() and int(rest) < len(parts) else None
        words = ["no single condition"] if part is None else [part.component, part.condition]
        told = f"class {', '.join(x for x in words if x)}"
        return f"on the way to {told}" if name.startswith(HELP) else told

    def tell(self, name: str, answer: Answer, found: Finding) -> Finding:
        """Return what was found, with what a judge was asked in place of a claim."""
        if not isinstance(answer.claim.mode, On):
            return found
        word = name.removeprefix(HELP).partition("-")[0]
        return replace(found, claim=_JUDGED.get(word, found.claim))

    # --- what answers show together ---------------------------------------------------------------

    def view(self, known: Answers) -> CoverageView:
        """Return all that is known of the set."""
        claims = tuple(_proof(x.query, name, known) for name, x in self.claims.covered.items())
        classes: tuple[ClassAnswer, ...] = ()
        needs: list[Need] = []
        if is_covered(claims):
            needs = [seen(ask_need(self.claims, x), known) for x in self.definitions]
        else:
            classes = tuple(x for name in self.groups for x in self._classes(name, known))
        survey = Survey(claims, classes, tuple(sorted(needs, key=lambda x: x.definition)))
        return CoverageView(survey, tuple(self.claims.covered), known)

    def _classes(self, group: str, known: Answers) -> ClassAnswers:
        answers = seen(self._asking(group, known).run(), known)
        return answers

    def doubts(self, known: Answers) -> list[tuple[str, Reason]]:
        """Return the classes of which neither a drive nor a proof is known, and why."""
        survey = self.view(known).survey
        names = [(_called(x), x) for x in survey.classes]
        return [(name, x.reason) for name, x in names if x.verdict is Verdict.UNKNOWN]

    def data(self, view: CoverageView, place: Place, seconds: float) -> CoverageData:
        """Return the view as ``--json`` prints it."""
        return coverage_data(self.basis, self.asked.wider, view, place, seconds, self.where.roads)


_JUDGED = {
    "simple": "gaps among some of the simple drives",
    "needed": "whether a simple drive is missed without it",
    "looks": "of which classes a drive is, and what catches it",
    "near": "in which scenario a drive is a gap, and what catches it",
}
"""What judges are asked, by how the names of their claims begin."""


def gaps_of(
    wider: Sequence[str], roads: Collection[Road], elsewhere: Collection[Road] = (), needed: bool = False
) -> Gaps:
    """Return the settings that ask about the gaps of a set."""
    return Gaps(
        wider=tuple(wider),
        roads=tuple(map(road_said, roads)),
        elsewhere=tuple(map(road_said, elsewhere)),
        needed=needed,
    )


@dataclass(frozen=True)
class CoverageBatch:
    """Claims of a survey of gaps."""

    claims: GapClaims

    def work_of(self, name: str) -> Work:
        """Return the work that is allowed for the claim of a name."""
        return work_of(name, self.claims)


@dataclass(frozen=True)
class NamedBatch(CoverageBatch):
    """One claim."""

    name: str
    claim: Claim

    def steps(self) -> Steps:
        """Yield the claim."""
        yield self.name, self.claim


@dataclass(frozen=True)
class NeedBatch(CoverageBatch):
    """Whether a set needs a definition."""

    definition: str

    @property
    def name(self) -> str:
        """The definition."""
        return f"needed-{self.definition}"

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        yield from ask_need(self.claims, self.definition)


@dataclass(frozen=True)
class GroupBatch:
    """The claims about a component and its conditions, or about no single condition."""

    asking: GroupAsking

    @property
    def name(self) -> str:
        """The group."""
        return self.asking.name

    def work_of(self, name: str) -> Work:
        """Return the work that is allowed for the claim of a name."""
        return work_of(name, self.asking.claims)

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        yield from self.asking.run()


def _proof(query: Query, name: str, known: Answers) -> ProofResult[Query]:
    answer, verdict = known.get(name), Verdict.UNKNOWN
    if answer is None:
        return ProofResult(query, verdict=Verdict.UNKNOWN, reason=NO_REASON)
    found: ProofVerdict = Verdict.UNKNOWN
    match answer.verdict:
        case Verdict.PROVED | Verdict.VACUOUS | Verdict.REFUTED as verdict:
            found = verdict
    return ProofResult(query, verdict=found, reason=answer.reason, certificate=answer.certificate)


def _called(answer: ClassAnswer) -> str:
    part = answer.part
    words = ["no single condition"] if part is None else [part.component, part.condition]
    return f"class {', '.join(x for x in words if x)}"
