"""Why a claim ends UNKNOWN: an enumeration of causes, each with the options that help, if any are known to.

The prover says where it stopped (``Stop``). Together with the form of the claim this tells the cause: some
forms need a kind of reasoning that the prover does not have, so that more work is in vain.
"""

from collections.abc import Mapping, Sequence
from enum import StrEnum

from roadproof.evidence.answers import doubt as kept
from roadproof.evidence.answers.doubt import Cause as Cause
from roadproof.library.motion import is_moving
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import signals_of
from roadproof.runtime.budget import Effort, backstop
from roadproof.runtime.records import dataclass
from roadproof.world.signals import SIGNALS

# Below so many units of work nothing is concluded from the form of a claim: more work comes first.
ENOUGH = 5.0


class Stop(StrEnum):
    """Where a search for a proof and for a counterexample stopped."""

    WORK = "work"
    CLOCK = "clock"
    PROCESS = "process"
    SOLVER = "solver"
    ROUNDS = "rounds"
    LANES = "lanes"
    PLACE = "place"
    FACTS = "facts"
    CERTIFICATE = "certificate"


# Each cause as a clause.
_WORDS: Mapping[Cause, str] = {
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
    Cause.SECOND_ORDER: "the claim relates positions to accelerations beyond the facts of second order",
}
NO_REMEDY = "no option is known that does"
# How much more work, or time, is asked for.
_MORE = 4


# What was tried, in the order of trial, with its words.
_TRIES: Mapping[kept.Tried, str] = {"proof": "a proof", "traces": "traces", "drives": "drives"}


@dataclass(frozen=True)
class Remedy:
    """What helps a claim, as an imperative, and the ``options`` of the command that follow it.

    ``without_assumptions``: the claim is then asked without what it is assumed under.
    """

    told: str
    options: tuple[str, ...]
    without_assumptions: bool = False


@dataclass(frozen=True)
class Doubt:
    """Why a claim ends UNKNOWN. ``units``: the work limit; ``detail``: what a solver said, or empty.

    ``seconds``: after which the clock ends the search. ``option``: what helps this very claim where more work
    does not; None where nothing is known to.
    """

    cause: Cause
    tried: tuple[kept.Tried, ...]
    units: float
    detail: str = ""
    option: Remedy | None = None
    seconds: float = 600.0

    @property
    def effort_helps(self) -> bool:
        """Whether more work can change the answer."""
        return self.cause in (Cause.WORK, Cause.CLOCK, Cause.PROCESS)

    @property
    def remedy(self) -> Remedy | None:
        """What helps; more work, more time or less company where that can help."""
        match self.cause:
            case Cause.WORK:
                more = ("--effort", f"{self.units * _MORE:g}")
                return Remedy(f"raise --effort (now {self.units:g})", more)
            case Cause.CLOCK:
                more = ("--timeout", f"{self.seconds * _MORE:g}")
                return Remedy("raise --timeout, or ask on an idle machine", more)
            case Cause.PROCESS:
                return Remedy("ask this claim alone, with --jobs 1", ("--jobs", "1"))
            case _:
                return self.option

    @property
    def kept(self) -> kept.Doubt:
        """As the answer has it."""
        remedy = self.remedy or Remedy("", ())
        return kept.Doubt(
            cause=self.cause,
            tried=self.tried,
            effort_helps=self.effort_helps,
            remedy=remedy.told,
            options=remedy.options,
            without_assumptions=remedy.without_assumptions,
            detail=self.detail,
        )

    def __str__(self) -> str:
        if self.cause is Cause.WORK:
            said = f"no answer within {self.units:g} units of work"
        elif self.cause in (Cause.CLOCK, Cause.PROCESS):
            return self.detail
        else:
            said = _WORDS[self.cause] + (f" ({self.detail})" if self.detail else "")
        tried = ", ".join(_TRIES[x] for x in self.tried)
        told = f"{said}; tried: {tried}; more work {'may help' if self.effort_helps else 'does not help'}"
        return f"{told}, and {NO_REMEDY}" if self.remedy is None else f"{told}: {self.remedy.told}"


def doubt_of(
    query: Query, said: Sequence[str], stop: Stop, effort: Effort, seek_drive: bool, detail: str = ""
) -> Doubt:
    """Why ``query``, asked under what is ``said``, ends UNKNOWN where the search stopped at ``stop``."""
    moving = is_moving(said)
    done = {"proof": True, "traces": not moving, "drives": seek_drive}
    tried = tuple(x for x in _TRIES if done[x])
    cause = _cause(query.formula, said, stop, effort.units)
    kept = cause in (Cause.CLOCK, Cause.PROCESS, Cause.SOLVER, Cause.CERTIFICATE)
    seconds = backstop(effort.units) if effort.timeout is None else effort.timeout
    return Doubt(cause, tried, effort.units, detail if kept else "", seconds=seconds)


def _cause(claim: Formula, said: Sequence[str], stop: Stop, units: float) -> Cause:
    if stop not in (Stop.WORK, Stop.ROUNDS, Stop.PLACE, Stop.FACTS):
        return Cause(stop)
    if stop is Stop.WORK and units < ENOUGH:
        return Cause.WORK
    endless = set(_chains(claim, False, False))
    if endless:
        return Cause.INDUCTION if True in endless else Cause.ALTERNATION
    if is_moving(said) and _is_of_second_order(claim, said):
        return Cause.SECOND_ORDER
    if not is_moving(said) and stop is not Stop.PLACE and _has_until(claim, True):
        return Cause.FIRST_INSTANT
    return Cause.WORK if stop is Stop.ROUNDS else Cause(stop)


def _chains(formula: Formula, wanted: bool, forever: bool) -> list[bool]:
    """Of each "at some time" that has to hold at all times: whether its time is bounded.

    ``wanted``: whether the formula is to be true; ``forever``: whether at all times without end.
    """
    match formula:
        case f.Not(body):
            return _chains(body, not wanted, forever)
        case f.Eventually(interval, body) | f.Always(interval, body):
            lasts = isinstance(formula, f.Always) == wanted
            endless = interval.high is None
            here = [not endless] if forever and not lasts else []
            return here + _chains(body, wanted, forever or (lasts and endless))
        case f.Until(left, interval, right):
            here = [interval.high is not None] if forever and wanted else []
            inner = forever or interval.high is None
            later = forever if wanted else inner
            return here + _chains(left, wanted, inner) + _chains(right, wanted, later)
        case _:
            return [x for part in f.children(formula) for x in _chains(part, wanted, forever)]


def _has_until(formula: Formula, claimed: bool) -> bool:
    """Whether an until is claimed, not supposed."""
    match formula:
        case f.Not(body):
            return _has_until(body, not claimed)
        case f.Until():
            return claimed or any(_has_until(x, claimed) for x in f.children(formula))
        case _:
            return any(_has_until(x, claimed) for x in f.children(formula))


def _is_of_second_order(claim: Formula, said: Sequence[str]) -> bool:
    """Whether a position is spoken of, and the acceleration in the same direction."""
    spoken = {*signals_of([claim])}
    rates = {x: about.rate_of for x, about in SIGNALS.items() if about.rate_of is not None}
    second = {x: rates.get(y) for x, y in rates.items()}
    return any(
        place in spoken and (x in spoken or any(limit.startswith(f"{x}(") for limit in said))
        for x, place in second.items()
        if place is not None
    )
