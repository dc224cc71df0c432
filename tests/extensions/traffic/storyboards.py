"""Storyboards of every action, trigger, position and dynamics that the reader supports, by name.

Each lasts SECONDS on a road with three lanes to the right of its reference line and two to the left. They are
run by the reader (``test_esmini.py``), and were run by esmini (``esmini_record.py``).
"""

import math
from collections.abc import Mapping
from pathlib import Path

from extensions.traffic.board import (
    at_time,
    element_is,
    event,
    facing,
    init,
    lane,
    longitudinal,
    of,
    to_lane,
    to_speed,
    when,
)

SECONDS = 10
EVERY = 0.5
"""s between the positions that are compared."""
CURVATURE = 0.0025
_WIDTH = '<width sOffset="0" a="4" b="0" c="0" d="0"/>'


def _lanes(*numbers: int) -> str:
    return "".join(f'<lane id="{k}" type="driving" level="false">{_WIDTH}</lane>' for k in numbers)


MAP = (
    '<OpenDRIVE><header revMajor="1" revMinor="6"/><road name="r" id="7" length="2000" junction="-1"><planView>'
    '<geometry s="0" length="2000" x="30" y="40" hdg="0.3">{curve}</geometry></planView>'
    f'<lanes><laneSection s="0"><left>{_lanes(2, 1)}</left><center><lane id="0" type="none" level="false"/>'
    f"</center><right>{_lanes(-1, -2, -3)}</right></laneSection></lanes></road></OpenDRIVE>"
)
CURVES = {"straight": "<line/>", "bend": f'<arc curvature="{CURVATURE}"/>'}
CAR = (
    '<Vehicle name="car" vehicleCategory="car"><BoundingBox><Center x="1.4" y="0" z="0.7"/>'
    '<Dimensions length="5" width="2" height="1.5"/></BoundingBox><Performance maxSpeed="60" '
    'maxAcceleration="20" maxDeceleration="20"/><Axles><FrontAxle maxSteering="0.5" wheelDiameter="0.6" '
    'trackWidth="1.6" positionX="2.8" positionZ="0.3"/><RearAxle maxSteering="0" wheelDiameter="0.6" '
    'trackWidth="1.6" positionX="0" positionZ="0.3"/></Axles><Properties/></Vehicle>'
)
CENTRED = CAR.replace('x="1.4"', 'x="0"')
"""On trajectories, where esmini turns boxes and the reader keeps them along the road, centres are compared."""
END = when(at_time(SECONDS + 1), tag="StopTrigger")
EGO, OTHER = init("Ego", lane(-2, 100), 20), init("Other", lane(-1, 140), 16)


def group(name: str, *events: str) -> str:
    return (
        f'<ManeuverGroup name="g {name}" maximumExecutionCount="1"><Actors selectTriggeringEntities="false">'
        f'<EntityRef entityRef="{name}"/></Actors><Maneuver name="m {name}">{"".join(events)}</Maneuver>'
        "</ManeuverGroup>"
    )


def write(
    folder: Path,
    begin: Mapping[str, str],
    groups: tuple[str, ...],
    curve: str,
    more: str = "",
    car: str = CAR,
) -> Path:
    """A file with its map."""
    (folder / "map.xodr").write_text(MAP.format(curve=CURVES[curve]), "utf-8")
    entities = "".join(f'<ScenarioObject name="{name}">{car}</ScenarioObject>' for name in begin)
    act = f'<Act name="act">{"".join(groups)}{when(at_time(0))}</Act>'
    path = folder / "story.xosc"
    path.write_text(
        '<OpenSCENARIO><FileHeader revMajor="1" revMinor="2" date="2026-01-01T00:00:00" author="roadproof" '
        f'description="test"/>{more}<CatalogLocations/><RoadNetwork><LogicFile filepath="map.xodr"/></RoadNetwork>'
        f"<Entities>{entities}</Entities><Storyboard><Init><Actions>{''.join(begin.values())}</Actions></Init>"
        f'<Story name="story">{act}</Story>{END}</Storyboard></OpenSCENARIO>',
        "utf-8",
    )
    return path


