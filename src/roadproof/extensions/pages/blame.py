"""Explains why a formula is true or false at an instant: which of its parts make it so, and when.

The result is sufficient: whatever the values of other parts, and of these parts at other times, the formula
keeps its value. It is not always minimal: of several reasons at one instant it has the first in the text, and
over a stretch of time all reasons of the same kind.
"""

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import TypeAlias, assert_never

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.exact import truth as sets
from roadproof.semantics.exact.algebraic import moved
from roadproof.semantics.exact.judging import Judgement, interval_seconds

Blame: TypeAlias = Mapping[Formula, sets.TruthSet]
_Require: TypeAlias = Callable[[Formula, sets.TruthSet, bool], None]


def blame(judgement: Judgement, formula: Formula | None = None, at: Fraction = Fraction(0)) -> Blame:
    """Return the instants at which each part makes ``formula`` true or false at time ``at`` (s).

    ``formula``: a judged part, the whole formula where None. Parts without influence are left out. Raises
    ``UsageError`` for a formula that is no judged part.
    """
    whole = judgement.formula if formula is None else formula
    required: dict[tuple[Formula, bool], sets.TruthSet] = {}

    def require(part: Formula, instants: sets.TruthSet, value: bool) -> None:
        if instants.cuts:
            required[part, value] = sets.union([required.get((part, value), sets.NEVER), instants])

    require(whole, sets.interval(at, at), judgement.truth(whole).at(at))
    for part in _parents_first(whole):
        for value in (True, False):
            instants = required.get((part, value), sets.NEVER)
            if instants.cuts:
                _require_parts(judgement, part, instants, value, require)
    parts = dict.fromkeys(part for part, _ in required)
    return {
        part: sets.union([required.get((part, True), sets.NEVER), required.get((part, False), sets.NEVER)])
        for part in parts
    }


def _parents_first(formula: Formula) -> Iterator[Formula]:
    """Yield every sub-formula once, after all formulas that contain it."""
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


def _require_parts(
    judgement: Judgement, part: Formula, instants: sets.TruthSet, value: bool, require: _Require
) -> None:
    """Require of the direct parts what makes ``part`` have ``value`` at all of ``instants``."""
    match part:
        case f.Truth() | f.Compare():
            return
        case f.Not(body):
            require(body, instants, not value)
        case f.Application(_, _, body):
            require(body, instants, value)
        case f.And(parts) | f.Or(parts):
            if isinstance(part, f.And) is value:
                for one in parts:
                    require(one, instants, value)
            else:
                _require_first(judgement, parts, instants, value, require)
        case f.Eventually(bounds, body) | f.Always(bounds, body):
            window = _shifted(instants, *interval_seconds(bounds))
            if isinstance(part, f.Always) is value:
                require(body, window, value)
            else:
                require(
                    body,
                    _first_stretch(
                        instants, sets.intersection([window, _instants_with(judgement, body, value)])
                    ),
                    value,
                )
        case f.Until():
            _require_until(judgement, part, instants, value, require)
        case f.Since(left, bounds, right):
            window = _shifted_before(instants, *interval_seconds(bounds))
            for below in (left, right):
                require(below, sets.intersection([window, _instants_with(judgement, below, value)]), value)
        case f.Occupies() | f.Some() | f.Every():
            raise AssertionError("what is judged is bound to a road")
        case _:
            assert_never(part)


def _require_first(
    judgement: Judgement, parts: tuple[Formula, ...], instants: sets.TruthSet, value: bool, require: _Require
) -> None:
    """Require at each instant the first of ``parts`` that has ``value``."""
    remaining = instants
    for part in parts:
        here = _instants_with(judgement, part, value)
        require(part, sets.intersection([remaining, here]), value)
        remaining = sets.intersection([remaining, sets.complement(here)])


def _require_until(
    judgement: Judgement, part: f.Until, instants: sets.TruthSet, value: bool, require: _Require
) -> None:
    low, high = interval_seconds(part.interval)
    window = _shifted(instants, low, high)
    left = _instants_with(judgement, part.left, value)
    right = _instants_with(judgement, part.right, value)
    if not _is_instant(instants):
        require(part.left, sets.intersection([window, left]), value)
        require(part.right, sets.intersection([window, right]), value)
    elif value:
        reached = _first_span(sets.intersection([window, right]))
        require(part.right, reached, True)
        require(part.left, sets.intersection([_up_to_end(window, reached), left]), True)
    else:
        broken = _first_span(sets.intersection([window, left]))
        require(part.left, broken, False)
        require(part.right, _up_to_start(window, broken), False)


def _instants_with(judgement: Judgement, part: Formula, value: bool) -> sets.TruthSet:
    truth = judgement.truth(part)
    return truth if value else sets.complement(truth)


def _shifted(instants: sets.TruthSet, low: Fraction, high: Fraction | None) -> sets.TruthSet:
    """Return all instants that are ``low`` to ``high`` seconds after one of ``instants``."""
    return sets.union([sets.TruthSet(_shifted_cuts(span, low, high)) for span in instants.spans()])


def _shifted_before(instants: sets.TruthSet, low: Fraction, high: Fraction | None) -> sets.TruthSet:
    """Return all instants that are ``low`` to ``high`` seconds before one of ``instants``."""
    return sets.eventually(low, high, instants)


def _shifted_cuts(span: sets.Span, low: Fraction, high: Fraction | None) -> tuple[sets.Cut, ...]:
    begin = sets.Cut(moved(span.begin.point, low), span.begin.after)
    if span.end is None or high is None:
        return (begin,)
    return begin, sets.Cut(moved(span.end.point, high), span.end.after)


def _is_instant(instants: sets.TruthSet) -> bool:
    spans = instants.spans()
    return len(spans) == 1 and spans[0].end is not None and spans[0].begin.point == spans[0].end.point


def _first_stretch(instants: sets.TruthSet, truth: sets.TruthSet) -> sets.TruthSet:
    """Return the first stretch of ``truth`` for a single instant, all of ``truth`` for more."""
    return _first_span(truth) if _is_instant(instants) else truth


def _first_span(truth: sets.TruthSet) -> sets.TruthSet:
    return sets.TruthSet(truth.cuts[:2])


def _up_to_end(window: sets.TruthSet, reached: sets.TruthSet) -> sets.TruthSet:
    """Return the window up to the end of ``reached``."""
    end = reached.cuts[1:2]
    return sets.intersection([window, sets.ALWAYS if not end else sets.complement(sets.TruthSet(end))])


def _up_to_start(window: sets.TruthSet, broken: sets.TruthSet) -> sets.TruthSet:
    """Return the window up to and including the first instant of ``broken``; all of it where that
    is empty.
    """
    if not broken.cuts:
        return window
    return sets.intersection(
        [window, sets.complement(sets.TruthSet((sets.Cut(broken.cuts[0].point, True),)))]
    )
