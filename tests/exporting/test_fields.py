"""Exported files field by field: every element and attribute, against texts and formulas written here.

Three vehicles: SV is a motorcycle that drifts to the left, POV1 a truck on the merge lane that brakes, POV2
is behind SV and speeds up; POV1 and POV2 follow by name. Two samples a second, from 0 to 2 s.
"""

import csv
import io
import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise

import pytest

from exporting.kept import TURN, motion, subject
from roadproof.errors import UsageError
from roadproof.recordings.export.polyline import polyline_of
from roadproof.recordings.export.registry import FORMATS
from roadproof.recordings.export.subject import Subject, subject_of
from roadproof.world.road import Lanelet, Road


@dataclass(frozen=True)
class Car:
    """At time 0, with a constant acceleration up to ``until`` (s)."""

    s: float
    d: float
    v: float
    across: float
    a: float
    until: float
    length: float
    width: float

    def at(self, t: float) -> tuple[float, float, float, float]:
        """s, d, speed and acceleration along."""
        pulled = min(t, self.until)
        speed = self.v + self.a * pulled
        place = self.s + self.v * pulled + self.a * pulled**2 / 2 + speed * (t - pulled)
        return place, self.d + self.across * t, speed, self.a if t < self.until else 0.0


CARS = {
    "SV": Car(10, 2.6, 30, 1, 0, 0, 2.5, 1.8),
    "POV1": Car(60, -0.9, 40, 0, -12, 9, 12.5, 2.4),
    "POV2": Car(-20, 2.9, 20, 0, 12, 0.5, 4, 1.6),
}
IDS = {"SV": 1, "POV1": 2, "POV2": 3}
CATEGORIES = {"SV": "motorbike", "POV1": "truck", "POV2": "car"}
TIMES = [0, 0.5, 1, 1.5, 2]


@pytest.fixture(scope="module")
def made() -> Subject:
    def moving(car: Car) -> tuple[tuple[str | None, str, str], ...]:
        if car.a and car.until < 2:
            return ((str(car.until), str(car.a), "0"), (None, "0", "0"))
        return ((None, str(car.a), "0"),)

    motions = {
        name: motion(
            *moving(car),
            start=(str(car.s), str(car.d), str(car.v), str(car.across)),
            size=(str(car.length), str(car.width)),
        )
        for name, car in CARS.items()
    }
    motions["SV"] = replace(motions["SV"], kind="motorcycle")
    return replace(subject("merge", "2", **motions), number=3, rate=2)


def file_of(made: Subject, format_: str, name: str) -> str:
    return FORMATS[format_](made)[name].decode("utf-8")


def canonical(text: str) -> str:
    return str(ElementTree.canonicalize(text, strip_text=True)).replace("><", ">\n<")


def short(number: float) -> str:
    return f"{number:.12g}"


# --- OpenSCENARIO ----------------------------------------------------------------------------------


def axle(car: Car, t: float) -> tuple[float, float, float]:
    """The rear axle, three tenths of the length behind the middle of the turned box, and the heading."""
    s, d, speed, _ = car.at(t)
    turned = math.atan2(car.across, speed)
    lever = 0.3 * car.length
    x, y = s - car.length / 2, d - car.width / 2
    return x - lever * math.cos(turned), y - lever * math.sin(turned), turned


def clock(name: str, value: str) -> str:
    return (
        f'<ConditionGroup><Condition name="{name}" delay="0" conditionEdge="none"><ByValueCondition>'
        f'<SimulationTimeCondition value="{value}" rule="greaterOrEqual"/></ByValueCondition></Condition>'
        "</ConditionGroup>"
    )


def vehicle(name: str, car: Car, fastest: float, pulls: tuple[float, float]) -> str:
    length, width = short(car.length), short(car.width)
    axles = "".join(
        f'<{tag} maxSteering="{steering}" wheelDiameter="0.6" trackWidth="{width}" '
        f'positionX="{short(place)}" '
        'positionZ="0.3"/>'
        for tag, steering, place in (("FrontAxle", "0.5", 0.6 * car.length), ("RearAxle", "0", 0))
    )
    return (
        f'<ScenarioObject name="{name}"><Vehicle name="box" vehicleCategory="{CATEGORIES[name]}">'
        f"<BoundingBox>"
        f'<Center x="{short(0.3 * car.length)}" y="0" z="0.75"/>'
        f'<Dimensions width="{width}" length="{length}" height="1.5"/></BoundingBox>'
        f'<Performance maxSpeed="{short(fastest + 10)}" maxAcceleration="{short(pulls[0])}" '
        f'maxDeceleration="{short(pulls[1])}"/><Axles>{axles}</Axles><Properties/></Vehicle></ScenarioObject>'
    )