Board = tuple[dict[str, str], tuple[str, ...], str, str]
"""Actions of Init by vehicle, maneuver groups, the curve of the road, and declarations."""
BOARDS: dict[str, Board] = {}


def board(
    name: str, *groups: str, begin: Mapping[str, str] | None = None, curve: str = "straight", more: str = ""
) -> None:
    assert name not in BOARDS, name
    BOARDS[name] = dict(begin or {"Ego": EGO, "Other": OTHER}), groups, curve, more


def private(action: str) -> str:
    return f"<PrivateAction>{action}</PrivateAction>"


def does(name: str, action: str, time: float = 1) -> str:
    """A group of one vehicle that begins an action at a time."""
    return group(name, event("go", action, when(at_time(time))))


# --- speeds -----------------------------------------------------------------------------------------

SHAPES = ("linear", "cubic", "sinusoidal")
for shape in SHAPES:
    for by, value in (("time", 3), ("rate", 2), ("distance", 60)):
        for curve in CURVES:
            board(f"speed {shape} {by} {curve}", does("Ego", to_speed(14, shape, by, value)), curve=curve)
            board(
                f"lane {shape} {by} {curve}",
                does("Ego", to_lane('<AbsoluteTargetLane value="-1"/>', shape, by, value)),
                curve=curve,
            )
board("speed step", does("Ego", to_speed(15)))
board("speed to a stop", does("Ego", to_speed(0, "linear", "rate", 5)))
board("speed above maxSpeed at once", does("Ego", to_speed(80)))
for kind, amount in (("delta", -3), ("factor", 1.2)):
    aim = f'<RelativeTargetSpeed entityRef="Other" value="{amount}" speedTargetValueType="{kind}" continuous="%s"/>'
    board(f"relative speed {kind}", does("Ego", to_speed(0, "linear", "time", 2, aim=aim % "false")))
    for shape in ("step", "linear", "cubic"):
        board(
            f"continuous relative speed {kind} {shape}",
            does("Ego", to_speed(0, shape, "time", 0 if shape == "step" else 2, aim=aim % "true")),
            does("Other", to_speed(12, "linear", "time", 3), 4),
        )
PROFILE = "".join(f'<SpeedProfileEntry speed="{v}" time="{t}"/>' for v, t in ((24, 2), (17, 3)))
board(
    "speed profile",
    does("Ego", longitudinal(f'<SpeedProfileAction followingMode="position">{PROFILE}</SpeedProfileAction>')),
)

# --- lanes and offsets ------------------------------------------------------------------------------

board("lane step", does("Ego", to_lane('<AbsoluteTargetLane value="-1"/>', "step", "time", 0)))
for value in (1, 0, -1):
    board(
        f"relative lane {value}",
        does("Ego", to_lane(f'<RelativeTargetLane entityRef="Other" value="{value}"/>')),
        begin={"Ego": EGO, "Other": init("Other", lane(-2, 140), 16)},
    )
OFFSET = '<LaneChangeAction targetLaneOffset="0.5">'
board(
    "lane with offset",
    does("Ego", to_lane('<AbsoluteTargetLane value="-1"/>').replace("<LaneChangeAction>", OFFSET)),
)


def offset(target: str, shape: str, most: float | None = 1.0) -> str:
    limit = "" if most is None else f' maxLateralAcc="{most}"'
    return private(
        f'<LateralAction><LaneOffsetAction continuous="false"><LaneOffsetActionDynamics dynamicsShape="{shape}"'
        f"{limit}/><LaneOffsetTarget>{target}</LaneOffsetTarget></LaneOffsetAction></LateralAction>"
    )


for shape in (*SHAPES, "step"):
    board(f"offset {shape}", does("Ego", offset('<AbsoluteTargetLaneOffset value="0.8"/>', shape)))
