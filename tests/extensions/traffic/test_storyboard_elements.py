"""Further elements of storyboards: places, trajectories, distances across, values, routes."""

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
    first_time,
    init,
    lane,
    longitudinal,
    maneuver,
    of,
    put,
    rows,
    target,
    to_lane,
    to_speed,
    when,
)
from roadproof.errors import InputError
from roadproof.extensions.exchange.openscenario import read_recording, read_scenario

END = when(at_time(12), tag="StopTrigger")


def lateral(action: str) -> str:
    return f"<PrivateAction><LateralAction>{action}</LateralAction></PrivateAction>"


def teleport(position: str) -> str:
    return f"<PrivateAction><TeleportAction>{position}</TeleportAction></PrivateAction>"


def follow(shape: str, time: str = "<None/>", mode: str = "position") -> str:
    return (
        '<PrivateAction><RoutingAction><FollowTrajectoryAction><TrajectoryRef><Trajectory name="t" '
        f'closed="false"><Shape>{shape}</Shape></Trajectory></TrajectoryRef><TimeReference>{time}'
        f'</TimeReference><TrajectoryFollowingMode followingMode="{mode}"/></FollowTrajectoryAction>'
        "</RoutingAction></PrivateAction>"
    )


TIMED = '<Timing domainAbsoluteRelative="relative" scale="1" offset="0"/>'

# --- places -----------------------------------------------------------------------------------------


def test_a_place_on_a_route(tmp_path: Path) -> None:
    """80 m behind the waypoint at s = 100, in the third lane and 0.5 m to its left."""
    inside = '<FromLaneCoordinates pathS="80" laneId="-3" laneOffset="0.5"/>'
    route = f'<Route name="r"><Waypoint routeStrategy="shortest">{lane(-2, 100)}</Waypoint></Route>'
    place = (
        f"<Position><RoutePosition><RouteRef>{route}</RouteRef><InRoutePosition>{inside}</InRoutePosition>"
        "</RoutePosition></Position>"
    )
    found = rows(put(tmp_path, {"Ego": EGO, "Other": init("Other", place, 10)}))["Other"]
    assert at(found, 0, "s") == pytest.approx(182)
    assert at(found, 0, "d") == pytest.approx(-9.5 + 1)


def test_a_place_beside_another_in_the_plane(tmp_path: Path) -> None:
    """30 m towards x and 10 m towards y, on a road that is turned by 0.3."""
    place = '<Position><RelativeWorldPosition entityRef="Ego" dx="30" dy="10" dz="0"/></Position>'
    found = rows(put(tmp_path, {"Ego": EGO, "Other": init("Other", place, 10)}))["Other"]
    assert at(found, 0, "s") == pytest.approx(102 + 30 * math.cos(0.3) + 10 * math.sin(0.3))
    assert at(found, 0, "d") == pytest.approx(-5 - 30 * math.sin(0.3) + 10 * math.cos(0.3))


def test_after_a_jump_it_is_another_vehicle(tmp_path: Path) -> None:
    jump = event("jump", teleport(lane(-1, 400)), when(at_time(3)))
    begin = {"Ego": EGO, "Other": init("Other", lane(-3, 50), 10)}
    path = put(tmp_path, begin, maneuver("Other", jump), stop=END)
    found = rows(path)
    assert set(found) == {"Ego", "Other", "Other (2)"}
    assert found["Other"]["time"][-1] == pytest.approx(2.96)
    assert at(found["Other (2)"], 3, "s") == pytest.approx(402)
    assert at(found["Other (2)"], 5, "s") == pytest.approx(422)
    assert at(found["Other (2)"], 5, "d") == pytest.approx(-1)
    assert read_recording(path).vehicles == 3


