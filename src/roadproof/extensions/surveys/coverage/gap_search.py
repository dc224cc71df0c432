"""The search for a gap of every class, or for a proof that the class is empty."""

from collections.abc import Sequence
from dataclasses import replace

from roadproof.engines.search.placing import with_moved
from roadproof.evidence.answer import JudgedTrace
from roadproof.evidence.answer_files import UndecidedFile
from roadproof.evidence.assuming import valid_under
from roadproof.evidence.claim import HELP
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.surveys.coverage.answers import (
    Answers,
    ClassAnswer,
    Gap,
    NamedAnswer,
    Need,
    in_role,
)
from roadproof.extensions.surveys.coverage.claims import GapClaims, group_name
from roadproof.extensions.surveys.coverage.classes import GapGroup, ScenarioPart
from roadproof.extensions.surveys.coverage.gap_drives import GapDrive, parent_of, roads_of_need, simple_drive
from roadproof.extensions.surveys.coverage.judges import (
    GapJudge,
    GapJudgement,
    NearMiss,
    NearMissJudge,
    NeedJudge,
    NeedJudgement,
    RoadPlacement,
)
from roadproof.extensions.surveys.coverage.simple_drives import HORIZON
from roadproof.extensions.surveys.extremes.points import ClaimGenerator
from roadproof.reasons import NO_REASON, Reason, ReasonKind, joined
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict
from roadproof.world.road import Road

PROOF, FIRST_PROOF, LONG_PROOF = 60.0, 2.0, 30.0
"""Units of work for a claim of coverage; for a proof before any search, and after it, for a road sector."""
LOOK, AGAIN = f"{HELP}look", f"{HELP}again"
SOUGHT, WIDER = f"{HELP}sought", f"{HELP}wider"


@dataclass(frozen=True)
class GapRoads:
    """The roads on which gaps are searched, in order, and those on which the motions are tried, too."""

    roads: tuple[Road, ...]
    elsewhere: tuple[Road, ...]


