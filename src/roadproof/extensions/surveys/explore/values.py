"""For which values of parameters and limits a formula has a drive: a map, and its boundaries narrowed.

A drive that was found for one value is judged at all others, so that only values which no drive serves
yet are searched. Nothing is said of values in between.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from roadproof.engines.search.stages import dt_of, duration_parameters
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.surveys.explore.asking import Explorable
from roadproof.extensions.surveys.extremes.extreme import PRECISION, Extreme, ExtremeQuestion, ExtremeSearch
from roadproof.extensions.surveys.extremes.measure import Measure, between
from roadproof.extensions.surveys.extremes.points import Asking, Point, PointFinding, Points, Remembered
from roadproof.logic.rewrite import is_cubic_state
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

MOST_SEARCHES = 10  # for one boundary
DIGITS = 10**9  # of a value that is written as a decimal
MOST_ROUNDS = 3  # of narrowing, where drives found for one boundary move another


@dataclass(frozen=True)
class Boundary:
    """A value with a drive and the nearest value looked at, on one side, for which none was found.

    ``surely``: the nearest value on that side for which it is said that there is none, if any is.
    """

    held: PointFinding
    missed: PointFinding
    surely: PointFinding | None


@dataclass(frozen=True)
class ExplorationResult:
    """``findings`` on the grid, in the order of ``Explorable.points``; boundaries where there is one knob.

    ``drives``: how many serve the values.
    """

    findings: tuple[PointFinding, ...] = ()
    boundaries: tuple[Boundary, ...] = ()
    extremes: tuple[Extreme, ...] = ()
    searches: int = 0
    drives: int = 0

    @property
    def verdicts(self) -> list[Verdict]:
        """The verdicts that decide whether all is: of all values, and of both sides of every bracket."""
        found: list[PointFinding | None] = [*self.findings]
        found += [x for boundary in self.boundaries for x in (boundary.held, boundary.missed)]
        found += [x for extreme in self.extremes for x in (extreme.best, extreme.missed)]
        return [x.verdict for x in found if x is not None]


def explore(name: str, asked: Explorable, remembered: Remembered) -> Asking[ExplorationResult]:
    """Ask for a drive at every point of the grid, narrow the boundaries of one knob, then seek extremes.

    Names of claims contain ``name``. Raises ``InputError``, ``UsageError``.
    """
    exploring = Exploration(name, asked, Points(remembered))
    found = ExplorationResult()
    if asked.knobs:
        found = yield from exploring.values()
    extremes: list[Extreme] = []
    for measure in asked.measures:
        begun = len(extremes)
        extremes += yield from exploring.extremes(measure, found.findings, begun)
    return replace(found, extremes=tuple(extremes), searches=exploring.points.searches)


class Exploration:
    """The claims of an exploration, and what is known in the course of it."""

    def __init__(self, name: str, asked: Explorable, points: Points) -> None:
        self.name = name
        self.asked = asked
        self.points = points
        self.grid = {point: f"{name}-value-{k:03}" for k, point in enumerate(asked.points, 1)}
        self.settled: dict[Point, PointFinding] = {}

    def values(self) -> Asking[ExplorationResult]:
        """Ask for a drive at every point of the grid, then narrow the boundaries."""
        proved = None
        if not is_cubic_state(self.asked.search.query.formula):
            proved = yield from self.points.proved(f"{self.name}-any", (), self.asked.search, "values")
        if proved is not None:
            never = proved
            return ExplorationResult(
                tuple(replace(never, at=point, query=self.asked.at(point).query) for point in self.grid)
            )
        yield from self._ask_all()
        boundaries: list[Boundary] = []
        for _ in range(MOST_ROUNDS):
            yield from self._ask_missed()
            boundaries = (yield from self._boundaries()) if len(self.asked.knobs) == 1 else []
            if not (yield from self._ask_missed()):
                break
        findings = tuple(self.settled[point] for point in self.grid)
        return ExplorationResult(findings, tuple(boundaries), (), 0, len(self.points.drives))

    def _ask_all(self) -> Asking[None]:
        """Ask at each point: ends first, each as far as can be from those that were searched before it."""
        spans = [knob.high - knob.low for knob in self.asked.knobs]
        left, searched = list(self.grid), list[Point]()

        def distance(one: Point, other: Point) -> Fraction:
            return sum((abs(a - b) / span for a, b, span in zip(one, other, spans, strict=True)), Fraction(0))

        nearest = dict.fromkeys(left, Fraction(0))
        while left:
            point = max(left, key=nearest.__getitem__)
            left.remove(point)
            before = self.points.searches
            self.settled[point] = yield from self.points.find(self.grid[point], point, self.asked.at(point))
            if self.points.searches > before:
                first = not searched
                searched.append(point)
                for x in left:
                    away = distance(x, point)
                    nearest[x] = away if first else min(nearest[x], away)

    def _ask_missed(self) -> Asking[bool]:
        """Ask again where no drive was found before one was that serves; return whether that changes any."""
        better = False
        for point, finding in self.settled.items():
            search = self.asked.at(point)
            if not finding.found and self.points.has_drive(self.grid[point], search):
                now = yield from self.points.again(f"{self.grid[point]}-later", point, search)
                self.settled[point] = now if now.found else finding
                better |= now.found
        return better

    def _boundaries(self) -> Asking[list[Boundary]]:
        """The boundaries between neighbours of which one has a drive, narrowed."""
        findings = [self.settled[point] for point in self.grid]
        boundaries: list[Boundary] = []
        for one, other in pairwise(findings):
            if one.found == other.found:
                continue
            held, missed = (one, other) if one.found else (other, one)
            boundary = yield from self.narrow(held, missed)
            if boundary is not None:
                surely = boundary.surely or _surely_beyond(held, missed, findings)
                boundaries.append(replace(boundary, surely=surely))
        return boundaries

    def narrow(self, held: PointFinding, missed: PointFinding) -> Asking[Boundary | None]:
        """The boundary between two neighbours on the grid: leaps by the judge, then halving by searches.

        None where a drive that is found on the way does at ``missed`` too.
        """
        [knob] = self.asked.knobs
        precision = self.asked.precision or (knob.high - knob.low) / 60
        setting = self.asked.search.setting
        lasts = knob.name in duration_parameters(self.asked.search.query.formula)
        grains = tuple(dt_of(setting) / k for k in (1, 2, 4)) if lasts else ()
        misses = [missed]
        reached, found = held.at[0], {held.at[0]: held}
        for _ in range(MOST_SEARCHES):
            while misses and self._serves(misses[-1].at[0]):
                reached = misses.pop().at[0]
            if not misses:
                return None
            reached = self._leap(reached, misses[-1].at[0], precision)
            if abs(misses[-1].at[0] - reached) <= precision:
                break
            middle = between(reached, misses[-1].at[0], grains)
            name = f"{self.name}-at-{_told(middle)}"
            finding = yield from self.points.find(name, (middle,), self.asked.at((middle,)), natural=False)
            if finding.found:
                reached, found[middle] = middle, finding
            else:
                misses.append(finding)
        if reached not in found:
            name = f"{self.name}-held-{_told(reached)}"
            found[reached] = yield from self.points.again(name, (reached,), self.asked.at((reached,)))
        sure = [finding for finding in misses if finding.verdict is not Verdict.UNKNOWN]
        return Boundary(found[reached], misses[-1], sure[-1] if sure else None)

    def _serves(self, value: Fraction) -> bool:
        return self.points.has_drive(f"{self.name}-{_told(value)}", self.asked.at((value,)))

    def _leap(self, reached: Fraction, missed: Fraction, precision: Fraction) -> Fraction:
        """The value nearest to ``missed``, by halving, at which a drive is judged to do that is known."""
        low, high = reached, missed
        while abs(high - low) > precision:
            middle = between(low, high)
            if self._serves(middle):
                low = middle
            else:
                high = middle
        return low

    def extremes(
        self, measure: Measure, findings: Sequence[PointFinding], before: int
    ) -> Asking[list[Extreme]]:
        """The extremes of one measure at every point that has a drive.

        The best drive of each is tried at all others. Where it goes further, that extreme is sought once more
        from there. ``before``: how many extremes come before them.
        """
        asked: list[tuple[ExtremeQuestion, tuple[JudgedDrive, ...]]] = []
        for finding in (x for x in findings if x.drive is not None):
            number = before + len(asked) + 1
            assert finding.drive is not None
            asked.append((self._sought(measure, number, finding.at), (finding.drive,)))
        if not self.asked.knobs:
            precision = self.asked.precision or PRECISION
            name = f"{self.name}-{measure.sense}-{before + 1}"
            asked.append((ExtremeQuestion(name, self.asked.search, measure, precision), ()))
        found: list[Extreme] = []
        for sought, drives in asked:
            found.append((yield from ExtremeSearch(sought, self.points).run(drives)))
        every = [x.best.drive for x in found if x.best is not None and x.best.drive is not None]
        for k, (sought, _) in enumerate(asked):
            found[k] = yield from self._again(sought, found[k], every)
        return found

    def _again(
        self, sought: ExtremeQuestion, extreme: Extreme, drives: Sequence[JudgedDrive]
    ) -> Asking[Extreme]:
        """Seek an extreme once more, where a drive of another point goes further."""
        if extreme.best is None or extreme.endless or len(drives) < 2:
            return extreme
        search = ExtremeSearch(replace(sought, name=f"{sought.name}-again"), self.points)
        others = search.best_of(drives)
        if others is None or (others - extreme.best.at[0]) * sought.measure.sign >= 0:
            return extreme
        further = [x for x in drives if search.best_of([x]) == others]
        again = yield from search.run(further[:1])
        return replace(again, searches=extreme.searches + again.searches)

    def _sought(self, measure: Measure, number: int, point: Point) -> ExtremeQuestion:
        """What is sought at a point."""
        name = f"{self.name}-{measure.sense}-{number}"
        placed, limits = self.asked.placed(point), self.asked.stated(point)
        return ExtremeQuestion(name, placed, measure, PRECISION, point, limits)


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


def _told(value: Fraction) -> str:
    """A value in the name of a file: as a decimal, or as 1_3."""
    whole, rest = divmod(abs(value) * DIGITS, DIGITS)
    if rest.denominator != 1:
        return f"{value.numerator}_{value.denominator}"
    decimal = f"{whole}.{rest.numerator:09}".rstrip("0").rstrip(".")
    return f"-{decimal}" if value < 0 else decimal