def begin(name: str, car: Car) -> str:
    x, y, turned = axle(car, 0)
    speed = math.hypot(car.v, car.across)
    return (
        f'<Private entityRef="{name}"><PrivateAction><TeleportAction><Position><WorldPosition x="{short(x)}" '
        f'y="{short(y)}" h="{short(turned)}"/></Position></TeleportAction></PrivateAction><PrivateAction>'
        '<LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape="step" value="0" '
        'dynamicsDimension="time"/><SpeedActionTarget>'
        f'<AbsoluteTargetSpeed value="{short(speed)}"/></SpeedActionTarget></SpeedAction>'
        f"</LongitudinalAction>"
        "</PrivateAction></Private>"
    )


def follows(name: str) -> str:
    return (
        f'<ManeuverGroup name="{name} acts" maximumExecutionCount="1"><Actors '
        f'selectTriggeringEntities="false"><EntityRef entityRef="{name}"/></Actors><Maneuver '
        f'name="{name} moves"><Event name="{name} drives" priority="override"><Action name="{name} follows">'
        f"<PrivateAction><RoutingAction><FollowTrajectoryAction><TrajectoryRef><Trajectory "
        f'name="way of {name}" '
        'closed="false"><Shape><Polyline/></Shape></Trajectory></TrajectoryRef><TimeReference><Timing '
        'domainAbsoluteRelative="absolute" scale="1" offset="0"/></TimeReference><TrajectoryFollowingMode '
        'followingMode="position"/></FollowTrajectoryAction></RoutingAction></PrivateAction></Action>'
        f"<StartTrigger>{clock(f'{name} begins', '0')}</StartTrigger></Event></Maneuver></ManeuverGroup>"
    )


def rounded(node: ElementTree.Element) -> None:
    """Numbers to twelve digits, as the ones here are."""
    for name, value in node.attrib.items():
        if name in ("x", "y", "h", "value"):
            node.set(name, short(float(value)))


def test_openscenario_has_every_attribute(made: Subject) -> None:
    root = ElementTree.fromstring(file_of(made, "openscenario", "made.xosc"))
    said = root.find("FileHeader")
    assert said is not None
    description = said.attrib.pop("description")
    assert description.startswith("true (base), 2 s, road merge, cut to s = -200 m to 400 m; straight lines")
    for group in root.iter("ManeuverGroup"):
        line = next(group.iter("Polyline"))
        check_vertices(CARS[group.attrib["name"].removesuffix(" acts")], line)
        line[:] = []
    for node in root.iter():
        rounded(node)
    fastest = {"SV": 30.0, "POV1": 40.0, "POV2": 26.0}
    pulls = {"SV": (10.0, 10.0), "POV1": (10.0, 12.0), "POV2": (12.0, 10.0)}
    expected = (
        '<OpenSCENARIO><FileHeader revMajor="1" revMinor="2" date="1970-01-01T00:00:00" author="roadproof"/>'
        "<ParameterDeclarations/><CatalogLocations/><RoadNetwork><LogicFile "
        'filepath="made.xodr"/></RoadNetwork>'
        f"<Entities>{''.join(vehicle(x, car, fastest[x], pulls[x]) for x, car in CARS.items())}</Entities>"
        f"<Storyboard><Init><Actions>{''.join(begin(x, car) for x, car in CARS.items())}</Actions></Init>"
        f'<Story name="drive"><Act name="all">{"".join(map(follows, CARS))}'
        f"<StartTrigger>{clock('begin', '0')}</StartTrigger></Act></Story>"
        f"<StopTrigger>{clock('end', '2')}</StopTrigger></Storyboard></OpenSCENARIO>"
    )
    assert canonical(ElementTree.tostring(root, "unicode")) == canonical(expected)


