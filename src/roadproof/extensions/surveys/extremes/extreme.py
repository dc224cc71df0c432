"""How far a measure can go: the least or greatest value of a term on drives of a formula, in a bracket.

On one side is a judged drive that reaches its value; on the other the nearest value looked at that none was
found for, with what is known of it. No optimum is claimed.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

from roadproof.engines.encode.along import names_places
from roadproof.engines.search.batches import Engines
from roadproof.engines.search.known_drive import offered
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.question import pose
from roadproof.engines.search.stages import dt_of, staged_claim, values_of
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.extensions.surveys.extremes.bracket import Bracket, range_of, starting_ranges
from roadproof.extensions.surveys.extremes.measure import Measure
from roadproof.extensions.surveys.extremes.points import Asking, Point, PointFinding, Points, Remembered, T
from roadproof.library.bind import bind
from roadproof.library.compose import with_parts
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.rewrite import is_cubic_state
from roadproof.logic.terms import Term, number
from roadproof.runtime.budget import Work
from roadproof.semantics.exact.signals import Courses, DriveSignals
from roadproof.verdict import Verdict
from roadproof.world.road import Road

MOST_SEARCHES = 24
GRAIN = Fraction(1, 1000)  # of values at a moment, which are found by halving
WITHOUT_END = Fraction(10**6)
PRECISION = Fraction(1, 10)  # of a measure, where none is given
PROOF = 5.0  # units of work for a proof that there is no drive


@dataclass(frozen=True)
class Extreme:
    """How far ``measure`` can go at a ``point`` of what is varied.

    ``best``: a judged drive that reaches ``best.at``; ``missed``: the nearest value it was not found for.
    ``surely``: the nearest value for which it is said that there is none, if any. ``endless``: the drive
    passes any value that is asked for. Where there is no drive at all, ``best`` is None.
    """

    measure: Measure
    point: Point
    best: PointFinding | None
    missed: PointFinding | None
    surely: PointFinding | None
    searches: int
    endless: bool = False


@dataclass(frozen=True)
class ExtremeQuestion:
    """How far a measure goes on drives of ``search`` at a point, and the ``name`` of claims about it.

    ``limits``: parts that drives satisfy at the point. ``precision``: how wide a bracket may be.
    """

    name: str
    search: Search
    measure: Measure
    precision: Fraction = PRECISION
    point: Point = ()
    limits: tuple[Query, ...] = ()

    def at(self, value: Fraction | None) -> Search:
        """Return the search with the measure at ``value`` or better, and limits stated."""
        parts = [*self.limits, *self.measure.bound(value)]
        return replace(self.search, query=with_parts(self.search.query, parts))


class ExtremeSearch:
    """Leaps from drive to drive, then halves, until the bracket is as narrow as the precision."""

    def __init__(self, asked: ExtremeQuestion, points: Points) -> None:
        self.asked = asked
        self.points = points
        self.measure = asked.measure
        self.library = asked.search.specification.library
        self.is_hard = is_cubic_state(asked.search.query.formula)
        self.asked_for = 0

    def run(self, drives: Iterable[JudgedDrive] = ()) -> Asking[Extreme]:
        """Return the extreme; ``drives``: they may serve. Raises ``InputError``, ``UsageError``."""
        before = self.points.searches
        first = self.best_of(drives)
        if first is None:
            begun = yield from self._begin()
            if not isinstance(begun, Fraction):
                extreme = Extreme(
                    self.measure,
                    self.asked.point,
                    None,
                    begun,
                    begun if begun.verdict is Verdict.IMPOSSIBLE else None,
                    self.points.searches - before,
                )
                return extreme
            first = begun
        bracket = Bracket(self.measure.sign, self.asked.precision, first, self.range_end)
        if not self.is_hard and first * self.measure.sign > 0:
            zero = yield from self.impossible("zero", Fraction(0))
            if zero is not None:
                bracket.miss(zero)
        while self.asked_for < MOST_SEARCHES - 1 and not bracket.narrow and not _is_endless(bracket):
            yield from self._narrow(bracket)
        return (yield from self._ended(bracket, before))

    def _begin(self) -> Asking[Fraction | PointFinding]:
        """Return the value of a first drive, or why there is none."""
        name, search = f"{self.asked.name}-first", self.asked.at(None)
        if not self.is_hard:
            proved = yield from self.points.proved(f"{self.asked.name}-any", (), search, "time")
            if proved is not None:
                return proved
        found = yield from self.points.find(name, (), search)
        value = None if found.drive is None else self.best_of([found.drive])
        return found if value is None else value

    def _narrow(self, bracket: Bracket) -> Asking[None]:
        """Ask for one more value."""
        value = bracket.next()
        self.asked_for += 1
        name = f"{self.asked.name}-{self.asked_for:02}"
        found = yield from self.points.find(name, (value,), self.asked.at(value), natural=False)
        reached = None if found.drive is None else self.best_of([found.drive])
        if reached is not None and bracket.reached(reached, value):
            bracket.hold(reached)
            return
        if self.is_hard and found.verdict is not Verdict.IMPOSSIBLE:
            found = (yield from self.impossible(f"{self.asked_for:02}-no", value)) or found
        bracket.miss(found)

    def _ended(self, bracket: Bracket, before: int) -> Asking[Extreme]:
        missed, surely = bracket.missed, bracket.sure
        if _is_endless(bracket):
            missed = surely = None
        elif missed is not None and missed.certificate is None:
            proved = yield from self.impossible("beyond", missed.at[0])
            missed, surely = (proved, proved) if proved is not None else (missed, surely)
        name, value = f"{self.asked.name}-best", bracket.best
        best = yield from self.points.again(name, (value,), self.asked.at(value))
        searches = self.points.searches - before
        return Extreme(self.measure, self.asked.point, best, missed, surely, searches, _is_endless(bracket))

    def impossible(self, name: str, value: Fraction) -> Asking[PointFinding | None]:
        """Ask for a proof that no drive, of any kind, reaches ``value``."""
        search = self.asked.at(value)
        return (yield from self.points.proved(f"{self.asked.name}-{name}", (value,), search, "time"))

    @cached_property
    def range_end(self) -> Fraction | None:
        """The best value that any drive could start with, where that is known."""
        if self.measure.when:
            return None
        # Only the start counts here, for which any grid does.
        setting = self.asked.search.setting
        dt = dt_of(setting)
        question = pose(self.library, self.asked.search.query, replace(setting, horizon=dt, dt=dt))
        try:
            term = self.bound_term(question.road, {})
            if names_places(f.Compare(term, ">", number(0)), question.vehicles):
                return None
            low, high = range_of(term, starting_ranges(question))
        except (ValueError, KeyError):
            return None
        return low if self.measure.sense == "least" else high

    def best_of(self, drives: Iterable[JudgedDrive]) -> Fraction | None:
        """The best value that one of the drives reaches; None where none of them shows the formula."""
        values = (self._value(self.points.number(x)) for x in drives)
        return min((x for x in values if x is not None), key=lambda x: x * self.measure.sign, default=None)

    def _value(self, number: int) -> Fraction | None:
        """The value that the drive of a number reaches, or None."""
        drive = self.points.drives[number - 1].judged
        key = self.asked.name, number
        return self.points.remembered.of(key, drive, lambda: self._work_out(drive))

    def _work_out(self, drive: JudgedDrive) -> Fraction | None:
        value = self.at_moment(drive.file) if self.measure.when else self.at_start(drive.file)
        return value if value is not None and self.reaches(drive.file, value) else None

    def at_start(self, file: DriveFile) -> Fraction:
        """The measure at time 0, exactly."""
        term = self.bound_term(file.road, file.lanes)
        _, course = Courses(DriveSignals(file.drive)).of(term)[0]
        return Fraction(course.numerators[0], course.denominator) if course.numerators else Fraction(0)

    def bound_term(self, road: Road, lanes: Mapping[str, str]) -> Term:
        """The term with values for its parameters."""
        here = f.Compare(self.measure.term, "<=", number(0))
        compare = bind(here, road, lanes, values_of(self.asked.search))
        assert isinstance(compare, f.Compare)
        return compare.left

    def at_moment(self, file: DriveFile) -> Fraction | None:
        """A multiple of ``GRAIN`` that the measure reaches while ``when`` holds, the next one it does not."""
        sign = self.measure.sign
        far, step = Fraction(0), Fraction(1)
        if self.reaches(file, far):
            reached = far
            while self.reaches(file, reached - sign * step):
                reached -= sign * step
                step *= 2
                if abs(reached) >= WITHOUT_END:
                    return reached
            missed = reached - sign * step
        else:
            missed = far
            while not self.reaches(file, missed + sign * step):
                missed += sign * step
                step *= 2
                if abs(missed) >= WITHOUT_END:
                    return None
            reached = missed + sign * step
        while abs(reached - missed) > GRAIN:
            middle = round((reached + missed) / 2 / GRAIN) * GRAIN
            if middle in (reached, missed):
                break
            reached, missed = (middle, missed) if self.reaches(file, middle) else (reached, middle)
        return reached

    def reaches(self, file: DriveFile, value: Fraction) -> bool:
        """Return whether a value is reached on a drive, judged exactly. Raises ``InputError``."""
        claim = staged_claim(self.asked.at(value), by="known")
        ruling = judge_file(offered(file, claim), self.library)
        if ruling.judgement is None:
            raise InputError(ruling.reason)
        return ruling.accepted


def _is_endless(bracket: Bracket) -> bool:
    return -bracket.best * bracket.sign >= WITHOUT_END


def find_extreme(asked: ExtremeQuestion, seeds: Iterable[JudgedDrive] = ()) -> Extreme:
    """Return an extreme, each claim settled as it comes; ``seeds``: drives that may serve.

    Raises ``InputError``, ``UsageError``, ``MissingSolverError``.
    """
    engines = Engines(Work(asked.search.search_options.effort, PROOF, staged=True, moves=False))
    known = [*seeds]
    for drive in known:
        engines.offer(drive)
    return settled_by(engines, ExtremeSearch(asked, Points(Remembered())).run(known))


def settled_by(engines: Engines, asking: Asking[T]) -> T:
    """Return what claims show that are settled here, one after the other."""
    try:
        _, claim = next(asking)
        while True:
            answer, _ = engines.settle(claim)
            engines.learn(answer)
            _, claim = asking.send(answer)
    except StopIteration as end:
        value: T = end.value
        return value
