"""Zones of measured roads: from types, from how lanelets follow and neighbour each other, as a user says."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from extensions.traffic.make_recording import Track, cruise, make_recording
from extensions.traffic.planar import commonroad_of, numbers_of
from roadproof.errors import InputError
from roadproof.extensions.exchange.commonroad import read_commonroad
from roadproof.extensions.maps.topology import MeasuredLanelet, attributes_of, chains_of, main_way
from roadproof.extensions.traffic.evaluate.one_trace import read_pair
from roadproof.extensions.traffic.evaluating import roads
from roadproof.extensions.traffic.formats.lanelets import network_of
from roadproof.extensions.traffic.formats.sources import find_source
from roadproof.world.models import load_road
from roadproof.world.road import Lanelet, Road
from tables import read_table

US101 = Path(__file__).parents[4] / "shared" / "data" / "us101"


def with_ramps(name: str) -> Road:
    """A reference road whose ramps come from beside it, and go on beside it."""
    road = load_road(name)
    made: list[Lanelet] = []
    for lanelet in road.lanelets:
        if lanelet.attribute == "merge":
            low = lanelet.s[0]
            assert low is not None
            made += [lanelet, replace(lanelet, id=f"{lanelet.id}-before", s=(low - 120, low))]
        elif lanelet.attribute == "departure":
            low = lanelet.s[0] or Fraction(0)
            (end,) = (x.s[1] or low for x in road.lanelets if x.lane == "main-1" and x.s[0] == low)
            made += [
                replace(lanelet, s=(low, end)),
                replace(lanelet, id=f"{lanelet.id}-after", s=(end, end + 120)),
            ]
        else:
            made.append(lanelet)
    return Road(name, tuple(made), road.adjacent)


@pytest.mark.parametrize("name", ["merge", "depart", "weave"])
@pytest.mark.parametrize("typed", [True, False])
def test_reference_roads(name: str, typed: bool, tmp_path: Path) -> None:
    """With types of ramps and with none, the zones and attributes of models/roads come out."""
    road = with_ramps(name)
    recording = make_recording([Track(2, 0, cruise(-50, 30, 3, 2.7)), Track(2, 0, cruise(20, 30, 3, -0.9))])
    path = tmp_path / "a.xml"
    text = (
        commonroad_of(recording, road) if typed else commonroad_of(recording, road, types=lambda _: "urban")
    )
    path.write_text(text)
    r = read_commonroad(path)
    number = numbers_of(road)
    expected = {str(number[x.id]): (x.zone, x.attribute) for x in road.lanelets}
    assert {x.id: (x.zone, x.attribute) for x in r.lanelets} == expected
    inferred = [note for note in r.notes if "inferred" in note]
    ramps = {x.lane for x in road.lanelets if x.attribute != "main"}
    assert len(inferred) == (0 if typed else len(ramps))
    assert len(r.lanes) == len(road.lanes)
    trace = read_pair(f"{path}:1,2")
    assert {x.zone for x in trace.road.lanelets} == {x.zone for x in road.lanelets}


def strip(
    name: str, begin: tuple[float, float], end: tuple[float, float], **more: tuple[str, ...]
) -> MeasuredLanelet:
    line = np.array([begin, end])
    across = np.array([begin[1] - end[1], end[0] - begin[0]])
    aside = 1.75 * across / np.hypot(*across)
    links = {"successors": (), "beside": (), **more}
    return MeasuredLanelet(name, line + aside, line - aside, None, links["successors"], links["beside"])


def by_id(*lanelets: MeasuredLanelet) -> dict[str, MeasuredLanelet]:
    return {x.id: x for x in lanelets}


def test_branches() -> None:
    """r leads into b; b goes on in c, which is straight, and in e, which turns away."""
    lanelets = by_id(
        strip("r", (-90, -40), (100, 0), successors=("b",)),
        strip("a", (0, 0), (100, 0), successors=("b",)),
        strip("b", (100, 0), (300, 0), successors=("e", "c")),
        strip("c", (300, 0), (400, 0)),
        strip("e", (300, 0), (400, -30), successors=("f",)),
        strip("f", (400, -30), (500, -60)),
    )
    assert chains_of(lanelets) == (("r",), ("a", "b", "c"), ("e", "f"))
    assert attributes_of(lanelets) == {
        "r": ("merge", "leads into b"),
        "a": ("main", ""),
        "b": ("main", ""),
        "c": ("main", ""),
        "e": ("departure", "leaves b"),
        "f": ("departure", "leaves b"),
    }
    network = network_of(Path("x"), lanelets)
    assert [lane.lanelets for lane in network.lanes] == [("r",), ("a", "b", "c"), ("e", "f")]
    assert network.main == (("a", "b", "c"),)
    assert network.zones == {
        "r": "merge",
        "a": "main",
        "b": "main",
        "c": "main",
        "e": "depart",
        "f": "depart",
    }


def test_a_long_ramp_is_no_main_road() -> None:
    """The ramp is longer than each lane of the main road, which has two lanes."""
    lanelets = by_id(
        strip("ramp", (-500, -90), (100, -3.5), successors=("aux",)),
        strip("aux", (100, -3.5), (200, -3.5), beside=("m2",)),
        strip("m1", (0, 0), (100, 0), successors=("m2",), beside=("n1",)),
        strip("m2", (100, 0), (200, 0), beside=("n2",)),
        strip("n1", (0, 3.5), (100, 3.5), successors=("n2",)),
        strip("n2", (100, 3.5), (200, 3.5)),
    )
    assert main_way(lanelets, chains_of(lanelets)) in (("m1", "m2"), ("n1", "n2"))
    found = attributes_of(lanelets)
    assert {name for name, (attribute, _) in found.items() if attribute == "merge"} == {"ramp", "aux"}
    assert network_of(Path("x"), lanelets).zones["n2"] == "merge"


def test_lanes_that_only_end_or_begin_at_the_edge_of_the_map_are_main() -> None:
    lanelets = by_id(strip("a", (0, 0), (100, 0), beside=("b",)), strip("b", (0, 3.5), (100, 3.5)))
    assert {attribute for attribute, _ in attributes_of(lanelets).values()} == {"main"}


def test_a_ring_is_one_chain() -> None:
    lanelets = by_id(
        strip("a", (0, 0), (50, 50), successors=("b",)),
        strip("b", (50, 50), (0, 100), successors=("a",)),
    )
    assert chains_of(lanelets) == (("a", "b"),)
    assert len(network_of(Path("x"), lanelets).lanes) == 1


def test_more_than_32_lanes_are_refused_and_more_lanelets_are_not() -> None:
    many = [
        strip(f"{k}", (10 * k, 0), (10 * k + 10, 0), successors=(f"{k + 1}",) if k < 99 else ())
        for k in range(100)
    ]
    assert len(network_of(Path("x"), by_id(*many)).lanes) == 1
    apart = [strip(f"{k}", (0, 9 * k), (10, 9 * k)) for k in range(33)]
    with pytest.raises(InputError, match="x: 33 lanes; at most 32 are supported"):
        network_of(Path("x"), by_id(*apart))


def urban(folder: Path, zones: str = "") -> Path:
    """The merge road, all typed urban, with the merge lane as lanelet 1007 and its ramp as 1008."""
    recording = make_recording([Track(2, 0, cruise(-50, 30, 3, 2.7))])
    path = folder / "a.xml"
    path.write_text(commonroad_of(recording, with_ramps("merge"), types=lambda _: "urban"))
    if zones:
        (folder / "a_zones.toml").write_text(zones)
    return path


def test_a_user_says_otherwise(tmp_path: Path) -> None:
    zones = '[[lanelet]]\nid = 1007\nattribute = "departure"\n[[lanelet]]\nid = "1002"\nzone = "main"\n'
    path = urban(tmp_path, zones)
    r = read_commonroad(path)
    said = {x.id: (x.zone, x.attribute) for x in r.lanelets}
    assert said["1007"] == ("depart", "departure")
    assert said["1008"] == ("merge", "merge")
    assert said["1002"] == ("main", "main")
    assert said["1005"] == ("depart", "main")
    assert "lanelet 1007: attribute departure, as said in its zones.toml" in r.notes
    assert [x.name for x in find_source(path).files] == ["a_zones.toml", "a.xml"]
    (told,) = roads(path)
    assert "  departure lane 1007, direction 1: 1007 in zone depart" in str(told).splitlines()


@pytest.mark.parametrize(
    ("zones", "said"),
    read_table(__file__, "what_a_user_cannot_say"),
)
def test_what_a_user_cannot_say(zones: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=said):
        read_commonroad(urban(tmp_path, zones))


@pytest.mark.skipif(not US101.is_dir(), reason="the US-101 recordings are not here: ../shared/data/us101")
def test_us101() -> None:
    """The auxiliary lane comes in in four windows and goes out in one; three have none."""
    found = {}
    for road in roads(US101):
        found[road.recording] = [
            (attribute, ids)
            for _, _, lanelets in road.lanes
            for attribute, ids in [(lanelets[0][1], [x for x, _, _ in lanelets])]
            if attribute != "main"
        ]
    assert found == {
        "USA_US101-10_4_T-1": [("merge", ["4", "30"])],
        "USA_US101-11_4_T-1": [],
        "USA_US101-12_1_T-1": [("merge", ["9", "8"])],
        "USA_US101-16_2_T-1": [],
        "USA_US101-25_2_T-1": [("merge", ["12", "11"])],
        "USA_US101-29_1_T-1": [("merge", ["5", "4"])],
        "USA_US101-3_1_T-1": [("departure", ["23", "22"])],
        "USA_US101-8_4_T-1": [],
    }
