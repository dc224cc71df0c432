"""How far a measure can go: the least or greatest value of a term on drives of a formula, in a bracket.

On one side is a judged drive that reaches its value; on the other the nearest value looked at that none was
found for, with what is known of it. No optimum is claimed.
"""

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.analysis.explore import PROOF_SECONDS, Finding, LookAll, Say, look_one_by_one
from roadproof.analysis.explore_knobs import Knob, Point, between, stated, with_point
from roadproof.analysis.explore_search import Pool, Reply, Shown, Task, claim_of, made_for
from roadproof.analysis.explore_text import compared, conjoin, eventually, expression
from roadproof.errors import InputError, UsageError
from roadproof.evidence.witness import DriveFile, judge_file
from roadproof.judge.signals import Courses, DriveSignals
from roadproof.logic import formula as f
from roadproof.logic.syntax import Expression
from roadproof.logic.terms import Dimension, Inverse, Signal, Term, leaves, number
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim, read_term
from roadproof.spec.library import Specification, load_library
from roadproof.verdict import Verdict
from roadproof.witness.ask import Request
from roadproof.witness.impossible import show_impossible

Sense: TypeAlias = Literal["least", "greatest"]
MOST_SEARCHES = 24
GRAIN = Fraction(1, 1000)  # of values at a moment, which are found by halving
WITHOUT_END = Fraction(10**6)


@dataclass(frozen=True)
class Measure:
    """The ``sense`` value of ``text``, at time 0 or at some moment at which ``when`` holds."""

    sense: Sense
    text: str
    term: Term
    dimension: Dimension
    when: str = ""

    @property
    def sign(self) -> int:
        """What turns a better value into a smaller one."""
        return 1 if self.sense == "least" else -1

    def bound(self, value: Fraction | None) -> list[Expression]:
        """That the measure is ``value`` or better (None: that there is a moment for it), as parts."""
        op: Literal["<=", ">="] = "<=" if self.sense == "least" else ">="
        here = [] if value is None else [compared(expression(self.text), op, value, self.dimension)]
        if not self.when:
            return here
        return [eventually([expression(self.when), *here])]


def read_measure(specification: Specification, sense: Sense, text: str, when: str = "") -> Measure:
    """A measure from what the user wrote. Raises ``TextError``, ``UsageError`` for what no drive changes."""
    term, dimension = read_term(specification, text, f"--{sense}")
    if isinstance(term, Inverse):
        raise UsageError(f"--{sense} '{text}': 1/x may be infinite; ask for the other extreme of x")
    if not any(isinstance(leaf, Signal) for leaf in leaves(term)):
        raise UsageError(f"--{sense} '{text}': no drive changes this; name a signal, such as v_lon(SV)")
    if when:
        read_claim(specification, when, "--when")
    return Measure(sense, text, term, dimension, when)