def test_vehicles_come_and_go(tmp_path: Path) -> None:
    def entity(kind: str) -> str:
        return f'<GlobalAction><EntityAction entityRef="Other">{kind}</EntityAction></GlobalAction>'

    come = event("come", entity(f"<AddEntityAction>{lane(-1, 300)}</AddEntityAction>"), when(at_time(2)))
    go = event("go", entity("<DeleteEntityAction/>"), when(at_time(6)))
    faster = event("faster", to_speed(12), when(at_time(3)))
    late = maneuver("Other", come, go, faster)
    found = rows(put(tmp_path, {"Ego": EGO, "Other": ""}, late, stop=END))["Other"]
    assert (found["time"][0], found["time"][-1]) == pytest.approx((2, 5.96))
    assert at(found, 5, "s") == pytest.approx(302 + 24)


# --- trajectories -----------------------------------------------------------------------------------


def test_a_polyline_without_times(tmp_path: Path) -> None:
    """From s = 120 straight on to 200 and then by 30 m along and 4 m to the left; speed is that on the path.

    The car brakes from 20 to 10 m/s with 5 m/s² at 5 s, where it comes to the corner.
    """

    def vertex(s: float, lane_id: int) -> str:
        return f"<Vertex>{lane(lane_id, s)}</Vertex>"

    shape = f"<Polyline>{vertex(120, -2)}{vertex(200, -2)}{vertex(230, -1)}</Polyline>"
    go = event("go", follow(shape), when(at_time(1)))
    brake = event("brake", to_speed(10, "linear", "time", 2), when(at_time(5)))
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", go, brake), stop=END))["Ego"]
    length = math.hypot(30, 4)
    assert at(found, 2, "d") == pytest.approx(-5)
    assert at(found, 5, "s") == pytest.approx(202)
    assert at(found, 6, "s") == pytest.approx(202 + 17.5 * 30 / length)
    assert at(found, 6, "d") == pytest.approx(-5 + 17.5 * 4 / length)
    assert at(found, 6, "v_lon") == pytest.approx(15 * 30 / length)
    assert at(found, 6, "v_lat") == pytest.approx(15 * 4 / length)
    assert at(found, 6, "a_lat") == pytest.approx(-5 * 4 / length)
    assert at(found, 12, "d") == pytest.approx(-1)
    assert at(found, 12, "s") == pytest.approx(232 + (30 + 50 - length), abs=1e-6)


def test_a_pedestrian_crosses_on_a_path(tmp_path: Path) -> None:
    """8 m across with 2 m/s from 1 s on, and Ego brakes when it is on the other side, at 5 s."""
    places = "".join(f"<Vertex>{lane(k, 400)}</Vertex>" for k in (-3, -1))
    shape = f"<Polyline>{places}</Polyline>"
    events = event("walk", to_speed(2), when(at_time(1))), event("cross", follow(shape), when(at_time(1)))
    ended = when(element_is("event", "cross", "completeState"))
    brake = event("brake", to_speed(10, "step"), ended)
    begin = {"Ego": EGO, "Man": init("Man", lane(-3, 400), 0)}
    path = put(tmp_path, begin, maneuver("Man", *events), maneuver("Ego", brake), stop=END)
    man = f'<ScenarioObject name="Man">{CAR}'
    text = path.read_text("utf-8")
    path.write_text(text.replace(man, man.replace("Vehicle", "Pedestrian")), "utf-8")
    found = rows(path)["Ego"]
    assert first_time(found, found["v_lon"] < 15) == pytest.approx(1 + 4, abs=0.06)


def test_a_clothoid_is_that_of_an_integration(tmp_path: Path) -> None:
    """From the car's place along the road, on a bend of its own; integrated in steps of 1 mm."""
    shape = (
        '<Clothoid curvature="0.001" curvaturePrime="-0.00004" length="80" startTime="0" stopTime="4">'
        '<Position><RelativeObjectPosition entityRef="Ego" dx="0" dy="0"/></Position></Clothoid>'
    )
    go = event("go", follow(shape, TIMED), when(at_time(2)))
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", go), stop=END))["Ego"]
    way = np.arange(0, 80.001, 0.001)
    heading = 0.001 * way - 0.00002 * way**2
    s = 140 + np.concatenate(([0], np.cumsum(np.cos(heading[:-1] + np.diff(heading) / 2) * 0.001)))
    d = -6 + np.concatenate(([0], np.cumsum(np.sin(heading[:-1] + np.diff(heading) / 2) * 0.001)))
    inside = (found["time"] >= 2) & (found["time"] <= 6)
    gone = 20 * (found["time"][inside] - 2)
    assert inside.sum() > 90
    assert np.allclose(found["s"][inside] - 2, np.interp(gone, way, s), atol=2e-3)
    assert np.allclose(found["d"][inside] - 1, np.interp(gone, way, d), atol=2e-3)


