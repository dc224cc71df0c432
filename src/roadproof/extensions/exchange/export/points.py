"""The reference points of vehicles by format; ours is the front-left corner of the box.

On a straight road the plane has x = s along the road and y = d to the left. Where a road has a reference
line, a place (s, d) is d to the left of the line at s, and headings are from its direction there. Our boxes
are aligned with the road (semantics §2);
a box that is turned by ``heading`` is turned about its centre, which stays where it is.
"""

import math
from dataclasses import dataclass
from fractions import Fraction

from roadproof.world.drive import Motion
from roadproof.world.motion import State
from roadproof.world.reference_line import ReferenceLine

_STEP = 0.1
"""Metres over which the curvature of a line is measured."""
OVERHANG = Fraction(1, 5)
"""The rear axle is this share of the length ahead of the rear, the front axle as far behind the front."""


def centre(state: State, length: Fraction, width: Fraction) -> tuple[Fraction, Fraction]:
    """The centre of the box (m): CommonRoad, exiD."""
    return state.s - length / 2, state.d - width / 2


def upper_left(state: State, length: Fraction) -> tuple[Fraction, Fraction]:
    """The corner of the box with the least x and the least y, with y = -d that grows down (m): highD."""
    return state.s - length, -state.d


def rear_axle(state: State, motion: Motion, turned: float) -> tuple[float, float]:
    """The middle of the rear axle (m) of a box that is ``turned`` (rad) about its centre: OpenSCENARIO."""
    x, y = centre(state, motion.length, motion.width)
    ahead = float(axle_to_centre(motion.length))
    return float(x) - ahead * math.cos(turned), float(y) - ahead * math.sin(turned)


@dataclass(frozen=True)
class PlanePose:
    """A place in the plane (m) and the direction of the road there (rad).

    ``curvature`` of its line (1/m), and what that changes by in a metre (1/m²).
    """

    x: float
    y: float
    along: float
    curvature: float
    curvature_rate: float


def centre_in_plane(state: State, motion: Motion, line: ReferenceLine) -> PlanePose:
    """The centre of the box on a road with a reference line."""
    s, d = map(float, centre(state, motion.length, motion.width))
    pose, ahead = line.pose(s), line.pose(s + _STEP)
    x, y = line.place(s, d)
    curvature = math.remainder(ahead.heading - pose.heading, math.tau) / _STEP
    return PlanePose(x, y, pose.heading, curvature, line.curvature_rate(s))


def rear_axle_in_plane(
    state: State, motion: Motion, turned: float, line: ReferenceLine | None
) -> tuple[float, float, float]:
    """The middle of the rear axle (m) and the heading of the box (rad), ``turned`` from the road's."""
    if line is None:
        return (*rear_axle(state, motion, turned), turned)
    pose = centre_in_plane(state, motion, line)
    heading = pose.along + turned
    ahead = float(axle_to_centre(motion.length))
    return pose.x - ahead * math.cos(heading), pose.y - ahead * math.sin(heading), heading


def axle_to_centre(length: Fraction) -> Fraction:
    """Return how far (m) the centre of the box is ahead of the rear axle."""
    return length / 2 - OVERHANG * length


def heading(state: State) -> float | None:
    """The direction of motion, from the road to the left (rad); None at rest."""
    return math.atan2(state.v_lat, state.v_lon) if state.v_lon or state.v_lat else None
