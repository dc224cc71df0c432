"""The CommonRoad reader: a road turned by 30 degrees with known answers, damage, and real traffic."""

import math
import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from roadproof.errors import InputError
from roadproof.recordings.formats.commonroad import read_commonroad
from roadproof.recordings.formats.overlaps import find_overlaps
from roadproof.recordings.formats.plausible import LARGEST_SIZE
from roadproof.recordings.formats.projection import (
    boxes_of,
    even_line,
    inside,
    overlap,
    project,
    triangles_of,
)
from traffic.tiny_commonroad import Car, document, point

US101 = Path(__file__).parents[3] / "shared" / "data" / "us101"


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
    [
        ('timeStepSize="0.1"', 'timeStepSize="0.3"', "timeStepSize=0.3: a whole number"),
        ('timeStepSize="0.1"', 'timeStepSize="fast"', "timeStepSize of commonRoad is 'fast'"),
        ('Version="2020a"', 'Version="2018b"', "2020a is needed"),
        ("</commonRoad>", "", "no well-formed XML"),
        ('<?xml version="1.0"?>', '<!DOCTYPE a [<!ENTITY b "c">]>', "the file has a document type"),
        (
            "<time><exact>2</exact>",
            "<time><exact>5</exact>",
            "dynamicObstacle 7: time step 1 is followed by 5",
        ),
        ("<exact>20.0</exact>", "<exact>nan</exact>", "velocity in a state of dynamicObstacle 7 is 'nan'"),
        ("<width>1.8</width>", "<width>-1.8</width>", r"dynamicObstacle 7 has length=4.0, width=-1.8"),
        ('dynamicObstacle id="3"', 'dynamicObstacle id="7"', "dynamicObstacle 7 occurs twice"),
        ("<lanelet ", "<lane ", "no well-formed XML"),
        ('successor ref="4"', 'successor ref="99"', "lanelet 3: successor 99 is no lanelet of the file"),
        ('lanelet id="2"', 'lanelet id="1"', "lanelet 1 occurs twice"),
    ],
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


def test_fuzz(tmp_path: Path) -> None:
    """200 random cuts and changes: an InputError or a recording, never anything else."""
    path, chance, refused = tmp_path / "fuzz.xml", random.Random(5), 0
    text = document()
    for _ in range(200):
        begin = chance.randrange(len(text))
        end = min(len(text), begin + chance.randrange(1, 40))
        path.write_text(text[:begin] + chance.choice(["", "0", "<x/>", "-", "1e999", "\0"]) + text[end:])
        try:
            read_commonroad(path)
        except InputError:
            refused += 1
    assert refused > 120


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
