"""Parts of time that follow each other, each with the rational instant, or the case, that serves it."""

from collections.abc import Callable, Collection, Iterator, Sequence
from fractions import Fraction
from typing import TypeVar

from roadproof.errors import RoadproofError
from roadproof.extensions.kernel.derivation import Crossing, Fixed, Later, Moment, Soon, Step, split
from roadproof.extensions.kernel.derivations.signs import Part, Signs, rational_of, splits
from roadproof.reasons import Reason, Why
from roadproof.semantics.exact.algebraic import Point, Root, bounds
from roadproof.semantics.exact.polynomial import sign_at
from roadproof.semantics.exact.truth import START, Cut, Span, TruthSet

Served = TypeVar("Served")
MOST_PARTS = 300
DEEPEST = 16  # how often a part is halved until a sign is seen
"""Parts that follow each other towards an irrational instant never reach it."""


class NoDerivationError(RoadproofError):
    """None was found, for this reason; there may be one."""

    def __init__(self, reason: Reason) -> None:
        super().__init__(reason)
        self.reason = reason


def contains(truth: TruthSet, part: Part) -> bool:
    span = _span_at(truth, part.begin)
    return span is not None and _ends_by(part.end, span.end)


def _span_at(truth: TruthSet, cut: Cut) -> Span | None:
    """The interval that what comes right after ``cut`` lies in."""
    return next((x for x in truth.spans() if x.begin <= cut and (x.end is None or cut < x.end)), None)


def _ends_by(end: Cut | None, limit: Cut | None) -> bool:
    return limit is None or (end is not None and end <= limit)


def put_together(found: Sequence[tuple[Part, Step]]) -> Step:
    """Steps for parts that follow each other as one."""
    step = found[-1][1]
    for part, before in reversed(found[:-1]):
        if part.end is None:
            raise ValueError("a part without end is the last")
        step = split(Fraction(part.stop or 0), part.end.after, before, step)
    return step


def covered(part: Part, sets: Sequence[TruthSet]) -> Iterator[tuple[Part, int | Root]]:
    """Parts of ``part`` that follow each other, each within one of the sets.

    A root in place of a set: at it one set ends and another begins.
    """
    cut = part.begin
    for _ in range(MOST_PARTS):
        reaching = [(span, k) for k, x in enumerate(sets) if (span := _span_at(x, cut)) is not None]
        if not reaching:
            raise NoDerivationError(Why.IRRATIONAL_CHANGE())
        whole = next(((span, k) for span, k in reaching if _ends_by(part.end, span.end)), None)
        if whole is not None:
            yield Part(cut, part.end), whole[1]
            return
        span, place = max(reaching, key=lambda x: x[0].end or cut)
        if span.end is None:
            raise ValueError("an interval for ever covers what is left")
        end = span.end
        if isinstance(end.point, Root):
            others = [y for x in sets for y in x.spans() if y.begin <= end and (y.end is None or end < y.end)]
            first = min((y.begin for y in others), default=None)
            if first is None:
                raise NoDerivationError(Why.IRRATIONAL_CHANGE())
            if first.point == end.point:
                change = end.point
                following = max((y for x in sets for y in x.spans() if y.begin == first), key=_by_end)
                before, after = _around(change, cut, following.end, part.end)
                if cut < before:
                    yield Part(cut, before), place
                yield Part(before, after), change
                if after == part.end:
                    return
                cut = after
                continue
            end = Cut(between(max(first, cut).point, end.point), False)
        yield Part(cut, end), place
        cut = end
    raise NoDerivationError(Why.IRRATIONAL_LIMIT())


def _by_end(span: Span) -> tuple[bool, Cut]:
    return (True, START) if span.end is None else (False, span.end)


def _around(change: Root, begin: Cut, limit: Cut | None, end: Cut | None) -> tuple[Cut, Cut]:
    """Rational cuts around ``change``, near it, not before ``begin``, not after ``limit`` and ``end``."""
    low, high = bounds(change, Fraction(1, 64))
    while (limit is not None and not Cut(high, False) <= limit) or not begin <= Cut(low, False):
        low, high = bounds(change, (high - low) / 8)
        if high - low < Fraction(1, 2**400):
            raise NoDerivationError(Why.CHANGE_TWICE())
    after = Cut(high, False)
    return Cut(low, False), after if end is None or after <= end else end


def widened(part: Part, window: tuple[Fraction, Fraction | None]) -> Part:
    low, high = window
    end = None if part.end is None or high is None else moved(part.end, high)
    return Part(moved(part.begin, low), end)


def image(part: Part, moment: Moment) -> Part:
    if isinstance(moment, Fixed):
        return Part(Cut(moment.time, False), Cut(moment.time, True))
    return Part(moved(part.begin, moment.time), None if part.end is None else moved(part.end, moment.time))