def test_a_spline_of_clothoids_ends_where_its_arcs_do(tmp_path: Path) -> None:
    """Two arcs of radius 200 m and 40 m, to the left and to the right: 400 (1 - cos 0.2) m aside."""
    pieces = "".join(
        f'<ClothoidSplineSegment curvatureStart="{k}" curvatureEnd="{k}" length="40">{start}'
        "</ClothoidSplineSegment>"
        for k, start in (
            (
                0.005,
                '<PositionStart><RelativeObjectPosition entityRef="Ego" dx="0" dy="0"/></PositionStart>',
            ),
            (-0.005, ""),
        )
    )
    go = event("go", follow(f"<ClothoidSpline>{pieces}</ClothoidSpline>"), when(at_time(1)))
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", go), stop=END))["Ego"]
    assert at(found, 10, "d") == pytest.approx(-5 + 400 * (1 - math.cos(0.2)), abs=1e-3)
    assert at(found, 10, "s") == pytest.approx(302 - 80 + 400 * math.sin(0.2), abs=1e-3)


def test_a_nurbs_may_be_a_circle(tmp_path: Path) -> None:
    """An eighth of a circle of radius 20 m, which a NURBS of order 3 is exactly."""
    angle = math.pi / 4

    def control(x: float, y: float, weight: float, time: float) -> str:
        place = f'<RelativeObjectPosition entityRef="Ego" dx="{x}" dy="{y}"/>'
        return f'<ControlPoint time="{time}" weight="{weight}"><Position>{place}</Position></ControlPoint>'

    middle = 20 * math.tan(angle / 2)
    end = 20 * math.sin(angle), 20 * (1 - math.cos(angle))
    points = control(0, 0, 1, 0) + control(middle, 0, math.cos(angle / 2), 1) + control(*end, 1, 2)
    knots = "".join(f'<Knot value="{x}"/>' for x in (0, 0, 0, 1, 1, 1))
    shape = f'<Nurbs order="3">{points}{knots}</Nurbs>'
    slow = init("Ego", lane(-3, 100), 8)
    go = event("go", follow(shape, TIMED), when(at_time(2)))
    found = rows(put(tmp_path, {"Ego": slow}, maneuver("Ego", go), stop=END))["Ego"]
    inside = (found["time"] >= 2) & (found["time"] <= 4)
    s, d = found["s"][inside] - 2 - 116, found["d"][inside] - 1 + 10
    assert np.allclose(np.hypot(s, d - 20), 20, atol=5e-3)
    assert (s[-1], d[-1]) == pytest.approx(end, abs=5e-3)


def test_a_trajectory_may_put_a_vehicle_on_the_road(tmp_path: Path) -> None:
    shape = "".join(f'<Vertex time="{k}">{lane(-1, 60 + 12 * k)}</Vertex>' for k in range(6))
    go = event("go", follow(f"<Polyline>{shape}</Polyline>", TIMED, "follow"), when(at_time(0)))
    path = put(tmp_path, {"Ego": EGO, "Other": ""}, maneuver("Other", go), stop=END)
    found = rows(path)["Other"]
    assert at(found, 3, "s") == pytest.approx(98)
    assert any("followingMode=follow is taken as position" in x for x in read_scenario(path).notes)


# --- distances --------------------------------------------------------------------------------------


SIDES = [("leftToReferencedEntity", -1.5), ("rightToReferencedEntity", -10.5)]


