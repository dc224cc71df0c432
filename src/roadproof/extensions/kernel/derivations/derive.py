"""Derivations that a formula is true of a drive, guided by the truth sets of its parts.

The exact judge computes when each part is true. A derivation chooses an instant for each `F`, a disjunct for
each `or`, and rational instants at which the choice changes. If the change must be at an irrational instant,
the derivation splits on the sign of a polynomial that decides the comparisons; if that is not enough, there
is none. Not trusted: Coq checks the derivation.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import assert_never

from roadproof.errors import InputError
from roadproof.evidence import periodic
from roadproof.evidence.periodic import PeriodicJudge, Window
from roadproof.extensions.kernel.derivation import (
    Crossing,
    DerivationStep,
    Soon,
    case,
    crossed,
    element,
    sign,
    soon,
    timed,
)
from roadproof.extensions.kernel.derivations.lanelets import LaneletNumbers, Scope
from roadproof.extensions.kernel.derivations.parts import (
    NoDerivationError,
    at_once,
    breaks,
    contains,
    covered,
    cuts_between,
    image,
    join_steps,
    moments,
    moved,
    narrowed,
    run,
    widened,
)
from roadproof.extensions.kernel.derivations.rounds import by_rule, in_rounds, is_first
from roadproof.extensions.kernel.derivations.signs import (
    DriveShapes,
    Shapes,
    Signs,
    TimePart,
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
from roadproof.reasons import ReasonKind
from roadproof.semantics.exact.algebraic import Root
from roadproof.semantics.exact.judging import NOTHING_GIVEN, interval_seconds
from roadproof.semantics.exact.polynomial import negate, polynomial, sign_at
from roadproof.semantics.exact.signals import AbstractSignals, TermPieces
from roadproof.semantics.exact.truth import ALWAYS, START, Cut, TruthSet, complement, intersection, union
from roadproof.world.drive import Drive
from roadproof.world.road import Road

MOST_STEPS = 5_000
NOTHING = TermPieces(AbstractSignals({}, {}))
NOW = TimePart(Cut(Fraction(0), False), Cut(Fraction(0), True))


def derive(
    formula: Formula, drive: Drive, road: Road, lanes: Mapping[str, str], values: Mapping[str, Fraction]
) -> DerivationStep:
    """Return a derivation that ``formula`` is true of a drive at time 0.

    Raises ``NoDerivationError``, also if the formula is false.
    """
    return derive_on(DriveShapes(values, drive), with_values(without_names(formula), values), road, lanes)


def derive_on(shapes: Shapes, formula: Formula, road: Road, lanes: Mapping[str, str]) -> DerivationStep:
    """Return a derivation of a formula without parameters at time 0. Raises ``NoDerivationError``."""
    return _Deriver(LaneletNumbers(road, lanes), shapes).why(without_empty_windows(formula), {}, True, NOW)


@dataclass
class _Deriver:
    """A search for derivations on one drive or trace."""

    lanelets: LaneletNumbers
    shapes: Shapes
    judges: dict[tuple[tuple[str, int], ...], "_ScopedJudge"] = field(default_factory=dict)
    steps: int = 0

    # --- when something is true ---------------------------------------------------------------------

    def when(self, formula: Formula, scope: Scope, positive: bool = True) -> TruthSet:
        """Return the times at which a formula is true, or false if not ``positive``."""
        key = tuple(sorted(scope.items()))
        if key not in self.judges:
            loop = self.shapes.loop
            self.judges[key] = _ScopedJudge(NOTHING, NOTHING_GIVEN, loop=loop, deriver=self, scope=scope)
        truth = self.judges[key].visit(formula)
        return truth if positive else self._first_round(complement(truth))

    def ahead(self, formula: Formula, scope: Scope, low: Fraction, positive: bool = True) -> TruthSet:
        """Return ``when`` in as many rounds as matter to windows from ``low`` on."""
        truth, loop = self.when(formula, scope, positive), self.shapes.loop
        return truth if loop is None else periodic.unroll_ahead(truth, low, loop)

    def _first_round(self, truth: TruthSet) -> TruthSet:
        loop = self.shapes.loop
        return truth if loop is None else periodic.first_round(truth, loop)

    def _searched(self, window: Window) -> Window:
        """Return the window without its part so late that the same states also occur earlier in it."""
        return window if self.shapes.loop is None else periodic.clip(window, self.shapes.loop)

    # --- why it is ----------------------------------------------------------------------------------

    def why(self, formula: Formula, scope: Scope, positive: bool, part: TimePart) -> DerivationStep:
        """Return a derivation that ``formula`` is true (or false) at every instant of ``part``."""
        self.steps += 1
        if self.steps > MOST_STEPS:
            raise NoDerivationError(ReasonKind.TOO_MANY_STEPS(MOST_STEPS))
        loop = self.shapes.loop
        if loop is not None and not is_first(part, loop):
            pieces = in_rounds(part, loop)
            return join_steps([(x, by_rule(r, self.why(formula, scope, positive, y))) for x, y, r in pieces])
        if not contains(self.when(formula, scope, positive), part):
            raise NoDerivationError(ReasonKind.NOT_SO())
        match formula:
            case f.Truth():
                return DerivationStep("Plain")
            case f.Compare() | f.Occupies():
                return self._sign(formula, scope, positive, part)
            case f.Not(body):
                return DerivationStep("Turn", (), (self.why(body, scope, not positive, part),))
            case f.And(parts):
                return self._joined(parts, scope, positive, part, f.And, both=positive)
            case f.Or(parts):
                return self._joined(parts, scope, positive, part, f.Or, both=not positive)
            case f.Some(variable, domain, body):
                return self._quantified(variable, domain, body, scope, positive, part, one=positive)
            case f.Every(variable, domain, body):
                return self._quantified(variable, domain, body, scope, positive, part, one=not positive)
            case f.Eventually(interval, body):
                return self._timed(body, scope, positive, part, interval_seconds(interval), once=positive)
            case f.Always(interval, body):
                return self._timed(body, scope, positive, part, interval_seconds(interval), once=not positive)
            case f.Until(left, interval, right) if positive:
                return self._until(left, right, scope, part, interval_seconds(interval))
            case f.Until(left, interval, right):
                return self._not_until(left, right, scope, part, interval_seconds(interval))
            case f.Since():
                raise InputError(f.NO_PAST)
            case f.Application(_, _, body):
                return self.why(body, scope, positive, part)
            case _:
                assert_never(formula)

    def _sign(
        self, formula: f.Compare | f.Occupies, scope: Scope, positive: bool, part: TimePart
    ) -> DerivationStep:
        leaves: set[t.Leaf]
        if isinstance(formula, f.Occupies):
            leaves = {t.Signal("s", formula.vehicle)}
            lanelet = self.lanelets.lanelet(formula.lanelet, scope)

            def is_seen(part: TimePart, signs: Signs) -> bool:
                return occupies(self.shapes, formula.vehicle, lanelet, positive, part, signs)
        else:
            leaves = {*leaves_of(formula)}
            op = formula.op if positive else f.NEGATED[formula.op]

            def is_seen(part: TimePart, signs: Signs) -> bool:
                return compares(self.shapes, formula.left, op, formula.right, part, signs)

        steps = sorted({x for leaf in leaves for x in self.shapes.steps(leaf)})
        steps_of_parts: list[tuple[TimePart, DerivationStep]] = []
        for whole in part.around(steps):
            knots = sorted({x for leaf in leaves for x in self.shapes.knots(leaf) if whole.has_inside(x)})
            cuts: list[Fraction] = []
            for place, piece in enumerate(whole.cut(knots)):
                cuts += knots[place - 1 : place] if place else []
                cuts += cuts_between(is_seen, piece)
            steps_of_parts.append((whole, sign(tuple(cuts))))
        return join_steps(steps_of_parts)

    def _joined(
        self,
        parts: Sequence[Formula],
        scope: Scope,
        positive: bool,
        part: TimePart,
        kind: type[f.And | f.Or],
        both: bool,
    ) -> DerivationStep:
        """Return a derivation of a conjunction or disjunction; Coq nests it: ``p and (q and r)``."""
        if not parts:
            return DerivationStep("Plain")
        if len(parts) == 1:
            return self.why(parts[0], scope, positive, part)
        sides = parts[0], parts[1] if len(parts) == 2 else kind(tuple(parts[1:]))
        if both:
            return DerivationStep("Both", (), tuple(self.why(x, scope, positive, part) for x in sides))
        steps: list[tuple[TimePart, DerivationStep]] = []
        for piece, place in covered(part, [self.when(x, scope, positive) for x in sides]):
            if isinstance(place, Root):
                steps.append((piece, self._case(kind(tuple(parts)), scope, positive, piece, place)))
                continue
            step = self.why(sides[place], scope, positive, piece)
            steps.append((piece, DerivationStep("One", (str(place == 1).lower(),), (step,))))
        return join_steps(steps)

    def _quantified(
        self,
        variable: str,
        domain: f.Domain,
        body: Formula,
        scope: Scope,
        positive: bool,
        part: TimePart,
        one: bool,
    ) -> DerivationStep:
        members = self.lanelets.members(domain, scope)
        scopes = [{**scope, variable: e} for e in members]
        if not one:
            return DerivationStep(
                "Each", (), tuple(self.why(body, x, positive, part) for x in scopes), many=True
            )
        steps: list[tuple[TimePart, DerivationStep]] = []
        for piece, place in covered(part, [self.when(body, x, positive) for x in scopes]):
            if isinstance(place, Root):
                whole = (f.Some if positive else f.Every)(variable, domain, body)
                steps.append((piece, self._case(whole, scope, positive, piece, place)))
                continue
            steps.append((piece, element(members[place], self.why(body, scopes[place], positive, piece))))
        return join_steps(steps)

    def _case(
        self, formula: Formula, scope: Scope, positive: bool, part: TimePart, change: Root
    ) -> DerivationStep:
        """Return a derivation by cases: the polynomial with this root is above 0, or not."""
        changing = polynomial(*change.polynomial)
        above, not_above = (assume(self.shapes, formula, part, changing, x) for x in (True, False))
        if formula in (above, not_above):
            raise NoDerivationError(ReasonKind.IRRATIONAL_CHANGE())
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
        part: TimePart,
        window: Window,
        once: bool,
    ) -> DerivationStep:
        if not once:
            return DerivationStep("Whole", (), (self.why(body, scope, positive, widened(part, window)),))
        steps: list[tuple[TimePart, DerivationStep]] = []
        when = self.ahead(body, scope, window[0], positive)
        for piece, moment in moments(part, self._searched(window), when, ALWAYS):
            if isinstance(moment, Crossing):
                steps.append((piece, self._crossed(moment, scope, positive, body)))
                continue
            step = self.why(body, scope, positive, image(piece, moment))
            steps.append((piece, timed("Moment", moment, step)))
        return join_steps(steps)

    def _until(
        self,
        left: Formula,
        right: Formula,
        scope: Scope,
        part: TimePart,
        window: Window,
    ) -> DerivationStep:
        steps: list[tuple[TimePart, DerivationStep]] = []
        comes, lasting = (self.ahead(x, scope, window[0]) for x in (right, left))
        for piece, moment in moments(part, self._searched(window), comes, lasting):
            if isinstance(moment, Crossing):
                begin = moved(piece.begin, window[0])
                steps.append((piece, self._crossed(moment, scope, True, right, left, begin)))
                continue
            before = DerivationStep("Plain")
            if not at_once(piece, moment, window[0]):
                before = self.why(left, scope, True, run(piece, moment, window[0], out=True))
            after = self.why(right, scope, True, image(piece, moment))
            steps.append((piece, timed("Reach", moment, before, after)))
        return join_steps(steps)

    def _not_until(
        self,
        left: Formula,
        right: Formula,
        scope: Scope,
        part: TimePart,
        window: Window,
    ) -> DerivationStep:
        never, failing = (self.ahead(x, scope, window[0], False) for x in (right, left))
        steps: list[tuple[TimePart, DerivationStep]] = []
        for piece, moment in breaks(part, self._searched(window), never, failing):
            if moment is None:
                step = DerivationStep("Whole", (), (self.why(right, scope, False, widened(piece, window)),))
            elif isinstance(moment, Crossing):
                step = self._crossed(moment, scope, False, left, right, moved(piece.begin, window[0]))
            elif isinstance(moment, Soon):
                early = TimePart(moved(piece.begin, window[0]), Cut(moment.begin, True))
                late = TimePart(early.end or early.begin, Cut(moment.end, False))
                step = soon(moment, self.why(right, scope, False, early), self.why(left, scope, False, late))
            else:
                step = timed(
                    "Break",
                    moment,
                    self.why(left, scope, False, image(piece, moment)),
                    self.why(right, scope, False, run(piece, moment, window[0], out=False)),
                )
            steps.append((piece, step))
        return join_steps(steps)

    def _crossed(
        self,
        moment: Crossing,
        scope: Scope,
        positive: bool,
        last: Formula,
        lasting: Formula | None = None,
        begin: Cut = START,
    ) -> DerivationStep:
        """Return a derivation with an irrational instant.

        ``last`` holds at it or right after it, ``lasting`` from ``begin`` up to it.
        """
        formulas = [last] if lasting is None else [last, lasting]
        leaves = {x for formula in formulas for x in leaves_of(formula)}
        times = {x for leaf in leaves for x in (*self.shapes.knots(leaf), *self.shapes.steps(leaf))}
        moment = narrowed(moment, times)
        near = TimePart(Cut(moment.begin, False), Cut(moment.end, True))
        at_it = lasting is None or positive
        above = sign_at(moment.polynomial, moment.begin if at_it else moment.end)
        changing = polynomial(*(above * x for x in moment.polynomial))
        before = between = DerivationStep("Plain")
        if lasting is not None:
            before = self.why(lasting, scope, positive, TimePart(begin, Cut(moment.begin, True)))
            between = self.why(assume(self.shapes, lasting, near, changing, positive), scope, positive, near)
        if at_it:
            last = assume(self.shapes, last, near, negate(changing), False)
        last = assume(self.shapes, last, near, changing, not at_it)
        return crossed(moment, above, (before, between, self.why(last, scope, positive, near)))


@dataclass(frozen=True, kw_only=True)
class _ScopedJudge(PeriodicJudge):
    """A judge of formulas on the drive and its road; ``scope`` has the values of bound variables."""

    deriver: _Deriver
    scope: Scope

    def _visit(self, formula: Formula) -> TruthSet:
        match formula:
            case f.Compare():
                return self.deriver.shapes.when(formula)
            case f.Occupies(vehicle, name):
                lanelet = self.deriver.lanelets.lanelet(name, self.scope)
                return self.visit(occupies_formula(vehicle, lanelet))
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):
                scopes = (
                    {**self.scope, variable: e} for e in self.deriver.lanelets.members(domain, self.scope)
                )
                truths = [self.deriver.when(body, scope) for scope in scopes]
                return union(truths) if isinstance(formula, f.Some) else intersection(truths)
            case f.Truth() | f.Not() | f.And() | f.Or() | f.Application():
                return PeriodicJudge._visit(self, formula)
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                return PeriodicJudge._visit(self, formula)
