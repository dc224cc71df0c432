"""Parts of storyboards that move vehicles otherwise than actions do, or that say that a motion is none."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from extensions.traffic.board import (
    CAR,
    EGO,
    at,
    at_time,
    event,
    init,
    lane,
    maneuver,
    of,
    put,
    rows,
    target,
    to_lane,
    to_speed,
    when,
)
from extensions.traffic.storyboards import follow, place, polyline, write
from roadproof.errors import InputError
from roadproof.extensions.exchange.openscenario import read_recording, read_scenario
from roadproof.extensions.exchange.storyboard.distances import Measure, distance_between
from roadproof.extensions.exchange.storyboard.drives import read_storyboard_drive
from roadproof.extensions.exchange.storyboard.positions import ObjectState, positions_on
from roadproof.extensions.exchange.storyboard.stage import open_stage

OTHER = init("Other", lane(-1, 140), 16)
BOTH = {"Ego": EGO, "Other": OTHER}
ASSIGN = (
    "<AssignControllerAction{more}><Controller name='c'><Properties/></Controller></AssignControllerAction>"
)
ACTIVATE = '<ActivateControllerAction lateral="{lateral}" longitudinal="{longitudinal}"/>'
PEDAL = '<OverrideControllerValueAction><Brake active="{active}" value="1"/></OverrideControllerValueAction>'
STOP = when(at_time(4), tag="StopTrigger")


def private(action: str) -> str:
    return f"<PrivateAction>{action}</PrivateAction>"


def controlled(action: str) -> dict[str, str]:
    """Ego with a controller from the start."""
    inside = private(f"<ControllerAction>{action}</ControllerAction>")
    return {"Ego": EGO.replace("</Private>", f"{inside}</Private>"), "Other": OTHER}


MOVES = {
    "assigned": ASSIGN.format(more=""),
    "assigned and activated": ASSIGN.format(more=' activateLateral="false" activateLongitudinal="true"'),
    "activated": ACTIVATE.format(lateral="true", longitudinal="false"),
    "pedal": PEDAL.format(active="true"),
}
RESTS = {
    "assigned only": ASSIGN.format(more=' activateLateral="false" activateLongitudinal="false"'),
    "deactivated": ACTIVATE.format(lateral="false", longitudinal="false"),
    "pedal": PEDAL.format(active="false"),
}


@pytest.mark.parametrize("action", MOVES.values(), ids=MOVES)
def test_a_vehicle_that_a_controller_moves_is_left_out(action: str, tmp_path: Path) -> None:
    path = put(tmp_path, controlled(action), stop=STOP)
    found = read_scenario(path)
    assert {*found.table["vehicle"]} == {"Other"}
    assert any(
        "does not say where it is: Ego, which a controller moves from 0 s on" in x for x in found.notes
    )
    with pytest.raises(InputError, match=r"controller moves.*unless read strictly"):
        read_scenario(path, strict=True)
    with pytest.raises(InputError, match="controller moves"):
        read_storyboard_drive(path)


@pytest.mark.parametrize("action", RESTS.values(), ids=RESTS)
def test_a_controller_that_is_not_active_moves_nothing(action: str, tmp_path: Path) -> None:
    found = rows(put(tmp_path, controlled(action), stop=STOP))["Ego"]
    assert at(found, 2, "s") == pytest.approx(142)
    assert read_scenario(put(tmp_path, controlled(action), stop=STOP), strict=True).unread == ()


def test_a_controller_takes_over_later(tmp_path: Path) -> None:
    take = event(
        "take", private(f"<ControllerAction>{MOVES['activated']}</ControllerAction>"), when(at_time(2))
    )
    path = put(tmp_path, BOTH, maneuver("Ego", take), stop=STOP)
    found = rows(path)
    assert found["Ego"]["time"][-1] == pytest.approx(1.96, abs=0.05)
    assert found["Other"]["time"][-1] == pytest.approx(4, abs=0.05)
    assert any("from then on: Ego" in x for x in read_scenario(path).notes)


LOOKS = {
    "distance": '<RelativeDistanceCondition entityRef="Ego" relativeDistanceType="longitudinal" value="20" '
    'freespace="false" rule="lessThan"/>',
    "speed": '<RelativeSpeedCondition entityRef="Ego" value="1" rule="greaterThan"/>',
    "clearance": '<RelativeClearanceCondition oppositeLanes="false" freeSpace="false"/>',
}


@pytest.mark.parametrize("condition", LOOKS.values(), ids=LOOKS)
def test_others_that_look_at_it_are_refused(condition: str, tmp_path: Path) -> None:
    brake = event("brake", to_speed(10), when(of("Other", condition)))
    path = put(tmp_path, controlled(MOVES["assigned"]), maneuver("Other", brake), stop=STOP)
    with pytest.raises(InputError, match="Ego, which a controller moves from 0 s on"):
        read_scenario(path)


@pytest.mark.parametrize(
    "action",
    [
        to_speed(
            0,
            aim='<RelativeTargetSpeed entityRef="Ego" value="1" speedTargetValueType="delta" '
            'continuous="false"/>',
        ),
        to_lane('<RelativeTargetLane entityRef="Ego" value="0"/>'),
    ],
)
def test_actions_that_refer_to_it_are_refused(action: str, tmp_path: Path) -> None:
    path = put(
        tmp_path,
        controlled(MOVES["assigned"]),
        maneuver("Other", event("go", action, when(at_time(1)))),
        stop=STOP,
    )
    with pytest.raises(InputError, match="it refers to Ego, which a controller moves"):
        read_scenario(path)


def test_a_vehicle_may_not_react_to_one_that_a_controller_moves_later(tmp_path: Path) -> None:
    aim = '<RelativeTargetSpeed entityRef="Ego" value="1" speedTargetValueType="delta" continuous="true"/>'
    go = event("go", to_speed(0, "linear", "time", 1, aim=aim), when(at_time(0.5)))
    take = event(
        "take", private(f"<ControllerAction>{MOVES['activated']}</ControllerAction>"), when(at_time(2))
    )
    path = put(tmp_path, BOTH, maneuver("Other", go), maneuver("Ego", take), stop=STOP)
    with pytest.raises(InputError, match="Other reacts to Ego, which a controller moves from 2 s on"):
        read_scenario(path)


# --- who acts, and who has a place --------------------------------------------------------------------


def selecting(names: tuple[str, ...], rule: str, actors: str = "") -> str:
    """A group whose actors are the vehicles that have gone 30 m."""
    refs = "".join(f'<EntityRef entityRef="{x}"/>' for x in names)
    gone = (
        f'<ByEntityCondition><TriggeringEntities triggeringEntitiesRule="{rule}">{refs}</TriggeringEntities>'
        '<EntityCondition><TraveledDistanceCondition value="30"/></EntityCondition></ByEntityCondition>'
    )
    group = maneuver("Ego", event("brake", to_speed(5), when(gone)))
    return group.replace('"false"><EntityRef entityRef="Ego"/>', f'"true">{actors}')


@pytest.mark.parametrize(
    ("rule", "slow"), [("any", {"Ego": True, "Other": False}), ("all", {"Ego": True, "Other": True})]
)
def test_triggering_entities_are_actors(rule: str, slow: dict[str, bool], tmp_path: Path) -> None:
    """Ego has gone 30 m first, with 20 m/s; both have after 1.9 s."""
    found = rows(put(tmp_path, BOTH, selecting(("Ego", "Other"), rule), stop=STOP))
    assert {name: at(found[name], 3, "v_lon") == pytest.approx(5) for name in found} == slow


def test_triggering_entities_act_beside_the_actors(tmp_path: Path) -> None:
    group = selecting(("Ego",), "any", '<EntityRef entityRef="Other"/>')
    found = rows(put(tmp_path, BOTH, group, stop=STOP))
    assert [at(found[x], 3, "v_lon") for x in ("Ego", "Other")] == pytest.approx([5, 5])


def test_a_trigger_of_nobody_selects_nobody(tmp_path: Path) -> None:
    group = maneuver("Ego", event("brake", to_speed(5), when(at_time(1))))
    group = group.replace('"false"><EntityRef entityRef="Ego"/>', '"true">')
    with pytest.raises(InputError, match="needs a StartTrigger with a ByEntityCondition"):
        rows(put(tmp_path, BOTH, group, stop=STOP))


def test_nobody_is_none_of_the_rules(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="triggeringEntitiesRule=both: one of any, all, none"):
        rows(put(tmp_path, BOTH, selecting(("Ego",), "both"), stop=STOP))


@pytest.mark.parametrize("order", [1, -1])
def test_a_speed_of_init_holds_for_a_vehicle_that_a_trajectory_places(order: int, tmp_path: Path) -> None:
    points = [(0.0, 100.0, -6.0), (1.0, 400.0, -6.0)]
    actions = [follow(polyline(points, False)), to_speed(20)][::order]
    begin = {"Ego": f'<Private entityRef="Ego">{"".join(actions)}</Private>', "Other": OTHER}
    found = rows(put(tmp_path, begin, stop=STOP))["Ego"]
    assert at(found, 2, "s") - at(found, 0, "s") == pytest.approx(40, abs=1e-3)


def test_a_relative_road_position_is_along_the_road(tmp_path: Path) -> None:
    """Both drive against the map's road: 30 m along it is 30 m behind, 1 m to its right is to their left."""
    beside = place('RelativeRoadPosition entityRef="Ego" ds="30" dt="-1"')
    begin = {"Ego": init("Ego", lane(1, 800), 20), "Other": init("Other", beside, 20)}
    found = rows(write(tmp_path, begin, (), "straight"))
    assert at(found["Ego"], 0, "s") - at(found["Other"], 0, "s") == pytest.approx(30)
    assert at(found["Other"], 0, "d") - at(found["Ego"], 0, "d") == pytest.approx(1)


