"""Storyboards of OpenSCENARIO: motions worked out by hand, shapes integrated apart, and refusals."""

import math
from pathlib import Path

import numpy as np
import pytest

from extensions.traffic.board import (
    CAR,
    EGO,
    at,
    at_time,
    element_is,
    event,
    facing,
    first_time,
    init,
    lane,
    longitudinal,
    maneuver,
    of,
    put,
    rows,
    to_lane,
    to_speed,
    when,
)
from roadproof.errors import InputError
from roadproof.extensions.exchange.openscenario import read_recording, read_scenario
from roadproof.extensions.exchange.storyboard.expressions import expression_value, replace_parameters

# --- three motions by hand --------------------------------------------------------------------------


def test_braking_by_hand(tmp_path: Path) -> None:
    """From 20 m/s at 2 s with 4 m/s² to 8 m/s: 3 s, in which the car goes 42 m."""
    brake = event("brake", to_speed(8, "linear", "rate", 4), when(at_time(2)))
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", brake)))["Ego"]
    assert at(found, 0, "s") == pytest.approx(102)
    assert at(found, 2, "s") == pytest.approx(142)
    assert at(found, 3, "v_lon") == pytest.approx(16)
    assert at(found, 3, "a_lon") == pytest.approx(-4)
    assert at(found, 3, "s") == pytest.approx(142 + 18)
    assert at(found, 5, "s") == pytest.approx(142 + 42)
    assert at(found, 6, "s") == pytest.approx(142 + 42 + 8)
    assert at(found, 6, "d") == pytest.approx(-6 + 1)
    assert found["time"][-1] == pytest.approx(10)  # 5 s after all is complete


def test_a_cut_in_by_hand(tmp_path: Path) -> None:
    """The other car, 5 m/s faster, is 20 m ahead after 6 s: at a headway of 1 s it changes lane in 4 s."""
    headway = (
        '<TimeHeadwayCondition entityRef="Other" value="1" freespace="false" rule="greaterOrEqual" '
        'coordinateSystem="road" relativeDistanceType="longitudinal"/>'
    )
    change = event(
        "cut in", to_lane('<RelativeTargetLane entityRef="Ego" value="0"/>'), when(of("Ego", headway))
    )
    begin = {"Ego": EGO, "Other": init("Other", lane(-1, 90), 25)}
    found = rows(put(tmp_path, begin, maneuver("Other", change)))["Other"]
    assert at(found, 6, "s") == pytest.approx(90 + 150 + 2)
    assert at(found, 6, "d") == pytest.approx(-1)
    assert at(found, 7, "d") == pytest.approx(-1 - 4 * (3 / 16 - 2 / 64))
    assert at(found, 8, "d") == pytest.approx(-3)
    assert at(found, 8, "v_lat") == pytest.approx(-1.5)
    assert at(found, 7, "a_lat") == pytest.approx(-4 * (6 - 12 / 4) / 16)
    assert at(found, 10, "d") == pytest.approx(-5)
    assert at(found, 12, "v_lat") == 0


def test_events_in_a_row_by_hand(tmp_path: Path) -> None:
    """Accelerate at 50 m for 100 m, then, a second after the end of that, change lane over 60 m.

    50 m are gone at 2.5 s; 20 to 30 m/s over 100 m takes 4 s. The end is seen at 6.51 s, and with the delay
    the lane change begins at 7.51 s, 30 m/s: it takes 2 s.
    """
    gone = of("Ego", '<TraveledDistanceCondition value="49.999"/>')
    first = event("faster", to_speed(30, "linear", "distance", 100), when(gone))
    ended = when(element_is("event", "faster", "completeState"), delay=1)
    second = event("left", to_lane('<AbsoluteTargetLane value="-1"/>', "sinusoidal", "distance", 60), ended)
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", first, second)))["Ego"]
    assert at(found, 4.52, "v_lon") == pytest.approx(20 + 2.5 * (4.52 - 2.5), abs=1e-6)
    assert at(found, 6.52, "s") == pytest.approx(102 + 150 + 30 * 0.02)
    assert at(found, 7.48, "d") == pytest.approx(-5)
    assert at(found, 8.52, "d") == pytest.approx(-3, abs=4 * math.pi / 4 * 0.011)
    assert at(found, 9.52, "d") == pytest.approx(-1)


