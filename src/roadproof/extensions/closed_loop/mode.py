"""The mode of claims about a vehicle under test: a search in closed loop answers them."""

import sys
from contextlib import redirect_stdout
from dataclasses import field
from typing import Literal, TypeAlias

from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.answer_files import Cause, UnknownReportData
from roadproof.evidence.claim import Claim, OwnMode
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.closed_loop.controllers.opening import ControllerSource, opened
from roadproof.extensions.closed_loop.isolation import isolated
from roadproof.extensions.closed_loop.search.problem import prevents
from roadproof.extensions.closed_loop.search.searching import FailureSearchOutcome, Searching
from roadproof.extensions.closed_loop.simulation import ControlLoop
from roadproof.extensions.closed_loop.simulations_file import PreventedFrom, SimulationPoint, SimulationsFile
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

Part: TypeAlias = Literal["simulations", "fails", "shown"]
_MOST = 4  # searches that are remembered
_known: dict[str, FailureSearchOutcome] = {}


@dataclass(frozen=True)
class ControllerSearch:
    """A search with the controller that it runs."""

    source: ControllerSource
    searching: Searching
    patience: float

    def run(self) -> FailureSearchOutcome:
        """Return the outcome of the search in this process; what a controller prints goes to stderr."""
        with (
            redirect_stdout(sys.stderr),
            opened(self.source, self.searching.seed, self.patience) as controller,
        ):
            return self.searching.run(ControlLoop(controller, self.patience))

    @staticmethod
    def lost(reason: Reason) -> FailureSearchOutcome:
        """Return the outcome where the process ended."""
        return FailureSearchOutcome(fault=f"it ended its process: {reason}")


@dataclass(frozen=True)
class ClosedLoop(OwnMode):
    """A search with a controller: for all simulations, a failing drive, or a drive that shows the target.

    ``key``: a digest of all that the search depends on.
    """

    part: Part
    key: str
    driven: ControllerSearch = field(compare=False, repr=False)

    def decide(self, claim: Claim) -> ClaimAnswer:
        """Return the answer to a claim; the claims of one search share its outcome."""
        outcome = self._outcome()
        match self.part:
            case "simulations":
                return ClaimAnswer(claim, self._file(claim, outcome))
            case "fails":
                drive = outcome.failing
                is_any = self.driven.searching.wanted == "any"
                if drive is not None and (is_any or prevents(outcome.decisions)):
                    return ClaimAnswer(claim, drive)
            case "shown":
                if outcome.shown is not None:
                    return ClaimAnswer(claim, outcome.shown)
        return undecided(claim, self._reason(outcome), report=_report(outcome))

    def verdict_of(self, evidence: object) -> Verdict | None:
        """Return WITNESSED for a drive; simulations alone show nothing."""
        if self.part == "simulations":
            return Verdict.UNKNOWN if isinstance(evidence, SimulationsFile) else None
        return Verdict.WITNESSED if isinstance(evidence, JudgedDrive) else None

    def _outcome(self) -> FailureSearchOutcome:
        if self.key not in _known:
            while len(_known) >= _MOST:
                del _known[next(iter(_known))]
            _known[self.key] = isolated(self.driven)
        return _known[self.key]

    def _file(self, claim: Claim, outcome: FailureSearchOutcome) -> SimulationsFile:
        problem, home = self.driven.searching.problem, claim.home
        knobs = [x.name for x in problem.shape.knobs]
        return SimulationsFile(
            set=home.set_name,
            options=dict(home.options),
            claim=claim.query.text,
            target=problem.name,
            key=self.key,
            count=outcome.count,
            first_failure=outcome.first_failure,
            first_preventable=outcome.first_preventable,
            reductions=outcome.reductions,
            nearest=round(outcome.nearest, 6) if outcome.count else None,
            values=dict(zip(knobs, outcome.failing_values, strict=False)),
            fault=outcome.fault,
            points=tuple(
                SimulationPoint(gap=x, faster=y, kind=kind)  # type: ignore[arg-type]
                for x, y, kind in outcome.points
            ),
            guide=problem.guide or "",
            boundary=tuple(PreventedFrom(gap=x, faster=y) for x, y in outcome.boundary),
        )

    def _reason(self, outcome: FailureSearchOutcome) -> Reason:
        if outcome.fault:
            return ReasonKind.CONTROLLER_FAILED(outcome.count, outcome.fault)
        if self.part == "fails" and outcome.failing is not None:
            return ReasonKind.NOT_PREVENTED(outcome.count)
        kind = ReasonKind.NO_FAILURE if self.part == "fails" else ReasonKind.SCENARIO_NOT_SHOWN
        return kind(outcome.count)


def _report(outcome: FailureSearchOutcome) -> UnknownReportData | None:
    if outcome.fault:
        return None
    return UnknownReportData(
        cause=Cause.WORK,
        tried=("drives",),
        effort_helps=False,
        remedy="raise --simulations",
        options=("--simulations",),
        without_assumptions=False,
        detail="",
    )