@pytest.mark.parametrize("free", [False, True])
def test_distances_on_a_bend_follow_their_coordinate_system(free: bool, tmp_path: Path) -> None:
    """60 m ahead on a left bend of radius 400 m: 60 m along the road, less along the vehicle."""
    stage = open_stage(write(tmp_path, BOTH, (), "bend"))
    positions = positions_on(stage.document, stage.road)
    one, other = ObjectState(100, -6, 20, 0, 0, 0), ObjectState(160, -6, 20, 0, 0, 0)
    turn, radius, length = 60 / 400, 406.0, 5.0
    ahead = radius * math.sin(turn)
    for system, expected in (("road", 60.0), ("lane", 60.0), ("entity", ahead)):
        box = stage.boxes["Ego"]
        more = 0.0
        if free and system != "entity":
            more = length
        elif free:  # the other box is turned, with its centre 1.4 m ahead of the reference point
            extent = length * math.cos(turn) + 2 * math.sin(turn)
            more = (length + extent) / 2 + 1.4 - 1.4 * math.cos(turn)
        found = distance_between(positions, Measure("longitudinal", system, free), (box, one), (box, other))
        assert found == pytest.approx(expected - more, abs=1e-3), system


# --- motions that are none, and parts that are left out -------------------------------------------------


def fast(most: float = 25, speed: float = 40, shape: str = "linear") -> tuple[dict[str, str], str, str]:
    limits = f'<Performance maxSpeed="{most}" maxAcceleration="5" maxDeceleration="5"/>'
    entity = CAR.replace("</BoundingBox>", f"</BoundingBox>{limits}")
    go = event("go", to_speed(speed, shape, "time", 5), when(at_time(1)))
    return {"Ego": EGO}, maneuver("Ego", go), entity


