"""A real browser for tests: Debian's Chromium, driven by playwright; where one is missing, why is said."""

import importlib.util
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

ASKED = "ROADPROOF_BROWSER"
CHROMIUM = Path(os.environ.get("CHROMIUM", "/usr/bin/chromium"))
_FLAGS = (
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync"),
)
SEEN = "if (location.protocol === 'http:') localStorage.setItem('roadproof-tour', 'true')"
DROP = """(files) => {
  const carried = new DataTransfer();
  for (const x of files) carried.items.add(new File([x.content], x.name));
  document.dispatchEvent(new DragEvent("drop", { dataTransfer: carried, bubbles: true, cancelable: true }));
}"""


def why_none() -> str:
    """Why no browser is driven here; empty where one is."""
    if not os.environ.get(ASKED):
        return "a browser is driven by make browser"
    if importlib.util.find_spec("playwright") is None:
        return "playwright is not installed: pip install -e '.[dev]'"
    if importlib.util.find_spec("uvicorn") is None:
        return "the extra 'studio' is not installed"
    return "" if CHROMIUM.exists() else f"there is no {CHROMIUM}: apt-get install chromium"


@contextmanager
def browsing() -> Iterator[Any]:
    """A headless browser with a new profile."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), headless=True, args=[*_FLAGS])
        try:
            yield browser
        finally:
            browser.close()


class Tab:
    """A page of the studio; ``faults`` has what no page may do: errors, and requests to other origins.

    ``newcomer``: one that begins with the tour.
    """

    def __init__(self, browser: Any, address: str, newcomer: bool = False, **options: Any) -> None:
        self.address = address
        self.faults: list[str] = []
        origin = address.partition("/#")[0]
        self.context = browser.new_context(viewport={"width": 1440, "height": 900}, **options)
        self.context.set_default_timeout(int(os.environ.get("BROWSER_TIMEOUT", "60")) * 1000)
        self.page = self.context.new_page()
        if not newcomer:
            self.page.add_init_script(SEEN)
        self.page.on(
            "console", lambda x: self.faults.append(x.text) if x.type in ("error", "warning") else None
        )
        self.page.on("pageerror", lambda x: self.faults.append(str(x)))
        self.page.on("dialog", lambda x: self.faults.append(f"dialog {x.message}"))
        self.page.on(
            "request",
            lambda x: None if x.url.startswith((origin, "data:", "blob:")) else self.faults.append(x.url),
        )
        self.open(address)

    def open(self, address: str) -> None:
        self.page.goto(address)
        self.ready()

    def ready(self) -> None:
        self.page.wait_for_selector("html[data-ready=yes]")

    def see(self, selector: str) -> Any:
        """What is there, once it is."""
        found = self.page.locator(selector).first
        found.wait_for()
        return found

    def press(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)

    def leave(self) -> None:
        """Out of every editor."""
        self.page.evaluate("document.activeElement?.blur()")

    def write(self, where: str, text: str) -> None:
        """Put a text into an editor in place of what is there, and leave it: definitions, asked, watched."""
        self.page.locator(f".{where} .cm-content").last.focus()
        self.press("Control+a", "Delete")
        self.page.keyboard.insert_text(text)
        self.leave()

    def until(self, condition: str, argument: Any = None) -> None:
        """Wait until an expression of the page is true."""
        self.page.wait_for_function(condition, arg=argument)

    def answered(self, verdict: str, count: int = 1) -> None:
        """Wait for answers with this verdict, and for the end of the job."""
        self.until(
            """([verdict, count]) => !document.querySelector('.spinner') &&
              [...document.querySelectorAll('.verdict .word')]
                .filter((x) => x.textContent === verdict).length >= count""",
            [verdict, count],
        )

    def holds(self, truth: str) -> None:
        """Wait until the question is that at 0 s on the drive that is shown."""
        self.until(
            "(said) => document.querySelector('.strips.question h3')?.textContent.includes(said)",
            f"{truth} at 0 s",
        )

    def rows(self) -> list[str]:
        """The names of the strips that are seen."""
        found: list[str] = self.page.locator(".row .words").all_inner_texts()
        return found

    def drop(self, *paths: Path) -> None:
        self.page.evaluate(DROP, [{"name": x.name, "content": x.read_text("utf-8")} for x in paths])

    def close(self) -> None:
        self.context.close()
