"""What the picture of a drive shows, tested on its data and on the figure's labels, not on pixels."""

import json
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction
from fractions import Fraction as F
from itertools import pairwise
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.evidence.drive_file import DriveFile, load_drive, read_drive
from roadproof.evidence.judged import judge_file
from roadproof.extensions.pages.drive_data import (
    Danger,
    Strip,
    danger_spans,
    dangers_of,
    distances_of,
    road_in,
    strips_of,
    times_of,
    vehicles_of,
    window_of,
)
from roadproof.extensions.pages.moving import draw_moving
from roadproof.extensions.pages.places import nearest, places_of
from roadproof.extensions.pages.scene import AnimationScene
from roadproof.extensions.pages.viewer_data import ShownFormula, viewer_data
from roadproof.extensions.pages.viewer_page import json_in_html, viewer_modules, viewer_page, viewer_style
from roadproof.extensions.pages.viewer_recorded import recorded_data
from roadproof.extensions.traffic.evaluate.observed import observe_drive
from roadproof.extensions.traffic.evaluate.one_trace import sample_drive
from roadproof.extensions.traffic.report.one_trace import draw_strips
from roadproof.frontends.report.colours import DANGER
from roadproof.library.bind import bind, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library, load_library
from roadproof.library.specification import Source
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road
from roadproof.world.motion import state_at

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


def test_strips_of_one_trace_are_all_there() -> None:
    file = file_of()
    claim = read_claim(LIBRARY.select("base"), " and ".join(f"scenario_{k}(SV, POV, L)" for k in (1, 4, 8)))
    formula = bind(claim.formula, file.road, file.lanes, values_with(LIBRARY, {}))
    observed = observe_drive("three", formula, file.drive, file.horizon, F(1, 10))
    [axes] = draw_strips(observed).axes
    rows = [x.get_text() for x in axes.get_yticklabels()]
    assert len(rows) == len(observed.strips) > 40
    assert rows[:3] == ["three", "  scenario_1(SV, POV, main-1)", "    initSafe(SV, POV)"]


# --- The moving picture of a drive, tested on what is drawn at each instant, not on pixels ----------

SVG = "{http://www.w3.org/2000/svg}"
CROSSING = {"SV": driving(0, 20), "POV": driving(-25, 30, F(13, 2), F(-1, 2))}
BEHIND = {"SV": driving(100, 20), "POV": driving(0, 30)}
THREE = {"SV": driving(0, 30), "POV1": driving(60, 28), "POV2": driving(105, 20)}
DRIVES = {
    "ahead": file_of(),
    "overtaken": file_of(None, "F danger(SV, POV)", **CROSSING),
    "behind": file_of(None, "F danger(SV, POV)", **BEHIND),
    "three": file_of(2, "scenario_2(SV, POV1, POV2, L)", **THREE),
}


def rectangles(file: DriveFile) -> list[ElementTree.Element]:
    root = ElementTree.fromstring(draw_moving(file, LIBRARY))
    return [x for x in root.iter(f"{SVG}rect") if x.get("x") is not None]


def at_instants(shape: ElementTree.Element, instants: int) -> list[tuple[float, ...]]:
    """Left, top, width and height at each instant, as a browser shows them."""
    moved = {x.get("attributeName"): (x.get("values") or "").split(";") for x in shape.iter(f"{SVG}animate")}
    still = [[shape.get(name) or ""] * instants for name in ("x", "y", "width", "height")]
    shown = [moved.get(name, same) for name, same in zip(("x", "y", "width", "height"), still, strict=True)]
    return [tuple(float(values[k]) for values in shown) for k in range(instants)]


def meeting(one: tuple[float, ...], other: tuple[float, ...], room: float) -> bool:
    """Whether two boxes meet, if both were wider by ``room`` pixels."""
    return min(other[2:]) > 0 and all(
        one[k] < other[k] + other[k + 2] + room and other[k] < one[k] + one[k + 2] + room for k in (0, 1)
    )


def drawn(shapes: list[ElementTree.Element], colour: str) -> ElementTree.Element:
    """The first shape of a colour, which is the vehicle; strips over time stand below it."""
    return next(x for x in shapes if x.get("fill") == colour and not x.get("fill-opacity"))


