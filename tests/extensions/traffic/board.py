"""Storyboards of OpenSCENARIO for tests, put together from elements.

The road has three lanes of 4 m to the right of its reference line: their middles are at d = -2, -6 and -10.
Boxes are 4 m by 2 m around the reference point, so the front-left corner is at s + 2 and d + 1.
"""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from roadproof.extensions.exchange.openscenario import read_scenario

Rows = Mapping[str, np.ndarray]
LANES = "".join(
    f'<lane id="-{k}" type="driving" level="false"><width sOffset="0" a="4" b="0" c="0" d="0"/></lane>'
    for k in (1, 2, 3)
)
MAP = (
    '<OpenDRIVE><header revMajor="1" revMinor="6"/><road id="7" length="2000" junction="-1"><planView>'
    '<geometry s="0" length="2000" x="30" y="40" hdg="{hdg}">{curve}</geometry></planView>'
    '<lanes><laneSection s="0"><center><lane id="0" type="none" level="false"/></center>'
    f"<right>{LANES}</right></laneSection></lanes></road></OpenDRIVE>"
)
CAR = (
    '<Vehicle name="car" vehicleCategory="car"><BoundingBox><Center x="0" y="0" z="0"/>'
    '<Dimensions length="4" width="2" height="1"/></BoundingBox></Vehicle>'
)


def lane(number: int, s: float) -> str:
    return f'<Position><LanePosition roadId="7" laneId="{number}" s="{s}" offset="0"/></Position>'


def init(name: str, position: str, speed: object) -> str:
    return (
        f'<Private entityRef="{name}"><PrivateAction><TeleportAction>{position}</TeleportAction>'
        f"</PrivateAction>{to_speed(speed)}</Private>"
    )


def target(speed: object) -> str:
    return f'<AbsoluteTargetSpeed value="{speed}"/>'


def to_speed(
    speed: object, shape: str = "step", by: str = "time", value: object = 0, aim: str | None = None
) -> str:
    dynamics = f'dynamicsShape="{shape}" dynamicsDimension="{by}" value="{value}"'
    return (
        f"<PrivateAction><LongitudinalAction><SpeedAction><SpeedActionDynamics {dynamics}/>"
        f"<SpeedActionTarget>{aim or target(speed)}</SpeedActionTarget></SpeedAction></LongitudinalAction>"
        "</PrivateAction>"
    )


def to_lane(aim: str, shape: str = "cubic", by: str = "time", value: float = 4) -> str:
    dynamics = f'dynamicsShape="{shape}" dynamicsDimension="{by}" value="{value}"'
    return (
        f"<PrivateAction><LateralAction><LaneChangeAction><LaneChangeActionDynamics {dynamics}/>"
        f"<LaneChangeTarget>{aim}</LaneChangeTarget></LaneChangeAction></LateralAction></PrivateAction>"
    )


def when(condition: str, edge: str = "none", delay: float = 0, tag: str = "StartTrigger") -> str:
    return (
        f'<{tag}><ConditionGroup><Condition name="c" conditionEdge="{edge}" delay="{delay}">'
        f"{condition}</Condition></ConditionGroup></{tag}>"
    )


def at_time(time: float) -> str:
    clock = f'<SimulationTimeCondition value="{time}" rule="greaterOrEqual"/>'
    return f"<ByValueCondition>{clock}</ByValueCondition>"


def of(name: str, condition: str) -> str:
    return (
        f'<ByEntityCondition><TriggeringEntities triggeringEntitiesRule="any"><EntityRef entityRef="{name}"/>'
        f"</TriggeringEntities><EntityCondition>{condition}</EntityCondition></ByEntityCondition>"
    )


def element_is(kind: str, name: str, state: str) -> str:
    return (
        f'<ByValueCondition><StoryboardElementStateCondition storyboardElementType="{kind}" '
        f'storyboardElementRef="{name}" state="{state}"/></ByValueCondition>'
    )


def event(name: str, action: str, trigger: str, priority: str = "parallel") -> str:
    return (
        f'<Event name="{name}" priority="{priority}"><Action name="{name} action">{action}</Action>'
        f"{trigger}</Event>"
    )


def maneuver(name: str, *events: str) -> str:
    return (
        f'<ManeuverGroup name="group of {name}" maximumExecutionCount="1"><Actors '
        f'selectTriggeringEntities="false"><EntityRef entityRef="{name}"/></Actors>'
        f'<Maneuver name="maneuver of {name}">{"".join(events)}</Maneuver></ManeuverGroup>'
    )


def put(
    folder: Path,
    begin: Mapping[str, str],
    *groups: str,
    stop: str = "",
    more: str = "",
    hdg: float = 0.3,
    curve: str = "<line/>",
    entity: str = CAR,
) -> Path:
    (folder / "map.xodr").write_text(MAP.format(hdg=hdg, curve=curve), "utf-8")
    entities = "".join(f'<ScenarioObject name="{name}">{entity}</ScenarioObject>' for name in begin)
    story = f'<Story name="story"><Act name="act">{"".join(groups)}{when(at_time(0))}</Act></Story>'
    path = folder / "story.xosc"
    path.write_text(
        f'<OpenSCENARIO><FileHeader revMajor="1" revMinor="2"/>{more}<RoadNetwork><LogicFile '
        f'filepath="map.xodr"/></RoadNetwork><Entities>{entities}</Entities><Storyboard><Init><Actions>'
        f"{''.join(begin.values())}</Actions></Init>{story if groups else ''}"
        f"{stop or '<StopTrigger/>'}</Storyboard></OpenSCENARIO>",
        "utf-8",
    )
    return path


def rows(path: Path) -> dict[str, Rows]:
    table = read_scenario(path).table
    names = table["vehicle"]
    return {str(name): {x: table[x][names == name] for x in table.columns} for name in dict.fromkeys(names)}


def at(found: Rows, time: float, signal: str) -> float:
    (k,) = np.flatnonzero(np.isclose(found["time"], time))
    return float(found[signal][k])


def first_time(found: Rows, holds: np.ndarray) -> float:
    """When something holds first, which it does, and not from the beginning."""
    assert holds.any(), "it never happens"
    assert not holds[0], "it holds from the beginning"
    return float(found["time"][np.argmax(holds)])


EGO = init("Ego", lane(-2, 100), 20)


def longitudinal(action: str) -> str:
    return f"<PrivateAction><LongitudinalAction>{action}</LongitudinalAction></PrivateAction>"


def facing(position: str, heading: float = math.pi) -> str:
    """A position whose vehicle is turned around."""
    tag = position.removeprefix("<Position><").split(" ", 1)[0]
    turn = f'<Orientation type="relative" h="{heading}"/>'
    return position.replace("/></Position>", f">{turn}</{tag}></Position>")