@dataclass(frozen=True)
class Sought:
    """What ``measure`` is sought for: drives of ``request.what`` with ``knobs`` at ``point``."""

    request: Request
    measure: Measure
    precision: Fraction
    knobs: tuple[Knob, ...] = ()
    point: Point = ()


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
        self.pool = Pool(self.library)
        self.searches = 0

    def run(self) -> Extreme:
        reply = self.look(None, natural=True)
        best = self.best_of(reply)
        if best is None:
            return self.extreme(None, self.missed((), self.text(None), reply), None)
        missed: Finding | None = None
        surely: Finding | None = None
        leap = max(self.sought.precision, Fraction(1))
        zero = self.impossible(Fraction(0)) if best.at[0] * self.measure.sign > 0 else None
        if zero is not None:
            missed = surely = zero
        while self.searches < MOST_SEARCHES:
            if self.endless(best):
                return self.extreme(best, None, None, endless=True)
            if missed is not None and abs(best.at[0] - missed.at[0]) <= self.sought.precision:
                break
            value = self.next(best, missed, leap)
            reply = self.look(value)
            found = self.best_of(reply)
            if found is not None and self.better(found, value):
                leap *= 2
                best = found
            else:
                missed = self.missed((value,), self.text(value), reply)
                surely = missed if missed.verdict is not Verdict.UNKNOWN else surely
            self.say(f"{self.measure.sense} so far: {float(best.at[0]):g}, {self.searches} searches")
        if missed is not None and missed.certificate is None:
            proved = self.impossible(missed.at[0])
            missed, surely = (proved, proved) if proved is not None else (missed, surely)
        return self.extreme(best, missed, surely)

    def extreme(
        self, best: Finding | None, missed: Finding | None, surely: Finding | None, endless: bool = False
    ) -> Extreme:
        return Extreme(self.measure, best, missed, surely, self.searches, endless)

    def next(self, best: Finding, missed: Finding | None, leap: Fraction) -> Fraction:
        """The next value to ask for: a leap ahead, or the middle of the bracket."""
        if missed is not None:
            return between(best.at[0], missed.at[0])
        ahead = best.at[0] - self.measure.sign * leap
        return between(ahead, ahead - self.measure.sign * self.sought.precision)

    def better(self, found: Finding, value: Fraction) -> bool:
        return (found.at[0] - value) * self.measure.sign <= 0

    def endless(self, best: Finding) -> bool:
        return -best.at[0] * self.measure.sign >= WITHOUT_END

    def text(self, value: Fraction | None) -> str:
        """The formula with the measure at ``value`` or better, limits stated."""
        limits = stated(self.sought.knobs, self.sought.point)
        return conjoin(self.request.what, [*limits, *self.measure.bound(value)])

    def look(self, value: Fraction | None, natural: bool = False) -> Reply:
        self.searches += 1
        what = conjoin(self.request.what, self.measure.bound(value))
        [reply] = self.look_all([Task(replace(self.request, what=what), natural)])
        return reply

    def missed(self, at: Point, text: str, reply: Reply) -> Finding:
        verdict = reply.verdict if reply.verdict is Verdict.NONE_WITHIN else Verdict.UNKNOWN
        reason = reply.reason or "the drive that was found is rejected by the judge"
        if not at and (proved := self.proved(at, text)) is not None:
            return proved
        return Finding(at, verdict, text, reason)

    def impossible(self, value: Fraction) -> Finding | None:
        """A proof that no drive, of any kind, reaches ``value``."""
        return self.proved((value,), self.text(value))

    def proved(self, at: Point, text: str) -> Finding | None:
        shown = show_impossible(self.specification, text, PROOF_SECONDS)
        if shown is None:
            return None
        reason = f"proved for all time: {' and '.join(shown.core)} clash"
        return Finding(at, Verdict.IMPOSSIBLE, text, reason, certificate=shown.certificate)

    def best_of(self, reply: Reply) -> Finding | None:
        """The best value that is judged on the drive of a reply."""
        self.pool.add(reply.drives)
        if not reply.drives:
            return None
        file = self.pool.files[-1]
        value = self.at_start(file) if not self.measure.when else self.at_moment(file)
        if value is None:
            return None
        shown = self.shown(file, value)
        if shown is None:
            return None
        number = len(self.pool.files)
        return Finding((value,), Verdict.WITNESSED, self.text(value), drive=shown.data, number=number)

    def shown(self, file: DriveFile, value: Fraction) -> Shown | None:
        """The drive as a file that says that ``value`` is reached, if that is judged so."""
        alone = Pool(self.library)
        alone.files.append(file)
        return alone.show(claim_of(self.request, self.text(value), self.library))

    def at_start(self, file: DriveFile) -> Fraction | None:
        """The measure at time 0, exactly."""
        values = {**default_values(self.library), **self.request.values}
        compare = bind(f.Compare(self.measure.term, "<=", number(0)), file.road, file.lanes, values)
        assert isinstance(compare, f.Compare)
        _, course = Courses(DriveSignals(file.drive)).of(compare.left)[0]
        return Fraction(course.numerators[0], course.denominator) if course.numerators else Fraction(0)

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
