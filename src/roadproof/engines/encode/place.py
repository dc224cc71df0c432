"""Constraints on places: on the road, clear of each other and, for natural drives, in a lane."""

from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise

from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.problem import (
    Circuit,
    ColumnInequality,
    Inequality,
    Leaf,
    LimitKind,
    Origin,
    all_of,
    any_of,
)
from roadproof.world.polynomial import Polynomial, affine, constant
from roadproof.world.road import Lanelet, Road
from roadproof.world.signals import SignalName, SizeName
from roadproof.world.vehicle import Range, Vehicle

# [from, to] along and [right, left] across; None is without bound.
Rectangle = tuple[tuple[Fraction | None, Fraction | None], Range]


def road_edges(road: Road) -> Range:
    """Return the right and left edge of the whole road (m across)."""
    return min(x.d[0] for x in road.lanelets), max(x.d[1] for x in road.lanelets)


def rectangles(lanelets: Iterable[Lanelet]) -> tuple[Rectangle, ...]:
    """Return the maximal rectangles that a set of lanelets covers."""
    tiles = tuple(lanelets)
    cuts = sorted({c for x in tiles for c in x.s if c is not None})
    ends: list[Fraction | None] = [None, *cuts, None]
    columns = [_covered(tiles, low, high) for low, high in pairwise(ends)]
    candidates: list[Rectangle] = []
    for first in range(len(columns)):
        shared = columns[first]
        for last in range(first, len(columns)):
            shared = _overlaps(shared, columns[last])
            candidates += [((ends[first], ends[last + 1]), d) for d in shared]
    return tuple(r for r in candidates if not any(r != o and _inside(r, o) for o in candidates))


def _covered(lanelets: Iterable[Lanelet], low: Fraction | None, high: Fraction | None) -> list[Range]:
    here = sorted(
        x.d
        for x in lanelets
        if (x.s[0] is None or (low is not None and x.s[0] <= low))
        and (x.s[1] is None or (high is not None and x.s[1] >= high))
    )
    merged: list[Range] = []
    for right, left in here:
        if merged and right <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(left, merged[-1][1]))
        else:
            merged.append((right, left))
    return merged


def _overlaps(some: list[Range], others: list[Range]) -> list[Range]:
    both = [(max(a[0], b[0]), min(a[1], b[1])) for a in some for b in others]
    return [(right, left) for right, left in both if right < left]


def _inside(small: Rectangle, large: Rectangle) -> bool:
    (from_, to), (right, left) = small
    (large_from, large_to), (large_right, large_left) = large
    return (
        (large_from is None or (from_ is not None and from_ >= large_from))
        and (large_to is None or (to is not None and to <= large_to))
        and large_right <= right
        and left <= large_left
    )


def stay_on_road(
    layout: ColumnLayout,
    road: Road,
    name: str,
    vehicle: Vehicle,
    between: bool,
    last_sample_persists: bool = True,
) -> Circuit[ColumnInequality]:
    """Return the constraint that the box lies inside one rectangle of the road at each sample.

    Where ``between``, it is the same rectangle at both ends of a step, and so all the way. Where
    ``last_sample_persists``, the last one has no end along the road, unless the whole road ends.
    """
    allowed = rectangles(road.lanelets)
    endless = tuple(r for r in allowed if r[0][1] is None)
    last = layout.grid.steps
    spells: list[tuple[tuple[int, ...], tuple[Rectangle, ...]]]
    spells = [(spell, allowed) for spell in _step_groups(last, between)]
    if last_sample_persists and endless:
        spells.append(((last,), endless))
    return all_of(
        any_of(
            all_of(_box_inside(layout, name, vehicle, r, e, LimitKind.ROAD) for e in spell) for r in places
        )
        for spell, places in spells
    )


