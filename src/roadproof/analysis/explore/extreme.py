"""How far a measure can go: the least or greatest value of a term on drives of a formula, in a bracket.

On one side is a judged drive that reaches its value; on the other the nearest value looked at that none was
found for, with what is known of it. No optimum is claimed.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, TypeAlias

from roadproof.analysis.explore.bracket import Bracket
from roadproof.analysis.explore.knobs import Knob, Point, stated, with_point
from roadproof.analysis.explore.measure import Measure
from roadproof.analysis.explore.range import range_of, starting_ranges
from roadproof.analysis.explore.search import (
    NATURAL_FIRST,
    PLAIN_FIRST,
    Pool,
    Reply,
    Shown,
    Stage,
    Task,
    claim_of,
    made_for,
)
from roadproof.analysis.explore.text import conjoin
from roadproof.analysis.explore.values import (
    PROOF,
    QUICK_PROOF,
    Finding,
    LookAll,
    Say,
    look_one_by_one,
)
from roadproof.analysis.requests import Request
from roadproof.encode.along import names_places
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.judged import judge_file
from roadproof.judge.signals import Courses, DriveSignals
from roadproof.logic import formula as f
from roadproof.logic.terms import Term, number
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import load_library
from roadproof.verdict import Verdict
from roadproof.witness.impossible import show_impossible
from roadproof.world.road import Road

MOST_SEARCHES = 24
GRAIN = Fraction(1, 1000)  # of values at a moment, which are found by halving
WITHOUT_END = Fraction(10**6)


FindAll: TypeAlias = Callable[[Sequence["Sought"]], Iterable["Extreme"]]


@dataclass(frozen=True)
class Sought:
    """What ``measure`` is sought for: drives of ``request.what`` with ``knobs`` at ``point``.

    ``seeds``: drive files' data that may serve here too.
    """

    request: Request
    measure: Measure
    precision: Fraction
    knobs: tuple[Knob, ...] = ()
    point: Point = ()
    seeds: tuple[Mapping[str, Any], ...] = ()


@dataclass(frozen=True)
class Extreme:
    """``best``: a judged drive that reaches ``best.at``; ``missed``: the nearest value it was not found for.

    ``surely``: the nearest value for which it is said that there is none, if any. ``endless``: the drive
    passes any value that is asked for. Where there is no drive at all, ``best`` is None.
    """

    measure: Measure
    best: Finding | None
    missed: Finding | None
    surely: Finding | None
    searches: int
    endless: bool = False


def find_extreme(
    sought: Sought, look_all: LookAll = look_one_by_one, say: Say = lambda text: None
) -> Extreme:
    """Leap from drive to drive, then halve, until the bracket is as narrow as the precision.

    Raises ``InputError``, ``UsageError``, ``MissingSolverError``.
    """
    return _Seeking(sought, look_all, say).run()


class _Seeking:
    def __init__(self, sought: Sought, look_all: LookAll, say: Say) -> None:
        self.sought = sought
        self.measure = sought.measure
        self.look_all = look_all
        self.say = say
        self.request = with_point(sought.request, sought.knobs, sought.point)
        self.library = load_library(self.request.specs)
        self.specification = self.library.select(self.request.set_name, self.request.options)
        self.searches = 0

    def run(self) -> Extreme:
        first = self.best_of(self.sought.seeds)
        if first is None:
            proved = self.proved((), self.text(None), QUICK_PROOF)
            if proved is not None:
                return Extreme(self.measure, None, proved, proved, 0)
            reply = self.look(None, NATURAL_FIRST)
            first = self.best_of(reply.drives)
            if first is None:
                return Extreme(self.measure, None, self.missed((), None, reply), None, self.searches)
        bracket = Bracket(self.measure.sign, self.sought.precision, first, self.range_end())
        if first.at[0] * self.measure.sign > 0 and (zero := self.impossible(Fraction(0))) is not None:
            bracket.miss(zero)
        while self.searches < MOST_SEARCHES and not bracket.narrow and not self.endless(bracket.best):
            value = bracket.next()
            reply = self.look(value)
            found = self.best_of(reply.drives)
            if found is not None and bracket.reached(found, value):
                bracket.hold(found)
            else:
                bracket.miss(self.missed((value,), value, reply))
            best = float(bracket.best.at[0])
            self.say(f"{self.measure.sense} so far: {best:g}, {self.searches} searches")
        return self.extreme(bracket)

    def extreme(self, bracket: "Bracket") -> Extreme:
        best, missed, surely = bracket.best, bracket.missed, bracket.sure
        if self.endless(best):
            return Extreme(self.measure, best, None, None, self.searches, endless=True)
        if missed is not None and missed.certificate is None:
            proved = self.impossible(missed.at[0])
            missed, surely = (proved, proved) if proved is not None else (missed, surely)
        return Extreme(self.measure, best, missed, surely, self.searches)

    def range_end(self) -> Fraction | None:
        """The best value that any drive could start with, where that is known."""
        if self.measure.when:
            return None
        question = self.request.question()
        try:
            term = self.bound_term(question.road, {})
            if names_places(f.Compare(term, ">", number(0)), question.vehicles):
                return None
            low, high = range_of(term, starting_ranges(question))
        except (ValueError, KeyError):
            return None
        return low if self.measure.sense == "least" else high

    def endless(self, best: Finding) -> bool:
        return -best.at[0] * self.measure.sign >= WITHOUT_END

    def text(self, value: Fraction | None) -> str:
        """The formula with the measure at ``value`` or better, limits stated."""
        limits = stated(self.sought.knobs, self.sought.point)
        return conjoin(self.request.what, [*limits, *self.measure.bound(value)])

    def look(self, value: Fraction | None, stages: tuple[Stage, ...] = PLAIN_FIRST) -> Reply:
        self.searches += 1
        what = conjoin(self.request.what, self.measure.bound(value))
        [reply] = self.look_all([Task(replace(self.request, what=what), stages)])
        return reply

    def missed(self, at: Point, value: Fraction | None, reply: Reply) -> Finding:
        verdict = reply.verdict if reply.verdict is Verdict.NONE_WITHIN else Verdict.UNKNOWN
        reason = reply.reason or "the drive that was found is rejected by the judge"
        return Finding(at, verdict, self.text(value), reason)

    def impossible(self, value: Fraction) -> Finding | None:
        """A proof that no drive, of any kind, reaches ``value``."""
        return self.proved((value,), self.text(value))

    def proved(self, at: Point, text: str, units: float = PROOF) -> Finding | None:
        shown = show_impossible(
            self.specification, read_claim(self.specification, text), self.request.means.effort.of(units)
        )
        if shown is None:
            return None
        reason = f"proved for all time; core: {' and '.join(shown.told)}"
        return Finding(at, Verdict.IMPOSSIBLE, text, reason, certificate=shown.as_data()["certificate"])

    def best_of(self, drives: Sequence[Mapping[str, Any]]) -> Finding | None:
        """The best value that is judged on one of the drives."""
        found: list[Finding] = []
        for data in drives:
            file = read_drive(dict(data), "drive")
            value = self.at_start(file) if not self.measure.when else self.at_moment(file)
            shown = None if value is None else self.shown(file, value)
            if value is not None and shown is not None:
                finding = Finding((value,), Verdict.WITNESSED, self.text(value), drive=shown.data)
                found.append(finding)
        return min(found, key=lambda finding: finding.at[0] * self.measure.sign, default=None)

    def shown(self, file: DriveFile, value: Fraction) -> Shown | None:
        """The drive as a file that says that ``value`` is reached, if that is judged so."""
        alone = Pool(self.library)
        alone.files.append(file)
        return alone.show(claim_of(self.request, self.text(value), self.library))

    def at_start(self, file: DriveFile) -> Fraction | None:
        """The measure at time 0, exactly."""
        term = self.bound_term(file.road, file.lanes)
        _, course = Courses(DriveSignals(file.drive)).of(term)[0]
        return Fraction(course.numerators[0], course.denominator) if course.numerators else Fraction(0)

    def bound_term(self, road: Road, lanes: Mapping[str, str]) -> Term:
        """The term with values for its parameters."""
        values = {**default_values(self.library), **self.request.values}
        compare = bind(f.Compare(self.measure.term, "<=", number(0)), road, lanes, values)
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
        claim = claim_of(self.request, self.text(value), self.library)
        ruling = judge_file(made_for(file, claim), self.library)
        if ruling.judgement is None:
            raise InputError(ruling.reason)
        return ruling.accepted


def find_extremes(soughts: Sequence[Sought], find_all: FindAll) -> list[Extreme]:
    """The extremes of one measure at several points, the drives of each tried at all others.

    Where one of them goes further, that extreme is sought once more from there.
    """
    found = list(find_all(soughts))
    drives = [x.best.drive for x in found if x.best is not None and x.best.drive is not None]
    again: dict[int, Sought] = {}
    for k, (sought, extreme) in enumerate(zip(soughts, found, strict=True)):
        if extreme.best is None or extreme.endless:
            continue
        others = _Seeking(sought, look_one_by_one, lambda text: None).best_of(drives)
        if others is not None and (others.at[0] - extreme.best.at[0]) * sought.measure.sign < 0:
            again[k] = replace(sought, seeds=(others.drive or {},))
    for k, extreme in zip(again, find_all(list(again.values())), strict=True):
        found[k] = replace(extreme, searches=extreme.searches + found[k].searches)
    return found