board(
    "offset without limit",
    does("Ego", offset('<AbsoluteTargetLaneOffset value="-0.6"/>', "sinusoidal", None)),
)
board(
    "offset relative",
    does("Ego", offset('<RelativeTargetLaneOffset entityRef="Other" value="0.2"/>', "cubic")),
    begin={"Ego": EGO, "Other": init("Other", lane(-1, 140).replace('offset="0"', 'offset="0.4"'), 16)},
)

# --- distances and meetings ---------------------------------------------------------------------------

LIMITS = '<DynamicConstraints maxAcceleration="2" maxDeceleration="3" maxSpeed="40"/>'


def distance(more: str, inside: str = LIMITS, action: str = "LongitudinalDistanceAction") -> str:
    kind = action.removesuffix("DistanceAction")
    node = f'<{action} entityRef="Other" {more}>{inside}</{action}>'
    return private(f"<{kind}Action>{node}</{kind}Action>")


AHEAD = {"Ego": EGO, "Other": init("Other", lane(-2, 150), 20)}
for name, more in {
    "distance": 'distance="40" freespace="false" continuous="true" coordinateSystem="road"',
    "distance free": 'distance="40" freespace="true" continuous="true" coordinateSystem="road"',
    "distance once": 'distance="45" freespace="false" continuous="false" coordinateSystem="road"',
    "time gap": 'timeGap="2" freespace="false" continuous="true" coordinateSystem="road"',
    "distance behind": 'distance="46" freespace="false" continuous="true" displacement="trailingReferencedEntity" '
    'coordinateSystem="road"',
}.items():
    board(name, does("Ego", distance(more)), begin=AHEAD)
for name, more in {
    "beside": 'distance="3" freespace="false" continuous="true" coordinateSystem="road"',
    "beside free": 'distance="1.5" freespace="true" continuous="true" coordinateSystem="road"',
}.items():
    inside = '<DynamicConstraints maxSpeed="1"/>'
    board(name, does("Ego", distance(more, inside, "LateralDistanceAction")))


def meets(final: str, here: float = 250) -> str:
    at = f"<TargetPositionMaster>{lane(-1, 260)[10:-11]}</TargetPositionMaster>"
    target = f"<TargetPosition>{lane(-2, here)[10:-11]}</TargetPosition>"
    return private(f'<SynchronizeAction masterEntityRef="Other">{at}{target}{final}</SynchronizeAction>')


for name, final in {
    "meeting": "",
    "meeting at a speed": '<FinalSpeed><AbsoluteSpeed value="17"/></FinalSpeed>',
    "meeting at a relative speed": '<FinalSpeed><RelativeSpeedToMaster value="2" speedTargetValueType="delta"/>'
    "</FinalSpeed>",
}.items():
    board(name, does("Ego", meets(final), 1))

# --- trajectories -------------------------------------------------------------------------------------


def world(s: float, d: float, turn: float = 0.0) -> str:
    x = 30 + s * math.cos(0.3) - d * math.sin(0.3)
    y = 40 + s * math.sin(0.3) + d * math.cos(0.3)
    return f'<Position><WorldPosition x="{x:.6f}" y="{y:.6f}" h="{0.3 + turn:.6f}"/></Position>'


def follow(shape: str, timing: str = "<None/>") -> str:
    return private(
        '<RoutingAction><FollowTrajectoryAction><TrajectoryRef><Trajectory name="t" closed="false"><Shape>'
        f"{shape}</Shape></Trajectory></TrajectoryRef><TimeReference>{timing}</TimeReference>"
        '<TrajectoryFollowingMode followingMode="position"/></FollowTrajectoryAction></RoutingAction>'
    )


def timing(domain: str) -> str:
    return f'<Timing domainAbsoluteRelative="{domain}" scale="1" offset="0"/>'


def polyline(points: list[tuple[float, float, float]], timed: bool) -> str:
    times = [f' time="{t}"' if timed else "" for t, _, _ in points]
    inside = "".join(f"<Vertex{x}>{world(s, d)}</Vertex>" for x, (_, s, d) in zip(times, points, strict=True))
    return f"<Polyline>{inside}</Polyline>"