# --- each shape against an integration in steps -----------------------------------------------------

SHAPES = {
    "linear": lambda x: x,
    "cubic": lambda x: 3 * x**2 - 2 * x**3,
    "sinusoidal": lambda x: 0.5 - 0.5 * np.cos(np.pi * x),
}
STEEPEST = {"linear": 1.0, "cubic": 1.5, "sinusoidal": np.pi / 2}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("by", "value"), [("time", 3.0), ("rate", 2.0), ("distance", 60.0)])
def test_speeds_are_those_of_an_integration(shape: str, by: str, value: float, tmp_path: Path) -> None:
    change = event("slower", to_speed(11, shape, by, value), when(at_time(1)))
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", change)))["Ego"]
    duration = {"time": value, "rate": STEEPEST[shape] * 9 / 2, "distance": 2 * 60 / 31}[by]
    fine = np.linspace(0, found["time"][-1], 200_001)
    speed = 20 - 9 * SHAPES[shape](np.clip((fine - 1) / duration, 0, 1))
    way = np.concatenate(([0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(fine))))
    assert np.allclose(found["s"], 102 + np.interp(found["time"], fine, way), atol=1e-4)
    assert np.allclose(found["v_lon"], np.interp(found["time"], fine, speed), atol=1e-4)
    inside = (found["time"] > 1.1) & (found["time"] < 0.9 + duration)
    slope = np.interp(found["time"], fine, np.gradient(speed, fine))
    assert inside.sum() > 20
    assert np.allclose(found["a_lon"][inside], slope[inside], atol=1e-3)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("by", "value"), [("time", 3.0), ("rate", 1.6), ("distance", 70.0)])
def test_lane_changes_are_those_of_an_integration(shape: str, by: str, value: float, tmp_path: Path) -> None:
    """While the car brakes from 20 m/s with 1 m/s², so that distance is not time."""
    brake = event("brake", to_speed(5, "linear", "rate", 1), when(at_time(0)))
    change = event("change", to_lane('<AbsoluteTargetLane value="-3"/>', shape, by, value), when(at_time(1)))
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", brake, change)))["Ego"]
    time = found["time"]
    gone = 19 * (time - 1) - (time - 1) ** 2 / 2
    x = gone / 70 if by == "distance" else (time - 1) / (3 if by == "time" else STEEPEST[shape] * 4 / 1.6)
    before_end = time < 12
    expected = -5 - 4 * SHAPES[shape](np.clip(np.where(time < 1, 0, x), 0, 1))
    assert np.allclose(found["d"][before_end], expected[before_end], atol=1e-6)
    for place, rate in (("d", "v_lat"), ("v_lat", "a_lat")):
        smooth = (x > 0.05) & (x < 0.95)
        assert np.allclose(np.gradient(found[place], time)[smooth], found[rate][smooth], atol=0.02)


# --- actions that look at other vehicles ------------------------------------------------------------


def test_a_distance_is_kept_as_a_damped_spring_does(tmp_path: Path) -> None:
    """Against an integration of the same law in far smaller steps."""
    keep = longitudinal(
        '<LongitudinalDistanceAction entityRef="Ego" distance="30" freespace="true" continuous="true">'
        '<DynamicConstraints maxAcceleration="2" maxDeceleration="4" maxSpeed="40"/>'
        "</LongitudinalDistanceAction>"
    )
    stop = when(at_time(30), tag="StopTrigger")
    begin = {"Ego": EGO, "Other": init("Other", lane(-2, 40), 25)}
    path = put(tmp_path, begin, maneuver("Other", event("keep", keep, when(at_time(1)))), stop=stop)
    found = rows(path)["Other"]
    s, v, step, expected = 40.0, 25.0, 1e-4, {}
    for k in range(300_001):
        time = k * step
        expected[round(time, 4)] = s, v
        error, pull = (100 + 20 * time) - s - 34, 0.0
        if time >= 1:
            stiffness = 0.4 * (2 if error < 0 else 4)
            pull = min(max(error * stiffness - (v - 20) * 2 * math.sqrt(stiffness), -4), 2)
        s, v = s + v * step, v + pull * step
    there = np.array([expected[round(float(x), 4)] for x in found["time"]])
    assert np.allclose(found["s"] - 2, there[:, 0], atol=0.2)
    assert np.allclose(found["v_lon"], there[:, 1], atol=0.1)
    assert 100 + 20 * 30 - (found["s"][-1] - 2) == pytest.approx(34, abs=0.2)