def check_vertices(car: Car, line: ElementTree.Element) -> None:
    times = []
    for vertex in line:
        assert vertex.tag == "Vertex"
        time = float(vertex.attrib["time"])
        (place,) = vertex.findall("Position/WorldPosition")
        assert [float(place.attrib[x]) for x in ("x", "y", "h")] == pytest.approx(axle(car, time), abs=1e-9)
        times.append(time)
    assert (times[0], times[-1]) == (0, 2)
    assert times == sorted(set(times))
    steps = [b - a for a, b in pairwise(times) if a < car.until]
    assert not car.a or max(steps) ** 2 * abs(car.a) / 8 < 0.01


# --- roads -----------------------------------------------------------------------------------------

CELLS = (
    (("main-2", "main"), ("main-1", "main")),
    (("main-2", "merge"), ("main-1", "merge"), ("merge-1", "merge")),
    (("main-2", "main"), ("main-1", "main")),
)
"""Lane and zone from left to right in each of the three sections of the merge road."""
ENDS = (-200, -100, 300, 400)


def drawn(number: int, k: int, last: bool) -> str:
    """A lane of OpenDRIVE: -1 is the leftmost; the ramp is in the middle section only."""
    lane, zone = CELLS[k][number - 1]
    links = "" if k == 0 or number == 3 else f'<predecessor id="-{number}"/>'
    links += "" if k == 2 or number == 3 else f'<successor id="-{number}"/>'
    kind, change = ("solid", "none") if last else ("broken", "both")
    return (
        f'<lane id="-{number}" type="{"entry" if number == 3 else "driving"}" level="false">'
        f"{f'<link>{links}</link>' if links else ''}"
        '<width sOffset="0" a="3.5" b="0" c="0" d="0"/>'
        f'<roadMark sOffset="0" type="{kind}" weight="standard" color="standard" width="0.15" '
        f'laneChange="{change}"/><speed sOffset="0" max="150" unit="km/h"/>'
        f'<userData code="roadproof:lane" value="{lane}"/><userData code="roadproof:zone" '
        f'value="{zone}"/></lane>'
    )


def test_opendrive_has_every_attribute(made: Subject) -> None:
    sections = "".join(
        f'<laneSection s="{low + 200}"><center><lane id="0" type="none" level="false"><roadMark sOffset="0" '
        'type="solid" weight="standard" color="standard" width="0.15" laneChange="none"/></lane></center>'
        f"<right>{''.join(drawn(n, k, n == len(row)) for n in range(1, len(row) + 1))}</right></laneSection>"
        for k, (row, low) in enumerate(zip(CELLS, ENDS, strict=False))
    )
    expected = (
        '<OpenDRIVE><header revMajor="1" revMinor="7" name="road merge, cut to s = -200 m to '
        '400 m" version="1" '
        'date="1970-01-01T00:00:00" north="7" south="-3.5" east="400" west="-200" vendor="roadproof"/>'
        '<road name="merge" length="600" id="1" junction="-1" rule="RHT"><type s="0" type="motorway">'
        '<speed max="150" unit="km/h"/></type><planView><geometry s="0" x="-200" y="7" hdg="0" length="600">'
        f"<line/></geometry></planView><lanes>{sections}</lanes></road></OpenDRIVE>"
    )
    for format_ in ("opendrive", "openscenario"):
        assert canonical(file_of(made, format_, "made.xodr")) == canonical(expected)


def exact(tag: str, value: float) -> str:
    return f"<{tag}><exact>{short(value)}</exact></{tag}>"


def point(x: float, y: float, tag: str = "point") -> str:
    return f"<{tag}><x>{short(x)}</x><y>{short(y)}</y></{tag}>"


def bound(tag: str, k: int, d: float, crossed: bool) -> str:
    low, high = ENDS[k], ENDS[k + 1]
    points = "".join(point(s, d) for s in (low, (low + high) / 2, high))
    return f"<{tag}>{points}<lineMarking>{'dashed' if crossed else 'solid'}</lineMarking></{tag}>"


