"""Wishes for a typical drive: a table of formulas beside the one that the drive has to satisfy.

A search with the objective ``typical`` prefers drives that fulfil them. Each wish follows from the structure
of the formula and from the road. The exact judge decides which of them a drive fulfils.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cache
from math import ceil
from typing import TYPE_CHECKING, Final, TypeAlias, assert_never

from roadproof.engines.search.usual_road import zones_of
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.bind import bind, values_with, without_empty_windows
from roadproof.library.specification import Library, Query
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare, Formula, Interval
from roadproof.logic.rewrite import bounds_of, with_values, without_names
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import judge

if TYPE_CHECKING:
    from roadproof.engines.encode.unroll import Grid
    from roadproof.world.road import Attribute, Lanelet, Road

NEAR: Final = Fraction(1, 2)
"""How far from the centre of a lane its middle reaches (m)."""
AWAY: Final = Fraction(10)
"""How far from its edges the inside of a zone begins (m)."""
LEAST: Final = Fraction(1)
"""How long each state lasts at least that the formula requires for a time (s)."""

Extent: TypeAlias = tuple[Fraction | None, Fraction | None]


@dataclass(frozen=True)
class ClaimOnRoad:
    """A formula, with the road and the parameter values (SI) with which it is read.

    Times in s: ``end`` of the search; ``least``: how long states last; ``late``: shortly before the end.
    """

    formula: Formula
    vehicles: tuple[str, ...]
    road: Road
    values: Mapping[str, Fraction]
    end: Fraction
    least: Fraction
    late: Fraction


@dataclass(frozen=True)
class Wish:
    """A wish: its name, how a drive fulfils it, and its formula in a claim.

    The formula is ``TRUE`` where the wish says nothing about a claim.
    """

    name: str
    meaning: str
    formula: Callable[[ClaimOnRoad], Formula]


def wished_formulas(query: Query, road: Road, values: Mapping[str, Fraction], grid: Grid) -> list[Formula]:
    """Return the formulas of all wishes that say something, for a search on a grid."""
    end, dt = grid.horizon, grid.dt
    least = ceil(LEAST / dt) * dt
    before_last = min(ceil((end - LEAST) / dt) * dt, end - dt)  # the last sample stands for all later
    late = max(Fraction(0), before_last)
    claim = ClaimOnRoad(query.formula, query.vehicles, road, values, end, least, late)
    return [x for wish in WISHES if (x := wish.formula(claim)) != f.TRUE]


def fulfilled_wishes(query: Query, file: DriveFile, library: Library) -> dict[str, bool]:
    """Return for each wish that says something whether a drive fulfils it, by its name."""
    values, end = values_with(library, file.values), file.horizon
    late = max(Fraction(0), end - LEAST)
    claim = ClaimOnRoad(query.formula, query.vehicles, file.road, values, end, LEAST, late)
    formulas = {wish.name: wish.formula(claim) for wish in WISHES}
    return {
        name: judge(without_empty_windows(bind(formula, file.road, file.lanes, values)), file.drive).holds
        for name, formula in formulas.items()
        if formula != f.TRUE
    }


def _uses_ramp(claim: ClaimOnRoad) -> Formula:
    """Return that a vehicle leaves a merge lane, or enters a departure lane, of a zone in the formula."""
    leaves = [_changes(x, ramp, True) for ramp in _ramps(claim, "merge") for x in claim.vehicles]
    enters = [_changes(x, ramp, False) for ramp in _ramps(claim, "departure") for x in claim.vehicles]
    return f.disjunction(*leaves, *enters) if leaves or enters else f.TRUE


def _ramps(claim: ClaimOnRoad, attribute: Attribute) -> list[tuple[Lanelet, ...]]:
    """Return the lanelets of each lane with an attribute that has lanelets in a zone of the formula."""
    zones = zones_of(claim.formula)
    lanelets = (x for x in claim.road.lanelets if x.attribute == attribute and x.zone in zones)
    return [claim.road.lanelets_of(lane) for lane in dict.fromkeys(x.lane for x in lanelets)]


def _changes(vehicle: str, ramp: Iterable[Lanelet], leaves: bool) -> Formula:
    """Return that a vehicle begins in a lane and leaves it, or begins elsewhere and enters it."""
    inside = f.disjunction(*(f.Occupies(vehicle, x.id) for x in ramp))
    before, after = (inside, f.negation(inside)) if leaves else (f.negation(inside), inside)
    return f.conjunction(before, f.Eventually(f.FOREVER, after))


def _begins_in_order(claim: ClaimOnRoad) -> Formula:
    """Return that two vehicles begin in the order along the road that the formula requires later only."""
    orders = [*_orders(claim.formula, False)]
    now = {_pair(x) for x, later in orders if not later}
    return f.conjunction(*dict.fromkeys(x for x, later in orders if later and _pair(x) not in now))


def _orders(formula: Formula, later: bool) -> Iterator[tuple[Compare, bool]]:
    """Yield the required comparisons of two vehicles' places along the road; whether at a later time only."""
    match formula:
        case Compare():
            if len(_pair(formula)) == 2:
                yield formula, later
        case f.And(parts):
            for part in parts:
                yield from _orders(part, later)
        case f.Application(_, _, body) | f.Always(_, body):
            yield from _orders(body, later)
        case f.Eventually(_, body) | f.Until(_, _, body):
            yield from _orders(body, True)
        case f.Truth() | f.Occupies() | f.Some() | f.Every() | f.Not() | f.Or() | f.Since():
            return
        case _:
            assert_never(formula)