@pytest.mark.parametrize(
    ("final", "speed"),
    [
        ('<AbsoluteSpeed value="12"/>', 12),
        ('<AbsoluteSpeed value="30"/>', 30),
        ('<RelativeSpeedToMaster value="-5" speedTargetValueType="delta"/>', 15),
        ('<RelativeSpeedToMaster value="0.5" speedTargetValueType="factor"/>', 10),
    ],
)
@pytest.mark.parametrize("place", [400, 210, 150])
def test_vehicles_arrive_at_the_same_time(final: str, speed: float, place: float, tmp_path: Path) -> None:
    """Ego is at s = 300 after 10 s; the other one begins at 100 with 18 m/s."""
    action = (
        '<PrivateAction><SynchronizeAction masterEntityRef="Ego"><TargetPositionMaster>'
        f"{lane(-2, 300)[10:-11]}</TargetPositionMaster><TargetPosition>{lane(-1, place)[10:-11]}"
        f"</TargetPosition><FinalSpeed>{final}</FinalSpeed></SynchronizeAction></PrivateAction>"
    )
    begin = {"Ego": EGO, "Other": init("Other", lane(-1, 100), 18)}
    found = rows(put(tmp_path, begin, maneuver("Other", event("meet", action, when(at_time(0))))))["Other"]
    assert at(found, 10, "s") == pytest.approx(place + 2, abs=0.05)
    assert at(found, 12, "v_lon") == pytest.approx(speed, abs=0.05)
    assert found["v_lon"].min() > -1e-6
    way = np.concatenate(([0], np.cumsum((found["v_lon"][1:] + found["v_lon"][:-1]) / 2 * 0.04)))
    assert np.allclose(found["s"] - found["s"][0], way, atol=0.02)


@pytest.mark.parametrize(
    "steady", ['<TargetTimeSteadyState time="2"/>', '<TargetDistanceSteadyState distance="36"/>']
)
def test_the_final_speed_may_be_reached_before(steady: str, tmp_path: Path) -> None:
    """18 m/s in the last 2 s, which are 36 m, before s = 260 at 10 s."""
    action = (
        '<PrivateAction><SynchronizeAction masterEntityRef="Ego"><TargetPositionMaster>'
        f"{lane(-2, 300)[10:-11]}</TargetPositionMaster><TargetPosition>{lane(-1, 260)[10:-11]}"
        f'</TargetPosition><FinalSpeed><AbsoluteSpeed value="18">{steady}</AbsoluteSpeed></FinalSpeed>'
        "</SynchronizeAction></PrivateAction>"
    )
    begin = {"Ego": EGO, "Other": init("Other", lane(-1, 100), 10)}
    found = rows(put(tmp_path, begin, maneuver("Other", event("meet", action, when(at_time(0))))))["Other"]
    last = (found["time"] > 8.05) & (found["time"] < 9.95)
    assert np.allclose(found["v_lon"][last], 18, atol=0.02)
    assert at(found, 8, "s") == pytest.approx(260 - 36 + 2, abs=0.05)
    assert at(found, 10, "s") == pytest.approx(262, abs=0.05)


def test_a_speed_profile(tmp_path: Path) -> None:
    """From 2 s on: to 30 m/s in 4 s, then to 10 m/s in 5 s, by hand."""
    entries = "".join(f'<SpeedProfileEntry speed="{v}" time="{t}"/>' for v, t in ((30, 4), (10, 5)))
    profile = longitudinal(f'<SpeedProfileAction followingMode="position">{entries}</SpeedProfileAction>')
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", event("go", profile, when(at_time(2))))))["Ego"]
    assert at(found, 4, "v_lon") == pytest.approx(25)
    assert at(found, 6, "s") == pytest.approx(102 + 40 + 100)
    assert at(found, 8, "a_lon") == pytest.approx(-4)
    assert at(found, 11, "s") == pytest.approx(102 + 40 + 100 + 100)
    assert at(found, 13, "v_lon") == pytest.approx(10)


