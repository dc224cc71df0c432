"""Truth sets: sets of instants in [0, ∞) with finitely many switches, and STL operators on them.

A *cut* lies just before or just after a point. A set is the ascending list of the cuts at which its
truth changes, being false before the first. So [p, q) is the cuts before p and before q, and the
single instant p is the cuts before and after p: open and closed ends need no further cases.
"""

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple, TypeAlias

from roadproof.semantics.exact.algebraic import Point, decimal, moved


class Cut(NamedTuple):
    """A position just before ``point`` (``after`` False) or just after it."""

    point: Point
    after: bool


class Span(NamedTuple):
    """The interval between two cuts; ``end`` None is for ever."""

    begin: Cut
    end: Cut | None


_Shift: TypeAlias = Callable[[Fraction, Fraction | None, Iterable[Span]], list[Span]]
START = Cut(Fraction(0), False)


@dataclass(frozen=True)
class TruthSet:
    """Ascending, distinct cuts, none before ``START``; equal sets have equal cuts."""

    cuts: tuple[Cut, ...]

    def at(self, time: Point) -> bool:
        """Return whether the set contains the instant ``time`` >= 0."""
        return bisect_right(self.cuts, Cut(time, False)) % 2 == 1

    def spans(self) -> tuple[Span, ...]:
        """Return the maximal intervals, ascending."""
        ends: list[Cut | None] = [*self.cuts[1::2]]
        if len(self.cuts) % 2 == 1:
            ends.append(None)
        return tuple(Span(*pair) for pair in zip(self.cuts[::2], ends, strict=True))

    def __str__(self) -> str:
        """The maximal intervals in seconds, as decimals with bounds: ``[0, 1.5) ∪ {2}``."""
        return " ∪ ".join(show_span(span) for span in self.spans()) or "∅"


NEVER = TruthSet(())
ALWAYS = TruthSet((START,))


def show_span(span: Span) -> str:
    """Return one interval of a truth set as text, in seconds."""
    begin, end = span
    if end is None:
        return f"{'(' if begin.after else '['}{decimal(begin.point)}, ∞)"
    if begin.point == end.point:
        return f"{{{decimal(begin.point)}}}"
    left, right = "(" if begin.after else "[", "]" if end.after else ")"
    return f"{left}{decimal(begin.point)}, {decimal(end.point)}{right}"


def from_values(values: Iterable[tuple[Cut, bool]]) -> TruthSet:
    """Return the set from ascending cuts, the first ``START``, each with the truth from it on."""
    cuts: list[Cut] = []
    current = False
    for cut, value in values:
        if value != current:
            cuts.append(cut)
            current = value
    return TruthSet(tuple(cuts))


def from_switches(switches: Iterable[tuple[Point, bool, bool]]) -> TruthSet:
    """Return the set from ascending (point, truth at it, truth after it); the first point is 0."""
    return from_values(
        (cut, value)
        for point, at, after in switches
        for cut, value in ((Cut(point, False), at), (Cut(point, True), after))
    )


def interval(low: Point, high: Point | None, closed: str = "[]") -> TruthSet:
    """Return an interval of times >= 0; ``closed``: ``[]``, ``[)``, ``(]`` or ``()``; high None: for ever."""
    begin = Cut(low, closed[0] == "(")
    return _overlapped([Span(begin, None if high is None else Cut(high, closed[1] == "]"))], 1)


def complement(truth: TruthSet) -> TruthSet:
    """Return the complement (not)."""
    if truth.cuts[:1] == (START,):
        return TruthSet(truth.cuts[1:])
    return TruthSet((START, *truth.cuts))


def intersection(sets: Iterable[TruthSet]) -> TruthSet:
    """Return the intersection (and); of no sets it is always."""
    operands = tuple(sets)
    return _overlapped(_spans(operands), len(operands)) if operands else ALWAYS


def union(sets: Iterable[TruthSet]) -> TruthSet:
    """Return the union (or); of no sets it is never."""
    return _overlapped(_spans(tuple(sets)), 1)


