"""Stretches of maps of measured lanelets: edges, lanes, zones, and what is refused."""

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

import roadproof as rp
from extensions.maps.measured_lanelets import RAMP, MapLane, commonroad, place
from roadproof.errors import InputError, UsageError
from roadproof.frontends.cli.main import main
from roadproof.world.models import load_road

CURVATURE = 1 / 400


def write(folder: Path, *lanes: MapLane, curvature: float = 0.0) -> Path:
    path = folder / "a.xml"
    path.write_text(commonroad(lanes, curvature))
    return path


def test_a_bend_with_a_merge_lane_is_a_road(tmp_path: Path) -> None:
    path = write(tmp_path, *RAMP, curvature=CURVATURE)
    (found,) = rp.stretches(path)
    assert (found.select, found.lanes) == (f"{path}#road=1", (2, 3))
    assert [x.zone for x in found.zones] == ["merge"]
    assert found.radius == pytest.approx(400, rel=0.03)
    road = load_road(path)
    assert road.lanes == ("main-1", "main-2", "merge-1")
    assert road.adjacent_lanes("main-1") == ("main-2", "merge-1")
    assert {x.id for x in road.lanelets_of("merge-1")} == {"32"}


def test_edges_are_as_near_to_the_bounds_as_the_answer_says(tmp_path: Path) -> None:
    taper = replace(RAMP[4], end=(-5, -3.5))
    path = write(tmp_path, *RAMP[:4], taper, *RAMP[5:], curvature=CURVATURE)
    for step in (1, 0.25, 0.1):
        (found,) = rp.stretches(f"{path}#step={step}")
        assert 0 < found.width_error <= step
        assert found.line is not None
        for k in range(200):
            s = 121 + k * 198 / 200
            x, d = found.line.locate(*place(s, -7 + 2 * (s - 120) / 200, CURVATURE))
            (edge,) = (
                y.d[0]
                for y in found.lanelets
                if y.lane == "merge-1" and y.s[0] is not None and y.s[1] is not None and y.s[0] <= x < y.s[1]
            )
            assert abs(float(edge) - d) <= float(found.width_error) + 0.01


def test_lanes_side_by_side_have_one_edge_in_common(tmp_path: Path) -> None:
    apart = [replace(x, d=(0.1, 3.5)) if x.id < 20 else x for x in RAMP]
    road = load_road(write(tmp_path, *apart, curvature=CURVATURE))
    assert road.adjacent_lanes("main-1") == ("main-2", "merge-1")
    for x in road.lanelets_of("main-1"):
        assert x.d[1] in {y.d[0] for y in road.lanelets_of("main-2") if y.s == x.s}


def test_the_line_is_as_long_and_as_bent_as_the_way(tmp_path: Path) -> None:
    road = load_road(write(tmp_path, *RAMP, curvature=CURVATURE))
    assert road.line is not None
    way = 1.75 if abs(road.line.locate(*place(220, 1.75, CURVATURE))[1]) < 1 else -1.75
    assert float(road.line.end) == pytest.approx(440 * (1 - way * CURVATURE), abs=0.3)
    for s in (50, 220, 400):
        along, aside = road.line.locate(*place(s, way, CURVATURE))
        assert abs(aside) < 0.3
        assert math.dist(road.line.place(along, aside), place(s, way, CURVATURE)) < 1e-6
    for before, after in pairwise(sorted(x.s for x in road.lanelets_of("main-1") if x.s[0] is not None)):
        assert before[1] == after[0]


def test_a_way_and_a_part_of_it(tmp_path: Path) -> None:
    path = write(tmp_path, *RAMP)
    part = load_road(f"{path}#way=22,from=100,to=300")
    assert min(x.s[0] for x in part.lanelets if x.s[0] is not None) == 100
    assert max(x.s[1] for x in part.lanelets if x.s[1] is not None) == 300
    assert part.map == f"{path}#way=22,from=100,to=300"


RING = tuple(MapLane(k, ((k - 1) * 50, k * 50), (0, 3), (k % 4 + 1,)) for k in (1, 2, 3, 4))


