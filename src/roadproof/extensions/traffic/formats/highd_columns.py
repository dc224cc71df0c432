"""The columns of the files of highD, its driving directions, and its lanes."""

from itertools import pairwise

from roadproof.extensions.traffic.formats.recording import Lane
from roadproof.extensions.traffic.formats.table import names_in

RECORDING_COLUMNS = names_in(
    "id frameRate locationId speedLimit month weekDay startTime duration totalDrivenDistance totalDrivenTime",
    "numVehicles numCars numTrucks upperLaneMarkings lowerLaneMarkings",
)


VEHICLE_COLUMNS = names_in(
    "id width height initialFrame finalFrame numFrames class drivingDirection traveledDistance",
    "minXVelocity maxXVelocity meanXVelocity minDHW minTHW minTTC numLaneChanges",
)


SAMPLE_COLUMNS = names_in(
    "frame id x y width height xVelocity yVelocity xAcceleration yAcceleration frontSightDistance",
    "backSightDistance dhw thw ttc precedingXVelocity precedingId followingId leftPrecedingId",
    "leftAlongsideId leftFollowingId rightPrecedingId rightAlongsideId rightFollowingId laneId",
)


UPPER, LOWER = 1, 2
"""Driving directions: on the upper lanes towards -x, on the lower ones towards +x."""


def lanes_of_markings(upper: tuple[float, ...], lower: tuple[float, ...]) -> tuple[Lane, ...]:
    """Lanes from the y values of the markings; a lane's name is its laneId (semantics §7)."""
    bands = [Lane(str(k), UPPER, (y, z)) for k, (y, z) in enumerate(pairwise(upper), start=2)]
    first = len(upper) + 2
    bands += [Lane(str(k), LOWER, (-z, -y)) for k, (y, z) in enumerate(pairwise(lower), start=first)]
    return tuple(bands)
