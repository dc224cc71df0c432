"""The mode of claims about a drive in which a controller drives in place of a recorded vehicle."""

import sys
from contextlib import redirect_stdout
from dataclasses import field
from typing import Literal, TypeAlias

from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.claim import Claim, OwnMode
from roadproof.evidence.judged import JudgedDrive, RejectedError
from roadproof.extensions.closed_loop.controllers.opening import ControllerSource, opened
from roadproof.extensions.closed_loop.errors import ControllerError
from roadproof.extensions.closed_loop.isolation import isolated
from roadproof.extensions.closed_loop.simulation import ControlLoop, driven_file, exact_drive
from roadproof.extensions.closed_loop.situation import TrafficSituation
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive

RequirementPart: TypeAlias = Literal["breaks", "keeps"]
_MOST = 4  # drives that are remembered
_known: dict[str, "DrivenOccurrence"] = {}


@dataclass(frozen=True)
class DrivenOccurrence:
    """The drive of a controller in a recorded situation; None with the ``fault`` where there is none."""

    drive: Drive | None = None
    fault: str = ""


@dataclass(frozen=True)
class RecordedRun:
    """A simulation of a recorded situation with the controller that it runs."""

    source: ControllerSource
    situation: TrafficSituation
    patience: float

    def run(self) -> DrivenOccurrence:
        """Return the drive, made in this process; what a controller prints goes to stderr."""
        with redirect_stdout(sys.stderr):
            try:
                with opened(self.source, 0, self.patience) as controller:
                    return DrivenOccurrence(
                        exact_drive(ControlLoop(controller, self.patience), self.situation)
                    )
            except ControllerError as error:
                return DrivenOccurrence(fault=str(error))

    @staticmethod
    def lost(reason: Reason) -> DrivenOccurrence:
        """Return what a process that ended leaves behind."""
        return DrivenOccurrence(fault=f"it ended its process: {reason}")


@dataclass(frozen=True)
class Resimulation(OwnMode):
    """One simulation of a recorded situation.

    ``key``: a digest of all that the drive depends on. ``driven`` is None in a question about stored answers.
    """

    part: RequirementPart
    key: str
    driven: RecordedRun | None = field(compare=False, repr=False)

    def decide(self, claim: Claim) -> ClaimAnswer:
        """Return the judged drive of a claim; the claims of one occurrence share it."""
        assert self.driven is not None
        outcome = self._outcome(self.driven)
        if outcome.drive is None:
            return undecided(claim, ReasonKind.CONTROLLER_GAVE_NO_DRIVE(outcome.fault))
        file = driven_file(self.driven.situation, claim, outcome.drive, may_overlap=True)
        try:
            return ClaimAnswer(claim, JudgedDrive(file, claim.home.library))
        except RejectedError as error:
            return undecided(claim, ReasonKind.TOLD(error))

    def verdict_of(self, evidence: object) -> Verdict | None:
        """Return WITNESSED for a drive."""
        return Verdict.WITNESSED if isinstance(evidence, JudgedDrive) else None

    def _outcome(self, driven: RecordedRun) -> DrivenOccurrence:
        if self.key not in _known:
            while len(_known) >= _MOST:
                del _known[next(iter(_known))]
            _known[self.key] = isolated(driven)
        return _known[self.key]