def eventually(low: Fraction, high: Fraction | None, body: TruthSet) -> TruthSet:
    """Return F_[low, high]: some t in [low, high] has body at T+t; high None is unbounded.

    An interval ⟨l, r⟩ of the body makes it true on ⟨l - high, r - low⟩, with open or closed ends kept.
    """
    return _overlapped(_shifted_back(low, high, body.spans()), 1)


def always(low: Fraction, high: Fraction | None, body: TruthSet) -> TruthSet:
    """Return G_[low, high]: every t in [low, high] has body at T+t."""
    return complement(eventually(low, high, complement(body)))


def until(left: TruthSet, low: Fraction, high: Fraction | None, right: TruthSet) -> TruthSet:
    """Return U_[low, high] of semantics §1: right at T+t for some t in [low, high], left on T + [low, t)."""
    return _while_left(left, low, high, right, _shifted_back)


def since(left: TruthSet, low: Fraction, high: Fraction | None, right: TruthSet) -> TruthSet:
    """Return S_[low, high], the mirror image of ``until``: nothing is before time 0."""
    return _while_left(left, low, high, right, _shifted_ahead)


def _while_left(
    left: TruthSet, low: Fraction, high: Fraction | None, right: TruthSet, shifted: _Shift
) -> TruthSet:
    """Return the until (or since) whose windows look to where ``shifted`` moves spans from.

    At T it is the one that starts with 0, seen from T + low (T - low). That one holds where right does, and,
    on each maximal interval ⟨p, q⟩ of left, where right is true within high - low at a point of [p, q]: that
    may be the far end itself, even if left fails there.
    """
    length = None if high is None else high - low
    reached = list(right.spans())
    for span in left.spans():
        begin, end = span
        reach = Span(Cut(begin.point, False), None if end is None else Cut(end.point, True))
        targets = [met for other in right.spans() if (met := _meet(other, reach)) is not None]
        for reaching in shifted(Fraction(0), length, targets):
            met = _meet(reaching, span)
            if met is not None:
                reached.append(met)
    return _overlapped(shifted(low, low, _overlapped(reached, 1).spans()), 1)


def _shifted_ahead(low: Fraction, high: Fraction | None, spans: Iterable[Span]) -> list[Span]:
    """Return each span moved to the times from which it lies back by ``low`` to ``high``."""
    return [
        Span(_moved(begin, low), None if end is None or high is None else _moved(end, high))
        for begin, end in spans
    ]


def _shifted_back(low: Fraction, high: Fraction | None, spans: Iterable[Span]) -> list[Span]:
    """Return each span moved to the times from which it is reached within [low, high], cut off at 0."""
    shifted: list[Span] = []
    for begin, end in spans:
        first = START if high is None else max(START, _moved(begin, -high))
        last = None if end is None else _moved(end, -low)
        if last is None or first < last:
            shifted.append(Span(first, last))
    return shifted


def _moved(cut: Cut, by: Fraction) -> Cut:
    return Cut(moved(cut.point, by), cut.after)


def _meet(left: Span, right: Span) -> Span | None:
    begin = max(left.begin, right.begin)
    ends = [end for end in (left.end, right.end) if end is not None]
    end = min(ends) if ends else None
    return None if end is not None and end <= begin else Span(begin, end)


def _spans(sets: Iterable[TruthSet]) -> Iterator[Span]:
    for truth in sets:
        yield from truth.spans()


def _overlapped(spans: Iterable[Span], times: int) -> TruthSet:
    """Return the times at which at least ``times`` of the spans overlap."""
    steps: list[tuple[Cut, int]] = []
    for begin, end in spans:
        steps.append((begin, 1))
        if end is not None:
            steps.append((end, -1))
    steps.sort(key=lambda step: step[0])
    cuts: list[Cut] = []
    depth, inside = 0, False
    for i, (cut, change) in enumerate(steps):
        depth += change
        complete = i + 1 == len(steps) or steps[i + 1][0] != cut
        if complete and (depth >= times) != inside:
            inside = not inside
            cuts.append(cut)
    return TruthSet(tuple(cuts))
