"""The studio as a person uses it, in a real browser: every pane and every action."""

import json
import os
import re
import shlex
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from extensions.pages.studio.browser import Tab, why_none
from extensions.pages.studio.serving import running, workers_of
from roadproof.frontends.cli.main import main

pytestmark = pytest.mark.skipif(bool(why_none()), reason=why_none() or "there is a browser")

ROOT = Path(__file__).parents[4]
DRIVES = ROOT / "examples" / "traffic" / "drives"
LOOSE = 'def danger(a, b: vehicle) "at whatever distance" := G[0, minDanger] s(b) - s(a) <= 1000 m\n'
TIGHT = (
    'def danger(a, b: vehicle) "nearer than the RSS distance along the road"\n'
    "  := G[0, minDanger] rssViolation_lon(a, b)\n"
)
LONG = "scenario_5(SV,POV,L) and not scenario_1(SV,POV,L)"


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    files = [str(next(DRIVES.glob(f"*{number}-base.json"))) for number in ("04", "01")]
    with running(*files) as (found, _):
        yield found


def test_a_drive_of_the_command_line_is_shown_with_its_parts_and_the_token_leaves_the_address(
    tab: Tab,
) -> None:
    tab.holds("true")
    assert "token" not in tab.page.url
    assert tab.rows()[:3] == ["scenario_4(SV, POV, main-1)", "initSafe(SV, POV)", "roadSector_4(SV, POV)"]
    label = tab.see(".scene").get_attribute("aria-label")
    assert label is not None
    assert re.search(r"at 0\.00 s: SV: s .*km/h; POV: s", label)
    assert "deceleration ahead" in tab.see(".called").inner_text()
    assert tab.page.locator(".drives li").count() == 2
    tab.page.locator(".drives button[aria-pressed=false]").click()
    tab.until("() => document.querySelector('.row .words')?.textContent.startsWith('scenario_1')")
    assert "01-base" in tab.see(".drives button[aria-pressed=true]").inner_text()


def test_samples_of_the_command_line_are_monitored(browser: Any) -> None:
    samples = ROOT / "examples" / "catalogue" / "tests" / "samples" / "braking.csv"
    with running(str(samples)) as (found, _):
        tab = Tab(browser, found)
        tab.until("() => document.querySelector('.scene')?.ariaLabel.includes('101 km/h')")
        tab.see(".strips.question .row")
        assert tab.faults == []
        tab.close()


def test_no_label_of_the_scene_covers_another(browser: Any, tmp_path: Path) -> None:
    starts = {"SV": (0, "2.6"), "POV": (6, "2.4"), "POV2": (3, 6), "POV3": (-5, "2.5")}
    moving = {name: rp.motion(s, d, 30) for name, (s, d) in starts.items()}
    formula = " and ".join(f"v_lon({name}) > 1 m/s" for name in starts)
    rp.drive(formula, moving, road="main-3", collisions=True).save(tmp_path / "four.json")
    with running(str(tmp_path / "four.json")) as (found, _):
        tab = Tab(browser, found)
        tab.page.add_init_script(HEARD_WORDS)
        tab.page.reload()
        tab.until("() => (window.heard ?? []).filter((x) => x.words.includes('km/h')).length >= 4")
        last = tab.page.evaluate(
            "window.heard.slice(window.heard.findLastIndex((x) => x.words.includes('driving')))"
        )
        names = [x for x in last if "km/h" in x["words"]]
        assert {x["words"].split()[0] for x in names} == {*starts}
        for one, other in combinations([x for x in last if "km/h" in x["words"] or "RSS" in x["words"]], 2):
            apart = abs(one["y"] - other["y"]) >= 11 or (
                one["x"] + one["wide"] <= other["x"] or other["x"] + other["wide"] <= one["x"]
            )
            assert apart, (one, other)
        tab.close()


HEARD_WORDS = """
const write = CanvasRenderingContext2D.prototype.fillText;
CanvasRenderingContext2D.prototype.fillText = function (words, x, y) {
  const place = this.getTransform().transformPoint(new DOMPoint(x, y));
  const ratio = window.devicePixelRatio || 1;
  const wide = this.measureText(words).width;
  if (this.canvas.classList.contains("scene")) {
    (window.heard ??= []).push({ words, x: place.x / ratio, y: place.y / ratio, wide });
  }
  return write.call(this, words, x, y);
};
"""


def test_what_is_typed_is_read_and_judged_at_once(tab: Tab) -> None:
    tab.holds("true")
    tab.write(
        "definitions", "def danger(a, b: vehicle) := G[0, minDanger] fals(a)\ndef laneKeep(a: vehicle) :=\n"
    )
    told = tab.see(".mistakes li:nth-child(2)").locator("xpath=..").inner_text()
    assert "1:46" in told or "1:" in told
    assert "2:" in told
    assert tab.page.locator(".cm-lintRange-error").count() >= 1
    tab.write("definitions", "def danger(a, b: vehicle) := false\n")
    tab.holds("false")
    tab.write("definitions", "")
    tab.holds("true")


