"""The question which disturbances a set misses: its settings, claims and view.

Claims of coverage come first. If they are proved, it remains to ask which definitions the set needs.
Otherwise simple drives are judged, and the search of each class begins with the gaps among them.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Annotated, ClassVar

from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer, JudgedTrace
from roadproof.evidence.answers.drive import RoadField
from roadproof.evidence.claim import HELP, Claim, On
from roadproof.evidence.codec import Doc, read
from roadproof.evidence.drive_file import road_data, road_of
from roadproof.evidence.finding import Finding
from roadproof.evidence.verdict_with_evidence import ProofResult
from roadproof.extensions.surveys.coverage.answers import Answers as ClassAnswers
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, GapSurvey, Need, is_covered
from roadproof.extensions.surveys.coverage.claims import GapClaims
from roadproof.extensions.surveys.coverage.classes import sets_between
from roadproof.extensions.surveys.coverage.data import CoverageData, coverage_data
from roadproof.extensions.surveys.coverage.gap_drives import GapDrive, own_definitions
from roadproof.extensions.surveys.coverage.gap_search import PROOF, GapRoads, GapSearch, ask_need, work_of
from roadproof.extensions.surveys.coverage.judges import SimpleGaps, SimpleJudge
from roadproof.extensions.surveys.survey import replay_steps
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, EvidencePlace, QuestionBatch, Steps
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import ProofVerdict, Verdict
from roadproof.world.road import Road

CHUNKS = 7
"""The simple drives of a road are looked through in so many pieces."""


@dataclass(frozen=True, kw_only=True)
class GapSettings:
    """The settings of the question for gaps."""

    wider: Annotated[tuple[str, ...], Doc("Wider sets, from the next to the widest.")] = ()
    roads: Annotated[tuple[RoadField, ...], Doc("Where drives are looked for, in this order.")]
    elsewhere: Annotated[tuple[RoadField, ...], Doc("Where the drives are tried that were found.")] = ()
    needed: Annotated[bool, Doc("Whether it is asked which definitions the set needs.")] = False


@dataclass(frozen=True)
class CoverageView:
    """The answers about a set; ``proofs``: the names of the claims of coverage."""

    survey: GapSurvey
    proofs: tuple[str, ...]
    known: Answers


@dataclass(frozen=True)
class CoverageQuestion:
    """The question which disturbances between two vehicles a set misses.

    ``only``: the groups of classes in question; ``numbers``: the scenarios that count. None means all.
    """

    kind: ClassVar[str] = "coverage"
    basis: Basis
    settings: GapSettings
    only: frozenset[str] | None = None
    numbers: tuple[int, ...] | None = None
    claims: GapClaims = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "claims", GapClaims(self.basis, self.settings.wider, self.numbers))

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim of coverage."""
        return Work(self.basis.effort, PROOF, alone=True)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "CoverageQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        made = cls(basis, read(GapSettings, settings, where))
        wider = made.settings.wider
        if wider and sets_between(basis.library, basis.specification.set_name, wider[-1]) != wider:
            raise InputError(f"{where}: wider={', '.join(wider)[:80]} do not extend one another")
        _ = made.where
        return made

    @cached_property
    def where(self) -> GapRoads:
        """The roads on which gaps are searched. Raises ``InputError``."""
        settings = self.settings
        roads, elsewhere = (
            tuple(road_of(x, "road") for x in y) for y in (settings.roads, settings.elsewhere)
        )
        return GapRoads(roads, elsewhere)

    @property
    def groups(self) -> list[str]:
        """The groups of classes in question."""
        return [x for x in self.claims.groups if self.only is None or x in self.only]

    @property
    def definitions(self) -> tuple[str, ...]:
        """The definitions that the set may need; empty unless the settings ask for them."""
        return own_definitions(self.basis.specification) if self.settings.needed else ()

    # --- batches ---------------------------------------------------------------------------------

    def batches(self, known: Answers) -> Sequence[QuestionBatch]:
        """Return claims of coverage; then definitions, or simple drives followed by classes of gaps."""
        coverage_claims = self.claims.coverage_claims
        batches: list[QuestionBatch] = [
            NamedBatch(self.claims, name, claim) for name, claim in coverage_claims.items()
        ]
        if not all(name in known for name in coverage_claims):
            return batches
        if self.is_covered(known):
            return [*batches, *(NeedBatch(self.claims, x) for x in self.definitions)]
        if not self.groups:
            return batches
        batches += [NamedBatch(self.claims, name, claim) for name, claim in self.simple.items()]
        if all(name in known for name in self.simple):
            batches += [GroupBatch(self._search(name, known)) for name in self.groups]
        return batches

    @cached_property
    def simple(self) -> dict[str, Claim]:
        """The claims which simple drives are gaps, by name."""
        judges = {f"{HELP}simple-{r}-{k}": x for r, k, x in self._judges()}
        about = {name: ("simple", x.road, x.start, x.step) for name, x in judges.items()}
        return {name: self.claims.judgement_claim(x, about[name]) for name, x in judges.items()}

    def _judges(self) -> Iterator[tuple[int, int, SimpleJudge]]:
        for r, road in enumerate(self.where.roads, 1):
            for k in range(CHUNKS):
                yield r, k + 1, SimpleJudge(self.claims, road, k, CHUNKS)

    def _search(self, group: str, known: Answers) -> GapSearch:
        """Return the search for a group, with the gaps among simple drives that are in its classes."""
        drives, lost = list[GapDrive](), list[Reason]()
        for r, k, judge in self._judges():
            answer = known.get(f"{HELP}simple-{r}-{k}")
            if answer is None:
                continue
            if isinstance(answer.evidence, JudgedTrace) and isinstance(answer.evidence.shows, SimpleGaps):
                drives += judge.drives_of(answer.evidence.shows)
            else:
                lost.append(ReasonKind.NOT_LOOKED_THROUGH(answer.reason))
        classes = self.claims.groups[group]
        keys = {part.key for part in classes.parts if part is not None}
        mine = tuple(x for x in drives if not keys or keys & {*x.classes})
        return GapSearch(self.claims, self.where, classes, mine, tuple(lost))

    def is_covered(self, known: Answers) -> bool:
        """Return whether all claims of coverage are proved."""
        coverage_claims = self.claims.coverage_claims
        return all(name in known and known[name].verdict is Verdict.PROVED for name in coverage_claims)

    def label(self, name: str) -> str:
        """Return which class, claim or definition the claim of a name is about."""
        home = self.basis.specification
        definition = next((x for x in own_definitions(home) if name.endswith(f"-{x}")), "")
        if f"needed-{definition}" in name or f"spare-{definition}" in name:
            return f"{definition} of {home.set_name}"
        stem = next((x for x in self.claims.groups if f"-{x}-" in name), "")
        if not stem:
            return home.set_name
        parts, rest = self.claims.groups[stem].parts, name.partition(f"-{stem}-")[2].partition("-")[0]
        part = parts[int(rest)] if rest.isdecimal() and int(rest) < len(parts) else None
        words = ["no single condition"] if part is None else [part.component, part.condition]
        title = f"class {', '.join(x for x in words if x)}"
        return f"on the way to {title}" if name.startswith(HELP) else title

    def annotate(self, name: str, answer: ClaimAnswer, finding: Finding) -> Finding:
        """Return what was found, with what a judge was asked in place of a claim."""
        if not isinstance(answer.claim.mode, On):
            return finding
        word = name.removeprefix(HELP).partition("-")[0]
        return replace(finding, claim=_JUDGED.get(word, finding.claim))

    # --- what answers show together ---------------------------------------------------------------

    def view(self, known: Answers) -> CoverageView:
        """Return the answers about the set."""
        claims = tuple(_proof(x.query, name, known) for name, x in self.claims.coverage_claims.items())
        classes: tuple[ClassAnswer, ...] = ()
        needs: list[Need] = []
        if is_covered(claims):
            needs = [replay_steps(ask_need(self.claims, x), known) for x in self.definitions]
        else:
            classes = tuple(x for name in self.groups for x in self._classes(name, known))
        survey = GapSurvey(claims, classes, tuple(sorted(needs, key=lambda x: x.definition)))
        return CoverageView(survey, tuple(self.claims.coverage_claims), known)

    def _classes(self, group: str, known: Answers) -> ClassAnswers:
        return replay_steps(self._search(group, known).run(), known)

    def unknowns(self, known: Answers) -> list[tuple[str, Reason]]:
        """Return the classes of which neither a drive nor a proof is known, and why."""
        survey = self.view(known).survey
        names = [(_title_of(x), x) for x in survey.classes]
        return [(name, x.reason) for name, x in names if x.verdict is Verdict.UNKNOWN]

    def data(self, view: CoverageView, place: EvidencePlace, seconds: float) -> CoverageData:
        """Return the view as ``--json`` prints it."""
        return coverage_data(self.basis, self.settings.wider, view, place, seconds, self.where.roads)


