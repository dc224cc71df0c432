"""The CommonRoad reader: a road turned by 30 degrees with known answers, damage, and real traffic."""

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
from hypothesis import given, settings
from hypothesis import strategies as st

from extensions.traffic.tiny_commonroad import Car, document, point
from roadproof.errors import InputError
from roadproof.extensions.exchange.commonroad import read_commonroad
from roadproof.extensions.maps.lines import even_line
from roadproof.extensions.traffic.formats.line_coordinates import project
from roadproof.extensions.traffic.formats.measured_roads import boxes_of, inside, overlap, triangles_of
from roadproof.extensions.traffic.formats.overlaps import find_overlaps
from roadproof.extensions.traffic.formats.plausible import LARGEST_SIZE
from tables import read_table

US101 = Path(__file__).parents[4] / "shared" / "data" / "us101"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "tiny.xml"
    path.write_text(document())
    return path


def test_by_hand(file: Path) -> None:
    r = read_commonroad(file)
    assert (r.name, r.rate) == ("tiny", 10)
    assert [lane.name for lane in r.lanes] == ["1", "3", "5"]
    assert r.beside == {frozenset("13"), frozenset("15")}
    assert r.vehicle_id.tolist() == [3, 7, 9]
    assert r.kind.tolist() == ["Car", "Car", "Truck"]
    assert r.first_frame.tolist() == [1, 0, 0]
    assert r.start.tolist() == [0, 2, 5, 6]
    # Γ is the centre of lane 1 (across = 1.75); the front is half a length ahead of the centre.
    assert r.s == pytest.approx([42.0, 44.0, 12.0, 14.0, 16.0, 64.5])
    assert r.d == pytest.approx([3.2 - 1.75 + 0.9, 3.6 - 1.75 + 0.9, 0.9, 0.9, 0.9, -3.5 + 0.9])
    assert r.v_lon == pytest.approx([20 * math.cos(0.1)] * 2 + [20.0] * 4)
    assert r.v_lat == pytest.approx([20 * math.sin(0.1)] * 2 + [0.0] * 4)
    assert r.a_lon == pytest.approx([-1.5 * math.cos(0.1)] * 2 + [-1.5] * 4)
    assert r.occupancy.tolist() == [0b011, 0b011, 0b001, 0b001, 0b001, 0b100]
    assert r.lane.tolist() == [0, 1, 0, 0, 0, 2]
    # Lanelets 1, 3 and 5 are side by side with the merge lane: merge zone; 2 and 4 are main road.
    assert r.zones.tolist() == [0b010] * 6


def test_zone_behind_the_merge_lane(tmp_path: Path) -> None:
    path = tmp_path / "far.xml"
    path.write_text(document((Car(1, 0, ((78.5, 1.75), (81.0, 1.75), (90.0, 1.75))),)))
    r = read_commonroad(path)
    assert r.zones.tolist() == [0b011, 0b011, 0b001]
    assert r.occupancy.tolist() == [1, 1, 1]


def test_a_vehicle_off_the_road_is_refused(tmp_path: Path) -> None:
    """At all times; one that leaves it, or comes from beside it, is noted."""
    path = tmp_path / "off.xml"
    path.write_text(
        document((Car(1, 0, ((50.0, 1.75), (52.0, 1.75))), Car(4, 0, ((50.0, 30.0), (52.0, 30.0)))))
    )
    with pytest.raises(InputError, match=r"off\.xml: dynamicObstacle 4: on no lanelet at any time"):
        read_commonroad(path)
    path.write_text(document((Car(1, 0, ((158.0, 1.75), (160.0, 1.75), (162.0, 1.75), (164.5, 1.75))),)))
    assert "1 of 4 samples have the centre of the box on no lane" not in (
        notes := read_commonroad(path).notes
    )
    assert "2 of 4 samples have the centre of the box on no lane" in notes


def test_overlaps_are_reported(tmp_path: Path) -> None:
    path = tmp_path / "crash.xml"
    path.write_text(
        document((Car(1, 0, ((50.0, 1.75), (60.0, 1.75))), Car(2, 0, ((54.0, 1.75), (63.0, 1.75)))))
    )
    r = read_commonroad(path)
    ((one, other, frames, depth),) = find_overlaps(r)  # touching bumpers in frame 0 are no overlap
    assert (one, other, frames) == (1, 2, 1)
    assert depth == pytest.approx(1.0)
    assert "vehicles 1 and 2 overlap in 1 frames, by up to 1.00 m" in r.notes


