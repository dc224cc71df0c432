"""What is asked of an exploration, and what is answered: values."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from typing import Literal, TypeAlias

from roadproof.engines.search.outcome import Search
from roadproof.errors import UsageError
from roadproof.evidence.settled import Settled
from roadproof.library.compose import always, both, comparison, eventually
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.specification import Query, Specification
from roadproof.logic import syntax
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import declared
from roadproof.logic.syntax import BinaryOperator, Binding, Expression
from roadproof.logic.terms import Dimension, Inverse, Term, Varying, leaves
from roadproof.verdict import DriveVerdict, Verdict
from roadproof.world.units import UNITS


def with_parts(query: Query, parts: Sequence[Query]) -> Query:
    """``query`` and all of ``parts``; as it was written where there are none."""
    return both(query, *parts) if parts else query


def compared(
    search: Search, left: Expression, op: BinaryOperator, value: Fraction, dimension: Dimension
) -> Query:
    """``left op value`` in the names that the search has, where ``value`` is in SI units of ``dimension``."""
    return comparison(search.specification, search.query.claim.given, left, op, value, dimension)


Sense: TypeAlias = Literal["least", "greatest"]


@dataclass(frozen=True)
class Measure:
    """The ``sense`` value of ``term``, at time 0 or at some ``moment`` at which that holds.

    ``text`` and ``when`` are how a user wrote term and moment; ``said`` is the term as a tree.
    """

    sense: Sense
    text: str
    said: Expression
    term: Term
    dimension: Dimension
    when: str = ""
    moment: Query | None = None

    @property
    def sign(self) -> int:
        """What turns a better value into a smaller one."""
        return 1 if self.sense == "least" else -1

    def bound(self, search: Search, value: Fraction | None) -> list[Query]:
        """That the measure is ``value`` or better (None: that there is a moment for it), as parts."""
        op: Literal["<=", ">="] = "<=" if self.sense == "least" else ">="
        here = [] if value is None else [compared(search, self.said, op, value, self.dimension)]
        return here if self.moment is None else [eventually(both(self.moment, *here))]


def read_measure(
    specification: Specification, sense: Sense, text: str, when: str = "", given: tuple[Binding, ...] = ()
) -> Measure:
    """A measure from what the user wrote, in the names that a formula has in its ``given``.

    Raises ``TextError``, and ``UsageError`` for what no drive changes.
    """
    head = declared(given)
    term, dimension = read_term(specification, head + text, f"--{sense}")
    if isinstance(term, Inverse):
        raise UsageError(f"--{sense} '{text}': 1/x may be infinite; ask for the other extreme of x")
    if not any(isinstance(leaf, Varying) for leaf in leaves(term)):
        raise UsageError(f"--{sense} '{text}': no drive changes this; name a signal, such as v_lon(SV)")
    moment = read_claim(specification, head + when, "--when") if when else None
    return Measure(sense, text, parse_claim(head + text).body, term, dimension, when, moment)


# A value for each knob, in order, in SI units.
Point: TypeAlias = tuple[Fraction, ...]


@dataclass(frozen=True)
class Variable:
    """A parameter, or the ``limit`` (such as ``a_lon.min``) of ``vehicles``, from ``low`` to ``high``.

    ``name`` is how the user names it; values are in SI units and printed in ``unit``.
    """

    name: str
    unit: str
    low: Fraction
    high: Fraction
    vehicles: tuple[str, ...] = ()
    limit: str = ""

    def values(self, steps: int) -> tuple[Fraction, ...]:
        """``steps`` (2 or more) values, evenly spaced, both ends included."""
        return tuple(self.low + (self.high - self.low) * k / (steps - 1) for k in range(steps))


def with_point(search: Search, knobs: Sequence[Variable], point: Point) -> Search:
    """``search`` with every knob at its value."""
    values = dict(search.setting.values)
    limits = {vehicle: dict(ends) for vehicle, ends in search.setting.limits.items()}
    for knob, value in zip(knobs, point, strict=True):
        if not knob.limit:
            values[knob.name] = value
        for vehicle in knob.vehicles:
            limits.setdefault(vehicle, {})[knob.limit] = value
    return replace(search, setting=replace(search.setting, values=values, limits=limits))


def stated(search: Search, knobs: Sequence[Variable], point: Point) -> list[Query]:
    """The limits at a point as formulas, so that a drive file says them and whoever judges it checks them."""
    parts: list[Query] = []
    for knob, value in zip(knobs, point, strict=True):
        signal, _, end = knob.limit.partition(".")
        for vehicle in knob.vehicles:
            left = syntax.Call(signal, (syntax.Name(vehicle),))
            op: Literal[">=", "<="] = ">=" if end == "min" else "<="
            parts.append(always(compared(search, left, op, value, UNITS[knob.unit][1])))
    return parts


def between(one: Fraction, other: Fraction, grains: Sequence[Fraction] = ()) -> Fraction:
    """A plain number strictly between two: a multiple of the first grain that has one, near the middle.

    Else the decimal with the fewest digits in the middle half.

    >>> str(between(Fraction(0), Fraction(3), [Fraction(3, 5)])), str(between(Fraction(1, 3), Fraction(1)))
    ('6/5', '7/10')
    """
    low, high = sorted((one, other))
    middle, quarter = (low + high) / 2, (high - low) / 4
    for grain in grains:
        multiple = round(middle / grain) * grain
        if low < multiple < high:
            return multiple
    for digits in range(-9, 12):
        unit = Fraction(10) ** -digits
        rounded = round(middle / unit) * unit
        if low + quarter <= rounded <= high - quarter:
            return rounded
    return middle


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
class PointFinding(Settled[DriveVerdict]):
    """The answer at one point. ``query`` is what the drive satisfies, or what has no drive.

    ``number`` tells drives apart; ``certificate`` proves that there is none: for all values, or for those
    that it assumes.
    """

    at: Point
    query: Query
    number: int | None = None

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