def lanelets() -> Iterator[str]:
    """1001, 1002 | 1003, 1004, 1005 | 1006, 1007, from left to right in each section."""
    numbers = {
        (0, 0): 1001,
        (0, 1): 1002,
        (1, 0): 1003,
        (1, 1): 1004,
        (1, 2): 1005,
        (2, 0): 1006,
        (2, 1): 1007,
    }
    for (k, place), number in numbers.items():
        top = 7 - 3.5 * place
        before, after = (numbers.get((k + step, place)) for step in (-1, 1))
        left, right = numbers.get((k, place - 1)), numbers.get((k, place + 1))
        refs = f'<predecessor ref="{before}"/>' if before else ""
        refs += f'<successor ref="{after}"/>' if after else ""
        refs += f'<adjacentLeft ref="{left}" drivingDir="same"/>' if left else ""
        refs += f'<adjacentRight ref="{right}" drivingDir="same"/>' if right else ""
        kind = "accessRamp" if place == 2 else "mainCarriageWay"
        yield (
            f'<lanelet id="{number}">{bound("leftBound", k, top, bool(left))}'
            f"{bound('rightBound', k, top - 3.5, bool(right))}{refs}"
            f"<laneletType>highway</laneletType><laneletType>{kind}</laneletType></lanelet>"
        )


def middle(car: Car, t: float) -> tuple[float, float]:
    s, d, _, _ = car.at(t)
    return s - car.length / 2, d - car.width / 2


def obstacle(name: str, car: Car) -> str:
    states = []
    for step, t in enumerate(TIMES):
        _, _, speed, pull = car.at(t)
        tag = "state" if step else "initialState"
        states.append(
            f"<{tag}><position>{point(*middle(car, t))}</position>"
            f"{exact('orientation', 0)}{exact('time', step)}"
            f"{exact('velocity', speed)}{exact('velocityY', car.across)}{exact('acceleration', pull)}</{tag}>"
        )
    kind = {"SV": "motorcycle", "POV1": "truck", "POV2": "car"}[name]
    return (
        f'<dynamicObstacle id="{IDS[name]}"><type>{kind}</type><shape><rectangle><length>{short(car.length)}'
        f"</length><width>{short(car.width)}</width></rectangle></shape>{states[0]}"
        f"<trajectory>{''.join(states[1:])}</trajectory></dynamicObstacle>"
    )


def test_commonroad_has_every_element(made: Subject) -> None:
    car = CARS["SV"]
    problem = (
        f'<planningProblem id="9001"><initialState><position>{point(*middle(car, 0))}</position>'
        f"{exact('velocity', 30)}{exact('orientation', 0)}{exact('yawRate', 0)}{exact('slipAngle', 0)}"
        f"{exact('time', 0)}</initialState><goalState><time><intervalStart>4</intervalStart><intervalEnd>5"
        "</intervalEnd></time><position><rectangle><length>2.5</length><width>1.8</width><orientation>0"
        f"</orientation>{point(*middle(car, 2), tag='center')}</rectangle></position></goalState>"
        f"</planningProblem>"
    )
    expected = (
        '<commonRoad commonRoadVersion="2020a" benchmarkID="ZAM_Roadproof-3_1_T-1" date="1970-01-01" '
        'author="roadproof" affiliation="roadproof" source="true (base), 2 s, road merge, cut '
        "to s = -200 m to "
        '400 m" timeStepSize="0.5"><location><geoNameId>-999</geoNameId><gpsLatitude>999</gpsLatitude>'
        "<gpsLongitude>999</gpsLongitude></location><scenarioTags><highway/><simulated/></scenarioTags>"
        f"{''.join(lanelets())}{''.join(obstacle(x, each) for x, each in CARS.items())}{problem}</commonRoad>"
    )
    assert canonical(file_of(made, "commonroad", "made.xml")) == canonical(expected)


@pytest.mark.parametrize(
    ("kind", "size", "type_"),
    [
        (None, ("4.5", "1.8"), "car"),
        (None, ("7", "2"), "car"),
        (None, ("7.1", "2"), "truck"),
        (None, ("2.2", "1.2"), "motorcycle"),
        (None, ("2.2", "1.21"), "car"),
        ("car", ("2.2", "1"), "car"),
        ("car", ("9", "2"), "car"),
        ("truck", ("4", "2"), "truck"),
        ("bus", ("4", "2"), "bus"),
        ("motorcycle", ("4", "2"), "motorcycle"),
        ("other", ("4", "2"), "unknown"),
    ],
)
def test_types_follow_kinds_and_sizes(kind: str | None, size: tuple[str, str], type_: str) -> None:
    car = replace(motion((None, "0", "0"), size=size), kind=kind)
    text = file_of(subject(SV=car), "commonroad", "made.xml")
    assert ElementTree.fromstring(text).findtext("dynamicObstacle/type") == type_
    told = {"motorcycle": "motorbike", "unknown": "van"}
    text = file_of(subject(SV=car), "openscenario", "made.xosc")
    found = ElementTree.fromstring(text).find(".//Vehicle")
    assert found is not None
    if (kind, type_) != (None, "motorcycle"):  # sizes alone say that in CommonRoad only
        assert found.get("vehicleCategory") == told.get(type_, type_)
    rows = [*csv.DictReader(io.StringIO(file_of(subject(SV=car), "highd", "01_tracksMeta.csv")))]
    assert rows[0]["class"] == ("Truck" if type_ in ("truck", "bus") else "Car")


