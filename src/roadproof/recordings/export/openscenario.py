"""A drive in OpenSCENARIO XML 1.2, on its road in OpenDRIVE: every vehicle follows a polyline in time.

A vehicle's reference point is its rear axle, and its box is turned as it moves. Times are absolute
(``domainAbsoluteRelative``), so a player is where the drive is at every instant.
"""

import math
from collections.abc import Mapping
from fractions import Fraction

from roadproof.recordings.export import opendrive
from roadproof.recordings.export.points import OVERHANG, axle_to_centre, rear_axle
from roadproof.recordings.export.polyline import ROUNDING, Polyline, polyline_of
from roadproof.recordings.export.subject import WRITTEN, Subject, kind_of
from roadproof.recordings.export.xml import Element, decimal, document, element
from roadproof.world.drive import Motion
from roadproof.world.motion import State
from roadproof.world.signals import Kind

HEIGHT = Fraction(3, 2)
WHEEL = Fraction(3, 5)
"""Metres: the height of the box and the diameter of the wheels, which our vehicles do not have."""

# Kinds that OpenSCENARIO calls otherwise; a van is read back as what is none of the other kinds.
_CATEGORIES: Mapping[Kind, str] = {"motorcycle": "motorbike", "other": "van"}


def files(subject: Subject) -> dict[str, bytes]:
    """NAME.xosc, and NAME.xodr, which it names. Raises ``InputError``."""
    return {f"{subject.name}.xosc": scenario_file(subject), **opendrive.files(subject)}


def scenario_file(subject: Subject) -> bytes:
    """The drive; its heading says how far from it straight lines between vertices are."""
    horizon = subject.file.horizon
    lines = {name: polyline_of(motion, horizon) for name, motion in subject.vehicles.items()}
    header = element(
        "FileHeader",
        revMajor="1",
        revMinor="2",
        date=f"{WRITTEN}T00:00:00",
        description=_said(subject, lines),
        author="roadproof",
    )
    network = element("RoadNetwork", element("LogicFile", filepath=f"{subject.name}.xodr"))
    entities = [
        element("ScenarioObject", _vehicle(motion, lines[name]), name=name)
        for name, motion in subject.vehicles.items()
    ]
    story = element("Story", _act(subject, lines), name="drive")
    actions = [_init(name, motion, lines[name]) for name, motion in subject.vehicles.items()]
    board = element(
        "Storyboard",
        element("Init", element("Actions", *actions)),
        story,
        element("StopTrigger", _at(horizon, "end")),
    )
    root = element("OpenSCENARIO", header, element("ParameterDeclarations"), element("CatalogLocations"))
    root.extend([network, element("Entities", *entities), board])
    return document(root)


def _said(subject: Subject, lines: dict[str, Polyline]) -> str:
    bound = math.ceil(max(x.bound + ROUNDING for x in lines.values()) * 10_000) / 10_000
    turned = max(_corner(subject.vehicles[name], line) for name, line in lines.items())
    return (
        f"{subject.said}; straight lines between vertices are within {bound:.4f} m of the drive; boxes are "
        f"turned as they move, their corners up to {turned:.3f} m from those of the boxes that were judged, "
        "which are aligned with the road"
    )


def _corner(motion: Motion, line: Polyline) -> float:
    """How far a corner of the turned box is from that of the aligned one at most."""
    return 2 * math.sin(line.turned / 2) * math.hypot(motion.length, motion.width) / 2


def _vehicle(motion: Motion, line: Polyline) -> Element:
    box = element(
        "BoundingBox",
        element("Center", x=decimal(axle_to_centre(motion.length)), y="0", z=decimal(HEIGHT / 2)),
        element(
            "Dimensions", width=decimal(motion.width), length=decimal(motion.length), height=decimal(HEIGHT)
        ),
    )
    pulls = [float(x) for x in line.pulls]
    can = element(
        "Performance",
        maxSpeed=decimal(max(x.v_lon for x in line.vertices) + 10),
        maxAcceleration=decimal(max(10.0, *pulls)),
        maxDeceleration=decimal(max(10.0, *(-x for x in pulls))),
    )
    apart = motion.length * (1 - 2 * OVERHANG)
    axles = element("Axles", _axle("FrontAxle", motion, apart), _axle("RearAxle", motion, Fraction(0)))
    kind = kind_of(motion)
    category = _CATEGORIES.get(kind, kind)
    return element("Vehicle", box, can, axles, element("Properties"), name="box", vehicleCategory=category)


def _axle(tag: str, motion: Motion, place: Fraction) -> Element:
    return element(
        tag,
        maxSteering="0.5" if place else "0",
        wheelDiameter=decimal(WHEEL),
        trackWidth=decimal(motion.width),
        positionX=decimal(place),
        positionZ=decimal(WHEEL / 2),
    )


def _init(name: str, motion: Motion, line: Polyline) -> Element:
    first = line.vertices[0]
    place = element("PrivateAction", element("TeleportAction", _position(first, line.headings[0], motion)))
    step = element("SpeedActionDynamics", dynamicsShape="step", value="0", dynamicsDimension="time")
    speed = decimal(math.hypot(first.v_lon, first.v_lat))
    target = element("SpeedActionTarget", element("AbsoluteTargetSpeed", value=speed))
    moving = element("LongitudinalAction", element("SpeedAction", step, target))
    return element("Private", place, element("PrivateAction", moving), entityRef=name)


def _position(state: State, turned: float, motion: Motion) -> Element:
    x, y = rear_axle(state, motion, turned)
    return element("Position", element("WorldPosition", x=decimal(x), y=decimal(y), h=decimal(turned)))


def _act(subject: Subject, lines: dict[str, Polyline]) -> Element:
    groups = [_group(name, motion, lines[name]) for name, motion in subject.vehicles.items()]
    start = element("StartTrigger", _at(Fraction(0), "begin"))
    return element("Act", *groups, start, name="all")


def _group(name: str, motion: Motion, line: Polyline) -> Element:
    actors = element("Actors", element("EntityRef", entityRef=name), selectTriggeringEntities="false")
    action = element("Action", element("PrivateAction", _follow(name, motion, line)), name=f"{name} follows")
    start = element("StartTrigger", _at(Fraction(0), f"{name} begins"))
    event = element("Event", action, start, name=f"{name} drives", priority="override")
    manoeuvre = element("Maneuver", event, name=f"{name} moves")
    return element("ManeuverGroup", actors, manoeuvre, name=f"{name} acts", maximumExecutionCount="1")


def _follow(name: str, motion: Motion, line: Polyline) -> Element:
    vertices = [
        element("Vertex", _position(state, turned, motion), time=decimal(state.time))
        for state, turned in zip(line.vertices, line.headings, strict=True)
    ]
    shape = element("Shape", element("Polyline", *vertices))
    way = element("Trajectory", shape, name=f"way of {name}", closed="false")
    timing = element("Timing", domainAbsoluteRelative="absolute", scale="1", offset="0")
    mode = element("TrajectoryFollowingMode", followingMode="position")
    reference = element("TrajectoryRef", way)
    follow = element("FollowTrajectoryAction", reference, element("TimeReference", timing), mode)
    return element("RoutingAction", follow)


def _at(time: Fraction, name: str) -> Element:
    """A condition that is met from ``time`` on."""
    clock = element("SimulationTimeCondition", value=decimal(time), rule="greaterOrEqual")
    condition = element("Condition", element("ByValueCondition", clock), name=name, delay="0")
    condition.set("conditionEdge", "none")
    return element("ConditionGroup", condition)
