"""One search for a drive on a grid that fits its durations; and a stock of drives, judged on any claim.

Bounds of intervals have to be multiples of dt. For each question the coarsest dt that divides them is
taken; where that would be too fine, drives are looked for at coarser durations nearby and judged at the
exact ones. Of formulas about one instant that no engine reads, a proof says that there is no drive.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil, floor
from typing import Literal, TypeAlias

from roadproof.analysis.explore.answer import Point, PointFinding
from roadproof.engines.encode.unroll import common_step
from roadproof.engines.prove.prover import prove
from roadproof.engines.search.ask import judge_found
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.question import COARSEST, SearchProblem, Setting, coarsest, durations, pose
from roadproof.engines.search.search import Attempt, find_witness, show_none
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, RejectedError
from roadproof.library.bind import telling_values, values_with
from roadproof.library.compose import negation
from roadproof.library.motion import Assumption, value_texts
from roadproof.library.specification import Library, Query
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import intervals_of, is_cubic_state, parameters_of
from roadproof.logic.terms import Parameter, leaves
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.budget import BudgetExceeded
from roadproof.semantics.exact.replay import first_overlap
from roadproof.verdict import DriveVerdict, Verdict

MOST_STEPS = 40  # beyond, searches seldom come to an end


# Natural drives; whatever the limits of the vehicles allow; that there is none.
Stage: TypeAlias = Literal["natural", "plain", "none"]
NATURAL_FIRST: tuple[Stage, ...] = ("natural", "plain", "none")
PLAIN_FIRST: tuple[Stage, ...] = ("plain", "none", "natural")


@dataclass(frozen=True)
class SearchTask:
    """A search for a drive, in stages that each have their own work limit; its dt is an upper bound."""

    search: Search
    stages: tuple[Stage, ...] = NATURAL_FIRST


@dataclass(frozen=True)
class Reply:
    """WITNESSED with a drive; NONE-WITHIN or UNKNOWN with a reason.

    ``drives`` are of other durations where there are none for the durations asked for; then the verdict
    is UNKNOWN. ``late``: cut off by the clock, or lost.
    """

    verdict: Verdict
    reason: Reason
    drives: tuple[JudgedDrive, ...] = ()
    late: bool = False


def missed(at: Point, query: Query, reply: Reply) -> PointFinding:
    """The answer where a search found no drive that is judged to do."""
    verdict: DriveVerdict = Verdict.UNKNOWN
    if reply.verdict is Verdict.NONE_WITHIN:
        verdict = Verdict.NONE_WITHIN
    reason = reply.reason or Why.FOUND_REJECTED()
    return PointFinding(at, query, verdict=verdict, reason=reason)


def look(task: SearchTask) -> Reply:
    """Go through the stages of a task until there is an answer; UNKNOWN where the clock cuts it off.

    Raises ``UsageError``, ``MissingSolverError``.
    """
    try:
        return _look(task)
    except BudgetExceeded as late:
        return undecided(task, late.reason)


def undecided(task: SearchTask, reason: Reason) -> Reply:
    """The reply to a search that nothing is known of."""
    return Reply(Verdict.UNKNOWN, reason, late=True)


def _look(task: SearchTask) -> Reply:
    fitting = fit_grid(task.search)
    if fitting is not None:
        return _search(replace(task, search=fitting))
    drives: list[JudgedDrive] = []
    for stand_in in stand_ins(task.search):
        drives += _search(SearchTask(stand_in, ("natural", "plain"))).drives
    finest = float(_finest(task.search.setting))
    return Reply(Verdict.UNKNOWN, Why.NO_COMMON_STEP(finest), tuple(drives))


def _search(task: SearchTask) -> Reply:
    search, setting = task.search, task.search.setting
    library = search.specification.library
    halvings = floor(dt_of(setting) / _finest(setting)).bit_length() - 1
    search_options = replace(
        search.search_options, explain=False, refinements=min(search.search_options.refinements, halvings)
    )

    def reply(question: SearchProblem, answer: Attempt) -> Reply:
        if answer.found is None:
            return Reply(answer.verdict, answer.reason)
        return Reply(Verdict.WITNESSED, NO_REASON, (judge_found(search, question, answer.found),))

    last = Reply(Verdict.UNKNOWN, NO_REASON)
    for stage in task.stages:
        for horizon in _horizons(search):
            asked = replace(setting, natural=stage == "natural", horizon=horizon)
            question = pose(library, search.query, asked)
            answer = (show_none if stage == "none" else find_witness)(question, search_options)
            last = reply(question, answer)
            if answer.found is None:
                break
            overlap = first_overlap(answer.found.drive, _clear(search))
            if overlap is None or setting.collisions:
                return last
            last = Reply(Verdict.UNKNOWN, Why.FOUND_OVERLAP(overlap))
        if last.verdict is Verdict.NONE_WITHIN and horizon == setting.horizon:
            return last
    return replace(last, verdict=Verdict.UNKNOWN)


def _horizons(search: Search) -> tuple[Fraction, ...]:
    """The horizon of the search; then, where boxes overlap soon after it, a longer one."""
    horizon, dt = search.setting.horizon, dt_of(search.setting)
    longer = ceil(_clear(search) / dt) * dt
    return (horizon, longer) if longer / dt <= 2 * MOST_STEPS else (horizon,)


def _clear(search: Search) -> Fraction:
    """Until when boxes stay apart: the horizon and, after it, the longest duration.

    So a danger that begins by then does not last because vehicles drive through each other.
    """
    return search.setting.horizon + max(_durations(search), default=Fraction(0))


def _durations(search: Search) -> set[Fraction]:
    return durations(search.query.formula, values_of(search))


def values_of(search: Search) -> dict[str, Fraction]:
    """The value of every parameter."""
    return values_with(search.specification.library, search.setting.values)


def fit_grid(search: Search) -> Search | None:
    """The search on the coarsest grid, of at most its dt, that its durations are multiples of.

    The horizon grows to a multiple of dt. None where that grid would have more than ``MOST_STEPS``.
    """
    step = Fraction(0)
    for duration in _durations(search):
        step = common_step(step, duration)
    setting = search.setting
    dt = coarsest(step, dt_of(setting))
    if dt < _finest(setting):
        return None
    return replace(search, setting=replace(setting, dt=dt, horizon=ceil(setting.horizon / dt) * dt))


def stand_ins(search: Search) -> list[Search]:
    """The search with the parameters that are durations rounded up, and down, to half its dt.

    Raises ``UsageError`` where that does not make a grid either.
    """
    grain = dt_of(search.setting) / 2
    found: list[Search] = []
    for rounding in (ceil, floor):
        values = values_of(search)
        for name in duration_parameters(search.query.formula):
            values[name] = rounding(values[name] / grain) * grain
        fitting = fit_grid(replace(search, setting=replace(search.setting, values=values)))
        if fitting is None:
            raise UsageError(
                f"the intervals of the formula have no common step of {float(_finest(search.setting)):g} s "
                "or more, whatever its parameters are: use bounds that are multiples of one time"
            )
        found.append(fitting)
    return found


def dt_of(setting: Setting) -> Fraction:
    """The coarsest step that may be taken, in s."""
    return setting.dt or COARSEST


def _finest(setting: Setting) -> Fraction:
    return min(dt_of(setting), setting.horizon / MOST_STEPS)


def duration_parameters(formula: Formula) -> tuple[str, ...]:
    """The parameters that bounds of intervals are made of, sorted."""
    terms = [t for x in intervals_of(formula) for t in (x.low, x.high) if t is not None]
    return tuple(sorted({leaf.name for t in terms for leaf in leaves(t) if isinstance(leaf, Parameter)}))


@dataclass(frozen=True)
class DriveClaim:
    """What a drive has to show: ``query`` holds with ``values``, and boxes stay apart until ``clear`` (s)."""

    query: Query
    values: Mapping[str, Fraction]
    clear: Fraction


@dataclass(frozen=True)
class Shown:
    """A drive on which a claim holds; ``number`` tells drives apart, from 1."""

    number: int
    drive: JudgedDrive


class Stock:
    """Drives that were found, each to be judged on any claim."""

    def __init__(self, library: Library) -> None:
        self.library = library
        self.files: list[DriveFile] = []
        self._last = 0

    def add(self, drives: Iterable[JudgedDrive]) -> None:
        """Add drives; the last of them is the first to be tried."""
        for judged in drives:
            self.files.append(judged.file)
            self._last = len(self.files) - 1

    def show(self, claim: DriveClaim, since: int = 0) -> Shown | None:
        """A drive on which the claim holds, judged as a file; the last that did is tried first.

        ``since``: the first so many drives are left out.
        """
        order = sorted(range(since, len(self.files)), key=lambda k: (k != self._last, -k))
        for k in order:
            try:
                judged = JudgedDrive(made_for(self.files[k], claim), self.library)
            except RejectedError:
                continue
            self._last = k
            return Shown(k + 1, judged)
        return None


def made_for(file: DriveFile, claim: DriveClaim) -> DriveFile:
    """The same motions as a file that makes ``claim``."""
    return replace(
        file,
        scenario=None,
        formula=claim.query.text,
        values=dict(claim.values),
        horizon=max(file.horizon, claim.clear),
    )


def claim_of(search: Search, query: Query) -> DriveClaim:
    """The claim ``query`` at the values of ``search``."""
    there = replace(search, query=query)
    values = telling_values(search.specification.library, query.formula, values_of(search))
    return DriveClaim(query, values, _clear(there))


def stages_for(search: Search, stages: tuple[Stage, ...]) -> tuple[Stage, ...]:
    """``stages`` without the last word of an engine, for formulas that have a proof in place of it."""
    hard = is_cubic_state(search.query.formula)
    return tuple(x for x in stages if x != "none") if hard else stages


def never(search: Search, at: Point, query: Query, units: float) -> PointFinding | None:
    """A proof that ``query`` holds in no state with the parameters at the values of ``search``.

    Wherever, however fast and how near vehicles are: it needs no limits. None where none is found with
    ``units`` of work, and for formulas of other kinds. Raises ``BudgetExceeded``.
    """
    if not is_cubic_state(query.formula):
        return None
    values = values_of(search)
    there = {name: values[name] for name in parameters_of(query.formula)}
    said = value_texts(search.specification, there)
    effort = search.search_options.effort.of(units)
    proof = prove(search.specification, negation(query), effort, assumed=Assumption(said)).certificate
    return (
        None
        if proof is None
        else PointFinding(
            at, query, verdict=Verdict.IMPOSSIBLE, reason=Why.PROVED_STATES(), certificate=proof
        )
    )