def test_traffic_that_crosses_is_refused_but_a_part_before_it_is_a_road(tmp_path: Path) -> None:
    path = write(tmp_path, *RAMP)
    bounds = [
        "".join(f"<point><x>{x}</x><y>{y}</y></point>" for y in (-30, 0, 30)) for x in (198, 202)
    ]  # from right to left of the road, at s = 200 m
    left, right = (f"<{tag}>{x}</{tag}>" for tag, x in zip(("leftBound", "rightBound"), bounds, strict=True))
    crossing = f'<lanelet id="90">{left}{right}</lanelet></commonRoad>'
    path.write_text(path.read_text().replace("</commonRoad>", crossing))
    with pytest.raises(InputError, match="lanelet 90 crosses it at s = 200 m: only traffic along one road"):
        load_road(f"{path}#road=1")
    assert len(load_road(f"{path}#road=1,to=190").lanelets) == 5
    assert [bool(x.refused) for x in rp.stretches(path)] == [True, True]


def test_rings_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path, *RING, curvature=2 * math.pi / 200)
    with pytest.raises(InputError, match="a ring road is not supported"):
        load_road(path)


def test_lanes_that_overlap_are_refused(tmp_path: Path) -> None:
    wide = [replace(x, d=(-2, 3.5)) if x.id == 12 else x for x in RAMP]
    with pytest.raises(InputError, match=r"lanelets 22 and 12 overlap by 2.0 m at s = 120 m"):
        load_road(write(tmp_path, *wide))


@pytest.mark.parametrize("parts", [True, False])
def test_where_a_lane_parts_or_joins_the_longer_lane_has_the_place(parts: bool, tmp_path: Path) -> None:
    """Lanelet 13 lies on 12 where it branches off, or ends on it, and is beside it 100 m away."""
    aside, on = (-3.5, 0.0), (0.0, 3.5)
    one = MapLane(12, (100, 200), on, (14,), right=13)
    other = MapLane(
        13, (100, 200), on if parts else aside, () if parts else (14,), left=12, end=aside if parts else on
    )
    lanes = (
        MapLane(11, (0, 100), on, (12, 13) if parts else (12,)),
        replace(one, after=(14,)),
        other,
        MapLane(14, (200, 300), on),
    )
    found = load_road(write(tmp_path, *lanes)).lanelets
    main = [x for x in found if x.id.partition(".")[0] != "13"]
    assert all(-1.75 <= x.d[0] <= -1.5 and x.d[1] == 1.75 for x in main)
    branch = sorted((x.s[0] or 0, x.s[1] or 0, *x.d) for x in found if x.id.startswith("13"))
    assert branch
    assert all(right < left <= -1.5 for _, _, right, left in branch)
    for begin, end, _, left in branch:  # side by side everywhere
        assert any((x.s[0] or 0) <= begin and end <= (x.s[1] or 0) and x.d[0] == left for x in main)
    far = branch[-1] if parts else branch[0]
    assert float(far[2]) == pytest.approx(-5.25, abs=0.25)
    near = branch[0] if parts else branch[-1]
    assert near[3] - near[2] < 0.4


def test_edges_are_coarser_where_lanelets_would_be_many(tmp_path: Path) -> None:
    """The outer edge moves by 20 m, the one inside it by 1 m; the others are straight."""
    lanes = (
        MapLane(1, (0, 600), (0, 3.5), right=2),
        MapLane(2, (0, 600), (-3.5, 0), left=1, right=3),
        MapLane(3, (0, 600), (-7, -3.5), left=2, end=(-8, -3.5)),
        MapLane(4, (0, 600), (-10, -7), left=3, end=(-30, -8)),
    )
    path = write(tmp_path, *(replace(x, right=x.id + 1) if x.id < 4 else x for x in lanes))
    coarse, fine = (rp.stretches(f"{path}#road=1{more}")[0] for more in ("", ",step=0.25"))
    assert len(coarse.lanelets) <= 50 < len(fine.lanelets)
    assert fine.width_error < coarse.width_error <= 1
    counts = {lane: sum(x.lane == lane for x in fine.lanelets) for lane in load_road(path).lanes}
    assert sorted(counts.values())[:3] == [1, 1, 4]
    for found in (coarse, fine):
        for x in found.lanelets:
            assert all(
                x.d[1] <= y.d[0] or y.d[1] <= x.d[0]
                for y in found.lanelets
                if y.lane != x.lane and (y.s[0] or 0) < (x.s[1] or 0) and (x.s[0] or 0) < (y.s[1] or 0)
            )


