"""Replays a drive exactly: first overlap of two boxes, first breach of a vehicle's limits.

Both questions are formulas for the exact judge.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare, Comparison, Formula, boxes_overlap, conjunction, implication
from roadproof.semantics.exact.algebraic import Point, decimal
from roadproof.semantics.exact.judging import LazyJudge, judge
from roadproof.semantics.exact.truth import Cut, TruthSet, complement
from roadproof.world.drive import Drive
from roadproof.world.units import unit_text

if TYPE_CHECKING:
    from roadproof.world.reference_line import ReferenceLine
    from roadproof.world.vehicle import Range, Vehicle


@dataclass(frozen=True)
class BoxOverlap:
    """Two boxes overlap with positive area from ``time`` on (not yet at it, where ``after``)."""

    first: str
    second: str
    time: Point
    after: bool

    def __str__(self) -> str:
        return f"the boxes of {self.first} and {self.second} overlap from {decimal(self.time)} s on"


@dataclass(frozen=True)
class Breach:
    """A vehicle breaks ``rule`` from ``time`` on (not yet at it, where ``after``)."""

    vehicle: str
    rule: str
    time: Point
    after: bool

    def __str__(self) -> str:
        return f"{self.vehicle} breaks {self.rule} from {decimal(self.time)} s on"


def first_overlap(drive: Drive, horizon: Fraction | None) -> BoxOverlap | None:
    """Return the first overlap of two boxes [s-length, s] × [d-width, d] within [0, horizon] (semantics §2).

    Touching is no overlap. ``horizon`` in s; None is for ever. Raises ``UsageError`` where negative.
    """
    judge, pairs = LazyJudge.on(drive), combinations(sorted(drive.vehicles), 2)
    overlap = _earliest((((a, b), judge.visit(boxes_overlap(a, b))) for a, b in pairs), horizon)
    return None if overlap is None else BoxOverlap(*overlap[1], *overlap[0])


def first_breach(
    drive: Drive, limits: Mapping[str, Vehicle], horizon: Fraction | None, line: ReferenceLine | None = None
) -> Breach | None:
    """Return the first instant within [0, horizon] at which a vehicle leaves its limits, or None.

    Checked are ranges of speeds and accelerations, no reversing, |v_lat| <= lateral_share·v_lon, and on the
    bends of ``line`` |v_lon²·κ + a_lat| <= a_bend. Raises ``UsageError`` for a vehicle without limits.
    """

    def broken() -> Iterator[tuple[tuple[str, str], TruthSet]]:
        """Yield each rule of each vehicle with the times at which it is broken."""
        for name in sorted(drive.vehicles):
            if name not in limits:
                raise UsageError(f"vehicle={name} has no limits to be checked against: name its model")
            bends = () if line is None else _bend_rules(name, limits[name], line)
            for rule, formula in (*_rules(name, limits[name]), *bends):
                yield (name, rule), complement(judge(formula, drive).truth(formula))

    breach = _earliest(broken(), horizon)
    return None if breach is None else Breach(*breach[1], *breach[0])


def _rules(name: str, limits: Vehicle) -> Iterator[tuple[str, Formula]]:
    """Every limit in words and as a formula."""
    zero = t.number(0, (1, -1))
    ranges: dict[t.SignalName, Range] = {"v_lon": limits.v_lon, "v_lat": limits.v_lat}
    ranges |= {"a_lon": limits.a_lon, "a_lat": limits.a_lat}
    for signal, (low, high) in ranges.items():
        unit = unit_text(t.SIGNAL_DIMENSIONS[signal]).replace("^2", "²")
        bounds: tuple[tuple[Comparison, Fraction], ...] = ((">=", low), ("<=", high))
        for op, limit in bounds:
            bound = t.Number(limit, t.SIGNAL_DIMENSIONS[signal])
            yield f"{signal} {op} {limit} {unit}", Compare(t.Signal(signal, name), op, bound)
    yield "v_lon >= 0 m/s (no reversing)", Compare(t.Signal("v_lon", name), ">=", zero)
    share: t.Term = t.Product((t.number(limits.lateral_share), t.Signal("v_lon", name)))
    lateral = t.Signal("v_lat", name)
    inside = conjunction(Compare(lateral, "<=", share), Compare(t.subtract(zero, share), "<=", lateral))
    yield f"|v_lat| <= {limits.lateral_share}·v_lon (heading)", inside


def _bend_rules(name: str, limits: Vehicle, line: ReferenceLine) -> Iterator[tuple[str, Formula]]:
    """Yield for each bend the rule |v_lon²·κ + a_lat| <= a_bend while the front of the vehicle is on it.

    Where only bounds of κ are known, it holds for both.
    """
    place, speed = t.Signal("s", name), t.Signal("v_lon", name)
    zero, most = t.number(0, (1, -2)), t.number(limits.a_bend, (1, -2))
    for bend in (x for x in line.bends() if x.greatest):
        there = conjunction(
            Compare(place, ">=", t.number(bend.begin, (1, 0))),
            Compare(place, "<=", t.number(bend.end, (1, 0))),
        )
        for begin, end in dict.fromkeys((bend.low, bend.high)):
            growth = (end - begin) / (bend.end - bend.begin)
            curvature = t.Sum(
                (
                    t.number(begin - growth * bend.begin, (-1, 0)),
                    t.Product((t.number(growth, (-2, 0)), place)),
                )
            )
            across = t.Sum((t.Product((speed, speed, curvature)), t.Signal("a_lat", name)))
            bounded = conjunction(Compare(across, "<=", most), Compare(t.subtract(zero, most), "<=", across))
            stretch = f"from s={float(bend.begin):g} m to {float(bend.end):g} m"
            rule = f"|v_lon²·κ + a_lat| <= {limits.a_bend} m/s² {stretch}"
            yield rule, implication(there, bounded)


def _earliest(
    named: Iterable[tuple[tuple[str, str], TruthSet]], horizon: Fraction | None
) -> tuple[Cut, tuple[str, str]] | None:
    """Return the first begin of a set by ``horizon``, and the name of that set."""
    begins = ((_first(truth, horizon), who) for who, truth in named)
    return min(((begin, who) for begin, who in begins if begin is not None), default=None)


def _first(truth: TruthSet, horizon: Fraction | None) -> Cut | None:
    """Return the begin of ``truth``, if it is not after ``horizon``."""
    if horizon is not None and horizon < 0:
        raise UsageError(f"horizon={horizon}: a drive starts at 0; ask for a horizon that is not negative")
    begin = truth.cuts[0] if truth.cuts else None
    if begin is None or (horizon is not None and begin > Cut(horizon, False)):
        return None
    return begin
