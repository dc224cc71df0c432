"""The course of an exploration: drives on a grid of values, narrowed boundaries, and extremes.

Each drive is judged at all other values, so only values without a drive need a search. No claim is made about
values in between.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.surveys.explore.explorable import Explorable
from roadproof.extensions.surveys.extremes.extreme import PRECISION, Extreme, ExtremeQuestion, ExtremeSearch
from roadproof.extensions.surveys.extremes.measure import DriveMeasure, between
from roadproof.extensions.surveys.extremes.points import (
    ClaimGenerator,
    JudgementCache,
    Point,
    PointFinding,
    Points,
)
from roadproof.extensions.surveys.staged import dt_of, duration_parameters
from roadproof.logic.rewrite import is_cubic_state
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

MOST_SEARCHES = 10  # for one boundary
DIGITS = 10**9  # of a value that is written as a decimal
MOST_ROUNDS = 3  # of narrowing, where drives found for one boundary move another


@dataclass(frozen=True)
class SweepBoundary:
    """A boundary of the values with a drive: one ``inside``, and the nearest one ``outside`` without a drive.

    ``excluded``: the nearest value outside at which drives are excluded, by a proof or within limits.
    """

    inside: PointFinding
    outside: PointFinding
    excluded: PointFinding | None


@dataclass(frozen=True)
class ExplorationResult:
    """The findings on the grid, in the order of ``Explorable.points``, and boundaries of a single variable.

    ``drives``: how many drives serve the values.
    """

    findings: tuple[PointFinding, ...] = ()
    boundaries: tuple[SweepBoundary, ...] = ()
    extremes: tuple[Extreme, ...] = ()
    searches: int = 0
    drives: int = 0

    @property
    def verdicts(self) -> list[Verdict]:
        """The verdicts of all values, and of both sides of every bracket."""
        findings: list[PointFinding | None] = [*self.findings]
        findings += [x for boundary in self.boundaries for x in (boundary.inside, boundary.outside)]
        findings += [x for extreme in self.extremes for x in (extreme.best, extreme.outside)]
        return [x.verdict for x in findings if x is not None]


def explore(
    name: str, explorable: Explorable, remembered: JudgementCache
) -> ClaimGenerator[ExplorationResult]:
    """Ask for a drive at every point of the grid, narrow the boundaries of one variable, then seek extremes.

    Names of claims contain ``name``. Raises ``InputError``, ``UsageError``.
    """
    exploring = Exploration(name, explorable, Points(remembered))
    result = ExplorationResult()
    if explorable.variables:
        result = yield from exploring.values()
    extremes: list[Extreme] = []
    for measure in explorable.measures:
        before = len(extremes)
        extremes += yield from exploring.extremes(measure, result.findings, before)
    return replace(result, extremes=tuple(extremes), searches=exploring.points.searches)


class Exploration:
    """The claims of an exploration, and the findings so far."""

    def __init__(self, name: str, explorable: Explorable, points: Points) -> None:
        self.name = name
        self.explorable = explorable
        self.points = points
        self.grid = {point: f"{name}-value-{k:03}" for k, point in enumerate(explorable.points, 1)}
        self.findings: dict[Point, PointFinding] = {}

    def values(self) -> ClaimGenerator[ExplorationResult]:
        """Ask for a drive at every point of the grid, then narrow the boundaries."""
        proved = None
        if not is_cubic_state(self.explorable.search.query.formula):
            proved = yield from self.points.proved(f"{self.name}-any", (), self.explorable.search, "values")
        if proved is not None:
            queries = {point: self.explorable.at(point).query for point in self.grid}
            return ExplorationResult(tuple(replace(proved, at=at, query=x) for at, x in queries.items()))
        yield from self._ask_all()
        boundaries: list[SweepBoundary] = []
        for _ in range(MOST_ROUNDS):
            yield from self._ask_again()
            boundaries = (yield from self._boundaries()) if len(self.explorable.variables) == 1 else []
            if not (yield from self._ask_again()):
                break
        findings = tuple(self.findings[point] for point in self.grid)
        return ExplorationResult(findings, tuple(boundaries), (), 0, len(self.points.drives))

    def _ask_all(self) -> ClaimGenerator[None]:
        """Ask at each point: ends first, then each time the point farthest from those searched."""
        spans = [variable.high - variable.low for variable in self.explorable.variables]
        left, searched = list(self.grid), list[Point]()

        def distance(one: Point, other: Point) -> Fraction:
            return sum((abs(a - b) / span for a, b, span in zip(one, other, spans, strict=True)), Fraction(0))

        nearest = dict.fromkeys(left, Fraction(0))
        while left:
            point = max(left, key=nearest.__getitem__)
            left.remove(point)
            before = self.points.searches
            self.findings[point] = yield from self.points.find(
                self.grid[point], point, self.explorable.at(point)
            )
            if self.points.searches > before:
                first = not searched
                searched.append(point)
                for x in left:
                    away = distance(x, point)
                    nearest[x] = away if first else min(nearest[x], away)

    def _ask_again(self) -> ClaimGenerator[bool]:
        """Ask again where a later drive serves; return whether that changes a finding."""
        better = False
        for point, finding in self.findings.items():
            search = self.explorable.at(point)
            if not finding.has_drive and self.points.has_drive(self.grid[point], search):
                now = yield from self.points.again(f"{self.grid[point]}-later", point, search)
                self.findings[point] = now if now.has_drive else finding
                better |= now.has_drive
        return better

    def _boundaries(self) -> ClaimGenerator[list[SweepBoundary]]:
        """Return the narrowed boundaries between neighbours of which one has a drive."""
        findings = [self.findings[point] for point in self.grid]
        boundaries: list[SweepBoundary] = []
        for one, other in pairwise(findings):
            if one.has_drive == other.has_drive:
                continue
            inside, outside = (one, other) if one.has_drive else (other, one)
            boundary = yield from self.narrow(inside, outside)
            if boundary is not None:
                excluded = boundary.excluded or _first_excluded(inside, outside, findings)
                boundaries.append(replace(boundary, excluded=excluded))
        return boundaries

    def narrow(self, inside: PointFinding, outside: PointFinding) -> ClaimGenerator[SweepBoundary | None]:
        """Narrow the boundary between two neighbours: by judging known drives, then by searches.

        Return None if a drive on the way serves ``outside``, too.
        """
        [variable] = self.explorable.variables
        precision = self.explorable.precision or (variable.high - variable.low) / 60
        setting = self.explorable.search.setting
        lasts = variable.name in duration_parameters(self.explorable.search.query.formula)
        grains = tuple(dt_of(setting) / k for k in (1, 2, 4)) if lasts else ()
        misses = [outside]
        reached, findings = inside.at[0], {inside.at[0]: inside}
        for _ in range(MOST_SEARCHES):
            while misses and self._serves(misses[-1].at[0]):
                reached = misses.pop().at[0]
            if not misses:
                return None
            reached = self._leap(reached, misses[-1].at[0], precision)
            if abs(misses[-1].at[0] - reached) <= precision:
                break
            middle = between(reached, misses[-1].at[0], grains)
            name = f"{self.name}-at-{_file_text(middle)}"
            finding = yield from self.points.find(
                name, (middle,), self.explorable.at((middle,)), natural=False
            )
            if finding.has_drive:
                reached, findings[middle] = middle, finding
            else:
                misses.append(finding)
        if reached not in findings:
            name = f"{self.name}-held-{_file_text(reached)}"
            findings[reached] = yield from self.points.again(name, (reached,), self.explorable.at((reached,)))
        sure = [finding for finding in misses if finding.verdict is not Verdict.UNKNOWN]
        return SweepBoundary(findings[reached], misses[-1], sure[-1] if sure else None)

    def _serves(self, value: Fraction) -> bool:
        return self.points.has_drive(f"{self.name}-{_file_text(value)}", self.explorable.at((value,)))

    def _leap(self, reached: Fraction, outside: Fraction, precision: Fraction) -> Fraction:
        """Return the value nearest to ``outside``, by halving, at which a known drive serves."""
        low, high = reached, outside
        while abs(high - low) > precision:
            middle = between(low, high)
            if self._serves(middle):
                low = middle
            else:
                high = middle
        return low

    def extremes(
        self, measure: DriveMeasure, findings: Sequence[PointFinding], before: int
    ) -> ClaimGenerator[list[Extreme]]:
        """Return the extremes of one measure at every point that has a drive.

        The best drive of each point is tried at all others. Where it goes further, the search continues from
        there. ``before``: the number of extremes before these.
        """
        questions: list[tuple[ExtremeQuestion, tuple[JudgedDrive, ...]]] = []
        for finding in (x for x in findings if x.drive is not None):
            number = before + len(questions) + 1
            assert finding.drive is not None
            questions.append((self._question_at(measure, number, finding.at), (finding.drive,)))
        if not self.explorable.variables:
            precision = self.explorable.precision or PRECISION
            name = f"{self.name}-{measure.sense}-{before + 1}"
            questions.append((ExtremeQuestion(name, self.explorable.search, measure, precision), ()))
        extremes: list[Extreme] = []
        for question, drives in questions:
            extremes.append((yield from ExtremeSearch(question, self.points).run(drives)))
        every = [x.best.drive for x in extremes if x.best is not None and x.best.drive is not None]
        for k, (question, _) in enumerate(questions):
            extremes[k] = yield from self._again(question, extremes[k], every)
        return extremes

    def _again(
        self, question: ExtremeQuestion, extreme: Extreme, drives: Sequence[JudgedDrive]
    ) -> ClaimGenerator[Extreme]:
        """Continue the search of an extreme if a drive of another point goes further."""
        if extreme.best is None or extreme.endless or len(drives) < 2:
            return extreme
        search = ExtremeSearch(replace(question, name=f"{question.name}-again"), self.points)
        others = search.best_of(drives)
        if others is None or (others - extreme.best.at[0]) * question.measure.sign >= 0:
            return extreme
        further = [x for x in drives if search.best_of([x]) == others]
        again = yield from search.run(further[:1])
        return replace(again, searches=extreme.searches + again.searches)

    def _question_at(self, measure: DriveMeasure, number: int, point: Point) -> ExtremeQuestion:
        """Return the question about an extreme at a point."""
        name = f"{self.name}-{measure.sense}-{number}"
        placed, limits = self.explorable.placed(point), self.explorable.stated(point)
        return ExtremeQuestion(name, placed, measure, PRECISION, point, limits)


def _first_excluded(
    inside: PointFinding, outside: PointFinding, findings: Sequence[PointFinding]
) -> PointFinding | None:
    """Return the first decided finding from ``outside`` on, away from ``inside``, before any drive."""
    ahead = findings if outside.at > inside.at else findings[::-1]
    for finding in ahead[ahead.index(outside) :]:
        if finding.has_drive:
            return None
        if finding.verdict is not Verdict.UNKNOWN:
            return finding
    return None


def _file_text(value: Fraction) -> str:
    """Return a value as part of a file name: a decimal, or a fraction such as ``1_3``."""
    whole, rest = divmod(abs(value) * DIGITS, DIGITS)
    if rest.denominator != 1:
        return f"{value.numerator}_{value.denominator}"
    decimal = f"{whole}.{rest.numerator:09}".rstrip("0").rstrip(".")
    return f"-{decimal}" if value < 0 else decimal
