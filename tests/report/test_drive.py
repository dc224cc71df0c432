"""What the picture of a drive shows, tested on its data and on the figure's labels, not on pixels."""

from dataclasses import replace
from fractions import Fraction as F
from itertools import pairwise

import pytest

from report.edges import cut_off
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.frontends.report.drive import SNAPSHOTS, compose_drive
from roadproof.frontends.report.drive_data import (
    Danger,
    Strip,
    dangers_of,
    distances_of,
    place_names,
    road_in,
    strips_of,
    times_of,
    window_of,
)
from roadproof.frontends.report.one_trace import compose_strips
from roadproof.library.bind import bind, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library, load_library
from roadproof.library.specification import Source
from roadproof.recordings.evaluate.observed import observe_drive
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road

LIBRARY = bundled_library()
SIZE = {"length": F(5), "width": F(2)}


def driving(s: int, v_lon: int, d: F = F(3), v_lat: F = F(0)) -> Motion:
    """At constant speed, in the right lane of main-2 unless said otherwise."""
    return Motion(**SIZE, s=F(s), d=d, v_lon=F(v_lon), v_lat=v_lat, pieces=(Piece(None, F(0), F(0)),))


FOUR = "scenario_4(SV, POV, L)"


def file_of(scenario: int | None = 4, formula: str = FOUR, **vehicles: Motion) -> DriveFile:
    """SV at 30 m/s comes up 100 m behind POV at 20 m/s: 10 m less every second."""
    drive = Drive(vehicles or {"SV": driving(0, 30), "POV": driving(105, 20)})
    road = load_road("main-2")
    return DriveFile(scenario, "base", formula, F(6), {"L": "main-1"}, {}, {}, road, drive)


def strips(file: DriveFile) -> tuple[Strip, ...]:
    judgement = judge_file(file, LIBRARY).judgement
    assert judgement is not None
    return strips_of(judgement, file.horizon)


def test_every_part_has_a_strip_below_what_it_is_part_of() -> None:
    shown = [(x.depth, x.name) for x in strips(file_of())]
    assert len(shown) == 29
    assert shown[:4] == [
        (0, "scenario_4(SV, POV, main-1)"),
        (1, "initSafe(SV, POV)"),
        (2, "instSafe(SV, POV)"),
        (3, "rssViolation(SV, POV)"),
    ]
    at = {name: (place, depth) for place, (depth, name) in enumerate(shown)}
    order = ("roadSector_4(SV, POV)", "disturb_4(SV, POV, main-1)", "behaviourSV_4(SV, POV, main-1)")
    assert sorted(order, key=lambda name: at[name][0]) == list(order)
    assert [at[name][1] for name in order] == [1, 1, 2]
    assert at["danger(SV, POV)"][1] == 3
    for (before, _), (after, _) in pairwise(shown):
        assert after <= before + 1


def test_a_strip_ends_with_the_drive() -> None:
    [violation] = [x for x in strips(file_of()) if x.name == "rssViolation(SV, POV)"]
    [(begin, end)] = violation.spans
    assert 0 < begin < end == 6.0
    assert [x.spans for x in strips(file_of()) if x.name == "dangerLeft(POV, SV)"] == [((0.0, 6.0),)]


def rss_lon(rear: float, front: float) -> float:
    """The paper's eq. lon_RSS for the declared parameters, written again."""
    return max(0.0, rear * 0.6 + 5 * 0.36 / 2 + (rear + 3) ** 2 / 12 - front**2 / 16)


def test_gaps_and_rss_distances_are_the_papers() -> None:
    file = file_of()
    [along] = distances_of(file, LIBRARY, "along")
    assert along.gap[0] == 100.0
    assert along.gap[10] == pytest.approx(90.0)
    assert along.needed == pytest.approx([rss_lon(30, 20)] * 61)
    [across] = distances_of(file, LIBRARY, "across")
    assert set(across.gap) == {-2.0}
    assert across.needed[0] == pytest.approx(1.08)  # both go straight on: a_max_lat ρ² + 2 (ρ a)²/(2 b)
    assert len(along.gap) == len(across.gap) == len(times_of(file)) == 61


def test_the_lateral_distance_grows_with_the_speed_towards_each_other() -> None:
    """Semantics §3: (v_1, v_2) = (1, -1) is 4.1467 m; the left one moves right, the right one left."""
    nearing = {"SV": driving(0, 30, v_lat=F(1)), "POV": driving(60, 30, F(13, 2), F(-1))}
    [across] = distances_of(file_of(**nearing), LIBRARY, "across")
    assert across.gap[0] == 1.5
    assert across.needed[0] == pytest.approx(4.146667, abs=1e-5)
    assert across.needed[-1] == pytest.approx(0.0)  # they have passed each other and move apart


def test_who_is_behind_may_change() -> None:
    overtaking = {"SV": driving(0, 20), "POV": driving(-25, 30, F(13, 2))}
    [along] = distances_of(file_of(**overtaking), LIBRARY, "along")
    assert (along.gap[0], along.needed[0]) == (20.0, pytest.approx(rss_lon(30, 20)))
    assert (along.gap[-1], along.needed[-1]) == (30.0, pytest.approx(rss_lon(20, 30)))
    assert min(along.gap) == -5.0
    assert [*along.runs] == [slice(0, 25), slice(25, 61)]  # side by side at 2.5 s


def test_distances_follow_options_and_values() -> None:
    slower = replace(file_of(), values={"rho": F(0), "a_max": F(0)})
    [along] = distances_of(slower, LIBRARY, "along")
    assert along.needed[0] == pytest.approx(30**2 / 12 - 20**2 / 16)


