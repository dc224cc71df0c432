"""What the studio shows in a real browser: at first paint, after a reload, and of which question."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from extensions.pages.studio.browser import SEEN, Tab, why_none
from extensions.pages.studio.serving import running

pytestmark = pytest.mark.skipif(bool(why_none()), reason=why_none() or "there is a browser")
DRIVES = Path(__file__).parents[4] / "examples" / "traffic" / "drives"
STRIPS = "document.querySelector('.strips.question h3')?.textContent"


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with running(str(next(DRIVES.glob("*04-base.json"))), known=True) as (found, _):
        yield found


def test_every_card_has_a_picture_before_the_server_has_read_a_scenario(browser: Any, address: str) -> None:
    context = browser.new_context(viewport={"width": 1440, "height": 900})
    page = context.new_page()
    page.add_init_script(SEEN)
    page.route("**/ask", lambda route: None)  # no answer to any question
    page.goto(address)
    page.wait_for_selector(".gallery .card")
    assert page.locator(".gallery .card").count() == page.locator(".gallery .picture").count() == 24
    assert page.locator(".gallery .picture .car").count() >= 48
    context.close()


def test_answers_survive_a_reload_and_show_their_drives_again(browser: Any, address: str) -> None:
    tab = Tab(browser, address)
    tab.write("asked", "initSafe(SV,POV)")
    tab.press("f")
    tab.answered("WITNESSED")
    tab.write("asked", "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)")
    tab.press("f")
    tab.answered("IMPOSSIBLE")
    before = tab.page.locator(".verdict").all_inner_texts()
    tab.page.reload()
    tab.ready()
    tab.until("() => document.querySelectorAll('.verdict').length === 2")
    assert tab.page.locator(".verdict").all_inner_texts() == before
    tab.page.locator(".verdict").nth(1).get_by_text("Show", exact=True).click()
    tab.until(f"() => {STRIPS}.includes('scenario_1')")
    other = Tab(browser, address)
    assert other.page.locator(".verdict").count() == 0
    assert tab.faults == other.faults == []
    other.close()
    tab.close()


def test_answers_that_have_no_room_are_left_out_and_broken_ones_are_not_read(
    browser: Any, address: str
) -> None:
    tab = Tab(browser, address)
    many = [{"verdict": "PROVED", "formula": f"{k}", "key": k, "reason": "x" * 100} for k in range(3)]
    stored = json.dumps([*many, {"verdict": 1}, "no answer", None])
    tab.page.evaluate("(text) => sessionStorage.setItem('roadproof-answers', text)", stored)
    tab.page.reload()
    tab.ready()
    tab.until("() => document.querySelectorAll('.verdict').length === 3")
    tab.page.evaluate("""() => {
      const set = Storage.prototype.setItem;
      Storage.prototype.setItem = function (name, value) {
        if (name === "roadproof-answers" && value.length > 5000) throw new Error("full");
        return set.call(this, name, value);
      };
    }""")
    tab.write("asked", "initSafe(SV,POV)")
    tab.press("f")
    tab.answered("WITNESSED")
    kept = tab.page.evaluate("JSON.parse(sessionStorage.getItem('roadproof-answers')).length")
    assert kept in (0, 1, 2, 3)
    assert tab.faults == []
    tab.close()


def test_the_title_of_strips_is_the_question_that_they_are_of(tab: Tab) -> None:
    tab.holds("true")
    assert "Question: scenario_4(SV, POV, L)" in tab.page.evaluate(STRIPS)
    tab.write("asked", "v_lon(SV) > 0 m/s")
    tab.until(f"() => {STRIPS}.startsWith('Question: v_lon(SV) > 0 m/s')")
    tab.write("definitions", "def danger(a, b: vehicle) :=")
    tab.write("asked", "v_lon(SV) > 1 m/s")
    tab.until(f"() => {STRIPS}.startsWith('Former question: v_lon(SV) > 0 m/s')")
    told = "document.querySelector('.stage > .former')?.textContent"
    tab.until(f"() => {told}?.includes('a former question: ')")
    tab.until(f"() => {told}?.includes('the statement ends too early')")
    tab.write("definitions", "")
    tab.until(f"() => {STRIPS}.startsWith('Question: v_lon(SV) > 1 m/s')")
    assert tab.page.locator(".stage > .former").count() == 0


def test_a_saved_page_has_the_title_of_the_question(tab: Tab, tmp_path: Path) -> None:
    tab.holds("true")
    tab.write("asked", "v_lon(SV) > 0 m/s")
    tab.until(f"() => {STRIPS}.startsWith('Question: v_lon(SV) > 0 m/s')")
    with tab.page.expect_download() as download:
        tab.press("x")
    download.value.save_as(tmp_path / "drive.html")
    assert "<h1>v_lon(SV) &gt; 0 m/s</h1>" in (tmp_path / "drive.html").read_text("utf-8")


def test_traces_of_a_recording_that_match_come_first(tab: Tab, tmp_path: Path) -> None:
    from roadproof.frontends.cli.main import main

    words = ["--recordings", "1", "--seconds", "40", "--seed", "7", "--quiet"]
    assert main(["simulate", "--out", str(tmp_path), *words]) == 0
    tab.drop(*tmp_path.glob("01_*.csv"))
    tab.see(".recording tbody tr")
    counts = tab.page.evaluate(
        "[...document.querySelectorAll('.recording tbody tr')].map((x) => x.cells[3].children.length)"
    )
    assert 0 in counts
    assert counts[0] > 0
    assert counts == sorted(counts, reverse=True)
    said = tab.see(".recording h2 small").inner_text()
    assert f"{sum(x > 0 for x in counts)} match a scenario" in said
