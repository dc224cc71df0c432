"""Partitions of time: consecutive parts, each with the rational instant, or case, of its derivation."""

from collections.abc import Callable, Collection, Iterator, Sequence
from fractions import Fraction
from typing import TypeVar

from roadproof.errors import RoadproofError
from roadproof.extensions.kernel.derivation import (
    Crossing,
    DerivationMoment,
    DerivationStep,
    Fixed,
    Later,
    Soon,
    split,
)
from roadproof.extensions.kernel.derivations.signs import Signs, TimePart, rational_of, splits
from roadproof.reasons import Reason, ReasonKind
from roadproof.semantics.exact.algebraic import Point, Root, bounds
from roadproof.semantics.exact.polynomial import sign_at
from roadproof.semantics.exact.truth import START, Cut, Span, TruthSet

Served = TypeVar("Served")
MOST_PARTS = 300
DEEPEST = 16  # how often a part is halved until a sign is seen
"""Parts that follow each other towards an irrational instant never reach it."""


class NoDerivationError(RoadproofError):
    """The search found no derivation, for this reason; there may be one."""

    def __init__(self, reason: Reason) -> None:
        super().__init__(reason)
        self.reason = reason


def contains(truth: TruthSet, part: TimePart) -> bool:
    """Return whether a truth set contains all of a part."""
    span = _span_at(truth, part.begin)
    return span is not None and _ends_by(part.end, span.end)


def _span_at(truth: TruthSet, cut: Cut) -> Span | None:
    """Return the interval of a truth set that contains the time right after ``cut``."""
    return next((x for x in truth.spans() if x.begin <= cut and (x.end is None or cut < x.end)), None)


def _ends_by(end: Cut | None, limit: Cut | None) -> bool:
    return limit is None or (end is not None and end <= limit)


def join_steps(steps: Sequence[tuple[TimePart, DerivationStep]]) -> DerivationStep:
    """Return one step from steps for consecutive parts."""
    step = steps[-1][1]
    for part, before in reversed(steps[:-1]):
        if part.end is None:
            raise ValueError("a part without end is the last")
        step = split(Fraction(part.stop or 0), part.end.after, before, step)
    return step


def covered(part: TimePart, sets: Sequence[TruthSet]) -> Iterator[tuple[TimePart, int | Root]]:
    """Yield consecutive parts of ``part``, each with the number of a set that contains it.

    A root instead of a number marks a part in which one set ends and another begins.
    """
    cut = part.begin
    for _ in range(MOST_PARTS):
        reaching = [(span, k) for k, x in enumerate(sets) if (span := _span_at(x, cut)) is not None]
        if not reaching:
            raise NoDerivationError(ReasonKind.IRRATIONAL_CHANGE())
        whole = next(((span, k) for span, k in reaching if _ends_by(part.end, span.end)), None)
        if whole is not None:
            yield TimePart(cut, part.end), whole[1]
            return
        span, place = max(reaching, key=lambda x: x[0].end or cut)
        if span.end is None:
            raise ValueError("an interval for ever covers what is left")
        end = span.end
        if isinstance(end.point, Root):
            others = [y for x in sets for y in x.spans() if y.begin <= end and (y.end is None or end < y.end)]
            first = min((y.begin for y in others), default=None)
            if first is None:
                raise NoDerivationError(ReasonKind.IRRATIONAL_CHANGE())
            if first.point == end.point:
                change = end.point
                following = max((y for x in sets for y in x.spans() if y.begin == first), key=_by_end)
                before, after = _around(change, cut, following.end, part.end)
                if cut < before:
                    yield TimePart(cut, before), place
                yield TimePart(before, after), change
                if after == part.end:
                    return
                cut = after
                continue
            end = Cut(between(max(first, cut).point, end.point), False)
        yield TimePart(cut, end), place
        cut = end
    raise NoDerivationError(ReasonKind.IRRATIONAL_LIMIT())


def _by_end(span: Span) -> tuple[bool, Cut]:
    return (True, START) if span.end is None else (False, span.end)


