"""How long a browser takes to open a page with 72 drives: ``python benchmarks/report.py``.

The drives are those of ``roadproof witness --all`` in base, extA and ext, found anew in a folder of its own.
What is told is the time from the start of loading until the page's scripts have run, by the browser's own
clock, of five openings; and how long it took to make the page. With ``--picture FILE`` the picture of
docs/how-to/report.md is made again.
"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import roadproof as rp

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
OPTIONS = ["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"]


def ready(page: Path) -> int:
    """Milliseconds until the page was ready."""
    command = [str(CHROMIUM), *OPTIONS, page.as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    found = re.search(r'data-ready="(\d+)"', done.stdout)
    assert found is not None, "the page's scripts did not run"
    return int(found[1])


def draw(target: Path) -> None:
    """The matrix of scenarios 1, 4, 5 and 6, and the drive behind the cell of 1 and 5."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
    from extensions.pages.studio.browser import browsing

    with tempfile.TemporaryDirectory() as name, browsing() as browser:
        folder = Path(name)
        rp.overlap("1,4-6", out=folder / "overlap")
        made = rp.page(
            folder / "overlap", out=folder / "page.html", title="Scenarios 1, 4, 5 and 6 of ISO 34502"
        )
        page = browser.new_page(viewport={"width": 1280, "height": 1560}, color_scheme="light")
        page.goto(f"{made.path.as_uri()}#pair-0-1")
        page.wait_for_selector(".viewer .uplot")
        page.evaluate("scrollTo(0, 0)")
        page.wait_for_timeout(1000)
        page.screenshot(path=target)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--picture", type=Path)
    args = parser.parse_args()
    if CHROMIUM is None:
        raise SystemExit("there is no chromium here: install it, for instance apt-get install chromium")
    if args.picture:
        draw(args.picture)
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rp.witness(using=rp.load("base", "extA", "ext"), out=folder / "drives", pictures=False)
        begun = time.monotonic()
        made = rp.page(folder / "drives", out=folder / "page.html")
        seconds = time.monotonic() - begun
        times = [ready(made.path) for _ in range(5)]
    size = len(made.text.encode()) / 1e6
    print(f"{made.drives} drives, {size:.1f} MB, made in {seconds:.1f} s")
    print(f"ready after {median(times):.0f} ms (median of {sorted(times)})")


if __name__ == "__main__":
    main()
