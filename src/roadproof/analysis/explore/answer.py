"""What is asked of an exploration, and what is answered: values."""

from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from roadproof.analysis.explore.knobs import Point, Variable, stated
from roadproof.analysis.explore.measure import Measure, with_parts
from roadproof.engines.search.ask import Search
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.specification import Query
from roadproof.verdict import DriveVerdict, Verdict


def say_nothing(text: str) -> None:
    """Nobody listens."""


@dataclass(frozen=True)
class Explorable:
    """For which values of ``knobs`` the query of ``search`` has a drive, and how far ``measures`` can go.

    ``steps``: values of each knob; ``precision``: how far boundaries are narrowed, in SI units of the
    knob (None: a sixtieth of its range), or brackets of measures where there is no knob.
    """

    search: Search
    knobs: tuple[Variable, ...]
    steps: int
    precision: Fraction | None = None
    measures: tuple[Measure, ...] = ()

    @property
    def points(self) -> list[Point]:
        """The grid: the product of the values of the knobs; no point where there are none."""
        return list(product(*(knob.values(self.steps) for knob in self.knobs))) if self.knobs else []

    def query(self, point: Point) -> Query:
        """What a drive has to satisfy at a point, limits stated."""
        return with_parts(self.search.query, stated(self.search, self.knobs, point))


@dataclass(frozen=True)
class PointFinding:
    """The answer at one point. ``query`` is what the drive satisfies, or what has no drive.

    ``number`` tells drives apart; ``certificate`` proves that there is none: for all values, or for those
    that it assumes.
    """

    at: Point
    verdict: DriveVerdict
    query: Query
    reason: str = ""
    drive: JudgedDrive | None = None
    number: int | None = None
    certificate: Certificate | None = None

    @property
    def found(self) -> bool:
        return self.verdict is Verdict.WITNESSED

    @property
    def assuming(self) -> tuple[str, ...]:
        """The values of parameters with which it is proved that there is none; empty where for all."""
        return () if self.certificate is None else self.certificate.assumed.said


@dataclass(frozen=True)
class Boundary:
    """A value with a drive and the nearest value looked at, on one side, for which none was found.

    ``surely``: the nearest value on that side for which it is said that there is none, if any is.
    """

    held: PointFinding
    missed: PointFinding
    surely: PointFinding | None


@dataclass(frozen=True)
class Extreme:
    """How far ``measure`` can go with the knobs at ``point``.

    ``best``: a judged drive that reaches ``best.at``; ``missed``: the nearest value it was not found for.
    ``surely``: the nearest value for which it is said that there is none, if any. ``endless``: the drive
    passes any value that is asked for. Where there is no drive at all, ``best`` is None. ``late``: cut off
    by the clock, or lost.
    """

    measure: Measure
    point: Point
    best: PointFinding | None
    missed: PointFinding | None
    surely: PointFinding | None
    searches: int
    endless: bool = False
    late: bool = False


@dataclass(frozen=True)
class ExplorationResult:
    """``findings`` on the grid, in the order of ``Explorable.points``; boundaries where there is one knob.

    ``seconds`` that it took; ``late``: something in it was cut off by the clock, or lost.
    """

    findings: tuple[PointFinding, ...] = ()
    boundaries: tuple[Boundary, ...] = ()
    extremes: tuple[Extreme, ...] = ()
    searches: int = 0
    drives: int = 0
    seconds: float = 0.0
    late: bool = False

    @property
    def held(self) -> list[Point]:
        """The points of the grid that have a drive."""
        return [finding.at for finding in self.findings if finding.found]

    @property
    def verdicts(self) -> list[Verdict]:
        """The verdicts that decide whether all is: of all values, and of both sides of every bracket."""
        found: list[PointFinding | None] = [*self.findings]
        found += [x for boundary in self.boundaries for x in (boundary.held, boundary.missed)]
        found += [x for extreme in self.extremes for x in (extreme.best, extreme.missed)]
        return [x.verdict for x in found if x is not None]