def test_a_trajectory_within_a_story(tmp_path: Path) -> None:
    """Relative times: from 2 s to 6 s along s with 15 m/s and 1 m/s to the right; then on with that speed."""

    def vertex(k: int) -> str:
        s, d = 140 + 15 * k, -6 - k
        x, y = 30 + s * math.cos(0.3) - d * math.sin(0.3), 40 + s * math.sin(0.3) + d * math.cos(0.3)
        place = f'<Position><WorldPosition x="{x}" y="{y}" h="0.3"/></Position>'
        return f'<Vertex time="{k}">{place}</Vertex>'

    shape = f"<Shape><Polyline>{''.join(map(vertex, range(5)))}</Polyline></Shape>"
    follow = (
        "<PrivateAction><RoutingAction><FollowTrajectoryAction><TrajectoryRef>"
        f'<Trajectory name="t" closed="false">{shape}</Trajectory></TrajectoryRef><TimeReference><Timing '
        'domainAbsoluteRelative="relative" scale="1" offset="0"/></TimeReference><TrajectoryFollowingMode '
        'followingMode="position"/></FollowTrajectoryAction></RoutingAction></PrivateAction>'
    )
    begin = {"Ego": EGO, "Other": init("Other", lane(-1, 90), 25)}
    found = rows(put(tmp_path, begin, maneuver("Ego", event("go", follow, when(at_time(2))))))["Ego"]
    assert at(found, 4, "s") == pytest.approx(142 + 30, abs=1e-6)
    assert at(found, 4, "d") == pytest.approx(-5 - 2, abs=1e-6)
    assert at(found, 4, "v_lat") == pytest.approx(-1, abs=1e-6)
    assert at(found, 8, "s") == pytest.approx(142 + 60 + 2 * math.hypot(15, 1), abs=1e-6)
    assert at(found, 8, "d") == pytest.approx(-5 - 4, abs=1e-6)


@pytest.mark.parametrize(
    "place", ['<Position><WorldPosition x="80" y="40" h="3.4"/></Position>', facing(lane(-1, 400))]
)
def test_oncoming_vehicles_are_left_out(place: str, tmp_path: Path) -> None:
    found = read_scenario(put(tmp_path, {"Ego": EGO, "Other": init("Other", place, 10)}))
    assert set(found.table["vehicle"]) == {"Ego"}
    assert "left out, as they drive against the others: Other" in found.notes


def test_oncoming_vehicles_trigger_others(tmp_path: Path) -> None:
    """Ego brakes when the oncoming vehicle is 100 m ahead: from 320 m apart, after 5.6 s.

    The other one goes faster from 2 s to 4 s, in which it goes 40 m: 320 - 20 t = 30 + 40 + 25 (t - 4) + 100.
    """
    near = of(
        "Ego",
        '<RelativeDistanceCondition entityRef="Other" relativeDistanceType="longitudinal" value="100" '
        'freespace="false" rule="lessOrEqual"/>',
    )
    brake = event("brake", to_speed(10, "step"), when(near))
    speed = of("Other", '<SpeedCondition value="15" rule="greaterOrEqual"/>')
    faster = event("faster", to_speed(25, "linear", "time", 2), when(speed, delay=2))
    begin = {"Ego": EGO, "Other": init("Other", facing(lane(-1, 420)), 15)}
    found = rows(put(tmp_path, begin, maneuver("Ego", brake), maneuver("Other", faster)))["Ego"]
    changed = first_time(found, found["v_lon"] < 15)
    assert changed == pytest.approx(250 / 45, abs=0.051)


# --- what else is read ------------------------------------------------------------------------------


def test_vehicles_without_a_story_keep_their_state(tmp_path: Path) -> None:
    found = rows(put(tmp_path, {"Ego": EGO}))["Ego"]
    assert found["time"][-1] == pytest.approx(5)
    assert np.allclose(found["s"], 102 + 20 * found["time"])


