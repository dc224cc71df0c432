"""CommonRoad 2020a with every field that is read away from its default, against a reading written here.

The road is straight and turned, one of its lanes is driven the other way; the reading uses ElementTree and
complex numbers, and none of the reader's functions.
"""

import cmath
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree as xml

import numpy as np
import pytest

from roadproof.errors import InputError
from roadproof.recordings.formats.commonroad import read_commonroad

TURN, AT = 0.7, complex(300, -120)
LANES = ((1, 0.0, 3.5), (2, 3.5, 7.0))
OPPOSITE = 3  # from 7 to 10.5, and driven towards the other end
LENGTH = 400.0


@dataclass(frozen=True)
class State:
    """Position along and across in road coordinates, orientation to the road, and its motion."""

    s: float
    d: float
    turned: float
    speed: float
    pull: float
    drift: float | None = None


@dataclass(frozen=True)
class Obstacle:
    id: int
    states: tuple[State, ...]
    first: int = 0
    kind: str = "car"
    size: tuple[float, float] = (4.5, 1.8)
    more: str = ""
    """Further elements of the rectangle."""
    centre: tuple[float, float] | None = None


def at(s: float, d: float) -> complex:
    return AT + complex(s, d) * cmath.exp(1j * TURN)


def point(where: complex) -> str:
    return f"<point><x>{where.real!r}</x><y>{where.imag!r}</y></point>"


def bound(tag: str, d: float, backwards: bool) -> str:
    places = [0.0, LENGTH / 3, LENGTH]
    points = "".join(point(at(s, d)) for s in (places[::-1] if backwards else places))
    return f"<{tag}>{points}<lineMarking>dashed</lineMarking></{tag}>"


def lanelet(name: int, low: float, high: float, backwards: bool = False, links: str = "") -> str:
    left, right = (low, high) if backwards else (high, low)
    return (
        f'<lanelet id="{name}">{bound("leftBound", left, backwards)}{bound("rightBound", right, backwards)}'
        f"{links}<laneletType>mainCarriageWay</laneletType><userOneWay>vehicle</userOneWay></lanelet>"
    )


def exact(tag: str, value: float) -> str:
    return f"<{tag}><exact>{value!r}</exact></{tag}>"


def state(tag: str, time: int, x: State) -> str:
    return (
        f"<{tag}><position>{point(at(x.s, x.d))}</position>{exact('orientation', x.turned + TURN)}"
        f"<time><exact>{time}</exact></time>{exact('velocity', x.speed)}"
        f"{'' if x.drift is None else exact('velocityY', x.drift)}{exact('acceleration', x.pull)}"
        f"{exact('yawRate', 0.3)}{exact('slipAngle', 0.1)}</{tag}>"
    )


def obstacle(car: Obstacle) -> str:
    first, *others = (
        state("state" if k else "initialState", car.first + k, x) for k, x in enumerate(car.states)
    )
    middle = "" if car.centre is None else f"<center><x>{car.centre[0]}</x><y>{car.centre[1]}</y></center>"
    return (
        f'<dynamicObstacle id="{car.id}"><type>{car.kind}</type><shape><rectangle>'
        f"<length>{car.size[0]}</length><width>{car.size[1]}</width>{car.more}{middle}</rectangle></shape>{first}"
        f"<trajectory>{''.join(others)}</trajectory></dynamicObstacle>"
    )


def put(folder: Path, cars: Sequence[Obstacle], step: str = "0.1", more: str = "") -> Path:
    same, other = ('drivingDir="same"', 'drivingDir="opposite"')
    road = [
        lanelet(1, 0.0, 3.5, links=f'<adjacentLeft ref="2" {same}/>'),
        lanelet(2, 3.5, 7.0, links=f'<adjacentLeft ref="3" {other}/><adjacentRight ref="1" {same}/>'),
        lanelet(3, 7.0, 10.5, backwards=True, links=f'<adjacentLeft ref="2" {other}/>'),
    ]
    path = folder / "fields.xml"
    path.write_text(
        f'<commonRoad commonRoadVersion="2020a" benchmarkID="DEU_A-1_1_T-1" timeStepSize="{step}" author="a" '
        'affiliation="b" source="c" date="2020-01-01"><location><geoNameId>1</geoNameId><gpsLatitude>50'
        "</gpsLatitude><gpsLongitude>9</gpsLongitude><geoTransformation><additionalTransformation>"
        "<xTranslation>5</xTranslation><yTranslation>6</yTranslation><zRotation>1</zRotation><scaling>2</scaling>"
        "</additionalTransformation></geoTransformation></location><scenarioTags><highway/></scenarioTags>"
        f"{''.join(road)}{''.join(map(obstacle, cars))}{more}</commonRoad>",
        "utf-8",
    )
    return path