@pytest.mark.parametrize(("side", "d"), SIDES)
def test_a_distance_across_is_reached_as_a_spring_does(side: str, d: float, tmp_path: Path) -> None:
    """Against an integration in steps of 0.1 ms: stiffness 0.4 times 2, damped critically, jerk up to 1."""
    keep = lateral(
        f'<LateralDistanceAction entityRef="Ego" distance="2.5" freespace="true" continuous="true" '
        f'displacement="{side}"><DynamicConstraints maxAcceleration="2" maxSpeed="3" '
        'maxAccelerationRate="1" maxDecelerationRate="1"/></LateralDistanceAction>'
    )
    begin = {"Ego": EGO, "Other": init("Other", lane(-2, 40), 25)}
    path = put(tmp_path, begin, maneuver("Other", event("keep", keep, when(at_time(1)))), stop=END)
    found = rows(path)["Other"]
    place, v, a, step, expected = -6.0, 0.0, 0.0, 1e-4, {}
    for k in range(120_001):
        expected[k] = place
        if k * step >= 1:
            pull = min(max((d - place) * 0.8 - v * 2 * math.sqrt(0.8), -2), 2)
            if pull < min(a, 0):
                pull = max(pull, a - step)
            elif pull > max(a, 0):
                pull = min(pull, a + step)
            a = pull
        place, v = place + v * step, v + a * step
    there = np.array([expected[round(float(x) / step)] for x in found["time"]])
    assert np.allclose(found["d"] - 1, there, atol=0.06)
    assert found["d"][-1] == pytest.approx(d + 1, abs=0.05)


def test_jerk_is_limited(tmp_path: Path) -> None:
    keep = longitudinal(
        '<LongitudinalDistanceAction entityRef="Ego" distance="30" freespace="false" continuous="true">'
        '<DynamicConstraints maxAcceleration="3" maxDeceleration="3" maxSpeed="50" maxAccelerationRate="0.5" '
        'maxDecelerationRate="0.5"/></LongitudinalDistanceAction>'
    )
    begin = {"Ego": EGO, "Other": init("Other", lane(-1, 40), 20)}
    path = put(tmp_path, begin, maneuver("Other", event("keep", keep, when(at_time(1)))), stop=END)
    found = rows(path)["Other"]
    assert at(found, 2, "a_lon") == pytest.approx(0.5, abs=0.02)
    assert at(found, 3, "a_lon") == pytest.approx(1, abs=0.02)
    assert at(found, 3, "v_lon") == pytest.approx(21, abs=0.05)


# --- values and conditions --------------------------------------------------------------------------


def test_a_variable_triggers(tmp_path: Path) -> None:
    """It is 2 at first; after a product at 1 s and a sum at 2 s it is 7."""
    more = (
        '<VariableDeclarations><VariableDeclaration name="n" variableType="double" value="2"/>'
        "</VariableDeclarations>"
    )

    def change(rule: str) -> str:
        inside = f"<ModifyAction><Rule>{rule}</Rule></ModifyAction>"
        return f'<GlobalAction><VariableAction variableRef="n">{inside}</VariableAction></GlobalAction>'

    seven = (
        '<ByValueCondition><VariableCondition variableRef="n" value="7" rule="equalTo"/></ByValueCondition>'
    )
    events = (
        event("times", change('<MultiplyByValue value="3"/>'), when(at_time(1))),
        event("plus", change('<AddValue value="1"/>'), when(at_time(2))),
        event("brake", to_speed(10), when(seven)),
    )
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", *events), more=more, stop=END))["Ego"]
    changed = first_time(found, found["v_lon"] < 15)
    assert changed == pytest.approx(2.04, abs=0.041)


