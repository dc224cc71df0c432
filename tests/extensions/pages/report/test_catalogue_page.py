"""The page of a catalogue: why a name is red, where a test fails, and drivers with their own drives."""

import json
import re
from pathlib import Path

import pytest

from extensions.pages.report.reading import PALE, opened
from extensions.pages.report.test_page import HEADED, body_of, catalogue_of, concrete, made
from extensions.pages.studio.browser import why_none
from roadproof.extensions.catalogue.catalogue_data import DecisionData
from roadproof.extensions.pages.page.catalogues import _least_left, _reasons_of, _worst_of

DRIVE = next((Path(__file__).parents[4] / "examples" / "traffic" / "drives").glob("*04-base.json"))
MODELS = ("careful", "r157", "eu1426", "rss", "fsm")
LONG = "drives found: 1 not covered, 2 preventable; a search found none on another side; nothing is proved"


def decision(test: str, driver: str, **more: object) -> dict:
    plain = {"scenario": "scenario_4", "vehicles": ["SV", "POV"], "side": "undecided", "at": 0.0}
    plain |= {"gap": None, "instant": None, "speed": None, "reason": "", "drive": None}
    start = {"Ve0": 27.65, "dV0": 1.523, "Gx": 0.1317, "dx0": 58.69, "length": 5, "width": 2}
    return {"test": test, "driver": driver, "start": start, **plain, **more}


def decisions_of(test: str) -> list[dict]:
    """Of each model: a collision, gaps, and one that is undecided."""
    drive = json.loads(DRIVE.read_text("utf-8"))
    hits = {"side": "unpreventable", "instant": 2.25, "speed": 4.5, "drive": drive}
    left = {"side": "preventable", "drive": drive}
    rows = [left | {"gap": 55.97}, left | {"gap": 12.5}, hits, hits | {"speed": 3.0}, {"reason": LONG}]
    return [decision(test, name, **more) for name, more in zip(MODELS, rows, strict=True)]


@pytest.fixture(scope="module")
def page(tmp_path_factory) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("catalogue")
    shown = [{"what": "scenario_4", "vehicles": ["SV", "POV"], "lane": "main-1", "at": 0.0}]
    near = {"nearest": "scenario_8", "vehicles": ["SV", "POV"], "lane": "main-1", "at": 4.5}
    near |= {"lacks": "changesLane(SV)", "told": "it is false at 4.5 s", "sets": {}}
    tests = [
        concrete(id="right", file=str(DRIVE), shown=shown),
        concrete(id="mislabelled", file=str(DRIVE), claims=["scenario_8"], shown=shown),
        concrete(id="aimless", file=str(DRIVE), shown=[], why=near),
    ]
    names = [f"drives/a-long-name-of-a-test-{k}" for k in range(12)]
    answer = {"schema": "roadproof/catalogue/1", **HEADED} | catalogue_of(
        **{"options": {}, "parameters": {}, "specs": []},
        tests=tests,
        faults=[
            {"tests": ["mislabelled"], "told": "claims scenario_8, and shows scenario_4"},
            {"tests": ["aimless"], "told": "shows no scenario; nearest is scenario_8"},
        ],
        decisions=[x for name in ("right", *names) for x in decisions_of(name)],
    )
    (folder / "tests.json").write_text(json.dumps(answer), "utf-8")
    return folder / "page.html", body_of(made(folder / "tests.json", out=folder / "page.html")[1])


def test_a_red_name_says_why_in_its_row_and_at_its_drive(page) -> None:
    rows = re.findall(
        r"<tr(?: id=\"[^\"]*\")?><th scope=\"row\"[^>]*><a href=\"#test-0-\d\"( class=\"wrong\")?>(.*?)</tr>",
        page[1],
    )
    assert [bool(red) for red, _ in rows] == [False, True, True]
    assert ["claims scenario_8, and shows scenario_4" in row for _, row in rows] == [False, True, False]
    assert "shows no scenario; nearest is scenario_8" in rows[2][1]
    assert page[1].count('<p class="wrong">claims scenario_8, and shows scenario_4</p>') == 1


def test_a_picture_of_a_test_shows_the_scenario_that_fails(page) -> None:
    right, wrong, aimless = re.findall(r'<details id="test-0-\d">.*?</details>', page[1], re.DOTALL)
    for part, name in ((right, "scenario_4"), (wrong, "scenario_8"), (aimless, "scenario_8")):
        assert f"<title>when the parts of {name}(SV, POV, " in part
    assert "is false on this drive" not in wrong + aimless


def test_of_a_test_the_worst_drive_and_the_least_gap_are_shown(page) -> None:
    found = [DecisionData(**{**x, "start": {}, "vehicles": ("SV", "POV")}) for x in decisions_of("a")]
    worst = _worst_of(found)
    assert worst is not None
    assert (worst.driver, _least_left(found)) == ("eu1426", "0")
    gaps = found[:2]
    least = _worst_of(gaps)
    assert least is not None
    assert (least.driver, _least_left(gaps)) == ("r157", "12.5")
    assert _worst_of(found[-1:]) is None
    assert _least_left(found[-1:]) == ""
    assert _reasons_of({x.driver: x for x in found}) == [(["fsm"], LONG)]
    assert '<a href="#own-0-0">drive of eu1426</a>' in page[1]
    assert '<details id="own-0-0">' in page[1]
    assert "hits at 2.25 s, 4.5 m/s faster" in page[1]
    assert "55.97 m left" in page[1]


@pytest.mark.skipif(bool(why_none()), reason=why_none() or "there is a browser")
@pytest.mark.parametrize(("width", "tallest"), [(1280, 160), (390, 420)])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_table_of_drivers_can_be_read(browser, page, width, tallest, scheme) -> None:
    shown, faults = opened(browser, page[0], viewport={"width": width, "height": 800}, color_scheme=scheme)
    table = shown.locator("table.drivers")
    high = table.evaluate("(x) => Math.max(...[...x.rows].map((y) => y.offsetHeight))")
    wide, room = table.evaluate("(x) => [x.scrollWidth, x.parentElement.clientWidth]")
    assert wide <= room
    assert high <= tallest
    assert shown.evaluate("document.documentElement.scrollWidth") <= width
    assert shown.evaluate(PALE) == []
    table.locator("a", has_text="drive of eu1426").first.click()
    shown.locator("#own-0-0[open]").wait_for(state="attached")
    assert faults == []
