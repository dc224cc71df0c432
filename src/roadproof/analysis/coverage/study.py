"""Which disturbances a spec set misses: proofs that it misses none, or its gaps in classes.

Claims of coverage come first. Where they are proved, only the definitions are left that the set may not need;
else the simple drives are looked through, and gaps among them are what the classes begin with.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from roadproof.analysis.basis import ProofResult
from roadproof.analysis.coverage.answers import (
    Chunk,
    ClassAnswer,
    Component,
    CoverageClaim,
    GapScan,
    GapTraffic,
    Kept,
    NeededDefinition,
    Piece,
    Survey,
    answers_in,
    group_name,
    is_covered,
    name_of,
    record_of,
    with_counts,
)
from roadproof.analysis.coverage.classes import PROOF, GapClasses, GapGroup, GapSurvey, Part, claims_of
from roadproof.analysis.coverage.found import (
    FoundGap,
    Need,
    Trials,
    find_among_simple,
    find_need,
    mixed_definitions,
    parent_of,
    replaced_by,
)
from roadproof.analysis.coverage.settling import ClassGroup
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared
from roadproof.errors import InputError
from roadproof.evidence.answers import coverage as kept
from roadproof.evidence.answers.coverage import SCHEMA
from roadproof.evidence.strict import JsonObject
from roadproof.library.specification import Query
from roadproof.reasons import Reason, Why, joined
from roadproof.verdict import Verdict
from roadproof.world.unread import unread_of_road

CHUNKS = 7
"""The simple drives of a road are looked through in so many pieces."""


@dataclass(frozen=True)
class Coverage(Unprepared):
    """The question which disturbances a set misses, as a ``study.frame.Study``.

    ``needed``: also which of its definitions it needs, where it misses none.
    """

    record_type: ClassVar[type[kept.Record]] = kept.Record
    survey: GapSurvey
    needed: bool = False

    @property
    def question(self) -> Question:
        """Without the roads: what was decided on some of them stays so, and doubts are asked again."""
        basis = self.survey.basis
        said: JsonObject = {"set": basis.specification.set_name, "wider": list(self.survey.wider)}
        return Question(SCHEMA, said | basis.said(), basis.limits, basis.library)

    @cached_property
    def claims(self) -> tuple[CoverageClaim, ...]:
        queries = claims_of(self.survey.basis.specification)
        return tuple(CoverageClaim(number, query) for number, query in enumerate(queries, 1))

    @cached_property
    def groups(self) -> dict[str, GapGroup]:
        """The classes in groups, by the names under which their answers are kept."""
        return {group_name(group): group for group in self._classes.groups()}

    @cached_property
    def _classes(self) -> GapClasses:
        return GapClasses(self.survey.basis)

    @cached_property
    def _trials(self) -> Trials:
        return Trials(self.survey.basis, self.survey.wider)

    # --- pieces ----------------------------------------------------------------------------------

    def pieces(self, known: Mapping[str, Kept]) -> Sequence[Piece]:
        claims = [claim for claim in self.claims if name_of(claim) not in known]
        if claims:
            return claims
        if is_covered(self._proved(known)):
            definitions = [NeededDefinition(name) for name in self._replaced()]
            return [definition for definition in definitions if name_of(definition) not in known]
        groups = [name for name in self.groups if name not in known]
        roads = range(len(self.survey.roads) if groups else 0)
        chunks = [Chunk(road, k) for road in roads for k in range(CHUNKS)]
        left = [chunk for chunk in chunks if name_of(chunk) not in known]
        if left:
            return left
        looked = [x for x in (known[name_of(chunk)] for chunk in chunks) if isinstance(x, GapScan)]
        found = [x for each in looked for x in each.found]
        lost = tuple(each.lost for each in looked if each.lost)
        return [Component(name, _concerning(self.groups[name], found), lost) for name in groups]

    def _proved(self, known: Mapping[str, Kept]) -> tuple[ProofResult[Query], ...]:
        answers = (known[name_of(claim)] for claim in self.claims)
        return tuple(answer for answer in answers if isinstance(answer, ProofResult))

    def _replaced(self) -> tuple[str, ...]:
        return replaced_by(self.survey.basis.specification) if self.needed else ()

    def settle(self, piece: Piece) -> dict[str, Kept]:
        basis = self.survey.basis
        answer: Kept
        match piece:
            case CoverageClaim(_, query):
                answer = basis.settle(query, query, PROOF, "coverage")
            case NeededDefinition(name):
                answer = find_need(basis, name)
            case Chunk(road, number):
                where, classes, trials = self.survey.roads[road], self._classes, self._trials
                answer = GapScan(tuple(find_among_simple(where, number, CHUNKS, classes, trials)))
            case Component(name, known, lost):
                group = self.groups[name]
                settling = ClassGroup(self.survey, group, [*known], self._classes, self._trials)
                answer = tuple(_with_lost(x, lost) for x in settling.run())
        return {name_of(piece): answer}

    def doubt(self, piece: Piece, reason: Reason) -> dict[str, Kept]:
        answer: Kept
        match piece:
            case CoverageClaim(_, query):
                answer = ProofResult(query, verdict=Verdict.UNKNOWN, reason=reason)
            case NeededDefinition(name):
                answer = Need(name, parent_of(self.survey.basis.specification), verdict=Verdict.UNKNOWN)
            case Chunk():
                answer = GapScan((), Why.NOT_LOOKED_THROUGH(reason))
            case Component(name):
                parts = self.groups[name].parts
                answer = tuple(ClassAnswer(part, verdict=Verdict.UNKNOWN, reason=reason) for part in parts)
        return {name_of(piece): answer}

    # --- answers that are kept -------------------------------------------------------------------

    def is_sure(self, answer: Kept) -> bool:
        """Gaps among the simple drives are no answer, and what has no evidence is quickly asked again."""
        match answer:
            case ProofResult():
                return answer.certificate is not None
            case Need():
                return answer.drive is not None
            case GapScan():
                return False
            case _:
                return all(x.verdict is not Verdict.UNKNOWN for x in answer)

    def wanted(self, known: Mapping[str, Kept]) -> Collection[str]:
        needs = (name_of(NeededDefinition(x)) for x in self._replaced())
        return [*map(name_of, self.claims), *needs, *self.groups]

    def key(self, name: str) -> str:
        return self._key

    @cached_property
    def _key(self) -> str:
        """A digest for all answers: each is about all scenarios of the set, and about sets put together.

        Such a set takes some definitions of another one, so every definition that it may be made of counts,
        with the values of all parameters.
        """
        basis, home = self.survey.basis, self.survey.basis.specification
        parts = self._classes.parts
        sets = [home.in_set(x) for x in (home.set_name, *self.survey.wider)]
        if self.needed and parent_of(home):
            sets.append(home.in_set(parent_of(home)))
        bodies = [sorted(mixed_definitions(home, x).items()) for x in sets]
        called = [(x.scenario, x.component, x.description, x.condition, x.finest) for x in parts]
        library = home.library.freedom, bool(home.library.files)
        roads = self.survey.roads, self.survey.elsewhere
        asked = [*claims_of(home), *(x.without for x in parts)]
        return basis.key(
            asked, bodies, called, library, roads, self.survey.wider, self.needed, basis.all_values()
        )

    def record(self, name: str, answer: Kept, shelf: EvidenceStore) -> kept.Record:
        match answer:
            case ProofResult(claim):
                said = kept.Claim(
                    claim=claim.text,
                    verdict=answer.verdict,
                    certificate=shelf.certificate(f"{name}.json", answer.certificate),
                    reason=answer.reason,
                )
                return kept.Record(claim=said)
            case Need(definition, parent):
                file = None if answer.drive is None else answer.drive.file
                need = kept.Need(
                    definition=definition,
                    extends=parent,
                    verdict=answer.verdict,
                    road="" if file is None else file.road.name,
                    formula="" if file is None else file.formula,
                    drive=shelf.drive(f"{name}.json", answer.drive),
                )
                return kept.Record(need=need)
            case GapScan():
                return kept.Record()
            case _:
                return record_of(self.groups[name], answer, shelf)

    def recall(self, record: kept.Record, shelf: EvidenceStore) -> tuple[str, Kept]:
        if record.claim is not None:
            return self._recalled_claim(record.claim, shelf)
        if record.need is not None:
            drive = shelf.read_drive(record.need.drive)
            need = Need(record.need.definition, record.need.extends, verdict=record.need.verdict, drive=drive)
            return name_of(NeededDefinition(need.definition)), need
        for name, group in self.groups.items():
            if group.title == record.group:
                return name, answers_in(record.classes, group, self.survey.basis.specification, shelf)
        raise InputError(f"the set has no component {record.group}")

    def _recalled_claim(self, said: kept.Claim, shelf: EvidenceStore) -> tuple[str, Kept]:
        for claim in self.claims:
            if claim.query.text == said.claim:
                certificate = shelf.read_certificate(said.certificate)
                return name_of(claim), ProofResult(
                    claim.query, verdict=said.verdict, reason=said.reason, certificate=certificate
                )
        raise InputError(f"coverage does not rest on this claim: {said.claim[:120]}")

    # --- all together ----------------------------------------------------------------------------

    def together(self, answers: Mapping[str, Kept], traffic: GapTraffic | None = None) -> Survey:
        """All answers, the classes in order; with how often they occur in ``traffic``."""
        claims = self._proved(answers)
        found = (answers.get(name_of(NeededDefinition(name))) for name in self._replaced())
        needs = [x for x in found if isinstance(x, Need)]
        every = [answers[name] for name in self._shown(answers)]
        classes = [x for each in every if isinstance(each, tuple) for x in each]
        if traffic is not None:
            classes = [with_counts(x, traffic) for x in classes]
        return Survey(claims, tuple(classes), tuple(sorted(needs, key=lambda x: x.definition)), traffic)

    def classes_in(self, answers: Mapping[str, Kept]) -> Callable[[Part | None], ClassAnswer | None]:
        """What is known of the class of a part; all are empty where it is proved that there is no gap."""
        known = {x.part and x.part.key: x for a in answers.values() if isinstance(a, tuple) for x in a}
        none = is_covered(self._proved(answers))

        def find(part: Part | None) -> ClassAnswer | None:
            return ClassAnswer(part, verdict=Verdict.IMPOSSIBLE) if none else known.get(part and part.key)

        return find

    def _shown(self, answers: Mapping[str, Kept]) -> list[str]:
        """The names of the groups that have answers, in order; none is shown where no gap can be."""
        return [] if is_covered(self._proved(answers)) else list(self.groups)

    def index(
        self,
        surveyed: Survey,
        answers: Mapping[str, Kept],
        records: Mapping[str, kept.Record],
        seconds: float,
    ) -> kept.Index:
        """The index, made of the answers as they are recorded: classes name their gaps by numbers."""
        recorded = [x for name in self._shown(answers) for x in records[name].classes]
        classes: list[kept.CountedClass] = []
        gaps: list[kept.NumberedGap] = []
        for answer, said in zip(surveyed.classes, recorded, strict=True):
            first = len(gaps) + 1
            gaps += [kept.NumberedGap(number=k, **vars(gap)) for k, gap in enumerate(said.gaps, first)]
            told = {
                "verdict": answer.verdict,
                "reason": answer.reason,
                "gaps": tuple(range(first, len(gaps) + 1)),
            }
            counts = {"in_traffic": answer.in_traffic, "trace": answer.trace}
            classes.append(kept.CountedClass(**{**vars(said), **told, **counts}))
        claims = (records[name_of(claim)].claim for claim in self.claims)
        needs = (records[name_of(NeededDefinition(x.definition))].need for x in surveyed.needs)
        return kept.Index(
            **self.question.heading,
            verdict=surveyed.verdict,
            claims=tuple(x for x in claims if x is not None),
            classes=tuple(classes),
            gaps=tuple(gaps),
            needs=tuple(x for x in needs if x is not None),
            traffic=None if surveyed.traffic is None else surveyed.traffic.told,
            left_out=tuple(x for road in self.survey.roads for x in unread_of_road(road)),
            seconds=round(seconds, 1),
        )


def _concerning(group: GapGroup, found: Sequence[FoundGap]) -> tuple[FoundGap, ...]:
    """The gaps that are in a class of the group; all of them where no single condition is to blame."""
    keys = {part.key for part in group.parts if part is not None}
    return tuple(x for x in found if not keys or keys & {*x.classes})


def _with_lost(answer: ClassAnswer, lost: tuple[Reason, ...]) -> ClassAnswer:
    """A doubt that also says which drives were not tried."""
    if answer.verdict is not Verdict.UNKNOWN or not lost:
        return answer
    return ClassAnswer(answer.part, verdict=answer.verdict, reason=joined((answer.reason, *lost)))
