"""The first false part of a formula on a drive, with the values there and a change that makes it true.

The score of a formula is the share of its parts that hold. Truth and values are those of the exact judge.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce
from typing import TypeAlias, assert_never

from roadproof.extensions.catalogue.change_text import change_text
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.logic.syntax import Definition
from roadproof.logic.terms import Term
from roadproof.semantics.exact.algebraic import Root, as_float
from roadproof.semantics.exact.judging import DriveJudge, Judgement, interval_seconds
from roadproof.semantics.exact.signals import TermPieces
from roadproof.semantics.exact.truth import Span, TruthSet, complement, intersection, interval
from roadproof.world.units import SI, Dimension

MOST_INSTANTS = 12
"""The most instants at which the body of an eventuality is judged."""
LONGEST = 100
"""The most characters of a comparison that is written out."""
_GRID = 1000  # instants inside a span are multiples of 1/1000 s where possible


@dataclass(frozen=True)
class FalsePart:
    """A comparison without the truth value that a formula needs at the instant ``at`` (s).

    ``part``: the definition around it; ``part_needed`` and ``needed``: the truth values that are needed of
    the definition and of the comparison. ``left`` and ``right``: the values of its sides (SI); ``values``:
    those of its signals and sizes. ``score``: the share of the formula's parts that hold.
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
        """The difference of the sides (SI), by which one of them must change."""
        return abs(self.left - self.right)


def first_false_part(formula: Formula, judge: DriveJudge, horizon: Fraction) -> FalsePart | None:
    """Return the first part whose falsity makes a bound formula false at time 0, up to ``horizon`` (s).

    ``judge``: that of the vehicles. None where the formula holds, or where no single comparison at one
    instant is to blame.
    """
    judgement, courses = judge.judgement(formula), judge.courses
    if judgement.holds:
        return None
    search = _BlameSearch(judgement, courses, horizon)
    leaf = search.leaf(formula, Fraction(0), True, (None, True))
    if leaf is None:
        return None
    (part, part_needed), comparison, needed, at = leaf
    leaves = dict.fromkeys(
        x
        for side in (comparison.left, comparison.right)
        for x in t.leaves(side)
        if isinstance(x, t.Signal | t.Size)
    )
    values = {x: _value(courses, x, at) for x in leaves}
    left, right = _value(courses, comparison.left, at), _value(courses, comparison.right, at)
    score = search.score(formula, Fraction(0), True)
    return FalsePart(part, part_needed, comparison, needed, at, left, right, values, score)


_Within: TypeAlias = tuple[f.Application | None, bool]
_Leaf: TypeAlias = tuple[_Within, f.Compare, bool, Fraction]


