"""Storyboards of OpenSCENARIO: motions worked out by hand, shapes integrated apart, and refusals.

The road has three lanes of 4 m to the right of its reference line: their middles are at d = -2, -6 and -10.
Boxes are 4 m by 2 m around the reference point, so the front-left corner is at s + 2 and d + 1.
"""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from roadproof.errors import InputError
from roadproof.recordings.formats.openscenario import read_recording, read_scenario
from roadproof.recordings.formats.storyboard.document import expression_value, replaced

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


EGO = init("Ego", lane(-2, 100), 20)


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
    headway = '<TimeHeadwayCondition entityRef="Other" value="1" freespace="false" rule="greaterOrEqual"/>'
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
    with pytest.raises(InputError, match="no Vehicle bus in a catalogue cars"):
        rows(put(tmp_path, begin, more=more, entity=entity.replace('"car"', '"bus"')))


@pytest.mark.parametrize(
    ("text", "value"),
    [("2 + 3*4", 14), ("-(1 - 3) / 4", 0.5), ("pow(2, 3) % 5", 3), ("max(sqrt(16), round(2.5))", 4)],
)
def test_expressions(text: str, value: float) -> None:
    assert expression_value(text) == value
    assert float(replaced(f"${{$a * ({text})}}", {"a": "2"})) == 2 * value


@pytest.mark.parametrize(
    "text", ["1 / 0", "__import__('os')", "9 ** 9", "a", "(" * 300, "pow(10, 400)", "1 if 1 else 2"]
)
def test_what_is_no_expression(text: str) -> None:
    with pytest.raises(ValueError, match=r"expression|supported|number"):
        expression_value(text)


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
        ("SpeedAction>", "SpeedProfileAction>", "SpeedProfileAction: this action is not supported"),
        ("SimulationTimeCondition", "TimeOfDayCondition", "TimeOfDayCondition: this condition is not"),
        ('laneId="-2"', 'laneId="-5"', "road 7 has no lane -5 at s=100.00"),
        ('dynamicsShape="linear"', 'dynamicsShape="round"', "dynamicsShape=round: one of step, linear"),
        ('priority="parallel"', 'priority="first"', "priority=first: one of override"),
        ('roadId="7"', 'roadId="8"', "there is no road 8"),
        ("LanePosition", "GeoPosition", "GeoPosition: this kind of position is not supported"),
        ('<EntityRef entityRef="Ego"', '<EntityRef entityRef="No"', "there is no ScenarioObject No"),
        ("TeleportAction>", "AppearanceAction>", "Ego has no TeleportAction in Init"),
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