def _box_inside(
    layout: ColumnLayout, name: str, vehicle: Vehicle, place: Rectangle, step: int, limit: LimitKind
) -> Circuit[ColumnInequality]:
    (from_, to), (right, left) = place
    s, d = layout.state(name, "s", step), layout.state(name, "d", step)
    origin = Origin(limit, step, (name,))
    parts = [_at_least(d, right + vehicle.width, origin), _at_least(d.scaled(Fraction(-1)), -left, origin)]
    if from_ is not None:
        parts.append(_at_least(s, from_ + vehicle.length, origin))
    if to is not None:
        parts.append(_at_least(s.scaled(Fraction(-1)), -to, origin))
    return all_of(parts)


def _at_least(value: Polynomial[int], bound: Fraction, origin: Origin) -> Circuit[ColumnInequality]:
    return Leaf(Inequality(value + constant(-bound), False, origin=origin))


def stay_apart(
    layout: ColumnLayout,
    first: tuple[str, Vehicle],
    second: tuple[str, Vehicle],
    gaps: tuple[Fraction, Fraction],
    between: bool,
) -> Circuit[ColumnInequality]:
    """Return the constraint that one of four sides separates two boxes at each sample.

    ``between``: the same side at both ends of a step. ``gaps``: clearance along and across (m).
    """
    ends: tuple[tuple[SignalName, SizeName, Fraction], ...]
    ends = (("s", "length", gaps[0]), ("d", "width", gaps[1]))
    conditions = []
    for step in _step_groups(layout.grid.steps, between):
        sides = []
        for signal, size, gap in ends:
            for (low, _), (high, body) in ((first, second), (second, first)):
                extent: Fraction = getattr(body, size)
                sides.append(all_of(_beyond(layout, signal, low, high, extent, gap, e) for e in step))
        conditions.append(any_of(sides))
    return all_of(conditions)


def _beyond(
    layout: ColumnLayout, signal: SignalName, low: str, high: str, extent: Fraction, gap: Fraction, step: int
) -> Circuit[ColumnInequality]:
    """``high`` less its own extent is not below ``low``."""
    ends = [
        (layout.column(high, signal, step), Fraction(1)),
        (layout.column(low, signal, step), Fraction(-1)),
    ]
    vehicles = (low, high) if layout.vehicles.index(low) < layout.vehicles.index(high) else (high, low)
    return Leaf(Inequality(affine(ends, -extent), False, gap, Origin(LimitKind.CLEARANCE, step, vehicles)))


def _step_groups(steps: int, between: bool) -> list[tuple[int, ...]]:
    """Return groups of samples that share a rectangle or side: both ends of a step, or single samples."""
    return [(k, k + 1) for k in range(steps)] if between else [(k,) for k in range(steps + 1)]


def be_in_lane(
    layout: ColumnLayout, road: Road, name: str, vehicle: Vehicle, step: int, off_centre: Fraction
) -> Circuit[ColumnInequality]:
    """Return the constraint that the box is in one lane at a sample, at most ``off_centre`` m off."""
    choices = []
    for lane in road.lanes:
        for along, (right, left) in rectangles(road.lanelets_of(lane)):
            slack = min(off_centre, (left - right - vehicle.width) / 2)
            if slack < 0:
                continue
            middle = (right + left + vehicle.width) / 2
            band = (middle - slack - vehicle.width, middle + slack)
            choices.append(_box_inside(layout, name, vehicle, (along, band), step, LimitKind.LANE))
    return any_of(choices)


def move_one_way(layout: ColumnLayout, name: str) -> Circuit[ColumnInequality]:
    """Return the constraint that a vehicle never moves to the left, or never to the right."""
    directions = []
    for sign in (Fraction(1), Fraction(-1)):
        speeds = [
            Inequality(
                layout.state(name, "v_lat", k).scaled(sign),
                False,
                origin=Origin(LimitKind.ONE_WAY, k, (name,)),
            )
            for k in range(layout.grid.steps + 1)
        ]
        directions.append(all_of(map(Leaf, speeds)))
    return any_of(directions)