def red_at(area: ElementTree.Element, times: list[F]) -> list[bool]:
    """Whether an area is red, at each instant."""
    [change] = [x for x in area.iter(f"{SVG}animate") if x.get("attributeName") == "fill"]
    values = (change.get("values") or "").split(";")
    since = [float(x) * 7 for x in (change.get("keyTimes") or "").split(";")]
    return [values[sum(begin <= time + F(1, 1000) for begin in since) - 1] == DANGER for time in times]


@pytest.mark.parametrize("name", DRIVES)
def test_an_area_is_red_exactly_while_the_vehicle_is_in_it(name: str) -> None:
    file = DRIVES[name]
    scene = AnimationScene(file, LIBRARY)
    shapes = rectangles(file)
    areas = [x for x in shapes if x.get("fill-opacity")]
    others = vehicles_of(file)[1:]
    assert len(areas) == len(others)
    seen = set()
    for other, area in zip(others, areas, strict=True):
        box = drawn(shapes, scene.colours[other])
        boxes, reached = (at_instants(x, len(scene.times)) for x in (box, area))
        for red, one, two in zip(red_at(area, scene.times), boxes, reached, strict=True):
            assert meeting(one, two, 0.3 if red else -0.3) == red
            seen.add(red)
    assert seen == {True, False}


@pytest.mark.parametrize("name", DRIVES)
def test_danger_is_red_for_as_long_as_it_must_last(name: str) -> None:
    scene = AnimationScene(DRIVES[name], LIBRARY)
    areas = [x for x in rectangles(scene.file) if x.get("fill-opacity")]
    least = LIBRARY.parameters["minDanger"].value
    for other, area in zip(vehicles_of(scene.file)[1:], areas, strict=True):
        spans = danger_spans(scene.file, LIBRARY, "SV", other)
        red = red_at(area, scene.times)
        for k, time in enumerate(scene.times):
            last = min(len(red) - 1, k + int(least * 10))
            in_danger = any(begin < time < end for begin, end in spans)
            if in_danger:
                assert all(red[k : last + 1])
            elif all(red[k : last + 1]):
                assert any(abs(time - x) < 0.1 for span in spans for x in span)


def test_vehicles_stand_where_the_drive_has_them() -> None:
    scene = AnimationScene(DRIVES["ahead"], LIBRARY)
    shapes = rectangles(DRIVES["ahead"])
    sv, pov = (drawn(shapes, scene.colours[name]) for name in ("SV", "POV"))
    ahead = [b[0] - a[0] for a, b in zip(*(at_instants(x, 61) for x in (sv, pov)), strict=True)]
    assert ahead[0] / scene.scale[0] == pytest.approx(105, abs=0.05)
    assert ahead[60] / scene.scale[0] == pytest.approx(45, abs=0.05)
    assert ahead[30] / scene.scale[0] == pytest.approx(75, abs=0.05)


def test_text_of_a_drive_cannot_become_markup() -> None:
    formula = "v_lon(SV) <v_lon(POV)"
    drawn = draw_moving(replace(DRIVES["ahead"], scenario=None, formula=formula), LIBRARY).decode()
    assert formula not in drawn
    assert formula.replace("<", "&lt;") in drawn


def test_the_same_drive_gives_the_same_file() -> None:
    assert draw_moving(file_of(4, FOUR), LIBRARY) == draw_moving(file_of(4, FOUR), LIBRARY)


def test_a_drive_of_one_vehicle_speaks_of_no_distances() -> None:
    shown = draw_moving(file_of(None, "v_lon(SV) > 0 m/s", SV=driving(0, 30)), LIBRARY).decode()
    assert "the view follows SV<" in shown
    assert "RSS" not in shown
    assert "danger" not in shown


