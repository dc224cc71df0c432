"""Explains UNKNOWN verdicts: an enumeration of causes, each with the options known to help.

The prover reports where it stopped (``StopPoint``). Together with the form of the claim this gives the
cause: some forms need a kind of reasoning that the prover lacks, so more work is in vain.
"""

from collections.abc import Mapping, Sequence
from enum import StrEnum

from roadproof.evidence.answer_files import Cause as Cause
from roadproof.evidence.answer_files import Tried, UnknownReportData
from roadproof.library.assumption import assumes_motion
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import signals_of
from roadproof.runtime.budget import Effort, backstop
from roadproof.runtime.records import dataclass
from roadproof.world.signals import SIGNALS

# Below so many units of work nothing is concluded from the form of a claim: more work comes first.
ENOUGH = 5.0


class StopPoint(StrEnum):
    """The point where a search for a proof and for a counterexample stopped."""

    WORK = "work"
    CLOCK = "clock"
    PROCESS = "process"
    SOLVER = "solver"
    ROUNDS = "rounds"
    LANES = "lanes"
    PLACE = "place"
    FACTS = "facts"
    CERTIFICATE = "certificate"
    PAST = "past"


# Each cause as a clause.
_CLAUSES: Mapping[Cause, str] = {
    Cause.WORK: "the work limit ended the search",
    Cause.CLOCK: "the clock ended the search",
    Cause.PROCESS: "the process of this claim ended",
    Cause.SOLVER: "z3 could not decide the arithmetic",
    Cause.PLACE: "candidate counterexamples were found, but none could be placed on a road",
    Cause.FACTS: "the facts about motion give no proof, and no drive was found that refutes the claim",
    Cause.CERTIFICATE: "a proof was found, but its certificate could not be confirmed",
    Cause.LANES: "the claim asks for more and more lanes and lanelets",
    Cause.INDUCTION: (
        "the claim repeats a step of bounded time for ever; the prover has no induction that fits it"
    ),
    Cause.ALTERNATION: "a counterexample would have to change infinitely often; none was found",
    Cause.FIRST_INSTANT: (
        "the claim asks for a first instant of what it compares, and signals that jump need not have one"
    ),
    Cause.PAST: "the claim looks back with O, H or S, for which proofs have no rules",
    Cause.SECOND_ORDER: "the claim relates positions to accelerations beyond the facts of second order",
}
NO_REMEDY = "no option is known that does"
# How much more work, or time, is asked for.
_MORE_BY = 4


# What was tried, in the order of trial, with its words.
_ATTEMPTS: Mapping[Tried, str] = {"proof": "a proof", "traces": "traces", "drives": "drives"}


@dataclass(frozen=True)
class Remedy:
    """An instruction that helps a claim, and the command ``options`` for it.

    ``without_assumptions``: the claim is then decided without its assumptions.
    """

    text: str
    options: tuple[str, ...]
    without_assumptions: bool = False


@dataclass(frozen=True)
class UnknownReport:
    """The reasons for an UNKNOWN verdict: cause, attempts, limits and a remedy.

    ``units``: the work limit; ``seconds``: the clock limit; ``detail``: text of a solver, or empty.
    ``option``: a remedy for this claim where more work does not help; None where none is known.
    """

    cause: Cause
    tried: tuple[Tried, ...]
    units: float
    detail: str = ""
    option: Remedy | None = None
    seconds: float = 600.0

    @property
    def effort_helps(self) -> bool:
        """Return whether more work can change the answer."""
        return self.cause in (Cause.WORK, Cause.CLOCK, Cause.PROCESS)

    @property
    def remedy(self) -> Remedy | None:
        """The remedy: more work, more time or fewer processes where that can help, else ``option``."""
        match self.cause:
            case Cause.WORK:
                more = ("--effort", f"{self.units * _MORE_BY:g}")
                return Remedy(f"raise --effort (now {self.units:g})", more)
            case Cause.CLOCK:
                more = ("--timeout", f"{self.seconds * _MORE_BY:g}")
                return Remedy("raise --timeout, or ask on an idle machine", more)
            case Cause.PROCESS:
                return Remedy("ask this claim alone, with --jobs 1", ("--jobs", "1"))
            case Cause.SOLVER | Cause.PLACE | Cause.FACTS | Cause.CERTIFICATE | Cause.LANES | Cause.INDUCTION:
                return self.option
            case Cause.ALTERNATION | Cause.FIRST_INSTANT | Cause.SECOND_ORDER | Cause.PAST:
                return self.option

    @property
    def data(self) -> UnknownReportData:
        """The report as the data of an answer."""
        remedy = self.remedy or Remedy("", ())
        return UnknownReportData(
            cause=self.cause,
            tried=self.tried,
            effort_helps=self.effort_helps,
            remedy=remedy.text,
            options=remedy.options,
            without_assumptions=remedy.without_assumptions,
            detail=self.detail,
        )

    def __str__(self) -> str:
        if self.cause is Cause.WORK:
            assumed = f"no answer within {self.units:g} units of work"
        elif self.cause in (Cause.CLOCK, Cause.PROCESS):
            return self.detail
        else:
            assumed = _CLAUSES[self.cause] + (f" ({self.detail})" if self.detail else "")
        tried = f"tried: {', '.join(_ATTEMPTS[x] for x in self.tried)}; " if self.tried else ""
        message = f"{assumed}; {tried}more work {'may help' if self.effort_helps else 'does not help'}"
        return f"{message}, and {NO_REMEDY}" if self.remedy is None else f"{message}: {self.remedy.text}"


