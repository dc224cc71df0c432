"""The lanes in which vehicles of a test begin, and the markings that models depend on."""

from fractions import Fraction

from roadproof.runtime.records import dataclass
from roadproof.world.road import Road


@dataclass(frozen=True)
class Across:
    """The places of SV and the first POV across the road when the scenario begins (m, to the left).

    ``side`` is 1 where POV is to the left of SV, -1 where it is to the right. ``centre``: the middle of the
    lane of POV; ``marking``: the edge of SV's lane on the side of POV.
    """

    side: int
    centre: Fraction
    marking: Fraction


@dataclass(frozen=True)
class VehicleBox:
    """A vehicle at one instant: its front, its left side, and its size (m)."""

    s: Fraction
    d: Fraction
    length: Fraction
    width: Fraction

    @property
    def middle(self) -> Fraction:
        """The middle of the box across the road."""
        return self.d - self.width / 2


def across(road: Road, subject: VehicleBox, other: VehicleBox, comes_in: bool) -> Across:
    """Return where two vehicles are among the lanes of a road.

    Off the lanes POV is taken to begin in the middle of its lane, and the marking half-way between the boxes.
    Where it ``comes_in``, and is in the lane of SV already, its lane is the one that it comes from: beside
    that of SV, and as wide.
    """
    side = 1 if other.middle >= subject.middle else -1
    own, its = lane_at(road, subject), lane_at(road, other)
    if own is not None and its == own and comes_in:
        wide = own[1] - own[0]
        its = own[0] + side * wide, own[1] + side * wide
    centre = other.middle if its is None else (its[0] + its[1]) / 2
    if own is None:
        near = subject.d if side > 0 else subject.d - subject.width
        far = other.d - other.width if side > 0 else other.d
        marking = (near + far) / 2
    else:
        marking = own[1] if side > 0 else own[0]
    return Across(side, centre, marking)


def lane_at(road: Road, box: VehicleBox) -> tuple[Fraction, Fraction] | None:
    """Return the edges of the lane in which the middle of a box is, right and left; None off the lanes."""
    for lanelet in road.lanelets:
        (low, high), (right, left) = lanelet.s, lanelet.d
        is_along = (low is None or low <= box.s) and (high is None or box.s <= high)
        if is_along and right <= box.middle <= left:
            return right, left
    return None