def _pair(comparison: Compare) -> frozenset[str]:
    """Return the vehicles whose places along the road are compared, and nothing else; empty if others are."""
    leaves = {x for side in (comparison.left, comparison.right) for x in t.leaves(side)}
    places = {x.vehicle for x in leaves if isinstance(x, t.Signal) and x.name == "s"}
    rest = {
        x
        for x in leaves
        if not (isinstance(x, t.Number | t.Size) or (isinstance(x, t.Signal) and x.name == "s"))
    }
    return frozenset() if rest else frozenset(places)


def _in_middles(claim: ClaimOnRoad) -> Formula:
    """Return that each vehicle begins in the middle of a lane and is in one from the end of the search on."""
    bands = dict.fromkeys(x.d for x in claim.road.lanelets)
    inside = f.conjunction(*(f.disjunction(*(_in_middle(x, band) for band in bands)) for x in claim.vehicles))
    return f.conjunction(inside, f.Always(Interval(_seconds(claim.end), None), inside))


def _in_middle(vehicle: str, band: tuple[Fraction, Fraction]) -> Formula:
    """Return that the centre of a vehicle is near that of a band between two places across the road."""
    left = t.Signal("d", vehicle)
    ends = t.Sum((left, t.subtract(left, t.Size("width", vehicle))))  # twice the centre
    twice = band[0] + band[1]
    return f.conjunction(
        Compare(ends, ">=", _metres(twice - 2 * NEAR)), Compare(ends, "<=", _metres(twice + 2 * NEAR))
    )


def _lasts(claim: ClaimOnRoad) -> Formula:
    """Return the formula with a longer time for each state that it requires for a shorter one."""
    plain = without_names(with_values(claim.formula, claim.values))

    @cache
    def longer(formula: Formula, positive: bool) -> Formula:
        """Return a formula that implies this one; one that follows from it where not ``positive``."""
        inner = positive != isinstance(formula, f.Not)
        changed = f.with_children(formula, tuple(longer(x, inner) for x in f.children(formula)))
        if positive and isinstance(changed, f.Always):
            low, high = bounds_of(changed.interval)
            if high is not None and low <= high < low + claim.least:
                return f.Always(Interval(changed.interval.low, _seconds(low + claim.least)), changed.body)
        return changed

    changed = longer(plain, True)
    return f.TRUE if changed == plain else changed


def _stays_inside(claim: ClaimOnRoad) -> Formula:
    """Return that all vehicles stay in zones of the formula, away from edges, until late in the search."""
    extents = [*_extents(claim.road, zones_of(claim.formula))]
    if not extents:
        return f.TRUE
    inside = f.conjunction(*(f.disjunction(*(_inside(x, y) for y in extents)) for x in claim.vehicles))
    return inside if inside == f.TRUE else f.Always(Interval(f.ZERO, _seconds(claim.late)), inside)


def _extents(road: Road, zones: Iterable[str]) -> Iterator[Extent]:
    """Yield for each zone the longest stretches along the road that its lanelets cover."""
    for zone in sorted(zones):
        current: Extent | None = None
        for low, high in sorted((x.s for x in road.lanelets_in(zone)), key=_from):
            if current is None or (current[1] is not None and low is not None and low > current[1]):
                if current is not None:
                    yield current
                current = low, high
            elif current[1] is not None and (high is None or high > current[1]):
                current = current[0], high
        if current is not None:
            yield current


def _from(extent: Extent) -> tuple[bool, Fraction]:
    return extent[0] is not None, extent[0] or Fraction(0)


def _inside(vehicle: str, extent: Extent) -> Formula:
    """Return that a vehicle is inside a stretch of the road, away from its ends."""
    low, high = extent
    front = t.Signal("s", vehicle)
    rear = t.subtract(front, t.Size("length", vehicle))
    return f.conjunction(
        f.TRUE if low is None else Compare(rear, ">=", _metres(low + AWAY)),
        f.TRUE if high is None else Compare(front, "<=", _metres(high - AWAY)),
    )


def _metres(value: Fraction) -> t.Number:
    return t.Number(value, (1, 0))


def _seconds(value: Fraction) -> t.Number:
    return t.Number(value, (0, 1))


WISHES: Final = (
    Wish("uses the ramp", "a vehicle leaves the merge lane, or enters the departure lane", _uses_ramp),
    Wish(
        "begins in order",
        "one vehicle is ahead of another from the start, if it has to be later",
        _begins_in_order,
    ),
    Wish("middle of lanes", "vehicles begin and end at most 0.5 m from the centre of a lane", _in_middles),
    Wish("lasts 1 s", "states that have to last, such as safety and danger, last at least 1 s", _lasts),
    Wish(
        "inside the zone",
        "vehicles are in the zone, 10 m from its edges, until 1 s before the end",
        _stays_inside,
    ),
)
"""The wishes, the most important first: where a search cannot fulfil all, it prefers the first ones."""