@dataclass(frozen=True)
class GapSearch:
    """The claims about a group of classes; ``drives``: known gaps; ``lost``: why drives are lacking."""

    claims: GapClaims
    where: GapRoads
    group: GapGroup
    drives: tuple[GapDrive, ...]
    lost: tuple[Reason, ...]

    @property
    def name(self) -> str:
        """The word for the group in the names of its claims."""
        return group_name(self.group)

    def run(self) -> ClaimGenerator[Answers]:
        """Ask all claims, and return the answers in the order of the parts.

        Conditions come first, because a gap for a condition is one for its component.
        """
        known, group = [*self.drives], self.group
        conditions: list[ClassAnswer] = []
        for k, part in enumerate(group.conditions, 1):
            conditions.append((yield from self._decide(f"{self.name}-{k}", part, (), known)))
        whole = yield from self._decide(f"{self.name}-0", group.component, self.claims.wider, known)
        return (whole, *conditions)

    def _decide(
        self, stem: str, part: ScenarioPart | None, wider: Sequence[str], known: list[GapDrive]
    ) -> ClaimGenerator[ClassAnswer]:
        """Ask for a gap or a proof of a class; with ``wider``, for a gap for each first catching set."""
        if not self._of(part, known):
            failed: set[str] = set()
            proved = yield from self._prove(stem, part, LOOK, failed)
            if proved is not None:
                return proved
            reason = yield from self._look(f"{SOUGHT}-{stem}", part, "", self.where.roads, known)
            if reason:
                proved = yield from self._prove(stem, part, AGAIN, failed)
                reasons = joined((reason, *self.lost))
                return proved or ClassAnswer(part, verdict=Verdict.UNKNOWN, reason=reasons)
        for first in wider:
            if all(x.first != first for x in self._of(part, known)):
                yield from self._look(f"{WIDER}-{stem}-{first}", part, first, self.where.roads[:1], known)
        best: dict[str, GapDrive] = {}
        for drive in sorted(self._of(part, known), key=lambda x: x.effort):
            best.setdefault(drive.first, drive)
        if not wider:
            best = dict(list(best.items())[:1])
        order = [*self.claims.wider, ""]
        gaps: list[Gap] = []
        for n, drive in enumerate(sorted(best.values(), key=lambda x: order.index(x.first)), 1):
            gap = yield from self._gap(f"{stem}-{n}", part, drive)
            if not isinstance(gap, Gap):
                return ClassAnswer(part, verdict=Verdict.UNKNOWN, reason=gap)
            gaps.append(gap)
        none_for = tuple(x for x in wider if x not in best)
        return ClassAnswer(part, verdict=Verdict.WITNESSED, gaps=tuple(gaps), none_for=none_for)

    def _of(self, part: ScenarioPart | None, known: Sequence[GapDrive]) -> list[GapDrive]:
        """Return the known gaps of the class; forged ones may name a set that is not asked."""
        sets = ("", *self.claims.wider)
        return [x for x in known if x.first in sets and self.claims.classes.has(part, x.classes)]

    def _prove(
        self, stem: str, part: ScenarioPart | None, word: str, failed: set[str]
    ) -> ClaimGenerator[ClassAnswer | None]:
        """Ask whether the class is empty: in the first road sector, and then in all.

        ``failed``: the names of claims about all sectors that were not proved.
        """
        for k, (first, every) in enumerate(self.claims.empty(part), 1):
            look = yield f"{word}-{stem}-{k}", first
            name = f"empty-{stem}-{k}"
            if look.certificate is None or name in failed:
                continue
            answer = yield name, every()
            if answer.certificate is not None:
                return ClassAnswer(
                    part,
                    verdict=Verdict.IMPOSSIBLE,
                    claim=answer.claim.query,
                    certificate=answer.certificate,
                    proof=NamedAnswer(name, answer),
                )
            failed.add(name)
        return None

    def _look(
        self, stem: str, part: ScenarioPart | None, first: str, roads: Sequence[Road], known: list[GapDrive]
    ) -> ClaimGenerator[Reason]:
        """Search a gap on the roads in turn; return the reason why none was found, or NO_REASON."""
        reasons: list[Reason] = []
        units = self.claims.basis.effort.units
        for r, road in enumerate(roads, 1):
            counterparts = self.claims.on(part, self.claims.classes.numbers_on(road))
            for k, counterpart in enumerate(counterparts, 1):
                name = f"{stem}-{r}-{k}"
                answer = yield name, self.claims.gap_exists(counterpart, road, first)
                if answer.drive is not None:
                    file = answer.drive.file
                    claim = self.claims.judgement_claim(
                        GapJudge(self.claims, file), ("looks", file.drive, file.road)
                    )
                    looks = yield name.replace(HELP, "looks-", 1), claim
                    if isinstance(looks.evidence, JudgedTrace) and isinstance(
                        looks.evidence.shows, GapJudgement
                    ):
                        shows = looks.evidence.shows
                        known.append(GapDrive(file, shows.first, shows.classes))
                        return NO_REASON
                    answer = looks
                elif isinstance(answer.evidence, UndecidedFile):
                    units = answer.evidence.units or units
                reasons.append(ReasonKind.NOT_ON(road.name, answer.reason or "none"))
        return ReasonKind.WORK_EACH(joined(reasons), units, self.claims.basis.horizon)

    # --- evidence --------------------------------------------------------------------------------

    def _gap(self, stem: str, part: ScenarioPart | None, gap_drive: GapDrive) -> ClaimGenerator[Gap | Reason]:
        """Ask for judgements of the drive as evidence for the class, in all road sectors."""
        claims, file = self.claims, gap_drive.file
        whole = part is None or not part.condition
        elsewhere = self.where.elsewhere if whole else ()
        judge = NearMissJudge(claims, part, file, elsewhere)
        about = "near", part and part.key, file.drive, file.road, elsewhere
        answer = yield f"near-{stem}", claims.judgement_claim(judge, about)
        if not isinstance(answer.evidence, JudgedTrace) or not isinstance(answer.evidence.shows, NearMiss):
            return answer.reason
        near = answer.evidence.shows
        if near.lane is not None and near.lane not in file.road.lanes:
            return ReasonKind.DRIVE_REJECTED()
        drive = in_role(file, near.turned, near.lane)
        gap = yield from self._evidence(f"gap-{stem}", part, near.scenario, drive)
        if gap is None:
            return ReasonKind.DRIVE_REJECTED()
        there: dict[str, NamedAnswer] = {}
        for placed in near.elsewhere:
            road = _road(placed, elsewhere, drive)
            if road is not None:
                name = f"gap-{stem}-{placed.road.replace(' ', '-')}"
                shown = yield from self._evidence(name, part, placed.scenario, replace(drive, road=road))
                there |= {} if shown is None else {placed.road: shown}
        return Gap(gap, gap_drive.first, near.caught_by, gap_drive.classes, there)

    def _evidence(
        self, name: str, part: ScenarioPart | None, scenario: int | None, file: DriveFile
    ) -> ClaimGenerator[NamedAnswer | None]:
        counterparts = self.claims.on(part, self.claims.classes.numbers)
        matches = [x for x in counterparts if (None if x is None else x.scenario) == scenario]
        if not matches:
            return None
        answer = yield name, self.claims.gap_on(matches[0], file)
        return None if answer.drive is None else NamedAnswer(name, answer)


