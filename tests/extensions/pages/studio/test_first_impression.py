"""The studio as a newcomer meets it, in a real browser: the gallery, with answers that are known."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from extensions.pages.report.reading import PALE
from extensions.pages.studio.browser import Tab, why_none
from extensions.pages.studio.serving import running

pytestmark = pytest.mark.skipif(bool(why_none()), reason=why_none() or "there is a browser")

DRIVES = Path(__file__).parents[4] / "examples" / "traffic" / "drives"
TIME = "Number(document.querySelector('.scrubber').value)"
QUESTION = "document.querySelector('.asked .cm-content').textContent"


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    folder = tmp_path_factory.mktemp("files")
    (folder / "own.spec").write_text("def laneKeep(a: vehicle, L: lane) := true\n", "utf-8")
    with running(str(folder), known=True) as (found, _):
        yield found


def test_scenario_1_plays_and_every_card_has_a_picture(tab: Tab) -> None:
    tab.until(f"() => document.querySelector('.scrubber') && {TIME} > 0.3")
    tab.holds("true")
    assert tab.see(".card[aria-current]").get_attribute("aria-label") == (
        "Scenario 1: cut-in, lane keep, main road"
    )
    tab.until("() => document.querySelectorAll('.gallery .picture').length === 24")
    assert tab.page.locator(".gallery summary").all_inner_texts()[:3] == [
        "Main road",
        "Merge zone",
        "Departure zone",
    ]


def test_a_card_is_loaded_by_keyboard_and_arrows_move_among_cards(tab: Tab) -> None:
    tab.until("() => document.querySelectorAll('.gallery .picture').length === 24")
    tab.leave()
    tab.press("g", "ArrowDown", "ArrowDown", "ArrowDown", "ArrowUp", "Enter")
    tab.until("() => document.querySelector('.row .words')?.textContent.startsWith('scenario_3')")
    tab.holds("true")
    assert tab.page.evaluate("document.activeElement.ariaLabel").startswith("Scenario 3:")
    assert tab.page.locator(".gallery .card[tabindex='0']").count() == 1


def test_whoever_prefers_rest_gets_the_drive_at_rest(browser: Any, address: str) -> None:
    tab = Tab(browser, address, reduced_motion="reduce")
    tab.holds("true")
    tab.page.wait_for_timeout(300)
    assert tab.page.evaluate(TIME) == 0
    assert tab.faults == []
    tab.close()


def test_files_are_put_into_the_editor_and_the_gallery_is_folded_for_good(tab: Tab) -> None:
    tab.holds("true")
    tab.page.get_by_role("button", name="own.spec").click()
    tab.until("() => document.querySelector('.definitions .cm-content').textContent.includes('laneKeep')")
    tab.page.get_by_role("button", name="Hide the gallery").click()
    assert tab.page.locator(".gallery").count() == 0
    tab.page.reload()
    tab.ready()
    assert tab.page.locator(".gallery").count() == 0
    tab.page.get_by_role("button", name="Gallery").click()
    tab.see(".gallery .card")


def test_on_a_phone_the_gallery_is_a_drawer(browser: Any, address: str) -> None:
    tab = Tab(browser, address)
    tab.page.set_viewport_size({"width": 390, "height": 844})
    tab.page.reload()
    tab.ready()
    tab.holds("true")
    assert tab.page.locator(".gallery").count() == 0
    tab.page.get_by_role("button", name="Gallery").click()
    tab.page.locator(".gallery .card", has_text="deceleration").first.click()
    tab.until("() => document.querySelector('.row .words')?.textContent.startsWith('scenario_4')")
    assert tab.page.locator(".gallery").count() == 0
    tab.page.get_by_role("button", name="Gallery").click()
    tab.see(".gallery .card[aria-current]")
    tab.press("Escape")
    assert tab.page.locator(".gallery").count() == 0
    assert tab.page.evaluate("document.activeElement.className") == "gallery-switch"
    assert tab.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert tab.faults == []
    tab.close()


TEXT = "document.querySelector('.definitions .cm-content').textContent"
DENIED = """for (const name of ['localStorage', 'sessionStorage'])
  Object.defineProperty(window, name, { get() { throw new DOMException('denied', 'SecurityError'); } });"""


def test_nothing_typed_is_lost_when_another_scenario_or_file_is_loaded(tab: Tab) -> None:
    tab.until("() => document.querySelectorAll('.gallery .picture').length === 24")
    tab.holds("true")
    assert tab.page.get_by_role("button", name="Undo").is_disabled()
    typed = "def laneKeep(a: vehicle, L: lane) := false"
    tab.write("definitions", typed)
    tab.write("asked", "scenario_1(SV,POV,L) and true")
    tab.page.locator(".gallery .card", has_text="acceleration").first.click()
    tab.until("() => document.querySelector('.row .words')?.textContent.startsWith('scenario_3')")
    tab.page.get_by_role("button", name="own.spec").click()
    tab.until(f"() => !{TEXT}.includes('false')")
    tab.leave()
    tab.press("u")
    tab.until(f"(typed) => {TEXT} === typed", typed)
    tab.press("Control+z")
    tab.until(f"() => {QUESTION} === 'scenario_1(SV,POV,L) and true'")
    tab.until("() => document.querySelector('.strips.question')?.textContent.includes('false at 0 s')")
    tab.page.get_by_role("button", name="Redo").click()
    tab.until(f"() => {QUESTION}.startsWith('scenario_3')")
    tab.until("() => document.querySelector('.row .words')?.textContent.startsWith('scenario_3')")
    tab.press("Control+y")
    tab.until(f"() => {TEXT}.includes('true')")
    tab.until("() => document.querySelector('button[aria-label=Redo]').disabled")


def test_an_example_is_asked_by_a_click_and_is_among_the_recent_questions_afterwards(tab: Tab) -> None:
    tab.holds("true")
    tab.page.locator(".examples button", has_text="a false claim").click()
    tab.answered("REFUTED")
    told = tab.see(".verdict .cost").inner_text()
    assert "processor" in told
    tab.write("asked", "1")
    tab.press("f")
    tab.answered("WITNESSED")
    cost = tab.see(".verdict .cost")
    assert "shipped with roadproof" in cost.inner_text()
    cost.get_by_role("button", name="Compute again").click()
    tab.answered("WITNESSED", 2)
    assert "shipped" not in tab.see(".verdict .cost").inner_text()
    tab.page.reload()
    tab.ready()
    rows = tab.page.locator(".recent button")
    rows.first.wait_for()
    assert [x.split("\n")[0] for x in rows.locator(".word").all_inner_texts()] == ["WITNESSED", "REFUTED"]
    rows.nth(1).click()
    tab.until(f"() => {QUESTION} === 'rssViolation(SV,POV) -> danger(SV,POV)'")
    tab.leave()
    tab.press("u")
    tab.until(f"() => {QUESTION} === '1'")
    tab.page.get_by_role("button", name="Forget", exact=True).click()
    assert tab.page.locator(".recent").count() == 0


def test_a_browser_that_keeps_nothing_and_one_that_keeps_rubbish_show_the_page(
    browser: Any, address: str
) -> None:
    rubbish = "localStorage.setItem('roadproof-recent', '[3, null, {\"formula\": 4}]');"
    for script in (DENIED, rubbish):
        context = browser.new_context(viewport={"width": 1440, "height": 900})
        page = context.new_page()
        faults: list[str] = []
        page.on("pageerror", lambda x, faults=faults: faults.append(str(x)))
        page.add_init_script(script)
        page.goto(address)
        page.wait_for_selector("html[data-ready=yes]")
        page.wait_for_selector(".scene")
        assert page.locator(".recent").count() == 0
        page.locator(".examples button", has_text="always leads").click()
        page.wait_for_selector(".verdict.yes")
        page.wait_for_selector(".recent .word.yes")
        assert faults == []
        context.close()


NAMELESS = """[...document.querySelectorAll('button, input, select, summary')]
  .filter((x) => !(x.ariaLabel || x.textContent.trim() || x.labels?.length)).map((x) => x.outerHTML)"""
CONTROLS = """() => {
  const all = document.querySelectorAll('button, input, select, summary, .cm-content, .tree');
  window.unreached = new Set([...all].filter((x) => x.checkVisibility() && !x.disabled && x.tabIndex >= 0));
}"""
REACHED = """() => {
  const x = document.activeElement;
  unreached.delete(x);
  const shown = x === document.body || x.closest('.cm-editor') || getComputedStyle(x).outlineStyle !== 'none';
  return shown ? [] : [x.outerHTML];
}"""


def focused(tab: Tab) -> str:
    return str(tab.page.evaluate("document.activeElement.textContent"))


def test_a_newcomer_is_shown_around_once(browser: Any, address: str) -> None:
    tab = Tab(browser, address, newcomer=True)
    tab.holds("true")
    titles = []
    for _ in range(6):
        titles.append(tab.see(".tour h2").inner_text())
        assert focused(tab) in ("Next", "Done")
        frame, place = tab.see(".tour .frame").bounding_box(), tab.see(".tour .card").bounding_box()
        assert frame is not None
        assert place is not None
        assert 0 <= place["x"] <= 1440 - place["width"]
        assert 0 <= place["y"] <= 900 - place["height"]
        tab.press("Enter")
    assert len(set(titles)) == 6
    assert tab.page.locator(".tour").count() == 0
    tab.page.reload()
    tab.ready()
    tab.page.goto("about:blank")
    tab.open(address)
    tab.holds("true")
    assert tab.page.locator(".tour").count() == 0
    assert tab.faults == []
    tab.close()


def test_the_tour_goes_back_and_escape_ends_it_and_gives_back_the_focus(tab: Tab) -> None:
    tab.holds("true")
    tab.page.locator(".examples button").first.focus()
    before = focused(tab)
    tab.press("i", "ArrowRight", "ArrowRight", "ArrowLeft")
    assert "2 of 6" in tab.see(".tour h2").inner_text()
    tab.press("Escape")
    assert tab.page.locator(".tour").count() == 0
    assert focused(tab) == before
    tab.press("i")
    tab.page.get_by_role("button", name="Skip the tour").click()
    assert tab.page.locator(".tour").count() == 0


def test_there_is_one_plot_of_each_kind_whatever_widths_the_page_had(tab: Tab) -> None:
    tab.holds("true")
    for width in (390, 1440, 700, 820, 1100):
        tab.page.set_viewport_size({"width": width, "height": 900})
    tab.page.wait_for_timeout(300)
    counts = "[...document.querySelectorAll('.plot .canvas')].map((x) => x.children.length)"
    assert tab.page.evaluate(counts) == [1, 1, 1, 1]
    box = "(name) => document.querySelector(name).getBoundingClientRect().left"
    assert abs(tab.page.evaluate(box, ".track") - tab.page.evaluate(box, ".u-over")) < 3


def test_the_keys_are_a_dialog_that_takes_the_focus_and_gives_it_back(tab: Tab) -> None:
    tab.holds("true")
    tab.page.get_by_role("button", name="Copy link").focus()
    tab.press("?")
    assert focused(tab) == "Close"
    tab.press("Escape")
    assert focused(tab) == "Copy link"


def test_words_of_the_viewer_are_explained_on_focus_and_on_hover(tab: Tab) -> None:
    tab.holds("true")
    for word in ("RSS envelope", "gap", "danger", "strips?", "margin?", "gap?"):
        button = tab.page.locator(".term button", has_text=re.compile(f"^{re.escape(word)}$")).first
        told = tab.page.locator(f"#{button.get_attribute('aria-describedby')}")
        assert not told.is_visible()
        button.focus()
        assert told.is_visible()
        tab.press("Escape")
        assert not told.is_visible()
        button.hover()
        assert told.is_visible()
        assert len(told.inner_text()) > 60
        tab.page.mouse.move(2, 2)
    tab.press("s", "ArrowDown")
    about = tab.page.locator(f"#{tab.see('.tree').get_attribute('aria-describedby')}")
    assert "durable safety at the start" in about.inner_text()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [390, 1280])
def test_every_text_has_contrast_and_nothing_is_wider_than_the_page(
    browser: Any, address: str, scheme: str, width: int
) -> None:
    tab = Tab(browser, address, color_scheme=scheme, reduced_motion="reduce")
    tab.page.set_viewport_size({"width": width, "height": 844})
    tab.page.reload()
    tab.ready()
    tab.holds("true")
    tab.page.locator(".examples button", has_text="a false claim").click()
    tab.answered("REFUTED")
    for key in ("Escape", "g", "i", "?"):
        tab.press(key)
        assert tab.page.evaluate(PALE) == []
        assert tab.page.evaluate("document.documentElement.scrollWidth") <= width
    assert tab.faults == []
    tab.close()


def test_every_control_is_reached_by_tab_shows_the_focus_and_has_a_name(tab: Tab) -> None:
    tab.until("() => document.querySelectorAll('.gallery .picture').length === 24")
    tab.holds("true")
    assert tab.page.evaluate(NAMELESS) == []
    tab.leave()
    tab.page.evaluate(CONTROLS)
    unseen = []
    for _ in range(tab.page.evaluate("unreached.size") + 12):
        tab.press("Tab")
        unseen += tab.page.evaluate(REACHED)
        if tab.page.evaluate("document.activeElement.closest('.editor')"):
            tab.press("Escape")
    assert unseen == []
    assert tab.page.evaluate("[...unreached].map((x) => x.outerHTML)") == []