def test_strips_are_unfolded_selected_and_jumped_in_with_the_mouse(tab: Tab) -> None:
    tab.holds("true")
    before = len(tab.rows())
    row = tab.page.locator(".row", has_text="initSafe(SV, POV)").first
    row.locator("button.fold").click()
    assert len(tab.rows()) > before
    row.locator(".words").click()
    assert "margin of initSafe(SV, POV)" in tab.see(".plot figcaption").inner_text()
    box = row.locator(".track").bounding_box()
    bar = row.locator(".track i.true").first.bounding_box()
    assert box is not None
    assert bar is not None
    tab.page.mouse.click(bar["x"] + bar["width"] + 4, box["y"] + 4)
    drive = json.loads(next(DRIVES.glob("*04-base.json")).read_text())
    end = next(x["true"] for x in drive["verdict"]["times"] if x["formula"].startswith("initSafe"))
    exactly = float(re.findall(r"[\d.]+", end.partition(",")[2])[0])
    assert abs(float(tab.see(".clock output").inner_text().split()[0]) - exactly) < 0.006


def test_all_of_it_by_keyboard_alone(tab: Tab) -> None:
    tab.press("?")
    keys = tab.see(".help").inner_text()
    assert all(word in keys for word in ("Find a drive", "Prove", "Compare", "Explain", "Stop what runs"))
    tab.press("Escape", "q", "Control+a", "Delete")
    tab.page.keyboard.insert_text("4")
    tab.press("Enter")
    tab.answered("WITNESSED")
    tab.press("Escape", "Escape", "s", "ArrowDown", "ArrowRight", "Enter")
    assert tab.page.locator(".row.chosen .words").inner_text() == "initSafe(SV, POV)"
    tab.until("() => Number(document.querySelector('.scrubber').value) > 0")
    tab.press(" ")
    tab.until("() => document.querySelector('.clock .play').ariaLabel === 'Pause'")
    tab.press(" ", "k")
    assert tab.page.locator(".clock .scale input").is_checked()
    tab.press("e")
    tab.see(".row.because")
    tab.press("a")
    tab.until("() => document.activeElement.closest('.watched')")
    tab.page.keyboard.insert_text("v_lon(SV) > 100 km/h")
    tab.until("() => document.querySelector('.strips.watch')?.textContent.includes('v_lon(SV) > 100 km/h')")
    tab.press("Escape", "Escape", "t")
    tab.until("() => document.documentElement.dataset.theme === 'dark'")


def test_next_is_another_drive_and_without_it_is_one_where_it_does_not_hold(tab: Tab) -> None:
    at_the_start = "document.querySelector('.scene').ariaLabel"
    tab.write("asked", "scenario_4(SV,POV,L)")
    tab.press("f")
    tab.answered("WITNESSED")
    tab.holds("true")
    tab.until(f"() => {at_the_start}.includes('at 0.00 s')")
    first = tab.page.evaluate(at_the_start)
    tab.press("n")
    tab.answered("WITNESSED", 2)
    tab.until(f"(former) => {at_the_start} !== former", first)
    newest = tab.page.locator(".verdict").first
    assert "--count 2" in newest.locator(".command code").inner_text()
    offered = newest.locator(".downloads button").all_inner_texts()
    assert offered == ["Show 1", "Show 2", "↓ drive-1.json", "↓ drive-2.json"]
    newest.get_by_text("Show 1", exact=True).click()
    tab.until(f"(first) => {at_the_start} === first", first)
    tab.press("w")
    tab.answered("WITNESSED", 3)
    tab.holds("false")


def test_options_of_jobs_are_chosen_on_the_page(tab: Tab) -> None:
    tab.page.get_by_label("objective").select_option("severe")
    tab.press("f")
    tab.answered("WITNESSED")
    assert "--objective severe" in tab.see(".verdict .command code").inner_text()
    tab.page.get_by_label("declared").check()
    tab.write("asked", "minDanger >= 0.6 s or v_lon(SV) > 0 m/s or v_lon(SV) < 1 m/s")
    tab.press("p")
    tab.answered("PROVED")
    assert "--declared" in tab.see(".verdict .command code").inner_text()


