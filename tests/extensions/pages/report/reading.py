"""What browser tests ask of every page: no fault, no request to others, texts that can be read."""

from pathlib import Path
from typing import Any

# The texts whose contrast with the background behind them is below that of WCAG 2.1 AA.
PALE = """() => {
  const rgb = (text) => (text.match(/[\\d.]+/g) ?? []).map(Number);
  const light = (parts) => parts.slice(0, 3).map((x) => x / 255)
    .map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4))
    .reduce((sum, x, k) => sum + x * [0.2126, 0.7152, 0.0722][k], 0);
  const behind = (x) => {
    for (let at = x; at; at = at.parentElement) {
      const found = rgb(getComputedStyle(at).backgroundColor);
      if (found.length === 3 || found[3] === 1) return found;
    }
    return [255, 255, 255];
  };
  const pale = [];
  for (const x of document.querySelectorAll("body *:not(svg *):not(style)")) {
    const own = [...x.childNodes].some((y) => y.nodeType === 3 && y.textContent.trim());
    if (!own || !x.checkVisibility() || x.closest(".doubt")) continue;
    const style = getComputedStyle(x), [a, b] = [light(rgb(style.color)), light(behind(x))];
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < (parseFloat(style.fontSize) >= 24 ? 3 : 4.5)) pale.push(`${ratio} ${x.textContent.trim()}`);
  }
  return pale;
}"""


def opened(browser: Any, path: Path, **more: Any) -> tuple[Any, list[str]]:
    """A page, and what a reader should never see: errors, and requests to others."""
    page, faults = browser.new_page(**more), list[str]()
    page.on("console", lambda x: faults.append(x.text))
    page.on("pageerror", lambda x: faults.append(str(x)))
    page.on("requestfailed", lambda x: faults.append(x.url))
    page.on("request", lambda x: None if x.url.startswith("file:") else faults.append(x.url))
    page.goto(path.as_uri())
    return page, faults