def told(path: Path) -> dict[int, dict[str, np.ndarray]]:
    """By obstacle the front-left corner along and across, and its motion; s counts from the car's first."""
    root = xml.parse(path).getroot()
    rate = round(1 / float(root.attrib["timeStepSize"]))
    found = {}
    for node in root.iter("dynamicObstacle"):
        box = node.find("shape/rectangle")
        assert box is not None
        length, width = (float(box.findtext(x) or "") for x in ("length", "width"))
        lever = complex(*(float(box.findtext(f"center/{x}") or 0) for x in "xy"))
        rows = []
        for each in [*node.findall("initialState"), *node.findall("trajectory/state")]:

            def value(tag: str, each: xml.Element = each) -> float:
                return float(each.findtext(f"{tag}/exact") or 0)

            turned = value("orientation")
            place = complex(*(float(each.findtext(f"position/point/{x}") or "") for x in "xy"))
            middle = (place + lever * cmath.exp(1j * turned) - AT) * cmath.exp(-1j * TURN)
            back = middle.imag > 7  # the lane that is driven the other way
            to_road = cmath.exp(1j * (turned - TURN - (math.pi if back else 0)))
            velocity = complex(value("velocity"), value("velocityY")) * to_road
            along = (LENGTH - middle.real if back else middle.real) + length / 2
            rows.append(
                (along, middle.imag, velocity, value("acceleration"), value("velocityY"), to_road, back)
            )
        aside = [x[4] for x in rows]
        change = [(b - a) * rate for a, b in pairwise(aside)]
        change = [*change, change[-1] if change else 0.0]
        pull = [complex(x[3], y) * x[5] for x, y in zip(rows, change, strict=True)]
        found[int(node.attrib["id"])] = {
            "s": np.array([x[0] for x in rows]),
            # d counts from the middle of the rightmost lane of a direction
            "d": np.array([(8.75 - x[1] if x[6] else x[1] - 1.75) + width / 2 for x in rows]),
            "v_lon": np.array([x[2].real for x in rows]),
            "v_lat": np.array([x[2].imag for x in rows]),
            "a_lon": np.array([x.real for x in pull]),
            "a_lat": np.array([x.imag for x in pull]),
        }
    return found


def differences(path: Path) -> list[str]:
    recording, wrong = read_commonroad(path), []
    for k, (number, expected) in enumerate(sorted(told(path).items())):
        rows = slice(recording.start[k], recording.start[k + 1])
        if recording.vehicle_id[k] != number:
            wrong.append(f"vehicle {number}")
        for signal, values in expected.items():
            ours = getattr(recording, signal)[rows]
            if len(ours) != len(values) or not np.allclose(ours, values, atol=1e-6, rtol=0):
                wrong.append(f"{number}: {signal} {ours} {values}")
    return wrong


def drive(s: float, d: float, speed: float = 20.0, **more: float) -> tuple[State, ...]:
    """Five samples at a steady speed."""
    turned, pull, drift = (more.get(x, 0.0) for x in ("turned", "pull", "drift"))
    return tuple(
        State(s + speed * k / 10, d + drift * k / 10, turned, speed, pull, drift if "drift" in more else None)
        for k in range(5)
    )


def back(
    s: float, d: float, speed: float = 15.0, turned: float = 0.0, drift: float = 0.0
) -> tuple[State, ...]:
    """The other way; ``drift`` is to the left of the car."""
    return tuple(
        State(s - speed * k / 10, d - drift * k / 10, math.pi + turned, speed, -0.5, drift) for k in range(5)
    )


