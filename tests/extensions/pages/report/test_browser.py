"""The page of a report in a real browser: it fits, plays, sorts, filters, and can be used by keyboard."""

import json
import re
import subprocess
from pathlib import Path

import pytest

import roadproof as rp
from extensions.pages.report.reading import PALE, opened
from extensions.pages.report.test_page import HEADED, VERSIONS, hostile_answers, hostile_overlap
from extensions.pages.report.test_summary import claims_of, written
from extensions.pages.studio.browser import CHROMIUM, why_none
from roadproof.engines.prove.properties import template_properties

pytestmark = pytest.mark.skipif(bool(why_none()), reason=why_none() or "there is a browser")
DRIVES = Path(__file__).parents[4] / "examples" / "traffic" / "drives"
READY = "document.documentElement.dataset.ready"


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    """A page with claims, open pairs and a gallery of drives."""
    folder = tmp_path_factory.mktemp("page")
    answers = {"claims": claims_of("P1", "P2", "P9", "C1"), "overlap": hostile_overlap() | {"set": "base"}}
    drives = sorted(DRIVES.glob("*.json"))[:6]
    return rp.page(*written(folder, **answers), *drives, out=folder / "page.html", jobs=1).path


@pytest.fixture(scope="module")
def kinds(tmp_path_factory) -> Path:
    """A page with a section of each kind of result."""
    folder = tmp_path_factory.mktemp("kinds")
    drive = json.loads(min(DRIVES.glob("*.json")).read_text("utf-8"))
    answers = {
        kind: {"schema": f"roadproof/{kind}/{VERSIONS.get(kind, 1)}", **HEADED, **data}
        for kind, data in hostile_answers(drive).items()
    }
    return rp.page(*written(folder, **answers), out=folder / "page.html", jobs=1).path


@pytest.mark.parametrize("width", [390, 1280])
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("which", ["made", "kinds"])
def test_the_page_fits_and_can_be_read(browser, request, which, width, scheme):
    made = request.getfixturevalue(which)
    page, faults = opened(browser, made, viewport={"width": width, "height": 900}, color_scheme=scheme)
    page.evaluate("document.querySelectorAll('details').forEach((x) => { x.open = true; })")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(PALE) == []
    assert faults == []


def test_a_drive_plays_at_focus_and_opens_and_closes_by_keyboard(browser, made):
    page, faults = opened(browser, made)
    card = page.locator("#drive-0")
    state = "(x) => getComputedStyle(x.querySelector('.plays')).animationPlayState"
    assert card.evaluate(state) == "paused"
    card.locator("button.open").focus()
    page.keyboard.press("Shift+Tab")
    page.keyboard.press("Tab")
    assert card.evaluate(state) == "running"
    page.keyboard.press("Enter")
    card.locator(".viewer").wait_for()
    page.keyboard.press("Enter")
    assert not card.locator(".viewer").is_visible()
    assert page.locator(".viewer").count() == 1
    assert faults == []


def test_a_reader_who_prefers_no_motion_sees_none(browser, made):
    page, _ = opened(browser, made, reduced_motion="reduce")
    page.locator("#drive-0").hover()
    state = "getComputedStyle(document.querySelector('#drive-0 .plays')).animationPlayState"
    assert page.evaluate(state) == "paused"


def test_tables_sort_by_keyboard_and_filter(browser, made):
    page, _ = opened(browser, made)
    page.locator("summary", has_text="All claims").click()
    table = page.locator("table.sheet", has=page.locator("#claim-0-0"))
    first = table.locator("tbody tr >> nth=0 >> td >> nth=1")
    heading = table.locator("th", has_text="claim of")
    heading.locator("button").focus()
    page.keyboard.press("Enter")
    assert (heading.get_attribute("aria-sort"), first.inner_text()) == ("ascending", "C1")
    page.keyboard.press("Enter")
    assert (heading.get_attribute("aria-sort"), first.inner_text()) == ("descending", "P9")
    numbers = [
        x.split()[1] for x in table.locator("td:nth-child(2)").all_inner_texts() if x.startswith("P1 ")
    ]
    assert numbers == [str(n) for n in range(24, 0, -1) for _ in range(3)]
    box = page.locator("details[open] > .filtering input")
    box.fill("dangerArises(SV,POV2)")
    assert table.locator("tbody tr:visible").count() == 9
    page.evaluate("location.hash = '#claim-0-0'")
    page.locator("#claim-0-0").wait_for(state="visible")
    assert box.input_value() == ""


def test_a_cell_of_the_grid_opens_its_claim(browser, made):
    page, _ = opened(browser, made)
    cell = page.locator("table.matrix a[title^='P1 8 in base']")
    cell.focus()
    page.keyboard.press("Enter")
    row = page.locator(":target")
    row.wait_for()
    assert "scenario_8(SV,POV,L) -> dangerArises(SV,POV)" in row.inner_text()
    assert row.is_visible()


def test_open_points_lead_to_their_place(browser, made):
    page, _ = opened(browser, made)
    page.locator(".finding a", has_text="scenarios 1 and 5").click()
    page.locator("#pair-1-0[open]").wait_for(state="attached")


def test_a_page_of_72_drives_is_ready_before_it_opens_one(browser, tmp_path):
    drives = sorted(DRIVES.glob("*.json"))
    many = [tmp_path / f"{k:02}.json" for k in range(72)]
    for k, path in enumerate(many):
        path.write_bytes(drives[k % len(drives)].read_bytes())
    page, faults = opened(browser, rp.page(*many, out=tmp_path / "page.html", jobs=1).path)
    assert page.locator(".gallery .mini").count() == 72
    assert page.locator(".viewer").count() == 0
    assert int(page.evaluate(READY)) >= 0  # benchmarks/report.py compares the milliseconds with a second
    assert faults == []


def test_paper_is_light_and_has_the_grid_and_no_folded_part(browser, made):
    page, _ = opened(browser, made, color_scheme="dark")
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("table.matrix").first.is_visible()
    assert page.locator("#drive-0 .mini").is_visible()
    assert not page.locator("summary", has_text="All claims").is_visible()
    assert page.locator("summary", has_text="control: the converse of P1").is_visible()
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.emulate_media(media="screen", color_scheme="dark")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(23, 27, 34)"


def test_the_demo_prints_on_ten_pages_or_fewer(tmp_path):
    """As `make demo` has them: all claims, 24 drives and a matrix."""
    names = {x.id for x in template_properties()}
    answers = {"claims": claims_of(*names), "overlap": hostile_overlap() | {"set": "base"}}
    drives = sorted(DRIVES.glob("*.json"))
    many = [tmp_path / f"drive-{k:02}.json" for k in range(24)]
    for k, path in enumerate(many):
        path.write_bytes(drives[k % len(drives)].read_bytes())
    page = rp.page(*written(tmp_path, **answers), *many, out=tmp_path / "page.html", jobs=1).path
    paper = tmp_path / "page.pdf"
    options = ["--headless", "--no-sandbox", "--disable-gpu", f"--print-to-pdf={paper}"]
    subprocess.run([str(CHROMIUM), *options, page.as_uri()], capture_output=True, timeout=120, check=True)
    assert 2 <= len(re.findall(rb"/Type\s*/Page\b", paper.read_bytes())) <= 10
