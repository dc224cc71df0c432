"""Columns of published recordings that are not read, since the columns that are read imply them.

Other columns that are not read are named (``unread.columns_not_read_note``).
"""

from collections.abc import Mapping

_ABOUT = "when, where and how long was recorded"
_COUNTS = "counts of vehicles, which are counted here"
_RULES = "speed limits, which no formula sees"
_OTHERS = "who is ahead, behind or beside, and how far: places of all vehicles are read"
_LANES = "the lane or lanelet by another map; lanes are those of the road that is read"
_EXTREMES = "extremes, sums and durations of samples, which are read"
_TURNED = "motion along and across the vehicle; that in the plane is read"
_ORIGIN = "how places were found in pictures and on the earth"


def _by_rule(**rules: str) -> dict[str, str]:
    """The rule of each column, from columns by rule."""
    rules_by_name = {
        "about": _ABOUT,
        "counts": _COUNTS,
        "limits": _RULES,
        "others": _OTHERS,
        "lanes": _LANES,
        "extremes": _EXTREMES,
        "turned": _TURNED,
        "origin": _ORIGIN,
    }
    return {name: rules_by_name[rule] for rule, names in rules.items() for name in names.split()}


HIGHD: Mapping[str, str] = _by_rule(
    about="locationId month weekDay startTime duration",
    limits="speedLimit",
    counts="totalDrivenDistance totalDrivenTime",
    extremes="traveledDistance minXVelocity maxXVelocity meanXVelocity minDHW minTHW minTTC numLaneChanges",
    others="dhw thw ttc precedingXVelocity precedingId followingId leftPrecedingId leftAlongsideId "
    "leftFollowingId rightPrecedingId rightAlongsideId rightFollowingId",
)
"""In highD; frontSightDistance and backSightDistance are compared with places."""

LEVELX: Mapping[str, str] = _by_rule(
    about="weekday weekDay month year startTime duration",
    limits="speedLimit",
    counts="numTracks numVehicles numVRUs numCars numTrucks totalDrivenDistance totalDrivenTime",
    origin="latLocation lonLocation orthoPxToMeter",
    extremes="trackLifetime traveledDistance",
    turned="lonAcceleration latAcceleration",
    lanes="odrRoadId odrSectionNo odrLaneId laneletId laneChange lonLaneletPos latLaneCenterOffset "
    "laneletLength laneWidth",
    others="leadDHW leadDV leadTHW leadTTC leadId rearId leftLeadId leftRearId leftAlongsideId rightLeadId "
    "rightRearId rightAlongsideId",
)
"""In exiD, inD, rounD and uniD; laneletId of exiD is compared with the map."""

NGSIM: Mapping[str, str] = _by_rule(
    counts="Total_Frames",
    origin="Global_X Global_Y",
    others="Preceding Following Space_Headway Time_Headway",
    lanes="O_Zone D_Zone Int_ID Section_ID Direction Movement",
)
"""In NGSIM, in upper or lower case; data of crossings are of streets, which are left out."""
