"""Why a formula is true or false at an instant: which of its parts make it so, and when.

What is named is enough: whatever the other parts were, and these at other times, the formula would be the
same. It is not always least, since of several reasons at one instant the first in the text is taken, and
over a stretch of time all that is of the same kind.
"""

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import TypeAlias, assert_never

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.exact import truth as sets
from roadproof.semantics.exact.algebraic import moved
from roadproof.semantics.exact.exact import Judgement, seconds

Blame: TypeAlias = Mapping[Formula, sets.TruthSet]
_Want: TypeAlias = Callable[[Formula, sets.TruthSet, bool], None]


def blame(judgement: Judgement, formula: Formula | None = None, at: Fraction = Fraction(0)) -> Blame:
    """The instants at which each part makes ``formula`` (the whole where None) what it is at ``at`` (s).

    Parts that have no share in it are left out. Raises ``UsageError`` where it is no judged part.
    """
    asked = judgement.formula if formula is None else formula
    wanted: dict[tuple[Formula, bool], sets.TruthSet] = {}

    def want(part: Formula, instants: sets.TruthSet, value: bool) -> None:
        if instants.cuts:
            wanted[part, value] = sets.union([wanted.get((part, value), sets.NEVER), instants])

    want(asked, sets.interval(at, at), judgement.truth(asked).at(at))
    for part in _parents_first(asked):
        for value in (True, False):
            instants = wanted.get((part, value), sets.NEVER)
            if instants.cuts:
                _share(judgement, part, instants, value, want)
    parts = dict.fromkeys(part for part, _ in wanted)
    return {
        part: sets.union([wanted.get((part, True), sets.NEVER), wanted.get((part, False), sets.NEVER)])
        for part in parts
    }


def _parents_first(formula: Formula) -> Iterator[Formula]:
    """Every sub-formula once, after all that it is a part of."""
    done: list[Formula] = []
    seen: set[Formula] = set()
    waiting = [(formula, False)]
    while waiting:
        current, left = waiting.pop()
        if left:
            done.append(current)
        elif current not in seen:
            seen.add(current)
            waiting.append((current, True))
            waiting += [(child, False) for child in f.children(current)]
    return reversed(done)


def _share(judgement: Judgement, part: Formula, instants: sets.TruthSet, value: bool, want: _Want) -> None:
    """Ask of the direct parts what makes ``part`` have ``value`` at all of ``instants``."""
    match part:
        case f.Truth() | f.Compare():
            return
        case f.Not(body):
            want(body, instants, not value)
        case f.Application(_, _, body):
            want(body, instants, value)
        case f.And(parts) | f.Or(parts):
            if isinstance(part, f.And) is value:
                for one in parts:
                    want(one, instants, value)
            else:
                _some_of(judgement, parts, instants, value, want)
        case f.Eventually(bounds, body) | f.Always(bounds, body):
            window = _later(instants, *seconds(bounds))
            if isinstance(part, f.Always) is value:
                want(body, window, value)
            else:
                want(body, _first(instants, sets.intersection([window, _is(judgement, body, value)])), value)
        case f.Until():
            _until(judgement, part, instants, value, want)
        case f.Occupies() | f.Some() | f.Every():
            raise AssertionError("what is judged is bound to a road")
        case _:
            assert_never(part)


def _some_of(
    judgement: Judgement, parts: tuple[Formula, ...], instants: sets.TruthSet, value: bool, want: _Want
) -> None:
    """At each instant the first of ``parts`` that has ``value``."""
    left = instants
    for one in parts:
        here = _is(judgement, one, value)
        want(one, sets.intersection([left, here]), value)
        left = sets.intersection([left, sets.complement(here)])


def _until(judgement: Judgement, part: f.Until, instants: sets.TruthSet, value: bool, want: _Want) -> None:
    low, high = seconds(part.interval)
    window = _later(instants, low, high)
    left = _is(judgement, part.left, value)
    right = _is(judgement, part.right, value)
    if not _is_instant(instants):
        want(part.left, sets.intersection([window, left]), value)
        want(part.right, sets.intersection([window, right]), value)
    elif value:
        reached = _first_span(sets.intersection([window, right]))
        want(part.right, reached, True)
        want(part.left, sets.intersection([_up_to(window, reached), left]), True)
    else:
        broken = _first_span(sets.intersection([window, left]))
        want(part.left, broken, False)
        want(part.right, _until_begin(window, broken), False)


def _is(judgement: Judgement, part: Formula, value: bool) -> sets.TruthSet:
    truth = judgement.truth(part)
    return truth if value else sets.complement(truth)


def _later(instants: sets.TruthSet, low: Fraction, high: Fraction | None) -> sets.TruthSet:
    """All instants that are ``low`` to ``high`` seconds after one of ``instants``."""
    return sets.union([sets.TruthSet(_moved(span, low, high)) for span in instants.spans()])


def _moved(span: sets.Span, low: Fraction, high: Fraction | None) -> tuple[sets.Cut, ...]:
    begin = sets.Cut(moved(span.begin.point, low), span.begin.after)
    if span.end is None or high is None:
        return (begin,)
    return begin, sets.Cut(moved(span.end.point, high), span.end.after)


def _is_instant(instants: sets.TruthSet) -> bool:
    spans = instants.spans()
    return len(spans) == 1 and spans[0].end is not None and spans[0].begin.point == spans[0].end.point


def _first(instants: sets.TruthSet, found: sets.TruthSet) -> sets.TruthSet:
    """One stretch of ``found`` is enough for one instant; for more all of it is taken."""
    return _first_span(found) if _is_instant(instants) else found


def _first_span(truth: sets.TruthSet) -> sets.TruthSet:
    return sets.TruthSet(truth.cuts[:2])


def _up_to(window: sets.TruthSet, reached: sets.TruthSet) -> sets.TruthSet:
    """The window up to the end of what was reached."""
    end = reached.cuts[1:2]
    return sets.intersection([window, sets.ALWAYS if not end else sets.complement(sets.TruthSet(end))])


def _until_begin(window: sets.TruthSet, broken: sets.TruthSet) -> sets.TruthSet:
    """The window up to the first instant of ``broken``, with it; all of it where there is none."""
    if not broken.cuts:
        return window
    return sets.intersection(
        [window, sets.complement(sets.TruthSet((sets.Cut(broken.cuts[0].point, True),)))]
    )
