"""For which values of parameters and limits a formula has a drive: a map, and its boundaries narrowed.

A drive that was found for one value is judged at all others, so that only values which no drive serves
yet are searched. Nothing is said of values in between.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import TypeAlias

from roadproof.analysis.explore.answer import (
    Boundary,
    Explorable,
    ExplorationResult,
    Point,
    PointFinding,
    between,
    say_nothing,
    with_point,
)
from roadproof.analysis.explore.search import (
    NATURAL_FIRST,
    PLAIN_FIRST,
    DriveClaim,
    Reply,
    SearchTask,
    Stage,
    Stock,
    claim_of,
    dt_of,
    duration_parameters,
    look,
    missed,
    never,
    stages_for,
)
from roadproof.analysis.study.pool import Say
from roadproof.engines.search.impossible import Impossibility, show_impossible
from roadproof.engines.search.outcome import Search
from roadproof.logic.rewrite import is_cubic_state
from roadproof.reasons import Why
from roadproof.runtime.budget import BudgetExceeded
from roadproof.verdict import Verdict

PROOF = 5.0  # units of work for a proof that there is no drive
QUICK_PROOF = 2.0  # before any search; where a formula can hold, that is mostly seen at once
WIDTH = 2  # searches at once, however many processes there are: each answer spares others
MOST_SEARCHES = 10  # for one boundary
MOST_ROUNDS = 3  # of narrowing, where drives found for one boundary move another

LookAll: TypeAlias = Callable[[Sequence[SearchTask]], Iterable[Reply]]


def _surely_beyond(
    held: PointFinding, missed: PointFinding, findings: Sequence[PointFinding]
) -> PointFinding | None:
    """From ``missed`` on, away from ``held``, the first decided finding, if it comes before a drive."""
    ahead = findings if missed.at > held.at else findings[::-1]
    for finding in ahead[ahead.index(missed) :]:
        if finding.found:
            return None
        if finding.verdict is not Verdict.UNKNOWN:
            return finding
    return None


def look_one_by_one(tasks: Sequence[SearchTask]) -> Iterable[Reply]:
    """Every search in this process."""
    return map(look, tasks)


def explore(
    asked: Explorable, look_all: LookAll = look_one_by_one, say: Say = say_nothing
) -> ExplorationResult:
    """Settle every point of the grid, then narrow the boundaries where there is one knob.

    ``look_all`` does several searches, in order; ``say`` is told how far it is. Raises ``InputError``,
    ``UsageError``, ``MissingSolverError``.
    """
    exploring = ExplorationState(asked, look_all)
    points = asked.points
    settled: dict[Point, PointFinding] = {}
    judged = 0
    while len(settled) < len(points):
        for point in points:
            if point not in settled and (finding := exploring.known(point, judged)) is not None:
                settled[point] = finding
        judged = len(exploring.stock.files)
        left = [point for point in points if point not in settled]
        for finding in exploring.settle(exploring.spread(left)[:WIDTH]):
            settled[finding.at] = finding
        say(f"{len(settled)} of {len(points)} values, {exploring.searches} searches")
    boundaries: list[Boundary] = []
    for _ in range(MOST_ROUNDS):
        exploring.judge_missed(settled)
        findings = tuple(settled[point] for point in points)
        boundaries = _boundaries(exploring, findings, say) if len(asked.knobs) == 1 else []
        if not exploring.judge_missed(settled):
            break
    drives = len(exploring.stock.files)
    return ExplorationResult(findings, tuple(boundaries), (), exploring.searches, drives, late=exploring.late)


def _boundaries(exploring: "ExplorationState", findings: Sequence[PointFinding], say: Say) -> list[Boundary]:
    """The boundaries between neighbours of which one has a drive, narrowed."""
    boundaries: list[Boundary] = []
    for one, other in pairwise(findings):
        if one.found == other.found:
            continue
        held, missed = (one, other) if one.found else (other, one)
        boundary = exploring.narrow(held, missed)
        if boundary is not None:
            surely = boundary.surely or _surely_beyond(held, missed, findings)
            boundaries.append(replace(boundary, surely=surely))
        say(f"{len(boundaries)} boundaries, {exploring.searches} searches")
    return boundaries


class ExplorationState:
    """What is known in the course of an exploration: drives that were found, or that there are none."""

    def __init__(self, asked: Explorable, look_all: LookAll = look_one_by_one) -> None:
        self.asked = asked
        self.look_all = look_all
        self.search = asked.search
        self.stock = Stock(asked.search.specification.library)
        self.searches = 0
        self.searched: list[Point] = []
        self.claims: dict[Point, DriveClaim] = {}
        self.late = False
        self.impossibility = self._impossibility()
        self.lasting = duration_parameters(self.search.query.formula)

    def _impossibility(self) -> Impossibility | None:
        """A proof that there is no drive, whatever the values are; of some formulas it is sought at each."""
        if is_cubic_state(self.search.query.formula):
            return None
        effort = self.search.search_options.effort.of(QUICK_PROOF)
        try:
            return show_impossible(self.search.specification, self.search.query, effort)
        except BudgetExceeded:
            self.late = True
            return None

    def at(self, point: Point) -> Search:
        """The search at a point."""
        return with_point(self.search, self.asked.knobs, point)

    def claim(self, point: Point) -> DriveClaim:
        """What a drive file has to say at a point, limits included."""
        if point not in self.claims:
            self.claims[point] = claim_of(self.at(point), self.asked.query(point))
        return self.claims[point]

    def known(self, point: Point, since: int = 0) -> PointFinding | None:
        """The answer by the proof that there is none, or by a drive that was found before.

        ``since``: so many of the drives are known not to do.
        """
        claim = self.claim(point)
        if self.impossibility is not None:
            core = Why.PROVED_CORE("values", " and ".join(self.impossibility.told))
            certificate = self.impossibility.certificate
            return PointFinding(
                point, claim.query, verdict=Verdict.IMPOSSIBLE, reason=core, certificate=certificate
            )
        shown = self.stock.show(claim, since)
        if shown is None:
            return None
        return PointFinding(
            point, claim.query, verdict=Verdict.WITNESSED, drive=shown.drive, number=shown.number
        )

    def settle(
        self, points: Sequence[Point], stages: tuple[Stage, ...] = NATURAL_FIRST
    ) -> list[PointFinding]:
        """The answers at ``points``, each by a search; of some formulas by a proof where that fails."""
        tasks = [SearchTask(self.at(point), stages_for(self.search, stages)) for point in points]
        self.searches += len(tasks)
        self.searched += points
        findings: list[PointFinding] = []
        for point, reply in zip(points, self.look_all(tasks), strict=True):
            self.late |= reply.late
            self.stock.add(reply.drives)
            query = self.claim(point).query
            findings.append(self.known(point) or self._never(point) or missed(point, query, reply))
        return findings

    def _never(self, point: Point) -> PointFinding | None:
        """A proof that there is no drive at a point, for formulas of which a state says all."""
        try:
            return never(self.at(point), point, self.claim(point).query, QUICK_PROOF)
        except BudgetExceeded:
            self.late = True
            return None

    def spread(self, points: Sequence[Point]) -> list[Point]:
        """``points``, ends first, each as far as can be from those that were searched before it."""
        spans = [knob.high - knob.low for knob in self.asked.knobs]

        def distance(one: Point, other: Point) -> Fraction:
            return sum((abs(a - b) / span for a, b, span in zip(one, other, spans, strict=True)), Fraction(0))

        left, chosen = list(points), list(self.searched)
        order: list[Point] = []
        while left and len(order) < WIDTH:
            far = max(left, key=lambda point: min((distance(point, q) for q in chosen), default=Fraction(0)))
            left.remove(far)
            chosen.append(far)
            order.append(far)
        return order

    def judge_missed(self, settled: dict[Point, PointFinding]) -> bool:
        """Judge all drives where none was found when it was looked for; whether that changes anything."""
        better = False
        for point, finding in settled.items():
            now = None if finding.found else self.known(point)
            if now is not None and now.found:
                settled[point] = now
                better = True
        return better

    def narrow(self, held: PointFinding, missed: PointFinding) -> Boundary | None:
        """The boundary between two neighbours on the grid: leaps by the judge, then halving by searches.

        None where a drive that is found on the way does at ``missed`` too.
        """
        [knob] = self.asked.knobs
        precision = self.asked.precision or (knob.high - knob.low) / 60
        grains = [dt_of(self.search.setting) / k for k in (1, 2, 4)] if knob.name in self.lasting else []
        misses = [missed]
        for _ in range(MOST_SEARCHES):
            while misses and (finding := self.known(misses[-1].at)) is not None and finding.found:
                held = finding
                misses.pop()
            if not misses:
                return None
            held = self.leap(held, misses[-1], precision)
            if abs(misses[-1].at[0] - held.at[0]) <= precision:
                break
            middle = between(held.at[0], misses[-1].at[0], grains)
            [finding] = self.settle([(middle,)], PLAIN_FIRST)
            if finding.found:
                held = finding
            else:
                misses.append(finding)
        sure = [finding for finding in misses if finding.verdict is not Verdict.UNKNOWN]
        return Boundary(held, misses[-1], sure[-1] if sure else None)

    def leap(self, held: PointFinding, missed: PointFinding, precision: Fraction) -> PointFinding:
        """The value nearest to ``missed``, by halving, at which a drive is judged to do that is known."""
        low, high = held.at[0], missed.at[0]
        while abs(high - low) > precision:
            middle = between(low, high)
            finding = self.known((middle,))
            if finding is None:
                high = middle
            else:
                held, low = finding, middle
        return held