def test_danger_that_no_definition_speaks_of_has_no_row(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.extensions.pages.drive_data.danger_spans", lambda *_: None)
    shown = draw_moving(file_of(), LIBRARY).decode()
    assert "danger between" not in shown
    assert "danger begins" not in shown


@pytest.mark.parametrize(("horizon", "ticks"), [(6, 7), (40, 9), (400, 9)])
def test_ticks_of_a_long_drive_do_not_run_into_each_other(horizon: int, ticks: int) -> None:
    root = ElementTree.fromstring(draw_moving(replace(file_of(), horizon=F(horizon)), LIBRARY))
    told = [x.text or "" for x in root.iter(f"{SVG}text")]
    assert sum(x.removesuffix(" s").isdecimal() for x in told) == ticks


# --- The document of the viewer says what the judge says; its files are whole, and its page asks nobody

VIEWER = Path(__file__).parents[4] / "src" / "roadproof" / "extensions" / "pages" / "viewer"
VIEWED = Path(__file__).parents[4] / "examples" / "traffic" / "drives"
FILE = load_drive(next(VIEWED.glob("*04-base.json")))


def moved(knots: list[list[float]], time: float) -> tuple[float, float]:
    """Where a vehicle is, as the viewer computes it."""
    begun, s, d, v_lon, v_lat, a_lon, a_lat, j_lon = [x for x in knots if x[0] <= time][-1]
    t = time - begun
    return s + t * (v_lon + t * (a_lon / 2 + j_lon * t / 6)), d + t * (v_lat + a_lat * t / 2)


def test_places_between_knots_and_truth_are_those_of_the_judge() -> None:
    document = viewer_data(FILE, LIBRARY).as_json()
    for name, vehicle in document["drive"]["vehicles"].items():
        for tenth in range(0, 61, 7):
            state = state_at(FILE.drive.vehicles[name], Fraction(tenth, 10))
            assert moved(vehicle["knots"], tenth / 10) == pytest.approx((float(state.s), float(state.d)))
    judgement = judge_file(FILE, LIBRARY).judgement
    assert judgement is not None
    [shown] = document["formulas"]
    told = {x["text"]: x["exact"] for x in shown["parts"] if x["op"] == "name"}
    assert told == {f"{x.name}({', '.join(x.arguments)})": str(truth) for x, truth in judgement.named()}
    assert shown["holds"] is True
    assert shown["parts"][0]["margins"][0] > 0
    json.dumps(document, allow_nan=False)
    assert read_drive({**document["file"], "verdict": {}}, "document") == FILE


def test_every_part_is_in_the_tree_once() -> None:
    parts = viewer_data(FILE, LIBRARY).as_json()["formulas"][0]["parts"]
    reached, waiting = set(), [0]
    while waiting:
        place = waiting.pop()
        reached.add(place)
        waiting += [x for x in parts[place]["children"] if x not in reached]
    assert reached == set(range(len(parts)))


def test_a_formula_that_cannot_be_judged_says_why_and_leaves_the_others() -> None:
    asked = [
        ShownFormula("question", "danger(SV,POV2)"),
        ShownFormula("watch", "v_lon(SV) > 1 m/s"),
        ShownFormula("watch", "("),
    ]
    wrong, right, broken = viewer_data(FILE, LIBRARY, asked).as_json()["formulas"]
    assert "mentions POV2" in wrong["error"]
    assert right["holds"] is True
    assert "ends too early" in broken["error"]


def test_margins_are_left_out_where_bounds_are_too_fine() -> None:
    [shown] = viewer_data(
        FILE, LIBRARY, [ShownFormula("question", "F[0, 0.123 s] v_lon(SV) > 1 m/s")]
    ).as_json()["formulas"]
    assert shown["step"] == 0
    assert "margins" not in shown["parts"][0]
    assert shown["parts"][0]["true"]


def test_reasons_are_told_in_the_tree_and_in_the_texts_of_the_user() -> None:
    mine = Source(
        "mine", "set mine extends base {\n def danger(a, b: vehicle) := G[0, 1 s] v_lon(a) < 1 m/s\n}\n"
    )
    home = load_library([mine]).select("mine")
    asked = ShownFormula("question", "F danger(SV,POV)", home, explain=(0, Fraction(0)))
    [shown] = viewer_data(FILE, LIBRARY, [asked]).as_json()["formulas"]
    assert shown["holds"] is False
    because = [shown["parts"][int(k)]["text"] for k in shown["because"]]
    assert because == [
        "F danger(SV, POV)",
        "danger(SV, POV)",
        "G[0, 1 s] v_lon(SV) < 1 m/s",
        "v_lon(SV) < 1 m/s",
    ]
    said = {(x["source"], *x["from"], *x["to"]) for x in shown["said"]}
    assert said == {("formula", 1, 3, 1, 17), ("mine", 2, 41, 2, 57)}
    [refused] = viewer_data(
        FILE, LIBRARY, [ShownFormula("question", "v_lon(SV) > 0", explain=(99, Fraction(0)))]
    ).as_json()["formulas"]
    assert "part=99" in refused["error"]


def test_parts_of_the_library_are_said_where_the_text_calls_them() -> None:
    query = read_claim(LIBRARY.select(), "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)")
    seen = [x for x in places_of(LIBRARY.select(), query) if x.source == "formula"]
    part = read_claim(LIBRARY.select(), "behaviourSV_4(SV,POV,L)").formula
    assert [x.at.column for x in nearest(seen, part)] == [26]


def test_texts_cannot_leave_the_document_of_a_page() -> None:
    hostile = "</script><img src=x onerror=alert(1)>\u2028<!--"
    text = json_in_html({"formula": hostile})
    assert json.loads(text) == {"formula": hostile}
    assert not re.search("[<>&\u2028\u2029]", text)
    page = viewer_page([viewer_data(FILE, LIBRARY).as_json()], hostile)
    assert "<img" not in page
    assert page.count("</script>") == 3


def test_a_page_names_no_other_place() -> None:
    page = viewer_page([viewer_data(FILE, LIBRARY).as_json()], "A drive")
    assert "default-src 'none'" in page
    above = page.partition('<script type="importmap">')[0]
    assert not re.search(r"\b(?:src|href)\s*=|url\(\s*['\"]?(?!data:)|@import|https?:", above)


def test_every_import_of_the_viewer_is_a_file_of_the_viewer() -> None:
    modules = viewer_modules()
    for name, text in modules.items():
        if name.startswith("viewer/"):
            assert set(re.findall(r'from "([^"]+)"', text)) <= set(modules)
    assert "--one" in viewer_style()


def test_the_bundles_have_licences_of_the_pinned_packages() -> None:
    """The list is made with the bundles (vendor/build.mjs); what is pinned is in it, in that version."""
    pinned = json.loads((VIEWER / "vendor" / "package.json").read_text("utf-8"))["devDependencies"]
    locked = json.loads((VIEWER / "vendor" / "package-lock.json").read_text("utf-8"))["packages"]
    told = (VIEWER / "vendor" / "LICENSES.txt").read_text("utf-8")
    for name, version in pinned.items():
        assert locked[f"node_modules/{name}"]["version"] == version
        if name != "esbuild":
            assert f"{name} {version} (" in told
    assert all("resolved" not in entry for entry in locked.values())


def test_all_that_the_page_loads_is_at_most_600_kilobytes() -> None:
    studio = VIEWER.parents[1] / "studio" / "page"
    files = [*VIEWER.glob("*"), *VIEWER.glob("vendor/*.js"), VIEWER / "vendor/uPlot.css", *studio.glob("*")]
    total = sum(
        x.stat().st_size for x in files if x.suffix in (".js", ".css", ".html") and "entry" not in x.name
    )
    assert 400_000 < total <= 600_000


def test_samples_of_a_drive_are_shown_with_the_distances_and_margins_of_the_drive() -> None:
    trace = sample_drive(FILE.drive, FILE.road, FILE.horizon, Fraction(1, 10), "samples")
    home = rp.load()
    observed = rp.monitor("danger(SV,POV)", trace, using=home, lanes={}).observed
    recorded = recorded_data(trace, [("question", observed)], home.specification, home.all_values()).as_json()
    document = viewer_data(FILE, LIBRARY, [ShownFormula("question", "danger(SV,POV)")]).as_json()
    assert recorded["drive"]["distances"] == document["drive"]["distances"] != []
    margins = [
        {x["text"]: x["margins"] for x in one["formulas"][0]["parts"] if "margins" in x}
        for one in (recorded, document)
    ]
    name = "rssViolation(SV, POV)"
    assert margins[0][name] == margins[1][name]
    assert len(margins[0]["danger(SV,POV)"]) == 61
    assert margins[0]["danger(SV,POV)"][-1] is None  # what comes after the samples decides
    assert recorded["formulas"][0]["step"] == 0.1