LINE = [(float(k), 121.0 + 20 * k, -6.0) for k in range(7)]
board("polyline with times", does("Ego", follow(polyline(LINE, True), timing("relative"))))
board("polyline without times", does("Ego", follow(polyline(LINE, False))))
CLOTHOID = '<Clothoid curvature="0" {prime}="0.00002" length="90"{times}>{at}</Clothoid>'
for prime in ("curvaturePrime", "curvatureDot"):
    at = world(120.2, -6)
    shape = CLOTHOID.format(prime=prime, times="", at=at)
    board(f"clothoid {prime}", does("Ego", follow(shape)))
shape = CLOTHOID.format(prime="curvaturePrime", times=' startTime="0" stopTime="5"', at=world(120.2, -6))
board("clothoid with times", does("Ego", follow(shape, timing("relative"))))


def clothoid(curvature: float, rate: float, length: float, at: str) -> str:
    return f'<Clothoid curvature="{curvature}" curvaturePrime="{rate}" length="{length}">{at}</Clothoid>'


def end_of(rate: float, length: float, steps: int = 6000) -> tuple[float, float, float]:
    """How far ahead and to the left a clothoid that begins straight on ends, and how it is turned there."""
    ahead = left = 0.0
    for k in range(steps):
        turn = rate * ((k + 0.5) * length / steps) ** 2 / 2
        ahead, left = ahead + length / steps * math.cos(turn), left + length / steps * math.sin(turn)
    return ahead, left, rate * length**2 / 2


AHEAD_BY, LEFT_BY, TURN = end_of(0.00002, 60)
FIRST = clothoid(0, 0.00002, 60, world(120.2, -6))
SECOND = clothoid(0.0012, -0.00004, 60, world(120.2 + AHEAD_BY, -6 + LEFT_BY, TURN))
board(
    "clothoid after clothoid",
    group(
        "Ego",
        event("one", follow(FIRST), when(at_time(1))),
        event("two", follow(SECOND), when(element_is("event", "one", "completeState"))),
    ),
)
ONWARDS = (
    f'<ClothoidSplineSegment curvatureStart="0" curvatureEnd="0.0012" length="60" hOffset="0">'
    f"<PositionStart>{world(120.2, -6)[10:-11]}</PositionStart></ClothoidSplineSegment>"
    '<ClothoidSplineSegment curvatureStart="0.0012" curvatureEnd="-0.0012" length="60" hOffset="0"/>'
)
board("clothoid spline", does("Ego", follow(f"<ClothoidSpline>{ONWARDS}</ClothoidSpline>")))
PLACED = '<Private entityRef="Ego">{first}{second}</Private>'
for order in ("trajectory first", "speed first"):
    both = follow(FIRST), to_speed(20)
    first, second = both if order == "trajectory first" else both[::-1]
    begin = {"Ego": PLACED.format(first=first, second=second), "Other": OTHER}
    board(f"placed by a trajectory, {order}", begin=begin)
CONTROLS = "".join(
    f'<ControlPoint weight="1">{world(s, d)}</ControlPoint>'
    for s, d in ((120.2, -6), (150, -6), (170, -2), (200, -2))
)
KNOTS = "".join(f'<Knot value="{x}"/>' for x in (0, 0, 0, 0, 1, 1, 1, 1))
board("nurbs", does("Ego", follow(f'<Nurbs order="4">{CONTROLS}{KNOTS}</Nurbs>')))

# --- triggers -----------------------------------------------------------------------------------------

BRAKE = to_speed(16, "linear", "time", 2)


def trigger(
    name: str, condition: str, *others: str, edge: str = "none", delay: float = 0, **more: object
) -> None:
    """Ego brakes when a condition holds, after the first half second, in which esmini has no velocities."""
    start = when(condition, edge, delay)
    first = f'<Condition name="d" conditionEdge="none" delay="0">{at_time(0.5)}</Condition></ConditionGroup>'
    start = start.replace("</ConditionGroup>", first)
    board(f"trigger {name}", group("Ego", event("brake", BRAKE, start)), *others, **more)  # type: ignore[arg-type]