@pytest.mark.parametrize(
    ("old", "new", "message"),
    read_table(__file__, "damage_is_named"),
)
def test_damage_is_named(old: str, new: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "spoiled.xml"
    text = document()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=message):
        read_commonroad(path)


def test_the_largest_vehicle_is_read_and_none_beyond(tmp_path: Path) -> None:
    path = tmp_path / "long.xml"
    text = document()
    path.write_text(text.replace("<length>4.0<", f"<length>{LARGEST_SIZE}<"))
    assert read_commonroad(path).length.max() == LARGEST_SIZE
    path.write_text(text.replace("<length>4.0<", f"<length>{LARGEST_SIZE + 0.1}<"))
    with pytest.raises(InputError, match="no vehicle is larger than 50 m"):
        read_commonroad(path)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.integers(0, 2**31))
def test_overlap_against_sampling(seed: int) -> None:
    """A box overlaps a triangle if one of many random points is inside both, and never if they touch."""
    random_ = np.random.default_rng(seed)
    box = boxes_of(random_.uniform(-2, 2, (1, 2)), random_.uniform(0, 7, 1), np.array([3.0]), np.array([1.5]))
    triangle = random_.uniform(-4, 4, (1, 3, 2))
    points = random_.uniform(-5, 5, (4000, 2))
    halves = np.stack((box[0][[0, 1, 2]], box[0][[0, 2, 3]]))
    common = inside(points, halves) & inside(points, triangle)
    found = bool(overlap(box, triangle)[0])
    if common.any():
        assert found
    shift = box[0, :, 0].max() - triangle[0, :, 0].min()  # moved until they just touch, or less
    assert not overlap(box, triangle + np.array([shift + 1e-9, 0]))[0]
    if found and not common.any():
        assert _distance_inside(box[0], triangle[0]) < 0.5  # only slivers escape the sampling


def _distance_inside(box: np.ndarray, triangle: np.ndarray) -> float:
    """How deep the figures overlap along their edge normals."""
    depth = np.inf
    for figure in (box, triangle):
        for a, b in zip(figure, np.roll(figure, -1, axis=0), strict=True):
            normal = np.array([a[1] - b[1], b[0] - a[0]]) / np.hypot(*(b - a))
            one, other = box @ normal, triangle @ normal
            depth = min(depth, min(one.max(), other.max()) - max(one.min(), other.min()))
    return float(depth)


def test_touching_is_not_occupying() -> None:
    strip = triangles_of(np.array([[0.0, 4.0], [50.0, 4.0]]), np.array([[0.0, 0.0], [50.0, 0.0]]))
    level = np.zeros(3)
    centre = np.array([[10.0, 5.0], [10.0, 4.999], [-2.0, 2.0]])
    boxes = boxes_of(centre, level, np.full(3, 4.0), np.full(3, 2.0))
    assert overlap(boxes, strip).tolist() == [False, True, False]


def test_projection_goes_on_straight() -> None:
    line = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]])
    along = project(line, np.array([[-5.0, 1.0], [12.0, 15.0]]))
    assert along.s.tolist() == [-5.0, 25.0]
    assert along.d.tolist() == [1.0, -2.0]
    assert along.heading == pytest.approx([0, math.pi / 2])
    straight = project(line[:2], np.array([[4.0, -2.0]]))
    assert (straight.s[0], straight.d[0], straight.heading[0], straight.stretch[0]) == (4.0, -2.0, 0.0, 0.0)


@pytest.mark.parametrize("d", [-18.0, -5.0, 0.0, 5.0, 18.0])
def test_projection_in_a_bend(d: float) -> None:
    """A left bend of 200 m: a point d to the left goes 1 - d/200 m where the line goes 1 m, without jumps."""
    radius, angle = 200.0, np.linspace(0.0, 1.0, 400)
    line = even_line(np.stack((radius * np.sin(angle), radius * (1 - np.cos(angle))), axis=1))
    at = np.linspace(0.05, 0.95, 5000)
    points = np.stack(((radius - d) * np.sin(at), radius - (radius - d) * np.cos(at)), axis=1)
    along = project(line, points)
    assert np.abs(along.s - radius * at).max() < 0.01
    assert np.abs(along.d - d).max() < 0.02  # chords of 5 m lie 16 mm inside the bend
    assert np.abs(along.heading - at).max() < 1e-5
    assert along.stretch == pytest.approx(-d / radius, abs=2e-4)
    assert np.abs(np.diff(along.heading, 2)).max() < 1e-4