def test_parameters_may_be_texts(tmp_path: Path) -> None:
    more = '<ParameterDeclarations><ParameterDeclaration name="go" value="no"/></ParameterDeclarations>'
    act = (
        '<GlobalAction><ParameterAction parameterRef="go"><SetAction value="yes"/></ParameterAction>'
        "</GlobalAction>"
    )
    yes = '<ParameterCondition parameterRef="go" value="yes" rule="equalTo"/>'
    said = f"<ByValueCondition>{yes}</ByValueCondition>"
    events = event("set", act, when(at_time(3))), event("brake", to_speed(10), when(said))
    path = put(tmp_path, {"Ego": EGO}, maneuver("Ego", *events), more=more, stop=END)
    found = rows(path)["Ego"]
    assert first_time(found, found["v_lon"] < 15) == pytest.approx(3.04, abs=0.041)
    path.write_text(path.read_text("utf-8").replace('rule="equalTo"', 'rule="lessThan"'), "utf-8")
    with pytest.raises(InputError, match="ParameterCondition: rule=lessThan: no or yes is no number"):
        rows(path)


def test_beside_the_road(tmp_path: Path) -> None:
    """To the right with 2 m/s from 1 s on: off all lanes after 3 m, and for a second at 3.5 s."""
    aside = lateral(
        '<LaneOffsetAction continuous="false"><LaneOffsetActionDynamics dynamicsShape="linear" '
        f'maxLateralAcc="{6 * 8 / 16}"/><LaneOffsetTarget><AbsoluteTargetLaneOffset value="-8"/>'
        "</LaneOffsetTarget></LaneOffsetAction>"
    )
    off = when(of("Ego", '<OffroadCondition duration="1"/>'))
    events = event("aside", aside, when(at_time(1))), event("brake", to_speed(10), off)
    begin = {"Ego": init("Ego", lane(-3, 100), 20)}
    found = rows(put(tmp_path, begin, maneuver("Ego", *events), stop=END))["Ego"]
    assert first_time(found, found["v_lon"] < 15) == pytest.approx(1 + 1 + 1, abs=0.06)


@pytest.mark.parametrize(("direction", "time"), [("longitudinal", 4), ("lateral", 2)])
def test_speeds_in_a_direction(direction: str, time: float, tmp_path: Path) -> None:
    condition = of("Ego", f'<AccelerationCondition value="0.9" rule="greaterThan" direction="{direction}"/>')
    events = (
        event("change", to_lane('<AbsoluteTargetLane value="-1"/>', "cubic", "time", 4), when(at_time(2))),
        event("faster", to_speed(26, "linear", "rate", 1), when(at_time(4))),
    )
    stop = when(condition, tag="StopTrigger")
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", *events), stop=stop))["Ego"]
    assert found["time"][-1] == pytest.approx(time, abs=0.05)


# --- conventions of other tools ---------------------------------------------------------------------


def test_maps_and_places_of_carla(tmp_path: Path) -> None:
    """CARLA names a map without its ending, and its y points to the right."""
    x, y = 30 + 50 * math.cos(0.3) + 6 * math.sin(0.3), 40 + 50 * math.sin(0.3) - 6 * math.cos(0.3)
    place = f'<Position><WorldPosition x="{x}" y="{-y}" z="0" h="-0.3"/></Position>'
    path = put(tmp_path, {"Ego": init("Ego", place, 3)})
    header = '<FileHeader revMajor="1" revMinor="2"'
    text = path.read_text("utf-8").replace(header, f'{header} description="CARLA:test"')
    path.write_text(text.replace("map.xodr", "map"), "utf-8")
    found = rows(path)["Ego"]
    assert at(found, 0, "s") == pytest.approx(52)
    assert at(found, 0, "d") == pytest.approx(-5)


def test_numbers_and_polynomials_of_maps(tmp_path: Path) -> None:
    """Exponents of three digits, and of two polynomials at one s the last one."""
    path = put(tmp_path, {"Ego": EGO})
    text = (tmp_path / "map.xodr").read_text("utf-8")
    width = '<width sOffset="0" a="4"'
    twice = text.replace(width, f'<width sOffset="0" a="3" b="0" c="0" d="0"/>{width}', 1)
    (tmp_path / "map.xodr").write_text(twice.replace('length="2000"', 'length="2.0e+003"'), "utf-8")
    assert at(rows(path)["Ego"], 0, "d") == pytest.approx(-5)