def _around(change: Root, begin: Cut, limit: Cut | None, end: Cut | None) -> tuple[Cut, Cut]:
    """Return rational cuts close to ``change``, not before ``begin``, not after ``limit`` and ``end``."""
    low, high = bounds(change, Fraction(1, 64))
    while (limit is not None and not Cut(high, False) <= limit) or not begin <= Cut(low, False):
        low, high = bounds(change, (high - low) / 8)
        if high - low < Fraction(1, 2**400):
            raise NoDerivationError(ReasonKind.CHANGE_TWICE())
    after = Cut(high, False)
    return Cut(low, False), after if end is None or after <= end else end


def widened(part: TimePart, window: tuple[Fraction, Fraction | None]) -> TimePart:
    """Return all times that windows from a part can reach."""
    low, high = window
    end = None if part.end is None or high is None else moved(part.end, high)
    return TimePart(moved(part.begin, low), end)


def image(part: TimePart, moment: DerivationMoment) -> TimePart:
    """Return the times that a moment has for the instants of a part."""
    if isinstance(moment, Fixed):
        return TimePart(Cut(moment.time, False), Cut(moment.time, True))
    return TimePart(
        moved(part.begin, moment.time), None if part.end is None else moved(part.end, moment.time)
    )


def run(part: TimePart, moment: DerivationMoment, low: Fraction, out: bool) -> TimePart:
    """Return the times from the beginning of windows to the moment, without the moment if ``out``."""
    begin = moved(part.begin, low)
    if isinstance(moment, Fixed):
        return TimePart(begin, Cut(moment.time, not out))
    if part.end is None:
        return TimePart(begin, None)
    end = moved(part.end, moment.time)
    return TimePart(begin, Cut(end.point, end.after and not out))


def at_once(part: TimePart, moment: DerivationMoment, low: Fraction) -> bool:
    """Return whether the moment is the beginning of every window."""
    return moment.time <= (low if isinstance(moment, Later) else part.start + low)


def moved(cut: Cut, by: Fraction) -> Cut:
    """Return a cut that is ``by`` seconds later."""
    if isinstance(cut.point, Root):
        raise NoDerivationError(ReasonKind.IRRATIONAL())
    return Cut(cut.point + by, cut.after)


def _in_turn(
    part: TimePart, serve: Callable[[Cut], tuple[Cut | None, Served]], stuck: Reason
) -> Iterator[tuple[TimePart, Served]]:
    """Yield consecutive parts, each with the choice of ``serve`` and as long as it lasts.

    ``stuck``: the reason if ``serve`` makes no progress.
    """
    cut = part.begin
    for _ in range(MOST_PARTS):
        end, result = serve(cut)
        yield TimePart(cut, end), result
        if end == part.end:
            return
        if end is None or end <= cut:
            raise NoDerivationError(stuck)
        cut = end
    raise NoDerivationError(ReasonKind.IRRATIONAL_LIMIT())


def moments(
    part: TimePart, window: tuple[Fraction, Fraction | None], right: TruthSet, left: TruthSet
) -> Iterator[tuple[TimePart, DerivationMoment | Crossing]]:
    """Yield consecutive parts, each with a moment at which ``right`` holds, and ``left`` until then."""
    low, high = window

    def serve(cut: Cut) -> tuple[Cut | None, DerivationMoment | Crossing]:
        """Return the end of the part that begins at ``cut``, and its moment."""
        here = _span_at(right, moved(cut, low))
        if here is None:
            return _later(part, cut, low, high, right, left)
        return _before(here.end, low, part.end, cut), Later(low)

    return _in_turn(part, serve, ReasonKind.NO_INSTANT())


def _before(limit: Cut | None, low: Fraction, target: Cut | None, cut: Cut) -> Cut | None:
    """Return the last instant whose window begins before ``limit``: ``target``, or a rational before it."""
    if limit is None:
        return target
    if not isinstance(limit.point, Root):
        last = moved(limit, -low)
        return last if target is None or last < target else target
    if target is not None and moved(target, low) < limit:
        return target
    return Cut(between(moved(cut, low).point, limit.point) - low, False)