def test_a_claim_is_proved_with_a_certificate_that_check_accepts(tab: Tab, tmp_path: Path) -> None:
    tab.write("asked", "minDanger = 0.6 s and danger(SV,POV) -> G[0, 0.6 s] rssViolation(SV,POV)")
    tab.press("p")
    tab.answered("PROVED")
    with tab.page.expect_download() as download:
        tab.page.click("text=certificate.json")
    download.value.save_as(tmp_path / "certificate.json")
    assert main(["check", str(tmp_path / "certificate.json")]) == 0
    tab.write("asked", "danger(SV,POV) -> rssViolation_lon(SV,POV) and v_lon(SV) > 0")
    tab.press("p")
    tab.answered("REFUTED")


def test_what_is_impossible_has_its_clash_underlined_in_the_text(tab: Tab) -> None:
    tab.write("asked", "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)")
    tab.press("f")
    tab.answered("IMPOSSIBLE")
    marked = tab.page.locator(".asked .mark-clash").all_inner_texts()
    assert "".join(marked).replace(" ", "") == "scenario_1(SV,POV,L)scenario_4(SV,POV,L)"
    assert tab.page.locator(".verdict .core li").count() >= 2


def test_the_story_of_the_paper(tab: Tab) -> None:
    """Danger too loosely, an example with two cars far apart, tightened, before against after as a drive."""
    tab.write("definitions", LOOSE)
    tab.write("asked", "F danger(SV,POV) and s(POV) - s(SV) > 75 m")
    tab.press("f")
    tab.answered("WITNESSED")
    tab.holds("true")
    tab.write("asked", "danger(SV,POV)")
    tab.press("b")
    tab.write("definitions", TIGHT)
    tab.holds("false")
    tab.press("c")
    tab.answered("REFUTED")
    tab.until(
        "() => document.querySelectorAll('.verdict').length >= 3 && !document.querySelector('.spinner')"
    )
    told = tab.page.locator(".answers").inner_text()
    assert "Where it holds before the edit, it does not always hold after it." in told
    tab.page.locator(".verdict", has_text="before the edit, it does not").get_by_text(
        "Show", exact=True
    ).click()
    tab.holds("false")
    tab.until(
        "() => document.querySelector('.strips.before h3')?.textContent.includes('true at 0 s')"
        " && document.querySelector('.row.differs')"
    )


def test_back_reload_and_a_bookmark(tab: Tab) -> None:
    tab.holds("true")
    tab.write("asked", "initSafe(SV,POV)")
    tab.write("definitions", "def laneKeep(a: vehicle, L: lane) := true\n")
    tab.press("f")
    tab.answered("WITNESSED")
    tab.until("() => location.hash.length > 20")
    tab.page.wait_for_timeout(500)
    there = tab.page.url
    tab.page.reload()
    tab.ready()
    tab.holds("true")
    assert "initSafe(SV,POV)" in tab.see(".asked .cm-content").inner_text()
    assert "laneKeep" in tab.see(".definitions .cm-content").inner_text()
    tab.page.go_back()
    tab.until("() => document.querySelector('.row .words')?.textContent.startsWith('initSafe')")
    tab.page.goto("about:blank")
    tab.open(there)
    tab.holds("true")
    assert tab.rows()[0] == "initSafe(SV, POV)"


def test_the_command_line_that_is_shown_gives_the_same(tab: Tab, tmp_path: Path, monkeypatch: Any) -> None:
    tab.write(
        "definitions",
        "def laneKeep(a: vehicle, L: lane) := atLane(a, L) and near(a)\n"
        "def near(a: vehicle) := v_lon(a) > 1 m/s\n",
    )
    tab.write("asked", "4")
    tab.press("f")
    tab.answered("WITNESSED")
    command = tab.see(".verdict .command code").inner_text()
    saved = {}
    for name in ("drive.json", "edit.spec"):
        with tab.page.expect_download() as download:
            tab.page.locator(".verdict").first.get_by_role("button", name=name).click()
        download.value.save_as(tmp_path / name)
        saved[name] = (tmp_path / name).read_text()
    monkeypatch.chdir(tmp_path)
    words = shlex.split(command)
    assert words[:2] == ["roadproof", "witness"]
    assert main([*words[1:], "--out", "again", "--no-pictures", "--quiet"]) == 0
    [again] = [x for x in (tmp_path / "again").glob("*.json") if x.name not in ("question.json",)]
    assert json.loads(again.read_text()) == json.loads(saved["drive.json"])
    assert main(["check", "drive.json", "--spec", "edit.spec"]) == 0


