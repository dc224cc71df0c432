"""Distances between objects as OpenSCENARIO's conditions measure them (ASAM OpenSCENARIO XML 1.3, 6.4.4).

In the coordinates of the road or the lane, a distance is a difference of s or d. In those of the entity, and
for Euclidean distances, it is measured in the plane, along the axes of the triggering vehicle. Boxes that are
turned against each other count with their extents along these axes.
"""

import math

from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.exchange.storyboard.positions import ObjectState, Positions
from roadproof.extensions.maps.xml_reader import Element
from roadproof.runtime.records import dataclass

_EUCLIDEAN = ("euclidianDistance", "cartesianDistance", "euclideanDistance")
_AXES = ("longitudinal", "lateral")
_SYSTEMS = ("entity", "lane", "road")
_POINT = ObjectBox("", "", 0.0, 0.0, (0.0, 0.0))


@dataclass(frozen=True)
class Measure:
    """The distance that a condition means: ``kind``, ``system`` of coordinates, and ``free`` space or not."""

    kind: str
    system: str
    free: bool


def measure_of(document: Document, node: Element) -> Measure:
    """The distance that a condition names; Euclidean by default, along the road for ``alongRoute``."""
    kind, system = node.get("relativeDistanceType"), node.get("coordinateSystem")
    along = document.flag(node, "alongRoute")
    if not kind:
        kind, system = ("longitudinal", system or "road") if along else ("euclidianDistance", system)
    if kind not in (*_AXES, *_EUCLIDEAN):
        problem = f"relativeDistanceType={kind}: one of {', '.join((*_AXES, _EUCLIDEAN[0]))} is needed"
        raise document.error(node, problem)
    system = system or "entity"
    if system not in _SYSTEMS:
        raise document.error(node, f"coordinateSystem={system}: one of {', '.join(_SYSTEMS)} is supported")
    return Measure(kind, system, document.flag(node, "freespace"))


def distance_between(
    positions: Positions,
    measure: Measure,
    one: tuple[ObjectBox, ObjectState],
    other: tuple[ObjectBox | None, ObjectState],
) -> float:
    """Return how far (m) an object, or a place, is from another one; at least 0."""
    (box, state), (far, there) = one, (other[0] or _POINT, other[1])
    if measure.kind in _AXES and measure.system != "entity":
        along, across = gaps_on_road((box, state), (far, there), measure.free)
    else:
        along, across = _gaps_in_plane(positions, (box, state), (far, there), measure.free)
    if measure.kind in _AXES:
        return max(along if measure.kind == "longitudinal" else across, 0.0)
    return math.hypot(max(along, 0.0), max(across, 0.0))


def gaps_on_road(
    one: tuple[ObjectBox, ObjectState], other: tuple[ObjectBox, ObjectState], free: bool
) -> tuple[float, float]:
    """Distances along and across the road; between boxes if ``free``, negative where they overlap."""
    (box, state), (far, there) = one, other
    apart = [there.s - state.s, there.d - state.d]
    if not free:
        return abs(apart[0]), abs(apart[1])
    ways = 1 if state.forward else -1, 1 if there.forward else -1
    s, d = (abs(x + ways[1] * b - ways[0] * a) for x, a, b in zip(apart, box.centre, far.centre, strict=True))
    return s - (box.length + far.length) / 2, d - (box.width + far.width) / 2


def _gaps_in_plane(
    positions: Positions, one: tuple[ObjectBox, ObjectState], other: tuple[ObjectBox, ObjectState], free: bool
) -> tuple[float, float]:
    """Distances along and across the first object; between boxes if ``free``."""
    (box, state), (far, there) = one, other
    x, y, heading = positions.pose_of(state)
    far_x, far_y, far_heading = positions.pose_of(there)
    ahead, left = _rotate((far_x - x, far_y - y), -heading)
    if not free:
        return abs(ahead), abs(left)
    turn = far_heading - heading
    centre = _rotate(far.centre, turn)
    c, s = abs(math.cos(turn)), abs(math.sin(turn))
    length, width = far.length * c + far.width * s, far.length * s + far.width * c
    along = abs(ahead + centre[0] - box.centre[0]) - (box.length + length) / 2
    return along, abs(left + centre[1] - box.centre[1]) - (box.width + width) / 2


def _rotate(point: tuple[float, float], angle: float) -> tuple[float, float]:
    (x, y), c, s = point, math.cos(angle), math.sin(angle)
    return x * c - y * s, x * s + y * c