def _later(
    part: TimePart, cut: Cut, low: Fraction, high: Fraction | None, right: TruthSet, left: TruthSet
) -> tuple[Cut | None, DerivationMoment | Crossing]:
    """Return a moment after ``cut`` and the begin of its window, and the end of the part it serves."""
    start = TimePart(cut, None).start
    first = moved(cut, low)
    lasting = _span_at(left, first)
    if lasting is None:
        raise NoDerivationError(ReasonKind.NO_INSTANT())
    last = None if high is None else start + high
    for span in right.spans():
        if span.begin < first:
            continue
        ends: list[Point] = [] if last is None else [last]
        ends += [x.point for x in (span.end, lasting.end) if x is not None]
        stop = min(ends) if ends else None
        if stop is not None and stop < span.begin.point:
            break
        if stop is None and part.end is None:
            return None, Later(between(span.begin.point, None) - start)
        target = None if part.stop is None else part.stop + low
        time = _instant(span, stop, target)
        if time is not None:
            end = Cut(time - low, True)
            return (part.end if part.end is not None and part.end <= end else end), Fixed(time)
        if stop == span.begin.point and not span.begin.after:
            crossing = _crossing(part, span.begin.point, low, last)
            if crossing is not None:
                return part.end, crossing
    raise NoDerivationError(ReasonKind.NO_INSTANT())


def _crossing(part: TimePart, change: Point, low: Fraction, limit: Point | None) -> Crossing | None:
    """Return an irrational instant after the beginning of all windows of a part, and before ``limit``."""
    if not isinstance(change, Root) or part.stop is None or change <= part.stop + low:
        return None
    last = None if limit is None else Cut(limit, False)
    before, after = _around(change, Cut(part.stop + low, False), last, None)
    return Crossing(rational_of(before), rational_of(after), change.polynomial)


def narrowed(crossing: Crossing, times: Collection[Fraction]) -> Crossing:
    """Return the same instant with bounds so close that none of ``times`` lies between them."""
    begin, end = crossing.begin, crossing.end
    first = sign_at(crossing.polynomial, begin)
    while any(begin < x < end for x in times):
        middle = (begin + end) / 2
        if sign_at(crossing.polynomial, middle) == first:
            begin = middle
        else:
            end = middle
    return Crossing(begin, end, crossing.polynomial)


def _instant(span: Span, stop: Point | None, target: Fraction | None) -> Fraction | None:
    """Return a rational instant in ``span`` up to ``stop``: from ``target`` on if possible, else late."""
    begin = span.begin.point
    if stop is not None and stop <= begin:
        inside = not isinstance(begin, Root) and not span.begin.after and stop == begin
        return begin if inside and isinstance(begin, Fraction) else None
    if target is not None and (stop is None or target < stop):
        return between(max(begin, target), stop)
    if stop is None:
        return between(begin, None)
    if not isinstance(stop, Root) and (span.end is None or Cut(stop, False) < span.end):
        return stop
    low, high = _rationals_between(begin, stop)
    return between(low + 3 * (high - low) / 4, stop)


