"""A derivation that a formula is true of a drive, read off the sets of instants at which its parts are true.

The exact judge says when each part is true; here an instant is chosen for each `F`, a disjunct for each `or`,
and rational instants at which the choice changes. Where it has to change exactly at an irrational instant,
cases are made of the sign of a polynomial, which decides the comparisons that change; where that is not
enough there is no derivation. Nothing rests on this: Coq checks what comes out.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias, assert_never

from roadproof.deriving.signs import Part, Poly, Shapes, Signs, compares, occupies, opposite, said_of, splits
from roadproof.errors import RoadproofError
from roadproof.judge.algebraic import Point, Root, bounds
from roadproof.judge.exact import judge, seconds
from roadproof.judge.truth import (
    ALWAYS,
    NEVER,
    START,
    Cut,
    Span,
    TruthSet,
    always,
    complement,
    eventually,
    intersection,
    union,
    until,
)
from roadproof.kernel.derivation import Fixed, Later, Moment, Step, case, element, sign, split, timed
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import terms_of, vehicles_of, with_values, without_names
from roadproof.spec.bind import occupies as occupies_formula
from roadproof.world.drive import Drive
from roadproof.world.road import Road

MOST_STEPS = 5_000
DEEPEST = 16  # how often a part is halved until a sign is seen
NOW = Part(Cut(Fraction(0), False), Cut(Fraction(0), True))
# What a bound variable speaks of: the number of a lanelet, which stands for its lane, too.
Scope: TypeAlias = Mapping[str, int]


class NoDerivationError(RoadproofError):
    """None was found, for this reason; there may be one."""


def derive(
    formula: Formula, drive: Drive, road: Road, lanes: Mapping[str, str], values: Mapping[str, Fraction]
) -> Step:
    """Why ``formula`` is true of a drive at time 0.

    Raises ``NoDerivationError``; also where the formula is false.
    """
    known = with_values(without_names(formula), values)
    finding = _Finding(drive, road, lanes, Shapes(drive, values))
    return finding.why(known, {}, True, NOW)


@dataclass
class _Finding:
    drive: Drive
    road: Road
    lanes: Mapping[str, str]
    shapes: Shapes
    truths: dict[tuple[Formula, tuple[tuple[str, int], ...]], TruthSet] = field(default_factory=dict)
    steps: int = 0

    # --- when something is true ---------------------------------------------------------------------

    def when(self, formula: Formula, scope: Scope, positive: bool = True) -> TruthSet:
        key = formula, tuple(sorted(scope.items()))
        if key not in self.truths:
            self.truths[key] = self._when(formula, scope)
        return self.truths[key] if positive else complement(self.truths[key])

    def _when(self, formula: Formula, scope: Scope) -> TruthSet:
        match formula:
            case f.Truth(value):
                return ALWAYS if value else NEVER
            case f.Compare():
                return judge(formula, self.drive).truth(formula)
            case f.Occupies(vehicle, name):
                inside = occupies_formula(vehicle, self.road.lanelets[self.number(name, scope)])
                return judge(inside, self.drive).truth(inside)
            case f.Some(variable, domain, body):
                return union(
                    [self.when(body, {**scope, variable: e}) for e in self.members(domain, scope)] or [NEVER]
                )
            case f.Every(variable, domain, body):
                return intersection(
                    [self.when(body, {**scope, variable: e}) for e in self.members(domain, scope)]
                )
            case f.Not(body):
                return complement(self.when(body, scope))
            case f.And(parts):
                return intersection([self.when(x, scope) for x in parts])
            case f.Or(parts):
                return union([self.when(x, scope) for x in parts] or [NEVER])
            case f.Eventually(interval, body):
                return eventually(*seconds(interval), self.when(body, scope))
            case f.Always(interval, body):
                return always(*seconds(interval), self.when(body, scope))
            case f.Until(left, interval, right):
                return until(self.when(left, scope), *seconds(interval), self.when(right, scope))
            case f.Named(_, _, body):
                return self.when(body, scope)
            case _:
                assert_never(formula)

    def number(self, name: str, scope: Scope) -> int:
        """Which lanelet a name stands for; a lane by its first one."""
        if name in scope:
            return scope[name]
        lane = self.lanes.get(name, name)
        for number, lanelet in enumerate(self.road.lanelets):
            if lanelet.lane == lane:
                return number
        raise NoDerivationError(f"the road has no lane for {name}")

    def members(self, domain: f.Domain, scope: Scope) -> list[int]:
        lanelets = list(enumerate(self.road.lanelets))
        if domain.kind == "lanes":
            return [k for k, _ in lanelets]
        if domain.kind == "zone":
            return [k for k, x in lanelets if x.zone == domain.of]
        lane = self.road.lanelets[self.number(domain.of, scope)].lane
        if domain.kind == "lanelets":
            return [k for k, x in lanelets if x.lane == lane]
        return [k for k, x in lanelets if x.lane in self.road.beside(lane)]

    # --- why it is ----------------------------------------------------------------------------------

    def why(self, formula: Formula, scope: Scope, positive: bool, part: Part) -> Step:
        """Why ``formula`` is true (or false) at every instant of ``part``."""
        self.steps += 1
        if self.steps > MOST_STEPS:
            raise NoDerivationError(f"it would have more than {MOST_STEPS} steps")
        if not _contains(self.when(formula, scope, positive), part):
            raise NoDerivationError("the formula is not what it should be at some instant")
        match formula:
            case f.Truth():
                return Step("Plain")
            case f.Compare() | f.Occupies():
                return self._sign(formula, scope, positive, part)
            case f.Not(body):
                return Step("Turn", (), (self.why(body, scope, not positive, part),))
            case f.And(parts):
                return self._joined(parts, scope, positive, part, f.And, both=positive)
            case f.Or(parts):
                return self._joined(parts, scope, positive, part, f.Or, both=not positive)
            case f.Some(variable, domain, body):
                return self._quantified(variable, domain, body, scope, positive, part, one=positive)
            case f.Every(variable, domain, body):
                return self._quantified(variable, domain, body, scope, positive, part, one=not positive)
            case f.Eventually(interval, body):
                return self._timed(body, scope, positive, part, seconds(interval), once=positive)
            case f.Always(interval, body):
                return self._timed(body, scope, positive, part, seconds(interval), once=not positive)
            case f.Until(left, interval, right) if positive:
                return self._until(left, right, scope, part, seconds(interval))
            case f.Until(left, interval, right):
                return self._not_until(left, right, scope, part, seconds(interval))
            case f.Named(_, _, body):
                return self.why(body, scope, positive, part)
            case _:
                assert_never(formula)

    def _sign(self, formula: f.Compare | f.Occupies, scope: Scope, positive: bool, part: Part) -> Step:
        if isinstance(formula, f.Occupies):
            vehicles = {formula.vehicle}
            lanelet = self.road.lanelets[self.number(formula.lanelet, scope)]

            def is_seen(part: Part, signs: Signs) -> bool:
                return occupies(self.shapes, formula.vehicle, lanelet, positive, part, signs)
        else:
            leaves = (leaf for side in terms_of(formula) for leaf in t.leaves(side))
            vehicles = {x.vehicle for x in leaves if isinstance(x, t.Signal)}
            op = formula.op if positive else opposite(formula.op)

            def is_seen(part: Part, signs: Signs) -> bool:
                return compares(self.shapes, formula.left, op, formula.right, part, signs)

        knots = sorted({x for name in vehicles for x in self.shapes.knots(name) if part.has_inside(x)})
        cuts: list[Fraction] = []
        for place, piece in enumerate(part.cut(knots)):
            cuts += knots[place - 1 : place] if place else []
            cuts += _cuts(is_seen, piece, DEEPEST)
        return sign(tuple(cuts))

    def _joined(
        self,
        parts: Sequence[Formula],
        scope: Scope,
        positive: bool,
        part: Part,
        kind: type[f.And | f.Or],
        both: bool,
    ) -> Step:
        """``p and q and r`` is ``p and (q and r)`` for Coq."""
        if not parts:
            return Step("Plain")
        if len(parts) == 1:
            return self.why(parts[0], scope, positive, part)
        sides = parts[0], parts[1] if len(parts) == 2 else kind(tuple(parts[1:]))
        if both:
            return Step("Both", (), tuple(self.why(x, scope, positive, part) for x in sides))
        found: list[tuple[Part, Step]] = []
        for piece, place in _covered(part, [self.when(x, scope, positive) for x in sides]):
            if isinstance(place, Root):
                found.append((piece, self._case(kind(tuple(parts)), scope, positive, piece, place)))
                continue
            step = self.why(sides[place], scope, positive, piece)
            found.append((piece, Step("One", (str(place == 1).lower(),), (step,))))
        return _put_together(found)

    def _quantified(
        self,
        variable: str,
        domain: f.Domain,
        body: Formula,
        scope: Scope,
        positive: bool,
        part: Part,
        one: bool,
    ) -> Step:
        members = self.members(domain, scope)
        scopes = [{**scope, variable: e} for e in members]
        if not one:
            return Step("Each", (), tuple(self.why(body, x, positive, part) for x in scopes), many=True)
        found: list[tuple[Part, Step]] = []
        for piece, place in _covered(part, [self.when(body, x, positive) for x in scopes]):
            if isinstance(place, Root):
                whole = (f.Some if positive else f.Every)(variable, domain, body)
                found.append((piece, self._case(whole, scope, positive, piece, place)))
                continue
            found.append((piece, element(members[place], self.why(body, scopes[place], positive, piece))))
        return _put_together(found)

    def _case(self, formula: Formula, scope: Scope, positive: bool, part: Part, change: Root) -> Step:
        """Where a polynomial that has this root is above 0, and where it is not."""
        polynomial = tuple(Fraction(x) for x in change.polynomial)
        above, not_above = (self._assuming(formula, part, polynomial, x) for x in (True, False))
        if formula in (above, not_above):
            raise NoDerivationError("what holds changes exactly at an irrational instant")
        return case(
            polynomial,
            self.why(above, scope, positive, part),
            self.why(not_above, scope, positive, part),
        )

    def _assuming(self, formula: Formula, part: Part, polynomial: Poly, above: bool) -> Formula:
        """``formula`` with what the sign of a polynomial says of its comparisons at the same instant."""
        match formula:
            case f.Compare():
                vehicles = vehicles_of(formula)
                if any(part.has_inside(x) for name in vehicles for x in self.shapes.knots(name)):
                    return formula
                said = said_of(self.shapes, formula, part, polynomial, above)
                return formula if said is None else f.Truth(said)
            case f.Not() | f.And() | f.Or() | f.Some() | f.Every():
                inside = (self._assuming(x, part, polynomial, above) for x in f.children(formula))
                return f.with_children(formula, tuple(inside))
            case _:
                return formula

    def _timed(
        self,
        body: Formula,
        scope: Scope,
        positive: bool,
        part: Part,
        window: tuple[Fraction, Fraction | None],
        once: bool,
    ) -> Step:
        if not once:
            return Step("Whole", (), (self.why(body, scope, positive, _widened(part, window)),))
        found: list[tuple[Part, Step]] = []
        when = self.when(body, scope, positive)
        for piece, moment in _moments(part, window, when, ALWAYS):
            step = self.why(body, scope, positive, _image(piece, moment))
            found.append((piece, timed("Moment", moment, step)))
        return _put_together(found)

    def _until(
        self,
        left: Formula,
        right: Formula,
        scope: Scope,
        part: Part,
        window: tuple[Fraction, Fraction | None],
    ) -> Step:
        found: list[tuple[Part, Step]] = []
        for piece, moment in _moments(part, window, self.when(right, scope), self.when(left, scope)):
            before = Step("Plain")
            if not _at_once(piece, moment, window[0]):
                before = self.why(left, scope, True, _run(piece, moment, window[0], out=True))
            after = self.why(right, scope, True, _image(piece, moment))
            found.append((piece, timed("Reach", moment, before, after)))
        return _put_together(found)

    def _not_until(
        self,
        left: Formula,
        right: Formula,
        scope: Scope,
        part: Part,
        window: tuple[Fraction, Fraction | None],
    ) -> Step:
        never, failing = self.when(right, scope, False), self.when(left, scope, False)
        found: list[tuple[Part, Step]] = []
        for piece, moment in _breaks(part, window, never, failing):
            if moment is None:
                step = Step("Whole", (), (self.why(right, scope, False, _widened(piece, window)),))
            else:
                step = timed(
                    "Break",
                    moment,
                    self.why(left, scope, False, _image(piece, moment)),
                    self.why(right, scope, False, _run(piece, moment, window[0], out=False)),
                )
            found.append((piece, step))
        return _put_together(found)


# --- parts of time ---------------------------------------------------------------------------------


def _contains(truth: TruthSet, part: Part) -> bool:
    span = _span_at(truth, part.begin)
    return span is not None and _ends_by(part.end, span.end)


def _span_at(truth: TruthSet, cut: Cut) -> Span | None:
    """The interval that what comes right after ``cut`` lies in."""
    return next((x for x in truth.spans() if x.begin <= cut and (x.end is None or cut < x.end)), None)


def _ends_by(end: Cut | None, limit: Cut | None) -> bool:
    return limit is None or (end is not None and end <= limit)


def _put_together(found: Sequence[tuple[Part, Step]]) -> Step:
    """Steps for parts that follow each other as one."""
    step = found[-1][1]
    for part, before in reversed(found[:-1]):
        if part.end is None:
            raise ValueError("a part without end is the last")
        step = split(Fraction(part.stop or 0), part.end.after, before, step)
    return step


def _covered(part: Part, sets: Sequence[TruthSet]) -> Iterator[tuple[Part, int | Root]]:
    """Parts of ``part`` that follow each other, each within one of the sets.

    A root in place of a set: at it one set ends and another begins.
    """
    cut = part.begin
    while True:
        reaching = [(span, k) for k, x in enumerate(sets) if (span := _span_at(x, cut)) is not None]
        if not reaching:
            raise NoDerivationError("what holds changes exactly at an irrational instant")
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
                raise NoDerivationError("what holds changes exactly at an irrational instant")
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
            end = Cut(_between(max(first, cut).point, end.point), False)
        yield Part(cut, end), place
        cut = end


def _by_end(span: Span) -> tuple[bool, Cut]:
    return (True, START) if span.end is None else (False, span.end)


def _around(change: Root, begin: Cut, limit: Cut | None, end: Cut | None) -> tuple[Cut, Cut]:
    """Rational cuts around ``change``, near it, not before ``begin``, not after ``limit`` and ``end``."""
    low, high = bounds(change, Fraction(1, 64))
    while (limit is not None and not Cut(high, False) <= limit) or not begin <= Cut(low, False):
        low, high = bounds(change, (high - low) / 8)
        if high - low < Fraction(1, 2**400):
            raise NoDerivationError("what holds changes twice at nearly one instant")
    after = Cut(high, False)
    return Cut(low, False), after if end is None or after <= end else end


def _widened(part: Part, window: tuple[Fraction, Fraction | None]) -> Part:
    low, high = window
    end = None if part.end is None or high is None else _moved(part.end, high)
    return Part(_moved(part.begin, low), end)


def _image(part: Part, moment: Moment) -> Part:
    if isinstance(moment, Fixed):
        return Part(Cut(moment.time, False), Cut(moment.time, True))
    return Part(_moved(part.begin, moment.time), None if part.end is None else _moved(part.end, moment.time))


def _run(part: Part, moment: Moment, low: Fraction, out: bool) -> Part:
    """From the begin of windows to the moment, without it where ``out``."""
    begin = _moved(part.begin, low)
    if isinstance(moment, Fixed):
        return Part(begin, Cut(moment.time, not out))
    if part.end is None:
        return Part(begin, None)
    end = _moved(part.end, moment.time)
    return Part(begin, Cut(end.point, end.after and not out))


def _at_once(part: Part, moment: Moment, low: Fraction) -> bool:
    return moment.time <= (low if isinstance(moment, Later) else part.start + low)


def _moved(cut: Cut, by: Fraction) -> Cut:
    if isinstance(cut.point, Root):
        raise NoDerivationError("an instant is irrational")
    return Cut(cut.point + by, cut.after)


def _moments(
    part: Part, window: tuple[Fraction, Fraction | None], right: TruthSet, left: TruthSet
) -> Iterator[tuple[Part, Moment]]:
    """For parts that follow each other, when within its window ``right`` holds, and ``left`` until then."""
    low, high = window
    cut = part.begin
    while True:
        first = _moved(cut, low)
        here = _span_at(right, first)
        if here is not None:
            end = _before(here.end, low, part.end, cut)
            yield Part(cut, end), Later(low)
        else:
            end, moment = _later(part, cut, low, high, right, left)
            yield Part(cut, end), moment
        if end == part.end:
            return
        if end is None or end <= cut:
            raise NoDerivationError("no rational instant was found at which it comes")
        cut = end


def _before(limit: Cut | None, low: Fraction, wanted: Cut | None, cut: Cut) -> Cut | None:
    """How far instants go on whose windows begin before ``limit``: ``wanted``, or a rational before."""
    if limit is None:
        return wanted
    if not isinstance(limit.point, Root):
        last = _moved(limit, -low)
        return last if wanted is None or last < wanted else wanted
    if wanted is not None and _moved(wanted, low) < limit:
        return wanted
    return Cut(_between(_moved(cut, low).point, limit.point) - low, False)


def _later(
    part: Part, cut: Cut, low: Fraction, high: Fraction | None, right: TruthSet, left: TruthSet
) -> tuple[Cut | None, Moment]:
    """A moment after ``cut`` and the begin of its window, and how far it serves."""
    start = Part(cut, None).start
    first = _moved(cut, low)
    kept = _span_at(left, first)
    if kept is None:
        raise NoDerivationError("no rational instant was found at which it comes")
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
            return None, Later(_between(span.begin.point, None) - start)
        wanted = None if part.stop is None else part.stop + low
        time = _instant(span, stop, wanted)
        if time is not None:
            end = Cut(time - low, True)
            return (part.end if part.end is not None and part.end <= end else end), Fixed(time)
    raise NoDerivationError("no rational instant was found at which it comes")


def _instant(span: Span, stop: Point | None, wanted: Fraction | None) -> Fraction | None:
    """A rational instant in ``span`` up to ``stop``: not before ``wanted`` if possible, else a late one."""
    begin = span.begin.point
    if stop is not None and stop <= begin:
        inside = not isinstance(begin, Root) and not span.begin.after and stop == begin
        return begin if inside and isinstance(begin, Fraction) else None
    if wanted is not None and (stop is None or wanted < stop):
        return _between(max(begin, wanted), stop)
    if stop is None:
        return _between(begin, None)
    if not isinstance(stop, Root) and (span.end is None or Cut(stop, False) < span.end):
        return stop
    low, high = _apart(begin, stop)
    return _between(low + 3 * (high - low) / 4, stop)


def _breaks(
    part: Part, window: tuple[Fraction, Fraction | None], never: TruthSet, failing: TruthSet
) -> Iterator[tuple[Part, Moment | None]]:
    """For parts that follow each other, when the left side of an until fails before its right side comes.

    None: the right side never comes. ``never`` is when the right side is false, ``failing`` the left.
    """
    low, high = window
    cut = part.begin
    while True:
        first = _moved(cut, low)
        free = _span_at(never, first)
        if free is None:
            raise NoDerivationError("both sides of an until change exactly at an irrational instant")
        end: Cut | None
        moment: Moment | None
        over = None if free.end is None or high is None else free.end
        broken = _span_at(failing, first)
        if free.end is None or (over is not None and _moved(cut, high or Fraction(0)) < over):
            end, moment = _before(free.end, high or Fraction(0), part.end, cut), None
        elif broken is not None:
            limits = [x for x in (broken.end, free.end) if x is not None]
            end, moment = _before(min(limits) if limits else None, low, part.end, cut), Later(low)
        else:
            wanted = None if part.stop is None else part.stop + low
            spans = [
                x for x in failing.spans() if first < x.begin and (free.end is None or x.begin < free.end)
            ]
            times = (_instant(x, None if free.end is None else free.end.point, wanted) for x in spans)
            found = [x for x in times if x is not None and failing.at(x) and never.at(x)]
            if not found:
                raise NoDerivationError("both sides of an until change exactly at an irrational instant")
            time = max(found)
            after = Cut(time - low, True)
            end, moment = (part.end if part.end is not None and part.end <= after else after), Fixed(time)
        yield Part(cut, end), moment
        if end == part.end:
            return
        if end is None or end <= cut:
            raise NoDerivationError("both sides of an until change exactly at an irrational instant")
        cut = end


def _cuts(is_seen: Callable[[Part, Signs], bool], part: Part, deeper: int) -> list[Fraction]:
    """Instants between which each sign is seen."""
    signs = Signs()
    if is_seen(part, signs):
        return []
    if not deeper:
        raise NoDerivationError("a sign is not seen between rational instants, so one may be irrational")
    inside = splits(signs.tested, part)
    if inside:
        cut = inside[len(inside) // 2]
    elif part.stop is None:
        cut = part.start + 2 ** (DEEPEST - deeper)
    else:
        third = (part.stop - part.start) / 3
        cut = _between(part.start + third, part.stop - third)
    if not part.has_inside(cut):
        raise NoDerivationError("a sign is not seen at a rational instant")
    before, after = part.cut([cut])
    return [*_cuts(is_seen, before, deeper - 1), cut, *_cuts(is_seen, after, deeper - 1)]


# --- rational instants -----------------------------------------------------------------------------


def _apart(low: Point, high: Point) -> tuple[Fraction, Fraction]:
    """Rationals not below ``low`` and not above ``high``, of which the first is less."""
    width = Fraction(1, 8)
    while True:
        near, far = bounds(low, width)[1], bounds(high, width)[0]
        if near < far:
            return near, far
        width /= 8
        if width < Fraction(1, 2**400):
            raise NoDerivationError("two instants are too near")


def _between(low: Point, high: Point | None) -> Fraction:
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