FIRST = Obstacle(7, drive(50, 1.75, pull=0.4))
CASES: Mapping[str, Sequence[Obstacle]] = {
    "as it is": [FIRST],
    "turned to the left": [Obstacle(1, drive(50, 1.75, turned=0.05))],
    "turned to the right": [Obstacle(1, drive(50, 1.75, turned=-0.08, pull=-2.0))],
    "moving to the left": [Obstacle(1, drive(50, 1.75, drift=0.8))],
    "moving to the right": [Obstacle(1, drive(50, 5.0, drift=-0.6, turned=-0.02))],
    "drift that changes": [
        Obstacle(1, tuple(replace(x, drift=0.1 * k * k) for k, x in enumerate(drive(50, 1.75))))
    ],
    "a single sample": [Obstacle(1, (State(80, 5.25, 0.1, 18, -1, 0.7),))],
    "single samples beside others": [
        Obstacle(1, tuple(replace(x, drift=0.1 * k) for k, x in enumerate(drive(50, 1.75)))),
        Obstacle(2, (State(80, 5.25, 0.1, 18, -1, 0.7),)),
        Obstacle(3, tuple(replace(x, drift=-0.2 * k) for k, x in enumerate(drive(120, 1.75)))),
        Obstacle(4, (State(150, 1.75, 0, 18, 1, -0.3),)),
    ],
    "two samples": [Obstacle(1, (State(80, 5.25, 0, 20, 0, 0.2), State(82, 5.27, 0, 20, 0, 0.3)))],
    "the other way": [FIRST, Obstacle(9, back(300, 8.75))],
    "the other way, across": [FIRST, Obstacle(9, back(300, 8.4, turned=0.04, drift=0.3))],
    "a box ahead of its position": [replace(FIRST, centre=(1.3, 0.0))],
    "a box to the left of its position": [replace(FIRST, centre=(0.0, 0.35))],
    "a box beside a turned position": [Obstacle(1, drive(50, 1.75, turned=0.1), centre=(1.3, -0.25))],
    "a box of the other way": [FIRST, replace(Obstacle(9, back(300, 8.75)), centre=(-1.0, 0.2))],
    "an orientation of 0 of the shape": [replace(FIRST, more="<orientation>0</orientation>")],
    "later": [replace(FIRST, first=12), Obstacle(2, drive(100, 5.25))],
}


@pytest.mark.parametrize("name", CASES)
def test_each_field_is_read_as_the_format_says(name: str, tmp_path: Path) -> None:
    assert differences(put(tmp_path, CASES[name])) == []


@pytest.mark.parametrize(("step", "rate"), [("0.04", 25), ("0.1", 10), ("0.2", 5), ("1", 1)])
def test_the_rate_is_that_of_the_steps(step: str, rate: int, tmp_path: Path) -> None:
    car = Obstacle(1, tuple(replace(x, s=50 + 20 * k * float(step)) for k, x in enumerate(drive(50, 1.75))))
    path = put(tmp_path, [replace(car, first=3)], step)
    recording = read_commonroad(path)
    assert (recording.rate, recording.first_frame.tolist()) == (rate, [3])
    assert differences(path) == []


def test_an_opposite_lane_is_a_direction_of_its_own(tmp_path: Path) -> None:
    recording = read_commonroad(put(tmp_path, [FIRST, Obstacle(9, back(300, 8.75))]))
    assert recording.beside == {frozenset("12")}
    ways = {lane.name: lane.direction for lane in recording.lanes}
    assert ways["1"] == ways["2"] != ways["3"]
    assert recording.direction.tolist() == [ways["1"], ways["3"]]
    assert [recording.lanes[k].name for k in recording.lane] == ["1"] * 5 + ["3"] * 5


@pytest.mark.parametrize(
    ("kind", "length", "expected"),
    [
        ("car", 4.5, ("Car", "Car")),
        ("car", 7.0, ("Car", "Car")),
        ("car", 7.1, ("Truck", "Truck")),
        ("truck", 5.0, ("Truck", "truck")),
        ("bus", 5.0, ("Truck", "bus")),
        ("taxi", 4.5, ("Car", "taxi")),
        ("motorcycle", 2.2, ("Car", "motorcycle")),
        ("bicycle", 1.9, ("Car", "bicycle")),
        ("unknown", 9.0, ("Truck", "unknown")),
    ],
)
def test_types_and_lengths_are_classes(
    kind: str, length: float, expected: tuple[str, str], tmp_path: Path
) -> None:
    recording = read_commonroad(put(tmp_path, [replace(FIRST, kind=kind, size=(length, 1.7))]))
    assert (recording.kind[0], recording.label[0]) == expected
    assert (recording.length[0], recording.width[0]) == (length, 1.7)