def relative(kind: str, system: str, free: str, value: float, rule: str = "lessThan") -> str:
    return of(
        "Ego",
        f'<RelativeDistanceCondition entityRef="Other" relativeDistanceType="{kind}" coordinateSystem="{system}" '
        f'value="{value}" freespace="{free}" rule="{rule}"/>',
    )


NEAR = {"Ego": EGO, "Other": init("Other", lane(-1, 140), 12)}
for curve in CURVES:
    for kind in ("longitudinal", "euclidianDistance"):
        for system in ("road", "entity"):
            for free in ("true", "false"):
                trigger(
                    f"{kind} {system} {free} {curve}",
                    relative(kind, system, free, 20),
                    begin=NEAR,
                    curve=curve,
                )
trigger(
    "lateral",
    relative("lateral", "road", "false", 3),
    does("Other", to_lane('<AbsoluteTargetLane value="-2"/>'), 2),
)
HEADWAY = '<TimeHeadwayCondition entityRef="Other" value="1.2" freespace="{free}" rule="lessThan" {more}/>'
for name, more in {
    "by default": "",
    "along the road": 'coordinateSystem="road" relativeDistanceType="longitudinal"',
}.items():
    for free in ("true", "false"):
        trigger(f"headway {name} {free}", of("Ego", HEADWAY.format(free=free, more=more)), begin=NEAR)
BEHIND = {"Ego": EGO, "Other": init("Other", lane(-2, 60), 26)}
trigger("headway to one behind", of("Ego", HEADWAY.format(free="false", more="")), begin=BEHIND)
COLLISION = (
    '<TimeToCollisionCondition value="3" freespace="{free}" rule="lessThan" {more}><TimeToCollisionConditionTarget>'
    "{target}</TimeToCollisionConditionTarget></TimeToCollisionCondition>"
)
for free in ("true", "false"):
    trigger(
        f"time to collision {free}",
        of(
            "Ego",
            COLLISION.format(
                free=free,
                more='coordinateSystem="road" relativeDistanceType="longitudinal"',
                target='<EntityRef entityRef="Other"/>',
            ),
        ),
        begin={"Ego": EGO, "Other": init("Other", lane(-2, 150), 12)},
    )
for name, condition in {
    "travelled distance": '<TraveledDistanceCondition value="50.1"/>',
    "reached position": f'<ReachPositionCondition tolerance="2">{lane(-2, 160.1)}</ReachPositionCondition>',
    "distance to a position": f'<DistanceCondition value="20" freespace="false" rule="lessThan">{lane(-2, 180.1)}'
    "</DistanceCondition>",
    "speed": '<SpeedCondition value="17" rule="lessThan"/>',
    "standstill": '<StandStillCondition duration="1"/>',
    "relative speed": '<RelativeSpeedCondition entityRef="Ego" value="-6" rule="lessThan"/>',
    "acceleration": '<AccelerationCondition value="-1" rule="lessThan" direction="longitudinal"/>',
}.items():
    if "position" in name or "travelled" in name:
        trigger(name, of("Ego", condition))
    else:
        final = 0 if name == "standstill" else 10
        trigger(name, of("Other", condition), does("Other", to_speed(final, "linear", "rate", 4), 2))
HIT = '<CollisionCondition><EntityRef entityRef="Other"/></CollisionCondition>'
trigger("collision", of("Ego", HIT), begin={"Ego": EGO, "Other": init("Other", lane(-2, 130), 12)})
CLEAR = '<RelativeClearanceCondition oppositeLanes="false" distanceForward="30" distanceBackward="10" freeSpace="{free}">{span}</RelativeClearanceCondition>'
SPAN = '<RelativeLaneRange from="1" to="1"/>'
for free in ("true", "false"):
    trigger(
        f"clearance {free}",
        of("Ego", CLEAR.format(free=free, span=SPAN)),
        begin={"Ego": EGO, "Other": init("Other", lane(-1, 105), 10)},
    )