@dataclass(frozen=True)
class _BlameSearch:
    """A search for the comparison to blame for a false formula; ``scores``: those worked out so far."""

    judgement: Judgement
    courses: TermPieces
    horizon: Fraction
    scores: dict[tuple[Formula, Fraction, bool], Fraction] = field(default_factory=dict)

    def leaf(self, part: Formula, at: Fraction, needed: bool, within: _Within) -> _Leaf | None:
        """Return the comparison to blame for a part whose truth at ``at`` is not ``needed``."""
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
        """Return the share of the parts whose truth is as ``needed``, 1 where that of the whole is."""
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
        blamed = next(self.blamed(part, at, needed), None)
        return Fraction(0) if blamed is None else self._weighted_score(part, needed, blamed)

    def _nearness(self, part: Formula, at: Fraction, needed: bool) -> tuple[Fraction, Fraction]:
        """Return the score of a part, and the negative lack of its comparison (SI) to order equal scores."""
        leaf = self.leaf(part, at, needed, (None, True))
        if leaf is None:
            return self.score(part, at, needed), Fraction(0)
        _, comparison, _, when = leaf
        sides = (_value(self.courses, x, when) for x in (comparison.left, comparison.right))
        left, right = sides
        return self.score(part, at, needed), -abs(left - right)

    def _weighted_score(
        self, part: Formula, needed: bool, blamed: tuple[Formula, Fraction, bool]
    ) -> Fraction:
        """Return the score of a part from that of the part to blame.

        Half where that one needs to last; the two sides of an until count half each.
        """
        score = self.score(*blamed)
        if isinstance(part, f.Until):
            return (score + (blamed[0] is part.left)) / 2
        lasts = isinstance(part, f.Always | f.Eventually) and isinstance(part, f.Always) is needed
        return score / 2 if lasts else score

    def blamed(self, part: Formula, at: Fraction, needed: bool) -> Iterator[tuple[Formula, Fraction, bool]]:
        """Yield the part below that is to blame, with the instant and the truth that it needs; or nothing."""
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
                low, high = _window(at, *interval_seconds(bounds))
                if isinstance(part, f.Always) is needed:
                    yield from self._first(body, low, high, needed)
                else:
                    yield from self._best(body, low, high, needed)
            case f.Until(left, bounds, right):
                if needed:
                    yield from self._until(left, right, *_window(at, *interval_seconds(bounds)))
            case f.Since(left, bounds, right):
                low, high = interval_seconds(bounds)
                if needed and low <= at:
                    begin = Fraction(0) if high is None else max(Fraction(0), at - high)
                    yield from self._until(left, right, begin, at - low)
            case f.Occupies() | f.Some() | f.Every():
                raise AssertionError("what is judged is bound to a road")
            case _:
                assert_never(part)

    def _until(
        self, left: Formula, right: Formula, low: Fraction, high: Fraction | None
    ) -> Iterator[tuple[Formula, Fraction, bool]]:
        """Yield the left part where it becomes false, if the right part is ever true; else the right part."""
        if intersection([self.judgement.truth(right), interval(low, high)]).cuts:
            yield from self._first(left, low, high, True)
        else:
            yield from self._best(right, low, high, True)

    def _first(
        self, body: Formula, low: Fraction, high: Fraction | None, needed: bool
    ) -> Iterator[tuple[Formula, Fraction, bool]]:
        """Yield the first instant at which the truth of the body is not as needed."""
        truth = self.judgement.truth(body)
        wrong = intersection([complement(truth) if needed else truth, interval(low, high)])
        for span in wrong.spans()[:1]:
            at = _inside(span, wrong)
            if at is not None:
                yield body, at, needed

    def _best(
        self, body: Formula, low: Fraction, high: Fraction | None, needed: bool
    ) -> Iterator[tuple[Formula, Fraction, bool]]:
        """Yield the instant with the best score of the body, where its truth is never as needed."""
        end = self.horizon if high is None else min(high, self.horizon)
        instants = [
            x for x in self._instants(body, low, end) if self.judgement.truth(body).at(x) is not needed
        ]
        if instants:
            yield body, max(instants, key=lambda x: self.score(body, x, needed)), needed

    def _instants(self, body: Formula, low: Fraction, end: Fraction) -> list[Fraction]:
        """Return instants at which a direct part of the body changes, and ``low``; evenly chosen if many."""
        bare = _bare(body)
        instants = {low}
        for part in (bare, *f.children(bare)):
            truth = self.judgement.truth(part)
            for one in (truth, complement(truth)):
                inside = (_inside(span, one) for span in one.spans())
                instants |= {x for x in inside if x is not None and low <= x <= end}
        every = sorted(instants)
        step = -(-len(every) // MOST_INSTANTS)
        return every[::step]


def _bare(part: Formula) -> Formula:
    """Return a part without the names and negations around it."""
    while isinstance(part, f.Application | f.Not):
        part = part.body
    return part


def _window(at: Fraction, low: Fraction, high: Fraction | None) -> tuple[Fraction, Fraction | None]:
    """Return an interval as seen from ``at``."""
    return at + low, None if high is None else at + high


def _inside(span: Span, truth: TruthSet) -> Fraction | None:
    """Return a rational instant of a span, its first where it has a rational one."""
    begin, end = span
    if not begin.after and not isinstance(begin.point, Root):
        return Fraction(begin.point)
    low = Fraction(as_float(begin.point))
    high = low + 1 if end is None else Fraction(as_float(end.point))
    soon = Fraction(int(low * _GRID) + 1, _GRID)
    return next((x for x in (soon, (low + high) / 2) if x >= 0 and truth.at(x)), None)


def _value(courses: TermPieces, term: Term, at: Fraction) -> Fraction:
    """Return the value of a term at an instant (SI)."""
    course = [p for start, p in courses.of(term) if start <= at][-1]
    whole = reduce(lambda sum_, x: sum_ * at + x, reversed(course.numerators), Fraction(0))
    return whole / course.denominator


def false_part_text(part: FalsePart, definitions: Mapping[str, Definition]) -> str:
    """Return a sentence with the definition, the values, the need and the change.

    ``definitions``: by name.
    """
    comparison, unit = part.comparison, SI.get(_dimension(part.comparison.left), "")
    values = ", ".join(
        f"{_term_text(x)} = {_number(value)} {SI.get(_dimension(x), '')}".strip()
        for x, value in part.values.items()
    )
    op = comparison.op if part.needed else f.NEGATED[comparison.op]
    need = text(as_syntax(f.Compare(comparison.left, op, comparison.right)))
    sides = f"left side {_number(part.left)} {unit}, right side {_number(part.right)} {unit}"
    needs = need if len(need) <= LONGEST else f"left side {op} right side of the comparison, {sides}"
    change = change_text(comparison, op, part.values)
    if not change:
        change = f"a side has to change by {_number(part.lack)} {unit}".rstrip()
    return f"{_definition(part, definitions)} at {_number(part.at)} s ({values}): it needs {needs}; {change}"


def _definition(part: FalsePart, definitions: Mapping[str, Definition]) -> str:
    """Return the definition around a comparison with its description, and that it is true or false."""
    if part.part is None:
        return "a comparison fails"
    name = part.part.name.partition("@")[0]
    sentence = f"{name}({', '.join(part.part.arguments)})"
    definition = definitions.get(name)
    if definition is not None and definition.doc and "[" not in definition.doc:
        pairs = zip((x.name for x in definition.parameters), part.part.arguments, strict=False)
        meaning = ", ".join(f"{own} is {actual}" for own, actual in pairs if own != actual)
        sentence += f" '{definition.doc}'" + (f", where {meaning}," if meaning else "")
    return f"{sentence} is {'false' if part.part_needed else 'true'}"


def _term_text(term: t.Signal | t.Size) -> str:
    return f"{term.name}({term.vehicle})"


def _number(value: Fraction) -> str:
    return f"{float(value):.6g}"


def _dimension(term: Term) -> Dimension:
    match term:
        case t.Number() | t.Parameter() | t.Variable() | t.CustomSignal():
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