_JUDGED = {
    "simple": "gaps among some of the simple drives",
    "needed": "whether a simple drive is missed without it",
    "looks": "of which classes a drive is, and what catches it",
    "near": "in which scenario a drive is a gap, and what catches it",
}
"""What judges are asked, by how the names of their claims begin."""


def gaps_of(
    wider: Sequence[str], roads: Collection[Road], elsewhere: Collection[Road] = (), needed: bool = False
) -> GapSettings:
    """Return the settings of a question for gaps."""
    return GapSettings(
        wider=tuple(wider),
        roads=tuple(map(road_data, roads)),
        elsewhere=tuple(map(road_data, elsewhere)),
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
    """The claims whether a set needs a definition."""

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

    search: GapSearch

    @property
    def name(self) -> str:
        """The group."""
        return self.search.name

    def work_of(self, name: str) -> Work:
        """Return the work that is allowed for the claim of a name."""
        return work_of(name, self.search.claims)

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        yield from self.search.run()


def _proof(query: Query, name: str, known: Answers) -> ProofResult[Query]:
    answer = known.get(name)
    if answer is None:
        return ProofResult(query, verdict=Verdict.UNKNOWN, reason=NO_REASON)
    verdict: ProofVerdict = Verdict.UNKNOWN
    match answer.verdict:
        case Verdict.PROVED | Verdict.VACUOUS | Verdict.REFUTED as decided:
            verdict = decided
    return ProofResult(query, verdict=verdict, reason=answer.reason, certificate=answer.certificate)


def _title_of(answer: ClassAnswer) -> str:
    part = answer.part
    words = ["no single condition"] if part is None else [part.component, part.condition]
    return f"class {', '.join(x for x in words if x)}"