def run(part: Part, moment: Moment, low: Fraction, out: bool) -> Part:
    """From the begin of windows to the moment, without it where ``out``."""
    begin = moved(part.begin, low)
    if isinstance(moment, Fixed):
        return Part(begin, Cut(moment.time, not out))
    if part.end is None:
        return Part(begin, None)
    end = moved(part.end, moment.time)
    return Part(begin, Cut(end.point, end.after and not out))


def at_once(part: Part, moment: Moment, low: Fraction) -> bool:
    return moment.time <= (low if isinstance(moment, Later) else part.start + low)


def moved(cut: Cut, by: Fraction) -> Cut:
    """A cut so many seconds later."""
    if isinstance(cut.point, Root):
        raise NoDerivationError(Why.IRRATIONAL())
    return Cut(cut.point + by, cut.after)


def _in_turn(
    part: Part, serve: Callable[[Cut], tuple[Cut | None, Served]], stuck: Reason
) -> Iterator[tuple[Part, Served]]:
    """Parts in turn. ``serve``: what serves after a cut, and how far; ``stuck``: why it may not."""
    cut = part.begin
    for _ in range(MOST_PARTS):
        end, found = serve(cut)
        yield Part(cut, end), found
        if end == part.end:
            return
        if end is None or end <= cut:
            raise NoDerivationError(stuck)
        cut = end
    raise NoDerivationError(Why.IRRATIONAL_LIMIT())


def moments(
    part: Part, window: tuple[Fraction, Fraction | None], right: TruthSet, left: TruthSet
) -> Iterator[tuple[Part, Moment | Crossing]]:
    """For parts that follow each other, when within its window ``right`` holds, and ``left`` until then."""
    low, high = window

    def serve(cut: Cut) -> tuple[Cut | None, Moment | Crossing]:
        here = _span_at(right, moved(cut, low))
        if here is None:
            return _later(part, cut, low, high, right, left)
        return _before(here.end, low, part.end, cut), Later(low)

    return _in_turn(part, serve, Why.NO_INSTANT())


def _before(limit: Cut | None, low: Fraction, wanted: Cut | None, cut: Cut) -> Cut | None:
    """How far instants go on whose windows begin before ``limit``: ``wanted``, or a rational before."""
    if limit is None:
        return wanted
    if not isinstance(limit.point, Root):
        last = moved(limit, -low)
        return last if wanted is None or last < wanted else wanted
    if wanted is not None and moved(wanted, low) < limit:
        return wanted
    return Cut(between(moved(cut, low).point, limit.point) - low, False)


def _later(
    part: Part, cut: Cut, low: Fraction, high: Fraction | None, right: TruthSet, left: TruthSet
) -> tuple[Cut | None, Moment | Crossing]:
    """A moment after ``cut`` and the begin of its window, and how far it serves."""
    start = Part(cut, None).start
    first = moved(cut, low)
    kept = _span_at(left, first)
    if kept is None:
        raise NoDerivationError(Why.NO_INSTANT())
    last = None if high is None else start + high
    for span in right.spans():
        if span.begin < first:
            continue
        ends: list[Point] = [] if last is None else [last]
        ends += [x.point for x in (span.end, kept.end) if x is not None]
        stop = min(ends) if ends else None
        if stop is not None and stop < span.begin.point:
            break
        if stop is None and part.end is None:
            return None, Later(between(span.begin.point, None) - start)
        wanted = None if part.stop is None else part.stop + low
        time = _instant(span, stop, wanted)
        if time is not None:
            end = Cut(time - low, True)
            return (part.end if part.end is not None and part.end <= end else end), Fixed(time)
        if stop == span.begin.point and not span.begin.after:
            crossing = _crossing(part, span.begin.point, low, last)
            if crossing is not None:
                return part.end, crossing
    raise NoDerivationError(Why.NO_INSTANT())


def _crossing(part: Part, change: Point, low: Fraction, limit: Point | None) -> Crossing | None:
    """An irrational instant after the begins of all windows of a part, and before ``limit``."""
    if not isinstance(change, Root) or part.stop is None or change <= part.stop + low:
        return None
    last = None if limit is None else Cut(limit, False)
    before, after = _around(change, Cut(part.stop + low, False), last, None)
    return Crossing(rational_of(before), rational_of(after), change.polynomial)


def narrowed(crossing: Crossing, times: Collection[Fraction]) -> Crossing:
    """The same instant, between two so near that none of ``times`` lies between them."""
    begin, end = crossing.begin, crossing.end
    first = sign_at(crossing.polynomial, begin)
    while any(begin < x < end for x in times):
        middle = (begin + end) / 2
        if sign_at(crossing.polynomial, middle) == first:
            begin = middle
        else:
            end = middle
    return Crossing(begin, end, crossing.polynomial)