def unknown_report(
    query: Query, assumed: Sequence[str], stop: StopPoint, effort: Effort, seek_drive: bool, detail: str = ""
) -> UnknownReport:
    """Return why ``query`` ends UNKNOWN under ``assumed`` when the search stopped at ``stop``."""
    readable = stop is not StopPoint.PAST
    done = {"proof": readable, "traces": readable and not assumes_motion(assumed), "drives": seek_drive}
    tried = tuple(x for x in _ATTEMPTS if done[x])
    cause = _cause(query.formula, assumed, stop, effort.units)
    has_detail = cause in (Cause.CLOCK, Cause.PROCESS, Cause.SOLVER, Cause.CERTIFICATE)
    seconds = backstop(effort.units) if effort.timeout is None else effort.timeout
    return UnknownReport(cause, tried, effort.units, detail if has_detail else "", seconds=seconds)


def _cause(claim: Formula, assumed: Sequence[str], stop: StopPoint, units: float) -> Cause:
    if stop not in (StopPoint.WORK, StopPoint.ROUNDS, StopPoint.PLACE, StopPoint.FACTS):
        return Cause(stop)
    if stop is StopPoint.WORK and units < ENOUGH:
        return Cause.WORK
    endless = set(_repeated_eventualities(claim, False, False))
    if endless:
        return Cause.INDUCTION if True in endless else Cause.ALTERNATION
    if assumes_motion(assumed) and _is_of_second_order(claim, assumed):
        return Cause.SECOND_ORDER
    if not assumes_motion(assumed) and stop is not StopPoint.PLACE and _has_until(claim, True):
        return Cause.FIRST_INSTANT
    return Cause.WORK if stop is StopPoint.ROUNDS else Cause(stop)


def _repeated_eventualities(formula: Formula, positive: bool, forever: bool) -> list[bool]:
    """Return, for each "at some time" that must hold at all times, whether its window is bounded.

    ``positive``: whether the formula is to be true; ``forever``: whether at all times without end.
    """
    match formula:
        case f.Not(body):
            return _repeated_eventualities(body, not positive, forever)
        case f.Eventually(interval, body) | f.Always(interval, body):
            lasts = isinstance(formula, f.Always) == positive
            endless = interval.high is None
            here = [not endless] if forever and not lasts else []
            return here + _repeated_eventualities(body, positive, forever or (lasts and endless))
        case f.Until(left, interval, right):
            here = [interval.high is not None] if forever and positive else []
            inner = forever or interval.high is None
            later = forever if positive else inner
            return (
                here
                + _repeated_eventualities(left, positive, inner)
                + _repeated_eventualities(right, positive, later)
            )
        case f.And() | f.Or() | f.Application() | f.Some() | f.Every() | f.Since():
            return [
                x for part in f.children(formula) for x in _repeated_eventualities(part, positive, forever)
            ]
        case f.Truth() | f.Compare() | f.Occupies():
            return []


def _has_until(formula: Formula, claimed: bool) -> bool:
    """Return whether an until is claimed rather than supposed."""
    match formula:
        case f.Not(body):
            return _has_until(body, not claimed)
        case f.Until():
            return claimed or any(_has_until(x, claimed) for x in f.children(formula))
        case f.And() | f.Or() | f.Application() | f.Some() | f.Every():
            return any(_has_until(x, claimed) for x in f.children(formula))
        case f.Eventually() | f.Always() | f.Since():
            return any(_has_until(x, claimed) for x in f.children(formula))
        case f.Truth() | f.Compare() | f.Occupies():
            return False


def _is_of_second_order(claim: Formula, assumed: Sequence[str]) -> bool:
    """Return whether the claim has a position and the acceleration in the same direction."""
    spoken = {*signals_of([claim])}
    rates = {x: about.rate_of for x, about in SIGNALS.items() if about.rate_of is not None}
    second = {x: rates.get(y) for x, y in rates.items()}
    return any(
        place in spoken and (x in spoken or any(limit.startswith(f"{x}(") for limit in assumed))
        for x, place in second.items()
        if place is not None
    )
