"""A CommonRoad file small enough to check by hand: a straight road turned by 30 degrees, as text."""

import math
from dataclasses import dataclass

TURN = math.radians(30)


@dataclass(frozen=True)
class Car:
    """Positions (along, across) of the centre in road coordinates; one state a time step.

    ``motion`` has a (speed, acceleration) for each; without it they are the same in all.
    """

    id: int
    first: int
    centres: tuple[tuple[float, float], ...]
    speed: float = 20.0
    drift: float = 0.0  # angle to the road
    length: float = 4.0
    motion: tuple[tuple[float, float], ...] | None = None


CARS = (
    Car(7, 0, ((10.0, 1.75), (12.0, 1.75), (14.0, 1.75))),  # right main lane
    Car(3, 1, ((40.0, 3.2), (42.0, 3.6)), drift=0.1),  # astride the marking at 3.5
    Car(9, 0, ((60.0, -1.75),), length=9.0),  # on the merge lane
)


def plane(along: float, across: float) -> tuple[float, float]:
    return (
        100 + along * math.cos(TURN) - across * math.sin(TURN),
        50 + along * math.sin(TURN) + across * math.cos(TURN),
    )


def point(along: float, across: float) -> str:
    x, y = plane(along, across)
    return f"<point><x>{x!r}</x><y>{y!r}</y></point>"


def lanelet(name: str, low: float, high: float, s: tuple[float, float], kind: str, links: str) -> str:
    def bound(tag: str, across: float) -> str:
        return f"<{tag}>{''.join(point(a, across) for a in (s[0], sum(s) / 2, s[1]))}</{tag}>"

    return (
        f'<lanelet id="{name}">{bound("leftBound", high)}{bound("rightBound", low)}{links}'
        f"<laneletType>{kind}</laneletType></lanelet>"
    )


def state(tag: str, car: Car, k: int) -> str:
    speed, acceleration = (car.speed, -1.5) if car.motion is None else car.motion[k]
    values = {
        "orientation": TURN + car.drift,
        "time": car.first + k,
        "velocity": speed,
        "acceleration": acceleration,
    }
    return (
        f"<{tag}><position>{point(*car.centres[k])}</position>"
        + "".join(f"<{x}><exact>{v!r}</exact></{x}>" for x, v in values.items())
        + f"</{tag}>"
    )


def obstacle(car: Car) -> str:
    states = "".join(state("state", car, k) for k in range(1, len(car.centres)))
    return (
        f'<dynamicObstacle id="{car.id}"><type>car</type><shape><rectangle><length>{car.length}</length>'
        f"<width>1.8</width></rectangle></shape>{state('initialState', car, 0)}"
        f"<trajectory>{states}</trajectory></dynamicObstacle>"
    )


def document(cars: tuple[Car, ...] = CARS) -> str:
    """Two main lanes of two lanelets each, and a merge lane beside the first right one."""
    road = [
        lanelet(
            "1", 0.0, 3.5, (0, 80), "highway", '<successor ref="2"/><adjacentLeft ref="3" drivingDir="same"/>'
        ),
        lanelet("2", 0.0, 3.5, (80, 160), "highway", '<predecessor ref="1"/>'),
        lanelet("3", 3.5, 7.0, (0, 80), "highway", '<successor ref="4"/>'),
        lanelet("4", 3.5, 7.0, (80, 160), "highway", '<adjacentRight ref="2" drivingDir="same"/>'),
        lanelet("5", -3.5, 0.0, (0, 80), "accessRamp", '<adjacentLeft ref="1" drivingDir="same"/>'),
    ]
    head = '<?xml version="1.0"?><commonRoad commonRoadVersion="2020a" timeStepSize="0.1">'
    return head + "".join(road) + "".join(map(obstacle, cars)) + "</commonRoad>"