def test_a_page_of_its_own_needs_no_server(tab: Tab, browser: Any, tmp_path: Path) -> None:
    tab.holds("true")
    with tab.page.expect_download() as download:
        tab.press("x")
    download.value.save_as(tmp_path / "drive.html")
    assert not re.search(
        r"(?:src|href)=|https?://(?!www\.w3\.org)",
        (tmp_path / "drive.html").read_text().partition("importmap")[0],
    )
    alone = browser.new_context(offline=True).new_page()
    faults: list[str] = []
    alone.on("console", lambda x: faults.append(x.text))
    alone.on("pageerror", lambda x: faults.append(str(x)))
    alone.on("request", lambda x: faults.append(x.url) if x.url.startswith("http") else None)
    alone.goto((tmp_path / "drive.html").as_uri())
    alone.wait_for_selector(".row")
    assert alone.locator(".row .words").all_inner_texts() == tab.rows()
    assert faults == []
    alone.context.close()


def test_files_are_dropped(tab: Tab, tmp_path: Path) -> None:
    proof = ROOT / "proofs" / "P4-scenario-03-base.json"
    other = ROOT / "examples" / "catalogue" / "tests" / "drives" / "braking.json"
    tab.drop(next(DRIVES.glob("*01-base.json")), other, proof)
    tab.answered("PROVED")
    tab.until("() => document.querySelector('.row .words')?.textContent.startsWith('scenario_1')")
    tab.page.locator(".drives button", has_text="braking").click()
    tab.until("() => document.querySelector('.row .words')?.textContent.startsWith('scenario_4')")
    assert (
        main(
            [
                "simulate",
                "--out",
                str(tmp_path),
                "--recordings",
                "1",
                "--seconds",
                "20",
                "--seed",
                "7",
                "--quiet",
            ]
        )
        == 0
    )
    tab.drop(*tmp_path.glob("01_*.csv"))
    tab.see(".recording tbody tr")
    tab.page.locator(".recording td:nth-child(4) button").first.click()
    tab.until(
        "() => document.querySelector('.scene')?.ariaLabel && !document.querySelector('.clock .danger')"
    )
    tab.see(".strips.question .row")
    tab.press("e")
    assert "Explain is about judged drives" in tab.see(".third").inner_text()
    assert tab.page.locator(".plot figcaption", has_text="margin").count() == 1


def test_texts_stay_texts(tab: Tab) -> None:
    tab.holds("true")
    hostile = '<img src=x onerror="document.title=1">'
    tab.write("asked", hostile)
    tab.until("() => document.querySelector('.called .wrong')")
    tab.write("definitions", f'def danger(a, b: vehicle) "{hostile.replace(chr(34), chr(39))}" := true\n')
    tab.page.wait_for_timeout(500)
    assert tab.page.title() == "roadproof studio"
    assert tab.page.locator("#app img, .cm-tooltip img").count() == 0


def test_stop_frees_the_processor_and_closing_the_page_stops_its_jobs(browser: Any) -> None:
    with running() as (address, process):
        tab = Tab(browser, address)
        tab.write("asked", LONG)
        before = wait_for_workers(process.pid, 3)
        tab.press("f")
        tab.until("() => document.querySelector('.third')?.textContent.includes('dt=')")
        tab.press("Escape")
        after = wait_for_workers(process.pid, 3, other_than=before)
        assert len(before - after) == 1
        tab.press("f")
        tab.until("() => document.querySelector('.third')?.textContent.includes('dt=')")
        assert tab.faults == []
        tab.close()
        last = wait_for_workers(process.pid, 3, other_than=after)
        assert len(after - last) == 1


def wait_for_workers(process: int, count: int, other_than: set[int] | None = None) -> set[int]:
    """The workers of a studio, once there are so many and, if asked, not the same ones. A minute at most."""
    import time

    for _ in range(600):
        found = workers_of(process)
        if len(found) == count and found != other_than:
            return found
        time.sleep(0.1)
    raise AssertionError(f"workers: {found}, before: {other_than}")


def test_two_tabs_do_not_disturb_each_other_and_a_killed_worker_leaves_the_page_alive(browser: Any) -> None:
    with running() as (address, process):
        one, other = Tab(browser, address), Tab(browser, address)
        one.write("asked", LONG)
        one.press("f")
        other.write("asked", "4")
        other.write("definitions", "def laneKeep(a: vehicle, L: lane) := true\n")
        other.press("f")
        other.answered("WITNESSED")
        one.until("() => document.querySelector('.third')?.textContent.includes('dt=')")
        assert one.page.locator(".definitions .cm-content").inner_text().startswith("def danger")
        for worker in workers_of(process.pid):
            os.kill(worker, 9)
        one.until("() => document.querySelector('.third')?.textContent.includes('SIGKILL')")
        one.write("asked", "4")
        one.press("f")
        one.answered("WITNESSED")
        assert one.faults == other.faults == []
        one.close()
        other.close()


def test_a_page_without_the_token_says_what_to_do(browser: Any, address: str) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.goto(address.partition("#")[0] + "#token=wrong")
    page.wait_for_function(
        "() => document.body.textContent.includes('open the address that this start of the studio printed')"
    )
    context.close()