def work_of(name: str, claims: GapClaims) -> Work:
    """Return the work that is allowed for the claim of a name."""
    effort = claims.basis.effort
    match name.removeprefix(HELP).partition("-")[0]:
        case "look":
            return Work(effort, FIRST_PROOF, alone=True)
        case "again":
            return Work(effort, LONG_PROOF, alone=True)
        case "empty":
            return Work(effort, LONG_PROOF * len(claims.classes.sectors), alone=True)
        case "wider":
            return Work(effort.with_units(effort.units / 2), 0.0, alone=True, simplify=True)
        case "sought":
            return Work(effort, 0.0, alone=True, simplify=True)
        case _:  # open: names of claims
            return Work(effort, PROOF, alone=True)


def ask_need(claims: GapClaims, definition: str) -> ClaimGenerator[Need]:
    """Ask whether a set needs its version of a definition instead of its parent's.

    The first claim is a simple drive that is missed with the parent's version (WITNESSED). Then come
    proofs that no drive is missed: PROVED if all have a certificate, UNKNOWN at the first one without.
    """
    parent, stem = parent_of(claims.home), f"needed-{definition}"
    gap, *others = claims.need_formulas(definition)
    claim = claims.judgement_claim(NeedJudge(claims, definition), ("needed", definition))
    answer = yield f"{HELP}{stem}", claim
    shows = answer.evidence.shows if isinstance(answer.evidence, JudgedTrace) else None
    if isinstance(shows, NeedJudgement) and shows.drive is not None:
        roads = roads_of_need()
        road = roads[shows.drive.road] if 0 <= shows.drive.road < len(roads) else None
        drive = None if road is None else simple_drive(road, shows.drive.number)
        if road is not None and drive is not None:
            shown = yield stem, claims.holds_on(gap, road, drive, None, HORIZON)
            if shown.drive is not None:
                need = NamedAnswer(stem, shown)
                return Need(definition, parent, verdict=Verdict.WITNESSED, drive=shown.drive, shown=need)
    for k, query in enumerate(others, 1):
        proof = yield f"spare-{definition}-{k}", valid_under(claims.home, query)
        if proof.certificate is None:
            return Need(definition, parent, verdict=Verdict.UNKNOWN)
    return Need(definition, parent, verdict=Verdict.PROVED)


def _road(placed: RoadPlacement, roads: Sequence[Road], file: DriveFile) -> Road | None:
    """Return the road of a placement, moved along; None if there is no such place."""
    named = [x for x in roads if x.name == placed.road]
    places = [y for x in named[:1] for y in with_moved([x], file.drive)]
    return places[placed.place] if 0 <= placed.place < len(places) else None
