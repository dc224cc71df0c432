"""For which values of parameters and limits a formula has a drive: a map, and its boundaries narrowed.

A drive that was found for one value is judged at all others, so that only values which no drive serves
yet are searched. Nothing is said of values in between.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise, product
from typing import Any, TypeAlias

from roadproof.analysis.explore.knobs import Knob, Point, between, stated, with_point
from roadproof.analysis.explore.search import (
    NATURAL_FIRST,
    PLAIN_FIRST,
    Claim,
    Pool,
    Reply,
    Stage,
    Task,
    claim_of,
    duration_parameters,
    look,
)
from roadproof.analysis.explore.text import conjoin
from roadproof.analysis.requests import Request
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import load_library
from roadproof.verdict import Verdict
from roadproof.witness.impossible import Impossibility, show_impossible

PROOF = 5.0  # units of work for a proof that there is no drive
QUICK_PROOF = 2.0  # before any search; where a formula can hold, that is mostly seen at once
WIDTH = 2  # searches at once, however many processes there are: each answer spares others
MOST_SEARCHES = 10  # for one boundary
MOST_ROUNDS = 3  # of narrowing, where drives found for one boundary move another

LookAll: TypeAlias = Callable[[Sequence[Task]], Iterable[Reply]]
Say: TypeAlias = Callable[[str], None]


@dataclass(frozen=True)
class Asked:
    """The values of ``knobs`` for which ``request.what``, a formula, has a drive.

    ``steps``: values of each knob; ``precision``: how far boundaries are narrowed, in SI units of the
    knob (None: a sixtieth of its range).
    """

    request: Request
    knobs: tuple[Knob, ...]
    steps: int
    precision: Fraction | None = None


@dataclass(frozen=True)
class Finding:
    """The answer at one point. ``formula`` is what the drive satisfies, or what has no drive.

    ``drive`` is a drive file's data, ``number`` tells drives apart; ``certificate`` proves for all values
    that there is none.
    """

    at: Point
    verdict: Verdict
    formula: str
    reason: str = ""
    drive: Mapping[str, Any] | None = None
    number: int | None = None
    certificate: Mapping[str, Any] | None = None

    @property
    def found(self) -> bool:
        return self.verdict is Verdict.WITNESSED


@dataclass(frozen=True)
class Boundary:
    """A value with a drive and the nearest value looked at, on one side, for which none was found.

    ``surely``: the nearest value on that side for which it is said that there is none, if any is.
    """

    held: Finding
    missed: Finding
    surely: Finding | None


@dataclass(frozen=True)
class Explored:
    """``findings`` on the grid in the order of the product of the knobs' values; boundaries for one knob."""

    findings: tuple[Finding, ...]
    boundaries: tuple[Boundary, ...]
    searches: int
    drives: int


def _surely_beyond(held: Finding, missed: Finding, findings: Sequence[Finding]) -> Finding | None:
    """From ``missed`` on, away from ``held``, the first decided finding, if it comes before a drive."""
    ahead = findings if missed.at > held.at else findings[::-1]
    for finding in ahead[ahead.index(missed) :]:
        if finding.found:
            return None
        if finding.verdict is not Verdict.UNKNOWN:
            return finding
    return None


def look_one_by_one(tasks: Sequence[Task]) -> Iterable[Reply]:
    """Every search in this process."""
    return map(look, tasks)


def explore(asked: Asked, look_all: LookAll = look_one_by_one, say: Say = lambda text: None) -> Explored:
    """Settle every point of the grid, then narrow the boundaries where there is one knob.

    ``look_all`` does several searches, in order; ``say`` is told how far it is. Raises ``InputError``,
    ``UsageError``, ``MissingSolverError``.
    """
    exploring = Exploring(asked, look_all)
    points = list(product(*(knob.values(asked.steps) for knob in asked.knobs)))
    settled: dict[Point, Finding] = {}
    judged = 0
    while len(settled) < len(points):
        for point in points:
            if point not in settled and (finding := exploring.known(point, judged)) is not None:
                settled[point] = finding
        judged = len(exploring.pool.files)
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
    return Explored(findings, tuple(boundaries), exploring.searches, len(exploring.pool.files))