def breaks(
    part: TimePart, window: tuple[Fraction, Fraction | None], never: TruthSet, failing: TruthSet
) -> Iterator[tuple[TimePart, DerivationMoment | Soon | Crossing | None]]:
    """Yield consecutive parts, each with a moment at which an until's left side fails before its right holds.

    None: the right side never holds. ``never``: when the right side is false; ``failing``: when the left is.
    """
    low, high = window
    stuck = ReasonKind.CHANGE_TOGETHER()

    def serve(cut: Cut) -> tuple[Cut | None, DerivationMoment | Soon | Crossing | None]:
        """Return the end of the part that begins at ``cut``, and its moment."""
        first = moved(cut, low)
        free = _span_at(never, first)
        if free is None:
            raise NoDerivationError(stuck)
        limit_of_free = None if free.end is None or high is None else free.end
        if free.end is None or (
            limit_of_free is not None and moved(cut, high or Fraction(0)) < limit_of_free
        ):
            return _before(free.end, high or Fraction(0), part.end, cut), None
        failing_span = _span_at(failing, first)
        if failing_span is not None:
            limits = [x for x in (failing_span.end, free.end) if x is not None]
            return _before(min(limits) if limits else None, low, part.end, cut), Later(low)
        target = None if part.stop is None else part.stop + low
        spans = (x for x in failing.spans() if first < x.begin and (free.end is None or x.begin < free.end))
        times = (_instant(x, _first_end(x, free), target) for x in spans)
        instants = [x for x in times if x is not None and failing.at(x) and never.at(x)]
        if instants:
            after = Cut(max(instants) - low, True)
            return (part.end if part.end is not None and part.end <= after else after), Fixed(max(instants))
        together = _together(part, free, failing, low)
        if together is None:
            raise NoDerivationError(stuck)
        return part.end, together

    return _in_turn(part, serve, stuck)


def _together(part: TimePart, free: Span, failing: TruthSet, low: Fraction) -> Soon | Crossing | None:
    """Return when the left side of an until fails as soon as its right side holds, for all of a part."""
    for span in failing.spans():
        change = span.begin.point
        if free.end is None or change != free.end.point or not free.end.after:
            continue
        limit = None if span.end is None else span.end.point
        if isinstance(change, Root):
            return _crossing(part, change, low, limit) if limit is None or change < limit else None
        if part.stop is not None and part.stop + low <= change:
            return Soon(change, between(change, limit))
    return None


def _first_end(one: Span, other: Span) -> Point | None:
    """Return the earlier end of two intervals; None if both are unbounded."""
    return min((x.end.point for x in (one, other) if x.end is not None), default=None)


def _rationals_between(low: Point, high: Point) -> tuple[Fraction, Fraction]:
    """Return two different rationals between ``low`` and ``high``, the smaller first."""
    width = Fraction(1, 8)
    while True:
        near, far = bounds(low, width)[1], bounds(high, width)[0]
        if near < far:
            return near, far
        width /= 8
        if width < Fraction(1, 2**400):
            raise NoDerivationError(ReasonKind.TOO_NEAR())


def between(low: Point, high: Point | None) -> Fraction:
    """Return the simplest rational strictly between two instants."""
    if high is None:
        return Fraction(int(bounds(low, Fraction(1))[1]) + 1)
    return _simplest(*_rationals_between(low, high))


def _simplest(low: Fraction, high: Fraction) -> Fraction:
    """Return the rational with the smallest denominator strictly between two that are not negative."""
    whole = low.numerator // low.denominator
    if whole + 1 < high:
        return Fraction(whole + 1)
    if low == whole:
        # between whole and high <= whole + 1: whole + 1/n
        return whole + Fraction(1, int(1 / (high - whole)) + 1)
    return whole + 1 / _simplest(1 / (high - whole), 1 / (low - whole))


def cuts_between(
    is_seen: Callable[[TimePart, Signs], bool], part: TimePart, deeper: int = DEEPEST
) -> list[Fraction]:
    """Return instants between which each sign is recognised."""
    signs = Signs()
    if is_seen(part, signs):
        return []
    if not deeper:
        raise NoDerivationError(ReasonKind.IRRATIONAL_SIGN())
    inside = splits(signs.tested, part)
    if inside:
        cut = inside[len(inside) // 2]
    elif part.stop is None:
        cut = part.start + 2 ** (DEEPEST - deeper)
    else:
        third = (part.stop - part.start) / 3
        cut = between(part.start + third, part.stop - third)
    if not part.has_inside(cut):
        raise NoDerivationError(ReasonKind.SIGN_UNSEEN())
    before, after = part.cut([cut])
    return [*cuts_between(is_seen, before, deeper - 1), cut, *cuts_between(is_seen, after, deeper - 1)]