# --- tables ----------------------------------------------------------------------------------------


def rows_of(text: str) -> list[dict[str, str]]:
    return [*csv.DictReader(io.StringIO(text))]


def test_csv_has_every_column(made: Subject) -> None:
    rows = rows_of(file_of(made, "csv", "made.csv"))
    expected = []
    for t in TIMES:
        for name, car in CARS.items():
            s, d, speed, pull = car.at(t)
            numbers = (s, d, speed, car.across, pull, 0, car.length, car.width)
            columns = ("s", "d", "v_lon", "v_lat", "a_lon", "a_lat", "length", "width")
            kind = {"SV": "Motorcycle", "POV1": "Truck", "POV2": "Car"}[name]
            told = {column: short(x) for column, x in zip(columns, numbers, strict=True)}
            expected.append({"time": short(t), "vehicle": name, **told, "kind": kind})
    assert [
        {k: v if k in ("vehicle", "kind") else short(float(v)) for k, v in row.items()} for row in rows
    ] == (expected)


SHIFT_S, SHIFT_D = 34, -15
"""The rear of POV2 at time 0 (-24 m) is moved to 10 m, the left edge of the road (7 m) to y = 8 m."""


def lane_id(d: float) -> int:
    """Lanes 2 (empty, above), 4, 5 and 6, by the middle of the box."""
    return 4 if d > 3.5 else 5 if d > 0 else 6


def neighbours(name: str, t: float) -> dict[str, int]:
    """The nearest in the own lane and in those beside it, which overlap along the road or do not."""
    car = CARS[name]
    s, d, _, _ = car.at(t)
    own = lane_id(d - car.width / 2)
    found: dict[str, tuple[float, int]] = {}
    for other, x in CARS.items():
        place, across, _, _ = x.at(t)
        lane = lane_id(across - x.width / 2)
        side = {0: "", -1: "left", 1: "right"}.get(lane - own)
        if other == name or side is None:
            continue
        level = bool(side) and place > s - car.length and place - x.length < s
        where = "alongside" if level else "preceding" if place > s else "following"
        key = f"{side}{where.capitalize() if side else where}Id"
        if key not in found or abs(place - s) < found[key][0]:
            found[key] = abs(place - s), IDS[other]
    return {key: number for key, (_, number) in found.items()}


def test_highd_has_every_column_of_every_sample(made: Subject) -> None:
    rows = rows_of(file_of(made, "highd", "03_tracks.csv"))
    order = [(name, t) for name in CARS for t in TIMES]
    assert len(rows) == len(order)
    ends = [(car.at(t)[0] - car.length, car.at(t)[0]) for car in CARS.values() for t in TIMES]
    west, east = min(x for x, _ in ends), max(x for _, x in ends)
    names = dict(zip(IDS.values(), IDS, strict=True))
    for row, (name, t) in zip(rows, order, strict=True):
        car = CARS[name]
        s, d, speed, pull = car.at(t)
        near = neighbours(name, t)
        gap = thw = ttc = ahead = 0.0
        if "precedingId" in near:
            leader = CARS[names[near["precedingId"]]]
            gap, ahead = leader.at(t)[0] - leader.length - s, leader.at(t)[2]
            thw, ttc = gap / speed, gap / (speed - ahead) if speed != ahead else 0.0
        sides = ("left", "right")
        keys = [f"{x}{y}Id" for x in sides for y in ("Preceding", "Alongside", "Following")]
        expected = {
            "frame": TIMES.index(t) + 1,
            "id": IDS[name],
            "x": s - car.length + SHIFT_S,
            "y": -(d + SHIFT_D),
            "width": car.length,
            "height": car.width,
            "xVelocity": speed,
            "yVelocity": -car.across,
            "xAcceleration": pull,
            "yAcceleration": 0,
            "frontSightDistance": east - (s - car.length / 2),
            "backSightDistance": s - car.length / 2 - west,
            "dhw": gap,
            "thw": thw,
            "ttc": ttc,
            "precedingXVelocity": ahead,
            **{key: near.get(key, 0) for key in ("precedingId", "followingId", *keys)},
            "laneId": lane_id(d - car.width / 2),
        }
        assert list(row) == list(expected)
        assert {k: float(v) for k, v in row.items()} == pytest.approx(expected, abs=2e-9), (name, t)


