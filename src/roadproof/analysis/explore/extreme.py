"""How far a measure can go: the least or greatest value of a term on drives of a formula, in a bracket.

On one side is a judged drive that reaches its value; on the other the nearest value looked at that none was
found for, with what is known of it. No optimum is claimed.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeAlias

from roadproof.analysis.explore.answer import (
    Explorable,
    ExplorationResult,
    Extreme,
    Measure,
    Point,
    PointFinding,
    Variable,
    say_nothing,
    stated,
    with_parts,
    with_point,
)
from roadproof.analysis.explore.bracket import Bracket, range_of, starting_ranges
from roadproof.analysis.explore.search import (
    NATURAL_FIRST,
    PLAIN_FIRST,
    DriveClaim,
    Reply,
    SearchTask,
    Stage,
    Stock,
    claim_of,
    dt_of,
    look,
    made_for,
    missed,
    never,
    stages_for,
    values_of,
)
from roadproof.analysis.explore.values import PROOF, QUICK_PROOF
from roadproof.analysis.study.pool import Say
from roadproof.engines.encode.along import names_places
from roadproof.engines.search.impossible import show_impossible
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.question import pose
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.library.bind import bind
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.rewrite import is_cubic_state
from roadproof.logic.terms import Term, number
from roadproof.reasons import Reason, Why
from roadproof.runtime.budget import BudgetExceeded
from roadproof.semantics.exact.signals import Courses, DriveSignals
from roadproof.verdict import Verdict
from roadproof.world.road import Road

MOST_SEARCHES = 24
GRAIN = Fraction(1, 1000)  # of values at a moment, which are found by halving
WITHOUT_END = Fraction(10**6)
PRECISION = Fraction(1, 10)  # of a measure, where none is given


@dataclass(frozen=True)
class ExtremeQuestion:
    """What ``measure`` is sought for: drives of the query of ``search`` with ``knobs`` at ``point``.

    ``seeds``: drives that may serve here too.
    """

    search: Search
    measure: Measure
    precision: Fraction
    knobs: tuple[Variable, ...] = ()
    point: Point = ()
    seeds: tuple[JudgedDrive, ...] = ()

    def query(self, value: Fraction | None) -> Query:
        """The formula with the measure at ``value`` or better, limits stated."""
        limits = stated(self.search, self.knobs, self.point)
        return with_parts(self.search.query, [*limits, *self.measure.bound(self.search, value)])


def soughts_of(asked: Explorable, explored: ExplorationResult, measure: Measure) -> list[ExtremeQuestion]:
    """A measure at every point that has a drive; at the one that there is where nothing is varied."""
    if asked.knobs:
        return [
            ExtremeQuestion(asked.search, measure, PRECISION, asked.knobs, point) for point in explored.held
        ]
    return [ExtremeQuestion(asked.search, measure, asked.precision or PRECISION)]


def find_extreme(sought: ExtremeQuestion, say: Say = say_nothing) -> Extreme:
    """Leap from drive to drive, then halve, until the bracket is as narrow as the precision.

    Raises ``InputError``, ``UsageError``, ``MissingSolverError``.
    """
    return _ExtremeSearch(sought, say).run()


def unsought(sought: ExtremeQuestion, reason: Reason) -> Extreme:
    """What is said of an extreme that nothing is known of."""
    missed = PointFinding((), sought.query(None), verdict=Verdict.UNKNOWN, reason=reason)
    return Extreme(sought.measure, sought.point, None, missed, None, 0, late=True)


class _ExtremeSearch:
    def __init__(self, sought: ExtremeQuestion, say: Say) -> None:
        self.sought = sought
        self.measure = sought.measure
        self.say = say
        self.search = with_point(sought.search, sought.knobs, sought.point)
        self.library = self.search.specification.library
        self.hard = is_cubic_state(self.search.query.formula)
        self.searches = 0
        self.late = False

    def run(self) -> Extreme:
        first = self.best_of(self.sought.seeds)
        if first is None:
            proved = None if self.hard else self.proved((), None, QUICK_PROOF)
            if proved is not None:
                return self.extreme(None, proved, proved)
            reply = self.look(None, NATURAL_FIRST)
            first = self.best_of(reply.drives)
            if first is None and self.hard and (proved := self.proved((), None)) is not None:
                return self.extreme(None, proved, proved)
            if first is None:
                return self.extreme(None, missed((), self.sought.query(None), reply), None)
        bracket = Bracket(self.measure.sign, self.sought.precision, first, self.range_end())
        if (
            not self.hard
            and first.at[0] * self.measure.sign > 0
            and (zero := self.impossible(Fraction(0))) is not None
        ):
            bracket.miss(zero)
        while self.searches < MOST_SEARCHES and not bracket.narrow and not self.endless(bracket.best):
            value = bracket.next()
            reply = self.look(value)
            found = self.best_of(reply.drives)
            if found is not None and bracket.reached(found, value):
                bracket.hold(found)
            else:
                proved = self.impossible(value) if self.hard else None
                bracket.miss(proved or missed((value,), self.sought.query(value), reply))
            best = float(bracket.best.at[0])
            self.say(f"{self.measure.sense} so far: {best:g}, {self.searches} searches")
        return self.ended(bracket)

    def ended(self, bracket: Bracket) -> Extreme:
        best, missed, surely = bracket.best, bracket.missed, bracket.sure
        if self.endless(best):
            return replace(self.extreme(best, None, None), endless=True)
        if missed is not None and missed.certificate is None:
            proved = self.impossible(missed.at[0])
            missed, surely = (proved, proved) if proved is not None else (missed, surely)
        return self.extreme(best, missed, surely)

    def extreme(
        self, best: PointFinding | None, missed: PointFinding | None, surely: PointFinding | None
    ) -> Extreme:
        point = self.sought.point
        return Extreme(self.measure, point, best, missed, surely, self.searches, late=self.late)

    def range_end(self) -> Fraction | None:
        """The best value that any drive could start with, where that is known."""
        if self.measure.when:
            return None
        # Only the start counts here, for which any grid does.
        dt = dt_of(self.search.setting)
        setting = replace(self.search.setting, horizon=dt, dt=dt)
        question = pose(self.library, self.search.query, setting)
        try:
            term = self.bound_term(question.road, {})
            if names_places(f.Compare(term, ">", number(0)), question.vehicles):
                return None
            low, high = range_of(term, starting_ranges(question))
        except (ValueError, KeyError):
            return None
        return low if self.measure.sense == "least" else high

    def endless(self, best: PointFinding) -> bool:
        return -best.at[0] * self.measure.sign >= WITHOUT_END

    def look(self, value: Fraction | None, stages: tuple[Stage, ...] = PLAIN_FIRST) -> Reply:
        self.searches += 1
        query = with_parts(self.search.query, self.measure.bound(self.search, value))
        reply = look(SearchTask(replace(self.search, query=query), stages_for(self.search, stages)))
        self.late |= reply.late
        return reply

    def impossible(self, value: Fraction) -> PointFinding | None:
        """A proof that no drive, of any kind, reaches ``value``."""
        return self.proved((value,), value)

    def proved(self, at: Point, value: Fraction | None, units: float = PROOF) -> PointFinding | None:
        query, effort = self.sought.query(value), self.search.search_options.effort.of(units)
        try:
            if (found := never(self.search, at, query, min(QUICK_PROOF, units))) is not None:
                return found
            shown = show_impossible(self.search.specification, query, effort)
        except BudgetExceeded:
            self.late = True
            return None
        if shown is None:
            return None
        reason = Why.PROVED_CORE("time", " and ".join(shown.told))
        return PointFinding(
            at, query, verdict=Verdict.IMPOSSIBLE, reason=reason, certificate=shown.certificate
        )

    def best_of(self, drives: Sequence[JudgedDrive]) -> PointFinding | None:
        """The best value that is judged on one of the drives."""
        found: list[PointFinding] = []
        for drive in drives:
            value = self.at_moment(drive.file) if self.measure.when else self.at_start(drive.file)
            shown = None if value is None else self.shown(drive, value)
            if value is not None and shown is not None:
                found.append(
                    PointFinding((value,), self.sought.query(value), verdict=Verdict.WITNESSED, drive=shown)
                )
        return min(found, key=lambda finding: finding.at[0] * self.measure.sign, default=None)

    def claim(self, value: Fraction) -> DriveClaim:
        """That ``value`` is reached."""
        return claim_of(self.search, self.sought.query(value))

    def shown(self, drive: JudgedDrive, value: Fraction) -> JudgedDrive | None:
        """The drive as one on which ``value`` is reached, if that is judged so."""
        alone = Stock(self.library)
        alone.add([drive])
        shown = alone.show(self.claim(value))
        return None if shown is None else shown.drive

    def at_start(self, file: DriveFile) -> Fraction | None:
        """The measure at time 0, exactly."""
        term = self.bound_term(file.road, file.lanes)
        _, course = Courses(DriveSignals(file.drive)).of(term)[0]
        return Fraction(course.numerators[0], course.denominator) if course.numerators else Fraction(0)

    def bound_term(self, road: Road, lanes: Mapping[str, str]) -> Term:
        """The term with values for its parameters."""
        compare = bind(f.Compare(self.measure.term, "<=", number(0)), road, lanes, values_of(self.search))
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
        ruling = judge_file(made_for(file, self.claim(value)), self.library)
        if ruling.judgement is None:
            raise InputError(ruling.reason)
        return ruling.accepted


FindAll: TypeAlias = Callable[[Sequence[ExtremeQuestion]], Iterable[Extreme]]


def find_extremes(soughts: Sequence[ExtremeQuestion], find_all: FindAll) -> list[Extreme]:
    """The extremes of one measure at several points, the drives of each tried at all others.

    Where one of them goes further, that extreme is sought once more from there.
    """
    found = list(find_all(soughts))
    drives = [x.best.drive for x in found if x.best is not None and x.best.drive is not None]
    again: dict[int, ExtremeQuestion] = {}
    for k, (sought, extreme) in enumerate(zip(soughts, found, strict=True)):
        if extreme.best is None or extreme.endless:
            continue
        others = _ExtremeSearch(sought, say_nothing).best_of(drives)
        further = others is not None and (others.at[0] - extreme.best.at[0]) * sought.measure.sign < 0
        if further and others is not None and others.drive is not None:
            again[k] = replace(sought, seeds=(others.drive,))
    for k, extreme in zip(again, find_all(list(again.values())), strict=True):
        found[k] = _together(found[k], extreme)
    return found


def _together(first: Extreme, again: Extreme) -> Extreme:
    """What is known after an extreme was sought again, from a drive; where that was lost, with the doubt."""
    searches = first.searches + again.searches
    if again.best is not None:
        return replace(again, searches=searches, late=first.late or again.late)
    missed = first.missed
    if missed is not None and again.missed is not None:
        missed = replace(again.missed, at=missed.at, query=missed.query)
    return replace(first, missed=missed, searches=searches, late=True)