@pytest.mark.parametrize(
    ("position", "s", "d"),
    [
        (lane(-1, 150), 150, -2),
        ('<Position><RoadPosition roadId="7" s="140" t="-5"/></Position>', 140, -5),
        ('<Position><RelativeLanePosition entityRef="Ego" dLane="1" ds="30"/></Position>', 130, -2),
        (
            '<Position><RelativeLanePosition entityRef="Ego" dLane="-1" ds="-30" offset="0.5"/></Position>',
            70,
            -9.5,
        ),
        ('<Position><RelativeRoadPosition entityRef="Ego" ds="8" dt="1"/></Position>', 108, -5),
    ],
)
@pytest.mark.parametrize("curve", ["<line/>", '<arc curvature="0.0025"/>'])
def test_positions(position: str, s: float, d: float, curve: str, tmp_path: Path) -> None:
    """Ego is at s = 100 in the second lane; the vehicle that refers to it comes first in the file."""
    begin = {"Other": init("Other", position, 0), "Ego": EGO}
    found = rows(put(tmp_path, begin, curve=curve))["Other"]
    assert at(found, 0, "s") == pytest.approx(s + 2, abs=1e-6)
    assert at(found, 0, "d") == pytest.approx(d + 1, abs=1e-6)


def test_world_positions(tmp_path: Path) -> None:
    x, y = 30 + 50 * math.cos(0.3) + 6 * math.sin(0.3), 40 + 50 * math.sin(0.3) - 6 * math.cos(0.3)
    place = f'<Position><WorldPosition x="{x}" y="{y}" z="0" h="0.3"/></Position>'
    found = rows(put(tmp_path, {"Ego": init("Ego", place, 3)}))["Ego"]
    assert at(found, 0, "s") == pytest.approx(52)
    assert at(found, 0, "d") == pytest.approx(-5)


def test_parameters_and_catalogues(tmp_path: Path) -> None:
    (tmp_path / "cars").mkdir()
    vehicle = CAR.replace('length="4"', 'length="$long"').replace(
        "<BoundingBox>",
        '<ParameterDeclarations><ParameterDeclaration name="long" parameterType="double" value="5"/>'
        "</ParameterDeclarations><BoundingBox>",
    )
    catalogue = f'<OpenSCENARIO><FileHeader/><Catalog name="cars">{vehicle}</Catalog></OpenSCENARIO>'
    (tmp_path / "cars/any.xosc").write_text(catalogue, "utf-8")
    more = (
        '<ParameterDeclarations><ParameterDeclaration name="kmh" parameterType="double" value="90"/>'
        '</ParameterDeclarations><CatalogLocations><VehicleCatalog><Directory path="cars"/></VehicleCatalog>'
        "</CatalogLocations>"
    )
    entity = (
        '<CatalogReference catalogName="cars" entryName="car"><ParameterAssignments>'
        '<ParameterAssignment parameterRef="$long" value="6"/></ParameterAssignments></CatalogReference>'
    )
    begin = {"Ego": init("Ego", lane(-2, 100), "${$kmh / 3.6}")}
    found = rows(put(tmp_path, begin, more=more, entity=entity))["Ego"]
    assert at(found, 0, "v_lon") == pytest.approx(25)
    assert at(found, 0, "s") == pytest.approx(103)
    with pytest.raises(InputError, match="no bus in a catalogue cars"):
        rows(put(tmp_path, begin, more=more, entity=entity.replace('"car"', '"bus"')))


def test_maneuvers_of_catalogues(tmp_path: Path) -> None:
    """The maneuver is called with another speed than its own."""
    (tmp_path / "cars").mkdir()
    go = event("go", to_speed("$v", "linear", "time", 2), when(at_time(1)))
    declared = '<ParameterDeclarations><ParameterDeclaration name="v" value="1"/></ParameterDeclarations>'
    catalogue = f'<Catalog name="all"><Maneuver name="m">{declared}{go}</Maneuver></Catalog>'
    (tmp_path / "cars/any.xosc").write_text(f"<OpenSCENARIO>{catalogue}</OpenSCENARIO>", "utf-8")
    more = '<CatalogLocations><ManeuverCatalog><Directory path="cars"/></ManeuverCatalog></CatalogLocations>'
    path = put(tmp_path, {"Ego": EGO}, maneuver("Ego"), more=more)
    reference = (
        '<CatalogReference catalogName="all" entryName="m"><ParameterAssignments><ParameterAssignment '
        'parameterRef="v" value="26"/></ParameterAssignments></CatalogReference>'
    )
    text = path.read_text("utf-8")
    path.write_text(text.replace('<Maneuver name="maneuver of Ego"></Maneuver>', reference), "utf-8")
    found = rows(path)["Ego"]
    assert at(found, 2, "v_lon") == pytest.approx(23)
    assert at(found, 4, "v_lon") == pytest.approx(26)
    with pytest.raises(InputError, match="this is a catalogue"):
        read_scenario(tmp_path / "cars/any.xosc")