def test_a_change_of_speed_ends_at_the_largest_speed(tmp_path: Path) -> None:
    """20 to 40 m/s in 5 s: 25 m/s after 1.25 s, in which the car goes 28.125 m."""
    begin, group, entity = fast()
    found = rows(put(tmp_path, begin, group, entity=entity, stop=STOP))["Ego"]
    assert at(found, 2, "v_lon") == pytest.approx(24)
    assert at(found, 3, "v_lon") == pytest.approx(25)
    assert at(found, 3, "s") == pytest.approx(102 + 20 + 28.125 + 0.75 * 25, abs=0.02)


@pytest.mark.parametrize("speed", [120.0, 432 / 3.6])
def test_a_speed_above_the_own_limit_is_cut(speed: float, tmp_path: Path) -> None:
    limits = '<Performance maxSpeed="70" maxAcceleration="5" maxDeceleration="5"/>'
    entity = CAR.replace("</BoundingBox>", f"</BoundingBox>{limits}")
    found = rows(put(tmp_path, {"Ego": init("Ego", lane(-2, 100), speed)}, entity=entity, stop=STOP))["Ego"]
    assert np.allclose(found["v_lon"], 70)


def test_accelerations_above_the_own_limit_are_faults(tmp_path: Path) -> None:
    begin, group, entity = fast(60, 60)
    found = read_scenario(put(tmp_path, begin, group, entity=entity, stop=STOP))
    (fault,) = found.faults
    assert fault == "vehicle Ego exceeds maxAcceleration=5 m/s² of its Performance from 1 s on: 8 m/s²"
    assert fault in found.notes


STEP = maneuver("Ego", event("go", to_speed(10), when(at_time(2))))