trigger(
    "off the road",
    of("Other", '<OffroadCondition duration="0.5"/>'),
    does("Other", offset('<AbsoluteTargetLaneOffset value="13"/>', "cubic", 4.0)),
)
for state in ("startTransition", "endTransition", "runningState", "completeState"):
    trigger(
        f"event {state}", element_is("event", "go", state), does("Other", to_speed(12, "linear", "time", 2))
    )
trigger("delay", at_time(2), delay=1.5)
trigger("rising edge", relative("longitudinal", "road", "false", 20), edge="rising", begin=NEAR)
trigger(
    "falling edge",
    relative("longitudinal", "road", "false", 20),
    edge="falling",
    begin={"Ego": EGO, "Other": init("Other", lane(-1, 110), 25)},
)
VARIABLE = '<VariableDeclarations><VariableDeclaration name="v" variableType="double" value="1"/></VariableDeclarations>'
SET = '<GlobalAction><VariableAction variableRef="v"><SetAction value="3"/></VariableAction></GlobalAction>'
VALUE = (
    '<ByValueCondition><VariableCondition variableRef="v" value="2" rule="greaterThan"/></ByValueCondition>'
)
trigger("variable", VALUE, does("Other", SET, 2), more=VARIABLE)
for priority in ("override", "parallel", "skip"):
    first = event("one", to_speed(14, "linear", "time", 4), when(at_time(1)))
    second = event("two", to_speed(22, "linear", "time", 2), when(at_time(3), "rising"), priority)
    board(f"priority {priority}", group("Ego", first, second))

# --- positions ----------------------------------------------------------------------------------------


def orientation(position: str, heading: float, kind: str = "relative") -> str:
    tag = position.removeprefix("<Position><").split(" ", 1)[0]
    turn = f'<Orientation type="{kind}" h="{heading}"/>'
    return position.replace("/></Position>", f">{turn}</{tag}></Position>")


def place(inside: str) -> str:
    return f"<Position><{inside}/></Position>"


for curve in CURVES:
    for name, position in {
        "lane": lane(-3, 150),
        "left lane": lane(1, 500),
        "left lane turned": facing(lane(1, 200)),
        "lane turned": facing(lane(-1, 500)),
        "road": place('RoadPosition roadId="7" s="150" t="-9.5"'),
        "road with heading": orientation(place('RoadPosition roadId="7" s="150" t="2"'), 0.0),
        "road turned": orientation(place('RoadPosition roadId="7" s="500" t="-2"'), math.pi),
        "relative lane": place('RelativeLanePosition entityRef="Ego" dLane="1" ds="30" offset="0.3"'),
        "relative road": place('RelativeRoadPosition entityRef="Ego" ds="25" dt="4"'),
        "relative object": place('RelativeObjectPosition entityRef="Ego" dx="30" dy="4"'),
    }.items():
        board(
            f"position {name} {curve}", begin={"Ego": EGO, "Other": init("Other", position, 10)}, curve=curve
        )
board("position world", begin={"Ego": EGO, "Other": init("Other", world(160, -2), 10)})
board(
    "position relative world",
    begin={
        "Ego": EGO,
        "Other": init("Other", place('RelativeWorldPosition entityRef="Ego" dx="30" dy="4"'), 10),
    },
)
PUT = private(f"<TeleportAction>{lane(-1, 300)}</TeleportAction>")
board("teleport", does("Other", PUT, 2))
ADD = '<GlobalAction><EntityAction entityRef="Other"><DeleteEntityAction/></EntityAction></GlobalAction>'
board("deleted", does("Ego", ADD, 2))


def files(folder: Path, name: str) -> Path:
    """The file of a storyboard."""
    begin, groups, curve, more = BOARDS[name]
    turns = any("FollowTrajectoryAction" in x for x in (*groups, *begin.values()))
    return write(folder, begin, groups, curve, more, CENTRED if turns else CAR)
