"""A drive or a proof for every class of gaps: claims one after the other, and what their answers show."""

from collections.abc import Sequence
from dataclasses import replace

from roadproof.engines.search.placing import with_moved
from roadproof.evidence.answer import Judged
from roadproof.evidence.answer_files import Undecided
from roadproof.evidence.claim import HELP, valid_under
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.surveys.coverage.answers import Answers, ClassAnswer, Gap, Need, Shown, in_role
from roadproof.extensions.surveys.coverage.claims import GapClaims, group_name
from roadproof.extensions.surveys.coverage.classes import GapGroup, Part
from roadproof.extensions.surveys.coverage.found import FoundGap, numbered, parent_of, roads_of_need
from roadproof.extensions.surveys.coverage.looks import (
    Looks,
    LooksJudge,
    Near,
    NearJudge,
    Needing,
    NeedJudge,
    Placed,
)
from roadproof.extensions.surveys.coverage.simple_drives import HORIZON
from roadproof.extensions.surveys.extremes.points import Asking
from roadproof.reasons import NO_REASON, Reason, Why, joined
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
    """Where gaps are looked for, in this order, and where the motions of those found are tried."""

    roads: tuple[Road, ...]
    elsewhere: tuple[Road, ...]


@dataclass(frozen=True)
class GroupAsking:
    """The claims about a group of classes; ``found``: gaps to begin with, and ``lost``: why few."""

    claims: GapClaims
    where: GapRoads
    group: GapGroup
    found: tuple[FoundGap, ...]
    lost: tuple[Reason, ...]

    @property
    def name(self) -> str:
        """How the names of its claims go on after the word for what is asked."""
        return group_name(self.group)

    def run(self) -> Asking[Answers]:
        """Ask; return the answers in the order of the parts.

        Conditions come first: a gap for one is one for its component.
        """
        known, group = [*self.found], self.group
        conditions: list[ClassAnswer] = []
        for k, part in enumerate(group.conditions, 1):
            conditions.append((yield from self._settle(f"{self.name}-{k}", part, (), known)))
        whole = yield from self._settle(f"{self.name}-0", group.component, self.claims.wider, known)
        return (whole, *conditions)

    def _settle(
        self, stem: str, part: Part | None, wider: Sequence[str], known: list[FoundGap]
    ) -> Asking[ClassAnswer]:
        """Ask for a gap of the class, or a proof; with ``wider``, for each set that may be the first."""
        if not self._of(part, known):
            failed: set[str] = set()
            proved = yield from self._prove(stem, part, LOOK, failed)
            if proved is not None:
                return proved
            reason = yield from self._look(f"{SOUGHT}-{stem}", part, "", self.where.roads, known)
            if reason:
                proved = yield from self._prove(stem, part, AGAIN, failed)
                doubt = joined((reason, *self.lost))
                return proved or ClassAnswer(part, verdict=Verdict.UNKNOWN, reason=doubt)
        for first in wider:
            if all(x.first != first for x in self._of(part, known)):
                yield from self._look(f"{WIDER}-{stem}-{first}", part, first, self.where.roads[:1], known)
        best: dict[str, FoundGap] = {}
        for found in sorted(self._of(part, known), key=lambda x: x.effort):
            best.setdefault(found.first, found)
        if not wider:
            best = dict(list(best.items())[:1])
        order = [*self.claims.wider, ""]
        gaps: list[Gap] = []
        for n, found in enumerate(sorted(best.values(), key=lambda x: order.index(x.first)), 1):
            gap = yield from self._gap(f"{stem}-{n}", part, found)
            if not isinstance(gap, Gap):
                return ClassAnswer(part, verdict=Verdict.UNKNOWN, reason=gap)
            gaps.append(gap)
        none_for = tuple(x for x in wider if x not in best)
        return ClassAnswer(part, verdict=Verdict.WITNESSED, gaps=tuple(gaps), none_for=none_for)

    def _of(self, part: Part | None, known: Sequence[FoundGap]) -> list[FoundGap]:
        """The known gaps of the class; a forged one may name a set that is not asked."""
        sets = ("", *self.claims.wider)
        return [x for x in known if x.first in sets and self.claims.classes.has(part, x.classes)]

    def _prove(self, stem: str, part: Part | None, word: str, failed: set[str]) -> Asking[ClassAnswer | None]:
        """Ask whether the class is empty, in every road sector, where it is in the first.

        ``failed``: the names of claims of every sector that were not proved.
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
                    proof=Shown(name, answer),
                )
            failed.add(name)
        return None

    def _look(
        self, stem: str, part: Part | None, first: str, roads: Sequence[Road], known: list[FoundGap]
    ) -> Asking[Reason]:
        """Look for a gap on the roads in turn; return why none was found, or nothing."""
        reasons: list[Reason] = []
        units = self.claims.basis.effort.units
        for r, road in enumerate(roads, 1):
            counterparts = self.claims.on(part, self.claims.classes.numbers_on(road))
            for k, counterpart in enumerate(counterparts, 1):
                name = f"{stem}-{r}-{k}"
                answer = yield name, self.claims.sought(counterpart, road, first)
                if answer.drive is not None:
                    file = answer.drive.file
                    claim = self.claims.judged(
                        LooksJudge(self.claims, file), ("looks", file.drive, file.road)
                    )
                    looks = yield name.replace(HELP, "looks-", 1), claim
                    if isinstance(looks.evidence, Judged) and isinstance(looks.evidence.shows, Looks):
                        shows = looks.evidence.shows
                        known.append(FoundGap(file, shows.first, shows.classes))
                        return NO_REASON
                    answer = looks
                elif isinstance(answer.evidence, Undecided):
                    units = answer.evidence.units or units
                is_refused = answer.reason.startswith(Why.NO_SEARCH(road.name, ""))
                reasons.append(
                    answer.reason if is_refused else Why.NOT_ON(answer.reason or "none", road.name)
                )
        return Why.WORK_EACH(joined(reasons), units, self.claims.basis.horizon)

    # --- evidence --------------------------------------------------------------------------------

    def _gap(self, stem: str, part: Part | None, found: FoundGap) -> Asking[Gap | Reason]:
        """Ask for the drive as evidence for the class, about the scenarios of all road sectors."""
        claims, file = self.claims, found.file
        whole = part is None or not part.condition
        elsewhere = self.where.elsewhere if whole else ()
        judge = NearJudge(claims, part, file, elsewhere)
        about = "near", part and part.key, file.drive, file.road, elsewhere
        answer = yield f"near-{stem}", claims.judged(judge, about)
        if not isinstance(answer.evidence, Judged) or not isinstance(answer.evidence.shows, Near):
            return answer.reason
        near = answer.evidence.shows
        if near.lane is not None and near.lane not in file.road.lanes:
            return Why.DRIVE_REJECTED()
        drive = in_role(file, near.turned, near.lane)
        gap = yield from self._shown(f"gap-{stem}", part, near.scenario, drive)
        if gap is None:
            return Why.DRIVE_REJECTED()
        there: dict[str, Shown] = {}
        for placed in near.elsewhere:
            road = _road(placed, elsewhere, drive)
            if road is not None:
                name = f"gap-{stem}-{placed.road.replace(' ', '-')}"
                shown = yield from self._shown(name, part, placed.scenario, replace(drive, road=road))
                there |= {} if shown is None else {placed.road: shown}
        return Gap(gap, found.first, near.caught_by, found.classes, there)

    def _shown(
        self, name: str, part: Part | None, scenario: int | None, file: DriveFile
    ) -> Asking[Shown | None]:
        counterparts = self.claims.on(part, self.claims.classes.numbers)
        found = [x for x in counterparts if (None if x is None else x.scenario) == scenario]
        if not found:
            return None
        answer = yield name, self.claims.shown(found[0], file)
        return None if answer.drive is None else Shown(name, answer)


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
            return Work(effort.of(effort.units / 2), 0.0, alone=True, simplify=True)
        case "sought":
            return Work(effort, 0.0, alone=True, simplify=True)
        case _:
            return Work(effort, PROOF, alone=True)


def ask_need(claims: GapClaims, definition: str) -> Asking[Need]:
    """Ask whether a set needs a definition: for a drive that is missed without it, or proofs that none is."""
    parent, stem = parent_of(claims.home), f"needed-{definition}"
    missed, *others = claims.without(definition)
    claim = claims.judged(NeedJudge(claims, definition), ("needed", definition))
    answer = yield f"{HELP}{stem}", claim
    shows = answer.evidence.shows if isinstance(answer.evidence, Judged) else None
    if isinstance(shows, Needing) and shows.drive is not None:
        roads = roads_of_need()
        road = roads[shows.drive.road] if 0 <= shows.drive.road < len(roads) else None
        drive = None if road is None else numbered(road, shows.drive.number)
        if road is not None and drive is not None:
            shown = yield stem, claims.given(missed, road, drive, None, HORIZON)
            if shown.drive is not None:
                need = Shown(stem, shown)
                return Need(definition, parent, verdict=Verdict.WITNESSED, drive=shown.drive, shown=need)
    for k, query in enumerate(others, 1):
        proof = yield f"spare-{definition}-{k}", valid_under(claims.home, query)
        if proof.certificate is None:
            return Need(definition, parent, verdict=Verdict.UNKNOWN)
    return Need(definition, parent, verdict=Verdict.PROVED)


def _road(placed: Placed, roads: Sequence[Road], file: DriveFile) -> Road | None:
    """The road on which the motions are tried, moved along; None where there is no such place."""
    found = [x for x in roads if x.name == placed.road]
    places = [y for x in found[:1] for y in with_moved([x], file.drive)]
    return places[placed.place] if 0 <= placed.place < len(places) else None
