"""OpenDRIVE files: the lanes that they describe are those of the road, section by section."""

import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction as F
from itertools import pairwise
from pathlib import Path

import pytest

from exporting.kept import motion, subject
from roadproof.errors import InputError
from roadproof.recordings.export import opendrive
from roadproof.recordings.export.layout import MARGIN, lay_out, span_of
from roadproof.recordings.export.subject import Subject
from roadproof.world.models import load_road, names_of
from roadproof.world.opendrive import read_lanelets
from roadproof.world.road import Lanelet, Road

Element = ElementTree.Element
Cell = tuple[str, str, str, F, F, F, F]
ATTRIBUTES = {"driving": "main", "entry": "merge", "exit": "departure"}


def root_of(made: Subject) -> Element:
    return ElementTree.fromstring(opendrive.road_file(made))


def sections(root: Element) -> list[tuple[F, F, Element]]:
    """Begin and end of each section along x."""
    (road,) = root.findall("road")
    (line,) = road.findall("planView/geometry")
    assert (line.get("hdg"), [x.tag for x in line]) == ("0", ["line"])
    assert line.get("length") == road.get("length")
    places = [F(x.get("s", "")) for x in road.iter("laneSection")] + [F(road.get("length", ""))]
    begin = F(line.get("x", ""))
    each = zip(pairwise(places), road.iter("laneSection"), strict=True)
    return [(begin + a, begin + b, node) for (a, b), node in each]


def cells(root: Element) -> list[Cell]:
    """Lane, zone, attribute and rectangle of each lane in each section, as a reader of the file has them."""
    found = []
    (line,) = root.findall("road/planView/geometry")
    for low, high, section in sections(root):
        edge = F(line.get("y", ""))
        for number, lane in enumerate(section.findall("right/lane"), 1):
            assert lane.get("id") == str(-number)
            (width,) = lane.findall("width")
            right = edge - F(width.get("a", ""))
            if lane.get("type") != "none":
                said = {x.get("code", ""): x.get("value", "") for x in lane.findall("userData")}
                place = (low, high, right, edge)
                kind = ATTRIBUTES[lane.get("type", "")]
                found.append((said["roadproof:lane"], said["roadproof:zone"], kind, *place))
            edge = right
    return found


def expected(made: Subject) -> list[Cell]:
    """The same from the road, cut wherever a lanelet begins or ends."""
    layout = made.layout
    ends = {x for lanelet in made.file.road.lanelets for x in lanelet.s if x is not None}
    places = sorted({layout.low, layout.high, *ends})
    found = []
    for low, high in pairwise(places):
        for x in made.file.road.lanelets:
            if (x.s[0] is None or x.s[0] <= low) and (x.s[1] is None or high <= x.s[1]):
                found.append((x.lane, x.zone, x.attribute, low, high, *x.d))
    return found


@pytest.mark.parametrize("name", names_of("roads"))
def test_lanes_are_those_of_the_road(name: str) -> None:
    made = subject(name)
    assert sorted(cells(root_of(made))) == sorted(expected(made))


@pytest.mark.parametrize("name", names_of("roads"))
def test_our_own_reader_of_such_roads_finds_the_same_lanes(name: str, tmp_path: Path) -> None:
    """s counts from the begin of the file's road there, d from its left edge; ``userData`` says the zones.

    Without it main lanes beside a departure lane are in its zone even beyond it, as types of lanes go.
    """
    made = subject(name)
    for file, content in opendrive.files(made).items():
        (tmp_path / file).write_bytes(content)
    left = max(x.d[1] for x in made.file.road.lanelets)
    begin = made.layout.low

    def zones_read() -> dict[tuple[object, ...], str]:
        return {
            (
                x.lane,
                x.attribute,
                begin + (x.s[0] or 0),
                begin + (x.s[1] or 0),
                left + x.d[0],
                left + x.d[1],
            ): x.zone
            for x in read_lanelets(path)
        }

    path = tmp_path / "made.xodr"
    ours = {(lane, kind, *place): zone for lane, zone, kind, *place in expected(made)}
    assert zones_read() == ours
    path.write_text(path.read_text().replace("roadproof:zone", "another:zone"))
    read = zones_read()
    assert read.keys() == ours.keys()
    other = {key[0] for key, zone in ours.items() if read[key] != zone}
    assert other == ({"main-1", "main-2"} if name in ("depart", "weave") else set())