def test_a_way_that_comes_near_itself_is_followed_from_place_to_place(tmp_path: Path) -> None:
    """The end of a loop is where it begins, but no lanelet leads back."""
    turn = 2 * math.pi / 400
    lanes = [MapLane(k, (100.0 * k, 100.0 * k + 100), (0, 0.3), (k + 1,) if k < 3 else ()) for k in range(4)]
    (found,) = rp.stretches(write(tmp_path, *lanes, curvature=turn))
    assert not found.refused
    assert float(found.length) == pytest.approx(400, abs=4)


def test_a_bound_that_turns_back_is_named(tmp_path: Path) -> None:
    path = write(tmp_path, *RAMP)
    point = "<point><x>60.0</x><y>3.5</y></point>"
    text = path.read_text()
    assert point in text
    path.write_text(text.replace(point, point.replace("60.0", "50.0"), 1))
    with pytest.raises(
        InputError, match=r"left bound of lanelet 11: .* by 6\.0 m, as it turns by 180 degrees"
    ):
        load_road(path)


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("#road=2", "road=2: a number from 1 to 1 is needed"),
        ("#way=5", "there is no lanelet 5"),
        ("#route=1+2", "lanes and route are for OpenDRIVE"),
        ("#road=1,way=11", "road and way: name one of them"),
        ("#from=500", "the road goes from 0 m to"),
    ],
)
def test_mistakes_in_a_selection_are_named(tmp_path: Path, said: str, told: str) -> None:
    path = write(tmp_path, *RAMP)
    with pytest.raises((InputError, UsageError), match=told):
        load_road(f"{path}{said}")


def test_a_way_of_a_road_in_opendrive_is_refused() -> None:
    with pytest.raises(UsageError, match="is named by road=ID"):
        load_road("a.xodr#way=1")


def test_versions_that_are_not_known_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path, *RAMP)
    path.write_text(commonroad(RAMP, version="2018b"))
    assert load_road(path).lanes == ("main-1", "main-2", "merge-1")
    path.write_text(commonroad(RAMP, version="1"))
    with pytest.raises(InputError, match="commonRoadVersion=1: commonRoad of version 2020a or 2018b"):
        load_road(path)


def test_a_drive_on_a_map_is_read_back_from_openscenario(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = write(tmp_path, *RAMP, curvature=CURVATURE), str(tmp_path / "out")
    asked = ["witness", "9", "--road", f"{path}#road=1", "--no-pictures", "--out", out]
    assert main(asked) == 0
    assert main(["export", f"{out}/scenario-09-base.json", "--to", "openscenario", "--out", out]) == 0
    assert main(["monitor", "9", f"{out}/scenario-09-base.xosc"]) == 0
    assert "scenario_9(SV, POV, L): true" in capsys.readouterr().out
    there, back = load_road(path), load_road(f"{out}/scenario-09-base.xodr")
    assert there.line is not None
    assert back.line is not None
    found = {(x.lane, x.zone, x.d): x.s for x in back.lanelets}
    assert {(x.lane, x.zone, x.d) for x in there.lanelets} <= found.keys()
    # Beside them are lanelets of a metre, on which edges go from one place to the next.
    steps = found.keys() - {(x.lane, x.zone, x.d) for x in there.lanelets}
    assert {high - low for low, high in (found[x] for x in steps) if high} <= {1}
    for s, d in ((0, -7), (101.5, 0), (222.2, 3.5), (300, -3.5), (430, -7)):
        assert math.dist(there.line.place(s, d), back.line.place(s, d)) < 0.02