CIRCLE = "<circle><radius>1</radius></circle>"


def shaped(more: str) -> Callable[[str], str]:
    """The second obstacle has another shape."""

    def change(text: str) -> str:
        place = text.rindex("<shape>")
        return text[:place] + more.join(text[place:].split("<shape>", 1))

    return change


@pytest.mark.parametrize(
    ("change", "note"),
    [
        (lambda x: x.replace("<shape>", f"<shape>{CIRCLE}", 1), "obstacles left out (not one rectangle"),
        (
            lambda x: x.replace("</rectangle></shape>", f"</rectangle>{CIRCLE}</shape>", 1),
            "left out (not one",
        ),
        (lambda x: x.replace("trajectory>", "occupancySet>", 2), "or no trajectory): 2"),
    ],
)
def test_what_is_no_box_is_left_out_and_noted(
    change: Callable[[str], str], note: str, tmp_path: Path
) -> None:
    path = put(tmp_path, [Obstacle(2, drive(100, 5.25)), FIRST])
    path.write_text(change(path.read_text("utf-8")), "utf-8")
    recording = read_commonroad(path)
    assert recording.vehicle_id.tolist() == [7]
    (told,) = [x for x in recording.notes if "left out" in x]
    assert note in told
    assert told.endswith(": 2")


def test_static_obstacles_are_noted(tmp_path: Path) -> None:
    parked = '<staticObstacle id="77"><type>parkedVehicle</type></staticObstacle>'
    recording = read_commonroad(put(tmp_path, [FIRST], more=parked * 2))
    assert "2 static obstacles left out: they are no traffic" in recording.notes
    assert not any("left out" in x for x in read_commonroad(put(tmp_path, [FIRST])).notes)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("</width>", "</width><orientation>0.1</orientation>", "orientation=0.1 of the rectangle of"),
        (
            "</width>",
            "</width><orientation>x</orientation>",
            "orientation of the rectangle of dynamicObstacle 7",
        ),
        ("</width>", "</width><center><x>1</x></center>", "center y of the rectangle of dynamicObstacle 7"),
        (
            "<velocity><exact>20.0</exact>",
            "<velocity><intervalStart>1</intervalStart>",
            "velocity in a state",
        ),
        ("<acceleration><exact>", "<acceleration><intervalEnd>", "acceleration in a state"),
        ("<time><exact>0</exact>", "<time><intervalStart>0</intervalStart>", "time in a state"),
        ("<position><point>", "<position><circle>", "x in a state of dynamicObstacle 7"),
    ],
)
def test_intervals_areas_and_turned_shapes_are_refused(old: str, new: str, said: str, tmp_path: Path) -> None:
    path = put(tmp_path, [FIRST])
    text = path.read_text("utf-8").replace(old, new, 1)
    tag = new.rpartition("<")[2].partition(">")[0]
    if old.endswith("<exact>") or tag == "circle":
        closing = "exact" if tag != "circle" else "point"
        text = text[: (k := text.index(new) + len(new))] + text[k:].replace(f"</{closing}>", f"</{tag}>", 1)
    path.write_text(text, "utf-8")
    with pytest.raises(InputError) as error:
        read_commonroad(path)
    assert said in str(error.value)


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_a_neighbour_that_one_side_alone_names_is_one(side: str, tmp_path: Path) -> None:
    path = put(tmp_path, [FIRST])
    other = {"Left": "Right", "Right": "Left"}[side]
    text = path.read_text("utf-8")
    assert f'<adjacent{other} ref="' in text
    path.write_text(re.sub(f'<adjacent{other} ref="[12]" drivingDir="same"/>', "", text), "utf-8")
    assert read_commonroad(path).beside == {frozenset("12")}
