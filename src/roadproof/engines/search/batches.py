"""Decides similar claims one after the other and reuses what earlier ones showed.

A drive of one claim is put on roads of the next and judged there; parts that clash in one are looked for
in the next and proved to clash there. So each claim has evidence of its own.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import assert_never

from roadproof.engines.search.claim_search import search_for_claim
from roadproof.engines.search.known_drive import KnownDrive, drive_of_claim, is_same_motion
from roadproof.engines.search.usual_road import zones_of
from roadproof.evidence.answer import ClaimAnswer, JudgedTrace, RefutingTrace, undecided
from roadproof.evidence.answer_files import UndecidedFile
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.claim import Claim, Exists, Means, On, OwnMode, Valid
from roadproof.evidence.countermodel import Countermodel
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.refutation import fault_of
from roadproof.library.compose import conjunction_of, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import without_sectors
from roadproof.library.specification import Query
from roadproof.logic.formula import Formula, Not
from roadproof.logic.parts import parts_of
from roadproof.logic.rewrite import without_names
from roadproof.reasons import ReasonKind
from roadproof.runtime.budget import NO_COST, BudgetExceeded, Cost, Work
from roadproof.runtime.progress import about
from roadproof.runtime.timing import now, seconds_since
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive

MOVED = 5
"""So many drives are tried on other roads for a claim that is about no road sector."""
FOR_A_PART = 10.0  # times the work of a first proof, for one that parts clash
TRACES = 5
"""So many of the latest refuting traces are tried as ones that have the formula of a further claim."""


@dataclass(frozen=True)
class Engines:
    """The engines for claims of a batch, and the drives, traces and clashes that earlier claims gave."""

    work: Work
    drives: list[KnownDrive] = field(default_factory=list)
    alike: dict[Formula, list[KnownDrive]] = field(default_factory=dict)
    traces: list[Countermodel] = field(default_factory=list)
    unrefuted: list[Claim] = field(default_factory=list)
    clashes: list[tuple[Formula, Certificate]] = field(default_factory=list)
    vain: set[Formula] = field(default_factory=set)

    def learn(self, answer: ClaimAnswer) -> None:
        """Remember the evidence of an answer for later claims."""
        if self.work.alone:
            return
        if answer.drive is not None and not self.work.moves:
            self.offer(answer.drive)
        elif answer.drive is not None:
            known = self._known(answer.drive)
            for claim in (answer.claim, *self._refuted_by(known)):
                self.alike.setdefault(without_sectors(claim.formula), []).append(known)
        elif isinstance(answer.claim.mode, Valid) and answer.certificate is None:
            self.unrefuted.append(answer.claim)
        elif not answer.is_final and not answer.reason.is_late:
            self.vain.add(without_sectors(answer.claim.formula))
        if isinstance(answer.evidence, RefutingTrace):
            self.traces.append(answer.evidence.trace)
        if isinstance(answer.claim.mode, Exists) and answer.certificate is not None:
            denied = read_claim(answer.claim.home, answer.certificate.claim).formula
            self.clashes.append((denied, answer.certificate))

    def offer(self, drive: JudgedDrive) -> None:
        """Remember a drive, to be tried first at its place; motions that are known move to the front."""
        known = [x for x in self.drives if is_same_motion(x.judged.file, drive.file)]
        self.drives[:] = [x for x in self.drives if x not in known] + (known or [KnownDrive(drive)])

    def _known(self, drive: JudgedDrive) -> KnownDrive:
        """Return the drive with its judge; one that shows several formulas is remembered once."""
        same = next((x for x in self.drives if x.moves_as(drive)), None)
        if same is None:
            same = KnownDrive(drive)
            self.drives.append(same)
        return same

    def _refuted_by(self, drive: KnownDrive) -> list[Claim]:
        """Return the claims that no drive refuted before, and that this one refutes."""
        refuted = [x for x in self.unrefuted if drive.refutes(x)]
        self.unrefuted[:] = [x for x in self.unrefuted if x not in refuted]
        return refuted

    def answer_claim(self, claim: Claim, proposed: Iterable[JudgedDrive] = ()) -> tuple[ClaimAnswer, Cost]:
        """Return the answer to a claim and its cost; UNKNOWN where the clock cuts it off.

        ``proposed``: drives that are tried first at their places.
        """
        started = now()
        with about(f"{claim.query.text} {claim.home.set_name}"):
            answer, cost = self._answer_by_mode(claim, proposed)
        if self.work.simplify and isinstance(answer.evidence, UndecidedFile):
            allowed = replace(answer.evidence, units=self.work.effort.units)
            answer = replace(answer, evidence=allowed)
        return answer, replace(cost, seconds=seconds_since(started))

    def _answer_by_mode(self, claim: Claim, proposed: Iterable[JudgedDrive]) -> tuple[ClaimAnswer, Cost]:
        try:
            shown = next((x for drive in proposed if (x := KnownDrive(drive).here(claim)) is not None), None)
            if shown is not None:
                return ClaimAnswer(claim, shown), NO_COST
            match claim.mode:
                case Valid():
                    from roadproof.engines.search.valid import decide_valid  # here: drives need no prover

                    alike = self.alike.get(without_sectors(claim.formula), ())
                    return decide_valid(claim, self.work, self.drives, alike)
                case Exists(like=Drive() as like):
                    shown = drive_of_claim(claim, claim.mode, like)
                    answer = (
                        undecided(claim, ReasonKind.NO_DRIVE())
                        if shown is None
                        else ClaimAnswer(claim, shown)
                    )
                    return answer, NO_COST
                case Exists(trees=True):
                    from roadproof.engines.search.single_claim import (
                        refute_with_trees,  # here: proofs need no numpy
                    )

                    return refute_with_trees(claim, self.work), NO_COST
                case Exists() if self.work.simplify:
                    from roadproof.engines.search.single_claim import decide_existence_simply

                    return decide_existence_simply(claim, self.work)
                case Exists() if self.work.alone:
                    from roadproof.engines.search.single_claim import decide_existence

                    return decide_existence(claim, self.work)
                case Exists():
                    return self._drive(claim, claim.mode.by), NO_COST
                case OwnMode() as own:
                    return own.decide(claim), NO_COST
                case On(judge=judge):
                    return ClaimAnswer(claim, JudgedTrace(judge())), NO_COST
                case _:
                    assert_never(claim.mode)
        except BudgetExceeded as late:
            return undecided(claim, late.reason), NO_COST

    def _drive(self, claim: Claim, by: Means) -> ClaimAnswer:
        match by:
            case "search":
                further = self.again if self._is_vain(claim) else self.decide
                return self.follow(claim) or further(claim)
            case "known":
                return self.follow(claim) or undecided(claim, ReasonKind.NO_DRIVE())
            case "proof":
                proof = self._repeated(claim) or self._clash(claim, 1.0)
                return undecided(claim, ReasonKind.NO_PROOF()) if proof is None else ClaimAnswer(claim, proof)
            case _:
                assert_never(by)

    def follow(self, claim: Claim) -> ClaimAnswer | None:
        """Return an answer that follows from an earlier one, or None."""
        if not self.work.moves:
            road = claim.mode.road if isinstance(claim.mode, Exists) else None
            there = (x for x in reversed(self.drives) if road in (None, x.judged.file.road))
            shown = (x.here(claim) for x in there)
            drive = next((x for x in shown if x is not None), None)
            return None if drive is None else ClaimAnswer(claim, drive)
        mine = {without_names(part): part for part in parts_of(claim.formula)}
        for denied, _ in self.clashes:
            clashing = [without_names(part) for part in parts_of(_body(denied))]
            if all(part in mine for part in clashing):
                core = conjunction_of(claim.query, [mine[part] for part in clashing])
                proof = self._proof(claim, core, FOR_A_PART)
                if proof is not None:
                    return ClaimAnswer(claim, proof)
        recast = self._recast(claim, moved=False) if self.work.recast else None
        if recast is not None:
            return recast
        elsewhere = [x for x in self.drives if x.has_vehicles_of(claim)][-MOVED:]
        if self.work.zones:
            elsewhere = [*{repr(x.judged.file.drive): x for x in reversed(elsewhere)}.values()][::-1]
        for earlier in (*self.alike.get(without_sectors(claim.formula), ()), *elsewhere):
            shown_elsewhere = earlier.elsewhere(claim.query, claim, self.work.zones)
            if shown_elsewhere is not None:
                return ClaimAnswer(claim, shown_elsewhere)
        return None

    def _recast(self, claim: Claim, moved: bool) -> ClaimAnswer | None:
        """Return the answer that a known drive gives with its vehicles in other roles, the latest first.

        ``moved``: also on other roads, where those that differ in the road only are one.
        """
        latest = self.drives[::-1]
        if moved:
            latest = [*{repr(x.judged.file.drive): x for x in latest}.values()]
        recasts = (x.recast(claim, moved) for x in latest)
        return next((ClaimAnswer(claim, x) for x in recasts if x is not None), None)

    def _is_vain(self, claim: Claim) -> bool:
        return self.work.once and without_sectors(claim.formula) in self.vain

    def again(self, claim: Claim) -> ClaimAnswer:
        """Return an answer to a claim, where a drive of it or of one on other roads was not found before."""
        recast = self._recast(claim, moved=True) if self.work.recast else None
        return recast or undecided(claim, ReasonKind.NO_DRIVE_ELSEWHERE())

    def decide(self, claim: Claim) -> ClaimAnswer:
        """Return an answer: a proof first, which is quick where one exists, then a drive.

        Where a known trace satisfies the formula, no proof that it never holds exists.
        """
        if self.work.staged:
            from roadproof.engines.search.stages import search_in_stages

            return search_in_stages(claim, search_for_claim(claim, self.work, explain=False))
        wants_proof = self.work.disprove and (not isinstance(claim.mode, Exists) or claim.mode.explain)
        proof = self._clash(claim, 1.0) if wants_proof and not self._has_trace(claim) else None
        if proof is not None:
            return ClaimAnswer(claim, proof)
        from roadproof.engines.search.drive_search import search_drive
        from roadproof.engines.search.single_claim import answer_from_outcome

        outcome = search_drive(search_for_claim(claim, self.work, explain=False))
        is_open = not outcome.drives and outcome.verdict is not Verdict.IMPOSSIBLE
        drive = self._across_sectors(claim) if is_open else None
        if drive is not None:
            return ClaimAnswer(claim, drive)
        if self.work.explain and is_open:
            outcome = search_drive(search_for_claim(claim, self.work))
        return answer_from_outcome(claim, outcome, outcome.reason_with(("--horizon",)))

    def _repeated(self, claim: Claim) -> Certificate | None:
        """Return a known proof that parts of a claim clash, where these are parts of this one, too."""
        mine = {*parts_of(claim.formula)}
        read_alike = claim.home.set_name, dict(claim.home.options)
        for denied, proof in self.clashes:
            if (proof.set_name, dict(proof.options)) == read_alike and {*parts_of(_body(denied))} <= mine:
                return proof
        return None

    def _across_sectors(self, claim: Claim) -> JudgedDrive | None:
        """Return a drive that is found where road sectors do not count, on a road with all zones of a claim.

        No usual road has several zones.
        """
        if not isinstance(claim.mode, Exists) or claim.mode.road is not None:
            return None
        if len(zones_of(claim.formula)) < 2:
            return None
        from roadproof.engines.search.drive_search import search_drive

        free = conjunction_of(claim.query, [without_sectors(claim.formula)])
        outcome = search_drive(
            search_for_claim(replace(claim, formula=free.formula, query=free), self.work, explain=False)
        )
        drives = (self._known(x).elsewhere(claim.query, claim) for x in outcome.drives)
        return next((x for x in drives if x is not None), None)

    def _has_trace(self, claim: Claim) -> bool:
        never, bounds = negation(claim.query).formula, claim.home.library.bounds
        return any(fault_of(trace, never, bounds) is None for trace in self.traces[-TRACES:])

    def _clash(self, claim: Claim, times: float) -> Certificate | None:
        """Return a proof that parts of a claim clash, as few as are found."""
        from roadproof.engines.prove.induction import prove_via_opaque_driver
        from roadproof.engines.search.impossible import explain_impossibility

        effort = self.work.effort.with_units(times * self.work.proof)
        proof = prove_via_opaque_driver(claim.home, negation(claim.query), effort)
        shown = explain_impossibility(
            claim.home, claim.query, proof, self.work.effort.with_units(FOR_A_PART * self.work.proof)
        )
        return None if shown is None else shown.of_core

    def _proof(self, claim: Claim, core: Query, times: float) -> Certificate | None:
        """Return a proof that ``core`` never holds."""
        from roadproof.engines.prove.induction import prove_via_opaque_driver

        effort = self.work.effort.with_units(times * self.work.proof)
        return prove_via_opaque_driver(claim.home, negation(core), effort).certificate


def _body(denied: Formula) -> Formula:
    return denied.body if isinstance(denied, Not) else denied