def test_positions_on_roads_that_follow_each_other(tmp_path: Path) -> None:
    """Road 8 goes on where road 7 ends, after 2000 m; the order is found."""
    begin = {"Ego": EGO, "Other": init("Other", lane(-2, 50).replace('"7"', '"8"'), 10)}
    path = put(tmp_path, begin, hdg=0)
    text = (tmp_path / "map.xodr").read_text("utf-8")
    road = text[text.index("<road ") : text.index("</OpenDRIVE>")]
    other = road.replace('id="7"', 'id="8"').replace('x="30"', 'x="2030"')
    (tmp_path / "map.xodr").write_text(text.replace(road, other + road), "utf-8")
    found = rows(path)
    assert at(found["Ego"], 0, "s") == pytest.approx(102)
    assert at(found["Other"], 0, "s") == pytest.approx(2052)
    assert at(found["Other"], 4, "d") == pytest.approx(-5)
    (tmp_path / "map.xodr").write_text(text.replace(road, other.replace("2030", "2050") + road), "utf-8")
    with pytest.raises(InputError, match="that are not one route"):
        rows(path)


@pytest.mark.parametrize(
    ("text", "value"),
    [("2 + 3*4", 14), ("-(1 - 3) / 4", 0.5), ("pow(2, 3) % 5", 3), ("max(sqrt(16), round(2.5))", 4)],
)
def test_expressions(text: str, value: float) -> None:
    assert expression_value(text) == value
    assert float(replace_parameters(f"${{$a * ({text})}}", {"a": "2"})) == 2 * value


@pytest.mark.parametrize(
    "text", ["1 / 0", "__import__('os')", "9 ** 9", "a", "(" * 300, "pow(10, 400)", "1 if 1 else 2"]
)
def test_what_is_no_expression(text: str) -> None:
    with pytest.raises(ValueError, match=r"expression|supported|number"):
        expression_value(text)


def _misc_object(vehicle: str) -> str:
    return vehicle.replace("Vehicle", "MiscObject").replace(
        'vehicleCategory="car"', 'miscObjectCategory="obstacle"'
    )


def test_objects_that_are_no_vehicles_are_left_out(tmp_path: Path) -> None:
    begin = {"Ego": EGO, "Box": init("Box", lane(-2, 400), 0)}
    path = put(tmp_path, begin)
    text = path.read_text("utf-8")
    thing = f'<ScenarioObject name="Box">{CAR}'
    assert thing in text
    path.write_text(text.replace(thing, _misc_object(thing)), "utf-8")
    recording = read_recording(path)
    assert recording.vehicles == 1
    assert "left out, as they are no motor vehicles: Box" in recording.notes


def test_pedestrians_move_and_trigger(tmp_path: Path) -> None:
    """A pedestrian crosses 4 m with 2 m/s from 1 s on; Ego brakes when it is 1 m beside, at 2.5 s."""
    cross = event("go", to_lane('<AbsoluteTargetLane value="-2"/>', "linear", "rate", 2), when(at_time(1)))
    beside = of(
        "Ego",
        '<RelativeDistanceCondition entityRef="Man" relativeDistanceType="lateral" value="1" '
        'freespace="false" rule="lessOrEqual"/>',
    )
    brake = event("brake", to_speed(10, "step"), when(beside))
    begin = {"Ego": EGO, "Man": init("Man", lane(-3, 400), 0)}
    path = put(tmp_path, begin, maneuver("Man", cross), maneuver("Ego", brake))
    man = f'<ScenarioObject name="Man">{CAR}'
    text = path.read_text("utf-8")
    assert man in text
    path.write_text(text.replace(man, man.replace("Vehicle", "Pedestrian")), "utf-8")
    found = rows(path)
    assert set(found) == {"Ego"}
    changed = first_time(found["Ego"], found["Ego"]["v_lon"] < 15)
    assert changed == pytest.approx(2.5, abs=0.051)