def test_highd_has_every_column_of_every_vehicle(made: Subject) -> None:
    rows = rows_of(file_of(made, "highd", "03_tracksMeta.csv"))
    samples = rows_of(file_of(made, "highd", "03_tracks.csv"))
    for row, (name, car) in zip(rows, CARS.items(), strict=True):
        own = [x for x in samples if int(x["id"]) == IDS[name]]
        speeds = [car.at(t)[2] for t in TIMES]
        lanes = [x["laneId"] for x in own]

        def least(column: str, own: list[dict[str, str]] = own) -> float:
            known = [float(x[column]) for x in own if int(x["precedingId"]) and float(x[column]) > 0]
            return min(known, default=-1)

        numbers = {
            "id": IDS[name],
            "width": car.length,
            "height": car.width,
            "initialFrame": 1,
            "finalFrame": 5,
            "numFrames": 5,
            "drivingDirection": 2,
            "traveledDistance": car.at(2)[0] - car.s,
            "minXVelocity": min(speeds),
            "maxXVelocity": max(speeds),
            "meanXVelocity": sum(speeds) / 5,
            "minDHW": least("dhw"),
            "minTHW": least("thw"),
            "minTTC": least("ttc"),
            "numLaneChanges": sum(a != b for a, b in pairwise(lanes)),
        }
        assert row.pop("class") == ("Truck" if name == "POV1" else "Car")
        assert {k: float(v) for k, v in row.items()} == pytest.approx(numbers, abs=2e-9)


def test_highd_has_every_column_of_the_recording(made: Subject) -> None:
    (row,) = rows_of(file_of(made, "highd", "03_recordingMeta.csv"))
    distance = sum(car.at(2)[0] - car.s for car in CARS.values())
    markings = [";".join(f"{x:.9f}" for x in edges) for edges in ((0, 4), (8, 11.5, 15, 18.5))]
    assert (row.pop("upperLaneMarkings"), row.pop("lowerLaneMarkings")) == (*markings,)
    words = {"month": "1.2020", "weekDay": "Mon", "startTime": "12:00"}
    assert {x: row.pop(x) for x in words} == words
    assert {k: float(v) for k, v in row.items()} == pytest.approx(
        {
            "id": 3,
            "frameRate": 2,
            "locationId": 1,
            "speedLimit": -1,
            "duration": 2.5,
            "totalDrivenDistance": distance,
            "totalDrivenTime": 7.5,
            "numVehicles": 3,
            "numCars": 2,
            "numTrucks": 1,
        }
    )


@pytest.mark.parametrize(("format_", "shifts"), [("csv", (0, 0)), ("highd", (SHIFT_S, SHIFT_D))])
def test_road_files_have_every_lanelet(format_: str, shifts: tuple[int, int], made: Subject) -> None:
    name = {"csv": "made_road.toml", "highd": "03_road.toml"}[format_]
    along, across = shifts
    expected = ['name = "merge"\n']
    for lane, bottom in (("main-1", 0), ("main-2", 3.5), ("merge-1", -3.5)):
        for part, (low, high) in zip("abc", (("-inf", -100), (-100, 300), (300, "inf")), strict=True):
            ramp = lane == "merge-1"
            if ramp and part != "b":
                continue
            ends = [x if isinstance(x, str) else short(x + along) for x in (low, high)]
            expected.append(
                f'[[lanelet]]\nid = "{"r" if ramp else f"m{lane[-1]}{part}"}"\nlane = "{lane}"\n'
                f'zone = "{"merge" if part == "b" else "main"}"\nattribute = '
                f'"{"merge" if ramp else "main"}"\n'
                f"s = [{ends[0]}, {ends[1]}]\n"
                f"d = [{short(bottom + across)}, {short(bottom + 3.5 + across)}]\n"
            )
    assert file_of(made, format_, name) == "\n".join(expected)