def kinked(text: str, tag: str, across: float) -> str:
    """``text`` (a lanelet) with a bound whose vertices come in threes, 4 cm apart, one of them 1 cm off."""
    shifts = ((0.0, 0.0), (0.04, 0.01), (0.08, 0.0))
    points = "".join(point(s + along, across + aside) for s in range(0, 81, 8) for along, aside in shifts)
    head, _, rest = text.partition(f"<{tag}>")
    return f"{head}<{tag}>{points}</{tag}>{rest.partition(f'</{tag}>')[2]}"


def test_kinks_of_the_lanelets_do_not_reach_the_velocities(tmp_path: Path) -> None:
    """The kinks turn the line by 14 degrees, which is 4.9 m/s across the road at 20 m/s."""
    text = document((Car(1, 0, tuple((20.0 + 2 * k, 5.25) for k in range(30))),))
    text = text.replace("<exact>-1.5</exact>", "<exact>0.0</exact>")
    for name, low, high in (("1", 0.0, 3.5), ("3", 3.5, 7.0)):
        head, mark, rest = text.partition(f'<lanelet id="{name}">')
        one, end, others = rest.partition("</lanelet>")
        text = head + mark + kinked(kinked(one, "leftBound", high), "rightBound", low) + end + others
    path = tmp_path / "kinked.xml"
    path.write_text(text)
    r = read_commonroad(path)
    assert np.abs(r.v_lat).max() < 0.08
    assert np.abs(np.diff(r.s) - 2.0).max() < 0.01


@pytest.mark.skipif(not US101.is_dir(), reason="the US-101 recordings are not here: ../shared/data/us101")
def test_us101() -> None:
    paths = sorted(US101.glob("*.xml"))
    assert len(paths) == 8
    for path in paths:
        r = read_commonroad(path)
        assert r.rate == 10
        assert len(r.lanes) in (5, 6)
        assert len(r.beside) == len(r.lanes) - 1
        assert (r.lane < 0).mean() < 0.01
        assert 0 <= r.v_lon.min() <= r.v_lon.max() < 35
        inner = np.diff(r.row_vehicle) == 0
        for position, velocity, limit in ((r.s, r.v_lon, 1.2), (r.d, r.v_lat, 0.1)):
            error = np.abs(np.diff(position) - (velocity[1:] + velocity[:-1]) / 20)[inner]
            assert error.max() < limit
        assert any(note.startswith("accelerations") for note in r.notes)
    first = read_commonroad(paths[0])
    assert list(find_overlaps(first)) == [(504, 513, 3, pytest.approx(0.12, abs=0.01))]


# --- CommonRoad 2020a with every field that is read away from its default, against a reading written here
# The road is straight and turned, one of its lanes is driven the other way; the reading uses ElementTree
# and complex numbers, and none of the reader's functions.

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


def xml_point(where: complex) -> str:
    return f"<point><x>{where.real!r}</x><y>{where.imag!r}</y></point>"


def bound(tag: str, d: float, backwards: bool) -> str:
    places = [0.0, LENGTH / 3, LENGTH]
    points = "".join(xml_point(at(s, d)) for s in (places[::-1] if backwards else places))
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
        f"<{tag}><position>{xml_point(at(x.s, x.d))}</position>{exact('orientation', x.turned + TURN)}"
        f"<time><exact>{time}</exact></time>{exact('velocity', x.speed)}"
        f"{'' if x.drift is None else exact('velocityY', x.drift)}{exact('acceleration', x.pull)}"
        f"{exact('yawRate', 0.3)}{exact('slipAngle', 0.0)}</{tag}>"
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
    read_table(__file__, "types_and_lengths_are_classes"),
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
        (lambda x: x.replace("<shape>", f"<shape>{CIRCLE}", 1), "left out obstacles (not one rectangle"),
        (
            lambda x: x.replace("</rectangle></shape>", f"</rectangle>{CIRCLE}</shape>", 1),
            "(not one",
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
    assert "left out 2 static obstacles: they are no traffic" in recording.notes
    assert not any("left out" in x for x in read_commonroad(put(tmp_path, [FIRST])).notes)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    read_table(__file__, "intervals_areas_and_turned_shapes_are_refused"),
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
