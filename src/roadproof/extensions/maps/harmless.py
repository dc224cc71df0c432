"""Parts of maps and CommonRoad files that are not read, since they change neither lanes nor motion.

Everything else that is not read is named (``left_out``).
"""

from collections.abc import Mapping

_DESCRIPTION = "description for people"
_EARTH = "where the map is on the earth; places are those of the file"
_FORMER = "the history of the file"
_HEIGHT = "heights, slopes and banks: roads are read in plan"
_LOOKS = "looks, which no formula sees"
_MARKS = "markings; lanes lie side by side whatever line parts them"
_RULES = "speed limits, signs, lights and rules of priority, which no formula sees"
_BESIDE = "objects beside or over the road, which are no traffic"
_OTHERS = "elements that place no lane"
_PLAN = "the task of a planner, which moves no vehicle"
_DYNAMICS = "inner states of a vehicle; its place, heading, speed and acceleration are read"
_TRAFFIC = "traffic, which a map leaves out"

OPENDRIVE: Mapping[str, str] = {
    "header": _DESCRIPTION,
    "@name": _DESCRIPTION,
    "userData": "data that each tool defines for itself, but for the zones of lanes, which are read",
    "dataQuality": _DESCRIPTION,
    "type": _RULES,
    "elevationProfile": _HEIGHT,
    "lateralProfile": _HEIGHT,
    "crossSectionSurface": _HEIGHT,
    "lane@level": _HEIGHT,
    "height": _HEIGHT,
    "objects": _BESIDE,
    "signals": _RULES,
    "surface": _LOOKS,
    "railroad": "rails, on which no road vehicle drives",
    "neighbor": "a road beside, whose lanes are its own",
    "center": "lane 0, which has no width",
    "roadMark": _MARKS,
    "material": _LOOKS,
    "visibility": _LOOKS,
    "speed": _RULES,
    "rule": _RULES,
}
"""Of a road and all below it in OpenDRIVE; other elements of the file are looked up in ``OPENDRIVE_FILE``."""

OPENDRIVE_FILE: Mapping[str, str] = {
    "road": "looked at one by one",
    "header": _DESCRIPTION,
    "userData": OPENDRIVE["userData"],
    "dataQuality": _DESCRIPTION,
    "controller": _RULES,
    "junction": "which roads meet; a route names its roads, and links join them",
    "junctionGroup": _DESCRIPTION,
    "station": _OTHERS,
}

_LANELETS: Mapping[str, str] = {
    **dict.fromkeys(
        (f"commonRoad@{x}" for x in ("benchmarkID", "date", "author", "affiliation", "source")), _DESCRIPTION
    ),
    "location": _EARTH,
    "scenarioTags": _DESCRIPTION,
    "lineMarking": _MARKS,
    "stopLine": _MARKS,
    "speedLimit": _RULES,
    "trafficSign": _RULES,
    "trafficLight": _RULES,
    "trafficSignRef": _RULES,
    "trafficLightRef": _RULES,
    "intersection": "which lanelets cross; their successors are read",
    "environmentObstacle": _BESIDE,
    "planningProblem": _PLAN,
    "z": _HEIGHT,
}
COMMONROAD_MAP: Mapping[str, str] = {
    **_LANELETS,
    "commonRoad@timeStepSize": _TRAFFIC,
    **dict.fromkeys(("staticObstacle", "dynamicObstacle", "phantomObstacle", "obstacle"), _TRAFFIC),
}
COMMONROAD: Mapping[str, str] = {
    **_LANELETS,
    "initialSignalState": _LOOKS,
    "signalSeries": _LOOKS,
    **dict.fromkeys(
        (
            *("yawRate", "steeringAngle", "hitchAngle", "curvature", "curvatureChange", "jerk", "jounce"),
            *("rollAngle", "rollRate", "pitchAngle", "pitchRate", "positionZ", "velocityZ"),
            *(f"{x}{y}" for x in ("rollAngle", "rollRate", "positionZ") for y in ("Front", "Rear")),
            *(f"{x}{y}" for x in ("velocityY", "velocityZ", "deltaY") for y in ("Front", "Rear")),
            *(f"{x}{y}WheelAngularSpeed" for x in ("left", "right") for y in ("Front", "Rear")),
        ),
        _DYNAMICS,
    ),
}

_TAGS: Mapping[str, tuple[str, ...]] = {
    _HEIGHT: ("ele", "local_z", "elevation", "height"),
    _EARTH: ("lat", "lon", "mgrs_code"),
    _DESCRIPTION: ("name", "road_name", "region", "location", "source"),
    _MARKS: ("type", "subtype", "lane_change", "width", "color", "temporary"),
    _RULES: ("speed_limit", "speed_limit_mandatory", "turn_direction", "road_surface"),
}
"""Keys of tags by the rule that makes them harmless; type and subtype of relations are read."""
LANELET2: Mapping[str, str] = {
    **{f"tag[k={key}]": rule for rule, keys in _TAGS.items() for key in keys},
    **{f"@{x}": _FORMER for x in ("version", "visible", "timestamp", "changeset", "uid", "user", "action")},
    **dict.fromkeys(("osm@generator", "@upload", "MetaInfo", "bounds", "note", "meta"), _FORMER),
    **dict.fromkeys(("node@lat", "node@lon"), "places on the earth of nodes that have local ones"),
    "member[role=regulatory_element]": _RULES,
    "member[role=centerline]": "a line between the bounds, which are read",
}
OSM_KEYS: Mapping[str, str] = {"tag": "k", "member": "role"}
"""By tag the attribute that says what an element of OSM is."""