def test_a_route_through_a_junction(tmp_path: Path) -> None:
    """From road 7 through a road of a junction to road 9, 20 m further; the route is found by the links."""
    begin = {"Ego": EGO, "Other": init("Other", lane(-2, 50).replace('"7"', '"9"'), 10)}
    path = put(tmp_path, begin, hdg=0)
    text = (tmp_path / "map.xodr").read_text("utf-8")
    road = text[text.index("<road ") : text.index("</OpenDRIVE>")]

    def of_map(name: int, x: float, length: float, links: str) -> str:
        made = road.replace('id="7"', f'id="{name}"').replace('x="30"', f'x="{x}"')
        return made.replace("2000", f"{length}").replace("<planView>", f"<link>{links}</link><planView>")

    before = '<predecessor elementType="road" elementId="7" contactPoint="end"/>'
    after = '<successor elementType="road" elementId="9" contactPoint="start"/>'
    crossing = of_map(8, 2030, 20, before + after).replace('junction="-1"', 'junction="5"')
    first = of_map(7, 30, 2000, '<successor elementType="junction" elementId="5"/>')
    last = of_map(9, 2050, 500, '<predecessor elementType="junction" elementId="5"/>')
    (tmp_path / "map.xodr").write_text(text.replace(road, last + crossing + first), "utf-8")
    found = rows(path)
    assert at(found["Other"], 0, "s") == pytest.approx(2072)
    assert at(found["Ego"], 0, "s") == pytest.approx(102)


@pytest.mark.parametrize(
    ("action", "told"),
    [
        ("<UserDefinedAction><CustomCommandAction/></UserDefinedAction>", "UserDefinedAction: this action"),
        (
            "<GlobalAction><TrafficAction><TrafficSwarmAction/></TrafficAction></GlobalAction>",
            "Action go action/GlobalAction/TrafficAction: this action is not supported",
        ),
        (follow("<Bezier/>"), "Shape/Bezier: one of Polyline, Clothoid"),
        (follow(f"<Polyline><Vertex>{lane(-1, 9)}</Vertex></Polyline>"), "at least two vertices"),
        (to_speed(0, aim=target(1).replace("Absolute", "Wrong")), "WrongTargetSpeed: this target"),
        (lateral("<LaneChangeAction/>"), "LaneChangeTarget is needed"),
    ],
)
def test_refusals_name_the_path(action: str, told: str, tmp_path: Path) -> None:
    path = put(tmp_path, {"Ego": EGO}, maneuver("Ego", event("go", action, when(at_time(1)))))
    with pytest.raises(InputError) as error:
        rows(path)
    assert told in str(error.value)
    assert "Event go/Action go action" in str(error.value)


def test_an_object_needs_a_box_only_where_it_is_a_vehicle(tmp_path: Path) -> None:
    path = put(tmp_path, {"Ego": EGO, "Thing": init("Thing", lane(-1, 500), 0)})
    thing = f'<ScenarioObject name="Thing">{CAR}'
    outside = '<ScenarioObject name="Thing"><ExternalObjectReference name="x"/>'
    text = path.read_text("utf-8")
    assert thing in text
    path.write_text(text.replace(thing, outside), "utf-8")
    assert set(rows(path)) == {"Ego"}


def test_a_road_goes_on_where_its_links_lead(tmp_path: Path) -> None:
    """The car begins 60 m before the end of road 7; road 9 goes on straight, road 8 turns away."""
    path = put(tmp_path, {"Ego": init("Ego", lane(-2, 1940), 20)}, hdg=0, stop=END)
    text = (tmp_path / "map.xodr").read_text("utf-8")
    road = text[text.index("<road ") : text.index("</OpenDRIVE>")]
    ahead = '<link><successor elementType="junction" elementId="5"/></link><planView>'
    before = '<link><predecessor elementType="road" elementId="7" contactPoint="end"/></link><planView>'
    inside = road.replace('x="30"', 'x="2030"').replace("<planView>", before)
    inside = inside.replace('junction="-1"', 'junction="5"').replace("2000", "300")
    turning = inside.replace('id="7" length', 'id="8" length').replace("<line/>", '<arc curvature="0.01"/>')
    straight = inside.replace('id="7" length', 'id="9" length')
    roads = turning + straight + road.replace("<planView>", ahead)
    (tmp_path / "map.xodr").write_text(text.replace(road, roads), "utf-8")
    found = rows(path)["Ego"]
    assert found["time"][-1] == pytest.approx(12)
    assert at(found, 12, "s") == pytest.approx(1942 + 240)
    assert at(found, 12, "d") == pytest.approx(-5)


