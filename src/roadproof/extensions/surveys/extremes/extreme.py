"""The search for the least or greatest value of a term on drives of a formula, in a bracket.

One side is a judged drive that reaches its value. The other side is the nearest value without a drive, with
the reason. No optimum is claimed.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

from roadproof.engines.encode.shift_invariance import depends_on_place
from roadproof.engines.search.batches import Engines
from roadproof.engines.search.known_drive import file_for_claim
from roadproof.engines.search.question import pose
from roadproof.engines.setting import Search
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.extensions.surveys.composition import with_parts
from roadproof.extensions.surveys.extremes.bracket import Bracket, range_of, starting_ranges
from roadproof.extensions.surveys.extremes.measure import DriveMeasure
from roadproof.extensions.surveys.extremes.points import (
    ClaimGenerator,
    JudgementCache,
    Point,
    PointFinding,
    Points,
    T,
)
from roadproof.extensions.surveys.staged import dt_of, staged_claim, values_of
from roadproof.library.bind import bind
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.rewrite import is_cubic_state
from roadproof.logic.terms import Term, number
from roadproof.runtime.budget import Work
from roadproof.semantics.exact.signals import DriveSignals, TermPieces
from roadproof.verdict import Verdict
from roadproof.world.road import Road

MOST_SEARCHES = 24
GRAIN = Fraction(1, 1000)  # of values at a moment, which are found by halving
WITHOUT_END = Fraction(10**6)
PRECISION = Fraction(1, 10)  # of a measure, where none is given
PROOF = 5.0  # units of work for a proof that there is no drive


@dataclass(frozen=True)
class Extreme:
    """An extreme of ``measure`` at a ``point`` of the variables.

    ``best``: a judged drive that reaches ``best.at``; None if there is no drive. ``outside``: the nearest
    value without a drive. ``excluded``: the nearest value at which drives are excluded. ``endless``: the
    drive passes any value.
    """

    measure: DriveMeasure
    point: Point
    best: PointFinding | None
    outside: PointFinding | None
    excluded: PointFinding | None
    searches: int
    endless: bool = False


@dataclass(frozen=True)
class ExtremeQuestion:
    """The question for an extreme on drives of ``search`` at a point; ``name``: that of its claims.

    ``limits``: conditions on drives at the point. ``precision``: the width of a bracket.
    """

    name: str
    search: Search
    measure: DriveMeasure
    precision: Fraction = PRECISION
    point: Point = ()
    limits: tuple[Query, ...] = ()

    def at(self, value: Fraction | None) -> Search:
        """Return the search with the measure at ``value`` or better, and limits stated."""
        parts = [*self.limits, *self.measure.bound(value)]
        return replace(self.search, query=with_parts(self.search.query, parts))


class ExtremeSearch:
    """A search that leaps from drive to drive, then halves, until the bracket is narrow."""

    def __init__(self, question: ExtremeQuestion, points: Points) -> None:
        self.question = question
        self.points = points
        self.measure = question.measure
        self.library = question.search.specification.library
        self.is_hard = is_cubic_state(question.search.query.formula)
        self.steps = 0

    def run(self, drives: Iterable[JudgedDrive] = ()) -> ClaimGenerator[Extreme]:
        """Return the extreme; ``drives`` may serve. Raises ``InputError``, ``UsageError``."""
        before = self.points.searches
        first = self.best_of(drives)
        if first is None:
            start = yield from self._begin()
            if not isinstance(start, Fraction):
                extreme = Extreme(
                    self.measure,
                    self.question.point,
                    None,
                    start,
                    start if start.verdict is Verdict.IMPOSSIBLE else None,
                    self.points.searches - before,
                )
                return extreme
            first = start
        bracket = Bracket(self.measure.sign, self.question.precision, first, self.range_end)
        if not self.is_hard and first * self.measure.sign > 0:
            zero = yield from self.impossible("zero", Fraction(0))
            if zero is not None:
                bracket.miss(zero)
        while self.steps < MOST_SEARCHES - 1 and not bracket.narrow and not _is_endless(bracket):
            yield from self._narrow(bracket)
        return (yield from self._result(bracket, before))

    def _begin(self) -> ClaimGenerator[Fraction | PointFinding]:
        """Return the value of a first drive, or why there is none."""
        name, search = f"{self.question.name}-first", self.question.at(None)
        if not self.is_hard:
            proved = yield from self.points.proved(f"{self.question.name}-any", (), search, "time")
            if proved is not None:
                return proved
        finding = yield from self.points.find(name, (), search)
        value = None if finding.drive is None else self.best_of([finding.drive])
        return finding if value is None else value

    def _narrow(self, bracket: Bracket) -> ClaimGenerator[None]:
        """Ask for one more value."""
        value = bracket.next()
        self.steps += 1
        name = f"{self.question.name}-{self.steps:02}"
        finding = yield from self.points.find(name, (value,), self.question.at(value), natural=False)
        reached = None if finding.drive is None else self.best_of([finding.drive])
        if reached is not None and bracket.reached(reached, value):
            bracket.hold(reached)
            return
        if self.is_hard and finding.verdict is not Verdict.IMPOSSIBLE:
            finding = (yield from self.impossible(f"{self.steps:02}-no", value)) or finding
        bracket.miss(finding)

    def _result(self, bracket: Bracket, before: int) -> ClaimGenerator[Extreme]:
        outside, excluded = bracket.outside, bracket.excluded
        if _is_endless(bracket):
            outside = excluded = None
        elif outside is not None and outside.certificate is None:
            proved = yield from self.impossible("beyond", outside.at[0])
            outside, excluded = (proved, proved) if proved is not None else (outside, excluded)
        name, value = f"{self.question.name}-best", bracket.best
        best = yield from self.points.again(name, (value,), self.question.at(value))
        searches = self.points.searches - before
        return Extreme(
            self.measure, self.question.point, best, outside, excluded, searches, _is_endless(bracket)
        )

    def impossible(self, name: str, value: Fraction) -> ClaimGenerator[PointFinding | None]:
        """Ask for a proof that no drive, of any kind, reaches ``value``."""
        search = self.question.at(value)
        return (yield from self.points.proved(f"{self.question.name}-{name}", (value,), search, "time"))

    @cached_property
    def range_end(self) -> Fraction | None:
        """The best value that any drive could start with, if known."""
        if self.measure.when:
            return None
        # Only the start counts here, for which any grid does.
        setting = self.question.search.setting
        dt = dt_of(setting)
        question = pose(self.library, self.question.search.query, replace(setting, horizon=dt, dt=dt))
        try:
            term = self.bound_term(question.road, {})
            if depends_on_place(f.Compare(term, ">", number(0)), question.vehicles):
                return None
            low, high = range_of(term, starting_ranges(question))
        except (ValueError, KeyError):
            return None
        return low if self.measure.sense == "least" else high

    def best_of(self, drives: Iterable[JudgedDrive]) -> Fraction | None:
        """Return the best value that one of the drives reaches; None if none of them shows the formula."""
        values = (self._value(self.points.number(x)) for x in drives)
        return min((x for x in values if x is not None), key=lambda x: x * self.measure.sign, default=None)

    def _value(self, number: int) -> Fraction | None:
        """Return the value that the drive of a number reaches, or None."""
        drive = self.points.drives[number - 1].judged
        key = self.question.name, number
        return self.points.remembered.of(key, drive, lambda: self._work_out(drive))

    def _work_out(self, drive: JudgedDrive) -> Fraction | None:
        value = self.at_moment(drive.file) if self.measure.when else self.at_start(drive.file)
        return value if value is not None and self.reaches(drive.file, value) else None

    def at_start(self, file: DriveFile) -> Fraction:
        """Return the measure at time 0, exactly."""
        term = self.bound_term(file.road, file.lanes)
        _, course = TermPieces(DriveSignals(file.drive)).of(term)[0]
        return Fraction(course.numerators[0], course.denominator) if course.numerators else Fraction(0)

    def bound_term(self, road: Road, lanes: Mapping[str, str]) -> Term:
        """Return the term with values for its parameters."""
        here = f.Compare(self.measure.term, "<=", number(0))
        compare = bind(here, road, lanes, values_of(self.question.search))
        assert isinstance(compare, f.Compare)
        return compare.left

    def at_moment(self, file: DriveFile) -> Fraction | None:
        """Return the best multiple of ``GRAIN`` that the measure reaches while ``when`` holds."""
        sign = self.measure.sign
        far, step = Fraction(0), Fraction(1)
        if self.reaches(file, far):
            reached = far
            while self.reaches(file, reached - sign * step):
                reached -= sign * step
                step *= 2
                if abs(reached) >= WITHOUT_END:
                    return reached
            outside = reached - sign * step
        else:
            outside = far
            while not self.reaches(file, outside + sign * step):
                outside += sign * step
                step *= 2
                if abs(outside) >= WITHOUT_END:
                    return None
            reached = outside + sign * step
        while abs(reached - outside) > GRAIN:
            middle = round((reached + outside) / 2 / GRAIN) * GRAIN
            if middle in (reached, outside):
                break
            reached, outside = (middle, outside) if self.reaches(file, middle) else (reached, middle)
        return reached

    def reaches(self, file: DriveFile, value: Fraction) -> bool:
        """Return whether a value is reached on a drive, judged exactly. Raises ``InputError``."""
        claim = staged_claim(self.question.at(value), by="known")
        ruling = judge_file(file_for_claim(file, claim), self.library)
        if ruling.judgement is None:
            raise InputError(ruling.reason)
        return ruling.accepted


def _is_endless(bracket: Bracket) -> bool:
    return -bracket.best * bracket.sign >= WITHOUT_END


def find_extreme(question: ExtremeQuestion, seeds: Iterable[JudgedDrive] = ()) -> Extreme:
    """Return an extreme, deciding each claim in this process; ``seeds``: drives that may serve.

    Raises ``InputError``, ``UsageError``, ``MissingSolverError``.
    """
    engines = Engines(Work(question.search.search_options.effort, PROOF, staged=True, moves=False))
    known = [*seeds]
    for drive in known:
        engines.offer(drive)
    return decide_steps(engines, ExtremeSearch(question, Points(JudgementCache())).run(known))


def decide_steps(engines: Engines, asking: ClaimGenerator[T]) -> T:
    """Return the result of a generator, deciding its claims one after the other in this process."""
    try:
        _, claim = next(asking)
        while True:
            answer, _ = engines.answer_claim(claim)
            engines.learn(answer)
            _, claim = asking.send(answer)
    except StopIteration as end:
        value: T = end.value
        return value