def gap() -> Road:
    """A ramp that lies beside the main road with 2 m of grass between, and joins it later."""
    main = Lanelet("a", "main-1", "main", "main", (None, None), (F(0), F("3.5")))
    far = Lanelet("b", "ramp", "merge", "merge", (F(0), F(100)), (F("-5.5"), F(-2)))
    return Road("gap", (main, far), frozenset())


def test_what_lies_between_lanes_is_a_lane_of_no_type() -> None:
    made = subject(gap())
    root = root_of(made)
    assert sorted(cells(root)) == sorted(expected(made))
    middle = sections(root)[1][2]
    assert [x.get("type") for x in middle.findall("right/lane")] == ["driving", "none", "entry"]
    assert [x.find("roadMark").get("type") for x in middle.findall("right/lane")] == ["solid"] * 3  # type: ignore[union-attr]


def test_overlapping_lanelets_are_refused() -> None:
    road = gap()
    wide = replace(road.lanelets[1], d=(F(-2), F(1)))
    with pytest.raises(InputError, match="s = 0 m to 100 m: lanelets a and b overlap"):
        opendrive.road_file(subject(replace(road, lanelets=(road.lanelets[0], wide))))


def test_a_road_with_a_gap_along_it_is_refused() -> None:
    here = Lanelet("a", "main-1", "main", "main", (F(0), F(50)), (F(0), F("3.5")))
    there = replace(here, id="b", lane="main-9", s=(F(60), F(90)))
    with pytest.raises(InputError, match="s = 50 m to 60 m: there is no lanelet"):
        opendrive.road_file(subject(Road("torn", (here, there), frozenset())))


def test_lanes_are_linked_along_the_road_and_nowhere_else() -> None:
    """Ids change where a lane begins on the left; a ramp that ends is linked to nothing."""
    base = load_road("merge")
    left = Lanelet("l", "main-3", "merge", "main", (F(-100), F(300)), (F(7), F("10.5")))
    road = replace(base, lanelets=(*base.lanelets, left))
    links = {}
    for k, (_, _, section) in enumerate(sections(root_of(subject(road)))):
        for lane in section.findall("right/lane"):
            ends = {x.tag: x.get("id") for x in lane.findall("link/*")}
            links[k, lane.get("id")] = (ends.get("predecessor"), ends.get("successor"))
    assert links == {
        **{(0, "-1"): (None, None), (0, "-2"): (None, "-2"), (0, "-3"): (None, "-3")},
        **{(1, "-1"): (None, None), (1, "-2"): ("-2", "-2"), (1, "-3"): ("-3", "-3")},
        **{(1, "-4"): (None, None), (2, "-1"): (None, None), (2, "-2"): ("-2", None)},
        (2, "-3"): ("-3", None),
    }


@pytest.mark.parametrize(("speed", "limit"), [("30", "130"), ("36", "130"), ("40", "150")])
def test_the_speed_is_said_twice(speed: str, limit: str) -> None:
    """Some readers look at one place, some at the other."""
    root = root_of(subject(SV=motion((None, "0", "0"), start=("0", "2", speed, "0"))))
    found = {(x.get("max"), x.get("unit")) for x in root.iter("speed")}
    assert found == {(limit, "km/h")}
    assert root.find("road/type/speed") is not None
    driven = [x for x in root.iter("lane") if x.get("type") == "driving"]
    assert all(x.find("speed") is not None for x in driven)


def test_markings_are_broken_between_lanes_of_one_zone() -> None:
    kinds = [
        [x.find("roadMark").get("type") for x in section.findall("right/lane")]  # type: ignore[union-attr]
        for _, _, section in sections(root_of(subject("depart")))
    ]
    assert kinds == [["broken", "solid"], ["broken", "broken", "solid"], ["broken", "solid", "solid"]]


def test_the_road_goes_as_far_as_the_drive_and_a_margin() -> None:
    car = motion(("2", "-10", "0"), (None, "0", "0"), start=("0", "2", "15", "0"))
    assert span_of([car], F(2)) == (F("-4.5"), F("11.25"))  # foremost at 1.5 s, 10 m at the end
    layout = lay_out(load_road("main-2"), (F("-4.5"), F("11.25")))
    assert (layout.low, layout.high) == (-5 - MARGIN, 12 + MARGIN)
    assert layout.said == "road main-2, cut to s = -105 m to 112 m"
    assert root_of(subject()).find("header").get("name") == subject().layout.said  # type: ignore[union-attr]