def _boundaries(exploring: "Exploring", findings: Sequence[Finding], say: Say) -> list[Boundary]:
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


class Exploring:
    """What is known in the course of an exploration: drives that were found, or that there are none."""

    def __init__(self, asked: Asked, look_all: LookAll = look_one_by_one) -> None:
        self.asked = asked
        self.look_all = look_all
        self.library = load_library(asked.request.specs)
        self.specification = self.library.select(asked.request.set_name, asked.request.options)
        self.pool = Pool(self.library)
        self.searches = 0
        self.searched: list[Point] = []
        self.claims: dict[Point, Claim] = {}
        query = read_claim(self.specification, asked.request.what)
        self.impossibility: Impossibility | None = show_impossible(
            self.specification, query, asked.request.means.effort.of(QUICK_PROOF)
        )
        self.lasting = duration_parameters(query.formula)

    def request(self, point: Point) -> Request:
        """The question at a point."""
        return with_point(self.asked.request, self.asked.knobs, point)

    def claim(self, point: Point) -> Claim:
        """What a drive file has to say at a point, limits included."""
        if point not in self.claims:
            text = conjoin(self.asked.request.what, stated(self.asked.knobs, point))
            self.claims[point] = claim_of(self.request(point), text, self.library)
        return self.claims[point]

    def known(self, point: Point, since: int = 0) -> Finding | None:
        """The answer by the proof that there is none, or by a drive that was found before.

        ``since``: so many of the drives are known not to do.
        """
        claim = self.claim(point)
        if self.impossibility is not None:
            core = f"proved for all values; core: {' and '.join(self.impossibility.told)}"
            certificate = self.impossibility.as_data()["certificate"]
            return Finding(point, Verdict.IMPOSSIBLE, claim.text, core, certificate=certificate)
        shown = self.pool.show(claim, since)
        if shown is None:
            return None
        return Finding(point, Verdict.WITNESSED, claim.text, drive=shown.data, number=shown.number)

    def settle(self, points: Sequence[Point], stages: tuple[Stage, ...] = NATURAL_FIRST) -> list[Finding]:
        """The answers at ``points``, each by a search of its own."""
        tasks = [Task(self.request(point), stages) for point in points]
        self.searches += len(tasks)
        self.searched += points
        findings: list[Finding] = []
        for point, reply in zip(points, self.look_all(tasks), strict=True):
            self.pool.add(reply.drives)
            findings.append(self.known(point) or self._missed(point, reply))
        return findings

    def _missed(self, point: Point, reply: Reply) -> Finding:
        text = self.claim(point).text
        if reply.verdict is Verdict.NONE_WITHIN:
            return Finding(point, Verdict.NONE_WITHIN, text, reply.reason)
        reason = reply.reason or "the drive that was found is rejected by the judge"
        return Finding(point, Verdict.UNKNOWN, text, reason)

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

    def judge_missed(self, settled: dict[Point, Finding]) -> bool:
        """Judge all drives where none was found when it was looked for; whether that changes anything."""
        better = False
        for point, finding in settled.items():
            now = None if finding.found else self.known(point)
            if now is not None and now.found:
                settled[point] = now
                better = True
        return better

    def narrow(self, held: Finding, missed: Finding) -> Boundary | None:
        """The boundary between two neighbours on the grid: leaps by the judge, then halving by searches.

        None where a drive that is found on the way does at ``missed`` too.
        """
        [knob] = self.asked.knobs
        precision = self.asked.precision or (knob.high - knob.low) / 60
        grains = [self.asked.request.dt / k for k in (1, 2, 4)] if knob.name in self.lasting else []
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

    def leap(self, held: Finding, missed: Finding, precision: Fraction) -> Finding:
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
