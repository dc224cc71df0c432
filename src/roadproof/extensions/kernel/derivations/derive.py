"""A derivation that a formula is true of a drive, read off the sets of instants at which its parts are true.

The exact judge says when each part is true; here an instant is chosen for each `F`, a disjunct for each `or`,
and rational instants at which the choice changes. Where it has to change exactly at an irrational instant,
cases are made of the sign of a polynomial, which decides the comparisons that change; where that is not
enough there is no derivation. Nothing rests on this: Coq checks what comes out.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias, assert_never

from roadproof.evidence import periodic
from roadproof.evidence.periodic import PeriodicJudge, Window
from roadproof.extensions.kernel.derivation import (
    Crossing,
    Soon,
    Step,
    case,
    crossed,
    element,
    sign,
    soon,
    timed,
)
from roadproof.extensions.kernel.derivations.parts import (
    NoDerivationError,
    at_once,
    breaks,
    contains,
    covered,
    cuts_between,
    image,
    moments,
    moved,
    narrowed,
    put_together,
    run,
    widened,
)
from roadproof.extensions.kernel.derivations.rounds import in_rounds, is_first, ruled
from roadproof.extensions.kernel.derivations.signs import (
    DriveShapes,
    Part,
    Shapes,
    Signs,
    assume,
    compares,
    occupies,
)
from roadproof.library.bind import occupies as occupies_formula
from roadproof.library.bind import without_empty_windows
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import leaves_of, with_values, without_names
from roadproof.reasons import Why
from roadproof.semantics.exact.algebraic import Root
from roadproof.semantics.exact.exact import NOTHING_GIVEN, seconds
from roadproof.semantics.exact.polynomial import negate, polynomial, sign_at
from roadproof.semantics.exact.signals import AbstractSignals, Courses
from roadproof.semantics.exact.truth import (
    ALWAYS,
    START,
    Cut,
    TruthSet,
    complement,
    intersection,
    union,
)
from roadproof.world.drive import Drive
from roadproof.world.road import Road

MOST_STEPS = 5_000
NOTHING = Courses(AbstractSignals({}, {}))
NOW = Part(Cut(Fraction(0), False), Cut(Fraction(0), True))
# What a bound variable speaks of: the number of a lanelet, which stands for its lane, too.
Scope: TypeAlias = Mapping[str, int]


def derive(
    formula: Formula, drive: Drive, road: Road, lanes: Mapping[str, str], values: Mapping[str, Fraction]
) -> Step:
    """Why ``formula`` is true of a drive at time 0.

    Raises ``NoDerivationError``; also where the formula is false.
    """
    return derive_on(DriveShapes(values, drive), with_values(without_names(formula), values), road, lanes)


def derive_on(shapes: Shapes, formula: Formula, road: Road, lanes: Mapping[str, str]) -> Step:
    """Why a formula without parameters is true at time 0. Raises as ``derive``."""
    return _Finding(road, lanes, shapes).why(without_empty_windows(formula), {}, True, NOW)


@dataclass
class _Finding:
    road: Road
    lanes: Mapping[str, str]
    shapes: Shapes
    judges: dict[tuple[tuple[str, int], ...], "_ScopedJudge"] = field(default_factory=dict)
    steps: int = 0

    # --- when something is true ---------------------------------------------------------------------

    def when(self, formula: Formula, scope: Scope, positive: bool = True) -> TruthSet:
        key = tuple(sorted(scope.items()))
        if key not in self.judges:
            loop = self.shapes.loop
            self.judges[key] = _ScopedJudge(NOTHING, NOTHING_GIVEN, loop=loop, finding=self, scope=scope)
        truth = self.judges[key].visit(formula)
        return truth if positive else self._first_round(complement(truth))

    def ahead(self, formula: Formula, scope: Scope, low: Fraction, positive: bool = True) -> TruthSet:
        """The same, in as many rounds as matter to windows from ``low`` on."""
        found, loop = self.when(formula, scope, positive), self.shapes.loop
        return found if loop is None else periodic.ahead(found, low, loop)

    def _first_round(self, truth: TruthSet) -> TruthSet:
        loop = self.shapes.loop
        return truth if loop is None else periodic.first_round(truth, loop)

    def _searched(self, window: Window) -> Window:
        """A window without what lies so late in it that it came before."""
        return window if self.shapes.loop is None else periodic.clipped(window, self.shapes.loop)

    def number(self, name: str, scope: Scope) -> int:
        """Which lanelet a name stands for; a lane by its first one."""
        if name in scope:
            return scope[name]
        lane = self.lanes.get(name, name)
        for number, lanelet in enumerate(self.road.lanelets):
            if lanelet.lane == lane:
                return number
        raise NoDerivationError(Why.NO_LANE(name))

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
            raise NoDerivationError(Why.TOO_MANY_STEPS(MOST_STEPS))
        loop = self.shapes.loop
        if loop is not None and not is_first(part, loop):
            pieces = in_rounds(part, loop)
            return put_together([(x, ruled(r, self.why(formula, scope, positive, y))) for x, y, r in pieces])
        if not contains(self.when(formula, scope, positive), part):
            raise NoDerivationError(Why.NOT_SO())
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
            case f.Application(_, _, body):
                return self.why(body, scope, positive, part)
            case _:
                assert_never(formula)

    def _sign(self, formula: f.Compare | f.Occupies, scope: Scope, positive: bool, part: Part) -> Step:
        leaves: set[t.Leaf]
        if isinstance(formula, f.Occupies):
            leaves = {t.Signal("s", formula.vehicle)}
            lanelet = self.road.lanelets[self.number(formula.lanelet, scope)]

            def is_seen(part: Part, signs: Signs) -> bool:
                return occupies(self.shapes, formula.vehicle, lanelet, positive, part, signs)
        else:
            leaves = {*leaves_of(formula)}
            op = formula.op if positive else f.NEGATED[formula.op]

            def is_seen(part: Part, signs: Signs) -> bool:
                return compares(self.shapes, formula.left, op, formula.right, part, signs)

        steps = sorted({x for leaf in leaves for x in self.shapes.steps(leaf)})
        found: list[tuple[Part, Step]] = []
        for whole in part.around(steps):
            knots = sorted({x for leaf in leaves for x in self.shapes.knots(leaf) if whole.has_inside(x)})
            cuts: list[Fraction] = []
            for place, piece in enumerate(whole.cut(knots)):
                cuts += knots[place - 1 : place] if place else []
                cuts += cuts_between(is_seen, piece)
            found.append((whole, sign(tuple(cuts))))
        return put_together(found)

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
        for piece, place in covered(part, [self.when(x, scope, positive) for x in sides]):
            if isinstance(place, Root):
                found.append((piece, self._case(kind(tuple(parts)), scope, positive, piece, place)))
                continue
            step = self.why(sides[place], scope, positive, piece)
            found.append((piece, Step("One", (str(place == 1).lower(),), (step,))))
        return put_together(found)

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
        for piece, place in covered(part, [self.when(body, x, positive) for x in scopes]):
            if isinstance(place, Root):
                whole = (f.Some if positive else f.Every)(variable, domain, body)
                found.append((piece, self._case(whole, scope, positive, piece, place)))
                continue
            found.append((piece, element(members[place], self.why(body, scopes[place], positive, piece))))
        return put_together(found)

    def _case(self, formula: Formula, scope: Scope, positive: bool, part: Part, change: Root) -> Step:
        """Where a polynomial that has this root is above 0, and where it is not."""
        changing = polynomial(*change.polynomial)
        above, not_above = (assume(self.shapes, formula, part, changing, x) for x in (True, False))
        if formula in (above, not_above):
            raise NoDerivationError(Why.IRRATIONAL_CHANGE())
        return case(
            changing.coefficients,
            self.why(above, scope, positive, part),
            self.why(not_above, scope, positive, part),
        )

    def _timed(
        self,
        body: Formula,
        scope: Scope,
        positive: bool,
        part: Part,
        window: Window,
        once: bool,
    ) -> Step:
        if not once:
            return Step("Whole", (), (self.why(body, scope, positive, widened(part, window)),))
        found: list[tuple[Part, Step]] = []
        when = self.ahead(body, scope, window[0], positive)
        for piece, moment in moments(part, self._searched(window), when, ALWAYS):
            if isinstance(moment, Crossing):
                found.append((piece, self._crossed(moment, scope, positive, body)))
                continue
            step = self.why(body, scope, positive, image(piece, moment))
            found.append((piece, timed("Moment", moment, step)))
        return put_together(found)

    def _until(
        self,
        left: Formula,
        right: Formula,
        scope: Scope,
        part: Part,
        window: Window,
    ) -> Step:
        found: list[tuple[Part, Step]] = []
        comes, kept = (self.ahead(x, scope, window[0]) for x in (right, left))
        for piece, moment in moments(part, self._searched(window), comes, kept):
            if isinstance(moment, Crossing):
                begin = moved(piece.begin, window[0])
                found.append((piece, self._crossed(moment, scope, True, right, left, begin)))
                continue
            before = Step("Plain")
            if not at_once(piece, moment, window[0]):
                before = self.why(left, scope, True, run(piece, moment, window[0], out=True))
            after = self.why(right, scope, True, image(piece, moment))
            found.append((piece, timed("Reach", moment, before, after)))
        return put_together(found)

    def _not_until(
        self,
        left: Formula,
        right: Formula,
        scope: Scope,
        part: Part,
        window: Window,
    ) -> Step:
        never, failing = (self.ahead(x, scope, window[0], False) for x in (right, left))
        found: list[tuple[Part, Step]] = []
        for piece, moment in breaks(part, self._searched(window), never, failing):
            if moment is None:
                step = Step("Whole", (), (self.why(right, scope, False, widened(piece, window)),))
            elif isinstance(moment, Crossing):
                step = self._crossed(moment, scope, False, left, right, moved(piece.begin, window[0]))
            elif isinstance(moment, Soon):
                early = Part(moved(piece.begin, window[0]), Cut(moment.begin, True))
                late = Part(early.end or early.begin, Cut(moment.end, False))
                step = soon(moment, self.why(right, scope, False, early), self.why(left, scope, False, late))
            else:
                step = timed(
                    "Break",
                    moment,
                    self.why(left, scope, False, image(piece, moment)),
                    self.why(right, scope, False, run(piece, moment, window[0], out=False)),
                )
            found.append((piece, step))
        return put_together(found)

    def _crossed(
        self,
        moment: Crossing,
        scope: Scope,
        positive: bool,
        last: Formula,
        lasting: Formula | None = None,
        begin: Cut = START,
    ) -> Step:
        """What comes at an irrational instant, or right after it, and what lasts from ``begin`` to it."""
        formulas = [last] if lasting is None else [last, lasting]
        leaves = {x for formula in formulas for x in leaves_of(formula)}
        times = {x for leaf in leaves for x in (*self.shapes.knots(leaf), *self.shapes.steps(leaf))}
        moment = narrowed(moment, times)
        near = Part(Cut(moment.begin, False), Cut(moment.end, True))
        at_it = lasting is None or positive
        above = sign_at(moment.polynomial, moment.begin if at_it else moment.end)
        changing = polynomial(*(above * x for x in moment.polynomial))
        before = between = Step("Plain")
        if lasting is not None:
            before = self.why(lasting, scope, positive, Part(begin, Cut(moment.begin, True)))
            between = self.why(assume(self.shapes, lasting, near, changing, positive), scope, positive, near)
        if at_it:
            last = assume(self.shapes, last, near, negate(changing), False)
        last = assume(self.shapes, last, near, changing, not at_it)
        return crossed(moment, above, (before, between, self.why(last, scope, positive, near)))


@dataclass(frozen=True, kw_only=True)
class _ScopedJudge(PeriodicJudge):
    """Judges formulas on the drive, and on its road with what bound variables stand for."""

    finding: _Finding
    scope: Scope

    def _visit(self, formula: Formula) -> TruthSet:
        match formula:
            case f.Compare():
                return self.finding.shapes.when(formula)
            case f.Occupies(vehicle, name):
                lanelet = self.finding.road.lanelets[self.finding.number(name, self.scope)]
                return self.visit(occupies_formula(vehicle, lanelet))
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):
                scopes = ({**self.scope, variable: e} for e in self.finding.members(domain, self.scope))
                truths = [self.finding.when(body, scope) for scope in scopes]
                return union(truths) if isinstance(formula, f.Some) else intersection(truths)
            case _:
                return PeriodicJudge._visit(self, formula)