def test_a_collision_ends_it(tmp_path: Path) -> None:
    """The gap of 46 m between boxes closes with 10 m/s."""
    hit = of("Ego", '<CollisionCondition><EntityRef entityRef="Other"/></CollisionCondition>')
    begin = {"Ego": EGO, "Other": init("Other", lane(-2, 150), 10)}
    found = rows(put(tmp_path, begin, stop=when(hit, tag="StopTrigger")))["Ego"]
    assert found["time"][-1] == pytest.approx(4.6, abs=0.05)


@pytest.mark.parametrize(
    ("condition", "time"),
    [
        (
            '<RelativeDistanceCondition entityRef="Other" relativeDistanceType="longitudinal" value="20" '
            'freespace="false" rule="lessThan"/>',
            3,
        ),
        (
            '<RelativeDistanceCondition entityRef="Other" relativeDistanceType="longitudinal" value="20" '
            'freespace="true" rule="lessThan"/>',
            2.6,
        ),
        ('<TimeHeadwayCondition entityRef="Other" value="2" freespace="false" rule="lessThan"/>', 1),
        (
            '<TimeToCollisionCondition value="1" freespace="true" rule="lessThan">'
            '<TimeToCollisionConditionTarget><EntityRef entityRef="Other"/></TimeToCollisionConditionTarget>'
            "</TimeToCollisionCondition>",
            3.6,
        ),
        (f'<ReachPositionCondition tolerance="2">{lane(-2, 182)}</ReachPositionCondition>', 4),
        (
            f'<DistanceCondition value="2" freespace="false" rule="lessThan">{lane(-2, 182)}'
            "</DistanceCondition>",
            4,
        ),
    ],
)
def test_triggers_fire_when_they_should(condition: str, time: float, tmp_path: Path) -> None:
    """Ego is 50 m behind and 10 m/s faster; by hand, the condition holds from ``time`` on."""
    brake = event("brake", to_speed(10, "step"), when(of("Ego", condition)))
    begin = {"Ego": EGO, "Other": init("Other", lane(-2, 150), 10)}
    found = rows(put(tmp_path, begin, maneuver("Ego", brake)))["Ego"]
    changed = first_time(found, found["v_lon"] < 15)
    assert changed == pytest.approx(time, abs=0.051)


@pytest.mark.parametrize(
    ("value", "rule", "time"), [(13, "greaterThan", 2.5), (13, "equalTo", 2.5), (6, "lessThan", 4)]
)
def test_a_relative_speed_triggers(value: float, rule: str, time: float, tmp_path: Path) -> None:
    """Ego is 10 m/s faster; the other one slows down by 2 m/s² from 1 s to 3 s, then speeds up by 8."""
    condition = f'<RelativeSpeedCondition entityRef="Other" value="{value}" rule="{rule}"/>'
    brake = event("brake", to_speed(10, "step"), when(of("Ego", condition)))
    slow = event("slow", to_speed(6, "linear", "time", 2), when(at_time(1)))
    fast = event("fast", to_speed(30, "linear", "rate", 8), when(at_time(3)))
    begin = {"Ego": EGO, "Other": init("Other", lane(-2, 250), 10)}
    found = rows(put(tmp_path, begin, maneuver("Ego", brake), maneuver("Other", slow, fast)))["Ego"]
    assert first_time(found, found["v_lon"] < 15) == pytest.approx(time, abs=0.06)


@pytest.mark.parametrize(
    ("priority", "speeds"), [("skip", (15, 10)), ("override", (15, 30)), ("parallel", (15, 30))]
)
def test_priorities(priority: str, speeds: tuple[float, float], tmp_path: Path) -> None:
    """A second event fires at 2.5 s, while the first one brakes with 2 m/s² from 0 to 5 s."""
    first = event("first", to_speed(10, "linear", "time", 5), when(at_time(0)))
    clock = of("Ego", '<TraveledDistanceCondition value="43.74"/>')
    second = event("second", to_speed(30, "step"), when(clock, "rising"), priority)
    found = rows(
        put(tmp_path, {"Ego": EGO}, maneuver("Ego", first, second), stop=when(at_time(8), tag="StopTrigger"))
    )
    assert at(found["Ego"], 2.48, "v_lon") == pytest.approx(speeds[0], abs=0.1)
    assert at(found["Ego"], 6, "v_lon") == pytest.approx(speeds[1])