@pytest.mark.parametrize("rate", [1, 10, 25, 64, 125, 512, 625, 1000])
def test_rates_whose_steps_are_decimals_are_exported(rate: int) -> None:
    """1/512 s has nine decimals, as many as files have."""
    file = subject(SV=motion((None, "0", "0"))).file
    assert subject_of("made", 1, file, rate).times[-1] == 4
    assert len(subject_of("made", 1, file, rate).times) == 4 * rate + 1


@pytest.mark.parametrize("rate", [0, -25, 3, 30, 1001, 1024, 2000])
def test_other_rates_are_refused(rate: int) -> None:
    with pytest.raises(UsageError, match=f"rate={rate}: write samples a second up to 1000"):
        subject_of("made", 1, subject(SV=motion((None, "0", "0"))).file, rate)


def test_a_bound_that_is_just_kept_needs_no_vertex_between() -> None:
    """Braking by 1 m/s² for a second is within an eighth of a metre, exactly."""
    braking = motion((None, "-1", "0"))
    assert len(polyline_of(braking, Fraction(1), 0.125).vertices) == 2
    assert len(polyline_of(braking, Fraction(1), 0.1249).vertices) == 3


@pytest.mark.parametrize(
    ("other", "plain"),
    [
        (Lanelet("b", "main-2", "main", "main", (None, None), (Fraction(4), Fraction(8))), True),
        (Lanelet("b", "main-2", "main", "main", (None, Fraction(900)), (Fraction(4), Fraction(8))), False),
        (Lanelet("b", "main-2", "main", "main", (Fraction(-900), None), (Fraction(4), Fraction(8))), False),
        (Lanelet("b", "main-2", "merge", "main", (None, None), (Fraction(4), Fraction(8))), False),
        (Lanelet("b", "ramp", "merge", "merge", (None, None), (Fraction(4), Fraction(8))), False),
    ],
)
def test_highd_has_a_road_file_where_markings_do_not_say_all(other: Lanelet, plain: bool) -> None:
    main = Lanelet("a", "main-1", "main", "main", (None, None), (Fraction(0), Fraction(4)))
    road = Road("other", (main, other), frozenset({frozenset({"main-1", other.lane})}))
    names = {*FORMATS["highd"](subject(road, SV=motion((None, "0", "0"))))}
    assert ("01_road.toml" in names) == (not plain)


def test_own_signals_are_columns_of_the_vehicles_that_have_them() -> None:
    """One of SV alone, and one of no vehicle, which is in the rows of all."""
    made = subject("main-2", "1", SV=motion((None, "0", "0")), POV=motion((None, "0", "0")))
    courses = {
        ("gaze", "SV"): ((Fraction(0), Fraction(2)), (Fraction(1), Fraction(3))),
        ("red", ""): ((Fraction(0), Fraction(1)),),
    }
    drive = replace(made.file.drive, own=courses)
    rows = rows_of(file_of(replace(made, file=replace(made.file, drive=drive), rate=2), "csv", "made.csv"))
    assert [*rows[0]][10:] == ["gaze", "red"]
    assert [(x["time"], x["vehicle"], x["gaze"], x["red"]) for x in rows] == [
        ("0", "SV", "2", "1"),
        ("0", "POV", "", "1"),
        ("0.5", "SV", "2", "1"),
        ("0.5", "POV", "", "1"),
        ("1", "SV", "3", "1"),
        ("1", "POV", "", "1"),
    ]


def test_accelerations_across_grow_to_the_left_and_in_highd_to_the_right() -> None:
    """A change of lane that begins and ends; y of highD grows down."""
    made = subject(SV=TURN)
    states = made.samples["SV"]
    expected = [float(x.a_lat) for x in states]
    assert {x > 0 for x in expected if x} == {True, False}
    ours = [float(x["a_lat"]) for x in rows_of(file_of(made, "csv", "made.csv"))]
    assert ours == pytest.approx(expected)
    for column, signal in (("yAcceleration", "a_lat"), ("yVelocity", "v_lat")):
        theirs = [-float(x[column]) for x in rows_of(file_of(made, "highd", "01_tracks.csv"))]
        assert theirs == pytest.approx([float(getattr(x, signal)) for x in states], abs=1e-8)