def test_a_library_without_such_a_distance_has_none() -> None:
    other = load_library([Source("mine.spec", "def dangerAhead(a, b: vehicle) := s(a) < s(b)")])
    assert distances_of(file_of(), other, "along") == ()
    assert len(distances_of(file_of(), other, "across")) == 1
    assert compose_drive(file_of(), other).axes


def test_danger_begins_where_the_judge_says() -> None:
    [danger] = dangers_of(file_of(), LIBRARY)
    assert (danger.one, danger.other) == ("SV", "POV")
    assert danger.begins == pytest.approx((100 - rss_lon(30, 20)) / 10)
    safe = {"SV": driving(0, 20), "POV": driving(105, 30)}
    assert dangers_of(file_of(**safe), LIBRARY) == ()


def test_of_three_vehicles_each_has_its_danger() -> None:
    three = {"POV2": driving(105, 20), "SV": driving(0, 30), "POV1": driving(130, 20)}
    dangers = dangers_of(file_of(2, "scenario_2(SV, POV1, POV2, L)", **three), LIBRARY)
    assert [x.other for x in dangers] == ["POV2", "POV1"]
    assert str(Danger("SV", "POV1", 2.345)) == "danger between SV and POV1 from 2.3 s on"


def test_lanes_and_zones_that_are_seen() -> None:
    road = road_in(load_road("merge"), F(-150), (-20.0, 80.0))
    assert [name for name, _ in road.lanes] == ["main-1", "main-2", "merge-1"]
    assert road.zones == ("main", "merge")
    assert road_in(load_road("merge"), F(-500), (-20.0, 80.0)).zones == ("main",)
    low, high = window_of(file_of(), [F(0), F(6)])
    assert low < -5
    assert high > 105


def meet(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    return one[0] < other[1] and other[0] < one[1] and one[2] < other[3] and other[2] < one[3]


def test_names_of_vehicles_are_on_nothing() -> None:
    boxes = {"SV": (0.0, 5.0, 1.0, 3.0), "POV1": (6.0, 11.0, 1.0, 3.0), "POV2": (12.0, 17.0, 1.0, 3.0)}
    names = place_names(boxes, dict.fromkeys(boxes, (4.0, 1.5)))
    placed = [*names.values()]
    for k, name in enumerate(placed):
        assert not any(meet(name, box) for box in boxes.values())
        assert not any(meet(name, other) for other in placed[:k])
    assert names["POV2"][0] > 17.0


def test_the_figure_says_what_it_shows() -> None:
    figure = compose_drive(file_of(), LIBRARY)
    title = figure.get_suptitle().splitlines()
    assert title[0] == "Scenario 4: deceleration ahead, lane keep, main road"
    assert title[1].startswith("Main road: you (SV) keep your lane")
    assert title[2] == f"set base, road main-2, L = main-1; {dangers_of(file_of(), LIBRARY)[0]}"
    roads, panels = figure.axes[:SNAPSHOTS], figure.axes[SNAPSHOTS:]
    assert [x.get_text() for x in roads[0].get_yticklabels()] == ["main-1", "main-2"]
    assert [x.get_text() for x in roads[0].get_legend().get_texts()] == ["main road"]
    assert any("driving direction" in text.get_text() for one in roads for text in one.texts)
    assert len({one.get_xlim() for one in roads}) == 1
    assert [one.get_ylabel() for one in panels[:3]] == ["speed, m/s", "gap along, m", "gap across, m"]
    assert {one.get_xlim() for one in panels} == {(0.0, 6.0)}
    [danger] = dangers_of(file_of(), LIBRARY)
    for one in panels:
        assert any([*line.get_xdata()] == [danger.begins] * 2 for line in one.get_lines())
        assert one.get_legend().get_bbox_to_anchor().x0 >= one.bbox.x1  # beside the curves
    rows = [x.get_text() for x in panels[3].get_yticklabels()]
    assert rows == ["  " * x.depth + x.name for x in strips(file_of())]


def test_nothing_is_cut_off() -> None:
    three = {"POV2": driving(105, 20), "SV": driving(0, 30), "POV1": driving(60, 20, F(13, 2), F(-1, 2))}
    long = " and ".join(["scenario_2(SV, POV1, POV2, L)", "aheadOf(SV, POV1)"] * 5)
    assert cut_off(compose_drive(file_of(None, long, **three), LIBRARY)) == []
    assert cut_off(compose_drive(file_of(), LIBRARY)) == []


def test_a_formula_is_its_own_title() -> None:
    file = file_of(None, "F danger(SV, POV)")
    assert compose_drive(file, LIBRARY).get_suptitle().splitlines()[0] == "F danger(SV, POV)"
    assert compose_drive(file, LIBRARY, "mine").get_suptitle().splitlines()[0] == "mine"


def test_strips_of_one_trace_are_all_there() -> None:
    file = file_of()
    claim = read_claim(LIBRARY.select("base"), " and ".join(f"scenario_{k}(SV, POV, L)" for k in (1, 4, 8)))
    formula = bind(claim.formula, file.road, file.lanes, values_with(LIBRARY, {}))
    observed = observe_drive("three", formula, file.drive, file.horizon, F(1, 10))
    [axes] = compose_strips(observed).axes
    rows = [x.get_text() for x in axes.get_yticklabels()]
    assert len(rows) == len(observed.strips) > 40
    assert rows[:3] == ["three", "  scenario_1(SV, POV, main-1)", "    initSafe(SV, POV)"]
