"""The atlas in a real browser: it fits, plays, can be used by keyboard, and is readable in light and dark."""

from typing import Any

import pytest

from extensions.pages.report.reading import PALE, opened
from extensions.pages.studio.browser import why_none

pytestmark = pytest.mark.skipif(bool(why_none()), reason=why_none() or "there is a browser")


@pytest.mark.parametrize("width", [390, 1280])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_each_page_fits_and_can_be_read(browser, made, width, scheme):
    for name in made.pages:
        more = {"viewport": {"width": width, "height": 900}, "color_scheme": scheme}
        page, faults = opened(browser, made.folder / name, **more)
        page.evaluate("document.querySelectorAll('details').forEach((x) => { x.open = true; })")
        assert page.evaluate("document.documentElement.scrollWidth") <= width, name
        assert page.evaluate(PALE) == [], name
        assert faults == []
        page.evaluate("document.body.style.color = '#777777'")
        assert page.evaluate(PALE) != []
        page.close()


def state_of(page: Any, picture: str) -> str:
    found = page.evaluate(
        "(x) => getComputedStyle(document.querySelector(x + ' .plays')).animationPlayState", picture
    )
    return str(found)


def test_a_picture_plays_when_the_keyboard_reaches_it_and_leads_to_its_page(browser, made):
    page, _ = opened(browser, made.path)
    assert state_of(page, ".card") == "paused"
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Skip to the content"
    for _ in range(5):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.className") == "card":
            break
    assert state_of(page, ".card") == "running"
    page.keyboard.press("Enter")
    page.wait_for_url("**/scenario-01.html")
    page.close()


def test_pictures_stand_still_where_the_reader_says_so(browser, made):
    page, _ = opened(browser, made.folder / "scenario-01.html")
    assert state_of(page, ".big") == "running"
    page.locator("#pause").focus()
    page.keyboard.press("Space")
    assert state_of(page, ".big") == "paused"
    page.close()
    page, _ = opened(browser, made.folder / "scenario-01.html", reduced_motion="reduce")
    assert state_of(page, ".big") == "paused"
    page.close()


def test_a_link_in_a_formula_unfolds_the_definition(browser, made):
    page, _ = opened(browser, made.folder / "scenario-01.html")
    page.locator(".formula.main a", has_text="initSafe").click()
    assert page.locator("#d-initSafe").is_visible()
    page.close()
