"""One search for a drive on a grid that fits its durations; and a pool of drives, judged on any claim.

Bounds of intervals have to be multiples of dt. For each question the coarsest dt that divides them is
taken; where that would be too fine, drives are looked for at coarser durations nearby and judged at the
exact ones.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil, floor
from typing import Any, Literal, TypeAlias

from roadproof.analysis.placing import as_data
from roadproof.analysis.requests import Request
from roadproof.effort import Late
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.judged import judge_file
from roadproof.judge.replay import first_overlap
from roadproof.logic.formula import Formula
from roadproof.logic.fragment import intervals_of
from roadproof.logic.terms import Parameter, leaves
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Library, Specification, load_library
from roadproof.verdict import Verdict
from roadproof.witness.ask import judge_found, telling_values
from roadproof.witness.grid import coarsest, common_step, durations
from roadproof.witness.question import Question
from roadproof.witness.search import Answer, find_witness, show_none

MOST_STEPS = 40  # beyond, searches seldom come to an end


# Natural drives; whatever the limits of the vehicles allow; that there is none.
Stage: TypeAlias = Literal["natural", "plain", "none"]
NATURAL_FIRST: tuple[Stage, ...] = ("natural", "plain", "none")
PLAIN_FIRST: tuple[Stage, ...] = ("plain", "none", "natural")


@dataclass(frozen=True)
class Task:
    """A search for a drive for ``request``, in stages that each have their own work limit."""

    request: Request
    stages: tuple[Stage, ...] = NATURAL_FIRST


@dataclass(frozen=True)
class Reply:
    """WITNESSED with a drive file's data, judged; NONE-WITHIN or UNKNOWN with a reason.

    ``drives`` are of other durations where there are none for the durations asked for; then the verdict
    is UNKNOWN.
    """

    verdict: Verdict
    reason: str
    drives: tuple[Mapping[str, Any], ...] = ()


def look(task: Task) -> Reply:
    """Go through the stages of a task until there is an answer; UNKNOWN where the clock cuts it off.

    Raises ``UsageError``, ``MissingSolverError``.
    """
    try:
        return _look(task)
    except Late as late:
        return Reply(Verdict.UNKNOWN, str(late))


def _look(task: Task) -> Reply:
    library = load_library(task.request.specs)
    specification = library.select(task.request.set_name, task.request.options)
    formula = read_claim(specification, task.request.what).formula
    fitting = fit_grid(task.request, formula)
    if fitting is not None:
        return _search(replace(task, request=fitting), library)
    drives: list[Mapping[str, Any]] = []
    for stand_in in stand_ins(task.request, formula):
        drives += _search(Task(stand_in, ("natural", "plain")), library).drives
    finest = float(_finest(task.request))
    reason = f"durations have no common step of {finest:g} s or more; no drive of coarser ones does"
    return Reply(Verdict.UNKNOWN, reason, tuple(drives))


def _search(task: Task, library: Library) -> Reply:
    request = task.request
    specification = library.select(request.set_name, request.options)
    halvings = floor(request.dt / _finest(request)).bit_length() - 1
    means = replace(request.means, explain=False, refinements=min(request.means.refinements, halvings))

    def reply(question: Question, answer: Answer) -> Reply:
        if answer.found is None:
            return Reply(answer.verdict, answer.reason)
        judged = judge_found(replace(request, count=1).search(), question, answer.found)
        return Reply(Verdict.WITNESSED, "", (judged.as_data(),))

    last = Reply(Verdict.UNKNOWN, "")
    for stage in task.stages:
        for horizon in _horizons(request, specification):
            asked = replace(request, natural=stage == "natural", horizon=horizon)
            question = asked.question()
            answer = (show_none if stage == "none" else find_witness)(question, means)
            last = reply(question, answer)
            if answer.found is None:
                break
            overlap = first_overlap(answer.found.drive, _clear(request, question.query.formula))
            if overlap is None or request.collisions:
                return last
            last = Reply(Verdict.UNKNOWN, f"on the drive that was found, {overlap}")
        if last.verdict is Verdict.NONE_WITHIN and horizon == request.horizon:
            return last
    return replace(last, verdict=Verdict.UNKNOWN)


def _horizons(request: Request, specification: Specification) -> tuple[Fraction, ...]:
    """The horizon of the request; then, where boxes overlap soon after it, a longer one."""
    clear = _clear(request, read_claim(specification, request.what).formula)
    longer = ceil(clear / request.dt) * request.dt
    return (request.horizon, longer) if longer / request.dt <= 2 * MOST_STEPS else (request.horizon,)


def _clear(request: Request, formula: Formula) -> Fraction:
    """Until when boxes stay apart: the horizon and, after it, the longest duration.

    So a danger that begins by then does not last because vehicles drive through each other.
    """
    return request.horizon + max(durations(formula, request.values), default=Fraction(0))


def fit_grid(request: Request, formula: Formula) -> Request | None:
    """The request on the coarsest grid, of at most its dt, that its durations are multiples of.

    The horizon grows to a multiple of dt. None where that grid would have more than ``MOST_STEPS``.
    """
    step = Fraction(0)
    for duration in durations(formula, request.values):
        step = common_step(step, duration)
    dt = coarsest(step, request.dt)
    if dt < _finest(request):
        return None
    return replace(request, dt=dt, horizon=ceil(request.horizon / dt) * dt)


def stand_ins(request: Request, formula: Formula) -> list[Request]:
    """The request with the parameters that are durations rounded up, and down, to half its dt.

    Raises ``UsageError`` where that does not make a grid either.
    """
    grain = request.dt / 2
    found: list[Request] = []
    for rounding in (ceil, floor):
        values = dict(request.values)
        for name in duration_parameters(formula):
            values[name] = rounding(values[name] / grain) * grain
        fitting = fit_grid(replace(request, values=values), formula)
        if fitting is None:
            raise UsageError(
                f"the intervals of the formula have no common step of {float(_finest(request)):g} s or "
                "more, whatever its parameters are: use bounds that are multiples of one time"
            )
        found.append(fitting)
    return found


def _finest(request: Request) -> Fraction:
    return min(request.dt, request.horizon / MOST_STEPS)


def duration_parameters(formula: Formula) -> tuple[str, ...]:
    """The parameters that bounds of intervals are made of, sorted."""
    terms = [t for x in intervals_of(formula) for t in (x.low, x.high) if t is not None]
    return tuple(sorted({leaf.name for t in terms for leaf in leaves(t) if isinstance(leaf, Parameter)}))


@dataclass(frozen=True)
class Claim:
    """What a drive has to show: ``text`` holds with ``values``, and boxes stay apart until ``clear`` (s)."""

    text: str
    values: Mapping[str, Fraction]
    clear: Fraction


@dataclass(frozen=True)
class Shown:
    """A judged drive file as plain data; ``number`` tells drives apart, from 1."""

    number: int
    data: Mapping[str, Any]


class Pool:
    """Drives that were found, each to be judged on any claim."""

    def __init__(self, library: Library) -> None:
        self.library = library
        self.files: list[DriveFile] = []
        self._last = 0

    def add(self, drives: Iterable[Mapping[str, Any]]) -> None:
        """Add drive files by their data."""
        for data in drives:
            self.files.append(read_drive(dict(data), "drive"))
            self._last = len(self.files) - 1

    def show(self, claim: Claim, since: int = 0) -> Shown | None:
        """A drive on which the claim holds, judged as a file; the last that did is tried first.

        ``since``: the first so many drives are left out.
        """
        order = sorted(range(since, len(self.files)), key=lambda k: (k != self._last, -k))
        for k in order:
            file = made_for(self.files[k], claim)
            ruling = judge_file(file, self.library)
            if ruling.accepted:
                self._last = k
                return Shown(k + 1, as_data(file, ruling))
        return None


def made_for(file: DriveFile, claim: Claim) -> DriveFile:
    """The same motions as a file that makes ``claim``."""
    return replace(
        file,
        scenario=None,
        formula=claim.text,
        values=dict(claim.values),
        horizon=max(file.horizon, claim.clear),
    )


def claim_of(request: Request, text: str, library: Library) -> Claim:
    """The claim ``text`` at the values of ``request``."""
    formula = read_claim(library.select(request.set_name, request.options), text).formula
    return Claim(text, telling_values(library, formula, request.values), _clear(request, formula))
