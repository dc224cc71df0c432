"""What a road allows of the truth of lanelet predicates: which model is that of some road.

Of anything but plain predicates, ``a is on a lanelet of D``, nothing is seen, and no answer is yes.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TypeAlias

from roadproof.evidence import state
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import terms_of
from roadproof.prove.states import TYPICAL_SIZE

# rear, front, right and left
Box: TypeAlias = tuple[Fraction, Fraction, Fraction, Fraction]
ZONES = tuple(f.Domain("zone", name) for name in ("main", "merge", "depart"))


def is_on_some_road(truths: Mapping[Formula, bool], lanes: Sequence[str] | None) -> bool:
    """Whether it is seen that a road allows these truth values of road predicates at one instant.

    ``a is on a lanelet of D`` can be had for each vehicle and each D alone, but for this: each
    lanelet is of one of three zones, and of a lane. Of anything more involved it is not seen.
    """
    road = [part for part in truths if isinstance(part, f.Occupies | f.Some | f.Every)]
    if all(isinstance(part, f.Occupies) for part in road):
        return True
    on: dict[tuple[str, f.Domain], bool] = {}
    for part in road:
        match part:
            case f.Some(variable, domain, f.Occupies(vehicle, lanelet)) if variable == lanelet:
                if on.setdefault((vehicle, domain), truths[part]) != truths[part]:
                    return False
            case _:
                return False
    for vehicle in {vehicle for vehicle, _ in on}:
        zones = [on[vehicle, zone] for zone in ZONES if (vehicle, zone) in on]
        in_lane = any(
            true for (who, domain), true in on.items() if who == vehicle and domain.kind == "lanelets"
        )
        if in_lane and len(zones) == len(ZONES) and not any(zones):
            return False
        lanelets = [] if lanes is None else [(vehicle, f.Domain("lanelets", lane)) for lane in lanes]
        in_no_lane = lanes is not None and not any(on.get(where, True) for where in lanelets)
        if any(zones) and in_no_lane:
            return False
    return True


def is_same_where_it_stands(
    truths: Sequence[Mapping[Formula, bool]], boxes: Sequence[Mapping[str, Box]]
) -> bool:
    """Whether a box that is on a lanelet of some domain is so at each instant, for each vehicle around it."""
    on = [
        (domain, truth[part], box[vehicle])
        for truth, box in zip(truths, boxes, strict=True)
        for part in truth
        for domain, vehicle in whose(part)
        if vehicle in box
    ]
    inside = [(domain, box) for domain, true, box in on if true]
    outside = [(domain, box) for domain, true, box in on if not true]
    return not any(a == b and contains(outer, inner) for a, inner in inside for b, outer in outside)


def boxes_of(
    parts: Iterable[Formula], found: Mapping[str, Fraction | bool], fixed: Mapping[str, Fraction]
) -> dict[str, Box]:
    """Where each vehicle stands whose s and d are both compared; others may stand anywhere."""
    compared = {leaf for part in parts for side in terms_of(part) for leaf in t.leaves(side)}
    boxes: dict[str, Box] = {}
    for vehicle in {leaf.vehicle for leaf in compared if isinstance(leaf, t.Signal)}:
        front, left = t.Signal("s", vehicle), t.Signal("d", vehicle)
        if front in compared and left in compared:
            s, d = (Fraction(found.get(state.symbol(leaf), 0)) for leaf in (front, left))
            length, width = (
                fixed.get(state.symbol(t.Size(name, vehicle)), typical)
                for name, typical in TYPICAL_SIZE.items()
            )
            boxes[vehicle] = (s - length, s, d - width, d)
    return boxes


def whose(part: Formula) -> Iterator[tuple[f.Domain | str, str]]:
    """The domain and the vehicle that a plain road predicate speaks of."""
    match part:
        case f.Some(_, domain, f.Occupies(vehicle, _)):
            yield domain, vehicle
        case f.Occupies(vehicle, lanelet):
            yield lanelet, vehicle
        case _:
            pass


def contains(outer: Box, inner: Box) -> bool:
    """Whether ``inner`` lies within ``outer``."""
    return outer[0] <= inner[0] and inner[1] <= outer[1] and outer[2] <= inner[2] and inner[3] <= outer[3]