def test_a_lane_change_at_once_is_a_jump(tmp_path: Path) -> None:
    change = event("jump", to_lane('<AbsoluteTargetLane value="-1"/>', "step"), when(at_time(4)))
    path = put(tmp_path, {"Ego": EGO}, maneuver("Ego", change), stop=END)
    assert read_recording(path).vehicles == 2
    assert at(rows(path)["Ego (2)"], 5, "s") == pytest.approx(202)


def test_criteria_of_carla_are_no_conditions(tmp_path: Path) -> None:
    value = '<ParameterCondition parameterRef="" value="" rule="lessThan"/>'
    criterion = f"<ByValueCondition>{value}</ByValueCondition>"
    stop = when(criterion, tag="StopTrigger").replace('name="c"', 'name="criteria_CollisionTest"')
    clock = when(at_time(3), tag="StopTrigger").removeprefix("<StopTrigger>")
    path = put(tmp_path, {"Ego": EGO}, stop=stop.replace("</StopTrigger>", clock))
    assert rows(path)["Ego"]["time"][-1] == pytest.approx(3)


@pytest.mark.parametrize(("free", "time"), [("false", 3), ("true", 3.4)])
def test_a_lane_is_clear(free: str, time: float, tmp_path: Path) -> None:
    """Ego, 10 m/s faster, passes a vehicle that is 10 m ahead on its left: clear when it is 20 m behind.

    Between boxes of 4 m that is when the reference points are 24 m apart.
    """
    clear = (
        f'<RelativeClearanceCondition distanceForward="30" distanceBackward="20" freeSpace="{free}" '
        'oppositeLanes="false"><RelativeLaneRange from="1" to="1"/></RelativeClearanceCondition>'
    )
    change = event("left", to_speed(35, "step"), when(of("Ego", clear)))
    begin = {"Ego": EGO, "Other": init("Other", lane(-1, 110), 10), "Third": init("Third", lane(-3, 105), 20)}
    found = rows(put(tmp_path, begin, maneuver("Ego", change), stop=END))["Ego"]
    assert first_time(found, found["v_lon"] > 30) == pytest.approx(time, abs=0.051)


def test_there_must_be_a_lane_to_be_clear(tmp_path: Path) -> None:
    clear = (
        '<RelativeClearanceCondition distanceForward="30" distanceBackward="20" freeSpace="false" '
        'oppositeLanes="false"><RelativeLaneRange from="2" to="3"/></RelativeClearanceCondition>'
    )
    change = event("left", to_speed(35, "step"), when(of("Ego", clear)))
    found = rows(put(tmp_path, {"Ego": EGO}, maneuver("Ego", change), stop=END))["Ego"]
    assert found["v_lon"].max() == pytest.approx(20)


def test_a_collision_with_any_vehicle(tmp_path: Path) -> None:
    """The gap of 46 m between boxes closes with 10 m/s."""
    hit = of("Ego", '<CollisionCondition><ByType type="vehicle"/></CollisionCondition>')
    begin = {"Ego": EGO, "Other": init("Other", lane(-2, 150), 10), "Far": init("Far", lane(-1, 110), 10)}
    found = rows(put(tmp_path, begin, stop=when(hit, tag="StopTrigger")))["Ego"]
    assert found["time"][-1] == pytest.approx(4.6, abs=0.05)