def test_a_step_of_speed_is_a_fault_that_all_readers_name(tmp_path: Path) -> None:
    path = put(tmp_path, BOTH, STEP, stop=STOP)
    rule = "vehicle Ego changes its speed from 20 to 10 m/s in no time at 2 s"
    assert read_scenario(path).faults == (rule,)
    recording = read_recording(path)
    assert recording.faults == (rule,)
    formula = "F[1, 1] v_lon(SV) = 20 m/s and F[3, 3] v_lon(SV) = 10 m/s"
    for where in (path, f"{path}:1,2"):
        answer = rp.monitor(formula, where)
        assert answer.verdict == "true"
        assert any(rule in x for x in answer.notes), where


def test_a_smooth_change_of_speed_is_no_fault(tmp_path: Path) -> None:
    smooth = maneuver("Ego", event("go", to_speed(10, "cubic", "time", 3), when(at_time(0.5))))
    assert read_scenario(put(tmp_path, BOTH, smooth, stop=STOP)).faults == ()


def test_a_test_that_is_no_motion_covers_nothing(tmp_path: Path) -> None:
    put(tmp_path, BOTH, STEP, stop=STOP)
    found = json.loads(json.dumps(rp.catalogue(tmp_path).as_data()))
    (test,) = found["tests"]
    assert "no vehicle drives so: vehicle Ego changes its speed" in json.dumps(test)


def test_parts_that_nothing_reads_are_named(tmp_path: Path) -> None:
    path = put(tmp_path, BOTH, stop=STOP)
    text = (
        path.read_text("utf-8")
        .replace("<Entities>", '<Entities strange="1">')
        .replace("<StopTrigger>", "<Miracle/><StopTrigger>")
    )
    path.write_text(text, "utf-8")
    found = read_scenario(path)
    (note,) = found.unread
    assert "Entities@strange, at OpenSCENARIO/Entities" in note
    assert "Miracle, at OpenSCENARIO/Storyboard/Miracle" in note
    answer = rp.monitor("v_lon(SV) > 1 m/s", path)
    assert answer.left_out == (note,)
    assert answer.as_data()["left_out"] == [note]
    with pytest.raises(InputError, match=r"Entities@strange.*unless read strictly, the rest is read"):
        rp.monitor("v_lon(SV) > 1 m/s", path, strict=True)


def test_parts_of_an_action_that_still_runs_are_named(tmp_path: Path) -> None:
    slow = to_speed(10, "linear", "time", 60).replace("<SpeedAction>", '<SpeedAction strange="1">')
    group = maneuver("Ego", event("slow", slow, when(at_time(1))))
    (note,) = read_scenario(put(tmp_path, BOTH, group, stop=STOP)).unread
    assert "SpeedAction@strange" in note


@pytest.mark.parametrize(("rule", "limit"), [("lessThan", 20), ("greaterThan", 20), ("equalTo", 19)])
def test_a_parameter_keeps_its_own_constraints(rule: str, limit: float, tmp_path: Path) -> None:
    more = (
        '<ParameterDeclarations><ParameterDeclaration name="v" parameterType="double" value="20">'
        f'<ConstraintGroup><ValueConstraint rule="{rule}" value="{limit}"/></ConstraintGroup>'
        "</ParameterDeclaration></ParameterDeclarations>"
    )
    begin = {"Ego": init("Ego", lane(-2, 100), "$v")}
    with pytest.raises(InputError, match=f"parameter v: value=20 breaks its ConstraintGroup: {rule} {limit}"):
        rows(put(tmp_path, begin, more=more))
    kept = more.replace(f'value="{limit}"', 'value="20"').replace(rule, "lessOrEqual")
    assert at(rows(put(tmp_path, begin, more=kept))["Ego"], 0, "v_lon") == pytest.approx(20)


def test_a_path_of_windows(tmp_path: Path) -> None:
    path = put(tmp_path, BOTH, stop=STOP)
    path.write_text(path.read_text("utf-8").replace('"map.xodr"', '".\\map.xodr"'), "utf-8")
    assert {*rows(path)} == {"Ego", "Other"}


def test_events_that_never_start_are_named(tmp_path: Path) -> None:
    late = maneuver("Ego", event("late", to_speed(10), when(at_time(90))))
    found = read_scenario(put(tmp_path, BOTH, late, stop=STOP))
    assert "events that never start: late" in found.notes
    assert found.unread == ()
    assert target(10) in to_speed(10)