def test_relative_speed_and_an_action_that_ends_another(tmp_path: Path) -> None:
    faster = (
        '<RelativeTargetSpeed entityRef="Ego" value="1.5" speedTargetValueType="factor" continuous="false"/>'
    )
    first = event("first", to_speed(0, "linear", "time", 10), when(at_time(0)))
    second = event("second", to_speed(0, "step", aim=faster), when(at_time(2)), "override")
    begin = {"Ego": EGO, "Other": init("Other", lane(-1, 90), 10)}
    found = rows(put(tmp_path, begin, maneuver("Other", first, second)))["Other"]
    assert at(found, 1.96, "v_lon") == pytest.approx(10 - 1.96)
    assert at(found, 2, "v_lon") == pytest.approx(30)
    assert at(found, 4, "s") == pytest.approx(92 + 18 + 60)


def test_a_transition_and_parameters_of_a_story(tmp_path: Path) -> None:
    """The act's start is seen one tick later; the story's parameter is beside that of the file."""
    start = when(element_is("act", "act", "startTransition"))
    go = event("go", to_speed("${$v + $w}"), start)
    declared = '<ParameterDeclarations><ParameterDeclaration name="{}" value="{}"/></ParameterDeclarations>'
    path = put(tmp_path, {"Ego": EGO}, maneuver("Ego", go), more=declared.format("v", 20))
    story = '<Story name="story">'
    path.write_text(path.read_text("utf-8").replace(story, story + declared.format("w", 5)), "utf-8")
    found = rows(path)["Ego"]
    assert at(found, 0, "v_lon") == pytest.approx(20)
    assert at(found, 0.04, "v_lon") == pytest.approx(25)


def test_a_stop_trigger_ends_it(tmp_path: Path) -> None:
    stop = when(of("Ego", '<SpeedCondition value="15" rule="lessThan"/>'), "rising", 0.5, "StopTrigger")
    brake = event("brake", to_speed(0, "linear", "rate", 5), when(at_time(1)))
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", brake), stop=stop))["Ego"]
    assert found["time"][-1] == pytest.approx(2.52 - 0.04, abs=0.041)


def test_it_is_read_as_a_recording(tmp_path: Path) -> None:
    recording = read_recording(put(tmp_path, {"Ego": EGO, "Other": init("Other", lane(-1, 90), 25)}))
    assert recording.vehicles == 2
    assert "the storyboard ends at 5 s: all is complete for 5 s" in recording.notes


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("SpeedAction>", "TrailerAction>", "TrailerAction: this action is not supported"),
        ("SimulationTimeCondition", "TimeOfDayCondition", "TimeOfDayCondition: this condition is not"),
        ('laneId="-2"', 'laneId="-5"', "road 7 has no lane -5 at s=100.00"),
        ('dynamicsShape="linear"', 'dynamicsShape="round"', "dynamicsShape=round: one of step, linear"),
        ('priority="parallel"', 'priority="first"', "priority=first: one of override"),
        ('roadId="7"', 'roadId="8"', "there is no road 8"),
        ("LanePosition", "GeoPosition", "GeoPosition: this kind of position is not supported"),
        ('<EntityRef entityRef="Ego"', '<EntityRef entityRef="No"', "there is no ScenarioObject No"),
        ("TeleportAction>", "AppearanceAction>", "no motor vehicle is on the road: left out"),
        ('value="8"', 'value="$v"', "there is no parameter v"),
        ('rule="greaterOrEqual"', 'rule="near"', "rule=near: one of"),
    ],
)
def test_refusals_name_the_element(old: str, new: str, told: str, tmp_path: Path) -> None:
    brake = event("brake", to_speed(8, "linear", "rate", 4), when(at_time(2)))
    path = put(tmp_path, {"Ego": EGO}, maneuver("Ego", brake))
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    with pytest.raises(InputError) as error:
        rows(path)
    assert told in str(error.value)
