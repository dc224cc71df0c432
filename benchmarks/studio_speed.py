"""How quick the studio is in a real browser: python benchmarks/studio_speed.py [--rounds 5] [--pictures DIR].

Measured in the page, from the event to the next frame that shows the answer. The machine's load is printed
with the figures, since they are those of an idle machine only where it is idle. With --pictures the pictures
of docs/how-to/studio.md are made again.
"""

import argparse
import os
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from extensions.pages.studio.browser import Tab, browsing
from extensions.pages.studio.serving import running, workers_of

LIMITS = {
    "page ready": 1.5,
    "key to diagnostics": 0.15,
    "edit to strips": 0.4,
    "click to drive, scenario 1": 1.5,
    "stop to a free processor": 1.0,
}
LOOSE = """\
# danger as it was first written: too loose
def danger(a, b: vehicle) "b is ahead of a, at whatever distance"
  := G[0, minDanger] s(a) < s(b)
"""
# Watches what a selector finds from the next event of a kind on, until it is another.
WATCH = """([selector, event]) => {
  const said = () => [...document.querySelectorAll(selector)].map((x) => x.outerHTML).join();
  const before = said();
  window.taken = new Promise((done, fail) => {
    setTimeout(() => fail(new Error(`nothing changed: ${selector}`)), 60000);
    const begin = () => {
      const begun = performance.now();
      const look = () => (said() === before ? requestAnimationFrame(look) : done(performance.now() - begun));
      requestAnimationFrame(look);
    };
    document.addEventListener(event, begin, { once: true, capture: true });
  });
}"""


def seconds(tab: Tab, selector: str, event: str, act: Callable[[], None]) -> float:
    """From an event that ``act`` brings about to the frame in which what ``selector`` finds has changed."""
    tab.page.evaluate(WATCH, [selector, event])
    act()
    return float(tab.page.evaluate("window.taken")) / 1000


def typing(tab: Tab, key: str) -> Callable[[], None]:
    """A key in the definitions."""
    tab.page.locator(".definitions .cm-content").focus()
    tab.press("Control+End")
    return lambda: tab.press(key)


def measure(rounds: int) -> dict[str, list[float]]:
    found: dict[str, list[float]] = {name: [] for name in LIMITS}
    with running() as (address, process), browsing() as browser:
        for _ in range(rounds):
            begun = time.perf_counter()
            tab = Tab(browser, address)
            found["page ready"].append(time.perf_counter() - begun)
            tab.page.wait_for_timeout(3000)
            click = tab.page.locator("button.main").click
            found["click to drive, scenario 1"].append(seconds(tab, ".viewer", "click", click))
            tab.holds("true")
            tab.write("definitions", "def danger(a, b: vehicle) := G[0, minDanger] s(b) - s(a) <= 3 m*1")
            tab.holds("false")
            tab.page.wait_for_timeout(1500)
            strips = seconds(tab, ".strips.question .track", "keydown", typing(tab, "0"))
            tab.page.wait_for_timeout(1000)
            found["edit to strips"].append(strips)
            found["key to diagnostics"].append(seconds(tab, ".mistakes", "keydown", typing(tab, ")")))
            found["stop to a free processor"].append(stopping(tab, process.pid))
            tab.close()
    return found


def stopping(tab: Tab, process: int) -> float:
    """From Escape to the end of the worker that was at a long job."""
    tab.write("definitions", "")
    tab.write("asked", "scenario_5(SV,POV,L) and not scenario_1(SV,POV,L)")
    tab.press("f")
    tab.until("() => document.querySelector('.third')?.textContent.includes('dt=')")
    before = workers_of(process)
    tab.press("Escape")
    begun = time.perf_counter()
    while before <= workers_of(process):
        time.sleep(0.005)
    return time.perf_counter() - begun


def begin(tab: Tab) -> None:
    """Scenario 1 where danger begins."""
    tab.page.locator(".clock .danger").click()
    tab.leave()


def explain(tab: Tab) -> None:
    """Why scenario 1 is false where danger begins, beside its answer."""
    tab.press("f")
    tab.answered("WITNESSED")
    begin(tab)
    tab.press("e")
    tab.see(".row.because")


def compare(tab: Tab) -> None:
    """Scenario 1 with a looser danger, before against after the edit."""
    tab.write("definitions", LOOSE)
    tab.press("c")
    tab.answered("REFUTED", 2)
    tab.see(".strips.before")


PICTURES = {
    "studio": ("light", begin),
    "studio-explain": ("dark", explain),
    "studio-compare": ("light", compare),
}


def draw(folder: Path) -> None:
    """The pictures of docs/how-to/studio.md."""
    folder.mkdir(parents=True, exist_ok=True)
    with running(known=True) as (address, _), browsing() as browser:
        for name, (scheme, act) in PICTURES.items():
            tab = Tab(browser, address, color_scheme=scheme, reduced_motion="reduce")
            tab.page.set_viewport_size({"width": 1400, "height": 860})
            tab.until("() => document.querySelectorAll('.gallery .picture').length === 24")
            tab.holds("true")
            act(tab)
            tab.page.mouse.move(1, 90)
            tab.page.wait_for_timeout(500)
            tab.page.screenshot(path=folder / f"{name}.png")
            tab.close()


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--pictures", type=Path)
    args = parser.parse_args()
    if args.pictures:
        draw(args.pictures)
        return
    print(f"load before: {', '.join(f'{x:.1f}' for x in os.getloadavg())} on {os.cpu_count()} cores")
    for name, values in measure(args.rounds).items():
        told = f"median {statistics.median(values):.3f} s, worst {max(values):.3f} s of {len(values)}"
        print(f"{name:<28} {told:<44} (at most {LIMITS[name]:g} s)")
    print(f"load after: {', '.join(f'{x:.1f}' for x in os.getloadavg())}")


if __name__ == "__main__":
    main()
