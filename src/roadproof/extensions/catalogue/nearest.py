"""Why no scenario holds on a drive: the nearest one, its first false part, the values there, and a change.

How near a scenario is, is the share of its parts that hold. Truth and values are the exact judge's.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce
from typing import TypeAlias, assert_never

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.logic.syntax import Definition
from roadproof.logic.terms import Term
from roadproof.semantics.exact.algebraic import Root, approximate
from roadproof.semantics.exact.exact import DriveJudge, Judgement, seconds
from roadproof.semantics.exact.signals import Courses
from roadproof.semantics.exact.truth import Span, TruthSet, complement, intersection, interval
from roadproof.world.units import SI, Dimension

MOST_INSTANTS = 12
"""Instants at which the body of an eventuality is looked at."""
LONGEST = 100
"""Characters of a comparison that is written out."""
_FINE = 1000


@dataclass(frozen=True)
class FalsePart:
    """A comparison that is not as a formula needs it at the instant ``at`` (s).

    ``part``: the definition that it is in; ``part_needed`` and ``needed``: the truth needed of the
    definition and comparison. ``left`` and ``right``: values of its sides there (SI); ``values``:
    of the signals and sizes that it speaks of. ``score``: the share of the formula's parts that hold.
    """

    part: f.Application | None
    part_needed: bool
    comparison: f.Compare
    needed: bool
    at: Fraction
    left: Fraction
    right: Fraction
    values: Mapping[t.Signal | t.Size, Fraction]
    score: Fraction

    @property
    def lack(self) -> Fraction:
        """How far apart the sides are (SI): a change by more than that makes the comparison as needed."""
        return abs(self.left - self.right)


def first_false_part(formula: Formula, judge: DriveJudge, horizon: Fraction) -> FalsePart | None:
    """The first part for want of which a bound formula is false at time 0, looked for up to ``horizon`` (s).

    ``judge``: that of the vehicles. None where the formula holds, or where no single comparison at one
    instant is to blame.
    """
    judgement, courses = judge.judgement(formula), judge.courses
    if judgement.holds:
        return None
    looking = _NearestSearch(judgement, courses, horizon)
    found = looking.leaf(formula, Fraction(0), True, (None, True))
    if found is None:
        return None
    (part, part_needed), comparison, needed, at = found
    leaves = dict.fromkeys(
        x
        for side in (comparison.left, comparison.right)
        for x in t.leaves(side)
        if isinstance(x, t.Signal | t.Size)
    )
    values = {x: _value(courses, x, at) for x in leaves}
    left, right = _value(courses, comparison.left, at), _value(courses, comparison.right, at)
    score = looking.score(formula, Fraction(0), True)
    return FalsePart(part, part_needed, comparison, needed, at, left, right, values, score)


_Within: TypeAlias = tuple[f.Application | None, bool]
_Leaf: TypeAlias = tuple[_Within, f.Compare, bool, Fraction]


@dataclass(frozen=True)
class _NearestSearch:
    judgement: Judgement
    courses: Courses
    horizon: Fraction
    scores: dict[tuple[Formula, Fraction, bool], Fraction] = field(default_factory=dict)

    def leaf(self, part: Formula, at: Fraction, needed: bool, within: _Within) -> _Leaf | None:
        """The comparison to blame for a part that is not as ``needed`` at ``at``."""
        match part:
            case f.Compare(left, _, right):
                has_inverse = any(isinstance(x, t.Inverse) for x in (left, right))
                return None if has_inverse else (within, part, needed, at)
            case f.Truth():
                return None
            case f.Application():
                return self.leaf(part.body, at, needed, (part, needed))
        return next(
            (self.leaf(x, when, value, within) for x, when, value in self.blamed(part, at, needed)), None
        )

    def score(self, part: Formula, at: Fraction, needed: bool) -> Fraction:
        """The share of the parts that are as ``needed``, 1 where the whole is."""
        if self.judgement.truth(part).at(at) is needed:
            return Fraction(1)
        key = (part, at, needed)
        if key not in self.scores:
            self.scores[key] = self._score(part, at, needed)
        return self.scores[key]

    def _score(self, part: Formula, at: Fraction, needed: bool) -> Fraction:
        if isinstance(part, f.And | f.Or) and isinstance(part, f.And) is needed:
            parts = [x for x in part.parts if not isinstance(_bare(x), f.Truth)] or part.parts
            return sum((self.score(x, at, needed) for x in parts), Fraction(0)) / len(parts)
        found = next(self.blamed(part, at, needed), None)
        return Fraction(0) if found is None else self._weighed(part, needed, found)

    def _nearness(self, part: Formula, at: Fraction, needed: bool) -> tuple[Fraction, Fraction]:
        """The score of a part, and of equal ones how little its comparison lacks (SI)."""
        found = self.leaf(part, at, needed, (None, True))
        if found is None:
            return self.score(part, at, needed), Fraction(0)
        _, comparison, _, when = found
        sides = (_value(self.courses, x, when) for x in (comparison.left, comparison.right))
        left, right = sides
        return self.score(part, at, needed), -abs(left - right)

    def _weighed(self, part: Formula, needed: bool, found: tuple[Formula, Fraction, bool]) -> Fraction:
        """The score of what is to blame, less where it needs to last; the end of an until counts half."""
        score = self.score(*found)
        if isinstance(part, f.Until):
            return (score + (found[0] is part.left)) / 2
        lasts = isinstance(part, f.Always | f.Eventually) and isinstance(part, f.Always) is needed
        return score / 2 if lasts else score

    def blamed(self, part: Formula, at: Fraction, needed: bool) -> Iterator[tuple[Formula, Fraction, bool]]:
        """The part below that is to blame, with the instant, and the truth that it needs; or nothing."""
        match part:
            case f.Compare() | f.Truth():
                return
            case f.Not(body):
                yield body, at, not needed
            case f.Application(_, _, body):
                yield body, at, needed
            case f.And(parts) | f.Or(parts):
                wrong = [x for x in parts if self.judgement.truth(x).at(at) is not needed]
                if isinstance(part, f.And) is needed:
                    yield wrong[0], at, needed
                elif wrong:
                    yield max(wrong, key=lambda x: self._nearness(x, at, needed)), at, needed
            case f.Always(bounds, body) | f.Eventually(bounds, body):
                low, high = _window(at, *seconds(bounds))
                if isinstance(part, f.Always) is needed:
                    yield from self._first(body, low, high, needed)
                else:
                    yield from self._best(body, low, high, needed)
            case f.Until(left, bounds, right):
                if needed:
                    yield from self._until(left, right, *_window(at, *seconds(bounds)))
            case f.Occupies() | f.Some() | f.Every():
                raise AssertionError("what is judged is bound to a road")
            case _:
                assert_never(part)

    def _until(
        self, left: Formula, right: Formula, low: Fraction, high: Fraction | None
    ) -> Iterator[tuple[Formula, Fraction, bool]]:
        """The left part where it breaks, if the right part comes at all; else the right part."""
        if intersection([self.judgement.truth(right), interval(low, high)]).cuts:
            yield from self._first(left, low, high, True)
        else:
            yield from self._best(right, low, high, True)

    def _first(
        self, body: Formula, low: Fraction, high: Fraction | None, needed: bool
    ) -> Iterator[tuple[Formula, Fraction, bool]]:
        """The first instant at which the body is not as needed."""
        truth = self.judgement.truth(body)
        wrong = intersection([complement(truth) if needed else truth, interval(low, high)])
        for span in wrong.spans()[:1]:
            at = _inside(span, wrong)
            if at is not None:
                yield body, at, needed

    def _best(
        self, body: Formula, low: Fraction, high: Fraction | None, needed: bool
    ) -> Iterator[tuple[Formula, Fraction, bool]]:
        """The instant at which most of the body is as needed, where it never is altogether."""
        end = self.horizon if high is None else min(high, self.horizon)
        instants = [
            x for x in self._instants(body, low, end) if self.judgement.truth(body).at(x) is not needed
        ]
        if instants:
            yield body, max(instants, key=lambda x: self.score(body, x, needed)), needed

    def _instants(self, body: Formula, low: Fraction, end: Fraction) -> list[Fraction]:
        """Instants at which a direct part of the body changes, and ``low``; evenly chosen where many."""
        bare = _bare(body)
        found = {low}
        for part in (bare, *f.children(bare)):
            truth = self.judgement.truth(part)
            for one in (truth, complement(truth)):
                inside = (_inside(span, one) for span in one.spans())
                found |= {x for x in inside if x is not None and low <= x <= end}
        every = sorted(found)
        step = -(-len(every) // MOST_INSTANTS)
        return every[::step]


def _bare(part: Formula) -> Formula:
    """A part without the names and negations around it."""
    while isinstance(part, f.Application | f.Not):
        part = part.body
    return part


def _window(at: Fraction, low: Fraction, high: Fraction | None) -> tuple[Fraction, Fraction | None]:
    return at + low, None if high is None else at + high


def _inside(span: Span, truth: TruthSet) -> Fraction | None:
    """A rational instant of a span, its first where it has one."""
    begin, end = span
    if not begin.after and not isinstance(begin.point, Root):
        return Fraction(begin.point)
    low = Fraction(approximate(begin.point))
    high = low + 1 if end is None else Fraction(approximate(end.point))
    soon = Fraction(int(low * _FINE) + 1, _FINE)
    return next((x for x in (soon, (low + high) / 2) if x >= 0 and truth.at(x)), None)


def _value(courses: Courses, term: Term, at: Fraction) -> Fraction:
    """The value of a term at an instant."""
    course = [p for start, p in courses.of(term) if start <= at][-1]
    whole = reduce(lambda sum_, x: sum_ * at + x, reversed(course.numerators), Fraction(0))
    return whole / course.denominator


def told(part: FalsePart, words: Mapping[str, Definition]) -> str:
    """A false part as a sentence: the definition, the values, what it needs and the change.

    ``words``: definitions by name.
    """
    comparison, unit = part.comparison, SI.get(_dimension(part.comparison.left), "")
    values = ", ".join(
        f"{_shown(x)} = {_number(value)} {SI.get(_dimension(x), '')}".strip()
        for x, value in part.values.items()
    )
    op = comparison.op if part.needed else f.NEGATED[comparison.op]
    said = text(as_syntax(f.Compare(comparison.left, op, comparison.right)))
    sides = f"left side {_number(part.left)} {unit}, right side {_number(part.right)} {unit}"
    needs = said if len(said) <= LONGEST else f"left side {op} right side of the comparison, {sides}"
    side = _shown(comparison.left) if isinstance(comparison.left, t.Signal) else "the left side"
    return (
        f"{_definition(part, words)} at {_number(part.at)} s ({values}): "
        f"it needs {needs}; {'raise' if op in ('>', '>=') else 'lower'} {side} "
        f"by {'more than' if op in ('<', '>') else 'at least'} {_number(part.lack)} {unit} there"
    )


def _definition(part: FalsePart, words: Mapping[str, Definition]) -> str:
    if part.part is None:
        return "a comparison fails"
    name = part.part.name.partition("@")[0]
    said = f"{name}({', '.join(part.part.arguments)})"
    definition = words.get(name)
    if definition is not None and definition.doc and "[" not in definition.doc:
        pairs = zip((x.name for x in definition.parameters), part.part.arguments, strict=False)
        meant = ", ".join(f"{own} is {given}" for own, given in pairs if own != given)
        said += f" '{definition.doc}'" + (f", where {meant}," if meant else "")
    return f"{said} is {'false' if part.part_needed else 'true'}"


def _shown(term: t.Signal | t.Size) -> str:
    return f"{term.name}({term.vehicle})"


def _number(value: Fraction) -> str:
    return f"{float(value):.6g}"


def _dimension(term: Term) -> Dimension:
    match term:
        case t.Number() | t.Parameter() | t.Variable() | t.Own():
            return term.dimension
        case t.Signal(name, _):
            return t.SIGNAL_DIMENSIONS[name]
        case t.Size(name, _):
            return t.SIZE_DIMENSIONS[name]
        case t.Sum(terms) | t.Maximum(terms) | t.Minimum(terms):
            return next((x for x in map(_dimension, terms) if x != (0, 0)), (0, 0))
        case t.Product(factors):
            lengths, times = zip(*map(_dimension, factors), strict=True)
            return sum(lengths), sum(times)
        case t.Power(base, exponent):
            length, time = _dimension(base)
            return length * exponent, time * exponent
        case t.Quotient(above, below):
            (length, time), (less, shorter) = _dimension(above), _dimension(below)
            return length - less, time - shorter
        case t.Inverse(inner):
            length, time = _dimension(inner)
            return -length, -time
        case _:
            assert_never(term)