def _instant(span: Span, stop: Point | None, wanted: Fraction | None) -> Fraction | None:
    """A rational instant in ``span`` up to ``stop``: not before ``wanted`` if possible, else a late one."""
    begin = span.begin.point
    if stop is not None and stop <= begin:
        inside = not isinstance(begin, Root) and not span.begin.after and stop == begin
        return begin if inside and isinstance(begin, Fraction) else None
    if wanted is not None and (stop is None or wanted < stop):
        return between(max(begin, wanted), stop)
    if stop is None:
        return between(begin, None)
    if not isinstance(stop, Root) and (span.end is None or Cut(stop, False) < span.end):
        return stop
    low, high = _apart(begin, stop)
    return between(low + 3 * (high - low) / 4, stop)


def breaks(
    part: Part, window: tuple[Fraction, Fraction | None], never: TruthSet, failing: TruthSet
) -> Iterator[tuple[Part, Moment | Soon | Crossing | None]]:
    """For parts that follow each other, when the left side of an until fails before its right side comes.

    None: the right side never comes. ``never`` is when the right side is false, ``failing`` the left.
    """
    low, high = window
    stuck = Why.CHANGE_TOGETHER()

    def serve(cut: Cut) -> tuple[Cut | None, Moment | Soon | Crossing | None]:
        first = moved(cut, low)
        free = _span_at(never, first)
        if free is None:
            raise NoDerivationError(stuck)
        over = None if free.end is None or high is None else free.end
        if free.end is None or (over is not None and moved(cut, high or Fraction(0)) < over):
            return _before(free.end, high or Fraction(0), part.end, cut), None
        broken = _span_at(failing, first)
        if broken is not None:
            limits = [x for x in (broken.end, free.end) if x is not None]
            return _before(min(limits) if limits else None, low, part.end, cut), Later(low)
        wanted = None if part.stop is None else part.stop + low
        spans = (x for x in failing.spans() if first < x.begin and (free.end is None or x.begin < free.end))
        times = (_instant(x, _first_end(x, free), wanted) for x in spans)
        found = [x for x in times if x is not None and failing.at(x) and never.at(x)]
        if found:
            after = Cut(max(found) - low, True)
            return (part.end if part.end is not None and part.end <= after else after), Fixed(max(found))
        together = _together(part, free, failing, low)
        if together is None:
            raise NoDerivationError(stuck)
        return part.end, together

    return _in_turn(part, serve, stuck)


def _together(part: Part, free: Span, failing: TruthSet, low: Fraction) -> Soon | Crossing | None:
    """Where the left side of an until fails as soon as its right side comes, for all of a part."""
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
    """When the first of two intervals ends, None where neither does."""
    return min((x.end.point for x in (one, other) if x.end is not None), default=None)


def _apart(low: Point, high: Point) -> tuple[Fraction, Fraction]:
    """Rationals not below ``low`` and not above ``high``, of which the first is less."""
    width = Fraction(1, 8)
    while True:
        near, far = bounds(low, width)[1], bounds(high, width)[0]
        if near < far:
            return near, far
        width /= 8
        if width < Fraction(1, 2**400):
            raise NoDerivationError(Why.TOO_NEAR())


def between(low: Point, high: Point | None) -> Fraction:
    """The simplest rational strictly between two instants."""
    if high is None:
        return Fraction(int(bounds(low, Fraction(1))[1]) + 1)
    return _simplest(*_apart(low, high))


def _simplest(low: Fraction, high: Fraction) -> Fraction:
    """The rational of the smallest denominator strictly between two that are not negative."""
    whole = low.numerator // low.denominator
    if whole + 1 < high:
        return Fraction(whole + 1)
    if low == whole:
        # between whole and high <= whole + 1: whole + 1/n
        return whole + Fraction(1, int(1 / (high - whole)) + 1)
    return whole + 1 / _simplest(1 / (high - whole), 1 / (low - whole))


def cuts_between(is_seen: Callable[[Part, Signs], bool], part: Part, deeper: int = DEEPEST) -> list[Fraction]:
    """Instants between which each sign is seen."""
    signs = Signs()
    if is_seen(part, signs):
        return []
    if not deeper:
        raise NoDerivationError(Why.IRRATIONAL_SIGN())
    inside = splits(signs.tested, part)
    if inside:
        cut = inside[len(inside) // 2]
    elif part.stop is None:
        cut = part.start + 2 ** (DEEPEST - deeper)
    else:
        third = (part.stop - part.start) / 3
        cut = between(part.start + third, part.stop - third)
    if not part.has_inside(cut):
        raise NoDerivationError(Why.SIGN_UNSEEN())
    before, after = part.cut([cut])
    return [*cuts_between(is_seen, before, deeper - 1), cut, *cuts_between(is_seen, after, deeper - 1)]
