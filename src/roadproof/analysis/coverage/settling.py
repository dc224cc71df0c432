"""A drive or a proof for every class of gaps: from drives that are known, from the prover, from a search."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

from roadproof.analysis.coverage.answers import Answers, ClassAnswer, Gap
from roadproof.analysis.coverage.classes import (
    GapClasses,
    GapGroup,
    GapSurvey,
    Part,
    caught,
    exchanged,
    in_either_role,
    near_miss,
    starts_in,
)
from roadproof.analysis.coverage.found import FoundGap, Trials
from roadproof.analysis.coverage.minimal import simplest
from roadproof.engines.search.ask import ask
from roadproof.engines.search.placing import judged_as, placed
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind
from roadproof.library.compose import both, conjuncts, either, eventually, implication, negation
from roadproof.library.scenarios import LANE, PAIR, Scenario, applied, danger
from roadproof.library.specification import Query
from roadproof.reasons import NO_REASON, Reason, Why, joined
from roadproof.runtime.budget import BudgetExceeded
from roadproof.semantics.exact.exact import judge
from roadproof.verdict import Verdict
from roadproof.world.road import Road

# Units of work for a proof before any search, and after it.
FIRST_PROOF = 2.0
LONG_PROOF = 30.0


@dataclass
class ClassGroup:
    """A group of classes that is to be settled; ``known``: gaps to begin with, to which those found come."""

    survey: GapSurvey
    group: GapGroup
    known: list[FoundGap]
    classes: GapClasses
    trials: Trials

    def __post_init__(self) -> None:
        self.basis = self.survey.basis
        self.specification = self.basis.specification
        self.library = self.basis.library

    def run(self) -> Answers:
        """The answers in the order of the parts. Conditions first: a gap for one is one for its component."""
        conditions = [self._answer(part) for part in self.group.conditions]
        return (self._answer(self.group.component, self.survey.wider), *conditions)

    def _answer(self, part: Part | None, wider: Sequence[str] = ()) -> ClassAnswer:
        """As ``_settle``; in doubt where the clock cuts it off."""
        try:
            return self._settle(part, wider)
        except BudgetExceeded as late:
            return ClassAnswer(part, verdict=Verdict.UNKNOWN, reason=late.reason)

    def _settle(self, part: Part | None, wider: Sequence[str] = ()) -> ClassAnswer:
        """A gap for the class, or a proof; with ``wider``, a gap for each set that may be the first."""
        units = self.basis.effort.units
        if not self._of(part):
            proved = self._prove(part, FIRST_PROOF)
            if proved is not None:
                return proved
            reason = self._look(part, "", self.survey.roads, units)
            if reason:
                return self._prove(part, LONG_PROOF) or ClassAnswer(
                    part, verdict=Verdict.UNKNOWN, reason=reason
                )
        for first in wider:
            if all(found.first != first for found in self._of(part)):
                self._look(part, first, self.survey.roads[:1], units / 2)
        best: dict[str, FoundGap] = {}
        for found in sorted(self._of(part), key=lambda found: found.effort):
            best.setdefault(found.first, found)
        if not wider:
            best = dict(list(best.items())[:1])
        order = [*self.survey.wider, ""]
        chosen = sorted(best.values(), key=lambda found: order.index(found.first))
        gaps = tuple(self._gap(part, found) for found in chosen)
        return ClassAnswer(
            part, verdict=Verdict.WITNESSED, gaps=gaps, none_for=tuple(x for x in wider if x not in best)
        )

    def _of(self, part: Part | None) -> list[FoundGap]:
        """The known gaps of the class."""
        return [found for found in self.known if self.classes.has(part, found.classes)]

    # --- proofs ----------------------------------------------------------------------------------

    def _prove(self, part: Part | None, units: float) -> ClassAnswer | None:
        """That the class of ``part`` is empty, in every road sector; ``units`` for a look at the first."""
        attempts = [self._all_are_near()] if part is None else [self._is_redundant(part), self._no_gaps(part)]
        for claims in attempts:
            if self.basis.proof_of(claims[0], units).certificate is None:
                continue
            claim = both(*claims)
            result = self.basis.proof_of(claim, max(LONG_PROOF, units) * len(self.classes.sectors), "gap")
            if result.holds and result.certificate is not None:
                return ClassAnswer(
                    part, verdict=Verdict.IMPOSSIBLE, claim=claim, certificate=result.certificate
                )
        return None

    def _is_redundant(self, part: Part) -> list[Query]:
        """That the scenario holds without the part only where it holds, a claim for each road sector."""
        return [
            implication(
                x.without, applied(self.specification, Scenario(x.scenario, self.specification.set_name))
            )
            for x, _ in self.classes.counterparts(part)
        ]

    def _no_gaps(self, part: Part) -> list[Query]:
        """That near misses of ``part`` are no gaps, in either role: claims for each road sector.

        Danger is the same in either order, but that is not taken for granted.
        """
        claims = []
        for counterpart, sector in self.classes.counterparts(part):
            some = either(*in_either_role(self.specification, sector))
            for pair in (PAIR, PAIR[::-1]):
                later = eventually(danger(self.specification, *pair))
                claims.append(implication(both(*conjuncts(counterpart.without), later), some))
        return claims

    def _all_are_near(self) -> list[Query]:
        """That a gap is a near miss but for a single condition, a claim for each road sector."""
        claims = []
        for sector in self.classes.sectors:
            near = [x for p in self._finest(sector) for x in (p.without, exchanged(p.without))]
            some = either(*in_either_role(self.specification, sector), *near)
            claims.append(implication(starts_in(self.specification, sector), some))
        return claims

    def _finest(self, numbers: Sequence[int]) -> list[Part]:
        """The parts of these scenarios that have no parts themselves."""
        return [part for number in numbers for part in self.classes.by_number[number] if part.finest]

    # --- drives ----------------------------------------------------------------------------------

    def _look(self, part: Part | None, first: str, roads: Sequence[Road], units: float) -> Reason:
        """Look for a gap on the roads in turn, with so much work each; why none was found, or empty."""
        reasons = []
        for road in roads:
            numbers = self.classes.numbers_on(road)
            for counterpart in self._on(part, numbers):
                query = self._query(counterpart, numbers, first)
                try:
                    outcome = ask(self.basis.search(query, road, self.basis.effort.of(units)))
                except UsageError as error:  # a grid that is too fine, a comparison too steep
                    reasons.append(Why.NO_SEARCH(road.name, error))
                    continue
                if outcome.drives:
                    file = simplest(outcome.drives[0].file, query, self.library)
                    self.known.append(FoundGap(file, self.trials.first(file), self.classes.of(file)))
                    return NO_REASON
                reasons.append(Why.NOT_ON(outcome.reason or "none", road.name))
        return Why.WORK_EACH(joined(reasons), units, self.basis.horizon)

    def _on(self, part: Part | None, numbers: Sequence[int]) -> list[Part | None]:
        """The counterparts of a part among these scenarios."""
        if part is None:
            return [None]
        return [p for p, _ in self.classes.counterparts(part) if p.scenario in numbers]

    def _query(self, part: Part | None, numbers: tuple[int, ...], first: str = "") -> Query:
        """What a gap of the class satisfies; with ``first`` one that this set is the first to catch."""
        asked = [*conjuncts(self.classes.missed(numbers))]
        if part is None:
            asked += [negation(near_miss(p)) for p in self._finest(numbers)]
        else:
            asked += conjuncts(part.without)
        if first:
            before = self.survey.wider[: self.survey.wider.index(first)]
            catches = {name: caught(self.specification, numbers, name) for name in (*before, first)}
            asked += [catches[first], *(negation(catches[name]) for name in before)]
        return both(*asked)

    # --- evidence --------------------------------------------------------------------------------

    def _gap(self, part: Part | None, found: FoundGap) -> Gap:
        """The drive as evidence for the class, judged on the scenarios of all road sectors."""
        counterpart, turned = self._turned(part, found.file)
        drive = judged_as(turned, self._query(counterpart, self.classes.numbers), self.library)
        assert drive is not None, f"the drive is no gap of {self.group.title}"
        whole = part is None or not part.condition
        elsewhere = dict(self._elsewhere(part, drive)) if whole else {}
        return Gap(drive, found.first, self.trials.smallest(drive.file), found.classes, elsewhere)

    def _turned(self, part: Part | None, file: DriveFile) -> tuple[Part | None, DriveFile]:
        """The sector, the roles and the lane in which the scenario of ``part`` is missed by it alone."""
        if part is None:
            return None, replace(file, lanes={})
        turned = file.drive.cast(dict(zip(PAIR, PAIR[::-1], strict=True)))
        for counterpart, _ in self.classes.counterparts(part):
            for drive, lane in product((file.drive, turned), file.road.lanes):
                lanes = {LANE: lane}
                bound = bind(counterpart.without.formula, file.road, lanes, self.classes.values)
                if judge(bound, drive).holds:
                    return counterpart, replace(file, drive=drive, lanes=lanes)
        raise AssertionError(f"the drive is no near miss of {part.key}")

    def _elsewhere(self, part: Part | None, drive: JudgedDrive) -> Iterator[tuple[str, JudgedDrive]]:
        """The same motions on other roads, where a counterpart is missed as nearly."""
        counterparts = self._on(part, self.classes.numbers)[::-1]
        for road in self.survey.elsewhere:
            if road.name == drive.file.road.name:
                continue
            for counterpart in counterparts:
                query = self._query(counterpart, self.classes.numbers)
                there = placed(drive.file, query, self.library, [road])
                if there is not None:
                    yield road.name, there
                    break
